"""Constants of a friction law from measured records of stick-slip (docs/fitting.md)."""
from __future__ import annotations

import concurrent.futures
import dataclasses
import hashlib
import numbers
import os
import pathlib
import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _namelist
from ._features import FLOOR, MEDIANS, RIG, Target, errors_of_medians, make_target, medians, rises
from ._namelist import InputError
from ._records import LEAST_EVENTS, Analysis, Record, analyse, means_between
from ._run import check_runs, spring_force
from ._search import (
    FOLLOWS,
    Constant,
    Journal,
    Limits,
    NoStickSlip,
    Problem,
    Simulate,
    along_valley,
    checked_bounds,
    replicas,
    search,
    set_times,
)

if TYPE_CHECKING:
    import matplotlib.figure

NORMAL = 1.959964       # standard deviations of a 95 % interval
UNDETERMINED = 0.2      # standard deviation of a constant's logarithm from which on the records do not determine it
REPLICAS = 100          # of the records with other noise, or with other events
VELOCITY_FACTOR = (0.8, 1.25)   # its bounds, unless given
RIG_KEYS = {('drive', 'velocity'), ('slider', 'stiffness')}   # what the slope of the loading tells about the rig
RIG_GROUPS = ('friction', 'slider', 'drive', 'initial', 'chain')   # other groups say how to compute, and what to write
RINGING_TIMES = 10.0    # least period without jumps of the response


@dataclasses.dataclass(frozen=True, eq=False)
class Fit:
    """What `fit` found."""

    values: dict[str, float]                       #: of the constants
    intervals: dict[str, tuple[float, float]]      #: 95 % intervals
    correlation: np.ndarray                        #: of the constants' logarithms, in the order of `values`
    undetermined: list[str]                        #: constants that the records do not determine
    misfit: dict[str, dict[str, float]]            #: by record and feature: root mean square, in standard deviations
    warnings: list[str]
    evaluations: int                               #: candidates that were simulated
    model: dict[str, dict[str, Any]]               #: input with the values found, as groups of keys
    _targets: tuple[Target, ...] = dataclasses.field(repr=False)
    _problem: Problem = dataclasses.field(repr=False)
    _candidate: np.ndarray = dataclasses.field(repr=False)

    def __str__(self) -> str:
        lines = []
        for name, value in self.values.items():
            low, high = self.intervals[name]
            remark = '   not determined by these records' if name in self.undetermined else ''
            lines.append(f'{name:16s} {value:12.5g}   95 % interval {low:.5g} to {high:.5g}{remark}')
        for record, features in self.misfit.items():
            lines.append(f'misfit of {record}: ' + ', '.join(f'{name} {value:.2g}' for name, value in features.items()))
        return '\n'.join(lines + [f'warning: {warning}' for warning in self.warnings])

    def settings(self, record: int = 0) -> dict[str, dict[str, Any]]:
        """Input of the program that computes a record with the values found, as groups of keys."""
        target = self._target(record)
        settings = self._problem.settings(self._candidate, target)
        set_times(settings, float(target.analysis.time[-1]), target.analysis.step)
        return settings

    def _target(self, record: int) -> Target:
        """What a record was compared by."""
        if not isinstance(record, numbers.Integral) or not 0 <= record < len(self._targets):
            raise IndexError(f'record = {record!r}: a whole number from 0 to {len(self._targets) - 1} is needed')
        return self._targets[record]

    def write_namelist(self, path: str | pathlib.Path, record: int = 0) -> None:
        """Writes an input for `stickslip run`: the model of one of the records."""
        found = ', '.join(f'{name} {self.values[name]:.5g}' for name in self.values)
        self._target(record)
        names = [' '.join(target.analysis.record.name.split()) for target in self._targets]   # in one line
        text = (f'! Fitted to {", ".join(names)}: {found}\n'
                f'! Drive and end are those of {names[record]}.\n\n')
        pathlib.Path(path).write_text(text + _namelist.written(self.settings(record)), encoding='utf-8')

    def predict(self, record: Record) -> dict[str, dict[str, float]]:
        """Compares the model with a record, which need not be one of those fitted. For period, drop, peak and slope of the
        loading it returns the measured median over the events, its error (standard deviation, block bootstrap), the computed
        median, and the relative deviation; NaN if the model has no such events. The `settings` of the record replace those of
        the model.

        record: a record with slip events (otherwise RecordError).
        """
        if not isinstance(record, Record):
            raise TypeError('predict: record: an object of stickslip.Record is needed')
        return compare(self._problem, self._candidate, analyse(record, _sense(_namelist.merge(self.model, record.settings))))

    def plot(self, path: str | pathlib.Path | None = None) -> matplotlib.figure.Figure:
        """Draws record and model, the cycles superposed, and the residuals; one row per record.

        path: where to save the picture, PNG, PDF or SVG by its ending. Returns the matplotlib figure.
        """
        from ._fit_picture import draw
        figure = draw(self)
        if path is not None:
            figure.savefig(path)
        return figure

    def simulate(self, target: Target) -> tuple[np.ndarray, np.ndarray]:
        """Time and spring force of the model over the length of a record, settled where the record is."""
        end = max(float(target.analysis.time[-1]), self._problem.expected_end(target, target.events))
        result = self._problem.run(self._candidate, target, end)
        if result is None:
            raise RuntimeError('the run with the values found failed')
        return result


