"""Fields that the program has written: HDF5, by h5dump, or the plain numbers of a build without HDF5."""
import array
import pathlib
import shutil
import subprocess
import tempfile
import unittest


def read_fields(base, names, cells):
    """Times of BASE_fields*, and each field as a list of numbers of its cells for each of them.

    base: path without `_fields.h5`; names: of the fields; cells: how many there are."""
    parts = sorted(base.parent.glob(f'{base.name}_fields_*.bin'))
    fields = {name: array.array('d') for name in ('time', *names)}
    for part in parts:
        numbers = array.array('d', part.read_bytes())
        records, rest = divmod(len(numbers), 1 + len(names) * cells)
        if rest:
            raise ValueError(f'{part} has no whole records')
        fields['time'] += numbers[:records]
        for k, name in enumerate(names):
            first = records * (1 + k * cells)
            fields[name] += numbers[first:first + records * cells]
    if not parts:
        for name in fields:
            fields[name] = read_data_set(f'{base}_fields.h5', name)
    return list(fields['time']), {name: [list(fields[name][i:i + cells]) for i in range(0, len(fields[name]), cells)]
                                  for name in names}


def read_data_set(path, name):
    """All numbers of a data set of doubles in an HDF5 file."""
    if shutil.which('h5dump') is None:
        raise unittest.SkipTest('no h5dump (Debian: hdf5-tools)')
    with tempfile.TemporaryDirectory() as place:
        numbers = pathlib.Path(place) / 'numbers'
        subprocess.run(['h5dump', '-d', name, '-b', 'NATIVE', '-o', numbers, path], check=True, stdout=subprocess.DEVNULL)
        return array.array('d', numbers.read_bytes())
