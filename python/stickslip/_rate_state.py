"""Constants of rate-and-state friction from velocity steps and holds (docs/fitting.md)."""
from __future__ import annotations

import dataclasses
import numbers
import pathlib
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from ._arrays import row_of
from ._optional import needed
from ._records import spread
from ._run import series
from ._search import checked_bounds
from .laws import Law, classes

if TYPE_CHECKING:
    import matplotlib.figure

#: What is left over, in standard deviations of the noise, at the logarithms of the constants.
Misfit = Callable[[np.ndarray], np.ndarray]

NAMES = ('a', 'b', 'd_c', 'stiffness')
NORMAL = 1.959964
UNDETERMINED = 0.2
STEP = 0.01           # of the constants' logarithms, for central differences
FRICTION = 0.6        # of steady sliding in the model; the level of the record is found apart from it
REST = 1e-6           # of the largest velocity: below it the drive stands still
RTOL = 1e-6           # error in a step, part of the friction
BEST = 4              # starting points from which least squares go on
STRAIGHT = 0.03       # standard deviation of a logarithm up to which slopes tell the interval
FIRST = 0.1           # step of a logarithm on the way to the end of an interval, at most
WAY = 12              # steps to the end of an interval, at most
CLOSE = 0.1           # standard deviations to which the end of an interval is found
MOST_LAGS = 1000      # samples over which what is left over is looked at for lasting


@dataclasses.dataclass(frozen=True, eq=False)
class RateStateFit:
    """What `fit_rate_and_state` found; lengths and times in the units of the record."""

    values: dict[str, float]                    #: a, b [-], d_c [L], stiffness [1/L], of friction against displacement
    intervals: dict[str, tuple[float, float]]   #: 95 % intervals, also of 'a - b'; 0 or infinite where the record tells no end
    correlation: np.ndarray                     #: of the constants' logarithms, in the order of `values`
    undetermined: list[str]                     #: constants that the record does not determine
    warnings: list[str]
    misfit: float                               #: root mean square of what is left over, in standard deviations of the noise
    time: np.ndarray                            #: of the record
    friction: np.ndarray                        #: of the record
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
                       starts: int = 64) -> RateStateFit:
    """Fits a, b, d_c and the stiffness of the loading to friction under a drive of constant velocity, piece by piece.

    time, friction: the record; friction is shear over normal traction [-].
    changes: times at which the drive changes its velocity [T], within the record.
    displacement: of the load point, at the same times [L]: gives the velocities, and the changes to a part of a sample
        (where the straight lines of two pieces meet); or
    velocity: of each piece, one more than changes [L/T]; 0 is a hold.
    bounds: of a, b [-], d_c [L], stiffness [1/L], by name, 0 < lower < upper; the others are taken from the record, far apart.
    evolution: 'ageing' or 'slip' law.
    seed, starts: of the starting points, a Sobol sequence within the bounds; a power of 2.

    Beside the four constants, the level and a straight trend of friction with time are found, which the law does not
    explain. Errors allow for what is left over being correlated from sample to sample. Raises ValueError where the
    record cannot be fitted; the text says why.
    """
    least_squares, qmc = needed('scipy.optimize', 'fit').least_squares, needed('scipy.stats', 'fit').qmc

    record = _prepare(time, friction, changes, displacement, velocity)
    limits = _limits(record, bounds or {})
    if evolution not in EVOLUTIONS:
        raise ValueError(f'evolution = {evolution!r}: one of {", ".join(EVOLUTIONS)}')
    if not isinstance(starts, numbers.Integral) or starts < 1 or starts & (starts - 1):
        raise ValueError(f'starts = {starts!r}: must be a power of 2')
    low, high = np.log([limits[name] for name in NAMES]).T
    known: dict[bytes, np.ndarray] = {}

    def misfit(at: np.ndarray) -> np.ndarray:
        key = at.tobytes()
        if key not in known:
            known[key] = record.misfit(np.exp(at), evolution)
        return known[key]

    def jacobian(at: np.ndarray) -> np.ndarray:
        steps = STEP * np.eye(at.size)
        return np.array([misfit(at + step) - misfit(at - step) for step in steps]).T / (2.0 * STEP)

    points = qmc.scale(qmc.Sobol(low.size, seed=seed).random(starts), low, high)
    best = None
    for point in points[np.argsort([np.sum(misfit(point)**2) for point in points])[:BEST]]:
        found = least_squares(misfit, point, jacobian, bounds=(low, high), x_scale=0.3, max_nfev=40)
        if best is None or found.cost < best.cost:
            best = found
    return _assess(record, best.x, misfit, jacobian(best.x), limits, frozenset(bounds or {}), evolution)