def compare(problem: Problem, candidate: np.ndarray, analysis: Analysis) -> dict[str, dict[str, float]]:
    """Medians over the events of a record against those of the model."""
    late = analysis.falls.part(slice(1 if analysis.from_rest else 0, None))
    measured, each = medians(analysis.time, analysis.force, late)
    errors = errors_of_medians(each, 200)
    settled = dataclasses.replace(analysis, scattered=True)
    target = dataclasses.replace(make_target(settled), analysis=settled)
    computed = problem.features(candidate, target)
    if computed is None:
        computed = np.full(len(MEDIANS), np.nan)
    return {name: {'measured': float(measured[k]), 'error': float(errors[k]), 'computed': float(computed[k]),
                   'deviation': float(computed[k] / measured[k] - 1.0)} for k, name in enumerate(MEDIANS)}


def fit(records: Record | Iterable[Record], input: str | pathlib.Path | dict, *, free: Sequence[str],
        bounds: float | Mapping[str, tuple[float, float]] = 5.0, seed: int = 1, starts: int = 128, jobs: int = 1,
        progress: bool | Callable[[str], None] | None = None, most_evaluations: int | None = None,
        most_seconds: float | None = None, checkpoint: str | pathlib.Path | None = None) -> Fit:
    """Finds constants with which the program's slider gives measured records of stick-slip.

    records: one or several; each may have its own settings in place of the input's, for example its drive.
    input: a namelist (name of the file, or its text) or a dict of groups as `run` takes them. Constants that are not
        free keep its values. Steps are adaptive, in continuous time, whatever its group ``&time`` says; an `rtol`
        above 1e-6 given there is used.
    free: names of the constants to find: keys of ``&friction``, or of ``&slider``, ``&drive``, ``&initial``, ``&chain`` as
        'slider.damping', 'slider.stiffness' (settings of the computation are not allowed); or 'velocity_factor', by which the drive
        velocities of all records are multiplied, if those of the rig are uncertain.
    bounds: a factor about the values of the input, or lower and upper bounds by name, for which the input needs no
        value; all above 0. Default for 'velocity_factor': 0.8 and 1.25.
    seed: random seed of the starting points; the same seed gives the same result, whatever `jobs` is.
    starts: number of points of a Sobol sequence within the bounds with which the search begins; a power of 2.
    jobs: number of simultaneous simulations.
    progress: True: lines on standard error; or a function that gets each line; None: lines if standard error is a terminal.
    most_evaluations, most_seconds: limits, at which the search stops with the best result so far and a warning.
    checkpoint: a file that stores the simulations. If it exists, the search continues from it.

    Raises RecordError if a record cannot be fitted (no sustained stick-slip, too few events, wrong sign, gaps, too
    much noise), ValueError if bounds or input are wrong; the text says what to do.
    """
    records, free = _listed(records, Record), _listed(free, str)
    if not all(isinstance(record, Record) for record in records):
        raise TypeError('fit: records: objects of stickslip.Record are needed')
    if not records:
        raise ValueError('fit: no records')
    if not all(isinstance(name, str) for name in free):
        raise TypeError(f'fit: free = {free}: names are needed')
    _check_names(free, bounds)
    _check_counts(seed=seed, starts=starts, jobs=jobs, **{} if most_evaluations is None else {'most_evaluations': most_evaluations})
    if most_seconds is not None and not (_is_number(most_seconds) and most_seconds > 0.0):
        raise InputError(f'fit: most_seconds = {most_seconds!r}: must be > 0')
    tell = _progress(progress)
    if not (checkpoint is None or isinstance(checkpoint, (str, os.PathLike))):
        raise TypeError(f'fit: checkpoint = {checkpoint!r}: the name of a file is needed')
    base = _namelist.groups_of(input)
    if 'fit' in base:
        raise InputError('fit: input: has a group &fit, which is for the command stickslip-fit: give an input without')
    constants = [_constant(name, base, bounds) for name in free]
    if not constants:
        raise InputError('fit: no free constants')
    for constant in constants:
        for record in records if constant.is_factor else ():
            if constant.key not in _namelist.merge(base, record.settings).get(constant.group, {}):
                raise InputError(f'fit: {constant.name}: {record.name} has no {constant.group}.{constant.key}')
    rig = 0.0 if any((constant.group, constant.key) in RIG_KEYS for constant in constants) else RIG
    targets = tuple(make_target(analyse(record, _sense(_namelist.merge(base, record.settings))), rig) for record in records)
    size = sum(target.values.size for target in targets)
    if size < len(constants):
        raise ValueError(f'fit: {len(constants)} free constants, but the records give only {size} numbers, because their '
                         'events scatter: free fewer, or add records')
    for target in targets:
        _check_units(target, _namelist.merge(base, target.analysis.record.settings), constants)
    journal = Journal(checkpoint, _fingerprint(base, constants, targets, seed, starts))
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        problem = Problem(base, constants, targets, _SIMULATE, pool, journal,
                          Limits(most_evaluations, most_seconds, tell))
        try:
            candidate, stopped = search(problem, seed, starts)
            problem.limits.most = problem.limits.seconds = None   # the rest is short, and nothing without it
            return _assess(problem, candidate, stopped)
        except NoStickSlip as none:
            raise _no_stick_slip(problem, str(none)) from None
        finally:
            journal.close()


