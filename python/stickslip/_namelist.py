"""Inputs of the program as groups of keys: from a namelist's text or file, and back. What the keys mean, and which are
right, the program alone knows."""
from __future__ import annotations

import copy
import pathlib
from typing import Any

import numpy as np

from ._optional import needed
from .laws import Law

Settings = dict[str, dict[str, Any]]


def merge(base: Settings, other: Settings) -> Settings:
    """A copy of `base` with the keys of `other` in place of its own."""
    merged = copy.deepcopy(base)
    for group, keys in other.items():
        merged.setdefault(group.lower(), {}).update({key.lower(): value for key, value in keys.items()})
    return merged


def groups_of(source: str | pathlib.Path | dict) -> Settings:
    """Groups of keys from a file's name, a namelist's text, or a dict whose group ``friction`` may be a law."""
    if isinstance(source, dict):
        groups = {}
        for group, keys in source.items():
            if isinstance(keys, Law):
                keys = keys.constants()
            if not isinstance(keys, dict):
                raise TypeError(f'group {group}: a dict of keys is needed, not {keys!r}')
            groups[group.lower()] = {key.lower(): value for key, value in keys.items()}
        return groups
    f90nml, text = needed('f90nml', 'run'), text_of(source)
    try:
        parsed = f90nml.reads(text).todict()
    except Exception as error:   # its parser asserts, and runs off the end of texts
        raise ValueError(f'this is no namelist that can be read ({type(error).__name__}: {error}); is a quote or a slash '
                         'missing?') from error
    return {group: dict(keys) for group, keys in parsed.items() if isinstance(keys, dict)}


def is_text(source: str | pathlib.Path) -> bool:
    """Is it a namelist itself, rather than the name of one?"""
    return isinstance(source, str) and '&' in source and ('\n' in source or '/' in source[source.index('&'):])


def text_of(source: str | pathlib.Path | dict) -> str:
    """The text of a namelist."""
    if isinstance(source, dict):
        return written(groups_of(source))
    if is_text(source):
        return source
    return pathlib.Path(source).read_text()


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
    if isinstance(value, (list, tuple, np.ndarray)):
        return ', '.join(_value(item, where) for item in value)
    raise TypeError(f'{where}: {value!r} cannot be written to a namelist')
