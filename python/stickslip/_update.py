"""The friction routine on numpy arrays (docs/python.md)."""
from __future__ import annotations

import ctypes
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from . import _library
from .laws import Law

STATE_SIZE = 8   # numbers of a state: status, u_n, u_et1, u_et2, mu, internal variable, slip, dissipated energy
_FLOAT = np.dtype(np.float64)

# By the shape of du: memory for state, traction and tangent (column-major) of a point, and their places in it.
_LAYOUTS = {(ndir,): (ctypes.c_double * (STATE_SIZE + ndir + ndir**2), ndir, STATE_SIZE + ndir, (ndir, ndir),
                      8 * STATE_SIZE, 8 * (STATE_SIZE + ndir)) for ndir in (2, 3)}
_byref, _c_double, _update_point = ctypes.byref, ctypes.c_double, _library.update_one
_frombuffer, _ndarray, _new = np.frombuffer, np.ndarray, tuple.__new__


class Result(NamedTuple):
    """What an update gives. For one point the arrays lack the first dimension, and `status` is an int."""

    traction: np.ndarray   #: (n, ndir) transmitted traction, tension positive [F/L^2]; NaN where status < 0
    tangent: np.ndarray    #: (n, ndir, ndir), d(traction i)/d(du j), unsymmetric [F/L^3]; NaN where status < 0
    state: np.ndarray      #: (n, 8) at the end of the increment; where status < 0 that at its start
    status: np.ndarray     #: (n,) 0 solved, 1 solved but several equilibria exist, < 0 refused: `message(status)`


def update(du: ArrayLike, dt: float, law: Law, state: ArrayLike | None = None, out: Result | None = None) -> Result:
    """Friction update of one contact point, or of many with the same constants.

    du: increment of relative displacement, normal, tangential 1[, tangential 2] [L]; shape (ndir,), or (n, ndir) for n
        points, with ndir 2 or 3. An array in C order, or in Fortran order (component-major), of 64-bit floats is used
        where it lies; others are copied.
    dt: increment of time, >= 0 [T].
    law: an object of `stickslip.laws`.
    state: shape (8,) or (n, 8), at the start of the increment, as an earlier result gave it; None: virgin points. It is
        left as it is.
    out: an earlier result of the same shapes and order whose arrays are written again, which saves the time that new
        memory takes. Its `state` may be the `state` given here.

    Results have the order of `du`. A bad increment or state is a negative status of that point and harms no other; wrong
    shapes are a ValueError. Releases the interpreter's lock, so that threads run side by side.
    """
    if type(du) is not _ndarray or du.dtype is not _FLOAT:
        du = np.asarray(du, _FLOAT)
    if (layout := _LAYOUTS.get(du.shape)) is not None:
        # One point. Every line counts here: a call takes two microseconds, half of them in the library.
        buffer, ndir, last, square, to_traction, to_tangent = layout
        room = buffer()
        numbers = _frombuffer(room)
        if state is not None:
            if len(state) != STATE_SIZE:
                raise ValueError(f'state has the length {len(state)}: {STATE_SIZE} is needed')
            numbers[:STATE_SIZE] = state
        status = _update_point(ndir, du.tobytes(), _c_double(dt), law._size, law._pointer, STATE_SIZE, room,
                               _byref(room, to_traction), _byref(room, to_tangent))
        if status < 0:
            numbers[STATE_SIZE:] = np.nan
        result = _new(Result, (numbers[STATE_SIZE:last], numbers[last:].reshape(square).T, numbers[:STATE_SIZE], status))
        return result if out is None else _copy_to(out, result)
    if du.ndim != 2 or du.shape[1:] not in _LAYOUTS:
        raise ValueError(f'du has the shape {du.shape}: (ndir,) or (n, ndir) with ndir 2 or 3 is needed')
    by_point = du.flags.c_contiguous or not du.flags.f_contiguous
    order = 'C' if by_point else 'F'
    du = np.asarray(du, order=order)
    n, ndir = du.shape
    if out is None:
        out = Result(np.empty((n, ndir), order=order), np.empty((n, ndir, ndir), order=order),
                     np.empty((n, STATE_SIZE), order=order), np.empty(n, np.int32))
    else:
        _check_out(out, order, n, ndir)
    traction, tangent, new, status = out
    if state is None:
        new[...] = 0.0
    elif state is not new:
        state = np.asarray(state, np.float64)
        if state.shape != new.shape:
            raise ValueError(f'state has the shape {state.shape}: {new.shape} is needed')
        new[...] = state
    routine = _library.update_points if by_point else _library.update_batch
    worst = routine(n, ndir, du.ctypes.data, dt, law._size, law._pointer, STATE_SIZE, new.ctypes.data,
                    traction.ctypes.data, tangent.ctypes.data, status.ctypes.data)
    if worst < 0:
        traction[status < 0] = np.nan
        tangent[status < 0] = np.nan
    return out


def _check_out(out: Result, order: str, n: int, ndir: int) -> None:
    shapes = {'traction': (n, ndir), 'tangent': (n, ndir, ndir), 'state': (n, STATE_SIZE), 'status': (n,)}
    for name, shape in shapes.items():
        array = getattr(out, name)
        kind = np.int32 if name == 'status' else np.float64
        lies = array.flags.c_contiguous if order == 'C' else array.flags.f_contiguous
        if array.shape != shape or array.dtype != kind or not lies or not array.flags.writeable:
            raise ValueError(f'out.{name}: an array of shape {shape}, {np.dtype(kind)}, in {order} order is needed')


def _copy_to(out: Result, result: Result) -> Result:
    """The result of one point in the arrays of an earlier one."""
    for name in ('traction', 'tangent', 'state'):
        getattr(out, name)[...] = getattr(result, name)
    return out._replace(status=result.status)