NO_RUN = ('no constants within the bounds give a run that ends: where the spring is softer than friction weakens, sliding without mass is '
          'unstable; give other bounds')
EVOLUTIONS = ('ageing', 'slip')


def _limits(record: _Steps, given: Mapping[str, tuple[float, float]]) -> dict[str, tuple[float, float]]:
    """Bounds of all constants: those given, the others from the record."""
    if unknown := set(given) - set(NAMES):
        raise ValueError(f'fit_rate_and_state: no constants {", ".join(sorted(unknown))}; there are {", ".join(NAMES)}')
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
    sense: float = 1.0      #: -1 where the drive goes backwards: friction and velocity are those of the mirrored rig

    def default_bounds(self) -> dict[str, tuple[float, float]]:
        """For the constants that the caller has no bounds for."""
        speed = self.velocity.max()
        # Samples may be denser around the changes; at random times, single ones are as near to one another as can be.
        shortest = speed * float(np.percentile(np.diff(self.time), 5))
        longest = speed * float(self.time[-1] - self.time[0])
        # What lies far beyond what the record can tell makes no difference there, but a bound that is too near does elsewhere.
        return {'a': (1e-4, 0.1), 'b': (1e-4, 0.1), 'd_c': (0.03 * shortest, 3.0 * longest), 'stiffness': (0.05 / longest, 100.0 / shortest)}

    def model(self, constants: np.ndarray, evolution: str) -> np.ndarray | None:
        """Friction of the model at the record's times, but for level and trend; None where its run fails."""
        a, b, d_c, stiffness = map(float, constants)
        first = float(self.velocity[0])
        ends = np.append(self.changes, self.time[-1]) - self.time[0]
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

    def misfit(self, constants: np.ndarray, evolution: str) -> np.ndarray:
        """Model less record, in standard deviations of the noise; where the model's run fails, more than any run leaves."""
        model = self.model(constants, evolution)
        if model is None or not np.isfinite(model).all():
            return np.maximum(100.0, 100.0 * np.ptp(self.friction) / self.noise)
        return (self.with_trend(model) - self.friction) / self.noise


def _between(time: np.ndarray, rows: np.ndarray, force: np.ndarray, after: np.ndarray, before: np.ndarray) -> np.ndarray:
    """The force at any time, from that in the rows of a run and its rates after each row and before the next one."""
    i = np.clip(np.searchsorted(rows, time, side='right') - 1, 0, rows.size - 2)
    length = np.diff(rows)[i]
    s = (time - rows[i]) / length
    return (force[i] * (1.0 + 2.0 * s) * (1.0 - s)**2 + force[i + 1] * s**2 * (3.0 - 2.0 * s)
            + length * s * (1.0 - s) * (after[i] * (1.0 - s) - before[i] * s))


