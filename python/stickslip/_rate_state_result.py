"""Constants of rate-and-state friction with their errors, and what a reader of them should know (docs/fitting.md)."""
from __future__ import annotations

import dataclasses
import pathlib
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from ._optional import needed
from ._rate_state_model import AT_BOUND, EARLY_LATE, NAMES, Search
from .laws import Law, classes

if TYPE_CHECKING:
    import matplotlib.figure

NORMAL = 1.959964
UNDETERMINED = 0.2
STRAIGHT = 0.03       # standard deviation of a logarithm up to which slopes tell the interval
FIRST = 0.1           # step of a logarithm on the way to the end of an interval, at most
WAY = 12              # steps to the end of an interval, at most
CLOSE = 0.1           # standard deviations to which the end of an interval is found
MOST_LAGS = 1000      # samples over which what is left over is looked at for lasting
LEAST_PARTS = 45     # of the record, as long as what is left over lasts: with fewer, errors are known badly
NO_RUN = ('no constants within the bounds give a complete run: sliding without mass is unstable if the spring is softer than the fall of '
          'friction; give other bounds')


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
        """Draws record and model, and the residuals. path: where to save the picture. Returns the figure."""
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


def assess(search: Search, at: np.ndarray) -> RateStateFit:
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


def _remarks(search: Search, at: np.ndarray, misfit: np.ndarray) -> list[str]:
    """What a careful reader of the result should know."""
    remarks = [*search.record.warnings]
    remarks += [f'{name} ends at its bound' for name, ends in zip(NAMES, search.at_bound(at)) if ends]
    late, changes = at[len(NAMES):], search.record.changes
    remarks += [f'the change at {changes[i]:.8g} fits best {EARLY_LATE:g} standard deviations away, at {found:.8g}: friction changes at '
                'another time than the one given. If that time is wrong, so are the constants, above all the stiffness: '
                'give changes_error if it is not known to a sample'
                for i, found in enumerate(search.record.moved(late)) if abs(late[i]) > 0.9 * EARLY_LATE]
    if (rms := float(np.sqrt(np.mean(misfit**2)))) > 2.0:
        remarks.append(f'the residuals are {rms:.2g} times the noise from sample to sample: the law does not explain all of them, '
                       'or the noise is correlated in time')
    if (lasting := _lasts(misfit)) > misfit.size / LEAST_PARTS:
        remarks.append(f'the residuals are correlated over {lasting:.0f} samples, a {misfit.size / lasting:.0f}th of the record: such noise looks '
                       'like the effect of d_c and a - b, whose errors may be twice those given')
    return remarks


def _valley(search: Search, at: np.ndarray, first: np.ndarray, shares: np.ndarray) -> np.ndarray:
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