def _no_stick_slip(problem: Problem, why: str) -> ValueError:
    """Why no candidate is like the records: the input may be wrong, and the program then knows how."""
    middle = 0.5 * (problem.low + problem.high)
    for target in problem.targets:
        settings = problem.settings(middle, target)
        set_times(settings, float(target.analysis.time[-1]), target.analysis.step)
        try:
            check_runs(settings)
        except ValueError as error:
            return type(error)(f'fit: {target.analysis.record.name}, in the middle of the bounds: {error}')
    why = why or 'no candidate within the bounds shows as many slip events as the records: widen the bounds, or check the model'
    return ValueError(f'fit: {why}')


_SIMULATE: Simulate = spring_force


def _progress(wanted: bool | Callable[[str], None] | None) -> Callable[[str], None] | None:
    if callable(wanted):
        return wanted
    if not (wanted is None or isinstance(wanted, (bool, np.bool_))):
        raise TypeError(f'fit: progress = {wanted!r}: True, False, None or a function that takes a line is needed')
    if wanted or (wanted is None and sys.stderr.isatty()):
        return lambda text: print(f'fit: {text}', file=sys.stderr, flush=True)
    return None


def _constant(name: str, base: dict, bounds: float | Mapping[str, tuple[float, float]]) -> Constant:
    """A free constant with its bounds."""
    if name == 'velocity_factor':
        own = bounds.get(name, VELOCITY_FACTOR) if isinstance(bounds, Mapping) else VELOCITY_FACTOR
        return _bounded(name, 'drive', 'velocity', own, is_factor=True)
    group, _, key = name.lower().rpartition('.')
    group = group or 'friction'
    if group not in RIG_GROUPS:
        raise InputError(f'fit: {name}: only constants of the surface and the rig can be free: keys of '
                         f'{", ".join("&" + group for group in RIG_GROUPS)}, and velocity_factor, not of &{group}')
    if isinstance(bounds, Mapping):
        if name not in bounds:
            raise InputError(f'fit: no bounds for {name}')
        return _bounded(name, group, key, bounds[name])
    value = base.get(group, {}).get(key)
    if not _is_number(value):
        raise InputError(f'fit: {name} has no value in the input for default bounds: give bounds by name')
    if not _is_number(bounds) or not bounds > 1.0:
        raise InputError(f'fit: bounds = {bounds!r}: a factor above 1 is needed, or lower and upper bounds by name')
    return _bounded(name, group, key, (value / bounds, value * bounds))


