"""What of a record the constants are fitted to, and the same of a simulation.

Means over the whole record and counts of events jump when an event enters or leaves; what is compared here moves
smoothly with the constants: for a record whose events repeat, the times of a fixed number of events one by one, the mean
cycle around the drop and between drops, and the first loading; for one whose events scatter, medians over the events.
"""
from __future__ import annotations

import dataclasses
from collections.abc import Iterator

import numpy as np

from ._records import Analysis, Falls, average, find_falls, means_between, smooth, straight_trend, unsettled_events

MOST_EVENTS = 30        # of a record that are followed one by one
SKIPPED = 5             # events of a simulation before it has settled
SETTLED = 4             # events of a simulation that stand for all, where those of the record scatter
TIMES = 12              # event times that are compared
NEAR = np.linspace(-1.0, 1.0, 31)
BETWEEN = np.linspace(0.06, 0.94, 23)
LOADING_BINS = 25
FLOOR = 1e-3            # of an amplitude: errors of sampling and of the time integration
RIG = 0.1               # of the slope of the loading: what is known of stiffness, velocity and units of a scattered record


@dataclasses.dataclass(frozen=True, eq=False)
class Target:
    """The features of one record with their standard deviations, and how to take them from a simulation."""

    analysis: Analysis
    events: int                          #: that a simulation must show
    names: tuple[str, ...]               #: of the features, one for each value
    values: np.ndarray
    noise: np.ndarray                    #: standard deviations of the features, by noise or by scatter
    scale: np.ndarray                    #: what a relative error of the model is relative to
    first_load: float                    #: length of the first loading in the record [T]; 0: it has none
    near: float                          #: half width of the window around a drop [T]
    rig: float                           #: relative error of the slope of the loading that the rig's own numbers have
    wander: np.ndarray                   #: noise that lasts from sample to sample; empty where samples vary by themselves

    def errors(self, floor: float = FLOOR) -> np.ndarray:
        """Standard deviations of the features, with a relative error of the model. The times of events are by far the
        sharpest of them and make the misfit's valleys narrow: a large error counts the more for them."""
        times = np.array(self.names) == 'event times'
        return np.hypot(self.noise, floor * self.scale * np.where(times, (floor / FLOOR)**0.9, 1.0))

    def with_noise(self, time: np.ndarray, force: np.ndarray, rng: np.random.Generator, number: int) -> Iterator[np.ndarray]:
        """A force like the record's, again and again with other noise like the record's; where a drift was taken out of the
        record, without what would have been taken for one here."""
        falls = self.falls(time, force) if self.analysis.straightened else None
        for _ in range(number):
            noise = self.draw_noise(rng, force.size)
            if falls is not None:
                noise = noise - straight_trend(time, noise, falls, self.analysis.from_rest)
            yield force + noise

    def draw_noise(self, rng: np.random.Generator, size: int) -> np.ndarray:
        """Noise like the record's."""
        if self.wander.size == 0:
            return self.analysis.white_noise(rng, size)
        # In pieces of about a cycle: the whole has no mean at any phase, which would leave the mean cycle without noise.
        period = self.analysis.period / self.analysis.step
        pieces: list[np.ndarray] = []
        while sum(map(len, pieces)) < size:
            start, length = rng.integers(self.wander.size), 1 + int(rng.uniform(0.5, 2.5) * period)
            pieces.append(rng.choice((-1.0, 1.0)) * self.wander.take(np.arange(start, start + length), mode='wrap'))
        return np.concatenate(pieces)[:size]

    def of_simulation(self, time: np.ndarray, force: np.ndarray) -> np.ndarray | None:
        """The features of a simulation; None where it shows too few events."""
        return self.of_samples(*self.analysis.like(time, force))

    def of_samples(self, time: np.ndarray, force: np.ndarray) -> np.ndarray | None:
        """The same of samples like the record's."""
        falls = self.falls(time, force)
        if falls is None:
            return None
        if self.analysis.scattered:
            return medians(time, force, falls)[0]
        return self._repeating(time, force, falls)

    def falls(self, time: np.ndarray, force: np.ndarray) -> Falls | None:
        """The events of samples that are compared; None where there are too few."""
        falls = find_falls(time, smooth(force, self.analysis.window), self.analysis.threshold)
        if len(falls) < self.events:
            return None
        return falls.part(slice(SKIPPED if self.analysis.scattered or not self.analysis.from_rest else 0, self.events))

    def _repeating(self, time: np.ndarray, force: np.ndarray, falls: Falls) -> np.ndarray:
        middle = falls.middle
        cycles = falls.part(slice(1, None)) if self.analysis.from_rest else falls
        # Since the first event: a record may begin some time before or after its drive does.
        times = np.interp(_time_places(len(middle)), np.arange(len(middle)), middle) - middle[0]
        parts = [times, *_mean_cycle(time, force, cycles.middle, self.near)]
        if self.first_load > 0.0:
            edges = middle[0] - self.first_load * np.linspace(1.0, 0.03, LOADING_BINS + 1)
            parts.append(means_between(time, force, edges))
        return np.concatenate(parts)


