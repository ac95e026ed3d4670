"""The friction routine on numpy arrays (docs/python.md)."""
from __future__ import annotations

import ctypes
import itertools
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from . import _library
from ._arrays import number, numbers
from .laws import AtPoints, Law, require_law

STATE_SIZE = 8   # numbers of a state: status, u_n, u_et1, u_et2, mu, internal variable, slip, dissipated energy
_STATE_SHAPE = (STATE_SIZE,)
_FLOAT = np.dtype(np.float64)


class _Place(NamedTuple):
    """Memory that an update of one point works on, with the C routine's arguments that point to it."""

    state: np.ndarray
    traction: np.ndarray
    tangent: np.ndarray
    dt: ctypes.c_double
    arguments: tuple


def _new_place(ndir: int) -> _Place:
    memory = (ctypes.c_double * (STATE_SIZE + ndir + ndir**2))()
    values = np.ctypeslib.as_array(memory)
    last = STATE_SIZE + ndir
    arguments = (STATE_SIZE, memory, ctypes.byref(memory, 8 * STATE_SIZE), ctypes.byref(memory, 8 * last))
    return _Place(values[:STATE_SIZE], values[STATE_SIZE:last], values[last:].reshape(ndir, ndir).T, ctypes.c_double(),
                  arguments)


# By the shape of du of one point: ndir, and places that nobody works on. They are taken and given back in one operation of
# the interpreter, so that threads never share one.
_PLACES: dict[tuple, tuple[int, list[_Place]]] = {(ndir,): (ndir, []) for ndir in (2, 3)}
_update_point, _ndarray, _new, _nan = _library.update_one, np.ndarray, tuple.__new__, np.nan


class Result(NamedTuple):
    """Result of an update. For one point the arrays lack the first dimension, and `status` is an int."""

    traction: np.ndarray   #: (n, ndir) transmitted traction, tension positive [F/L^2]; NaN where status < 0
    tangent: np.ndarray    #: (n, ndir, ndir), d(traction i)/d(du j), unsymmetric [F/L^3]; NaN where status < 0
    state: np.ndarray      #: (n, 8) at the end of the increment; where status < 0 that at its start
    status: np.ndarray     #: (n,) 0 solved, 1 solved but several equilibria exist, < 0 refused: `message(status)`


def update(du: ArrayLike, dt: float, law: Law | AtPoints, state: ArrayLike | None = None, out: Result | None = None) -> Result:
    """Friction update of one contact point, or of many.

    du: increment of relative displacement, normal, tangential 1[, tangential 2] [L]; shape (ndir,), or (n, ndir) for n
        points, with ndir 2 or 3. An array in C order, or in Fortran order (component-major), of 64-bit floats is used
        without a copy; others are copied.
    dt: increment of time, >= 0 [T].
    law: an object of `stickslip.laws`, or of `Law.at_points` for constants that differ from point to point.
    state: shape (8,) or (n, 8), at the start of the increment, as in an earlier result; None: virgin points. It is
        not changed.
    out: an earlier result of the same shapes and order, whose arrays are overwritten, which saves the allocation of
        memory. Its `state` may be the `state` given here.

    Results have the order of `du`. A point with an invalid increment or state has a negative status, and other points are not
    affected; wrong shapes raise ValueError. Releases the interpreter's lock, so that several threads can run in parallel.
    """
    if type(du) is not _ndarray or du.dtype is not _FLOAT:
        du = numbers(du, 'du')
    if (places := _PLACES.get(du.shape)) is not None:
        # One point. Every line counts here: a call takes less than two microseconds, a third of them in the library.
        ndir, free = places
        try:
            place = free.pop()
        except IndexError:
            place = _new_place(ndir)
        here, traction, tangent, time, arguments = place
        if state is None:
            here[...] = 0.0
        else:
            if type(state) is not _ndarray:
                state = numbers(state, 'state')
            if state.shape != _STATE_SHAPE:
                raise ValueError(f'state has the shape {state.shape}: {_STATE_SHAPE} is needed')
            here[...] = state
        try:
            time.value = dt
        except (TypeError, OverflowError):
            time.value = number(dt, 'dt')
        try:
            size, pointer = law._size, law._pointer
        except AttributeError:
            require_law(law, own=True)
            raise
        status = _update_point(ndir, du.tobytes(), time, size, pointer, *arguments)
        if status < 0:
            traction[...] = tangent[...] = _nan
        result = _new(Result, (traction.copy(), tangent.copy(), here.copy(), status))
        free.append(place)
        return result if out is None else _copy_to(out, result)
    if du.ndim != 2 or du.shape[1:] not in _PLACES:
        raise ValueError(f'du has the shape {du.shape}: (ndir,) or (n, ndir) with ndir 2 or 3 is needed')
    require_law(law, own=True)
    time = ctypes.c_double(number(dt, 'dt'))
    by_point = du.flags.c_contiguous or not du.flags.f_contiguous
    order: Literal['C', 'F'] = 'C' if by_point else 'F'
    n, ndir = du.shape
    if out is None:
        out = _new_result(n, ndir, order)
    else:
        _check_out(out, order, n, ndir)
        if any(np.may_share_memory(du, array) for array in out):
            du = du.copy(order)
    _take_state(out.state, state)
    if not isinstance(law, AtPoints):
        routine = _library.update_points if by_point else _library.update_batch
        _update_all(routine, np.asarray(du, order=order), time, law._size, law._pointer, out)
        return out
    if len(law) != n:
        raise ValueError(f'the law has constants of {len(law)} points, du of {n}')
    columns = out   # constants of each point go with arrays that are component-major
    if by_point:
        columns = _new_result(n, ndir, 'F')
        columns.state[...] = out.state
    _update_all(_library.update_batch_props, np.asarray(du, order='F'), time, len(law.props), law.props.ctypes.data, columns)
    if by_point:
        for name in Result._fields:
            getattr(out, name)[...] = getattr(columns, name)
    return out