def _prepare(time: Any, friction: Any, changes: Any, displacement: Any, velocity: Any) -> _Steps:
    time, friction, changes = row_of(time, 'time'), row_of(friction, 'friction'), row_of(changes, 'changes')
    if time.size != friction.size or time.size < 50:
        raise ValueError(f'{time.size} times and {friction.size} values of friction: as many of each are needed, at least 50')
    if not (np.isfinite(time).all() and np.isfinite(friction).all()):
        raise ValueError('the record holds what is not a finite number')
    if np.diff(time).min() <= 0.0:
        raise ValueError(f'time does not increase at {time[int(np.argmin(np.diff(time))) + 1]:g}')
    if changes.size == 0 or np.any(np.diff(changes) <= 0.0) or changes[0] <= time[0] or changes[-1] >= time[-1]:
        raise ValueError(f'changes = {changes.tolist()}: at least one, increasing, between {time[0]:g} and {time[-1]:g}')
    if (displacement is None) == (velocity is None):
        raise ValueError('either displacement or velocity is needed')
    edges = np.concatenate([[time[0]], changes, [time[-1]]])
    if displacement is not None:
        displacement = row_of(displacement, 'displacement')
        if displacement.size != time.size:
            raise ValueError(f'{displacement.size} displacements for {time.size} times: as many are needed')
        if not np.isfinite(displacement).all():
            raise ValueError('the displacement holds what is not a finite number')
        changes, velocity = _lines(time, displacement, edges)
    velocity = row_of(velocity, 'velocity')
    if velocity.size != changes.size + 1:
        raise ValueError(f'{velocity.size} velocities for {changes.size} changes: {changes.size + 1} are needed')
    sense = 1.0
    if np.all(velocity <= 0.0):   # mirrored; the force may have either sign
        sense = float(np.sign(np.median(friction))) or 1.0
        velocity, friction = -velocity, sense * friction
    if not (np.isfinite(velocity).all() and velocity.min() >= 0.0 and velocity[0] > 0.0):
        raise ValueError(f'velocities {velocity.tolist()}: the first must not be 0, and all must go one way')
    noise, steps, least = np.empty_like(time), np.abs(np.diff(friction)), 1e-6 * np.ptp(friction)
    steps = steps[steps > least]
    for begin, end in zip(edges[:-1], edges[1:]):
        part = (time >= begin) & (time <= end)
        if part.sum() < 10:
            raise ValueError(f'{part.sum()} samples from {begin:g} to {end:g} are too few')
        second = np.diff(friction[part], 2)
        own = spread(second) / np.sqrt(6.0)
        if own < least and steps.size:   # friction is known in steps
            own = float(np.median(steps)) / np.sqrt(12.0)
        noise[part] = max(own, least)
    return _Steps(time, friction, changes, velocity, noise, sense)