def _is_number(value: Any) -> bool:
    return isinstance(value, numbers.Real) and not isinstance(value, bool)


def _bounded(name: str, group: str, key: str, bounds: Any, is_factor: bool = False) -> Constant:
    try:
        return Constant(name, group, key, *checked_bounds(name, bounds), is_factor)
    except ValueError as fault:
        raise InputError(f'fit: {fault}') from None


def _listed(given: Any, kind: type) -> list:
    """One or several of a kind as a list; what can be neither is its only element."""
    several = isinstance(given, Iterable) and not isinstance(given, kind) and getattr(given, 'ndim', 1) != 0   # an array of no dimension has no items
    return list(given) if several else [given]


def _check_names(free: Sequence[str], bounds: Any) -> None:
    """Refuses a name that stands twice, and bounds of others."""
    full = [name.lower() if '.' in name or name == 'velocity_factor' else f'friction.{name.lower()}' for name in free]
    if len(set(full)) < len(full):
        raise InputError(f'fit: free = {free}: a name occurs twice')
    if isinstance(bounds, Mapping) and (others := [name for name in bounds if name not in free]):
        raise InputError(f'fit: bounds of {", ".join(map(str, others))}, which free does not have')


def _check_counts(**counts: int) -> None:
    """Refuses counts that are none."""
    for name, value in counts.items():
        least = 0 if name == 'seed' else 1
        if not isinstance(value, numbers.Integral) or isinstance(value, bool) or value < least:
            raise InputError(f'fit: {name} = {value!r}: must be a whole number >= {least}')
    if counts['starts'] & (counts['starts'] - 1):
        raise InputError(f'fit: starts = {counts["starts"]}: must be a power of 2')


def _sense(settings: Mapping[str, Any]) -> float:
    """Which way the drive goes first: -1 backwards, else 1."""
    velocity = settings.get('drive', {}).get('velocity', 1.0)
    moves = [number for number in np.ravel(velocity) if _is_number(number) and number != 0.0]
    return -1.0 if moves and moves[0] < 0.0 else 1.0


def _fingerprint(base: dict, constants: Sequence[Constant], targets: Sequence[Target], seed: int, starts: int) -> str:
    digest = hashlib.sha256(repr((sorted(base.items(), key=str), constants, seed, starts)).encode())
    for target in targets:
        digest.update(repr((target.analysis.record.settings, target.analysis.from_rest)).encode())
        digest.update(target.analysis.time.tobytes() + target.analysis.force.tobytes())
    return digest.hexdigest()


