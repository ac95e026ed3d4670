"""Friction in continuous time: rates of a state, slip rates without a contact spring (docs/python.md)."""
from __future__ import annotations

import ctypes
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from . import _library
from ._arrays import number, numbers
from ._update import STATE_SIZE
from .laws import AtPoints, Law, require_law


LEAST_PROPS = 8   # that the library's slip rates ask for


class Rates(NamedTuple):
    """Result of `rates`. For one point the arrays lack the first dimension, and `status` is an int."""

    rates: np.ndarray    #: (n, 8) d(state)/dt; that of the contact's status is 0; NaN where status < 0
    status: np.ndarray   #: (n,) 0, or < 0 refused: `message(status)`; -11 where slip starts with a jump and has no rate


class SlipRates(NamedTuple):
    """Result of `slip_rates`, in the shape of its arguments."""

    rate: np.ndarray         #: slip rate, >= 0 [L/T]; NaN where status < 0
    theta_rate: np.ndarray   #: d(theta)/dt at that slip rate [-]; NaN where status < 0
    status: np.ndarray       #: 0, or < 0 refused: `message(status)`


def rates(velocity: ArrayLike, law: Law, state: ArrayLike) -> Rates:
    """Rates of a contact's state, to which `update` converges as its time increment tends to 0 (docs/theory.md, section 10).

    velocity: relative velocity, normal, tangential 1[, tangential 2] [L/T]; shape (ndir,), or (n, ndir) for n points,
        with ndir 2 or 3.
    law: an object of `stickslip.laws`.
    state: shape (8,) or (n, 8), as `update` returns it; not changed.

    A point with an invalid state or velocity has a negative status; wrong shapes raise ValueError.
    """
    require_law(law, own=False)
    velocity, state = numbers(velocity, 'velocity'), numbers(state, 'state')
    if velocity.ndim not in (1, 2) or velocity.shape[-1] not in (2, 3):
        raise ValueError(f'velocity has the shape {velocity.shape}: (ndir,) or (n, ndir) with ndir 2 or 3 is needed')
    if state.shape != (*velocity.shape[:-1], STATE_SIZE):
        raise ValueError(f'state has the shape {state.shape}: {(*velocity.shape[:-1], STATE_SIZE)} is needed')
    velocity, state = np.ascontiguousarray(velocity), np.ascontiguousarray(state)
    found = np.full(state.shape, np.nan)
    points = velocity.size // velocity.shape[-1]
    status = np.empty(points, np.int32)
    for i in range(points):
        status[i] = _library.rates(velocity.shape[-1], velocity.ctypes.data + i * velocity.strides[0], law._size,
                                   law._pointer, STATE_SIZE, state.ctypes.data + i * state.strides[0],
                                   found.ctypes.data + i * found.strides[0])
    one: Any = int(status[0]) if velocity.ndim == 1 else status
    return Rates(found, one)


def slip_rates(tau: ArrayLike, pressure: ArrayLike, law: Law | AtPoints, theta: ArrayLike, damping: float = 0.0) -> SlipRates:
    """Slip rates V >= 0 of points without a contact spring: tau - damping V = friction(V, theta, pressure).

    tau: magnitude of the tangential traction, >= 0 [F/L^2].
    pressure: >= 0 [F/L^2].
    law: `RateAndState` (others get the status -2, bad law), or one at points (`Law.at_points`). Its springs are not used.
    theta: state of the surface, > 0 [T].
    damping: radiation damping, >= 0, for instance G/(2 c_s) [F T/L^3].

    tau, pressure and theta are numbers or arrays that can be broadcast together; with a law at n points
    their shape is (n,). A point with invalid input has a negative status; other points are not affected. Releases the
    interpreter's lock; more than 2000 points are divided among OpenMP threads.
    """
    require_law(law, own=True)
    points = (len(law),) if isinstance(law, AtPoints) else ()
    drag = ctypes.c_double(number(damping, 'damping'))
    given = numbers(tau, 'tau'), numbers(pressure, 'pressure'), numbers(theta, 'theta')
    shape = np.broadcast_shapes(*(values.shape for values in given), points)
    tau, pressure, theta = (np.ascontiguousarray(np.broadcast_to(values, shape)) for values in given)
    n = tau.size
    if points and shape != points:
        raise ValueError(f'the law has constants of {points[0]} points, the other arguments the shape {shape}')
    props = law.props if points else np.repeat(law.props[:, None], n, axis=1)
    if len(props) < LEAST_PROPS:   # so that the status says that the law is the wrong one
        props = np.concatenate([props, np.zeros((LEAST_PROPS - len(props), n))])
    rate, theta_rate, status = np.full(shape, np.nan), np.full(shape, np.nan), np.empty(shape, np.int32)
    _library.slip_rates(n, tau.ctypes.data, pressure.ctypes.data, drag, len(props), props.ctypes.data, theta.ctypes.data,
                        rate.ctypes.data, theta_rate.ctypes.data, status.ctypes.data)
    return SlipRates(rate, theta_rate, status)
