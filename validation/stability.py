"""Where steady sliding becomes unstable, found by bisection on the program."""
import matplotlib.pyplot as plot
import numpy

HALVINGS = 9


def growth(rows, steady, end):
    """Rate at which the distance of the friction force from steady sliding grows: a line through the logarithm of its
    extrema, those of the first cycle left out."""
    late = rows['time'] > 0.1 * end
    times, away = rows['time'][late], rows['friction_force'][late] - steady
    inner = abs(away[1:-1])
    peaks = numpy.flatnonzero((inner >= abs(away[:-2])) & (inner > abs(away[2:]))) + 1
    return numpy.polyfit(times[peaks], numpy.log(abs(away[peaks])), 1)[0]


def bisect(rate, low, high):
    """Where `rate` changes its sign, `low` and `high` being on either side of it."""
    sign = numpy.sign(rate(low))
    if sign == numpy.sign(rate(high)):
        raise RuntimeError(f'no change of stability between {low} and {high}')
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        if numpy.sign(rate(middle)) == sign:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)


# ---- rate and state: um, s, stresses in units of the normal traction ---------------------------------

A, B, D_C, F0, V0 = 0.005, 0.01, 10.0, 0.6, 1.0
CONTACT = 100.0    # [1/um]: 1e5 times the critical stiffness


def critical_stiffness(mass, rate):
    return (B - A) / D_C * (1 + mass * rate**2 / (A * D_C))


def rate_and_state_run(program, evolution, mass, rate, stiffness):
    """Steady sliding at `rate`, disturbed by a ten-thousandth of its friction's direct effect."""
    omega = rate / D_C * numpy.sqrt((B - A) / A)
    end, dt = 6 * 2 * numpy.pi / omega, 2 * numpy.pi / omega / 4000
    steady = A * numpy.arcsinh(rate / (2 * V0) * numpy.exp((F0 + B * numpy.log(V0 / rate)) / A))
    initial = {'mu': steady + 1e-4 * A}
    if mass > 0:
        initial['velocity'] = rate
    rows, _ = program.run(
        friction={'law': 'rate_and_state', 'alpha_n': 1.0, 'alpha_t': CONTACT, 'a': A, 'b': B, 'd_c': D_C, 'v0': V0, 'f0': F0,
                  'theta_0': D_C / rate, 'evolution': evolution},
        slider={'mass': mass, 'stiffness': stiffness, 'normal_traction': 1.0}, drive={'velocity': rate}, initial=initial,
        time={'t_end': end, 'dt': dt, 'tolerance': 1e-14}, output={'interval': 20})
    return rows, steady, end


def rate_and_state(program, report):
    report.section('Linear stability: rate-and-state friction', f"""
Steady sliding is disturbed a little; the disturbance grows or decays. `a = {A}`, `b = {B}`, `d_c = {D_C:g}`, normal traction 1, a contact
so stiff (`alpha_t = {CONTACT:g}`) that it does not count. 4000 fixed steps to a period of the critical oscillation, {HALVINGS} halvings of
the interval of 10 % to either side.""")
    for evolution in ('ageing', 'slip'):
        for mass, rate in ((0.0, 1.0), (0.025, 1.0), (0.025, 2.0), (0.025, 0.1)):
            expected = critical_stiffness(mass, rate)

            def rate_of(stiffness):
                return growth(*rate_and_state_run(program, evolution, mass, rate, stiffness))   # noqa: B023

            report.row(f'{evolution} law: critical stiffness, `M = {mass:g}`, `v = {rate:g}`',
                       '`(b - a) sigma/d_c (1 + M v^2/(sigma a d_c))`, Ruina 1983, Rice and Ruina 1983',
                       expected, bisect(rate_of, 0.9 * expected, 1.1 * expected), 1e-2)
    figure, axes = plot.subplots(1, 2, figsize=(12, 3.6), sharey=True)
    for axis, part in zip(axes, (0.98, 1.02)):
        rows, steady, _ = rate_and_state_run(program, 'ageing', 0.025, 1.0, part * critical_stiffness(0.025, 1.0))
        axis.plot(rows['time'], 1e6 * (rows['friction_force'] - steady), 'C1-')
        axis.set(xlabel='time [T]', title=f'k = {part:g} k_c (ageing law, M = 0.025, v = 1)')
        axis.grid(alpha=0.3)
    axes[0].set(ylabel='friction less its steady value [1e-6]')
    report.picture(figure, 'stability', 'A small disturbance on either side of the critical stiffness')


# ---- subloading: N, mm, s, t -------------------------------------------------------------------------