def _assess(problem: Problem, candidate: np.ndarray, stopped: str) -> Fit:
    """Errors, correlations and warnings at the candidate that was found."""
    slope, bent = problem.jacobian(candidate)
    misfit = problem.misfit(problem.evaluate('full', [candidate])[0])
    inverse = np.linalg.pinv(slope, rcond=1e-9)
    by_noise = replicas(problem, candidate, REPLICAS)
    covariance = np.cov(inverse @ by_noise, ddof=0).reshape(2 * (candidate.size,))
    # White noise through the slopes tells how wide a valley is but for its bends, which counts half, as the coverage of synthetic
    # records says (docs/fitting.md); noise that lasts and events that scatter are known less well: there it counts in full.
    white = not any(target.wander.size or target.analysis.scattered for target in problem.targets)
    for valley, direction in (along_valley(problem, candidate, slope, which) for which in (0, 1)):
        along, known = (direction @ part @ direction for part in (valley, covariance))
        share = 0.5 + 0.5 * max(0.0, 1.0 - known / along) if white and along > 0.0 else 1.0
        covariance += share * valley
    covariance += (inverse * _floors(problem.targets)**2) @ inverse.T
    freedom = misfit.size - candidate.size
    if freedom > 0:
        covariance *= max(1.0, float(misfit @ misfit) / freedom)
    deviation = np.sqrt(np.diag(covariance))
    # Directions that change nothing have no finite error.
    blind = np.linalg.norm(slope, axis=0) < 1e-6 * max(np.linalg.norm(slope, axis=0).max(), 1e-300)
    deviation = np.where(blind, np.inf, deviation)
    names = [constant.name for constant in problem.constants]
    values = dict(zip(names, problem.values(candidate).tolist()))
    with np.errstate(over='ignore', invalid='ignore'):
        intervals = {name: (float(values[name] * np.exp(-NORMAL * s)), float(values[name] * np.exp(NORMAL * s)))
                     for name, s in zip(names, deviation)}
        correlation = np.nan_to_num(covariance / np.outer(deviation, deviation))
    np.fill_diagonal(correlation, 1.0)
    undetermined = [name for name, s in zip(names, deviation) if not s <= UNDETERMINED]
    warnings = [warning for target in problem.targets for warning in target.analysis.warnings]
    warnings += [stopped] if stopped else []
    warnings += _remarks(problem, candidate, bent, misfit, by_noise)
    return Fit(values, intervals, correlation, undetermined, _by_feature(problem.targets, misfit), warnings,
               problem.limits.count, problem.settings(candidate), tuple(problem.targets), problem, candidate)


def _floors(targets: Sequence[Target]) -> np.ndarray:
    """Errors that noise and scatter do not show, in the search's standard deviations: of sampling, of the time
    integration, of the rig. Those of the times of events are not independent of one another, and are left out."""
    floors = []
    for target in targets:
        floor = FLOOR * target.scale
        floor[np.array(target.names) == 'event times'] = 0.0
        if target.analysis.scattered:
            floor[-1] = target.rig * abs(target.values[-1])
        floors.append(floor / target.errors())
    return np.concatenate(floors)


def _by_feature(targets: Sequence[Target], misfit: np.ndarray) -> dict[str, dict[str, float]]:
    found: dict[str, dict[str, float]] = {}
    first = 0
    for target in targets:
        part = misfit[first:first + target.values.size]
        first += target.values.size
        names = np.array(target.names)
        label = target.analysis.record.name
        while label in found:
            label += "'"
        found[label] = {name: float(np.sqrt(np.mean(part[names == name]**2))) for name in dict.fromkeys(target.names)}
    return found


