"""Constants of rate-and-state friction from velocity steps and holds (docs/fitting.md)."""
from __future__ import annotations

import copy
import dataclasses
import numbers
import pathlib
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from ._arrays import number, row_of
from ._optional import needed
from ._records import spread
from ._run import series
from ._search import checked_bounds
from .laws import Law, classes

if TYPE_CHECKING:
    import matplotlib.figure

NAMES = ('a', 'b', 'd_c', 'stiffness')
NORMAL = 1.959964
UNDETERMINED = 0.2
STEP = 0.01           # of the constants' logarithms, for central differences
FRICTION = 0.6        # of steady sliding in the model; the level of the record is found apart from it
REST = 1e-6           # of the largest velocity: below it the drive stands still
RTOL = 1e-6           # error in a step, part of the friction
BEST = 4              # starting points from which least squares go on
MUCH_WORSE = 2.0      # times the least misfit with the changes where they were given: not gone on from
STRAIGHT = 0.03       # standard deviation of a logarithm up to which slopes tell the interval
FIRST = 0.1           # step of a logarithm on the way to the end of an interval, at most
WAY = 12              # steps to the end of an interval, at most
CLOSE = 0.1           # standard deviations to which the end of an interval is found
MOST_LAGS = 1000      # samples over which what is left over is looked at for lasting
MOST_FRICTION = 5.0   # above, it is a traction, or in per cent
EARLY_LATE = 3.0      # standard deviations by which a change of the drive may come earlier or later than it was given
AT_BOUND = 1e-3       # of a constant, relative
LEAST_PARTS = 45     # of the record, as long as what is left over lasts: with fewer, errors are known badly
SPIKE = 15.0          # standard deviations of the noise by which a sample stands out
BESIDE = 10           # samples after a change that friction may well jump in
AGREE = 3.0           # standard deviations by which two numbers for one thing may differ


@dataclasses.dataclass(frozen=True, eq=False)
class RateStateFit:
    """What `fit_rate_and_state` found; lengths and times in the units of the record."""

    values: dict[str, float]                    #: a, b [-], d_c [L], stiffness [1/L], of friction against displacement
    intervals: dict[str, tuple[float, float]]   #: 95 % intervals, also of 'a - b'; 0 or infinite where the record tells no end
    correlation: np.ndarray                     #: of the constants' logarithms, in the order of `values`
    undetermined: list[str]                     #: constants that the record does not determine
    warnings: list[str]
    misfit: float                               #: root mean square of what is left over, in standard deviations of the noise
    velocity: np.ndarray                        #: of the drive in each piece, as given or from the displacement [L/T]
    changes: np.ndarray                         #: times at which it changes, as found [T]
    time: np.ndarray                            #: of the record, without samples that were left out
    friction: np.ndarray                        #: at these times
    model: np.ndarray                           #: at the same times

    def law(self, *, alpha_n: float, alpha_t: float, v0: float, f0: float, evolution: str = 'ageing') -> Law:
        """The law with the values found, for `update` and `run`."""
        return classes['rate_and_state'](alpha_n=alpha_n, alpha_t=alpha_t, v0=v0, f0=f0, evolution=evolution,
                            **{name: self.values[name] for name in ('a', 'b', 'd_c')})

    def __str__(self) -> str:
        lines = []
        for name, value in {**self.values, 'a - b': self.values['a'] - self.values['b']}.items():
            low, high = self.intervals[name]
            remark = '   not determined by this record' if name in self.undetermined else ''
            lines.append(f'{name:10s} {value:10.4g}   95 % interval {low:.4g} to {high:.4g}{remark}')
        lines.append('velocity ' + ', '.join(f'{value:.4g}' for value in self.velocity)
                     + '; changes at ' + ', '.join(f'{value:.8g}' for value in self.changes))
        return '\n'.join([*lines, *(f'warning: {warning}' for warning in self.warnings)])

    def plot(self, path: str | pathlib.Path | None = None) -> matplotlib.figure.Figure:
        """Draws record and model, and what is left over. path: where to save the picture. Gives the figure."""
        figure = needed('matplotlib.figure', 'fit').Figure(figsize=(8, 5), layout='constrained')
        above, below = figure.subplots(2, 1, sharex=True, height_ratios=(3, 1))
        above.plot(self.time, self.friction, lw=0.5, color='0.6', label='measured')
        above.plot(self.time, self.model, lw=1.2, label='rate and state')
        above.set_ylabel('friction coefficient [-]')
        above.legend(loc='upper right')
        below.plot(self.time, self.friction - self.model, lw=0.5, color='0.4')
        below.set_ylabel('left over [-]')
        below.set_xlabel('time [T]')
        if path is not None:
            figure.savefig(path)
        return figure


