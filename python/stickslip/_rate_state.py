"""Constants of rate-and-state friction from velocity steps and holds (docs/fitting.md)."""
from __future__ import annotations

import numbers
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ._optional import needed
from ._rate_state_model import NAMES, Search, limits_of
from ._rate_state_record import prepare
from ._rate_state_result import RateStateFit, assess

BEST = 4              # starting points from which least squares go on
MUCH_WORSE = 2.0      # times the least misfit with the changes where they were given: not gone on from
EVOLUTIONS = ('ageing', 'slip')


def fit_rate_and_state(time: ArrayLike, friction: ArrayLike, *, changes: ArrayLike,
                       displacement: ArrayLike | None = None, velocity: ArrayLike | None = None,
                       bounds: Mapping[str, tuple[float, float]] | None = None, evolution: str = 'ageing', seed: int = 1,
                       starts: int = 64, changes_error: float | None = None) -> RateStateFit:
    """Fits a, b, d_c and the stiffness of the loading to friction under a drive of constant velocity, piece by piece.

    time: of the samples, increasing [T]; at least 50, and 10 in each piece.
    friction: shear over normal traction there [-].
    changes: times at which the drive changes its velocity [T], within the record.
    displacement: of the load point, at the same times [L]: determines the velocities, and the times of the changes to a part of
    a sample (where straight lines through the samples on either side meet); or
    velocity: of each piece, one more than changes [L/T]; 0 is a hold.
    bounds: of a, b [-], d_c [L], stiffness [1/L], by name, 0 < lower < upper; default bounds from the record are wide.
    evolution: 'ageing' or 'slip' law.
    seed: of the starting points, a whole number >= 0.
    starts: number of starting points, a Sobol sequence within the bounds; a power of 2.
    changes_error: standard deviation of the times of the changes [T], 0 if they are known exactly. None: from the
    displacement, or the error of times that are known to a sample.

    In addition to the four constants, the level and a linear trend of friction with time are fitted, and the time of each
    change, whose error would otherwise appear as an error of the stiffness. Errors include the correlation of the residuals
    from sample to sample. Raises ValueError if the record cannot be fitted, TypeError if an argument has the wrong type; the
    text says why. Sources of the law: docs/theory.md.
    """
    least_squares, qmc = needed('scipy.optimize', 'fit').least_squares, needed('scipy.stats', 'fit').qmc

    record = prepare(time, friction, changes, displacement, velocity, changes_error)
    _check_choices(bounds, evolution, seed, starts)
    search = Search(record, limits_of(record, bounds or {}), frozenset(bounds or {}), evolution)
    # With the changes where they were given first: together with them the misfit has more valleys.
    first = search.part(len(NAMES))
    points = qmc.scale(qmc.Sobol(len(NAMES), seed=seed).random(starts), first.low, first.high)
    points = points[np.argsort([np.sum(first.misfit(point)**2) for point in points])[:BEST]]
    ends = [least_squares(first.misfit, point, first.jacobian, bounds=(first.low, first.high), x_scale=first.scale, max_nfev=40)
            for point in points]
    least = min(end.cost for end in ends)
    ends = [least_squares(search.misfit, np.append(end.x, 0.0 * record.changes), search.jacobian, bounds=(search.low, search.high),
                          x_scale=search.scale, max_nfev=40) for end in ends if end.cost < MUCH_WORSE * least]
    return assess(search, min(ends, key=lambda end: end.cost).x)


def _check_choices(bounds: Any, evolution: Any, seed: Any, starts: Any) -> None:
    """Refuses what is not the record."""
    if bounds is not None and not isinstance(bounds, Mapping):
        raise TypeError(f'bounds = {bounds!r}: a dict of lower and upper bounds by name is needed')
    if not isinstance(evolution, str) or evolution not in EVOLUTIONS:
        raise ValueError(f'evolution = {evolution!r}: one of {", ".join(EVOLUTIONS)}')
    for name, value, least in (('seed', seed, 0), ('starts', starts, 1)):
        if not isinstance(value, numbers.Integral) or isinstance(value, bool) or value < least:
            raise ValueError(f'{name} = {value!r}: must be a whole number >= {least}')
    if starts & (starts - 1):
        raise ValueError(f'starts = {starts!r}: must be a power of 2')
