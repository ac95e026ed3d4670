"""Orders of convergence of the two schemes of the subloading law, against an explicit solution of order 8."""
import matplotlib.pyplot as plot
import numpy
from scipy.integrate import solve_ivp

MASS, SPRING, DAMPING, RATE, NORMAL = 1e-3, 1.0, 0.01, 1.0, 10.0
CONTACT, MU_S, MU_K, KAPPA, XI, M = 1000.0, 0.4, 0.2, 10.0, 10.0, 1000.0
END = 6.0


def motion(time, y):
    """x, v, traction, mu and R: loading throughout, up to the first fall of the spring force."""
    x, v, traction, mu, ratio = y
    log_ratio = numpy.log(max(ratio, 1e-300))
    hardening = NORMAL * (-M * log_ratio * mu - ratio * KAPPA * (mu - MU_K))
    slip_rate = max(0.0, (CONTACT * v - NORMAL * ratio * XI * (MU_S - mu)) / (CONTACT + hardening))
    traction_rate = CONTACT * (v - slip_rate)
    mu_rate = -KAPPA * (mu - MU_K) * slip_rate + XI * (MU_S - mu)
    ratio_rate = -M * log_ratio * slip_rate if slip_rate > 0 else traction_rate / (mu * NORMAL) - ratio * mu_rate / mu
    return v, (SPRING * (RATE * time - x) - DAMPING * v - traction) / MASS, traction_rate, mu_rate, ratio_rate


def reference():
    """Time and force of the first peak of the spring force: where the block overtakes the drive."""
    def overtakes(_, y):
        return y[1] - RATE

    overtakes.direction, overtakes.terminal = 1, True
    solution = solve_ivp(motion, (0.0, END), [0.0, 0.0, 0.0, MU_S, 0.0], 'DOP853', events=lambda t, y: overtakes(t, y) if t > 1
                         else -1.0, rtol=1e-12, atol=1e-14)
    events = solution.t_events[0]
    if not events.size:
        raise RuntimeError('the reference finds no slip event')
    state = solution.y_events[0][0]
    return events[0], SPRING * (RATE * events[0] - state[0])


def peak(rows):
    """The largest spring force, by the cubic through two rows and their velocities."""
    force, slope = rows['spring_force'], SPRING * (RATE - rows['velocity'])
    k = numpy.flatnonzero((slope[:-1] > 0) & (slope[1:] <= 0) & (rows['time'][:-1] > 1.0))[0]
    h = rows['time'][k + 1] - rows['time'][k]
    s = numpy.linspace(0.0, 1.0, 20001)
    values = (force[k] * (1 + 2 * s) * (1 - s)**2 + h * slope[k] * s * (1 - s)**2
              + force[k + 1] * s**2 * (3 - 2 * s) - h * slope[k + 1] * s**2 * (1 - s))
    return values.max()


def errors(program, scheme, steps, expected):
    """Errors of the first event's time and of the peak force, for each step."""
    found = []
    for dt in steps:
        rows, events = program.run(
            friction={'law': 'subloading', 'alpha_n': 1000.0, 'alpha_t': CONTACT, 'mu_s': MU_S, 'mu_k': MU_K, 'kappa': KAPPA,
                      'xi': XI, 'm': M, 'scheme': scheme},
            slider={'mass': MASS, 'stiffness': SPRING, 'damping': DAMPING, 'normal_traction': NORMAL},
            drive={'velocity': RATE}, time={'t_end': END, 'dt': dt, 'tolerance': 1e-13})
        found.append((abs(events['onset'][0] - expected[0]), abs(peak(rows) - expected[1])))
    return numpy.array(found).T


def validate(program, report):
    expected = reference()
    report.section('Orders of convergence', f"""
The reference problem (`M = {MASS:g}`, `K = {SPRING:g}`, `C = {DAMPING:g}`, `V = {RATE:g}`, normal traction {NORMAL:g}, `alpha_t = {CONTACT:g}`, `mu_s = {MU_S}`,
`mu_k = {MU_K}`, `kappa = {KAPPA:g}`, `xi = {XI:g}`, `m = {M:g}`) with fixed steps and Newmark's method, against scipy's DOP853 at 1e-12: first
slip event at {expected[0]:.9f}, peak force {expected[1]:.9f}. The order is the slope of a line through the logarithms of the errors.""")
    steps = numpy.array([4e-4, 2e-4, 1e-4, 5e-5])
    figure, axes = plot.subplots(1, 2, figsize=(10, 4))
    for scheme, order, least in (('backward_euler', 1.0, 0.1), ('exact_rate', 2.0, 0.1)):
        name = scheme.replace('_', ' ')
        found = errors(program, scheme, steps, expected)
        for axis, values, what, unit in zip(axes, found, ('event time', 'peak force'), 'TF'):
            slope = numpy.polyfit(numpy.log(steps), numpy.log(values), 1)[0]
            report.row(f'{name}: order in the {what}; error {values[-1]:.0e} at dt = {steps[-1]:g}', 'DOP853', order, slope, least,
                       absolute=True)
            axis.loglog(steps, values, 'o-', label=f'{name}, order {slope:.2f}')
            axis.set(xlabel='step [T]', ylabel=f'error of the {what} [{unit}]')
            axis.set_xticks(steps, [f'{dt:g}' for dt in steps])
            axis.set_xticks([], minor=True)
            axis.grid(alpha=0.3, which='both')
            axis.legend()
    report.picture(figure, 'orders', 'Error over the step')
