"""How honest the error bars of `stickslip.fit_rate_and_state` are: two velocity steps, or one, from an independent solver, with noise.

Usage, after ./dev test: build/python/bin/python bench/rate_state_errors.py [RECORDS [KIND...]]. Two to five seconds a fit. Says for
each kind and constant the mean and the root mean square of errors in standard deviations (those of the side on which the true
value lies), how many lie in their intervals of 68 and 95 %, and what was warned of.
"""
import collections
import re
import sys

import numpy as np
from fit_errors import coloured, flicker
from scipy.integrate import solve_ivp

import stickslip

TRUE = {'a': 0.01, 'b': 0.014, 'd_c': 5.0, 'stiffness': 0.02}
TIME, NOISE = np.arange(0.0, 130.0, 0.1), 2e-4
PROGRAMMES = {'': ([40.0, 80.0], [3.0, 10.0, 3.0]), 'one': ([60.0], [3.0, 10.0]), 'hold': ([40.0, 80.0], [3.0, 0.0, 3.0])}


def friction_of(time, changes, velocity):
    """d(friction)/dt = k (v - V), friction = f0 + a ln(V/v0) + b ln(theta v0/d_c), by scipy's solver."""
    a, b, d_c, stiffness = TRUE.values()
    found, state = np.empty_like(time), [0.6, np.log(d_c / velocity[0])]
    for begin, end, drive in zip([time[0], *changes], [*changes, time[-1]], velocity):
        def rates(_, y, drive=drive):
            slip = velocity[0] * np.exp((y[0] - 0.6 - b * (y[1] - np.log(d_c / velocity[0]))) / a)
            return [stiffness * (drive - slip), np.exp(-y[1]) - slip / d_c]
        inner = (time >= begin) & (time <= end)
        run = solve_ivp(rates, (begin, end), state, method='LSODA', rtol=1e-9, atol=1e-11, dense_output=True)
        found[inner], state = run.sol(time[inner])[0], run.y[:, -1]
    return found


def record(kind, draw):
    """Time, friction, and what else the fit is given."""
    name, _, number = kind.partition('@')
    programme, _, name = name.rpartition(' ')
    number, (changes, velocity) = float(number or 0.0), PROGRAMMES[programme]
    time = np.append(0.0, np.sort(draw.uniform(0.0, 130.0, TIME.size - 1))) if name == 'uneven' else TIME
    noise = {'lasting': lambda: coloured(draw, time.size, number), 'flicker': lambda: flicker(draw, time.size)}.get(
        name, lambda: draw.normal(size=time.size))()
    values = friction_of(time, changes, velocity) + NOISE * noise
    given = {'changes': np.array(changes), 'velocity': velocity}
    if name == 'late':   # the changes come earlier than they are given
        given['changes'] = given['changes'] + number
    elif name == 'bits':
        values = 1.2 / 2.0**number * np.round(values / 1.2 * 2.0**number)
    elif name == 'bend':   # of a surface or a load cell
        values = values + number * (time / time[-1])**2
    elif name == 'struck':
        values[draw.choice(time.size, int(number), replace=False)] += draw.uniform(-0.1, 0.1, int(number))
    elif name == 'displacement':
        edges = np.array([0.0, *changes, time[-1]])
        way = np.concatenate([[0.0], np.cumsum(velocity * np.diff(edges))])
        given = {'changes': changes, 'displacement': np.interp(time, edges, way) + number * draw.normal(size=time.size)}
    return time, values, given


KINDS = ('white', 'late@0.05', 'one late@0.05', 'hold late@0.05', 'displacement@0.3', 'uneven', 'bits@12', 'struck@5', 'bend@0.003',
         'lasting@0.9', 'lasting@0.99', 'flicker')


def main():
    number = int(sys.argv[1]) if len(sys.argv) > 1 else 40
    for kind in sys.argv[2:] or KINDS:
        off, told = [], collections.Counter()
        for seed in range(number):
            time, values, given = record(kind, np.random.default_rng(seed))
            fit = stickslip.fit_rate_and_state(time, values, starts=16, **given)
            errors = []
            for name, true in {**TRUE, 'a - b': TRUE['a'] - TRUE['b']}.items():
                (low, high), value = fit.intervals[name], fit.values.get(name, fit.values['a'] - fit.values['b'])
                side = high if true > value else low
                errors.append(1.96 * ((value - true) / abs(side - value) if name == 'a - b' else
                                      np.log(value / true) / abs(np.log(max(side, 1e-300) / value))))
            off.append(errors)
            told.update(re.sub(r'[-+]?\d[\d.e%+-]*', '#', warning)[:100] for warning in fit.warnings)
        print(kind, flush=True)
        for name, column in zip((*TRUE, 'a - b'), np.array(off).T):
            print(f'    {name:10s} mean {column.mean():+.2f} rms {np.sqrt(np.mean(column**2)):.2f} in intervals of 68 % '
                  f'{np.mean(np.abs(column) < 1.0):.0%}, of 95 % {np.mean(np.abs(column) < 1.96):.0%}', flush=True)
        for words, count in told.most_common():
            print(f'    {count:3d} times: {words}', flush=True)


if __name__ == '__main__':
    main()
