"""Options of every law: cohesion and the damper beside the contact spring, against closed forms and scipy."""
import matplotlib.pyplot as plot
import numpy
from library import COULOMB, RATE_AND_STATE, SLIP_WEAKENING, STATIC_KINETIC, SUBLOADING
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

COHESION, STIFF = 0.7, 1e7
OFF = (0.0, 1.0, 0.0)   # cap, ratio of coefficients, direction
# law: its constants, and the friction coefficient of steady sliding at the rate 1
LAWS = {
    'Coulomb': ((COULOMB, 1e3, STIFF, 0.3), 0.3),
    'static-kinetic': ((STATIC_KINETIC, 1e3, STIFF, 0.4, 0.2, 0.5), 0.2 + 0.2 * numpy.exp(-0.5)),
    'rate-and-state': ((RATE_AND_STATE, 1e3, STIFF, 0.01, 0.015, 1.0, 1.0, 0.6, 0.0, 1.0), 0.01 * numpy.arcsinh(0.5 * numpy.exp(60))),
    'slip-weakening': ((SLIP_WEAKENING, 1e3, STIFF, 0.5, 0.3, 0.02), 0.3),
    'subloading': ((SUBLOADING, 1e3, STIFF, 0.45, 0.25, 10.0, 0.0, 1e3, 0.45, 0.0, 0.0), 0.25),
}
# a slider for N, mm and s
MASS, SPRING, AREA, CONTACT = 1e-3, 1.0, 1.0, 1000.0


def validate(library, program, report):
    report.section('Cohesion', f"""
`resistance = mu f_n + c` (theory.md 15) with c = {COHESION:g}: steady sliding at pressures from 0 on, and a block that is pulled at zero pressure, where cohesion is all
there is: a constant friction force, so that it goes on in half waves, `K e = c S + V sqrt(K M) sin(omega (t - t_0))`.""")
    for name, (props, mu) in LAWS.items():
        strength(library, report, name, props, mu)
    pulled_without_pressure(program, report)
    report.section('A damper beside the contact spring', """
`T = alpha_t u_e + eta_t u_e'` (theory.md 16). A block that sticks is a damped oscillator; dragged faster than `mu p/eta_t` from rest, the damper
carries what friction lets it, while the spring takes over; a block under static-kinetic friction rings down after its jump, where scipy's Radau
integrates velocity, spring and contact with the slip rate as the root of a balance.""")
    stuck(program, report)
    dragged(library, report)
    ringing(program, report)


def strength(library, report, name, props, mu):
    computed, expected = [], []
    for pressure in (0.0, 0.1, 1.0, 10.0):
        point = library.point(*props, *OFF, COHESION).pressed(pressure)
        for _ in range(2000):
            point.shear(0.05, 0.05)
        computed.append(point.traction[1])
        expected.append(mu * pressure + COHESION)
    report.curve(f'cohesion, {name}: traction of steady sliding at pressures of 0 to 10', '`mu f_n + c`, theory.md 15', numpy.array(expected),
                 numpy.array(computed), 1e-9)


def pulled_without_pressure(program, report):
    rate, friction = 10.0, {'law': 'coulomb', 'alpha_n': 1e3, 'alpha_t': CONTACT, 'mu': 0.3, 'cohesion': COHESION, 'contact': 'rigid'}
    rows, _ = program.run(friction=friction, slider={'mass': MASS, 'stiffness': SPRING, 'normal_traction': 1.0},
                          drive={'velocity': [rate], 'duration': [9.0], 'normal': [0.0]}, time={'t_end': 0.4, 'rtol': 1e-10}, output={'interval': 1})
    omega, start = numpy.sqrt(SPRING / MASS), COHESION * AREA / (SPRING * rate)
    t, force = rows['time'], rows['spring_force']
    # the block stops when its velocity is zero again: a whole wave after it began
    within = t < start + 2 * numpy.pi / omega
    expected = numpy.where(t < start, SPRING * rate * t, COHESION * AREA + rate * numpy.sqrt(SPRING * MASS) * numpy.sin(omega * (t - start)))
    report.curve('cohesion: spring force of a block pulled at zero pressure, rigid contact, rtol = 1e-10', '`c S + V sqrt(K M) sin(omega (t - t_0))`',
                 expected[within], force[within], 1e-7)