def fit_rate_and_state(time: ArrayLike, friction: ArrayLike, *, changes: ArrayLike,
                       displacement: ArrayLike | None = None, velocity: ArrayLike | None = None,
                       bounds: Mapping[str, tuple[float, float]] | None = None, evolution: str = 'ageing', seed: int = 1,
                       starts: int = 64, changes_error: float | None = None) -> RateStateFit:
    """Fits a, b, d_c and the stiffness of the loading to friction under a drive of constant velocity, piece by piece.

    time: of the samples, increasing [T]; at least 50, and 10 in each piece.
    friction: shear over normal traction there [-].
    changes: times at which the drive changes its velocity [T], within the record.
    displacement: of the load point, at the same times [L]: gives the velocities, and the changes to a part of a sample
        (where straight lines through the samples on either side meet); or
    velocity: of each piece, one more than changes [L/T]; 0 is a hold.
    bounds: of a, b [-], d_c [L], stiffness [1/L], by name, 0 < lower < upper; the others are taken from the record, far apart.
    evolution: 'ageing' or 'slip' law.
    seed: of the starting points, a whole number >= 0.
    starts: their number, a Sobol sequence within the bounds; a power of 2.
    changes_error: standard deviation of the times of the changes [T], 0 where they are known for certain. None: what the
        displacement tells, or that they are known to a sample.

    Beside the four constants, the level and a straight trend of friction with time are found, which the law does not
    explain, and the moment of each change, without which those around it would count as the stiffness. Errors allow for
    what is left over being correlated from sample to sample. Raises ValueError where the record cannot be fitted, TypeError
    where an argument is of the wrong kind; the text says why. Sources of the law: docs/theory.md.
    """
    least_squares, qmc = needed('scipy.optimize', 'fit').least_squares, needed('scipy.stats', 'fit').qmc

    record = _prepare(time, friction, changes, displacement, velocity, changes_error)
    _check_choices(bounds, evolution, seed, starts)
    search = _Search(record, _limits(record, bounds or {}), frozenset(bounds or {}), evolution)
    # With the changes where they were given first: together with them the misfit has more valleys.
    first = search.part(len(NAMES))
    points = qmc.scale(qmc.Sobol(len(NAMES), seed=seed).random(starts), first.low, first.high)
    points = points[np.argsort([np.sum(first.misfit(point)**2) for point in points])[:BEST]]
    ends = [least_squares(first.misfit, point, first.jacobian, bounds=(first.low, first.high), x_scale=first.scale, max_nfev=40)
            for point in points]
    least = min(end.cost for end in ends)
    ends = [least_squares(search.misfit, np.append(end.x, 0.0 * record.changes), search.jacobian, bounds=(search.low, search.high),
                          x_scale=search.scale, max_nfev=40) for end in ends if end.cost < MUCH_WORSE * least]
    return _assess(search, min(ends, key=lambda end: end.cost).x)


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


NO_RUN = ('no constants within the bounds give a run that ends: where the spring is softer than friction weakens, sliding without mass is '
          'unstable; give other bounds')
EVOLUTIONS = ('ageing', 'slip')


