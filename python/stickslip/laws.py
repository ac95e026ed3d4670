"""The friction laws (docs/laws.md): named constants, checked by the library when an object is made.

Every law takes the stiffnesses of the contact, ``alpha_n`` and ``alpha_t`` [F/L^3], its own constants, and the
options of docs/law_options.md: ``tau_max``, a shear cap (0: none) [F/L^2]; ``mu_ratio``, the friction coefficient
along the second tangential axis over that along the first; ``direction`` of slip there, ``'associated'`` or
``'radial'``. A constant out of its range is a ValueError in the library's own words.
"""
from __future__ import annotations

import ctypes
import dataclasses
from typing import Any, ClassVar

import numpy as np

from . import _library

__all__ = ['Coulomb', 'Law', 'RateAndState', 'SlipWeakening', 'StaticKinetic', 'Subloading']

_WORDS = {
    'scheme': ('backward_euler', 'exact_rate'),
    'u_of_r': ('logarithm', 'cotangent', 'reciprocal'),
    'evolution': ('ageing', 'slip'),
    'direction': ('associated', 'radial'),
}


@dataclasses.dataclass(frozen=True, kw_only=True)
class Law:
    """What all laws share. ``props`` are the constants in the order of the friction routine, read-only."""

    alpha_n: float
    alpha_t: float
    tau_max: float = 0.0
    mu_ratio: float = 1.0
    direction: str = 'associated'
    props: np.ndarray = dataclasses.field(init=False, repr=False, compare=False)

    number: ClassVar[int]
    name: ClassVar[str]
    _own: ClassVar[tuple[str, ...]]

    def __post_init__(self) -> None:
        names = ('alpha_n', 'alpha_t', *self._own, 'tau_max', 'mu_ratio', 'direction')
        props = np.array([self.number, *(self._value(name) for name in names)], float)
        props.flags.writeable = False
        object.__setattr__(self, 'props', props)
        object.__setattr__(self, '_size', len(props))
        object.__setattr__(self, '_pointer', ctypes.c_void_p(props.ctypes.data))
        self._check()

    def _value(self, name: str) -> float:
        """A constant as the number that the friction routine takes."""
        value = getattr(self, name)
        if value is None:
            value = self._default(name)
        if name in _WORDS:
            if value not in _WORDS[name]:
                raise ValueError(f"{type(self).__name__}: {name} = {value!r}: one of {', '.join(_WORDS[name])}")
            return float(_WORDS[name].index(value))
        if isinstance(value, (str, bytes, bool)):
            raise TypeError(f'{type(self).__name__}: {name} = {value!r} is not a number')
        try:
            return float(value)
        except (TypeError, ValueError):
            raise TypeError(f'{type(self).__name__}: {name} = {value!r} is not a number') from None

    def _default(self, name: str) -> float:
        raise TypeError(f'{type(self).__name__}: {name} is None')

    def _check(self) -> None:
        """Lets the library look at the constants: an update of a virgin point that does not move."""
        du, traction, tangent, state = ((ctypes.c_double * size)() for size in (2, 2, 4, 8))
        status = _library.update_one(2, du, ctypes.c_double(0.0), len(self.props), self._pointer, 8, state, traction,
                                     tangent)
        if status < 0:
            raise ValueError(f'{type(self).__name__}: {_library.message(status)}: {self.constants()}')

    def constants(self) -> dict[str, Any]:
        """Names and values of the constants, as keys of the program's group ``&friction``."""
        given = {'law': self.name}
        for field in dataclasses.fields(self):
            value = getattr(self, field.name)
            if field.init and value is not None and (field.default is dataclasses.MISSING or value != field.default):
                given[field.name] = value
        return given


@dataclasses.dataclass(frozen=True, kw_only=True)
class Subloading(Law):
    """Time-dependent elastoplastic friction with a subloading surface (docs/theory.md).

    mu_s, mu_k: static and kinetic friction coefficient [-]; kappa: loss of mu with slip [1/L]; xi: recovery of mu with
    time [1/T]; m: how fast the surface passes from stick to slip [1/L]; mu_0: mu of a virgin point, default mu_s;
    scheme: 'backward_euler', or 'exact_rate' for an exact integration over increments of constant slip rate; u_of_r:
    'logarithm', 'cotangent' or 'reciprocal'.
    """

    mu_s: float
    mu_k: float
    kappa: float
    xi: float
    m: float
    mu_0: float | None = None
    scheme: str = 'backward_euler'
    u_of_r: str = 'logarithm'

    number = 1
    name = 'subloading'
    _own = ('mu_s', 'mu_k', 'kappa', 'xi', 'm', 'mu_0', 'scheme', 'u_of_r')

    def _default(self, name: str) -> float:
        return self.mu_s if name == 'mu_0' else super()._default(name)


@dataclasses.dataclass(frozen=True, kw_only=True)
class Coulomb(Law):
    """Friction proportional to the pressure. mu: friction coefficient [-]."""

    mu: float

    number = 2
    name = 'coulomb'
    _own = ('mu',)


@dataclasses.dataclass(frozen=True, kw_only=True)
class StaticKinetic(Law):
    """mu = mu_k + (mu_s - mu_k) exp(-d_c v).

    mu_s, mu_k: friction coefficient at rest and in fast sliding [-]; d_c: decay with the slip rate [T/L].
    """

    mu_s: float
    mu_k: float
    d_c: float

    number = 3
    name = 'static_kinetic'
    _own = ('mu_s', 'mu_k', 'd_c')


@dataclasses.dataclass(frozen=True, kw_only=True)
class RateAndState(Law):
    """Regularised rate-and-state friction.

    a, b: direct and evolution effect [-]; d_c: slip over which the state evolves [L]; v0: reference slip rate [L/T];
    f0: friction coefficient of steady sliding at v0 [-]; evolution: 'ageing' or 'slip' law; theta_0: state of a virgin
    point, default d_c/v0 [T].
    """

    a: float
    b: float
    d_c: float
    v0: float
    f0: float
    evolution: str = 'ageing'
    theta_0: float | None = None

    number = 4
    name = 'rate_and_state'
    _own = ('a', 'b', 'd_c', 'v0', 'f0', 'evolution', 'theta_0')

    def _default(self, name: str) -> float:
        if name != 'theta_0':
            return super()._default(name)
        d_c, v0 = self._value('d_c'), self._value('v0')
        return d_c / v0 if v0 != 0 else float('nan')   # a v0 of 0 is refused anyway


@dataclasses.dataclass(frozen=True, kw_only=True)
class SlipWeakening(Law):
    """mu falls with slip, linearly, from mu_s to mu_k, and stays there.

    mu_s, mu_k: friction coefficients [-]; d_c: slip over which friction falls [L].
    """

    mu_s: float
    mu_k: float
    d_c: float

    number = 5
    name = 'slip_weakening'
    _own = ('mu_s', 'mu_k', 'd_c')