def _new_result(n: int, ndir: int, order: Literal['C', 'F']) -> Result:
    return Result(np.empty((n, ndir), order=order), np.empty((n, ndir, ndir), order=order),
                  np.empty((n, STATE_SIZE), order=order), np.empty(n, np.int32))


def _take_state(new: np.ndarray, state: ArrayLike | None) -> None:
    """Puts the state at the start where the update works on it."""
    if state is None:
        new[...] = 0.0
    elif state is not new:
        state = numbers(state, 'state')
        if state.shape != new.shape:
            raise ValueError(f'state has the shape {state.shape}: {new.shape} is needed')
        new[...] = state


def _update_all(routine: Any, du: np.ndarray, dt: ctypes.c_double, nprops: int, props: Any, out: Result) -> None:
    """All points by a routine of the library, in place."""
    n, ndir = du.shape
    traction, tangent, state, status = out
    worst = routine(n, ndir, du.ctypes.data, dt, nprops, props, STATE_SIZE, state.ctypes.data, traction.ctypes.data,
                    tangent.ctypes.data, status.ctypes.data)
    if worst < 0:
        traction[status < 0] = np.nan
        tangent[status < 0] = np.nan


def _check_out(out: Result, order: str, n: int, ndir: int) -> None:
    _require_result(out)
    shapes = {'traction': (n, ndir), 'tangent': (n, ndir, ndir), 'state': (n, STATE_SIZE), 'status': (n,)}
    for name, shape in shapes.items():
        array = _array_of(out, name)
        kind = np.int32 if name == 'status' else np.float64
        lies = array.flags.c_contiguous if order == 'C' else array.flags.f_contiguous
        if array.shape != shape or array.dtype != kind or not lies or not array.flags.writeable:
            raise ValueError(f'out.{name}: an array of shape {shape}, {np.dtype(kind)}, in {order} order is needed')
    for first, second in itertools.combinations(shapes, 2):
        if np.may_share_memory(getattr(out, first), getattr(out, second)):
            raise ValueError(f'out.{first} and out.{second} share memory')


def _require_result(out: Any) -> None:
    if not isinstance(out, Result):
        raise TypeError(f'out: an earlier result is needed, not {out!r}')


def _array_of(out: Result, name: str) -> np.ndarray:
    array = getattr(out, name)
    if not isinstance(array, np.ndarray):
        raise TypeError(f'out.{name}: an array is needed, not {array!r}')
    return array


def _copy_to(out: Result, result: Result) -> Result:
    """The result of one point in the arrays of an earlier one."""
    _require_result(out)
    for name in ('traction', 'tangent', 'state'):
        array, shape = _array_of(out, name), getattr(result, name).shape
        if array.shape != shape or array.dtype != _FLOAT or not array.flags.writeable:
            raise ValueError(f'out.{name}: an array of shape {shape}, float64, that can be written is needed')
    for name in ('traction', 'tangent', 'state'):
        getattr(out, name)[...] = getattr(result, name)
    return out._replace(status=result.status)