def _limits(record: _Steps, given: Mapping[str, tuple[float, float]]) -> dict[str, tuple[float, float]]:
    """Bounds of all constants: those given, the others from the record."""
    if unknown := set(given) - set(NAMES):
        raise ValueError(f'bounds: no constants {", ".join(sorted(map(str, unknown)))}; there are {", ".join(NAMES)}')
    limits = record.default_bounds()
    for name, bounds in given.items():
        limits[name] = checked_bounds(name, bounds)
    return limits


@dataclasses.dataclass(frozen=True)
class _Steps:
    """A record of friction with the velocities of its drive."""

    time: np.ndarray
    friction: np.ndarray
    changes: np.ndarray     #: [T]
    velocity: np.ndarray    #: of each piece [L/T]
    noise: np.ndarray       #: of each sample
    unsure: np.ndarray      #: standard deviations of the changes [T]
    warnings: tuple[str, ...] = ()
    sense: float = 1.0      #: -1 where the drive goes backwards: friction and velocity are those of the mirrored rig

    def default_bounds(self) -> dict[str, tuple[float, float]]:
        """For the constants that the caller has no bounds for."""
        speed = self.velocity.max()
        # Samples may be denser around the changes; at random times, single ones are as near to one another as can be.
        shortest = speed * float(np.percentile(np.diff(self.time), 5))
        longest = speed * float(self.time[-1] - self.time[0])
        # What lies far beyond what the record can tell makes no difference there, but a bound that is too near does elsewhere.
        return {'a': (1e-4, 0.1), 'b': (1e-4, 0.1), 'd_c': (0.03 * shortest, 3.0 * longest), 'stiffness': (0.05 / longest, 100.0 / shortest)}

    def moved(self, by: np.ndarray | float) -> np.ndarray:
        """The changes, so many of their standard deviations later."""
        return self.changes + by * self.unsure

    def model(self, constants: np.ndarray, evolution: str, late: np.ndarray | float = 0.0) -> np.ndarray | None:
        """Friction of the model at the record's times, but for level and trend; None where its run fails. late: how much later the
        changes come, in their standard deviations."""
        a, b, d_c, stiffness = map(float, constants)
        first = float(self.velocity[0])
        ends = np.append(self.moved(late), self.time[-1]) - self.time[0]
        found = series({
            'friction': {'law': 'rate_and_state', 'contact': 'rigid', 'alpha_n': 1.0, 'alpha_t': 1.0, 'a': a, 'b': b, 'd_c': d_c,
                         'v0': first, 'f0': FRICTION, 'evolution': evolution},
            'slider': {'mass': 0.0, 'stiffness': stiffness, 'area': 1.0, 'normal_traction': 1.0},
            'initial': {'mu': FRICTION},   # steady sliding: theta_0 is that of v0
            'drive': {'velocity': self.velocity, 'duration': np.diff(np.append(0.0, ends))},
            'time': {'t_end': float(ends[-1]), 'rtol': RTOL}}, 'time', 'spring_force', 'velocity')
        if found is None:
            return None
        rows, force, velocity = found
        drive = self.velocity[np.searchsorted(ends[:-1], 0.5 * (rows[1:] + rows[:-1]))]   # between rows
        return _between(self.time - self.time[0], rows, force, stiffness * (drive - velocity[:-1]),
                        stiffness * (drive - velocity[1:]))

    def with_trend(self, model: np.ndarray) -> np.ndarray:
        """The model on the level of the record, and with its straight trend."""
        part = (self.time - self.time[0]) / (self.time[-1] - self.time[0])
        basis = np.column_stack([np.ones_like(part), part]) / self.noise[:, None]
        trend, *_ = np.linalg.lstsq(basis, (self.friction - model) / self.noise, rcond=None)
        return model + basis @ trend * self.noise

    def misfit(self, constants: np.ndarray, evolution: str, late: np.ndarray) -> np.ndarray | None:
        """Model less record, in standard deviations of the noise, and the changes less those given; None where the run fails."""
        model = self.model(constants, evolution, late)
        if model is None or not np.isfinite(model).all():
            return None
        return np.append((self.with_trend(model) - self.friction) / self.noise, late)