def _remarks(problem: Problem, candidate: np.ndarray, bent: np.ndarray, misfit: np.ndarray, by_noise: np.ndarray) -> list[str]:
    """What a careful reader of the result should know. by_noise: misfits that noise makes, one column a replica."""
    remarks = []
    for constant, x, high, bend in zip(problem.constants, candidate, problem.high, bent):
        if bend > 0.5:
            remarks.append(f'the response jumps, or bends sharply, within 1 % of {constant.name}: its interval is not '
                           'reliable')
        if min(x, high - x) < 1e-3:
            remarks.append(f'{constant.name} ends at its bound: widen the bound, or check the model')
    first = 0
    for target in problem.targets:
        features = slice(first, first + target.values.size)
        first += target.values.size
        name = target.analysis.record.name
        slider = problem.settings(candidate, target).get('slider', {})
        remarks += _rig_remarks(target, slider, problem.settings(candidate, target).get('drive', {}))
        if slider.get('mass', 0.0) > 0.0 and slider.get('stiffness', 0.0) > 0.0:
            ringing = 2.0 * np.pi * np.sqrt(slider['mass'] / slider['stiffness'])
            if target.analysis.period < RINGING_TIMES * ringing:
                remarks.append(f'{name}: the period {target.analysis.period:.3g} is less than {RINGING_TIMES:g} ringing times '
                               f'(of {ringing:.3g} each): small changes of the constants can move the slider to another cycle')
        if target.analysis.scattered:
            remarks.append(f'{name}: its events scatter, those of the model do not: medians over the events were fitted')
            drive = problem.settings(candidate, target).get('drive', {})
            if 'file' in drive or any(np.ptp(np.ravel(drive.get(key, 0.0))) > 0.0 for key in ('velocity', 'normal')):
                remarks.append(f'{name}: its drive changes, and the medians of the model are those of its first events: fit each part with one '
                               'velocity and one normal traction as a separate record (start, end)')
        if target.wander.size:
            remarks.append(f'{name}: from cycle to cycle the force differs by {np.std(target.wander):.3g}, from sample to sample '
                           f'by {target.analysis.noise:.3g}: its noise is correlated in time; the errors include this')
        remarks += _misfit_remarks(problem, candidate, target, misfit[features], by_noise[features])
    return remarks


def _misfit_remarks(problem: Problem, candidate: np.ndarray, target: Target, misfit: np.ndarray,
                    by_noise: np.ndarray) -> list[str]:
    """Does the model explain the record? misfit, by_noise: of this record's features, in standard deviations."""
    name, whole = target.analysis.record.name, np.sqrt(np.mean(misfit**2))
    noise = np.sum(by_noise**2, axis=0)
    if not misfit @ misfit > noise.mean() + UNEXPLAINED * noise.std():
        return []
    drift = _drift_remarks(problem, candidate, target)
    if whole > FOLLOWS:
        told = compare(problem, candidate, target.analysis)
        return [f'{name}: the model does not follow this record (misfit {whole:.2g} standard deviations): its peaks are '
                f'{told["peak"]["measured"]:.4g} and rise by {told["slope"]["measured"]:.4g} per unit of time, the model\'s '
                f'{told["peak"]["computed"]:.4g} and {told["slope"]["computed"]:.4g}', *drift]
    names = np.array(target.names)
    parts = {feature: np.sqrt(np.mean(misfit[names == feature]**2)) for feature in dict.fromkeys(target.names)}
    worst = max(parts, key=lambda feature: parts[feature])
    return [f'{name}: noise does not explain the residuals ({worst} {parts[worst]:.2g} standard deviations): the model '
            'does not follow all of this record, or the search has not found the best constants; the intervals are wider because of this',
            *drift]


def _drift_remarks(problem: Problem, candidate: np.ndarray, target: Target) -> list[str]:
    """Do the periods of a record that the model does not follow become longer or shorter, beside the model's?"""
    analysis, events = target.analysis, target.events
    result = problem.run(candidate, target, problem.expected_end(target, events))
    if analysis.scattered or result is None:
        return []
    time, force = analysis.like(*result)
    computed = target.falls(time, force)
    if computed is None:
        return []
    measured = analysis.falls.part(slice(None, len(computed)))
    period, error = _trend(np.diff(measured.middle), np.diff(computed.middle), np.sqrt(2.0) * target.noise[0] / analysis.period)
    level, _ = _trend(means_between(analysis.time, analysis.force, measured.middle), means_between(time, force, computed.middle))
    if abs(period) < max(5.0 * error, 0.003):
        return []
    told = (f'{analysis.record.name}: from its first to its last events the period changes by {period:+.1%} more than that of the model, '
            f'and the mean force by {level:+.1%}: ')
    if analysis.straightened or abs(level) > 0.5 * abs(period):
        return [told + 'the surface, the normal traction or the load cell changes with time. Take a part of the record (start, end), or give '
                       'the normal traction as it was measured (&drive file)']
    return [told + f'the velocity of the drive {"falls" if period > 0.0 else "rises"}. Give the drive as it was measured (&drive file), '
                   'with a record from its start, or take a part of the record (start, end)']


