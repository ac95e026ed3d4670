"""Constants of rate-and-state friction from velocity steps and holds (docs/fitting.md)."""
from __future__ import annotations

import dataclasses
import pathlib
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike

from ._optional import needed
from ._run import spring_force
from .laws import RateAndState

NAMES = ('a', 'b', 'd_c', 'stiffness')
NORMAL = 1.959964
UNDETERMINED = 0.2
STEP = 0.01           # of the constants' logarithms, for central differences
FRICTION = 0.6        # of steady sliding in the model; the level of the record is found apart from it
REST = 1e-6           # of the largest velocity: below it the drive stands still
RTOL = 1e-6           # error in a step, part of the friction
ROWS = 5000           # of a run
RIGID = 300.0         # contact springs in a drive spring


@dataclasses.dataclass(frozen=True)
class RateStateFit:
    """What `fit_rate_and_state` found; lengths and times in the units of the record."""

    values: dict[str, float]                    #: a, b [-], d_c [L], stiffness [1/L], of friction against displacement
    intervals: dict[str, tuple[float, float]]   #: 95 % intervals
    correlation: np.ndarray                     #: of the constants' logarithms, in the order of `values`
    undetermined: list[str]                     #: constants that the record does not determine
    warnings: list[str]
    misfit: float                               #: root mean square of what is left over, in standard deviations of the noise
    time: np.ndarray                            #: of the record
    friction: np.ndarray                        #: of the record
    model: np.ndarray                           #: at the same times

    def law(self, *, alpha_n: float, alpha_t: float, v0: float, f0: float, evolution: str = 'ageing') -> RateAndState:
        """The law with the values found, for `update` and `run`."""
        return RateAndState(alpha_n=alpha_n, alpha_t=alpha_t, v0=v0, f0=f0, evolution=evolution,
                            **{name: self.values[name] for name in ('a', 'b', 'd_c')})

    def __str__(self) -> str:
        lines = []
        for name, value in self.values.items():
            low, high = self.intervals[name]
            remark = '   not determined by this record' if name in self.undetermined else ''
            lines.append(f'{name:10s} {value:10.4g}   95 % interval {low:.4g} to {high:.4g}{remark}')
        a_b = self.values['a'] - self.values['b']
        return '\n'.join([*lines, f'{"a - b":10s} {a_b:10.4g}', *(f'warning: {warning}' for warning in self.warnings)])

    def plot(self, path: str | pathlib.Path | None = None):
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


def fit_rate_and_state(time: ArrayLike, friction: ArrayLike, *, changes: Sequence[float],
                       displacement: ArrayLike | None = None, velocity: Sequence[float] | None = None,
                       bounds: Mapping[str, tuple[float, float]] | None = None, evolution: str = 'ageing', seed: int = 1,
                       starts: int = 64) -> RateStateFit:
    """Fits a, b, d_c and the stiffness of the loading to friction under a drive of constant velocity, piece by piece.

    time, friction: the record; friction is shear over normal traction [-].
    changes: times at which the drive changes its velocity [T], within the record.
    displacement: of the load point, at the same times [L]: gives the velocities, and the changes to a part of a sample
        (where the straight lines of two pieces meet); or
    velocity: of each piece, one more than changes [L/T]; 0 is a hold.
    bounds: of a, b [-], d_c [L], stiffness [1/L], by name; the others are taken from the record.
    evolution: 'ageing' or 'slip' law.
    seed, starts: of the starting points, a Sobol sequence within the bounds; a power of 2.

    Beside the four constants, the level and a straight trend of friction with time are found, which the law does not
    explain. Errors allow for what is left over being correlated from sample to sample. Raises ValueError where the
    record cannot be fitted; the text says why.
    """
    least_squares, qmc = needed('scipy.optimize', 'fit').least_squares, needed('scipy.stats', 'fit').qmc

    record = _prepare(time, friction, changes, displacement, velocity)
    limits = {**record.default_bounds(), **(bounds or {})}
    if unknown := set(limits) - set(NAMES):
        raise ValueError(f'fit_rate_and_state: no constants {", ".join(sorted(unknown))}; there are {", ".join(NAMES)}')
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
    for point in points[np.argsort([np.sum(misfit(point)**2) for point in points])[:3]]:
        found = least_squares(misfit, point, jacobian, bounds=(low, high), x_scale=0.3, max_nfev=40)
        if best is None or found.cost < best.cost:
            best = found
    return _assess(record, best.x, misfit(best.x), jacobian(best.x), limits, evolution)