class _Search:
    """The misfit as a function of the logarithms of the constants, and of how late the changes of the drive come."""

    def __init__(self, record: _Steps, limits: dict[str, tuple[float, float]], given: frozenset[str], evolution: str) -> None:
        self.record, self.limits, self.given, self.evolution = record, limits, given, evolution
        changes = np.ones(record.changes.size)
        low, high = np.log([limits[name] for name in NAMES]).T
        self.low, self.high = np.append(low, -EARLY_LATE * changes), np.append(high, EARLY_LATE * changes)
        self.scale = np.append(np.full(len(NAMES), 0.3), changes)
        self.steps = np.append(np.full(len(NAMES), STEP), 10.0 * STEP * changes)
        # More than any run leaves.
        self.failed = np.append(np.maximum(100.0, 100.0 * np.ptp(record.friction) / record.noise), 0.0 * changes)
        self.known: dict[bytes, np.ndarray | None] = {}

    def part(self, size: int) -> _Search:
        """The same of the constants alone, with the changes where they were given."""
        other = copy.copy(self)
        other.low, other.high, other.scale, other.steps = (values[:size] for values in (self.low, self.high, self.scale, self.steps))
        return other

    def _of_run(self, at: np.ndarray) -> np.ndarray | None:
        key = at.tobytes()
        if key not in self.known:
            size = len(NAMES)
            late = at[size:] if at.size > size else 0.0 * self.record.changes
            self.known[key] = self.record.misfit(np.exp(at[:size]), self.evolution, late)
        return self.known[key]

    def misfit(self, at: np.ndarray) -> np.ndarray:
        """What is left over, in standard deviations; the last of it are those of the changes."""
        found = self._of_run(at)
        return self.failed if found is None else found

    def at_bound(self, at: np.ndarray) -> np.ndarray:
        """Which constants are at one of their bounds?"""
        return np.minimum(at - self.low, self.high - at)[:len(NAMES)] < AT_BOUND

    def jacobian(self, at: np.ndarray, which: slice | np.ndarray = slice(None)) -> np.ndarray:
        """Slopes by central differences; beside constants whose run fails, which say nothing of slopes, by those to the other side."""
        columns = []
        for step in np.diag(self.steps)[which]:
            here, ahead, behind = self.misfit(at), self._of_run(at + step), self._of_run(at - step)
            if (ahead is None) != (behind is None):
                columns.append((ahead - here if ahead is not None else here - behind) / step.sum())
            else:
                columns.append(np.zeros_like(here) if ahead is None else (ahead - behind) / (2.0 * step.sum()))
        return np.array(columns).T


def _between(time: np.ndarray, rows: np.ndarray, force: np.ndarray, after: np.ndarray, before: np.ndarray) -> np.ndarray:
    """The force at any time, from that in the rows of a run and its rates after each row and before the next one."""
    i = np.clip(np.searchsorted(rows, time, side='right') - 1, 0, rows.size - 2)
    length = np.diff(rows)[i]
    s = (time - rows[i]) / length
    return (force[i] * (1.0 + 2.0 * s) * (1.0 - s)**2 + force[i + 1] * s**2 * (3.0 - 2.0 * s)
            + length * s * (1.0 - s) * (after[i] * (1.0 - s) - before[i] * s))


