"""Each law against its closed forms, point by point through the library."""
import matplotlib.pyplot as plot
import numpy
from library import COULOMB, RATE_AND_STATE, SLIP_WEAKENING, SLIP_WEAKENING_HEALING, STATIC_KINETIC, SUBLOADING
from scipy.special import expi

PRESSURE = 10.0
EXACT_RATE = 1.0


def validate(library, report):
    report.section('Closed forms', f"""
The routine itself, called through `friction.h`, at a pressure of {PRESSURE:g}. "Steady" means: sheared at a constant rate until nothing
changes. Where the closed form is of a rigid contact the tangential spring is made stiff enough not to matter.""")
    coulomb(library, report)
    static_kinetic(library, report)
    slip_weakening(library, report)
    healing(library, report)
    rate_and_state_steady(library, report)
    rate_and_state_transient(library, report)
    subloading_rest_and_steady(library, report)
    similarity_ratio(library, report)
    orthotropic(library, report)
    draw(library, report)


def slide(point, rate, dt, steps):
    for _ in range(steps):
        traction = point.shear(rate * dt, dt)
    return traction


def coulomb(library, report):
    source = '`tau = mu p`, laws.md 2'
    for angle in (0.0, 0.7):
        point = library.point(COULOMB, 1e3, 1e3, 0.3).pressed(PRESSURE)
        for _ in range(50):
            point.update(0.0, 1e-3 * numpy.cos(angle), 1e-3 * numpy.sin(angle), 0.1)
        report.row(f'Coulomb: traction when sliding at {angle:g} rad to the axis', source, 0.3 * PRESSURE,
                   numpy.hypot(point.traction[1], point.traction[2]), 1e-12)
    point = library.point(COULOMB, 1e3, 1e3, 0.3).pressed(PRESSURE)
    report.row('Coulomb: elastic below it', '`tau = alpha_t u`', 2.0, point.shear(2e-3, 0.1), 1e-12)


def static_kinetic(library, report):
    mu_s, mu_k, decay = 0.4, 0.2, 0.5
    source = '`mu_k + (mu_s - mu_k) exp(-d_c v)`, laws.md 3'
    for rate in (1e-12, 1e-6, 0.1, 1.0, 5.0, 1e3):   # the first and the last are the limits mu_s and mu_k
        point = library.point(STATIC_KINETIC, 1e3, 1e6, mu_s, mu_k, decay).pressed(PRESSURE)
        report.row(f'static-kinetic: friction at the slip rate {rate:g}', source,
                   mu_k + (mu_s - mu_k) * numpy.exp(-decay * rate), slide(point, rate, 1e-3 / rate, 500) / PRESSURE, 1e-11)


def slip_weakening(library, report):
    mu_s, mu_k, d_c, du = 0.5, 0.3, 0.02, 1e-5
    point = library.point(SLIP_WEAKENING, 1e3, 1e4, mu_s, mu_k, d_c).pressed(PRESSURE)
    slip, traction = [0.0], [mu_s * PRESSURE]
    for _ in range(3000):
        new = point.shear(du, 0.1)
        if point.slip > 0.0:
            slip.append(point.slip)
            traction.append(new)
    slip, traction = numpy.array(slip), numpy.array(traction)
    energy = numpy.trapezoid(traction - mu_k * PRESSURE, slip)
    # linear but for the step in which the fall ends
    report.row('slip-weakening: energy beyond sliding at `mu_k`', '`(mu_s - mu_k) p d_c/2`, Ida 1972',
               (mu_s - mu_k) * PRESSURE * d_c / 2, energy, 1e-6)
    expected = PRESSURE * numpy.maximum(mu_k, mu_s - (mu_s - mu_k) * slip / d_c)
    report.curve('slip-weakening: traction over the slip', 'laws.md 5', expected, traction, 1e-12)