SUBLOADING = {'law': 'subloading', 'alpha_n': 1000.0, 'alpha_t': 1000.0, 'mu_s': 0.4, 'mu_k': 0.2, 'm': 1000.0}
NORMAL = 10.0
CASES = (dict(kappa=10.0, xi=10.0, rate=1.0, mass=1e-3, stiffness=1.0), dict(kappa=10.0, xi=10.0, rate=3.0, mass=1e-2, stiffness=5.0),
         dict(kappa=2.0, xi=0.5, rate=0.5, mass=1e-3, stiffness=1.0), dict(kappa=100.0, xi=100.0, rate=1.0, mass=1e-3, stiffness=10.0))


def subloading_terms(kappa, xi, rate):
    mu = (kappa * rate * 0.2 + xi * 0.4) / (kappa * rate + xi)
    weakening = NORMAL * kappa * (mu - 0.2)
    return mu, weakening, kappa * rate + xi, 1000.0 / (1000.0 - weakening)


def critical_damping(case):
    """The C with `A = C c + (C K/b)/(M b c + C)`: the positive root of a quadratic."""
    _, weakening, c, b = subloading_terms(case['kappa'], case['xi'], case['rate'])
    inertia = case['mass'] * b * c
    linear = c * inertia + case['stiffness'] / b - weakening
    return (-linear + numpy.sqrt(linear**2 + 4 * c * weakening * inertia)) / (2 * c)


def subloading_run(program, case, damping, scheme):
    mu, weakening, c, _ = subloading_terms(case['kappa'], case['xi'], case['rate'])
    # M l^3 + (C + M c) l^2 + (K + C c - A) l + K c = 0 but for the contact spring: its oscillation
    omega = max(abs(numpy.roots([case['mass'], damping + case['mass'] * c, case['stiffness'] + damping * c - weakening,
                                 case['stiffness'] * c]).imag))
    period = 2 * numpy.pi / omega
    rows, _ = program.run(
        friction={**SUBLOADING, 'kappa': case['kappa'], 'xi': case['xi'], 'scheme': scheme},
        slider={'mass': case['mass'], 'stiffness': case['stiffness'], 'damping': damping, 'normal_traction': NORMAL},
        drive={'velocity': case['rate']},
        initial={'mu': mu * (1 + 1e-5), 'r': 1.0, 'velocity': case['rate'],
                 'spring_force': mu * NORMAL + damping * case['rate']},
        time={'t_end': 8 * period, 'dt': period / 4000, 'tolerance': 1e-14}, output={'interval': 20})
    return rows, mu * NORMAL, 8 * period


def subloading(program, report):
    report.section('Linear stability: the subloading law', """
The same with the criterion of theory.md, section 6, `A < C c + (C K/b)/(M b c + C)`, which counts the contact spring; here the damping `C` is
sought. `alpha_t = 1000`, `mu_s = 0.4`, `mu_k = 0.2`, `m = 1000`, normal traction 10 (N, mm, s, t).""")
    for case in CASES:
        expected = critical_damping(case)
        for scheme in ('exact_rate', 'backward_euler'):

            def rate_of(damping):
                return growth(*subloading_run(program, case, damping, scheme))   # noqa: B023

            report.row('critical damping, ' + ', '.join(f'`{key} = {value:g}`' for key, value in case.items())
                       + f', {scheme.replace("_", " ")}', 'theory.md 6', expected,
                       bisect(rate_of, 0.9 * expected, 1.1 * expected), 1e-2)


# ---- the same from eigenvalues -----------------------------------------------------------------------

def eigenvalues(program, report):
    report.section('Linear stability: eigenvalues', """
The same closed forms against `stickslip stability`, which finds where the largest real part of an eigenvalue changes its sign
([stability.md](stability.md)). Rate and state on a rigid contact; the other constants as above.""")
    source = 'Rice and Ruina 1983'
    for evolution in ('ageing', 'slip'):
        for mass, rate in ((0.0, 1.0), (0.025, 1.0), (0.025, 2.0), (0.025, 0.1)):
            expected = critical_stiffness(mass, rate)

            def steady(stiffness):
                return program.stability(
                    friction={'law': 'rate_and_state', 'alpha_n': 1.0, 'alpha_t': CONTACT, 'contact': 'rigid', 'a': A, 'b': B, 'd_c': D_C,   # noqa: B023
                              'v0': V0, 'f0': F0, 'evolution': evolution},                                                                   # noqa: B023
                    slider={'mass': mass, 'stiffness': stiffness, 'normal_traction': 1.0}, drive={'velocity': rate},                         # noqa: B023
                    time={'t_end': 1.0, 'rtol': 1e-6})

            found = steady(1.1 * expected)
            case = f'{evolution} law, `M = {mass:g}`, `v = {rate:g}`'
            report.row(f'{case}: critical stiffness', source, expected, found['critical_stiffness'], 1e-10)
            report.row(f'{case}: frequency there, `v/d_c sqrt((b - a)/a)/(2 pi)`', source, rate / D_C * numpy.sqrt((B - A) / A) / (2 * numpy.pi),
                       steady(found['critical_stiffness'])['frequency'], 1e-10)
    for case in CASES:
        expected = critical_damping(case)
        found = program.stability(
            friction={**SUBLOADING, 'kappa': case['kappa'], 'xi': case['xi']},
            slider={'mass': case['mass'], 'stiffness': case['stiffness'], 'damping': 1.1 * expected, 'normal_traction': NORMAL},
            drive={'velocity': case['rate']}, time={'t_end': 1.0, 'dt': 0.1})
        report.row('subloading: critical damping, ' + ', '.join(f'`{key} = {value:g}`' for key, value in case.items()), 'theory.md 6', expected,
                   found['critical_damping'], 1e-10)


