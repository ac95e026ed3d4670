"""The library of include/friction.h, loaded by ctypes: prototypes, and nothing else."""
from __future__ import annotations

import ctypes
import functools
import operator
import pathlib
import sys
from typing import Any, NamedTuple

_int, _int64, _double, _pointer = ctypes.c_int, ctypes.c_int64, ctypes.c_double, ctypes.c_void_p
_arrays: tuple[Any, ...] = (_int, _pointer, _double, _int, _pointer, _int, _pointer, _pointer, _pointer)


def load(name: str) -> ctypes.CDLL:
    """A shared library of this package."""
    ending = 'dylib' if sys.platform == 'darwin' else 'so'
    # An editable installation has modules in one folder of the package and libraries in another.
    paths = [pathlib.Path(folder).resolve() / f'lib{name}.{ending}' for folder in sys.modules[__package__].__path__]
    path = next((path for path in paths if path.exists()), paths[0])
    try:
        return ctypes.CDLL(str(path))
    except OSError as error:
        raise ImportError(f'stickslip: cannot load {path}: {error}. Is libgfortran installed, and was the package '
                          'installed with pip rather than imported from its source folder?') from error


library = load('stickslip')
# One point takes so little time that checks of argument types, and giving the interpreter's lock away, would double it:
# its caller passes ctypes objects.
update_one = ctypes.PyDLL(library._name)['friction_update']
update_batch = library.friction_update_batch
update_batch.argtypes = [_int64, *_arrays, _pointer]
update_points = library.friction_update_points
update_points.argtypes = [_int64, *_arrays, _pointer]
update_batch_props = library.friction_update_batch_props
update_batch_props.argtypes = [_int64, *_arrays, _pointer]
rates = library.friction_rates
rates.argtypes = [_int, _pointer, _int, _pointer, _int, _pointer, _pointer]
slip_rates = library.friction_slip_rates
slip_rates.argtypes = [_int64, _pointer, _pointer, _double, _int, *5 * [_pointer]]
library.friction_message.restype = ctypes.c_char_p
library.friction_version.restype = ctypes.c_char_p

version: str = library.friction_version().decode()


def message(status: int) -> str:
    """The text of a status of the friction routine, in one line (docs/user_guide.md, Status codes). status: a whole number."""
    try:
        return library.friction_message(_int(operator.index(status))).decode()
    except TypeError:
        raise TypeError(f'status = {status!r}: a whole number is needed') from None


class _LawFacts(ctypes.Structure):
    _fields_ = [('name', ctypes.c_char * 24), ('internal', ctypes.c_char * 16), ('internal_unit', ctypes.c_char * 8),
                ('has_internal', _int), ('constants', _int)]


class _ConstantFacts(ctypes.Structure):
    _fields_ = [('name', ctypes.c_char * 24), ('unit', ctypes.c_char * 8), ('meaning', ctypes.c_char * 72),
                ('rule', ctypes.c_char * 104), ('default_text', ctypes.c_char * 24), ('words', ctypes.c_char * 72),
                ('lower', _double), ('upper', _double), ('optional', _int), ('choice', _int)]


class Constant(NamedTuple):
    """What the library tells about a material constant."""

    name: str
    unit: str
    meaning: str
    rule: str                #: 'must be > 0', ...
    optional: bool
    default: str             #: '0', 'mu_s', 'd_c/v0', ...; '' where there is none
    words: tuple[str, ...]   #: of a choice: those that stand for 0, 1, ...; else empty


library.friction_get_default.argtypes = [_int, _pointer, _int, ctypes.POINTER(_double)]
library.friction_check.argtypes = [_int, _pointer, _int, ctypes.c_char_p]


def law_count() -> int:
    """Laws are numbered from 1 to this."""
    return library.friction_law_count()


def law_name(law: int) -> str:
    """The name of a law in the program's input."""
    facts = _LawFacts()
    library.friction_get_law(law, ctypes.byref(facts))
    return facts.name.decode()


def law_summary(law: int) -> str:
    """What a law is, in words."""
    text = ctypes.create_string_buffer(81)
    library.friction_get_law_summary(law, len(text), text)
    return text.value.decode()


@functools.cache
def constants_of(law: int) -> tuple[Constant, ...]:
    """The constants of a law after its number, in their order."""
    facts, constant = _LawFacts(), _ConstantFacts()
    library.friction_get_law(law, ctypes.byref(facts))
    found = []
    for place in range(1, facts.constants):
        library.friction_get_constant(law, place, ctypes.byref(constant))
        found.append(Constant(constant.name.decode(), constant.unit.decode(), constant.meaning.decode(), constant.rule.decode(),
                              bool(constant.optional), constant.default_text.decode(),
                              tuple(constant.words.decode().split()) if constant.choice else ()))
    return tuple(found)


def default_of(props: list[float]) -> float | None:
    """The default of the constant that follows those given; None where there is none."""
    value = _double()
    known = (_double * len(props))(*props)
    status = library.friction_get_default(len(props), known, len(props), ctypes.byref(value))
    return value.value if status == 0 else None


def broken_rule(props: ctypes.c_void_p, size: int) -> str:
    """Which constant breaks which rule; empty if none does."""
    text = ctypes.create_string_buffer(96)
    status = library.friction_check(size, props, len(text), text)
    return '' if status == 0 else text.value.decode() or message(status)
