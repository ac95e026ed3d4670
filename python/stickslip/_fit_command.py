"""stickslip-fit INPUT.nml: `fit` from a namelist with a group &fit (docs/fitting.md)."""
from __future__ import annotations

import argparse
import math
import pathlib
import sys
from typing import Any

from . import _namelist
from ._fit import Fit, fit
from ._namelist import InputError
from ._records import Record

#: Keys of &fit: what they are, and their defaults. Lists give one value a record.
RECORD_KEYS = {'time_column': 'time', 'force_column': 'spring_force', 'time_factor': 1.0, 'force_factor': 1.0,
               'force_offset': 0.0, 'start': None, 'end': None, 'velocity': None, 'stiffness': None, 'normal_traction': None}
FIT_KEYS = {'records': None, 'free': None, 'lower': None, 'upper': None, 'factor': 5.0, 'seed': 1, 'starts': 128, 'jobs': 1,
            'most_evaluations': None, 'most_seconds': None}
MODEL_KEYS = {'velocity': 'drive', 'stiffness': 'slider', 'normal_traction': 'slider'}
TEXTS = ('records', 'free', 'time_column', 'force_column')
WHOLE = ('seed', 'starts', 'jobs', 'most_evaluations')
LISTS = ('records', 'free', 'lower', 'upper', *RECORD_KEYS)


def main(arguments: list[str] | None = None) -> int:
    """Exit status: 0 fitted; 1 a record cannot be fitted, the search failed, or results could not be written; 2 bad usage or
    input."""
    parser = argparse.ArgumentParser(prog='stickslip-fit', description='Finds friction constants from measured records.')
    parser.add_argument('input', type=pathlib.Path, help='namelist: an input of stickslip run with a group &fit')
    parser.add_argument('--output', type=pathlib.Path, help='directory of the results; default: STEM_fit')
    parser.add_argument('--no-plot', action='store_true', help='draw no picture')
    parser.add_argument('--resume', action='store_true', help='continue from the checkpoint of an interrupted search')
    given = parser.parse_args(arguments)
    folder = given.output or pathlib.Path(f'{given.input.stem}_fit')
    checkpoint = folder / f'{given.input.stem}.checkpoint'
    try:
        groups = _namelist.groups_of(given.input)
        told = _checked(groups.pop('fit', None))
        if given.input.resolve() == (folder / f'{given.input.stem}.nml').resolve():
            raise InputError(f'--output {folder}: the results would overwrite the input: choose another directory')
        records = _records(told, given.input.parent)
        folder.mkdir(parents=True, exist_ok=True)
        if not given.resume:
            checkpoint.unlink(missing_ok=True)
    except (OSError, ValueError) as error:
        return _fail(given.input, error, 2)
    try:
        found = fit(records, groups, free=_list(told['free']), bounds=_bounds(told), checkpoint=checkpoint,
                    **{key: told[key] for key in ('seed', 'starts', 'jobs', 'most_evaluations', 'most_seconds')})
    except InputError as error:
        return _fail(given.input, error, 2)
    except (OSError, ValueError, TypeError, RuntimeError) as error:
        return _fail(given.input, error, 1)
    except KeyboardInterrupt:
        print('stickslip-fit: interrupted; --resume continues from here', file=sys.stderr)
        return 1
    try:
        _write(found, records, folder, given.input.stem, not given.no_plot)
        checkpoint.unlink(missing_ok=True)
        print(f'{found}\nresults in {folder}', flush=True)
    except (OSError, ImportError) as error:
        return _fail(given.input, error, 1)
    return 0


def _fail(path: pathlib.Path, error: Exception, status: int) -> int:
    for line in str(error).splitlines():
        print(f'stickslip-fit: {line if line.startswith(f"{path}:") else f"{path}: {line}"}', file=sys.stderr)
    return status