# ---- two ways to move ----------------------------------------------------------------------------------

MINIMAL = {'mass': 1.0, 'stiffness': 23.25, 'normal_traction': 10.0, 'normal_mass': 1.0, 'normal_stiffness': 7.75,
           'tilt_stiffness': 4.5 * numpy.sqrt(0.75)}


def mode_coupling(program, report):
    report.section('Mode coupling', """
The minimal model of Hoffmann, Fischer, Allgaier and Gaul (2002): a unit mass on springs of 11 and 20 at 150 and 30 degrees, a contact of stiffness 11, constant
friction. `lambda^2 = -(k_11 + k_22)/2 +- sqrt((k_11 - k_22)^2/4 + k_12 (k_12 - mu k_3))` (theory.md, section 14). The growth in time is read off
the maxima of the displacement across the interface, 4000 fixed steps to a swing, from next to steady sliding until it lifts off.""")
    k_11, k_22, k_12, k_3 = 23.25, 18.75, MINIMAL['tilt_stiffness'], 11.0
    source = 'Hoffmann et al. 2002'

    def case(mu, **more):
        return {'friction': {'law': 'coulomb', 'alpha_n': k_3, 'alpha_t': 1e4, 'mu': mu}, 'slider': MINIMAL, 'drive': {'velocity': 20.0},
                'time': {'t_end': 1.0, 'dt': 0.1}, **more}

    critical = ((k_11 - k_22)**2 / (4 * k_12) + k_12) / k_3
    for mu in (0.3, 0.5, 1.0):
        root = numpy.sqrt(complex((k_11 - k_22)**2 / 4 + k_12 * (k_12 - mu * k_3)))
        expected = numpy.sqrt(-(k_11 + k_22) / 2 + root)
        found = program.stability(**case(mu))
        report.row(f'`mu = {mu:g}`: growth', source, abs(expected.real), found['growth_rate'], 1e-10, absolute=True)
        if mu > critical:
            report.row(f'`mu = {mu:g}`: frequency', source, abs(expected.imag) / (2 * numpy.pi), found['frequency'], 1e-10)
    found = program.boundary(**case(0.5, sweep={'key': 'slider%stiffness', 'values': [16.0, 40.0], 'key2': 'friction%mu', 'values2': [0.1, 5.0]}))
    errors = abs(found['friction%mu'] / (((found['slider%stiffness'] - k_22)**2 / (4 * k_12) + k_12) / k_3) - 1)
    report.row(f'flutter boundary, friction coefficient over stiffness: largest error of {len(errors)} points', source, 0.0, errors.max(), 1e-10)
    mu = 0.6
    growth_rate = numpy.sqrt(complex(-(k_11 + k_22) / 2 + numpy.sqrt(complex((k_11 - k_22)**2 / 4 + k_12 * (k_12 - mu * k_3))))).real
    pressure = program.stability(**case(mu))['normal_traction']
    rows, _ = program.run(**case(mu, time={'t_end': 12.0, 'dt': 3.4e-4}, output={'interval': 10}, initial={
        'mu': mu, 'velocity': 20.0, 'spring_force': mu * pressure + k_12 * (10 - pressure) / k_3}))
    away = rows['normal_displacement'] + pressure / k_3
    use = (rows['time'] > 4) & (numpy.maximum.accumulate(rows['normal_displacement']) < 0)
    inner = away[1:-1]
    peaks = numpy.flatnonzero((inner > away[:-2]) & (inner > away[2:]) & use[1:-1]) + 1
    report.row('growth in a run with `mu = 0.6`', source, abs(growth_rate), numpy.polyfit(rows['time'][peaks], numpy.log(away[peaks]), 1)[0], 1e-2)


def validate(program, report):
    rate_and_state(program, report)
    subloading(program, report)
    eigenvalues(program, report)
    mode_coupling(program, report)