def _prepare(time: Any, friction: Any, changes: Any, displacement: Any, velocity: Any, changes_error: Any) -> _Steps:
    time, friction, changes = row_of(time, 'time'), row_of(friction, 'friction'), row_of(changes, 'changes')
    if time.size != friction.size or time.size < 50:
        raise ValueError(f'{time.size} times and {friction.size} values of friction: as many of each are needed, at least 50')
    _check_finite(time=time, friction=friction, changes=changes)
    if np.diff(time).min() <= 0.0:
        raise ValueError(f'time does not increase at {time[int(np.argmin(np.diff(time))) + 1]:g}')
    if changes.size == 0 or np.any(np.diff(changes) <= 0.0) or changes[0] <= time[0] or changes[-1] >= time[-1]:
        raise ValueError(f'changes = {changes.tolist()}: at least one, increasing, between {time[0]:g} and {time[-1]:g}')
    if (displacement is None) == (velocity is None):
        raise ValueError('either displacement or velocity is needed')
    edges = np.concatenate([[time[0]], changes, [time[-1]]])
    noise = _noise(time, friction, edges)
    after = np.searchsorted(time, changes)
    unsure = (time[after] - time[after - 1]) / np.sqrt(3.0)   # anywhere between one sample before and one after
    if displacement is not None:
        displacement = row_of(displacement, 'displacement')
        if displacement.size != time.size:
            raise ValueError(f'{displacement.size} displacements for {time.size} times: as many are needed')
        _check_finite(displacement=displacement)
        changes, velocity, found = _lines(time, displacement, edges)
        unsure = np.hypot(found, 0.5 * unsure)   # friction and displacement are of one sample, taken within its time
    velocity = row_of(velocity, 'velocity')
    if velocity.size != changes.size + 1:
        raise ValueError(f'velocity: {velocity.size} values for {changes.size} changes: {changes.size + 1} are needed')
    if changes_error is not None:
        unsure[:] = number(changes_error, 'changes_error')
        if not 0.0 <= unsure[0] < np.inf:
            raise ValueError(f'changes_error = {changes_error!r}: must be >= 0')
    edges[1:-1] = changes
    unsure = np.minimum(unsure, np.minimum(np.diff(edges)[1:], np.diff(edges)[:-1]) / (3.0 * EARLY_LATE))
    sense = 1.0
    if np.all(velocity <= 0.0):   # mirrored; the force may have either sign
        sense = float(np.sign(np.median(friction))) or 1.0
        velocity, friction = -velocity, sense * friction
    _check_physics(friction, velocity, changes)
    kept, warnings = _without_spikes(time, friction, noise, changes)
    return _Steps(time[kept], friction[kept], changes, velocity, noise[kept], unsure, warnings, sense)


