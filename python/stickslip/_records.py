"""Measured records of a force against time, and what they show: noise, events, their scatter."""
from __future__ import annotations

import dataclasses
import os
import pathlib
from collections.abc import Mapping
from typing import Any

import numpy as np

from . import _namelist, _program
from ._arrays import number, row_of
from ._optional import needed


class RecordError(ValueError):
    """A record that cannot be fitted; the text says why, where, and what to do."""


@dataclasses.dataclass(frozen=True, eq=False)
class Record:
    """A measured force of the drive spring.

    time: when the force was measured, increasing [T]; force: there, positive when the spring pulls the way the drive
    goes [F]; settings: keys of the model's input that differ for this record, by groups, for instance
    ``{'drive': {'velocity': 2.0}, 'slider': {'stiffness': 5.0}}``; name: for messages and pictures; from_rest: does the
    record begin in, or shortly before, the first loading of a slack spring, with the block at rest? None: detected.
    """

    time: np.ndarray
    force: np.ndarray
    settings: dict[str, dict[str, Any]] = dataclasses.field(default_factory=dict)
    name: str = 'record'
    from_rest: bool | None = None

    def __post_init__(self) -> None:
        self._check_kinds()
        for name in ('time', 'force'):
            object.__setattr__(self, name, _numbers(getattr(self, name), f'{self.name}: {name}'))
        object.__setattr__(self, 'settings', _namelist.groups_of(self.settings))
        self._check()

    @classmethod
    def read(cls, path: str | pathlib.Path, *, time: str = 'time', force: str = 'spring_force', time_factor: float = 1.0,
             force_factor: float = 1.0, force_offset: float = 0.0, start: float | None = None, end: float | None = None,
             settings: dict[str, dict[str, Any]] | None = None, name: str | None = None,
             from_rest: bool | None = None) -> Record:
        """Reads a record from a table (CSV or other separated text with a header), or from a MATLAB file (.mat).

        time, force: names of the columns, exact, or ignoring case and a unit after the name, if only one column matches;
        time_factor, force_factor: factors for the values read, for other units; force_offset: added to the force
        afterwards [F]; start, end: the part of the record to use, in its own time [T]; the others as for `Record`.
        """
        if not isinstance(path, (str, os.PathLike)):
            raise TypeError(f'path = {path!r}: the name of a file is needed')
        path = pathlib.Path(path)
        for what, column in (('time', time), ('force', force)):
            if not isinstance(column, str):
                raise TypeError(f'{path}: {what} = {column!r}: the name of a column is needed')
        if time == force:
            raise RecordError(f'{path}: time and force are both {time!r}: two columns are needed')
        _check_numbers(path, time_factor=time_factor, force_factor=force_factor, force_offset=force_offset, start=start, end=end)
        moment, pull = (_numbers(values, f'{path}: {column!r}')
                        for column, values in zip((time, force), _read_columns(path, (time, force))))
        moment, pull = moment * time_factor, pull * force_factor + force_offset
        if moment.size == pull.size:   # else the record says so
            keep = np.ones(moment.size, bool)
            if start is not None:
                keep &= ~(moment < start)
            if end is not None:
                keep &= ~(moment > end)
            if not keep.any() and moment.size > 0:
                raise RecordError(f'{path}: no sample lies between start and end: the record goes from {moment[0]:g} to {moment[-1]:g}')
            moment, pull = moment[keep], pull[keep]
        return cls(moment, pull, settings or {}, name or path.stem, from_rest)

    def _check_kinds(self) -> None:
        """Refuses what is not of the right kind, beside the numbers."""
        if not isinstance(self.name, str):
            raise TypeError(f'name = {self.name!r}: text is needed')
        if not (self.from_rest is None or isinstance(self.from_rest, (bool, np.bool_))):
            raise TypeError(f'{self.name}: from_rest = {self.from_rest!r}: True, False or None is needed')
        if not isinstance(self.settings, Mapping):
            raise TypeError(f'{self.name}: settings: a dict of groups is needed, not {self.settings!r}')

    def refuse(self, why: str) -> None:
        """Raises RecordError."""
        raise RecordError(f'{self.name}: {why}')

    def _check(self) -> None:
        t, force = self.time, self.force
        if t.size != force.size:
            self.refuse(f'{t.size} times, but {force.size} forces')
        if t.size < 50:
            self.refuse(f'{t.size} samples are too few; at least 50 are needed')
        bad = ~(np.isfinite(t) & np.isfinite(force))
        if bad.any():
            self.refuse(f'sample {int(np.argmax(bad)) + 1} of {t.size} is not a finite number')
        step = np.diff(t)
        if step.min() <= 0.0:
            i = int(np.argmin(step))
            self.refuse(f'time does not increase from {t[i]:g} to {t[i + 1]:g} (sample {i + 2})')