def _trend(measured: np.ndarray, computed: np.ndarray, least: float = 0.0) -> tuple[float, float]:
    """Change of a ratio from the first event to the last, on a straight line, and its error. least: relative error of one."""
    apart, place = np.log(measured / computed), np.linspace(-0.5, 0.5, measured.size)
    slope = place @ apart / (place @ place)
    left = apart - apart.mean() - slope * place
    return float(slope), float(max(np.sqrt(left @ left / (apart.size - 2)), least) / np.sqrt(place @ place))


def _check_units(target: Target, settings: dict, constants: Sequence[Constant]) -> None:
    """Refuses a force that rises between events at quite another rate than the rig's numbers allow: a search over simulations
    in wrong units would take long and find nothing."""
    numbers = [settings.get(group, {}).get(key) for group, key in
               (('slider', 'stiffness'), ('drive', 'velocity'), ('friction', 'alpha_t'), ('slider', 'area'))]
    numbers[3] = 1.0 if numbers[3] is None else numbers[3]
    for constant in constants:
        if (constant.group, constant.key) == ('friction', 'alpha_t'):
            numbers[2] = constant.high
        elif constant.group != 'friction' and not constant.is_factor:
            return
    if not all(isinstance(number, (int, float)) and number != 0.0 for number in numbers):
        return
    stiffness, velocity, alpha_t, area = numbers
    analysis = target.analysis
    slope = float(medians(analysis.time, analysis.force, analysis.falls)[0][-1])
    fastest = stiffness * abs(velocity)
    slowest = fastest / (1.0 + stiffness / (area * alpha_t))
    if slope > WRONG_UNITS * fastest or slope < slowest / WRONG_UNITS:
        analysis.record.refuse(
            f'between events the force rises by {slope:.4g} per unit of time, but stiffness times velocity is {fastest:.4g}: the '
            'units of time or force (time_factor, force_factor), the stiffness or the velocity do not fit the record')


UNEXPLAINED = 7.0    # standard deviations of the squared misfit that noise makes, whose tail is long
WRONG_UNITS = 5.0    # times faster, or slower, than the rig's numbers say


def _rig_remarks(target: Target, slider: dict, drive: dict) -> list[str]:
    """Does the force rise in stick as stiffness and velocity say? No contact makes a spring load faster than that."""
    stiffness, velocity = slider.get('stiffness'), drive.get('velocity')
    analysis = target.analysis
    if not isinstance(stiffness, (int, float)) or not isinstance(velocity, (int, float)) or len(analysis.falls) < LEAST_EVENTS:
        return []
    each = rises(analysis.time, analysis.force, analysis.falls)
    if each.size < LEAST_EVENTS - 1:
        return []
    slope = float(np.median(each))
    error = float(errors_of_medians(each[:, None], 50)[0])
    # Noise of a straight line through the middle half of a rise, and of the median of such slopes: few events may scatter
    # less by chance.
    half = 0.5 * float(np.median(analysis.falls.onset[1:] - analysis.falls.end[:-1]))
    by_noise = 1.25 * analysis.noise / half * np.sqrt(12.0 * analysis.step / half / len(each))
    expected = stiffness * abs(velocity)
    if slope - expected < max(0.03 * expected, 3.0 * max(error, by_noise)):
        return []
    return [f'{analysis.record.name}: between events the force rises by {slope:.4g} per unit of time, faster than stiffness '
            f'times velocity, {expected:.4g}: units are wrong, or the record was taken with a velocity of '
            f'{slope / stiffness:.4g} or a stiffness of {slope / abs(velocity):.4g} or more. Give the right one, or free '
            "'velocity_factor' or 'slider.stiffness'"]
