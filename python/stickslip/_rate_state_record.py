"""What a record of velocity steps and holds must be, and what it tells by itself: noise, velocities, changes (docs/fitting.md)."""
from __future__ import annotations

from typing import Any

import numpy as np

from ._arrays import number, row_of
from ._rate_state_model import EARLY_LATE, Steps
from ._records import spread

REST = 1e-6           # of the largest velocity: below it the drive stands still
MOST_FRICTION = 5.0   # above, it is a traction, or in per cent
SPIKE = 15.0          # standard deviations of the noise by which a sample stands out
BESIDE = 10           # samples after a change that friction may well jump in
AGREE = 3.0           # standard deviations by which two numbers for one thing may differ


def prepare(time: Any, friction: Any, changes: Any, displacement: Any, velocity: Any, changes_error: Any) -> Steps:
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
    return Steps(time[kept], friction[kept], changes, velocity, noise[kept], unsure, warnings, sense)


def _without_spikes(time: np.ndarray, friction: np.ndarray, noise: np.ndarray, changes: np.ndarray) -> tuple[np.ndarray, tuple[str, ...]]:
    """Which samples stay: single ones that stand out from their neighbours, away from the changes, go, if they are a few."""
    around = np.median(np.lib.stride_tricks.sliding_window_view(np.pad(friction, 2, mode='edge'), 5), axis=1)
    spikes = np.abs(friction - around) > SPIKE * noise
    for after in np.searchsorted(time, changes):
        spikes[max(0, after - 2):after + BESIDE] = False   # the change may come a sample earlier
    count = int(np.count_nonzero(spikes))
    if not 0 < count <= max(1, time.size // 50):
        return np.ones_like(spikes), ()
    return ~spikes, (f'{count} samples differ strongly from their neighbours and were omitted, the first at {time[int(np.argmax(spikes))]:g}',)


def _check_finite(**given: np.ndarray) -> None:
    """Refuses what is not a finite number, or missing."""
    for name, values in given.items():
        if (bad := ~np.isfinite(values)).any():
            raise ValueError(f'{name}: value {int(np.argmax(bad)) + 1} of {values.size} is not a finite number; leave out '
                             'samples with missing values')


def _check_physics(friction: np.ndarray, velocity: np.ndarray, changes: np.ndarray) -> None:
    """Refuses numbers that are no friction under a drive that changes its velocity."""
    if not (np.isfinite(velocity).all() and velocity.min() >= 0.0 and velocity[0] > 0.0):
        raise ValueError(f'velocity = {velocity.tolist()}: the first must not be 0, and all must go one way')
    if np.any(same := np.abs(np.diff(velocity)) < REST * velocity.max()):
        raise ValueError(f'velocity: {velocity[int(np.argmax(same))]:g} before and after the change at {changes[int(np.argmax(same))]:g}: '
                         'at a change the velocity must differ')
    middle = float(np.median(friction))
    if middle < 0.0:
        raise ValueError(f'friction: its median, {middle:.3g}, is negative under a forward drive: reverse the sign of one of them')
    if middle > MOST_FRICTION:
        raise ValueError(f'friction: its median is {middle:.3g}: shear over normal traction is needed, neither a traction nor per cent')


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
            raise ValueError(f'displacement: its velocity does not change near {moment:g}, the time in changes')
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