@dataclasses.dataclass(frozen=True)
class _Steps:
    """A record of friction with the velocities of its drive."""

    time: np.ndarray
    friction: np.ndarray
    changes: np.ndarray     #: [T]
    velocity: np.ndarray    #: of each piece [L/T]
    noise: np.ndarray       #: of each sample

    def default_bounds(self) -> dict[str, tuple[float, float]]:
        """For the constants that the caller has no bounds for."""
        speed = self.velocity.max()
        shortest = speed * float(np.median(np.diff(self.time)))
        longest = speed * (self.time[-1] - self.time[0]) / 5.0
        return {'a': (1e-4, 0.1), 'b': (1e-4, 0.1), 'd_c': (shortest, longest), 'stiffness': (0.01 / longest, 0.1 / shortest)}

    def model(self, constants: np.ndarray, evolution: str) -> np.ndarray | None:
        """Friction of the model at the record's times, but for level and trend; None where its run fails."""
        a, b, d_c, stiffness = map(float, constants)
        first = float(self.velocity[0])
        ends = np.append(self.changes, self.time[-1]) - self.time[0]
        end = float(ends[-1])
        result = spring_force({
            'friction': {'law': 'rate_and_state', 'alpha_n': 1.0, 'alpha_t': RIGID * stiffness, 'a': a, 'b': b, 'd_c': d_c,
                         'v0': first, 'f0': FRICTION, 'evolution': evolution},
            'slider': {'mass': 0.0, 'stiffness': stiffness, 'area': 1.0, 'normal_traction': 1.0},
            'initial': {'mu': FRICTION},   # steady sliding: theta_0 is that of v0
            'drive': {'velocity': list(self.velocity), 'duration': list(np.diff(np.append(0.0, ends)))},
            'time': {'t_end': end, 'rtol': RTOL}, 'output': {'every': end / ROWS}})
        if result is None:
            return None
        return np.interp(self.time - self.time[0], *result)

    def with_trend(self, model: np.ndarray) -> np.ndarray:
        """The model on the level of the record, and with its straight trend."""
        part = (self.time - self.time[0]) / (self.time[-1] - self.time[0])
        basis = np.column_stack([np.ones_like(part), part]) / self.noise[:, None]
        trend, *_ = np.linalg.lstsq(basis, (self.friction - model) / self.noise, rcond=None)
        return model + basis @ trend * self.noise

    def misfit(self, constants: np.ndarray, evolution: str) -> np.ndarray:
        """Model less record, in standard deviations of the noise; large where the model's run fails."""
        model = self.model(constants, evolution)
        if model is None or not np.isfinite(model).all():
            return np.full(self.time.size, 100.0)
        return (self.with_trend(model) - self.friction) / self.noise


def _prepare(time: ArrayLike, friction: ArrayLike, changes: Sequence[float], displacement: ArrayLike | None,
             velocity: Sequence[float] | None) -> _Steps:
    time, friction = np.asarray(time, float).ravel(), np.asarray(friction, float).ravel()
    changes = np.asarray(changes, float).ravel()
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
        changes, velocity = _lines(time, np.asarray(displacement, float).ravel(), edges)
    velocity = np.asarray(velocity, float)
    if velocity.size != changes.size + 1:
        raise ValueError(f'{velocity.size} velocities for {changes.size} changes: {changes.size + 1} are needed')
    if velocity.max() <= 0.0 or velocity.min() < 0.0 or velocity[0] <= 0.0:
        raise ValueError(f'velocities {velocity.tolist()}: the first above 0, none below')
    noise = np.empty_like(time)
    for begin, end in zip(edges[:-1], edges[1:]):
        part = (time >= begin) & (time <= end)
        if part.sum() < 10:
            raise ValueError(f'{part.sum()} samples from {begin:g} to {end:g} are too few')
        second = np.diff(friction[part], 2)
        noise[part] = max(float(np.subtract(*np.percentile(second, [75, 25]))) / 1.349 / np.sqrt(6.0),
                          1e-6 * np.ptp(friction))
    return _Steps(time, friction, changes, velocity, noise)


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


def _assess(record: _Steps, at: np.ndarray, misfit: np.ndarray, slope: np.ndarray, limits: Mapping[str, tuple[float, float]],
            evolution: str) -> RateStateFit:
    """Errors from the slope and from sums of what is left over in blocks, which are as good as independent."""
    inverse = np.linalg.pinv(slope.T @ slope, rcond=1e-12)
    blocks = np.array_split(np.arange(misfit.size), max(10, round(np.sqrt(misfit.size))))
    pulls = np.array([slope[block].T @ misfit[block] for block in blocks])
    covariance = inverse @ (pulls.T @ pulls) @ inverse
    covariance = np.maximum(1.0, np.diag(inverse) / np.maximum(np.diag(covariance), 1e-300)).max() * covariance
    deviation = np.sqrt(np.diag(covariance))
    intervals = {name: (float(np.exp(x - NORMAL * s)), float(np.exp(x + NORMAL * s)))
                 for name, x, s in zip(NAMES, at, deviation)}
    warnings = [f'{name} ends at its bound' for name, x in zip(NAMES, at)
                if min(x - np.log(limits[name][0]), np.log(limits[name][1]) - x) < 1e-3]
    rms = float(np.sqrt(np.mean(misfit**2)))
    if rms > 2.0:
        warnings.append(f'what is left over is {rms:.2g} times the noise: the law does not explain all of it')
    model = record.with_trend(record.model(np.exp(at), evolution))
    return RateStateFit(dict(zip(NAMES, np.exp(at).tolist())), intervals, covariance / np.outer(deviation, deviation),
                        [name for name, s in zip(NAMES, deviation) if not s <= UNDETERMINED], warnings, rms,
                        record.time, record.friction, model)