def healing(library, report):
    mu_s, mu_k, d_c, xi = 0.5, 0.3, 0.02, 2.0

    def fresh():
        return library.point(SLIP_WEAKENING_HEALING, 1e3, 1e9, mu_s, mu_k, d_c, xi).pressed(PRESSURE)

    for share in (0.01, 0.5, 3.0):   # of the slip rate from which on friction stays kinetic
        rate = share * xi * d_c
        report.row(f'slip-weakening that heals: steady friction at v = {share:g} xi d_c', 'laws.md 6, `D = v/xi` up to `d_c`',
                   mu_s - (mu_s - mu_k) * min(1, share), slide(fresh(), rate, 0.05 / xi, 600) / PRESSURE, 1e-9)
    times = numpy.linspace(0.05, 3.0, 60)
    computed = []
    for time in times:   # slid far, held, and then pulled until it slides, in next to no time
        point = fresh()
        slide(point, 100 * d_c, 0.01, 5)
        point.shear(0.0, time)
        computed.append(point.shear(1e-8, 1e-12) / PRESSURE)
    report.curve('slip-weakening that heals: friction at the end of a hold', '`mu_s - (mu_s - mu_k) exp(-xi t)`',
                 mu_s - (mu_s - mu_k) * numpy.exp(-xi * times), numpy.array(computed), 1e-6)


def rate_and_state(library, evolution, alpha_t=1e3, theta_0=None):
    constants = dict(a=0.01, b=0.015, d_c=1e-2, v0=1e-3, f0=0.6)
    theta_0 = constants['d_c'] / constants['v0'] if theta_0 is None else theta_0
    return constants, library.point(RATE_AND_STATE, 1e3, alpha_t, *constants.values(), evolution, theta_0).pressed(PRESSURE)


def steady_friction(rate, a, b, v0, f0, **_):
    """Regularised, of sliding at a constant rate."""
    return a * numpy.arcsinh(rate / (2 * v0) * numpy.exp((f0 + b * numpy.log(v0 / rate)) / a))


def rate_and_state_steady(library, report):
    for evolution, name in enumerate(('ageing', 'slip')):
        for rate in (1e-9, 1e-6, 1e-3, 1.0):
            constants, point = rate_and_state(library, evolution)
            slide(point, rate, 5e-2 * constants['d_c'] / rate, 3000)
            report.row(f'rate-and-state, {name} law: steady friction at v = {rate:g}',
                       '`a asinh(v/(2 v0) exp((f0 + b ln(v0/v))/a))`, Rice et al. 2001',
                       steady_friction(rate, **constants), point.traction[1] / PRESSURE, 1e-11)


def transient(library, evolution, steps=400):
    """A velocity step of a rigid contact: slip since the step in d_c, friction expected and computed."""
    before, after = 1e-3, 1e-2
    c, point = rate_and_state(library, evolution, alpha_t=1e9)
    dt = 1e-2 * c['d_c'] / before
    slide(point, before, dt, 5000)
    dt = 0.02 * c['d_c'] / after
    computed = numpy.array([point.shear(after * dt, dt) / PRESSURE for _ in range(steps)])
    x = 0.02 * numpy.arange(1, steps + 1)
    if evolution == 0:
        theta = c['d_c'] / after + (c['d_c'] / before - c['d_c'] / after) * numpy.exp(-x)
    else:
        theta = c['d_c'] / after * numpy.exp(numpy.log(after / before) * numpy.exp(-x))
    expected = c['a'] * numpy.arcsinh(after / (2 * c['v0'])
                                      * numpy.exp((c['f0'] + c['b'] * numpy.log(c['v0'] * theta / c['d_c'])) / c['a']))
    return x, expected, computed


def rate_and_state_transient(library, report):
    sources = ('`theta = d_c/v2 + (d_c/v1 - d_c/v2) exp(-v2 t/d_c)`', '`ln(theta v2/d_c) = ln(v2/v1) exp(-v2 t/d_c)`')
    for evolution, name in enumerate(('ageing', 'slip')):
        _, expected, computed = transient(library, evolution)
        report.curve(f'rate-and-state, {name} law: friction after a tenfold velocity step, no elasticity', sources[evolution],
                     expected, computed, 1e-6)


SUBLOADING_CONSTANTS = dict(mu_s=0.4, mu_k=0.2, kappa=10.0, xi=0.5, m=1000.0)


def subloading(library, scheme, mu_0=0.4, alpha_t=1e3, **changes):
    constants = {**SUBLOADING_CONSTANTS, **changes}
    return library.point(SUBLOADING, 1e3, alpha_t, *constants.values(), mu_0, scheme).pressed(PRESSURE)


