"""The search for constants: candidates, their simulations, misfits, least squares. No statistics, no pictures."""
from __future__ import annotations

import concurrent.futures
import dataclasses
import json
import pathlib
import time as clock
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from . import _namelist
from ._features import FLOOR, Target, median_of_blocks, medians, outline
from ._optional import needed
from ._records import find_falls, smooth

Settings = dict[str, dict[str, Any]]
#: Runs the model on its settings; gives time and spring force, or None where the run fails.
Simulate = Callable[[Settings], 'tuple[np.ndarray, np.ndarray] | None']

STEP = 0.01             # of a constant, relative, for central differences: smaller ones give error bars too small
LIMIT = 500.0           # misfits are bent to stay below
NO_EVENTS = 300.0       # misfit of every feature where a simulation shows too few events
NO_OUTLINE = 100.0      # the least of each coarse number then


FINE, COARSE = 1e-6, 1e-4   # error in a step, part of the static friction force


class Stopped(Exception):
    """A limit that the caller set has been reached."""


class NoStickSlip(Exception):
    """No candidate shows as many events as a record."""


def checked_bounds(name: str, bounds: Any) -> tuple[float, float]:
    """Bounds of a constant as numbers; ValueError if they are none."""
    try:
        low, high = map(float, bounds)
    except (TypeError, ValueError):
        raise ValueError(f'bounds of {name}, {bounds!r}: a lower and an upper one are needed') from None
    if not 0.0 < low < high < np.inf:
        raise ValueError(f'bounds of {name}, {low:g} and {high:g}: 0 < lower < upper is needed')
    return low, high


@dataclasses.dataclass(frozen=True)
class Constant:
    """A constant to be found."""

    name: str       #: as the caller gave it
    group: str      #: of the namelist
    key: str
    low: float
    high: float
    is_factor: bool = False   #: multiplies what the settings have, instead of taking its place

    def set(self, settings: Settings, value: float) -> None:
        """Puts a value into the settings of a run."""
        keys = settings.setdefault(self.group, {})
        if self.is_factor:
            if self.key in keys:   # records may have it, each its own, and the input not
                keys[self.key] = (float(value) * np.asarray(keys[self.key], float)).tolist()
        else:
            keys[self.key] = float(value)


