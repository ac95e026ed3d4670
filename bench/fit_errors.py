"""How honest the error bars of `stickslip.fit` are: two constants of seeded synthetic records of many kinds.

Usage, after ./dev test: build/python/bin/python bench/fit_errors.py [RECORDS [KIND...]]. One to four seconds a fit. Says for
each kind the mean and the root mean square of errors in standard deviations, which are 0 and 1 where error bars are right
(of 40 records: within 0.16 and 0.11), how many constants lie in their 95 % intervals, and what `fit` warned of.
"""
import collections
import re
import sys

import numpy as np

import stickslip

TRUE = {'mu_s': 0.4, 'mu_k': 0.2}
INPUT = {'friction': {'law': 'subloading', 'alpha_n': 1.0, 'alpha_t': 0.2, **TRUE, 'kappa': 3.0, 'xi': 2.0, 'm': 100.0},
         'slider': {'mass': 1e-3, 'stiffness': 1.0, 'damping': 0.02, 'area': 1000.0, 'normal_traction': 0.01},
         'drive': {'velocity': 1.0}}
SETTINGS = {'free': list(TRUE), 'bounds': {'mu_s': (0.3, 0.6), 'mu_k': (0.1, 0.29)}, 'starts': 8, 'progress': lambda text: None}
END, STEP = 17.0, 0.01
NOISE = 0.01            # of the largest force
PIECES = 100            # of a drive that changes
OTHERS = {'soft': {'kappa': 10.0, 'xi': 1.0}, 'kinetic': {'law': 'static_kinetic', 'd_c': 0.1}}
runs = {}


def force_of(law='', **changes):
    """Time and force of the model."""
    key = repr((law, changes))
    if key not in runs:
        friction = {**INPUT['friction'], **OTHERS.get(law, {})}
        if law == 'kinetic':
            friction = {name: value for name, value in friction.items() if name not in ('kappa', 'xi', 'm')}
        given = {'time': {'t_end': 1.5 * END, 'rtol': 1e-8}, 'output': {'every': 0.001}, **changes}
        table = stickslip.run({**INPUT, 'friction': friction, **given}).table
        runs[key] = table['time'].to_numpy(), table['spring_force'].to_numpy(), friction
    return runs[key]


def coloured(draw, size, last):
    """Noise of standard deviation 1 in which a sample keeps a part of the one before."""
    weights = last**np.arange(int(8.0 / (1.0 - last)) + 1) * np.sqrt(1.0 - last**2)
    return np.convolve(draw.normal(size=size + weights.size - 1), weights, 'valid')


def flicker(draw, size):
    """Noise of standard deviation 1 whose power falls with the frequency (1/f)."""
    parts = np.fft.rfft(draw.normal(size=size))
    found = np.fft.irfft(np.concatenate([[0.0], parts[1:] / np.sqrt(np.arange(1, parts.size))]), size)
    return found / found.std()


def drive(law='', velocity=0.0, normal=0.0):
    """The model's force where the drive's velocity, or the normal traction, changes by a part from start to end."""
    way = np.linspace(-0.5, 0.5, PIECES)
    given = {'velocity': (1.0 + velocity * way).tolist(), 'duration': PIECES * [END / PIECES],
             'normal': (0.01 * (1.0 + normal * way)).tolist()}
    return *force_of(law, drive=given), given


def record(kind, draw):
    """A record, and the friction of its model."""
    name, _, number = kind.partition('@')
    law, _, name = name.rpartition(' ')
    number, settings = float(number or 0.0), {}
    if name in ('drift', 'measured', 'loaded'):
        fine, force, friction, given = drive(law, **{'normal' if name == 'loaded' else 'velocity': number})
        settings = {'drive': given} if name == 'measured' else {}
    else:
        fine, force, friction = force_of(law)
    first = {'late': number, 'idle': -number}.get(name, 0.0)
    time = np.arange(first, first + END if name == 'inside' else END, STEP)
    if name == 'inside':
        time += number
    elif name == 'short':
        time = np.arange(0.0, number, STEP)
    elif name == 'coarse':
        time = np.arange(number * draw.uniform(), END, number)
    elif name == 'uneven':
        time = np.sort(draw.uniform(0.0, END, time.size))
    top = force.max()
    noise = {'lasting': lambda: coloured(draw, time.size, number), 'flicker': lambda: flicker(draw, time.size)}.get(
        name, lambda: draw.normal(size=time.size))()
    level = 0.3 * NOISE if name == 'steps' else NOISE
    values = np.interp(time, fine, force) + level * top * noise
    if name == 'steps':   # of an analog-digital converter whose range the force fills to a half
        step = 2.0 * top / 2.0**number
        values = step * np.round(values / step)
    elif name == 'cell':   # a load cell that drifts
        values = values + number * top * time / END
    elif name == 'zero':   # its zero is a wrong one
        values = values + number * top
    elif name == 'struck':   # single samples are wrong
        values[draw.choice(time.size, int(number), replace=False)] += top * draw.uniform(-1.0, 1.0, int(number))
    return stickslip.Record(time, values, settings), friction


KINDS = ('even', 'late@0.02', 'late@0.15', 'late@0.5', 'late@1.5', 'inside@6', 'idle@0.05', 'idle@0.2', 'soft late@0.1', 'soft idle@0.1',
         'kinetic late@0.2', 'uneven', 'coarse@0.1', 'coarse@0.3', 'lasting@0.9', 'flicker', 'steps@8', 'steps@12', 'cell@0.15', 'short@15.5', 'drift@0.03',
         'measured@0.03', 'loaded@0.05', 'struck@10', 'zero@0.02', 'stiffness')


def main():
    number = int(sys.argv[1]) if len(sys.argv) > 1 else 40
    for kind in sys.argv[2:] or KINDS:
        off, told = [], collections.Counter()
        settings, true = SETTINGS, TRUE
        if kind == 'stiffness':   # is one of the unknowns
            true = {**TRUE, 'slider.stiffness': 1.0}
            settings = {**SETTINGS, 'free': list(true), 'bounds': {**SETTINGS['bounds'], 'slider.stiffness': (0.7, 1.4)}}
        for seed in range(number):
            measured, friction = record(kind, np.random.default_rng(seed))
            try:
                fit = stickslip.fit(measured, {**INPUT, 'friction': friction}, **settings)
            except ValueError as error:
                told[f'refused: {str(error)[:100]}'] += 1
                continue
            off.append([np.log(fit.values[name] / value) / np.log(np.divide(*fit.intervals[name][::-1])) * 2 * 1.96
                        for name, value in true.items()])
            told.update(re.sub(r'[-+]?\d[\d.e%+-]*', '#', warning)[:100] for warning in fit.warnings)
        off = np.array(off)
        print(f'{kind:18s}', ', '.join(f'{name} mean {mean:+.2f} rms {rms:.2f}' for name, mean, rms in
                                       zip(true, off.mean(axis=0), np.sqrt(np.mean(off**2, axis=0)))) if off.size else 'none',
              f'in their intervals of 68 % {np.mean(np.abs(off) < 1.0):.0%}, of 95 % {np.mean(np.abs(off) < 1.96):.0%}, of {off.size}', flush=True)
        for words, count in told.most_common():
            print(f'    {count:3d} times: {words}', flush=True)


if __name__ == '__main__':
    main()