def subloading_rest_and_steady(library, report):
    c = SUBLOADING_CONSTANTS
    expected = c['mu_s'] - (c['mu_s'] - 0.25) * numpy.exp(-c['xi'] * 3.0)
    source = '`mu_s - (mu_s - mu_0) exp(-xi t)`, theory.md 6'
    point = subloading(library, EXACT_RATE, 0.25)
    point.shear(0.0, 3.0)
    report.row('subloading: `mu` after a hold, exact-rate scheme, one increment', source, expected, point.mu, 1e-12)
    errors = []
    for steps in (200, 400):
        point = subloading(library, 0.0, 0.25)
        slide(point, 0.0, 3.0 / steps, steps)
        errors.append(point.mu - expected)
    report.row('subloading: the same by backward Euler, 400 increments', source, expected, point.mu, 1e-2)
    report.row('subloading: its error in 200 increments over that in 400', 'first order: 2', 2.0, errors[0] / errors[1], 2e-2)
    for rate in (1e-3, c['xi'] / c['kappa'], 1.0):
        rest = (c['kappa'] * rate * c['mu_k'] + c['xi'] * c['mu_s']) / (c['kappa'] * rate + c['xi'])
        for scheme, name in ((0.0, 'backward Euler'), (EXACT_RATE, 'exact-rate')):
            point = subloading(library, scheme)
            slide(point, rate, 0.05 / (c['kappa'] * rate + c['xi']), 1500)
            report.row(f'subloading: steady friction at v = {rate:g}, {name}',
                       '`(kappa v mu_k + xi mu_s)/(kappa v + xi)`, theory.md 6', rest, point.traction[1] / PRESSURE, 1e-11)
    # from one steady state to another, rigid: R is 1 by then
    before, after = 0.01, 0.1
    point = subloading(library, EXACT_RATE, alpha_t=1e9)
    slide(point, before, 0.1, 1000)
    speed = c['kappa'] * after + c['xi']
    times = 0.05 * numpy.arange(1, 101)
    computed = [point.shear(after * 0.05, 0.05) / PRESSURE for _ in times]
    steady = [(c['kappa'] * v * c['mu_k'] + c['xi'] * c['mu_s']) / (c['kappa'] * v + c['xi']) for v in (before, after)]
    report.curve('subloading: friction after a tenfold velocity step, exact-rate', '`exp(-(kappa v + xi) t)`, theory.md 6',
                 steady[1] + (steady[0] - steady[1]) * numpy.exp(-speed * times), computed, 1e-7)


def li(x):
    return expi(numpy.log(x))


def loading(library, scheme, steps, shift=0.03, alpha_t=1e3, m=200.0):
    """Sheared from a virgin state: slip and R after each increment."""
    point = subloading(library, scheme, alpha_t=alpha_t, m=m)
    rows = []
    for _ in range(steps):
        point.shear(shift / steps, 1e-3)
        rows.append((point.slip, point.internal))
    return numpy.array(rows).T


def similarity_ratio(library, report):
    m, first = 200.0, 20
    slip, ratio = loading(library, EXACT_RATE, 300)
    inside = slice(first, int(numpy.searchsorted(ratio, 0.999)))   # beyond, li is too steep to tell
    report.curve('subloading: `(li(R) - li(R_0) + m s)/(m s)` along a loading path, exact-rate', '`li(R) = li(R_0) - m s`: 0',
                 numpy.zeros(len(slip[inside])),
                 (li(ratio[inside]) - li(ratio[first - 1]) + m * (slip[inside] - slip[first - 1])) / (m * slip[inside]), 1e-10)


ASSOCIATED, RADIAL = 0.0, 1.0
MU_RATIO = 0.5


def steady_traction(mu, direction, angles):
    """Of sliding at angles to axis 1 of a surface with two coefficients: components along the axes."""
    c, s = numpy.cos(angles), numpy.sin(angles)
    if direction == ASSOCIATED:
        return mu * PRESSURE * numpy.array([c, MU_RATIO**2 * s]) / numpy.hypot(c, MU_RATIO * s)
    return mu * PRESSURE * numpy.array([c, s]) / numpy.hypot(c, s / MU_RATIO)


def slide_at(point, angle, rate, dt=2.0, steps=100):
    for _ in range(steps):
        point.update(0.0, rate * dt * numpy.cos(angle), rate * dt * numpy.sin(angle), dt)
    return point.traction[1:3]