@dataclasses.dataclass
class Problem:
    """Records, model and free constants. A candidate is the vector of the logarithms of the constants over their lower
    bounds, so that units do not matter."""

    base: Settings
    constants: Sequence[Constant]
    targets: Sequence[Target]
    simulate: Simulate
    pool: concurrent.futures.Executor | None
    journal: Journal
    limits: Limits
    #: What noise adds to the features on average: it blurs the mean cycle, and a peak is the largest of noisy samples.
    shift: np.ndarray | float = 0.0

    @property
    def low(self) -> np.ndarray:
        return np.zeros(len(self.constants))

    @property
    def high(self) -> np.ndarray:
        return np.log([constant.high / constant.low for constant in self.constants])

    @property
    def size(self) -> int:
        """Number of features."""
        return sum(target.values.size for target in self.targets)

    def values(self, candidate: np.ndarray) -> np.ndarray:
        """The constants of a candidate."""
        return np.array([constant.low for constant in self.constants]) * np.exp(candidate)

    def settings(self, candidate: np.ndarray, target: Target | None = None) -> Settings:
        """Input of the run of one candidate for one record, without its end; or for no record."""
        settings = _namelist.merge(self.base, target.analysis.record.settings if target else {})
        for constant, value in zip(self.constants, self.values(candidate)):
            constant.set(settings, value)
        return settings

    def __getstate__(self) -> dict[str, Any]:
        """What is pickled: of a search that is over."""
        return {**self.__dict__, 'pool': None}

    def run(self, candidate: np.ndarray, target: Target, end: float,
            rtol: float = FINE) -> tuple[np.ndarray, np.ndarray] | None:
        """Simulates up to a time."""
        self.limits.check()
        settings = self.settings(candidate, target)
        set_times(settings, end, target.analysis.row_step, rtol)
        result = self.simulate(settings)
        return None if result is None else (result[0], target.analysis.sense * result[1])

    def expected_end(self, target: Target, events: int) -> float:
        """Time by which a simulation like the record shows so many events [T]."""
        falls = target.analysis.falls
        slow = target.analysis.period / target.analysis.drop   # time for the drive to load the spring by a unit of force
        if target.analysis.from_rest:
            before = max(0.0, target.analysis.force[0]) * slow   # that the record lacks
            if events <= len(falls):
                return before + 1.02 * falls.middle[events - 1] + 0.5 * target.analysis.period
            return before + falls.middle[-1] + (events - len(falls) + 1.5) * target.analysis.period
        # From a slack spring: as long as the drive needs to load it.
        load = float(np.median(falls.peak)) * slow
        return 1.2 * load + (events + 1) * 1.1 * target.analysis.period

    def features(self, candidate: np.ndarray, target: Target) -> np.ndarray | None:
        """Of a simulation that goes on until it shows enough events; None where it does not."""
        for longer in (1.0, 1.6):
            result = self.run(candidate, target, longer * self.expected_end(target, target.events))
            if result is None:
                return None
            found = target.of_simulation(*result)
            if found is not None:
                return found
        return None

    def all_features(self, candidate: np.ndarray) -> np.ndarray:
        """Features of the simulations of all records, one after another; NaN for records without enough events."""
        found = [self.features(candidate, target) for target in self.targets]
        return np.concatenate([np.full(target.values.size, np.nan) if values is None else values
                               for target, values in zip(self.targets, found)])

    def misfit(self, features: np.ndarray, floor: float = FLOOR) -> np.ndarray:
        """Features of simulations less those of the records, in standard deviations with a relative error of the model:
        with a large one the search finds its way along narrow valleys, which the times of the events make."""
        return np.where(np.isnan(features), NO_EVENTS, LIMIT * np.tanh(self._apart(features, floor) / LIMIT))

    def _apart(self, features: np.ndarray, floor: float) -> np.ndarray:
        """The same without its bend."""
        wanted = np.concatenate([target.values for target in self.targets])
        errors = np.concatenate([target.errors(floor) for target in self.targets])
        return (features + self.shift - wanted) / errors

    def coarse_misfit(self, candidate: np.ndarray) -> np.ndarray:
        """A few robust numbers of a short simulation against those of the records."""
        parts = []
        for target in self.targets:
            analysis = target.analysis
            scale = float(np.median(analysis.falls.peak))
            first_load = target.first_load
            wanted = outline(analysis.falls, first_load, scale, analysis.period)
            if wanted is None:
                raise NoStickSlip
            result = self.run(candidate, target, self.expected_end(target, 4), COARSE)
            found: np.ndarray | None = None
            if result is not None:
                time, force = analysis.like(*result)
                falls = find_falls(time, smooth(force, analysis.window), analysis.threshold)
                if not analysis.from_rest:
                    falls = falls.part(slice(min(2, max(0, len(falls) - 3)), None))
                found = outline(falls, first_load, scale, analysis.period)
                level = abs(float(force[force.size // 2:].mean()) / float(analysis.force.mean()) - 1.0)
            if found is None:
                parts.append(np.full(wanted.size, NO_OUTLINE + (50.0 * min(level, 1.0) if result is not None else 100.0)))
            else:
                parts.append(found - wanted)
        return np.concatenate(parts)

    def evaluate(self, kind: str, candidates: Sequence[np.ndarray]) -> list[np.ndarray]:
        """Coarse misfits, or all features, of several candidates; what the journal has is not simulated again."""
        function = {'coarse': self.coarse_misfit, 'full': self.all_features}[kind]
        known: list[Any] = [self.journal.get(kind, candidate) for candidate in candidates]
        missing = [i for i, values in enumerate(known) if values is None]
        run_all = self.pool.map if self.pool is not None else map
        allowed = missing[:self.limits.left()]   # as many whatever the number of threads
        for i, values in zip(allowed, run_all(function, [candidates[i] for i in allowed])):
            known[i] = values
            self.journal.put(kind, candidates[i], values)
            self.limits.count += 1
        if len(allowed) < len(missing):
            raise Stopped(f'after {self.limits.count} evaluations')
        return known

    def jacobian(self, candidate: np.ndarray, step: float = STEP, floor: float = FLOOR) -> tuple[np.ndarray, np.ndarray]:
        """Slopes of the misfit, and how far each constant's response is from a straight line (0 to 1). Differences are those of
        the features: the times of many events move so far in a step that the bend of the misfit would make them too small."""
        size, steps = candidate.size, step * np.eye(candidate.size)
        features = np.array(self.evaluate('full', [candidate, *(candidate + steps), *(candidate - steps)]))
        misfits, apart = self.misfit(features, floor), self._apart(features, floor)
        flat = np.isnan(apart).any(axis=0)   # where a simulation shows too few events
        values = np.where(flat, misfits, apart)
        here, ahead, behind = values[0], values[1:size + 1], values[size + 1:]
        bend = np.linalg.norm(ahead + behind - 2.0 * here, axis=1)
        straight = np.linalg.norm(ahead - behind, axis=1)
        bent = np.where(flat, 1.0, 1.0 - (misfits[0] / LIMIT)**2)
        return (bent * (ahead - behind) / (2.0 * step)).T, bend / np.maximum(bend + straight, 1e-300)

    def coarse_jacobian(self, candidate: np.ndarray, step: float = 0.02) -> np.ndarray:
        """Differences of the coarse misfit to one side, towards the middle of the bounds."""
        steps = np.where(candidate > 0.5 * (self.low + self.high), -step, step)
        here, *ahead = self.evaluate('coarse', [candidate, *(candidate + np.diag(steps))])
        return ((np.array(ahead) - here) / steps[:, None]).T


def set_times(settings: Settings, end: float, step: float, rtol: float = FINE) -> None:
    """Gives a run its end, and rows at the record's samples. Steps are adaptive, in continuous time: fixed ones with the
    update by backward Euler bias the constants."""
    time = settings.get('time', {})
    kept: dict[str, Any] = {key: time[key] for key in ('dt_min', 'dt_max') if key in time}
    settings['time'] = {'t_end': float(end), 'rtol': max(float(time.get('rtol', FINE)), rtol), **kept}
    settings['output'] = {'every': float(step)}
    settings.get('friction', {}).pop('scheme', None)


class Limits:
    """When to stop, and whom to tell how far the search is."""

    def __init__(self, most: int | None, seconds: float | None, progress: Callable[[str], None] | None) -> None:
        self.most, self.seconds, self.progress = most, seconds, progress
        self.count = 0
        self.start = clock.monotonic()

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, 'progress': None}

    def left(self) -> int | None:
        """Evaluations that may still be made; None: any number."""
        return None if self.most is None else max(0, self.most - self.count)

    def check(self) -> None:
        """Raises Stopped where the time is over."""
        if self.seconds is not None and clock.monotonic() - self.start > self.seconds:
            raise Stopped(f'after {self.seconds:g} seconds')

    def tell(self, text: str) -> None:
        """Reports progress."""
        if self.progress is not None:
            self.progress(text)


class Journal:
    """Misfits that are known already, also in a file, so that an interrupted search can go on. The search is a function
    of its seed and of them alone: with a journal it does again what it did, without the simulations."""

    def __init__(self, path: str | pathlib.Path | None, problem: str) -> None:
        self.known: dict[tuple[str, bytes], np.ndarray] = {}
        self.file = None
        if path is None:
            return
        path = pathlib.Path(path)
        if path.exists():
            self._read(path, problem)
            self.file = path.open('a')
        else:
            self.file = path.open('w')
            self.file.write(json.dumps({'problem': problem}) + '\n')
            self.file.flush()

    def _read(self, path: pathlib.Path, problem: str) -> None:
        whole = 0
        for number, line in enumerate(path.read_bytes().splitlines(keepends=True)):
            try:
                entry = json.loads(line)
            except ValueError:
                break   # cut short when the search was interrupted
            if number == 0 and entry.get('problem') != problem:
                raise ValueError(f'{path}: the checkpoint of another fit (records, input, constants or bounds differ)')
            if number > 0:
                self.known[entry['kind'], _key(entry['at'])] = np.array(entry['values'])
            whole += len(line)
        with path.open('r+b') as file:
            file.truncate(whole)

    def get(self, kind: str, candidate: np.ndarray) -> np.ndarray | None:
        return self.known.get((kind, _key(candidate)))

    def put(self, kind: str, candidate: np.ndarray, misfit: np.ndarray) -> None:
        self.known[kind, _key(candidate)] = misfit
        if self.file is not None:
            self.file.write(json.dumps({'kind': kind, 'at': list(candidate), 'values': list(misfit)}) + '\n')
            self.file.flush()

    def close(self) -> None:
        if self.file is not None:
            self.file.close()
            self.file = None


def _key(candidate: Sequence[float] | np.ndarray) -> bytes:
    return np.asarray(candidate, float).tobytes()


def replicas(problem: Problem, candidate: np.ndarray, number: int) -> np.ndarray:
    """Deviations of the features, in the search's standard deviations, one column a replica: the model's force with
    other noise, or, where the events of the record scatter, other events in blocks."""
    rng = np.random.default_rng(0)
    blocks = []
    for target in problem.targets:
        analysis = target.analysis
        if analysis.scattered:
            late = analysis.falls.part(slice(1 if analysis.from_rest else 0, None))
            middle, each = medians(analysis.time, analysis.force, late)
            found = np.array([median_of_blocks(each, rng) for _ in range(number)]) - middle
        else:
            result = problem.run(candidate, target, problem.expected_end(target, target.events))
            found = _with_noise(target, *result, rng, number) if result is not None else None
            if found is None:
                found = rng.normal(size=(number, target.values.size)) * target.noise
        blocks.append((found / target.errors()).T)
    return np.concatenate(blocks)


def _with_noise(target: Target, time: np.ndarray, force: np.ndarray, rng: np.random.Generator,
                number: int) -> np.ndarray | None:
    """Deviations of the features by noise, and by where in the falls samples are, if these are few; None where there are too few
    events."""
    analysis = target.analysis
    clean = target.of_simulation(time, force)
    if clean is None:
        return None
    late = rng.uniform(0.0, analysis.step_in_falls, number) if analysis.sparse else np.zeros(1)
    found = []
    for begin in late:
        moment, sampled = analysis.like(time - begin, force)
        found += [target.of_samples(moment, noisy) for noisy in target.with_noise(moment, sampled, rng, number // late.size)]
    return np.array([clean if features is None else features for features in found]) - clean


def search(problem: Problem, seed: int, starts: int) -> tuple[np.ndarray, str]:
    """The best candidate, and why the search ended early, or ''. Sobol points, then least squares from the best few: on
    the coarse misfit first, then on all features."""
    best = Best()
    try:
        best.update(_search(problem, seed, starts, best))
    except Stopped as stop:
        found = best.rough if best.candidate is None else best.candidate
        if found is None:
            raise NoStickSlip(f'the search was stopped {stop}, before any candidate showed stick-slip') from None
        return found, f'the search was stopped {stop}: the values are the best so far'
    return best.place, ''


@dataclasses.dataclass
class Best:
    """The best candidate that has been seen."""

    candidate: np.ndarray | None = None
    cost: float = np.inf
    rough: np.ndarray | None = None   #: the best of the coarse search, if it shows stick-slip

    def update(self, found: tuple[np.ndarray, float]) -> None:
        if found[1] < self.cost:
            self.candidate, self.cost = found

    @property
    def place(self) -> np.ndarray:
        """The candidate; NoStickSlip where no misfit was a number."""
        if self.candidate is None:
            raise NoStickSlip
        return self.candidate


def _search(problem: Problem, seed: int, starts: int, best: Best) -> tuple[np.ndarray, float]:
    qmc = needed('scipy.stats', 'fit').qmc
    low, high = problem.low, problem.high
    limits = problem.limits
    points = qmc.scale(qmc.Sobol(low.size, seed=seed).random(starts), low, high)
    costs = []
    for first in range(0, starts, 16):
        costs += [float(np.sum(np.minimum(np.abs(values), NO_OUTLINE)**2))
                  for values in problem.evaluate('coarse', points[first:first + 16])]
        lowest = int(np.argmin(costs))
        if costs[lowest] < NO_OUTLINE**2:
            best.rough = points[lowest]
        limits.tell(f'start {min(first + 16, starts)} of {starts}')
    coarse = []
    for k, i in enumerate(np.argsort(costs)[:4]):
        coarse.append(_least_squares(problem, points[i], lambda at: problem.evaluate('coarse', [at])[0],
                                     problem.coarse_jacobian, 'soft_l1', 10))
        limits.tell(f'coarse {k + 1} of 4: misfit {coarse[-1][1]:.3g}')
    coarse.sort(key=lambda found: found[1])
    best.rough = coarse[0][0]
    if all(np.isnan(values).all() for values in problem.evaluate('full', [candidate for candidate, _ in coarse])):
        raise NoStickSlip
    for k, (candidate, _) in enumerate(coarse):
        if _fine(problem, candidate, best, f'fine {k + 1} of at most {len(coarse)}'):
            break
    problem.limits.tell('last steps')
    problem.shift = _shift_by_noise(problem, best.place)
    return _descend(problem, best.place, FLOOR, STEP, 'linear', 30, 1e-7)


def _fine(problem: Problem, candidate: np.ndarray, best: Best, label: str) -> bool:
    """Least squares on all features from one start. Is the search over? It is where noise explains the misfit, or where
    another start has come to the same one, which the model more or less follows: in a wrong valley there is room for two. Before the
    end of the descent, which may pass by, the constants must be the same, too. A start that stays far above another's end is given up."""
    other, place = best.cost, best.candidate
    for k, (floor, step, loss) in enumerate(STAGES):
        candidate, cost = _descend(problem, candidate, floor, step, loss, 8)
        best.update((candidate, cost))
        problem.limits.tell(f'{label}: misfit {cost / problem.size:.3g} a feature')
        at_end = k == len(STAGES) - 1 or (place is not None and np.abs(candidate - place).max() < BESIDE)
        if k > 0 and at_end and other / SAME < cost < min(SAME * other, FOLLOWS**2 * problem.size):
            return True
        if k > 0 and cost > HOPELESS * other:
            return False
    return best.cost < _by_noise_alone(problem, best.place)


SAME = 1.5          # times the misfit of another start: the same valley
BESIDE = 0.05       # of a constant, relative: the same place
FOLLOWS = 5.0       # standard deviations of a feature on average: above, the model does not follow the record
HOPELESS = 30.0     # times the misfit of another start


def _by_noise_alone(problem: Problem, candidate: np.ndarray) -> float:
    """A misfit that the noise of the records can make where the constants are right, at most."""
    costs = np.sum(replicas(problem, candidate, 40)**2, axis=0)
    return float(np.mean(costs) + 2.0 * np.std(costs))


def _shift_by_noise(problem: Problem, candidate: np.ndarray) -> np.ndarray:
    """Mean of what noise does to the features; records whose events scatter have none of this."""
    errors = np.concatenate([target.errors() for target in problem.targets])
    repeats = np.concatenate([np.full(target.values.size, not target.analysis.scattered) for target in problem.targets])
    return np.where(repeats, replicas(problem, candidate, 100).mean(axis=1) * errors, 0.0)


def _descend(problem: Problem, start: np.ndarray, floor: float, step: float, loss: str, most: int,
             tolerance: float = 1e-4) -> tuple[np.ndarray, float]:
    """Least squares on all features; gives the misfit without what the search allows for."""
    candidate, _ = _least_squares(
        problem, start, lambda at: problem.misfit(problem.evaluate('full', [at])[0], floor),
        lambda at: problem.jacobian(at, step, floor)[0], loss, most, tolerance)
    misfit = problem.misfit(problem.evaluate('full', [candidate])[0])
    return candidate, float(misfit @ misfit)


#: Relative error of the model, step of the differences, loss.
STAGES = ((0.03, 0.05, 'soft_l1'), (0.006, 0.03, 'linear'), (0.0025, 0.02, 'linear'), (FLOOR, STEP, 'linear'))


def _least_squares(problem: Problem, start: np.ndarray, misfit: Callable[[np.ndarray], np.ndarray],
                   jacobian: Callable[[np.ndarray], np.ndarray], loss: str, most: int,
                   tolerance: float = 1e-4) -> tuple[np.ndarray, float]:
    """Levenberg and Marquardt's method within bounds (scipy's trust regions)."""
    least_squares = needed('scipy.optimize', 'fit').least_squares
    inside = np.clip(start, problem.low + 1e-6, problem.high - 1e-6)
    found = least_squares(misfit, inside, jacobian, loss=loss, f_scale=5.0, bounds=(problem.low, problem.high),
                          max_nfev=most, xtol=tolerance, ftol=tolerance, gtol=1e-10, x_scale=0.1)
    values = misfit(found.x)
    return found.x, float(values @ values)


def along_valley(problem: Problem, candidate: np.ndarray, slope: np.ndarray, which: int) -> tuple[np.ndarray, np.ndarray]:
    """Covariance of the constants along a flat valley of the misfit, 0 the flattest, 1 the next, and its direction. It is
    curved: slopes at the best candidate alone make the errors several times too small. Where the constant with the largest part in the
    flattest direction is held at one value after the other, the others are found anew; likelihoods weigh the way."""
    if candidate.size < which + 2:
        return np.zeros((candidate.size, candidate.size)), np.zeros(candidate.size)
    strengths, directions = np.linalg.eigh(slope.T @ slope)
    strength, direction = strengths[which], directions[:, which]
    held = int(np.argmax(np.abs(direction)))
    first = float(np.clip(abs(direction[held]) / np.sqrt(max(strength, 1e-12)), 0.01, 0.1))
    start = direction / direction[held]
    misfit = problem.misfit(problem.evaluate('full', [candidate])[0])
    places, costs = [candidate], [float(misfit @ misfit)]
    for side in (-1.0, 1.0):
        surface = Surface(problem, candidate, slope)
        place, ahead = candidate, side * first * start
        for _ in range(WAY):
            guess = np.clip(place + ahead, problem.low + 1e-6, problem.high - 1e-6)
            found, cost = surface.lowest(guess, held)
            ahead = 1.6 * (found - place)
            place = found
            places.append(found)
            costs.append(cost)
            if cost - costs[0] > FAR or abs(found[held] - guess[held]) > 1e-9 or ahead[held] == 0.0:
                break
        problem.limits.tell('error bars')
    order = np.argsort([place[held] for place in places])
    way, along = np.array(places)[order], np.array(costs)[order]
    fine = np.linspace(way[0, held], way[-1, held], 400)
    weights = np.exp(-0.5 * (np.interp(fine, way[:, held], along) - along.min()))
    apart = np.column_stack([np.interp(fine, way[:, held], values) for values in way.T]) - candidate
    return (weights[:, None] * apart).T @ apart / weights.sum(), direction


WAY = 7        # steps along the valley to either side, at most
FAR = 9.0      # rise of the misfit at which it is not followed any more: three standard deviations


class Surface:
    """The misfit around a candidate whose slopes are known. Each evaluation corrects the slopes along the way it was
    reached by (Broyden), so that a walk needs no differences: those cost two evaluations a constant."""

    def __init__(self, problem: Problem, candidate: np.ndarray, slope: np.ndarray) -> None:
        self.problem, self.slope, self.at = problem, slope.copy(), candidate
        self.misfit = problem.misfit(problem.evaluate('full', [candidate])[0])

    def evaluate(self, candidate: np.ndarray) -> np.ndarray:
        """The misfit there; corrects the slopes."""
        misfit = self.problem.misfit(self.problem.evaluate('full', [candidate])[0])
        step = candidate - self.at
        if (length := step @ step) > 0.0:
            self.slope += np.outer(misfit - self.misfit - self.slope @ step, step / length)
        self.at, self.misfit = candidate, misfit
        return misfit

    def lowest(self, guess: np.ndarray, held: int) -> tuple[np.ndarray, float]:
        """The best candidate with one constant held at its value in the guess, and its squared misfit."""
        least_squares = needed('scipy.optimize', 'fit').least_squares
        others = np.arange(guess.size) != held

        def whole(part: np.ndarray) -> np.ndarray:
            candidate = guess.copy()
            candidate[others] = part
            return candidate

        found = least_squares(lambda part: self.evaluate(whole(part)), guess[others], lambda _: self.slope[:, others],
                              bounds=(self.problem.low[others] - 1e-9, self.problem.high[others] + 1e-9), max_nfev=8,
                              xtol=1e-4, ftol=1e-3, x_scale=0.1)
        return whole(found.x), 2.0 * float(found.cost)
