"""stickslip-fit INPUT.nml: `fit` from a namelist with a group &fit (docs/fitting.md)."""
from __future__ import annotations

import argparse
import pathlib
import sys

from . import _namelist
from ._fit import fit
from ._records import Record
from ._run import InputError

#: Keys of &fit: what they are, and their defaults. Lists give one value a record.
RECORD_KEYS = {'time_column': 'time', 'force_column': 'spring_force', 'time_factor': 1.0, 'force_factor': 1.0,
               'force_offset': 0.0, 'start': None, 'end': None, 'velocity': None, 'stiffness': None, 'normal_traction': None}
FIT_KEYS = {'records': None, 'free': None, 'lower': None, 'upper': None, 'factor': 5.0, 'seed': 1, 'starts': 128, 'jobs': 1,
            'most_evaluations': None, 'most_seconds': None}
MODEL_KEYS = {'velocity': 'drive', 'stiffness': 'slider', 'normal_traction': 'slider'}


def main(arguments: list[str] | None = None) -> int:
    """Exit status: 0 fitted; 1 a record cannot be fitted, or the search failed; 2 bad usage or input."""
    parser = argparse.ArgumentParser(prog='stickslip-fit', description='Finds friction constants from measured records.')
    parser.add_argument('input', type=pathlib.Path, help='namelist: an input of stickslip run with a group &fit')
    parser.add_argument('--output', type=pathlib.Path, help='directory of the results; default: STEM_fit')
    parser.add_argument('--no-plot', action='store_true', help='draw no picture')
    parser.add_argument('--resume', action='store_true', help='go on from the checkpoint of an interrupted search')
    given = parser.parse_args(arguments)
    folder = given.output or pathlib.Path(f'{given.input.stem}_fit')
    checkpoint = folder / f'{given.input.stem}.checkpoint'
    try:
        groups = _namelist.groups_of(given.input)
        told = _checked(groups.pop('fit', None))
        records = _records(told, given.input.parent)
        folder.mkdir(parents=True, exist_ok=True)
        if not given.resume:
            checkpoint.unlink(missing_ok=True)
    except (OSError, ValueError, InputError) as error:
        print(f'stickslip-fit: {given.input}: {error}', file=sys.stderr)
        return 2
    try:
        found = fit(records, groups, free=_list(told['free']), bounds=_bounds(told), checkpoint=checkpoint,
                    **{key: told[key] for key in ('seed', 'starts', 'jobs', 'most_evaluations', 'most_seconds')})
    except (ValueError, TypeError, RuntimeError) as error:
        print(f'stickslip-fit: {given.input}: {error}', file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print('stickslip-fit: interrupted; --resume goes on from here', file=sys.stderr)
        return 1
    print(found)
    for k, record in enumerate(records):
        found.write_namelist(folder / (f'{given.input.stem}.nml' if k == 0 else f'{given.input.stem}_{record.name}.nml'), k)
    (folder / f'{given.input.stem}.txt').write_text(f'{found}\n')
    if not given.no_plot:
        found.plot(folder / f'{given.input.stem}.png')
    checkpoint.unlink(missing_ok=True)
    print(f'results in {folder}')
    return 0


def _checked(told: dict | None) -> dict:
    """The group with its defaults; ValueError for what it must or cannot have."""
    if told is None:
        raise ValueError('group &fit is missing')
    known = {**FIT_KEYS, **RECORD_KEYS}
    faults = [f'&fit {key}: unknown key; there are {", ".join(known)}' for key in told if key not in known]
    faults += [f'&fit {key} is missing' for key in ('records', 'free') if key not in told]
    if ('lower' in told) != ('upper' in told):
        faults.append('&fit: lower and upper go together')
    if faults:
        raise ValueError('; '.join(faults))
    return {**known, **told}


def _list(value) -> list:
    return list(value) if isinstance(value, (list, tuple)) else [value]


def _records(told: dict, folder: pathlib.Path) -> list[Record]:
    paths = _list(told['records'])
    columns = {}
    for key, default in RECORD_KEYS.items():
        values = _list(told[key])
        if len(values) == 1:
            values *= len(paths)
        if len(values) != len(paths):
            raise ValueError(f'&fit {key}: {len(values)} values for {len(paths)} records')
        columns[key] = [default if value is None else value for value in values]
    records = []
    for k, path in enumerate(paths):
        own = {key: columns[key][k] for key in RECORD_KEYS}
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
    free, lower, upper = _list(told['free']), _list(told['lower']), _list(told['upper'])
    if not len(free) == len(lower) == len(upper):
        raise ValueError(f'&fit: {len(free)} free constants, {len(lower)} lower and {len(upper)} upper bounds')
    return dict(zip(free, zip(lower, upper)))


if __name__ == '__main__':
    sys.exit(main())
