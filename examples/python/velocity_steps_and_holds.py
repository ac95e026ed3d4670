#!/usr/bin/env python3
"""What an experimenter reads off rate-and-state friction: a velocity step, and healing against the time of a hold.

The slider has no inertia, a stiff spring and a rigid contact. Needs the package stickslip with pandas and matplotlib.
"""
import matplotlib
import numpy as np

import stickslip

matplotlib.use('Agg')
import matplotlib.pyplot as plt  # noqa: E402

# um, s; friction is force over normal force, so that 1 is as good a normal traction as any
A, B, D_C, V0, F0 = 0.010, 0.014, 5.0, 1.0, 0.6
HOLDS = [10.0, 30.0, 100.0, 300.0, 1000.0]


def slide(velocity, duration):
    """The run of a drive by pieces, from steady sliding at V0."""
    return stickslip.run({
        'friction': {'law': 'rate_and_state', 'alpha_n': 1.0, 'alpha_t': 1.0, 'a': A, 'b': B, 'd_c': D_C, 'v0': V0, 'f0': F0,
                     'contact': 'rigid'},
        'slider': {'mass': 0.0, 'stiffness': 0.1, 'normal_traction': 1.0},
        'initial': {'mu': F0},
        'drive': {'velocity': velocity, 'duration': duration},
        'time': {'t_end': sum(duration), 'rtol': 1e-7}})


step = slide([V0, 10 * V0], [20.0, 20.0])
a_minus_b = step.pieces['a_minus_b'].iloc[-1]
print(f'velocity step: a - b = {a_minus_b:.5f}, put in {A - B:.5f}')

velocity, duration = [V0], [100.0]
for hold in HOLDS:
    velocity += [0.0, V0]
    duration += [hold, 100.0]
holds = slide(velocity, duration).pieces.dropna(subset=['healing'])
slope = np.polyfit(np.log(holds['hold_time'].iloc[-3:]), holds['healing'].iloc[-3:], 1)[0]
print(f'healing: {slope:.4f} for each factor e of the hold, for long holds about b = {B}')

figure, (above, below) = plt.subplots(2, 1, figsize=(6, 7), layout='constrained')
above.plot(step.table['time'], step.table['friction_force'])
above.set(xlabel='time [s]', ylabel='friction coefficient', title=f'from {V0:g} to {10 * V0:g} um/s')
below.semilogx(holds['hold_time'], holds['healing'], 'o-')
below.set(xlabel='time of the hold [s]', ylabel='healing')
figure.savefig('velocity_steps_and_holds.png', dpi=120)
print('picture: velocity_steps_and_holds.png')
