"""The model of friction in velocity steps and holds, and its misfit with a record (docs/fitting.md)."""
from __future__ import annotations

import copy
import dataclasses
from collections.abc import Mapping

import numpy as np

from ._run import series
from ._search import checked_bounds

NAMES = ('a', 'b', 'd_c', 'stiffness')
STEP = 0.01           # of the constants' logarithms, for central differences
FRICTION = 0.6        # of steady sliding in the model; the level of the record is found apart from it
RTOL = 1e-6           # error in a step, part of the friction
AT_BOUND = 1e-3       # of a constant, relative
EARLY_LATE = 3.0      # standard deviations by which a change of the drive may come earlier or later than it was given


@dataclasses.dataclass(frozen=True)
class Steps:
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


def _between(time: np.ndarray, rows: np.ndarray, force: np.ndarray, after: np.ndarray, before: np.ndarray) -> np.ndarray:
    """The force at any time, from that in the rows of a run and its rates after each row and before the next one."""
    i = np.clip(np.searchsorted(rows, time, side='right') - 1, 0, rows.size - 2)
    length = np.diff(rows)[i]
    s = (time - rows[i]) / length
    return (force[i] * (1.0 + 2.0 * s) * (1.0 - s)**2 + force[i + 1] * s**2 * (3.0 - 2.0 * s)
            + length * s * (1.0 - s) * (after[i] * (1.0 - s) - before[i] * s))


def limits_of(record: Steps, given: Mapping[str, tuple[float, float]]) -> dict[str, tuple[float, float]]:
    """Bounds of all constants: those given, the others from the record."""
    if unknown := set(given) - set(NAMES):
        raise ValueError(f'bounds: no constants {", ".join(sorted(map(str, unknown)))}; there are {", ".join(NAMES)}')
    limits = record.default_bounds()
    for name, bounds in given.items():
        limits[name] = checked_bounds(name, bounds)
    return limits


class Search:
    """The misfit as a function of the logarithms of the constants, and of how late the changes of the drive come."""

    def __init__(self, record: Steps, limits: dict[str, tuple[float, float]], given: frozenset[str], evolution: str) -> None:
        self.record, self.limits, self.given, self.evolution = record, limits, given, evolution
        changes = np.ones(record.changes.size)
        low, high = np.log([limits[name] for name in NAMES]).T
        self.low, self.high = np.append(low, -EARLY_LATE * changes), np.append(high, EARLY_LATE * changes)
        self.scale = np.append(np.full(len(NAMES), 0.3), changes)
        self.steps = np.append(np.full(len(NAMES), STEP), 10.0 * STEP * changes)
        # More than any run leaves.
        self.failed = np.append(np.maximum(100.0, 100.0 * np.ptp(record.friction) / record.noise), 0.0 * changes)
        self.known: dict[bytes, np.ndarray | None] = {}

    def part(self, size: int) -> Search:
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
