"""The friction laws (docs/laws.md): named constants, checked by the library when an object is made.

Every law takes the stiffnesses of the contact, ``alpha_n`` and ``alpha_t`` [F/L^3], its own constants, and the
options of docs/law_options.md: ``tau_max``, a shear cap (0: none) [F/L^2]; ``mu_ratio``, the friction coefficient
along the second tangential axis over that along the first; ``direction`` of slip there, ``'associated'`` or
``'radial'``; ``cohesion``, a tangential traction without pressure [F/L^2]; ``eta_t``, a damper beside the tangential
contact spring [F T/L^3]. A constant out of its range is a ValueError in the library's own words.
"""
from __future__ import annotations

import ctypes
import dataclasses
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from . import _library

__all__ = ['AtPoints', 'Coulomb', 'FlashHeating', 'Law', 'LinkerDieterich', 'RateAndState', 'SlipWeakening', 'SlipWeakeningHealing',
           'StaticKinetic', 'Subloading']


@dataclasses.dataclass(frozen=True, kw_only=True)
class Law:
    """What all laws share. ``props`` are the constants in the order of the friction routine, read-only."""

    alpha_n: float
    alpha_t: float
    tau_max: float = 0.0
    mu_ratio: float = 1.0
    direction: str = 'associated'
    cohesion: float = 0.0
    eta_t: float = 0.0
    props: np.ndarray = dataclasses.field(init=False, repr=False, compare=False)

    number: ClassVar[int]
    name: ClassVar[str]

    def __post_init__(self) -> None:
        numbers = [float(self.number)]
        for constant in _library.constants_of(self.number):
            numbers.append(self._number(constant, numbers))
        props = np.array(numbers)
        props.flags.writeable = False
        object.__setattr__(self, 'props', props)
        object.__setattr__(self, '_size', len(props))
        object.__setattr__(self, '_pointer', ctypes.c_void_p(props.ctypes.data))
        if broken := _library.broken_rule(self._pointer, self._size):
            raise ValueError(f'{type(self).__name__}: {broken}')

    def _number(self, constant: _library.Constant, before: list[float]) -> float:
        """A constant as the number that the friction routine takes."""
        value = getattr(self, constant.name)
        if value is None:
            value = _library.default_of(before)
        elif constant.words and isinstance(value, str):
            if value not in constant.words:
                raise ValueError(f"{type(self).__name__}: {constant.name} = {value!r}: one of {', '.join(constant.words)}")
            value = constant.words.index(value)
        if value is None or isinstance(value, (str, bytes, bool)):
            raise TypeError(f'{type(self).__name__}: {constant.name} = {value!r} is not a number')
        try:
            return float(value)
        except (TypeError, ValueError):
            raise TypeError(f'{type(self).__name__}: {constant.name} = {value!r} is not a number') from None

    def at_points(self, **constants: ArrayLike) -> AtPoints:
        """The same law with other values of some constants at each of n points, for `update` and `slip_rates`.

        constants: numbers by name, n of each; the others, and all choices, are those of this law. A constant that has a
        default, and no value here, follows those of its point.
        """
        return AtPoints(self, constants)

    def constants(self) -> dict[str, Any]:
        """Names and values of the constants, as keys of the program's group ``&friction``."""
        given = {'law': self.name}
        for field in dataclasses.fields(self):
            value = getattr(self, field.name)
            if field.init and value is not None and (field.default is dataclasses.MISSING or value != field.default):
                given[field.name] = value
        return given


class AtPoints:
    """A law whose constants vary from point to point (`Law.at_points`).

    law: where all else is taken from. props: the constants in the order of the friction routine, component-major: shape
    (constants, n), read-only. ``len()`` is n. A constant out of its range is a ValueError that names the first such point.
    """

    def __init__(self, law: Law, constants: dict[str, ArrayLike]) -> None:
        self.law = law
        known = {constant.name: constant for constant in _library.constants_of(law.number)}
        given = {}
        for name, values in constants.items():
            if name not in known:
                raise TypeError(f"{type(law).__name__} has no constant {name}; there are {', '.join(known)}")
            if known[name].words:
                raise ValueError(f'{name} is a choice, which all points share')
            given[name] = np.asarray(values, float)
        sizes = {values.shape for values in given.values()}
        if len(sizes) != 1 or len(next(iter(sizes))) != 1:
            raise ValueError('one number a point is needed of each constant: the shapes are '
                             + (', '.join(f'{name} {values.shape}' for name, values in given.items()) or 'none'))
        rows = [np.full(sizes.pop(), float(law.number))]
        for place, name in enumerate(known, 1):
            if name in given:
                rows.append(given[name])
            elif getattr(law, name) is None:
                rows.append(np.array([_library.default_of(list(before)) for before in zip(*rows)], float))
            else:
                rows.append(np.full(rows[0].shape, law.props[place]))
        self.props = np.array(rows)
        self.props.flags.writeable = False
        self._check()

    def __len__(self) -> int:
        return self.props.shape[1]

    @property
    def _size(self) -> int:
        """What `update` of one point asks for first."""
        raise ValueError(f'the law has constants of {len(self)} points: du needs the shape ({len(self)}, ndir)')

    def __repr__(self) -> str:
        return f'{self.law!r} at {len(self)} points'

    def _check(self) -> None:
        for i, props in enumerate(np.ascontiguousarray(self.props.T)):
            if broken := _library.broken_rule(ctypes.c_void_p(props.ctypes.data), props.size):
                raise ValueError(f'{type(self.law).__name__}, point {i}: {broken}')


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


@dataclasses.dataclass(frozen=True, kw_only=True)
class Coulomb(Law):
    """Friction proportional to the pressure. mu: friction coefficient [-]."""

    mu: float

    number = 2
    name = 'coulomb'


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


@dataclasses.dataclass(frozen=True, kw_only=True)
class SlipWeakeningHealing(Law):
    """mu falls with slip, linearly, from mu_s to mu_k, and recovers with time, at rest from the moment slip ends.

    mu_s, mu_k: friction coefficients [-]; d_c: slip over which friction falls [L]; xi: rate of the recovery [1/T].
    """

    mu_s: float
    mu_k: float
    d_c: float
    xi: float

    number = 6
    name = 'slip_weakening_healing'


@dataclasses.dataclass(frozen=True, kw_only=True)
class FlashHeating(Law):
    """Rate-and-state friction, slip law, that weakens strongly beyond a slip rate.

    a, b, d_c, v0, f0, theta_0: as of RateAndState, b > 0; f_w: friction coefficient far above v_w, up to f0 [-]; v_w: slip
    rate beyond which friction weakens [L/T]; n: how sharply, 1 to 1000.
    """

    a: float
    b: float
    d_c: float
    v0: float
    f0: float
    f_w: float
    v_w: float
    n: float = 8.0
    theta_0: float | None = None

    number = 7
    name = 'flash_heating'


@dataclasses.dataclass(frozen=True, kw_only=True)
class LinkerDieterich(Law):
    """Rate-and-state friction whose state depends on the contact pressure.

    a, b, d_c, v0, f0, evolution, theta_0: as of RateAndState, b > 0; alpha: effect of the pressure on the state [-].
    """

    a: float
    b: float
    d_c: float
    v0: float
    f0: float
    alpha: float
    evolution: str = 'ageing'
    theta_0: float | None = None

    number = 8
    name = 'linker_dieterich'
