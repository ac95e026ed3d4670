"""Spring-slider with inertia under rate-and-state friction with flash heating, against scipy's Radau."""
import matplotlib.pyplot as plot
import numpy
from library import FLASH_HEATING
from scipy.integrate import solve_ivp

# of inputs/flash_heating.nml: MN, m, s
A, B, D_C, V0, F0, F_W, V_W, N = 0.01, 0.014, 1e-3, 1e-6, 0.6, 0.2, 0.1, 8.0
MASS, STIFFNESS, DAMPING, NORMAL, ALPHA, DRIVE = 0.2, 20.0, 5.0, 50.0, 1e4, 1e-3
T_END = 2000.0


def steady(v):
    """As the references write it: f_LV is not regularised."""
    low = F0 + (A - B) * numpy.log(v / V0)
    return F_W + (low - F_W) / (1 + (v / V_W)**N)**(1 / N)


def reference():
    """One event: extension of the spring, velocity, elastic displacement of the contact, and psi, as differential equations."""

    def rates(_, y):
        extension, velocity, elastic, psi = y
        tau = ALPHA * elastic
        # ln(2 sinh) from tau/(a p) on, where that is all
        v = V0 * numpy.exp(tau / (A * NORMAL) - psi / A) * -numpy.expm1(-2 * tau / (A * NORMAL))
        f = steady(max(v, 1e-30))
        psi_ss = A * (numpy.log(V0 / max(v, 1e-30)) + f / A + numpy.log1p(-numpy.exp(-2 * f / A)))
        return (DRIVE - velocity, (STIFFNESS * extension - DAMPING * velocity - tau) / MASS, velocity - v,
                -v / D_C * (psi - psi_ss))

    with numpy.errstate(over='ignore'):   # of guesses far off
        return solve_ivp(rates, (0, T_END), [0.0, 0.0, 0.0, F0], 'Radau', rtol=1e-9, atol=[1e-11, 1e-11, 1e-13, 1e-11])


def validate(library, program, report):
    report.section('Flash heating', f"""
Steady friction against the published form, whose `f_LV` is a logarithm (laws.md 7); and the block of `inputs/flash_heating.nml`, on springs
and with its mass, up to {T_END:g} s, which is one event. Reference: psi, traction and motion as four differential equations, by scipy's Radau at a tolerance
of 1e-9.""")
    for rate in (1e-9, 1e-3, 0.1, 1.0, 10.0):
        point = library.point(FLASH_HEATING, 1e4, 1e6, A, B, D_C, V0, F0, F_W, V_W, N).pressed(NORMAL)
        for _ in range(1500):
            traction = point.shear(0.05 * D_C, 0.05 * D_C / rate)
        report.row(f'flash heating: steady friction at v = {rate:g} m/s',
                   '`f_w + (f_LV - f_w)/(1 + (v/v_w)^8)^(1/8)`, Noda et al. 2009', steady(rate), traction / NORMAL, 1e-11)
    rows, events = program.run(
        friction={'law': 'flash_heating', 'alpha_n': ALPHA, 'alpha_t': ALPHA, 'a': A, 'b': B, 'd_c': D_C, 'v0': V0, 'f0': F0,
                  'f_w': F_W, 'v_w': V_W},
        slider={'mass': MASS, 'stiffness': STIFFNESS, 'damping': DAMPING, 'normal_traction': NORMAL},
        drive={'velocity': DRIVE}, time={'t_end': T_END, 'rtol': 1e-8}, output={'interval': 1})
    expected = reference()
    force = STIFFNESS * expected.y[0]
    peak = expected.t[numpy.argmax(force)]
    found = rows['time'][numpy.argmax(rows['spring_force'])]
    report.row('flash heating: time of the largest spring force [s]', 'Radau', peak, found, 1e-4)
    report.row('flash heating: largest slip rate of the block [m/s]', 'Radau', max(expected.y[1]), max(rows['velocity']), 1e-4)
    report.row('flash heating: stress drop [MPa]', 'Radau', max(force) - min(force[expected.t > peak]), events['stress_drop'][0], 1e-5)
    report.row('flash heating: spring force at the end [MN]', 'Radau', force[-1], rows['spring_force'][-1], 1e-5)
    figure, axes = plot.subplots(1, 2, figsize=(12, 4))
    rates = numpy.logspace(-9, 1, 200)
    axes[0].semilogx(rates, steady(rates))
    axes[0].set(xlabel='slip rate [m/s]', ylabel='steady friction coefficient', ylim=(0, 0.7))
    axes[1].plot(expected.t - peak, expected.y[1], 'k-', linewidth=3, alpha=0.4, label='Radau, 1e-9')
    axes[1].plot(rows['time'] - peak, rows['velocity'], 'C1-', linewidth=1, label='stickslip')
    axes[1].set(xlabel='time since the largest force [s]', ylabel='velocity [m/s]', xlim=(-0.2, 1.2))
    axes[1].legend()
    for axis in axes:
        axis.grid(alpha=0.3)
    report.picture(figure, 'flash_heating', 'Steady friction, and the velocity of the block in its event')
