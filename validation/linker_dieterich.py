"""Rate-and-state friction whose state depends on the pressure: steps of the pressure, and an oscillating one against scipy."""
import matplotlib.pyplot as plot
import numpy
from library import LINKER_DIETERICH
from scipy.integrate import solve_ivp

A, B, D_C, V0, F0, ALPHA = 0.01, 0.015, 1.0, 1.0, 0.6, 0.25    # um, s, MPa
NORMAL, CONTACT = 10.0, 100.0
EVOLUTIONS = ('ageing', 'slip')
# a spring stiffer than the critical one, pulled at 1 um/s, under a normal traction that goes up and down
STIFFNESS, CHANGE, PERIOD, T_END = 5.0, 2.0, 3.0, 40.0


def step(library, report, evolution):
    """The pressure is raised by a fifth during steady sliding of a contact that is nearly rigid."""
    point = library.point(LINKER_DIETERICH, 1e3, 1e9, A, B, D_C, V0, F0, ALPHA, evolution).pressed(NORMAL)
    for _ in range(2000):
        point.shear(0.02 * D_C, 0.02 * D_C / V0)
    name, factor, computed = EVOLUTIONS[evolution], 1.2, []
    dt = 1e-6 * D_C / V0
    point.update(-(factor - 1) * NORMAL / 1e3, V0 * dt, 0.0, dt)
    computed.append(point.traction[1] / (factor * NORMAL))
    slips = [0.0]
    for _ in range(300):
        computed.append(point.shear(0.02 * D_C, 0.02 * D_C / V0) / (factor * NORMAL))
        slips.append(slips[-1] + 0.02)
    slips = numpy.array(slips)
    if evolution == 0:
        ln_state = numpy.log(1 + (factor**(-ALPHA / B) - 1) * numpy.exp(-slips))
    else:
        ln_state = -ALPHA / B * numpy.log(factor) * numpy.exp(-slips)
    source = ('`v theta/d_c = 1 + ((p_2/p_1)^(-alpha/b) - 1) exp(-s/d_c)`', '`ln(v theta/d_c) = -(alpha/b) ln(p_2/p_1) exp(-s/d_c)`')
    report.curve(f'Linker-Dieterich, {name} law: friction after a step of the pressure, no elasticity', source[evolution],
                 A * numpy.arcsinh(0.5 * numpy.exp((F0 + B * ln_state) / A)), numpy.array(computed), 1e-5)


def reference(evolution, times):
    series = 1 / (1 / STIFFNESS + 1 / CONTACT)
    omega = 2 * numpy.pi / PERIOD

    def rates(t, y):
        tau, ln_theta = y
        p = NORMAL + CHANGE * numpy.sin(omega * t)
        change = ALPHA / B * CHANGE * omega * numpy.cos(omega * t) / p
        v = 2 * V0 * numpy.sinh(tau / (A * p)) * numpy.exp(-(F0 + B * (numpy.log(V0 / D_C) + ln_theta)) / A)
        x = v * numpy.exp(ln_theta) / D_C
        evolved = numpy.exp(-ln_theta) - v / D_C if evolution == 0 else -v / D_C * numpy.log(max(x, 1e-300))
        return series * (V0 - v), evolved - change

    with numpy.errstate(over='ignore', invalid='ignore'):   # of guesses far off
        solution = solve_ivp(rates, (0, T_END), [0.0, numpy.log(D_C / V0)], 'Radau', times, rtol=1e-10, atol=1e-12)
    return solution.y[0]


def validate(library, program, report):
    report.section('State that depends on the pressure', f"""
Linker and Dieterich's law (laws.md 8), `alpha = {ALPHA:g}`: a step of the pressure by a fifth against its closed forms; and a block without mass, pulled at
{V0:g} um/s by a spring of {STIFFNESS:g} MPa/um, under a normal traction of {NORMAL:g} MPa that goes up and down by {CHANGE:g} MPa every {PERIOD:g} s. Reference: two
differential equations by scipy's Radau at a tolerance of 1e-10.""")
    figure, axes = plot.subplots(1, 2, figsize=(12, 4), sharey=True)
    for evolution, name in enumerate(EVOLUTIONS):
        step(library, report, evolution)
        groups = {'friction': {'law': 'linker_dieterich', 'alpha_n': 1e3, 'alpha_t': CONTACT, 'a': A, 'b': B, 'd_c': D_C, 'v0': V0,
                               'f0': F0, 'alpha': ALPHA, 'evolution': name},
                  'slider': {'mass': 0.0, 'stiffness': STIFFNESS, 'normal_traction': NORMAL},
                  'drive': {'velocity': V0, 'normal_amplitude': CHANGE, 'normal_frequency': 1 / PERIOD},
                  'output': {'interval': 1}}
        rows, _ = program.run(**groups, time={'t_end': T_END, 'rtol': 1e-8})
        expected = reference(evolution, rows['time'])
        report.row(f'Linker-Dieterich, {name} law: friction under an oscillating pressure, rtol = 1e-8 [MPa]', 'Radau: 0', 0.0,
                   numpy.max(abs(rows['friction_force'] - expected)), 1e-5, absolute=True)
        errors = []
        for dt in (4e-3, 2e-3):
            fixed, _ = program.run(**groups, time={'t_end': T_END, 'dt': dt})
            errors.append(numpy.max(abs(fixed['friction_force'] - reference(evolution, fixed['time']))))
        report.row(f'Linker-Dieterich, {name} law: the same, error at dt = 4 ms over that at 2 ms', 'first order: 2', 2.0,
                   errors[0] / errors[1], 5e-2)
        axes[evolution].plot(rows['time'], expected / (NORMAL + CHANGE * numpy.sin(2 * numpy.pi * rows['time'] / PERIOD)), 'k-',
                             linewidth=3, alpha=0.4, label='Radau, 1e-10')
        axes[evolution].plot(rows['time'], rows['mu'], 'C1-', linewidth=1, label='stickslip')
        axes[evolution].set(xlabel='time [s]', ylabel='friction coefficient', title=f'{name} law', xlim=(20, T_END), ylim=(0.5, 0.7))
        axes[evolution].grid(alpha=0.3)
        axes[evolution].legend()
    report.picture(figure, 'linker_dieterich', 'Friction under an oscillating pressure')
