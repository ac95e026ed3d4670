"""The worst of errors, for a test that compares it with a bound: `max` passes over a NaN, but where that stands first.

>>> worst_of([1.0, 3.0, 2.0])
3.0
>>> nan = float('nan')
>>> [worst_of(errors) for errors in ([nan, 1.0, 2.0], [1.0, nan, 2.0], [1.0, 2.0, nan])]
[nan, nan, nan]
"""
import math


def worst_of(errors):
    """The largest; a NaN is worse than any number, and below no bound."""
    return max(errors, key=lambda error: (math.isnan(error), error))
