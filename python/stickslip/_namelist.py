"""Inputs of the program as groups of keys: from a namelist's text or file, and back. What the keys mean, and which are
right, the program alone knows."""
from __future__ import annotations

import copy
import os
import pathlib
import re
from collections.abc import Mapping, Sequence
from typing import Any, Union

import numpy as np

from . import _program
from ._arrays import numbers
from .laws import Law

Settings = dict[str, dict[str, Any]]
Source = Union[str, pathlib.Path, Mapping[str, Any]]
NAME = re.compile(r'[a-z_]\w*(\(\s*\d+\s*\))?', re.IGNORECASE | re.ASCII)   # of a group, or of a key and its place in a list


class InputError(ValueError):
    """An invalid input; the text lists all errors with line, group, key, value and rule."""


def merge(base: Settings, other: Settings) -> Settings:
    """A copy of `base` with the keys of `other` in place of its own; a file of the drive takes the place of its lists, too, and lists
    that of a file."""
    merged = copy.deepcopy(base)
    for group, keys in groups_of(other).items():
        own = merged.setdefault(group, {})
        if group == 'drive' and ('file' in keys or 'velocity' in keys):
            for key in [key for key in own if (key in DRIVE_LISTS) == ('file' in keys) and not key.startswith(OSCILLATION)]:
                del own[key]
        own.update(keys)
    return merged


DRIVE_LISTS = ('velocity', 'duration', 'normal', 'normal_change')
OSCILLATION = ('normal_amplitude', 'normal_frequency', 'normal_phase')   # beside lists and beside a file


def groups_of(source: Source) -> Settings:
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
    groups = _input_of(source).groups
    if not is_text(source):
        for keys in groups.values():   # the program looks for files beside its input
            if isinstance(keys.get('file'), str):
                keys['file'] = str(pathlib.Path(source).resolve().parent / keys['file'])
    return groups


def _input_of(source: str | pathlib.Path) -> _program.Namelists:
    """What a namelist says; InputError with all that is wrong with the way in which it is written."""
    if not isinstance(source, (str, os.PathLike)):
        raise TypeError(f'input: the name or the text of a namelist, or a dict, is needed, not {source!r}')
    if isinstance(source, str) and is_text(source):
        read = _program.namelists(source.encode(errors='replace'), 'input')
    else:
        read = _program.namelists(pathlib.Path(source).read_bytes(), str(source))
    if read.faults:
        raise InputError(read.faults.rstrip())
    return read


def _lowered(named: Mapping[str, Any], what: str) -> dict[str, Any]:
    """The same under lower-case names, which are what the program reads."""
    lowered: dict[str, Any] = {}
    for name, value in named.items():
        if not isinstance(name, str):
            raise TypeError(f'{what} {name!r}: a name is needed')
        if not NAME.fullmatch(name):
            raise InputError(f'{what} {name!r}: must be a name: letters, digits and underscores')
        if name.lower() in lowered:
            raise InputError(f'{what} {name.lower()}: given twice')
        lowered[name.lower()] = value
    return lowered


def is_text(source: Any) -> bool:
    """Is it a namelist itself, rather than the name of one?"""
    return isinstance(source, str) and '&' in source and ('\n' in source or re.match(r'\s*&\w+(\s|/\s*$)', source) is not None)


def named_text(source: Source) -> tuple[str, str]:
    """The text of a namelist, and what its faults call it."""
    if isinstance(source, Mapping):
        return written(groups_of(source)), 'input'
    return _input_of(source).text, 'input' if is_text(source) else str(source)


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
        if re.search('[\n\r\0\ud800-\udfff]', value):
            raise InputError(f'{where} = {value!r}: must be text of one line')
        return "'" + value.replace("'", "''") + "'"
    if isinstance(value, (np.datetime64, np.timedelta64)):
        raise TypeError(f'{where}: {value!r} is no number, but a time')
    if isinstance(value, np.ma.MaskedArray):   # NaN where it is masked, which the program refuses
        return _value(numbers(value, where).tolist(), where)
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