def _time_places(events: int) -> np.ndarray:
    """Events whose times are compared: all of a few, evenly spread ones of many; the first is the origin."""
    return np.linspace(1, events - 1, min(TIMES, events - 1))


def _mean_cycle(time: np.ndarray, force: np.ndarray, middle: np.ndarray, near: float) -> tuple[np.ndarray, np.ndarray]:
    """Mean force around a drop, in time, and between drops, in parts of the period."""
    whole = middle[(middle - near > time[0]) & (middle + near < time[-1])]
    around = np.interp(whole[:, None] + near * NEAR, time, force).mean(axis=0)
    between = middle[:-1, None] + np.diff(middle)[:, None] * BETWEEN
    return around, np.interp(between, time, force).mean(axis=0)


MEDIANS = ('period', 'drop', 'peak', 'slope')


def medians(time: np.ndarray, force: np.ndarray, falls: Falls) -> tuple[np.ndarray, np.ndarray]:
    """Medians of `MEDIANS` over the events, and the numbers of each event they are taken of."""
    gaps = np.diff(falls.middle)
    # Slope of the loading: from a quarter to three quarters of the way from a trough to the next peak.
    begin, end = falls.end[:-1], falls.onset[1:]
    quarter = np.interp(begin + 0.25 * (end - begin), time, force)
    later = np.interp(begin + 0.75 * (end - begin), time, force)
    slope = (later - quarter) / np.maximum(0.5 * (end - begin), 1e-300)
    each = np.column_stack([gaps, (falls.peak - falls.trough)[1:], falls.peak[1:], slope])
    return np.median(each, axis=0), each


def rises(time: np.ndarray, force: np.ndarray, falls: Falls) -> np.ndarray:
    """Slopes of straight lines through the middle half of each rise: with all its samples, less noisy than `medians` are."""
    slopes = []
    for begin, end in zip(falls.end[:-1], falls.onset[1:]):
        inner = slice(*np.searchsorted(time, (0.75 * begin + 0.25 * end, 0.25 * begin + 0.75 * end)))
        if inner.stop - inner.start > 2:
            moment = time[inner] - time[inner].mean()
            slopes.append(moment @ force[inner] / (moment @ moment))
    return np.array(slopes)


def make_target(analysis: Analysis, rig: float = RIG) -> Target:
    """What of this record is to be fitted. rig: part of the slope of a scattered record's loading that stiffness, velocity
    and units may be wrong by; 0 where one of them is found from it."""
    falls = analysis.falls
    near = min(0.2 * analysis.period, 3.0 * float(np.median(falls.end - falls.onset)))
    if analysis.scattered:
        values, each = medians(analysis.time, analysis.force, falls)
        errors = errors_of_medians(each, 200)
        unknown = np.where(np.array(MEDIANS) == 'slope', rig * np.abs(values), 0.0)
        return Target(analysis, SKIPPED + SETTLED, MEDIANS, values, np.hypot(errors, unknown), np.abs(values), 0.0, near, rig,
                      np.empty(0))
    events = min(len(falls), MOST_EVENTS)
    first_load = falls.middle[0] if analysis.from_rest else 0.0
    blank = Target(analysis, events + (0 if analysis.from_rest else SKIPPED), (), np.empty(0), np.empty(0), np.empty(0),
                   first_load, near, rig, _wander(analysis))
    values = blank._repeating(analysis.time, analysis.force, falls.part(slice(None, events)))
    names, noise, scale = _errors(blank, events, values)
    return dataclasses.replace(blank, names=names, values=values, noise=noise, scale=scale)


WANDERS = 1.5      # times what samples vary by themselves: cycles that differ by more have noise that lasts