def _numbers(values: Any, what: str) -> np.ndarray:
    """A time or a force as an array of its own, of one dimension."""
    try:
        return row_of(values, what).copy()
    except (TypeError, ValueError) as error:
        raise RecordError(str(error)) from None


def _check_numbers(path: pathlib.Path, **given: Any) -> None:
    """Refuses factors, and ends of a part, that make no record."""
    for name, value in given.items():
        if value is None and name in ('start', 'end'):
            continue
        try:
            finite = np.isfinite(number(value, name))
        except (TypeError, ValueError):
            finite = False
        if not finite:
            raise RecordError(f'{path}: {name} = {value!r}: must be a finite number')
    if not given['time_factor'] > 0.0:
        raise RecordError(f'{path}: time_factor = {given["time_factor"]}: must be > 0')
    if given['force_factor'] == 0.0:
        raise RecordError(f'{path}: force_factor = 0: must not be 0')
    start, end = given['start'], given['end']
    if start is not None and end is not None and not start < end:
        raise RecordError(f'{path}: start = {start:g}, end = {end:g}: start must be below end')


def _read_columns(path: pathlib.Path, names: tuple[str, ...]) -> list[np.ndarray]:
    """Columns of a file, by name, under the rules that the program has for tables."""
    if path.suffix.lower() == '.mat':
        return _matlab_columns(path, names)
    found, faults = _program.columns(path.read_bytes(), names)
    if faults:
        raise RecordError('\n'.join(f'{path}: {fault}' for fault in faults.splitlines()))
    return list(found)


def _matlab_columns(path: pathlib.Path, names: tuple[str, ...]) -> list[np.ndarray]:
    io = needed('scipy.io', 'fit')
    try:
        table = io.loadmat(path, appendmat=False)
    except (io.matlab.MatReadError, NotImplementedError, ValueError, TypeError, IndexError) as error:
        raise RecordError(f'{path}: not a MATLAB file that can be read ({error})') from None
    for name in names:
        if name not in table:
            raise RecordError(f'{path}: no variable {name!r}; there are '
                              + ', '.join(key for key in table if not key.startswith('__')))
    return [table[name] for name in names]


@dataclasses.dataclass(frozen=True, eq=False)
class Falls:
    """Falls of a force: the slip events of a record or of a model, in their order."""

    onset: np.ndarray     #: time of the peak [T]
    end: np.ndarray       #: time of the trough [T]
    middle: np.ndarray    #: time at which half of the fall is over [T]
    peak: np.ndarray      #: force there [F]
    trough: np.ndarray    #: force there [F]

    def __len__(self) -> int:
        return self.onset.size

    def part(self, selection: slice) -> Falls:
        """Some of them."""
        return Falls(*(getattr(self, field.name)[selection] for field in dataclasses.fields(self)))


def smooth(force: np.ndarray, samples: int) -> np.ndarray:
    """Moving mean over an odd number of samples; the ends are held."""
    if samples <= 1:
        return force
    half = samples // 2
    padded = np.concatenate([np.full(half + 1, force[0]), force, np.full(half, force[-1])])
    total = np.cumsum(padded)
    return (total[2 * half + 1:] - total[:-2 * half - 1]) / (2 * half + 1)