def _lines(time: np.ndarray, displacement: np.ndarray, edges: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Velocities of the pieces, and the times at which their straight lines meet."""
    lines = []
    for begin, end in zip(edges[:-1], edges[1:]):
        margin = 0.05 * (end - begin)
        inner = (time > begin + margin) & (time < end - margin)
        lines.append(np.polyfit(time[inner] - time[0], displacement[inner], 1))
    meet = [time[0] + (after[1] - before[1]) / (before[0] - after[0]) for before, after in zip(lines[:-1], lines[1:])]
    moved = np.abs(np.array(meet) - edges[1:-1])
    if np.any(moved > 0.1 * (edges[-1] - edges[0])):
        raise ValueError('the displacement does not change its velocity near the changes given')
    velocity = np.array([line[0] for line in lines])
    velocity[np.abs(velocity) < REST * np.abs(velocity).max()] = 0.0
    return np.array(meet), velocity


def _assess(record: _Steps, at: np.ndarray, misfit_at: Misfit, slope: np.ndarray, limits: Mapping[str, tuple[float, float]],
            given: frozenset[str], evolution: str) -> RateStateFit:
    """Errors from the slope and from sums of what is left over in blocks, which are as good as independent; where they are large,
    from the way along the valley. given: the names of the bounds that are the caller's."""
    misfit = misfit_at(at)
    inverse = np.linalg.pinv(slope.T @ slope, rcond=1e-12)
    blocks = np.array_split(np.arange(misfit.size), max(10, round(np.sqrt(misfit.size))))
    pulls = np.array([slope[block].T @ misfit[block] for block in blocks])
    covariance = inverse @ _lasting(slope, misfit) @ inverse
    alone = np.sqrt(np.maximum(np.diag(covariance), 1e-300))
    deviation = np.sqrt(np.max([alone**2, np.diag(inverse), np.diag(inverse @ (pulls.T @ pulls) @ inverse)], axis=0))
    covariance *= np.outer(deviation / alone, deviation / alone)
    ends = np.array([at - NORMAL * deviation, at + NORMAL * deviation])
    if deviation.max() > STRAIGHT:
        ends = np.array([_valley(misfit_at, at, side * NORMAL * deviation, np.sqrt(np.diag(inverse)) / deviation, limits, given)
                         for side in (-1.0, 1.0)])
    with np.errstate(over='ignore'):   # of what is not determined at all
        intervals = {name: (float(np.exp(low)), float(np.exp(high))) for name, low, high in zip(NAMES, *ends)}
        widths = (ends[1] - ends[0]) / (2.0 * NORMAL)
        a, b = np.exp(at[:2])
        off = NORMAL * np.sqrt(max(0.0, np.array([a, -b]) @ covariance[:2, :2] @ np.array([a, -b])))
        intervals['a - b'] = (float(a - b - off), float(a - b + off))
    warnings = [f'{name} ends at its bound' for name, x in zip(NAMES, at)
                if min(x - np.log(limits[name][0]), np.log(limits[name][1]) - x) < 1e-3]
    rms = float(np.sqrt(np.mean(misfit**2)))
    if rms > 2.0:
        warnings.append(f'what is left over is {rms:.2g} times the noise from sample to sample: the law does not explain all of '
                        'it, or the noise lasts')
    computed = record.model(np.exp(at), evolution)
    if computed is None:
        raise ValueError(NO_RUN)
    model = record.sense * record.with_trend(computed)
    return RateStateFit(dict(zip(NAMES, np.exp(at).tolist())), intervals, covariance / np.outer(deviation, deviation),
                        [name for name, s in zip(NAMES, widths) if not s <= UNDETERMINED], warnings, rms,
                        record.time, record.sense * record.friction, model)


def _valley(misfit: Misfit, at: np.ndarray, first: np.ndarray, shares: np.ndarray, limits: Mapping[str, tuple[float, float]],
            given: frozenset[str]) -> np.ndarray:
    """How far each constant may go to one side until the misfit, with the others found anew, has risen by `NORMAL` standard
    deviations: slopes tell nothing of a valley that is flat to one side, as that of a rig that is stiff enough. Without an end
    within the default bounds there is none. first: where to look first, from `at`; shares: errors of white noise over those of
    the noise there is."""
    least_squares = needed('scipy.optimize', 'fit').least_squares
    low, high = np.log([limits[name] for name in NAMES]).T
    lowest, ends = float(misfit(at) @ misfit(at)), np.empty_like(at)
    for i, name in enumerate(NAMES):
        others = np.arange(at.size) != i

        def held(part: np.ndarray, value: float, i: int = i) -> np.ndarray:
            return misfit(np.insert(part, i, value))

        inside, outside = (0.0, 0.0, at[others]), (np.inf, np.inf)   # step, rise of the misfit; the others there
        step = np.clip(first[i], -FIRST, FIRST)
        for _ in range(WAY):
            value = float(np.clip(at[i] + step, low[i], high[i]))
            found = least_squares(held, np.clip(inside[2], low[others] + 1e-9, high[others] - 1e-9), args=(value,), x_scale=0.3,
                                  bounds=(low[others], high[others]), diff_step=STEP, max_nfev=10)
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
        is_open = at_bound and risen < NORMAL and name not in given
        ends[i] = np.copysign(np.inf, first[i]) if is_open else value
    return ends


def _lasting(slope: np.ndarray, misfit: np.ndarray) -> np.ndarray:
    """Covariance of slope.T @ misfit, for a misfit that lasts from sample to sample in the same way all along: the few samples
    that tell a constant say little about that themselves."""
    rest = misfit - misfit.mean()
    total = (rest @ rest) / rest.size * (slope.T @ slope)
    for lag in range(1, min(MOST_LAGS, rest.size // 4)):
        together = (rest[:-lag] @ rest[lag:]) / rest.size
        if together <= 0.0:
            break
        cross = slope[:-lag].T @ slope[lag:]
        total += together * (cross + cross.T)
    return total