def _wander(analysis: Analysis) -> np.ndarray:
    """What the force differs by from the mean cycle, sample after sample, if that is more than white noise makes, which is
    all that neighbouring samples show: noise of a filter or of a surface, by which whole cycles differ."""
    time, force, middle = analysis.time, analysis.force, analysis.falls.middle
    if analysis.from_rest:   # the first events may differ, and the model's do so, too
        middle = middle[unsettled_events(time, analysis.falls, analysis.noise):]
    places = np.arange(0, len(middle) - 1)[:, None] + BETWEEN
    cycles = np.interp(np.interp(places, np.arange(len(middle)), middle), time, force)
    mean = cycles.mean(axis=0)
    left = np.sqrt(len(cycles) / (len(cycles) - 1.0))   # of a deviation from the mean, which has a part of it
    if left * np.std(cycles - mean) < WANDERS * np.std(analysis.white_noise(np.random.default_rng(0), time.size)):
        return np.empty(0)
    phase = np.interp(time, middle, np.arange(len(middle)))
    inner = (phase > 0.0) & (phase < len(middle) - 1.0) & (phase % 1.0 > BETWEEN[0]) & (phase % 1.0 < BETWEEN[-1])
    deviation = force[inner] - np.interp(phase[inner] % 1.0, BETWEEN, mean)
    span = slice(int(np.argmax(inner)), inner.size - int(np.argmax(inner[::-1])))
    found = left * np.interp(time[span], time[inner], deviation)   # straight across the drops
    return found - found.mean()


def median_of_blocks(each: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Medians of events drawn with replacement in blocks of neighbours, which keeps what events do to the next ones."""
    n = len(each)
    block = max(1, round(n ** (1.0 / 3.0)))
    starts = rng.integers(0, n, size=-(-n // block))
    chosen = (starts[:, None] + np.arange(block)).ravel()[:n] % n
    return np.median(each[chosen], axis=0)


def errors_of_medians(each: np.ndarray, number: int) -> np.ndarray:
    """Standard deviations of the medians over so many draws. numpy's generators spawn others from 1.25 on, their seeds before."""
    seeds = np.random.SeedSequence(0).spawn(number)
    return np.std([median_of_blocks(each, np.random.default_rng(seed)) for seed in seeds], axis=0)


def _errors(target: Target, events: int, values: np.ndarray) -> tuple[tuple[str, ...], np.ndarray, np.ndarray]:
    """Names, errors by noise and scales of the features of a record whose events repeat."""
    lasting = target.wander
    if target.analysis.uneven and not lasting.size:   # straight lines between samples
        lasting = target.analysis.white_noise(np.random.default_rng(0), target.analysis.time.size)
    noise = float(np.std(lasting)) if lasting.size else target.analysis.noise
    times = len(_time_places(events))
    around = values[times:times + NEAR.size]
    amplitude = np.ptp(around)
    slope = np.abs(np.gradient(around, target.near * NEAR))
    timing = max(noise / max(slope.max(), 1e-300), 0.05 * target.analysis.step)   # of the middle of one fall
    level = noise / np.sqrt(events)
    parts = [('event times', np.full(times, timing), 0.05 * np.abs(values[:times])),
             ('drop', np.hypot(level, slope * timing / np.sqrt(events)), np.full(NEAR.size, amplitude)),
             ('cycle', np.full(BETWEEN.size, level), np.full(BETWEEN.size, amplitude))]
    if target.first_load > 0.0:
        samples = max(1.0, target.first_load / (LOADING_BINS * target.analysis.step))
        of_means = np.std(average(lasting, int(samples))) if lasting.size else noise / np.sqrt(samples)
        parts.append(('first loading', np.full(LOADING_BINS, of_means), np.full(LOADING_BINS, amplitude)))
    names = tuple(name for name, errors, _ in parts for _ in errors)
    return names, np.concatenate([errors for _, errors, _ in parts]), np.concatenate([scale for _, _, scale in parts])


def outline(falls: Falls, first_load: float, scale: float, period: float) -> np.ndarray | None:
    """A few numbers that change smoothly over the whole range of the constants, in units of a small change of each: for
    the first, coarse search. Times count by the logarithms of their ratio to `period`, forces by `scale`."""
    if len(falls) < 3:
        return None
    late = falls.part(slice(1, None))

    def log(value: float) -> float:
        return float(np.log(max(value / period, 1e-300)))

    numbers = [log(np.median(np.diff(falls.middle))) / 0.01, np.median(late.peak) / (0.02 * scale),
               np.median(late.trough) / (0.02 * scale), log(np.median(late.end - late.onset)) / 0.05]
    if first_load > 0.0:
        numbers += [log(falls.middle[0]) / 0.04, falls.peak[0] / (0.04 * scale)]
    return np.array(numbers)
