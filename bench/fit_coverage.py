"""How good `stickslip.fit` is: seeded fits of six constants to two synthetic records each, from bounds of a factor 5.

Usage, after ./dev test: build/python/bin/python bench/fit_coverage.py [FITS [FIRST_SEED]]. Six to seventeen seconds of
processor time a fit. Says for each fit the errors, the standard deviations, and whether it is right: every constant in its
95 % interval widened by 1.3, and within 5 % (xi 10 %) where its standard deviation is below 2 %; what is above 20 % is
named undetermined.
"""
import sys
import time

import numpy as np

import stickslip

TRUE = {'alpha_t': 0.05, 'mu_s': 0.4, 'mu_k': 0.2, 'kappa': 3.0, 'xi': 2.0, 'm': 100.0}
VELOCITIES, DURATIONS = (0.5, 2.0), (40.0, 15.0)   # periods of 16 ringing times and more
NOISE = 0.01                # of the largest force
INPUT = {'friction': {'law': 'subloading', 'alpha_n': 1.0, **TRUE},
         'slider': {'mass': 2e-4, 'stiffness': 1.0, 'damping': 0.005, 'area': 1000.0, 'normal_traction': 0.01},
         'drive': {'velocity': 1.0}, 'time': {'rtol': 1e-6}}


def records(seed):
    """Records of the model, with noise."""
    draw = np.random.default_rng(seed)
    runs = [stickslip.run({**INPUT, 'drive': {'velocity': velocity}, 'time': {'t_end': end, 'rtol': 1e-9},
                           'output': {'every': 0.005}}).table for velocity, end in zip(VELOCITIES, DURATIONS)]
    noise = NOISE * max(run['spring_force'].max() for run in runs)
    return [stickslip.Record(run['time'], run['spring_force'] + noise * draw.standard_normal(len(run)),
                             {'drive': {'velocity': velocity}}, f'v = {velocity:g}') for run, velocity in zip(runs, VELOCITIES)]


def bounds(seed):
    """A factor 5 about a point that is off by up to a factor 2."""
    draw = np.random.default_rng(1000 + seed)
    found = {}
    for name, true in TRUE.items():
        middle = true * 2.0**draw.uniform(-1, 1)
        found[name] = (middle / 5.0, middle * 5.0)
    return found


def main():
    fits = int(sys.argv[1]) if len(sys.argv) > 1 else 40
    first = int(sys.argv[2]) if len(sys.argv) > 2 else 0
    right, rows = 0, []
    for seed in range(first, first + fits):
        data = records(seed)
        start = time.process_time()
        fit = stickslip.fit(data, INPUT, free=list(TRUE), bounds=bounds(seed), seed=seed, progress=lambda text: None)
        spent = time.process_time() - start
        good, words = True, []
        rows.append([])
        for name, true in TRUE.items():
            low, high = fit.intervals[name]
            error, sigma = np.log(fit.values[name] / true), np.log(high / low) / 2 / 1.96
            close = sigma > 0.02 or abs(error) < (0.1 if name == 'xi' else 0.05)
            named = (sigma > 0.2) == (name in fit.undetermined)
            good &= bool(abs(error) < 1.3 * 1.96 * sigma and close and named)
            words.append(f'{name} {100 * error:+.1f} ({100 * sigma:.1f})')
            rows[-1].append((error, sigma))
        right += good
        print(f'seed {seed:3d}: error % (standard deviation %)', ', '.join(words), f'{spent:.1f} s', 'right' if good else 'WRONG',
              flush=True)
    print(f'{right} of {fits} right')
    error, sigma = np.moveaxis(rows, 2, 0)
    for name, off, width in zip(TRUE, error.T, sigma.T):
        print(f'{name:8s} median standard deviation {100 * np.median(width):.2f} %, in its 95 % interval {np.sum(abs(off) < 1.96 * width)} '
              f'times, root mean square of error over standard deviation {np.sqrt(np.mean((off / width)**2)):.2f}')


if __name__ == '__main__':
    main()
