"""Spring-slider with rate-and-state friction, without inertia, against scipy's LSODA and Radau."""
import matplotlib.pyplot as plot
import numpy
from scipy.integrate import solve_ivp

# um, s, and stresses in units of the normal traction
A, B, D_C, F0, V0 = 0.005, 0.01, 10.0, 0.6, 1.0
# Of drive spring and contact in series [1/um]. By the slip law a tenfold velocity step makes the block run away even at twice
# the critical stiffness.
STIFFNESS = {'ageing': 1e-3, 'slip': 5e-3}
CONTACT = 1.0    # of the contact alone [1/um]
TRACKS = {
    'velocity step': ([1.0, 10.0], [1500.0, 100.0]),
    'slide-hold-slide': ([1.0, 0.0, 1.0, 0.0, 1.0], [1500.0, 100.0, 600.0, 1000.0, 600.0]),
}
SHOWN = {'velocity step': (1490, 1530), 'slide-hold-slide': (1450, 3800)}
EVOLUTIONS = ('ageing', 'slip')


def program_run(program, evolution, track, interval=1, **time):
    velocities, durations = TRACKS[track]
    rows, _ = program.run(
        friction={'law': 'rate_and_state', 'alpha_n': 1.0, 'alpha_t': CONTACT, 'a': A, 'b': B, 'd_c': D_C, 'v0': V0, 'f0': F0,
                  'evolution': evolution},
        slider={'mass': 0.0, 'stiffness': 1 / (1 / STIFFNESS[evolution] - 1 / CONTACT), 'normal_traction': 1.0},
        drive={'velocity': velocities, 'duration': durations},
        time={'t_end': sum(durations), 'tolerance': 1e-13, **time}, output={'interval': interval})
    return rows['time'], rows['friction_force']


def reference(evolution, track, times, method='LSODA'):
    """Friction at given times: the same spring, contact and law as two differential equations in tau and ln(theta)."""
    velocities, durations = TRACKS[track]
    stiffness = STIFFNESS[evolution]

    def rates(_, y, drive):
        tau, ln_theta = y
        tau, ln_theta = max(-1.0, min(tau, 1.0)), max(-30.0, ln_theta)   # beyond, where only guesses go, numbers would overflow
        slip_rate = 2 * V0 * numpy.sinh(tau / A) * numpy.exp(-(F0 + B * (numpy.log(V0 / D_C) + ln_theta)) / A)
        x = slip_rate * numpy.exp(ln_theta) / D_C
        if evolution == 'ageing':
            return stiffness * (drive - slip_rate), numpy.exp(-ln_theta) - slip_rate / D_C
        return stiffness * (drive - slip_rate), -slip_rate / D_C * numpy.log(x) if x > 0 else 0.0

    state, start, found = [0.0, numpy.log(D_C / V0)], 0.0, []
    for drive, duration in zip(velocities, durations):
        end = start + duration
        at = times[(times > start * (1 + 1e-12)) & (times <= end * (1 + 1e-12))]
        solution = solve_ivp(rates, (start, end), state, method, at if at.size and at[-1] >= end * (1 - 1e-12)
                             else numpy.append(at, end), args=(drive,), rtol=1e-11, atol=1e-13, first_step=1e-6)
        if not solution.success:
            raise RuntimeError(solution.message)
        found.extend(solution.y[0][:at.size])
        state, start = solution.y[:, -1], end
    return numpy.array(found)


def validate(program, report):
    report.section('Rate-and-state friction on a spring', f"""
Quasi-static (`mass = 0`), `f0 = {F0}`, `a = {A}`, `b = {B}`, `d_c = {D_C:g}` um, stiffness of the normal traction {STIFFNESS['ageing']:g}/um
with the ageing law, {STIFFNESS['slip']:g}/um with the slip law (the critical one is {(B - A) / D_C:g}); the contact spring ({CONTACT:g}/um) counts in series. The whole history, from
a slack spring on, is solved as two ordinary differential equations by scipy's LSODA at a tolerance of 1e-11. Differences are in the friction
coefficient, and the largest of the whole run.""")
    figure, axes = plot.subplots(2, 2, figsize=(12, 7), sharey='row')
    checked = False
    for row, track in enumerate(TRACKS):
        for column, evolution in enumerate(EVOLUTIONS):
            dt = 2e-3
            times, found = program_run(program, evolution, track, dt=dt, interval=250)
            times, found = times[1:], found[1:]
            adaptive = program_run(program, evolution, track, rtol=1e-7)
            every, at = numpy.unique(numpy.concatenate([times, adaptive[0][1:]]), return_inverse=True)
            whole = reference(evolution, track, every)[at]
            expected, expected_adaptive = whole[:len(times)], whole[len(times):]
            if not checked:
                other = reference(evolution, track, times, 'Radau')
                report.row('the reference itself: LSODA against Radau, largest difference', 'scipy', 0.0,
                           numpy.max(abs(other - expected)), 1e-8, absolute=True)
                checked = True
            error = numpy.max(abs(found - expected))
            name = f'{track}, {evolution} law'
            late = adaptive[0][1:] > 1500.0
            report.row(f'{name}: peak of the friction, rtol = 1e-7', 'LSODA', max(expected_adaptive[late]),
                       max(adaptive[1][1:][late]), 1e-6)
            report.row(f'{name}: whole curve, dt = {dt:g} s', 'LSODA: 0', 0.0, error, 5e-5, absolute=True)
            coarse = program_run(program, evolution, track, dt=2 * dt, interval=125)[1][1:]
            report.row(f'{name}: error with twice the step over that', 'first order: 2', 2.0, numpy.max(abs(coarse - expected)) / error,
                       5e-2)
            report.row(f'{name}: whole curve, rtol = 1e-7 ({len(adaptive[0]) - 1} steps)', 'LSODA: 0', 0.0,
                       numpy.max(abs(adaptive[1][1:] - expected_adaptive)), 1e-6, absolute=True)
            axis = axes[row, column]
            axis.plot(adaptive[0][1:], expected_adaptive, 'k-', linewidth=3, alpha=0.4, label='LSODA, 1e-11')
            axis.plot(adaptive[0], adaptive[1], 'C1-', linewidth=1, label='stickslip')
            axis.set(xlabel='time [s]', ylabel='friction coefficient', title=name, xlim=SHOWN[track], ylim=(0.57, 0.65))
            axis.grid(alpha=0.3)
            axis.legend()
    report.picture(figure, 'rate_and_state', 'Velocity steps and holds')