def stuck(program, report):
    v0, eta = 0.1, 0.2
    natural = numpy.sqrt((SPRING + AREA * CONTACT) / MASS)
    ratio = eta * AREA / (2 * MASS * natural)
    damped = natural * numpy.sqrt(1 - ratio**2)
    groups = {'friction': {'law': 'coulomb', 'alpha_n': 1e3, 'alpha_t': CONTACT, 'mu': 0.4, 'eta_t': eta},
              'slider': {'mass': MASS, 'stiffness': SPRING, 'normal_traction': 10.0}, 'drive': {'velocity': 0.0},
              'initial': {'velocity': v0}, 'output': {'interval': 1}}

    def motion(t):
        return v0 / damped * numpy.exp(-ratio * natural * t) * numpy.sin(damped * t)

    def peaks(rows):
        """Heights of the maxima of the displacement, by parabolas."""
        x = rows['displacement']
        top = numpy.flatnonzero((x[1:-1] > x[:-2]) & (x[1:-1] >= x[2:])) + 1
        return [x[i] - (x[i + 1] - x[i - 1])**2 / (8 * (x[i + 1] - 2 * x[i] + x[i - 1])) for i in top]

    decrement, errors = 2 * numpy.pi * ratio / numpy.sqrt(1 - ratio**2), []
    for dt in (2e-5, 1e-5):
        rows, _ = program.run(**groups, time={'t_end': 0.05, 'dt': dt})
        high, t = peaks(rows), rows['time']
        errors.append(numpy.max(abs(rows['displacement'] - motion(t))))
    report.row('damper: logarithmic decrement of a block that sticks, dt = 1e-5', '`2 pi z/sqrt(1 - z^2)`, `z = eta_t S/(2 sqrt(k M))`', decrement,
               numpy.log(high[0] / high[4]) / 4, 1e-2)
    report.row('damper: displacement of the block, error at dt = 2e-5 over that at half of it', 'first order: 2', 2.0, errors[0] / errors[1], 5e-2)
    rows, _ = program.run(**groups, time={'t_end': 0.05, 'rtol': 1e-10})
    report.curve('damper: displacement of the block, rtol = 1e-10', '`(v_0/omega_d) exp(-z omega t) sin(omega_d t)`',
                 motion(rows['time']), rows['displacement'], 1e-10)


def dragged(library, report):
    alpha, eta, mu, pressure, dt = 1e3, 10.0, 0.3, 10.0, 1e-6
    point = library.point(COULOMB, 1e3, alpha, mu, *OFF, 0.0, eta).pressed(pressure)
    elastic, traction = [], []
    for _ in range(20000):
        traction.append(point.shear(2.0 * dt, dt))
        elastic.append(point.statev[2])
    t = dt * numpy.arange(1, 20001)
    report.curve('damper: traction of a contact that is dragged from rest at 2 > mu p/eta_t', '`mu p`', numpy.full(t.size, mu * pressure),
                 numpy.array(traction), 1e-12)
    report.curve('damper: what the spring carries of it, dt = 1e-6', '`mu p (1 - exp(-alpha_t t/eta_t))`', mu * pressure * (1 - numpy.exp(-alpha * t / eta)),
                 alpha * numpy.array(elastic), 1e-3)


def ringing(program, report):
    mu_s, mu_k, decay, eta, pressure, rate, t_end = 0.4, 0.2, 0.02, 0.1, 10.0, 1.0, 4.6

    def slip_rate(push):
        """The least slip rate >= 0 with push - eta s = mu(s) p."""
        if push <= mu_s * pressure:
            return 0.0
        return brentq(lambda s: push - eta * s - pressure * (mu_k + (mu_s - mu_k) * numpy.exp(-decay * s)), 0.0, push / eta, xtol=1e-15, rtol=1e-14)

    def rates(t, y):
        e, v, u = y
        push = CONTACT * u + eta * v
        slip = numpy.sign(push) * slip_rate(abs(push))
        return rate - v, (SPRING * e - AREA * (push - eta * slip)) / MASS, v - slip

    solution = solve_ivp(rates, (0, t_end), [0.0, 0.0, 0.0], 'Radau', rtol=1e-9, atol=1e-11, max_step=2e-3, dense_output=True)
    rows, _ = program.run(friction={'law': 'static_kinetic', 'alpha_n': 1e3, 'alpha_t': CONTACT, 'mu_s': mu_s, 'mu_k': mu_k, 'd_c': decay, 'eta_t': eta},
                          slider={'mass': MASS, 'stiffness': SPRING, 'normal_traction': pressure}, drive={'velocity': rate},
                          time={'t_end': t_end, 'rtol': 1e-9}, output={'interval': 1})
    t = rows['time']
    expected = solution.sol(t)
    report.row('damper: velocity after the jump of static-kinetic friction, rtol = 1e-9, largest difference [mm/s]', 'Radau: 0', 0.0,
               numpy.max(abs(rows['velocity'] - expected[1])), 1e-3, absolute=True)
    figure, axes = plot.subplots(figsize=(9, 4))
    axes.plot(t, expected[1], 'k-', linewidth=3, alpha=0.4, label='Radau, 1e-9')
    axes.plot(t, rows['velocity'], 'C1-', linewidth=1, label='stickslip')
    onset = t[numpy.argmax(rows['velocity'] > 2.0)]
    axes.set(xlabel='time [s]', ylabel='velocity of the block [mm/s]', xlim=(onset - 0.02, onset + 0.25))
    axes.grid(alpha=0.3)
    axes.legend()
    report.picture(figure, 'damper', 'A slip event under static-kinetic friction, and the damped ringing of the contact after it')
