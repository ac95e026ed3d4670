"""Inputs of the program as groups of keys: from a namelist's text or file, and back. What the keys mean, and which are
right, the program alone knows."""
from __future__ import annotations

import copy
import os
import pathlib
import re
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ._optional import needed
from ._text import decoded
from .laws import Law

Settings = dict[str, dict[str, Any]]


class InputError(ValueError):
    """An input that breaks rules; the text lists every fault with its line, group, key, value and rule."""


def merge(base: Settings, other: Settings) -> Settings:
    """A copy of `base` with the keys of `other` in place of its own."""
    merged = copy.deepcopy(base)
    for group, keys in groups_of(other).items():
        merged.setdefault(group, {}).update(keys)
    return merged


def groups_of(source: str | pathlib.Path | dict) -> Settings:
    """Groups of keys from a file's name, a namelist's text, or a dict whose group ``friction`` may be a law."""
    if isinstance(source, Mapping):
        groups = {}
        for group, keys in source.items():
            if isinstance(keys, Law):
                keys = keys.constants()
            if not isinstance(keys, Mapping):
                raise TypeError(f'group {group}: a dict of keys is needed, not {keys!r}')
            groups[group] = _lowered(keys, f'group {group}, key')
        return _lowered(groups, 'group')
    f90nml, text = needed('f90nml', 'run'), text_of(source)
    _refuse_misread(text)
    try:
        parsed = f90nml.reads(text).todict()
    except Exception as error:   # its parser asserts, and runs off the end of texts
        raise InputError(f'this is no namelist that can be read ({type(error).__name__}: {error}); is a quote or a slash '
                         'missing?') from error
    groups = {group: dict(keys) for group, keys in parsed.items() if isinstance(keys, dict)}
    if not is_text(source):
        for keys in groups.values():   # the program looks for files beside its input
            if isinstance(keys.get('file'), str):
                keys['file'] = str(pathlib.Path(source).resolve().parent / keys['file'])
    return groups


def _refuse_misread(text: str) -> None:
    """Raises InputError with what the parser takes without a word, and in another way than the program."""
    bare = re.sub(r"""'[^']*'|"[^"]*"|![^\n]*""", '', text)   # without texts and comments
    found: set[str] = set()
    faults = []
    for group, body in re.findall(r'&(\w+)(.*?)(?:/|&end\b|$)', bare.lower(), re.DOTALL):
        keys = re.findall(r'([a-z]\w*)\s*(\([^)]*\))?\s*=', body)
        for name in [f'group &{group}', *(f'&{group} {key}{place}' for key, place in keys)]:
            if name in found:
                faults.append(f'{name}: given twice')
            found.add(name)
        faults += [f'&{group} {key}{place}: give the whole list, without subscripts' for key, place in keys if place]
    if faults:
        raise InputError('\n'.join(faults))


def _lowered(named: Mapping[str, Any], what: str) -> dict[str, Any]:
    """The same under lower-case names, which are what the program reads."""
    lowered: dict[str, Any] = {}
    for name, value in named.items():
        if not isinstance(name, str):
            raise TypeError(f'{what} {name!r}: a name is needed')
        if name.lower() in lowered:
            raise InputError(f'{what} {name.lower()}: given twice')
        lowered[name.lower()] = value
    return lowered


def is_text(source: str | pathlib.Path) -> bool:
    """Is it a namelist itself, rather than the name of one?"""
    return isinstance(source, str) and '&' in source and ('\n' in source or re.match(r'\s*&\w+(\s|/\s*$)', source) is not None)


def text_of(source: str | pathlib.Path | dict) -> str:
    """The text of a namelist."""
    if isinstance(source, Mapping):
        return written(groups_of(source))
    if not is_text(source):
        try:
            return decoded(pathlib.Path(source).read_bytes())
        except ValueError as error:
            raise InputError(f'{source}: {error}') from None
    if '\0' in source:
        raise InputError('the text of the input holds a character 0')
    return source


def written(groups: Settings) -> str:
    """Groups of keys as a namelist."""
    lines = []
    for group, keys in groups.items():
        lines.append(f'&{group}')
        lines += [f'    {key} = {_value(value, f"{group}.{key}")}' for key, value in keys.items() if value is not None]
        lines.append('/\n')
    return '\n'.join(lines)


def _value(value: Any, where: str) -> str:
    if isinstance(value, (bool, np.bool_)):
        return '.true.' if value else '.false.'
    if isinstance(value, str):
        return "'" + value.replace("'", "''") + "'"
    if isinstance(value, (int, np.integer)):
        return str(int(value))
    if isinstance(value, (float, np.floating)):
        return repr(float(value))
    if isinstance(value, os.PathLike):
        return _value(os.fspath(value), where)
    if hasattr(value, '__array__'):   # numpy's, pandas' and others'; some of no dimension
        return _value(np.asarray(value).tolist(), where)
    if isinstance(value, Sequence) and not isinstance(value, (bytes, bytearray)):
        return ', '.join(_value(item, where) for item in value)
    raise TypeError(f'{where}: {value!r} cannot be written to a namelist')