def means_between(time: np.ndarray, force: np.ndarray, edges: np.ndarray) -> np.ndarray:
    """Mean force between one time and the next; before the first sample there is none."""
    impulse = np.concatenate([[0.0], np.cumsum(0.5 * (force[1:] + force[:-1]) * np.diff(time))])
    return np.diff(np.interp(edges, time, impulse)) / np.diff(edges)


def average(values: np.ndarray, samples: int) -> np.ndarray:
    """Means of so many samples each; what is left over at the end is dropped."""
    return values[:values.size // samples * samples].reshape(-1, samples).mean(axis=1)


def find_falls(time: np.ndarray, force: np.ndarray, threshold: float) -> Falls:
    """Falls by more than `threshold` that the force has made up for by as much again, or at the end of the record."""
    turn = np.flatnonzero(np.diff(np.sign(np.diff(force))) != 0) + 1
    places = np.concatenate([[0], turn, [force.size - 1]])
    peaks, troughs = [], []
    high = low = 0
    falling = False
    for i, value in zip(places.tolist(), force[places].tolist()):
        if falling:
            if value < force[low]:
                low = i
            elif value > force[low] + threshold:
                peaks.append(high)
                troughs.append(low)
                falling, high = False, i
        elif value > force[high]:
            high = i
        elif value < force[high] - threshold:
            falling, low = True, i
    if falling and low < force.size - 1:
        peaks.append(high)
        troughs.append(low)
    middle = np.empty(len(peaks))
    for k, (i, j) in enumerate(zip(peaks, troughs)):
        level = 0.5 * (force[i] + force[j])
        below = i + int(np.argmax(force[i:j + 1] < level))
        part = (force[below - 1] - level) / (force[below - 1] - force[below])
        middle[k] = time[below - 1] + part * (time[below] - time[below - 1])
    at_peak, at_trough = np.array(peaks, int), np.array(troughs, int)
    return Falls(time[at_peak], time[at_trough], middle, force[at_peak], force[at_trough])


@dataclasses.dataclass(frozen=True, eq=False)
class Analysis:
    """A record made ready: from time 0, evenly sampled, with its events."""

    record: Record
    time: np.ndarray       #: from 0 [T]
    force: np.ndarray      #: without drift [F]
    averaged: int          #: samples of the record in the mean that each sample is
    noise: float           #: standard deviation of a sample; of uneven ones what their means have times its root [F]
    own_noise: float       #: of the record's own samples [F]
    window: int            #: samples of the moving mean before events are looked for
    threshold: float       #: least fall of an event [F]
    falls: Falls
    from_rest: bool
    scattered: bool        #: do period or drop vary from event to event by more than a tenth?
    warnings: tuple[str, ...]
    sense: float           #: -1 where the drive goes backwards: forces here are those of the mirrored rig
    straightened: bool     #: was a steady drift taken out?

    @property
    def step(self) -> float:
        """Time between samples [T]."""
        return self.time[1] - self.time[0]

    @property
    def row_step(self) -> float:
        """Time between rows of a simulation that is to be sampled like the record [T]."""
        return self.step / self.averaged / (FINER if self.uneven or self.sparse else 1)

    @property
    def sparse(self) -> bool:
        """Has a fall so few samples that it counts where in the fall they are?"""
        return bool(np.median(self.falls.end - self.falls.onset) < FEW_SAMPLES * self.step_in_falls)

    @property
    def step_in_falls(self) -> float:
        """Time between the record's own samples where the force falls, median [T]."""
        own = self.record.time - self.record.time[0]
        return float(np.median(np.diff(own)[np.searchsorted(own[1:-1], self.falls.middle)]))

    @property
    def uneven(self) -> bool:
        """Are the record's samples not taken at even times?"""
        return _uneven(self.record.time)

    def like(self, time: np.ndarray, force: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Another force against time, sampled and averaged as the record is."""
        fine = np.arange(0.0, time[-1], self.step / self.averaged)
        if self.uneven:   # sparse samples cut peaks off
            own = self._own_times(time[-1])
            time, force = own, np.interp(own, time, force)
        return average(fine, self.averaged), average(np.interp(fine, time, force), self.averaged)

    def white_noise(self, rng: np.random.Generator, size: int) -> np.ndarray:
        """Noise that varies from sample to sample, as the force has it: between samples that are not even it is a straight
        line."""
        if not self.uneven:
            return rng.normal(scale=self.noise, size=size)
        fine = self.step / self.averaged * np.arange(size * self.averaged)
        own = self._own_times(fine[-1])
        return average(np.interp(fine, own, rng.normal(scale=self.own_noise, size=own.size)), self.averaged)

    def _own_times(self, end: float) -> np.ndarray:
        """Times of the record's own samples from 0 on, again and again up to some time."""
        own = self.record.time - self.record.time[0]
        length = own[-1] + self.step
        return np.concatenate([own + k * length for k in range(int(end / length) + 1)])

    @property
    def period(self) -> float:
        """Median time between events [T]."""
        return float(np.median(np.diff(self.falls.middle)))

    @property
    def drop(self) -> float:
        """Median fall of an event [F]."""
        return float(np.median(self.falls.peak - self.falls.trough))


LEAST_EVENTS = 5
FINER = 4               # rows of a simulation in a step of a record whose samples lie between rows
FEW_SAMPLES = 8         # of a fall
SAMPLES_A_PERIOD = 200
SAMPLES_A_FALL = 30


def analyse(record: Record, sense: float = 1.0, settled: bool = False) -> Analysis:
    """Finds the events of a record, or refuses it in words. sense: -1 where the drive goes backwards; the force may then be
    given with the sign that the program has for it, or as for a drive that goes forwards. settled: are the first events known to be
    like the others?"""
    if sense < 0.0 and np.median(record.force) < 0.0:
        record = dataclasses.replace(record, force=-record.force)
    time, force, noise, own_noise = _even(record)
    if np.median(force) < 0.0 and np.median(force) < -3.0 * noise:
        record.refuse('the force is negative: it acts against the drive. Turn its sign (force_factor=-1), or the '
                      "drive's velocity")
    force, warnings = _without_spikes(record, force, noise)
    window, threshold, falls = _events(record, time, force, noise)
    period = np.median(np.diff(falls.middle))
    _check_gaps(record, period)
    warnings += _check_shape(record, falls)
    from_rest, of_start = _begins_at_rest(record, time, smooth(force, window), falls)
    warnings += of_start
    if not (from_rest or settled) and (early := unsettled_events(time, falls, noise)):
        told = (f'{record.name}: the first {f"{early} events differ" if early > 1 else "event differs"} from the later ones: the slider '
                'had not settled, or the surface was changing, when the record began')
        if len(falls) - early >= LEAST_EVENTS:
            late = record.time > record.time[0] + falls.end[early - 1]
            rest = dataclasses.replace(record, time=record.time[late], force=record.force[late], from_rest=False)
            found = analyse(rest, sense, settled=True)
            return dataclasses.replace(found, warnings=(*of_start, f'{told}; left out', *found.warnings))
        warnings.append(f'{told}; too few are left without: take a longer record')
    trend, drift = _drift(record, time, force, falls, from_rest, noise)
    if drift:
        force = force - trend
        falls = dataclasses.replace(falls, peak=falls.peak - np.interp(falls.onset, time, trend),
                                    trough=falls.trough - np.interp(falls.end, time, trend))
        warnings.append(f'{record.name}: {drift}')
    fine = min(period / SAMPLES_A_PERIOD, np.median(falls.end - falls.onset) / SAMPLES_A_FALL)
    coarser = max(1, int(fine / (time[1] - time[0])))
    if coarser > 1:
        time, force = average(time, coarser), average(force, coarser)
        noise /= np.sqrt(coarser)
        window = max(1, window // coarser // 2 * 2 + 1)
        falls = find_falls(time, smooth(force, window), threshold)
    return Analysis(record, time, force, coarser, noise, own_noise, window, threshold, falls, from_rest, _scatters(falls), tuple(warnings),
                    sense, bool(drift))


def _scatters(falls: Falls) -> bool:
    """Do period or drop vary from event to event? Quartiles keep single outliers from making a record a scattered one."""
    gaps, drops = np.diff(falls.middle), falls.peak - falls.trough
    return bool(max(spread(gaps) / np.median(gaps), spread(drops[1:]) / np.median(drops)) > 0.1)


def spread(values: np.ndarray) -> float:
    """Standard deviation of normally distributed values, from their quartiles."""
    return float(np.subtract(*np.percentile(values, [75, 25])) / 1.349)


def _uneven(time: np.ndarray) -> bool:
    """Are samples not taken at even times?"""
    steps = np.diff(time)
    step = float(np.median(steps))
    return bool(np.abs(steps - step).max() > 1e-3 * step)


def _even(record: Record) -> tuple[np.ndarray, np.ndarray, float, float]:
    """The record from time 0 on even samples, their noise, and that of its own samples."""
    steps = np.diff(record.time)
    step = float(np.median(steps))
    time = record.time - record.time[0]
    force = record.force
    # From the straight line between its neighbours a sample differs by noise: neither the level nor the slope of the force
    # counts. Where most do not differ, the force is known in steps, or rests.
    before = steps[1:] / (steps[:-1] + steps[1:])   # weight of the neighbour before
    apart = (force[1:-1] - before * force[:-2] - (1.0 - before) * force[2:]) / np.sqrt(1.0 + before**2 + (1.0 - before)**2)
    own_noise = spread(apart)
    if own_noise == 0.0 and np.count_nonzero(apart) > 3:
        own_noise = spread(apart[apart != 0.0])
    noise = own_noise
    if _uneven(record.time):
        even = np.arange(0.0, time[-1], step)
        # Where samples are sparse, several even ones have the noise of one, and means of them more than so many would.
        apart = 0.5 * (steps[:-1] + steps[1:])
        noise *= np.sqrt(np.sum(apart * np.maximum(apart, step)) / (step * apart.sum()))
        time, force = even, np.interp(even, time, force)
    else:
        time = step * np.arange(time.size)
    return time, force, noise, own_noise


def _events(record: Record, time: np.ndarray, force: np.ndarray, noise: float) -> tuple[int, float, Falls]:
    """Smooths more and more until noise makes no events, but never over more than a part of the period."""
    late = force[force.size // 4:]
    range_ = float(np.subtract(*np.percentile(late, [98, 2])))
    window, count = 1, 0
    while True:
        left = noise / np.sqrt(window)   # of the noise, after smoothing
        threshold = max(0.2 * range_, 8.0 * left)
        if threshold < 0.5 * range_:
            falls = find_falls(time, smooth(force, window), threshold)
            count = max(count, len(falls))
            if len(falls) >= 2:
                typical = float(np.median(falls.peak - falls.trough))
                # Slow changes of the level widen the range: judge by the events themselves.
                threshold = max(0.3 * typical, 8.0 * left)
                falls = find_falls(time, smooth(force, window), threshold)
                if threshold < 0.6 * typical:
                    break
        window = 2 * window + 1
        if window > force.size // 20:
            _refuse_without_events(record, count, noise, range_)
    if len(falls) < LEAST_EVENTS:
        _refuse_without_events(record, len(falls), noise, range_)
    gaps = np.diff(falls.middle)
    rest = time[-1] - falls.middle[-1]
    if rest > 5.0 * np.median(gaps) and rest > 0.25 * time[-1]:
        record.refuse(f'no sustained stick-slip: the last event ends at {record.time[0] + falls.end[-1]:g}, the record at '
                      f'{record.time[-1]:g}; take the part with events alone (end)')
    period = float(np.median(gaps))
    if window * (time[1] - time[0]) > 0.25 * period:
        record.refuse(f'the noise ({noise:.3g}) is above what can be smoothed away within a period ({period:.3g}); the '
                      f'drops are about {typical:.3g}')
    return window, threshold, falls


def _refuse_without_events(record: Record, count: int, noise: float, range_: float) -> None:
    if range_ > 20.0 * noise:
        record.refuse(f'no sustained stick-slip, or {count} slip events, which are too few; at least {LEAST_EVENTS} are '
                      'needed: take a longer record, or another part of it (start, end)')
    record.refuse('no sustained stick-slip: the noise, or whatever changes from sample to sample, is as large as the falls '
                  f'of the force (noise {noise:.3g}, range of the force {range_:.3g}). Velocity steps and holds are for fit_rate_and_state')


def _without_spikes(record: Record, force: np.ndarray, noise: float) -> tuple[np.ndarray, list[str]]:
    """Samples that stand out alone, or two together, take the median of their neighbours; more than a few are left alone."""
    around = np.lib.stride_tricks.sliding_window_view(np.pad(force, 2, mode='edge'), 5)
    middle = np.median(around, axis=1)
    range_ = float(np.subtract(*np.percentile(force[force.size // 4:], [98, 2])))
    spikes = np.abs(force - middle) > max(15.0 * noise, 0.2 * range_)
    count = int(np.count_nonzero(spikes))
    if not 0 < count <= max(1, force.size // 50):
        return force, []
    return np.where(spikes, middle, force), [f'{record.name}: {count} samples differ strongly from their neighbours and were omitted, '
                                             f'the first at {record.time[int(np.argmax(spikes))]:g}']


def _check_shape(record: Record, falls: Falls) -> list[str]:
    """In stick-slip the force rises slowly and falls fast."""
    falling = float(np.median(falls.end - falls.onset))
    rising = float(np.median(falls.onset[1:] - falls.end[:-1]))
    if falling > 2.0 * rising:
        record.refuse(f'the force falls slowly ({falling:.3g}) and rises fast ({rising:.3g}): it has the wrong sign. Turn it '
                      '(force_factor=-1), with the offset that makes the force of a slack spring 0')
    if falling > 0.7 * rising:
        return [f'{record.name}: the force rises ({rising:.3g}) hardly more slowly than it falls ({falling:.3g}): this is an '
                'oscillation or noise rather than stick-slip']
    return []


def _check_gaps(record: Record, period: float) -> None:
    steps = np.diff(record.time)
    i = int(np.argmax(steps))
    if steps[i] > max(0.1 * period, 3.0 * np.median(steps)):
        record.refuse(f'nothing was recorded from {record.time[i]:g} to {record.time[i + 1]:g}, a large part of a period '
                      f'({period:.3g}); take the part before or after (start, end)')


def _begins_at_rest(record: Record, time: np.ndarray, force: np.ndarray, falls: Falls) -> tuple[bool, list[str]]:
    """Does the record begin with the loading of a slack spring? Not where the drive starts some time later: the moment is not
    known well enough."""
    if record.from_rest is not None:
        return record.from_rest, []
    if not force[0] < max(0.05 * np.median(falls.peak), 0.5 * np.median(falls.trough)):   # a cycle may begin there, too
        return False, []
    first = falls.onset[0]
    rise = force[0] + np.array([0.2, 0.6]) * (falls.peak[0] - force[0])
    before = time <= first
    early, later = (float(time[before][np.argmax(force[before] > level)]) for level in rise)
    start = early - 0.5 * (later - early)   # where a straight rise began
    if start < 0.15 * first:
        return True, []
    return False, [f'{record.name}: the force begins to rise at about {record.time[0] + start:g} only: the first loading is not '
                   'fitted. If the drive starts then, begin the record there (start)']


PEAK_NOISE = 0.5       # of the noise of a sample: what peaks vary by at least, each the largest of a few samples


def unsettled_events(time: np.ndarray, falls: Falls, noise: float) -> int:
    """How many events at the start differ from what the later half, with its drift, says they would be, where those after them do
    not. Where many do, the level wanders, and where the events scatter, nothing can be said."""
    if _scatters(falls):
        return 0
    timing = max(0.5 * (time[1] - time[0]), noise * float(np.median((falls.end - falls.onset) / (falls.peak - falls.trough))))
    unsettled = 0
    for values, least in ((falls.peak, PEAK_NOISE * noise), (falls.trough, PEAK_NOISE * noise), (np.diff(falls.middle), timing)):
        half = values.size // 2
        late, since = values[half:], falls.onset[:values.size] - falls.onset[half:values.size].mean()
        length, known = since[half:] @ since[half:], late.size + 2.0   # noise counts like four events
        slope = since[half:] @ late / length
        apart = values - late.mean() - slope * since
        error = np.sqrt((apart[half:] @ apart[half:] + 4.0 * least**2) / known)
        if abs(slope) * np.sqrt(length) < 3.0 * error:   # no drift that could be told
            apart, since = values - late.mean(), np.zeros_like(since)
        expected = 4.5 * (1.0 + 4.0 / known) * error * np.sqrt(1.0 + 1.0 / late.size + since**2 / length)
        unsettled = max(unsettled, int(np.max(np.flatnonzero(np.abs(apart[:half]) > expected[:half]) + 1, initial=0)))
    return unsettled if unsettled <= len(falls) // 3 else 0


def _drift(record: Record, time: np.ndarray, force: np.ndarray, falls: Falls, from_rest: bool,
           noise: float) -> tuple[np.ndarray, str]:
    """A steady drift of the peaks, to be taken out, and words on it, or ''; one of more than the force itself is refused."""
    late = falls.part(slice(1, None))
    if len(late) < 4:
        return np.zeros_like(time), ''
    # Sparse samples cut peaks and troughs off: where there are fewer in a part of the record, that is no drift.
    levels = 0.5 * (late.peak + late.trough) if _uneven(record.time) else late.peak
    line = np.polyfit(late.onset, levels, 1)
    residual = levels - np.polyval(line, late.onset)
    # A few peaks may lie on a line by chance.
    scatter = max(np.std(residual) * np.sqrt(len(late) / (len(late) - 2.0)), PEAK_NOISE * noise)
    error = scatter / (np.std(late.onset) * np.sqrt(len(late)))
    rise = line[0] * (late.onset[-1] - late.onset[0])
    drop = float(np.median(late.peak - late.trough))
    if abs(rise) < 0.03 * drop or abs(line[0]) < 5.0 * error or abs(rise) < 2.0 * np.std(residual):
        return np.zeros_like(time), ''
    level = float(np.median(late.peak))
    if abs(rise) > 0.5 * level:
        record.refuse(f'the peaks drift by {rise:.3g}, more than half of their level {level:.3g}: a sensor or a surface '
                      'that changes so much is not what the model describes. Parts with one normal traction each may be records of '
                      'their own (start, end)')
    trend = straight_trend(time, force, falls, from_rest)
    drift = float(np.interp(late.onset[-1], time, trend) - np.interp(late.onset[0], time, trend))
    return trend, (f'the peaks drift by {drift:.3g} over the record, {abs(drift) / drop:.0%} of a drop; a straight line was '
                   'taken out, and errors allow for it')


def straight_trend(time: np.ndarray, force: np.ndarray, falls: Falls, from_rest: bool) -> np.ndarray:
    """The straight line on which the mean forces of the cycles lie, which have far less noise than peaks. The force of a spring
    that is slack at the start is right there, that of others in the middle."""
    edges = falls.middle[1:]
    slope, _ = np.polyfit(0.5 * (edges[1:] + edges[:-1]), means_between(time, force, edges), 1)
    return slope * (time - (0.0 if from_rest else 0.5 * (falls.onset[1] + falls.onset[-1])))