def _write(found: Fit, records: list[Record], folder: pathlib.Path, stem: str, with_picture: bool) -> None:
    """The results as files: the picture last, which may want what is not installed."""
    names = [record.name for record in records]
    for k, name in enumerate(names):
        own = name if names.count(name) == 1 else f'{name}_{k + 1}'
        found.write_namelist(folder / (f'{stem}.nml' if k == 0 else f'{stem}_{own}.nml'), k)
    (folder / f'{stem}.txt').write_text(f'{found}\n', encoding='utf-8')
    if with_picture:
        found.plot(folder / f'{stem}.png')


def _checked(told: dict | None) -> dict:
    """The group with its defaults; InputError with all that it must or cannot have."""
    if told is None:
        raise InputError('group &fit is missing')
    known = {**FIT_KEYS, **RECORD_KEYS}
    faults = [f'&fit {key}: unknown key; there are {", ".join(known)}' for key in told if key not in known]
    faults += [f'&fit {key} is missing' for key in ('records', 'free') if key not in told]
    faults += [fault for key, value in told.items() if key in known and (fault := _fault(key, value))]
    if ('lower' in told) != ('upper' in told):
        faults.append('&fit: give both lower and upper')
    elif 'lower' in told and not len(_list(told.get('free'))) == len(_list(told['lower'])) == len(_list(told['upper'])):
        faults.append(f'&fit: {len(_list(told.get("free")))} free constants, {len(_list(told["lower"]))} lower and '
                      f'{len(_list(told["upper"]))} upper bounds')
    records = len(_list(told.get('records')))
    faults += [f'&fit {key}: {len(_list(told[key]))} values for {records} records' for key in RECORD_KEYS
               if key in told and len(_list(told[key])) not in (1, records)]
    if faults:
        raise InputError('\n'.join(faults))
    return {**known, **told}


def _fault(key: str, value: Any) -> str:
    """What is wrong with the values of a key, whatever the others are; or ''."""
    shown = ', '.join(map(repr, _list(value)))
    if key not in LISTS and len(_list(value)) > 1:
        return f'&fit {key} = {shown}: one value is needed'
    for item in _list(value):
        number = isinstance(item, (int, float)) and not isinstance(item, bool) and math.isfinite(item)
        if item is None:
            return f'&fit {key}: has no value'
        if key in TEXTS and not isinstance(item, str):
            return f'&fit {key} = {shown}: must be text in quotes'
        if key in WHOLE and not (number and isinstance(item, int) and item >= (0 if key == 'seed' else 1)):
            return f'&fit {key} = {shown}: must be a whole number >= {0 if key == "seed" else 1}'
        if key not in TEXTS and not number:
            return f'&fit {key} = {shown}: must be a finite number'
    if key == 'most_seconds' and value <= 0:
        return f'&fit {key} = {shown}: must be > 0'
    return ''


def _list(value: Any) -> list:
    return list(value) if isinstance(value, (list, tuple)) else [value]


def _records(told: dict, folder: pathlib.Path) -> list[Record]:
    paths = _list(told['records'])
    records = []
    for k, path in enumerate(paths):
        own = {key: values[k] if len(values := _list(told[key])) > 1 else values[0] for key in RECORD_KEYS}
        settings: dict = {}
        for key, group in MODEL_KEYS.items():
            if own[key] is not None:
                settings.setdefault(group, {})[key] = own[key]
        records.append(Record.read(folder / path, time=own['time_column'], force=own['force_column'],
                                   time_factor=own['time_factor'], force_factor=own['force_factor'],
                                   force_offset=own['force_offset'], start=own['start'], end=own['end'], settings=settings))
    return records


def _bounds(told: dict) -> float | dict[str, tuple[float, float]]:
    if told['lower'] is None:
        return float(told['factor'])
    return dict(zip(_list(told['free']), zip(_list(told['lower']), _list(told['upper']))))


if __name__ == '__main__':
    sys.exit(main())
