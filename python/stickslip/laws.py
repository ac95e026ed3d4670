"""The friction laws (docs/laws.md): named constants, checked by the library when an object is made.

There is a class for each law of the library, made from the library's own table when this module is loaded: `Subloading`,
`Coulomb`, `StaticKinetic`, `RateAndState`, `SlipWeakening`, `SlipWeakeningHealing`, `FlashHeating`, `LinkerDieterich`;
``help(stickslip.laws.Coulomb)`` lists its constants. Every law takes the stiffnesses of the contact, ``alpha_n`` and
``alpha_t`` [F/L^3], its own constants, and the options of docs/law_options.md. A constant out of its range raises a
ValueError with the rule of the library.
"""
from __future__ import annotations

import ctypes
import dataclasses
import functools
import math
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from . import _library
from ._arrays import numbers

__all__ = ['AtPoints', 'Law', 'classes']


@dataclasses.dataclass(frozen=True, kw_only=True)
class Law:
    """What all laws share. ``props`` are the constants in the order of the friction routine, read-only."""

    props: np.ndarray = dataclasses.field(init=False, repr=False, compare=False)

    number: ClassVar[int]
    name: ClassVar[str]
    _size: ClassVar[int]   # of props, and a pointer to them: set in each object, and no fields of it
    _pointer: ClassVar[ctypes.c_void_p]

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
        for number, constant in zip(numbers[1:], _library.constants_of(self.number)):
            if constant.words:   # a choice may be given by its number, too: the program takes words alone
                object.__setattr__(self, constant.name, constant.words[int(number)])
            elif getattr(self, constant.name) is not None:   # an array, or a number of less digits, is no value of its own
                object.__setattr__(self, constant.name, number)

    def __reduce__(self) -> tuple:
        """How a law is pickled and copied: made anew from its constants, because pointers belong to one process."""
        return functools.partial(type(self), **{field.name: getattr(self, field.name) for field in dataclasses.fields(self)
                                                if field.init}), ()

    def _number(self, constant: _library.Constant, before: list[float]) -> float:
        """A constant as the number that the friction routine takes."""
        value = getattr(self, constant.name)
        if value is None:
            value = _library.default_of(before)
        elif constant.words and isinstance(value, str):
            if value not in constant.words:
                raise ValueError(f"{type(self).__name__}: {constant.name} = {value!r}: one of {', '.join(constant.words)}")
            value = constant.words.index(value)
        if value is None or isinstance(value, (str, bytes, bool, np.bool_)):
            raise TypeError(f'{type(self).__name__}: {constant.name} = {value!r} is not a number')
        try:
            number = float(value)
        except (TypeError, ValueError):
            raise TypeError(f'{type(self).__name__}: {constant.name} = {value!r} is not a number') from None
        except OverflowError:
            raise ValueError(f'{type(self).__name__}: {constant.name} is larger than the largest number') from None
        if not math.isfinite(number):
            raise ValueError(f'{type(self).__name__}: {constant.name} = {number}: must be finite')
        return number

    def at_points(self, **constants: ArrayLike) -> AtPoints:
        """The same law with other values of some constants at each of n points, for `update` and `slip_rates`.

        constants: n numbers for each name; other constants, and all choices, are those of this law. The default of a constant
        without a value may depend on other constants of its point.
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

    law: the law of the points, with the other constants. props: the constants in the order of the friction routine, component-major: shape
    (constants, n), read-only. ``len()`` is n. A constant out of its range raises a ValueError with the first such point.
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
            given[name] = numbers(values, name)
            if not (finite := np.isfinite(given[name]).ravel()).all():
                i = int(np.argmin(finite))
                raise ValueError(f'{type(law).__name__}, point {i}: {name} = {given[name].ravel()[i]}: must be finite')
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

    def __setstate__(self, state: dict[str, Any]) -> None:
        """What pickle does, but for the array, which it would leave writable."""
        self.__dict__.update(state)
        self.props.flags.writeable = False

    _pointer: ClassVar[ctypes.c_void_p]   # a law has one, points do not

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


def require_law(law: Any, own: bool) -> None:
    """Raises TypeError where this is no law, or none that is allowed. own: may points have constants of their own?"""
    if not isinstance(law, (Law, AtPoints) if own else Law):
        raise TypeError(f'law: an object of stickslip.laws{"" if own else ", the same at all points,"} is needed, not {law!r}')


def _field(constant: _library.Constant) -> tuple[str, Any, Any]:
    """A constant as the field of a dataclass: its default is a number, a word, or None where it depends on others."""
    if not constant.optional:
        return constant.name, float, dataclasses.field()
    if constant.words:
        return constant.name, str, dataclasses.field(default=constant.default)
    try:
        return constant.name, float, dataclasses.field(default=float(constant.default))
    except ValueError:
        return constant.name, float | None, dataclasses.field(default=None)


def _described(constant: _library.Constant) -> str:
    """A constant in one line, for `help`."""
    rule = ' or '.join(map(repr, constant.words)) or constant.rule.removeprefix('must be ')
    default = f'; default {constant.default}' if constant.optional else ''
    return f'{constant.name}: {constant.meaning} [{constant.unit}], {rule}{default}'


def _law_class(number: int) -> type[Law]:
    """The class of a law: 'RateAndState' for 'rate_and_state'."""
    name, constants = _library.law_name(number), _library.constants_of(number)
    made = dataclasses.make_dataclass(
        ''.join(word.capitalize() for word in name.split('_')), map(_field, constants), bases=(Law,), frozen=True, kw_only=True,
        namespace={'number': number, 'name': name})
    made.__module__ = __name__
    made.__doc__ = '\n'.join([f'{_library.law_summary(number)}.', '', *map(_described, constants)])
    return made


#: All laws by their names in the program's input.
classes: dict[str, type[Any]] = {made.name: made for made in map(_law_class, range(1, _library.law_count() + 1))}
globals().update({made.__name__: made for made in classes.values()})
__all__ += [made.__name__ for made in classes.values()]

if TYPE_CHECKING:
    def __getattr__(name: str) -> Any:
        """The classes of the laws, which only a running program knows."""