def orthotropic(library, report):
    angles = numpy.radians(numpy.arange(0, 360, 15))
    c, rate = SUBLOADING_CONSTANTS, 0.05
    steady = (c['kappa'] * rate * c['mu_k'] + c['xi'] * c['mu_s']) / (c['kappa'] * rate + c['xi'])
    sources = {ASSOCIATED: '`mu p (v_1, rho^2 v_2)/sqrt(v_1^2 + rho^2 v_2^2)`, theory.md 9',
               RADIAL: '`mu p v/sqrt(v_1^2 + (v_2/rho)^2)`, theory.md 9'}
    for direction, name in ((ASSOCIATED, 'associated'), (RADIAL, 'radial')):
        options = (0.0, MU_RATIO, direction)   # no shear cap
        laws = {'Coulomb': (0.3, (COULOMB, 1e3, 1e3, 0.3, *options)),
                'subloading': (steady, (SUBLOADING, 1e3, 1e3, *c.values(), c['mu_s'], 0.0, 0.0, *options))}
        for law, (mu, props) in laws.items():
            computed = [list(slide_at(library.point(*props).pressed(PRESSURE), angle, rate)) for angle in angles]
            for i, curves in enumerate(zip(steady_traction(mu, direction, angles), numpy.transpose(computed)), 1):
                report.curve(f'{law}, `mu_2 = mu_1/2`, {name}: steady sliding at 0 to 345 degrees, traction along axis {i}',
                             sources[direction], *curves, 1e-11)


def draw_directions(library, axis):
    angles = numpy.radians(numpy.linspace(0, 90, 10))
    fine = numpy.radians(numpy.linspace(0, 90, 200))
    for direction, name in ((ASSOCIATED, 'associated'), (RADIAL, 'radial')):
        tractions = [list(slide_at(library.point(COULOMB, 1e3, 1e3, 0.3, 0.0, MU_RATIO, direction).pressed(PRESSURE), angle, 0.05))
                     for angle in angles]
        expected = steady_traction(0.3, direction, fine)
        axis.plot(numpy.degrees(fine), numpy.degrees(numpy.arctan2(expected[1], expected[0])), 'k-')
        axis.plot(numpy.degrees(angles), [numpy.degrees(numpy.arctan2(second, first)) for first, second in tractions], 'o',
                  color=f'C{int(direction) + 1}', label=name)
    axis.set(xlabel='sliding, angle to axis 1 [degrees]', ylabel='traction, angle to axis 1 [degrees]', title='Coulomb, mu_2 = mu_1/2')


def draw(library, report):
    figure, axes = plot.subplots(1, 4, figsize=(16, 3.6))
    rates = numpy.logspace(-2, 1.5, 15)
    computed = []
    for rate in rates:
        point = library.point(STATIC_KINETIC, 1e3, 1e6, 0.4, 0.2, 0.5).pressed(PRESSURE)
        computed.append(slide(point, rate, 1e-3 / rate, 500) / PRESSURE)
    fine = numpy.logspace(-2, 1.5, 200)
    axes[0].semilogx(fine, 0.2 + 0.2 * numpy.exp(-0.5 * fine), 'k-', label='closed form')
    axes[0].semilogx(rates, computed, 'o', color='C1', label='library')
    axes[0].set(xlabel='slip rate [L/T]', ylabel='friction coefficient [-]', title='static-kinetic decay')
    for evolution, name in enumerate(('ageing', 'slip')):
        x, expected, computed = transient(library, evolution)
        axes[1].plot(x, expected, 'k-')
        axes[1].plot(x[::15], computed[::15], 'o', color=f'C{evolution + 1}', label=f'{name} law')
    axes[1].set(xlabel='slip since the step over d_c [-]', ylabel='friction coefficient [-]', title='rate-and-state, tenfold velocity step')
    slip, ratio = loading(library, EXACT_RATE, 300)
    grid = numpy.linspace(1e-3, 0.999, 400)
    axes[2].plot(-li(grid) / 200.0, grid, 'k-', label='li(R) = -m s')
    axes[2].plot(slip[::6], ratio[::6], 'o', color='C1', label='library')
    axes[2].set(xlabel='slip [L]', ylabel='R [-]', xlim=(0, 0.02), title='subloading, first loading')
    draw_directions(library, axes[3])
    for axis in axes:
        axis.legend()
        axis.grid(alpha=0.3)
    report.picture(figure, 'closed_forms', 'Closed forms and the library')