def _without_spikes(time: np.ndarray, friction: np.ndarray, noise: np.ndarray, changes: np.ndarray) -> tuple[np.ndarray, tuple[str, ...]]:
    """Which samples stay: single ones that stand out from their neighbours, away from the changes, go, if they are a few."""
    around = np.median(np.lib.stride_tricks.sliding_window_view(np.pad(friction, 2, mode='edge'), 5), axis=1)
    spikes = np.abs(friction - around) > SPIKE * noise
    for after in np.searchsorted(time, changes):
        spikes[max(0, after - 2):after + BESIDE] = False   # the change may come a sample earlier
    count = int(np.count_nonzero(spikes))
    if not 0 < count <= max(1, time.size // 50):
        return np.ones_like(spikes), ()
    return ~spikes, (f'{count} samples stand out from their neighbours and were left out, the first at {time[int(np.argmax(spikes))]:g}',)


def _check_finite(**given: np.ndarray) -> None:
    """Refuses what is not a finite number, or missing."""
    for name, values in given.items():
        if (bad := ~np.isfinite(values)).any():
            raise ValueError(f'{name}: value {int(np.argmax(bad)) + 1} of {values.size} is not a finite number; leave samples out '
                             'of which anything is missing')


def _check_physics(friction: np.ndarray, velocity: np.ndarray, changes: np.ndarray) -> None:
    """Refuses numbers that are no friction under a drive that changes its velocity."""
    if not (np.isfinite(velocity).all() and velocity.min() >= 0.0 and velocity[0] > 0.0):
        raise ValueError(f'velocity = {velocity.tolist()}: the first must not be 0, and all must go one way')
    if np.any(same := np.abs(np.diff(velocity)) < REST * velocity.max()):
        raise ValueError(f'velocity: {velocity[int(np.argmax(same))]:g} before and after the change at {changes[int(np.argmax(same))]:g}: '
                         'where it stays as it is there is no change')
    middle = float(np.median(friction))
    if middle < 0.0:
        raise ValueError(f'friction: its median, {middle:.3g}, is negative: it acts against the drive. Turn the sign of one of them')
    if middle > MOST_FRICTION:
        raise ValueError(f'friction: its median is {middle:.3g}: shear over normal traction is needed, not a traction, and not per cent')


def _noise(time: np.ndarray, friction: np.ndarray, edges: np.ndarray) -> np.ndarray:
    """Standard deviation of each sample's noise, which may differ from piece to piece."""
    noise, steps, least = np.empty_like(time), np.abs(np.diff(friction)), 1e-6 * np.ptp(friction)
    if least == 0.0:
        raise ValueError(f'friction: all values are {friction[0]:g}: there is nothing to fit')
    steps = steps[steps > least]
    for begin, end in zip(edges[:-1], edges[1:]):
        part = (time >= begin) & (time <= end)
        if part.sum() < 10:
            raise ValueError(f'changes: {part.sum()} samples from {begin:g} to {end:g} are too few; at least 10 are needed')
        second = np.diff(friction[part], 2)
        own = spread(second) / np.sqrt(6.0)
        if own < least and steps.size:   # friction is known in steps
            own = float(np.median(steps)) / np.sqrt(12.0)
        noise[part] = max(own, least)
    return noise


def _lines(time: np.ndarray, displacement: np.ndarray, edges: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Times at which the drive changes its velocity, the velocities of the pieces, and the standard deviations of those times."""
    apart = time - time[0]
    lines, moments, errors = [], [], []
    for begin, end in zip(edges[:-1], edges[1:]):
        margin = 0.05 * (end - begin)
        inner = (time > begin + margin) & (time < end - margin)
        lines.append(np.polyfit(apart[inner], displacement[inner], 1))
    velocity = np.array([line[0] for line in lines])
    velocity[np.abs(velocity) < REST * np.abs(velocity).max()] = 0.0
    for i, (begin, moment, end) in enumerate(zip(edges[:-2], edges[1:-1], edges[2:])):
        change = velocity[i + 1] - velocity[i]
        meet = time[0] + (lines[i + 1][1] - lines[i][1]) / (lines[i][0] - lines[i + 1][0]) if change != 0.0 else np.inf
        if not abs(meet - moment) < 0.1 * (edges[-1] - edges[0]):
            raise ValueError(f'displacement: does not change its velocity near {moment:g}, as changes says')
        meet, error = _meet(time, displacement, (begin, meet, end))
        moments.append(meet)
        errors.append(error)
    return np.array(moments), velocity, np.array(errors)


def _meet(time: np.ndarray, displacement: np.ndarray, piece: tuple[float, float, float]) -> tuple[float, float]:
    """Where straight lines through the samples before and after a change of velocity meet, and its standard deviation. The widest
    part of them is taken that agrees with all narrower ones: a drive is not so steady that samples far away tell the moment."""
    begin, meet, end = piece
    width, found = max(meet - begin, end - meet), []
    while True:
        apart = time - meet
        parts = (apart > max(begin - meet, -width)) & (apart < -0.05 * width), (apart > 0.05 * width) & (apart < min(end - meet, width))
        if min(part.sum() for part in parts) < 10:
            break
        before, after = (np.polyfit(apart[part], displacement[part], 1) for part in parts)
        if not abs(before[1] - after[1]) < 0.5 * width * abs(after[0] - before[0]):
            break   # noise alone
        # A line is known at its end with twice the error of its mean; samples that are the same as those before say nothing.
        variance = 0.0
        for part, line in zip(parts, (before, after)):
            known = 1 + np.count_nonzero(np.diff(displacement[part]))
            variance += 4.0 * float(np.var(displacement[part] - np.polyval(line, apart[part]))) / known
        meet += (before[1] - after[1]) / (after[0] - before[0])
        found.append((meet, float(np.sqrt(variance)) / abs(after[0] - before[0])))
        width *= 0.5
    best = found.pop() if found else (piece[1], 0.0)
    narrower = [best]
    while found:
        wider = found.pop()
        if any(abs(wider[0] - moment) > AGREE * np.hypot(wider[1], error) for moment, error in narrower):
            break
        narrower.append(best := wider)
    return best


def _assess(search: _Search, at: np.ndarray) -> RateStateFit:
    """Errors from the slope and from sums of what is left over in blocks, which are as good as independent; where they are large,
    from the way along the valley."""
    record, size = search.record, len(NAMES)
    computed = record.model(np.exp(at[:size]), search.evolution, at[size:])
    if computed is None:
        raise ValueError(NO_RUN)
    slope, samples = search.jacobian(at), record.time.size
    misfit, own, changes = search.misfit(at)[:samples], slope[:samples], slope[samples:].T @ slope[samples:]
    inverse = np.linalg.pinv(slope.T @ slope, rcond=1e-12)
    blocks = np.array_split(np.arange(samples), max(10, round(np.sqrt(samples))))
    pulls = np.array([own[block].T @ misfit[block] for block in blocks])
    covariance = inverse @ (_lasting(own, misfit) + changes) @ inverse
    alone = np.sqrt(np.maximum(np.diag(covariance), 1e-300))
    deviation = np.sqrt(np.max([alone**2, np.diag(inverse), np.diag(inverse @ (pulls.T @ pulls + changes) @ inverse)], axis=0))
    correlation = (covariance / np.outer(alone, alone))[:size, :size]
    np.fill_diagonal(correlation, 1.0)
    # What changes nothing has no finite error.
    blind = np.linalg.norm(own, axis=0)[:size] < 1e-6 * np.linalg.norm(own, axis=0).max()
    shares = np.where(blind, 1.0, (np.sqrt(np.diag(inverse)) / deviation)[:size])
    deviation = np.where(blind, np.inf, deviation[:size])
    ends = np.array([at[:size] - NORMAL * deviation, at[:size] + NORMAL * deviation])
    if deviation.max() > STRAIGHT or search.at_bound(at).any():
        ends = np.array([_valley(search, at, side * NORMAL * deviation, shares) for side in (-1.0, 1.0)])
    with np.errstate(over='ignore'):   # of what is not determined at all
        intervals = {name: (float(np.exp(low)), float(np.exp(high))) for name, low, high in zip(NAMES, *ends)}
        widths = (ends[1] - ends[0]) / (2.0 * NORMAL)
    (a, b), parts = np.exp(at[:2]), np.exp(at[:2]) * [1.0, -1.0] * deviation[:2]
    off = np.inf if blind[:2].any() else NORMAL * np.sqrt(max(0.0, parts @ correlation[:2, :2] @ parts))
    intervals['a - b'] = (float(a - b - off), float(a - b + off))
    rms = float(np.sqrt(np.mean(misfit**2)))
    return RateStateFit(dict(zip(NAMES, np.exp(at).tolist())), intervals, correlation,
                        [name for name, s in zip(NAMES, widths) if not s <= UNDETERMINED], _remarks(search, at, misfit), rms,
                        record.sense * record.velocity, record.moved(at[size:]), record.time, record.sense * record.friction,
                        record.sense * record.with_trend(computed))


def _remarks(search: _Search, at: np.ndarray, misfit: np.ndarray) -> list[str]:
    """What a careful reader of the result should know."""
    remarks = [*search.record.warnings]
    remarks += [f'{name} ends at its bound' for name, ends in zip(NAMES, search.at_bound(at)) if ends]
    late, changes = at[len(NAMES):], search.record.changes
    remarks += [f'the change at {changes[i]:.8g} fits best {EARLY_LATE:g} standard deviations away, at {found:.8g}: friction answers at '
                'another time than it was given for the drive, and the constants, the stiffness above all, are wrong where this time is; '
                'give changes_error if it is not known to a sample'
                for i, found in enumerate(search.record.moved(late)) if abs(late[i]) > 0.9 * EARLY_LATE]
    if (rms := float(np.sqrt(np.mean(misfit**2)))) > 2.0:
        remarks.append(f'what is left over is {rms:.2g} times the noise from sample to sample: the law does not explain all of '
                       'it, or the noise lasts')
    if (lasting := _lasts(misfit)) > misfit.size / LEAST_PARTS:
        remarks.append(f'what is left over lasts for {lasting:.0f} samples, a {misfit.size / lasting:.0f}th of the record: errors of d_c and '
                       'a - b, which such noise looks like, may be twice those given')
    return remarks


def _valley(search: _Search, at: np.ndarray, first: np.ndarray, shares: np.ndarray) -> np.ndarray:
    """How far each constant may go to one side until the misfit, with the others found anew, has risen by `NORMAL` standard
    deviations: slopes tell nothing of a valley that is flat to one side, as that of a rig that is stiff enough. Without an end
    within the default bounds there is none. first: where to look first, from `at`; shares: errors of white noise over those of
    the noise there is."""
    least_squares = needed('scipy.optimize', 'fit').least_squares
    low, high = search.low, search.high
    lowest, ends = float(np.sum(search.misfit(at)**2)), np.empty(len(NAMES))
    for i, name in enumerate(NAMES):
        others = np.arange(at.size) != i

        def held(part: np.ndarray, value: float, i: int = i) -> np.ndarray:
            return search.misfit(np.insert(part, i, value))

        def slopes(part: np.ndarray, value: float, i: int = i, others: np.ndarray = others) -> np.ndarray:
            return search.jacobian(np.insert(part, i, value), others)

        inside, outside = (0.0, 0.0, at[others]), (np.inf, np.inf)   # step, rise of the misfit; the others there
        step = np.clip(first[i], -FIRST, FIRST)
        if name not in search.given and abs((high if first[i] > 0.0 else low)[i] - at[i]) < AT_BOUND:
            ends[i] = np.copysign(np.inf, first[i])   # the best of all may lie beyond
            continue
        for _ in range(WAY):
            value = float(np.clip(at[i] + step, low[i], high[i]))
            found = least_squares(held, np.clip(inside[2], low[others] + 1e-9, high[others] - 1e-9), slopes, args=(value,),
                                  x_scale=search.scale[others], bounds=(low[others], high[others]), max_nfev=10)
            risen = np.sqrt(max(0.0, 2.0 * found.cost - lowest)) * shares[i]
            if risen < NORMAL:
                inside = (value - at[i], risen, found.x)
            else:
                outside = (value - at[i], risen)
            at_bound = value in (low[i], high[i])
            if abs(risen - NORMAL) < CLOSE or at_bound and risen < NORMAL:
                break
            if np.isinf(outside[0]):
                step = inside[0] * np.clip(NORMAL / max(risen, 1e-3), 1.3, 3.0)
            else:
                part = (NORMAL - inside[1]) / (outside[1] - inside[1])
                step = inside[0] + (outside[0] - inside[0]) * np.clip(part, 0.1, 0.9)
        is_open = at_bound and risen < NORMAL and name not in search.given
        ends[i] = np.copysign(np.inf, first[i]) if is_open else value
    return ends


def _lasting(slope: np.ndarray, misfit: np.ndarray) -> np.ndarray:
    """Covariance of slope.T @ misfit, for a misfit that lasts from sample to sample in the same way all along: the few samples
    that tell a constant say little about that themselves."""
    rest = misfit - misfit.mean()
    total = (rest @ rest) / rest.size * (slope.T @ slope)
    for lag, together in _together(rest):
        cross = slope[:-lag].T @ slope[lag:]
        total += together * (cross + cross.T)
    return total


def _together(rest: np.ndarray) -> Iterator[tuple[int, float]]:
    """Covariances of samples one, two, three, ... apart, as long as they are positive."""
    for lag in range(1, min(MOST_LAGS, rest.size // 4)):
        together = float(rest[:-lag] @ rest[lag:]) / rest.size
        if together <= 0.0:
            return
        yield lag, together


def _lasts(misfit: np.ndarray) -> float:
    """For how many samples what is left over is as good as one number."""
    rest = misfit - misfit.mean()
    return 1.0 + 2.0 * sum(together for _, together in _together(rest)) / max(float(np.mean(rest**2)), 1e-300)
