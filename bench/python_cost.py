"""What an update costs from Python: one point, and many in either order, against the calls of the C interface.

Usage, after ./dev test: build/python/bin/python bench/python_cost.py [POINTS]. Times are the lowest of several
repetitions, by the processor's clock, in one thread; ratios are between rows of one run.
"""
import os
import sys
import time

os.environ.setdefault('OMP_NUM_THREADS', '1')

import numpy as np  # noqa: E402

import stickslip  # noqa: E402

LAW = stickslip.laws.Subloading(alpha_n=1000, alpha_t=800, mu_s=0.45, mu_k=0.25, kappa=8, xi=0.2, m=60)


def cost(call, repetitions, batches=15):
    """Time of a call [s]."""
    best = float('inf')
    for _ in range(batches):
        start = time.process_time()
        for _ in range(repetitions):
            call()
        best = min(best, (time.process_time() - start) / repetitions)
    return best


def main():
    n = int(float(sys.argv[1])) if len(sys.argv) > 1 else 100_000
    pressed = stickslip.update([-0.01, 0.0, 0.0], 0.01, LAW).state
    one = np.array([0.0, 1e-4, 0.0])
    peer = cost(lambda: np.add(one, one), 10_000)
    call = cost(lambda: stickslip.update(one, 0.01, LAW, pressed), 10_000)
    print(f'one point                       {1e6 * call:8.2f} us, {call / peer:.1f} times numpy.add of two vectors of 3')
    du = np.random.default_rng(1).normal(scale=1e-4, size=(n, 3))
    du[:, 0] = 0
    times = {}
    for order in 'FC':
        moves = np.array(du, order=order)
        state = np.array(np.tile(pressed, (n, 1)), order=order)
        result = stickslip.update(moves, 0.01, LAW, state)
        fresh = cost(lambda moves=moves, state=state: stickslip.update(moves, 0.01, LAW, state), 3)
        times[order] = cost(lambda moves=moves, state=state, result=result:
                            stickslip.update(moves, 0.01, LAW, state, out=result), 3)
        name = {'F': 'component-major', 'C': 'C order'}[order]
        print(f'{n} points, {name:16s} {1e9 * times[order] / n:8.1f} ns a point, {1e9 * fresh / n:8.1f} with new memory')
    print(f'C order to component-major      {times["C"] / times["F"]:8.2f}')


if __name__ == '__main__':
    main()
