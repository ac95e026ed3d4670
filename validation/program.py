"""The program `stickslip`: an input in, its table out."""
import pathlib
import subprocess
import tempfile

import numpy


class Program:
    def __init__(self, path):
        self.path = path

    def run(self, **groups):
        """Runs an input given as {group: {key: value}}; the columns of its table and of its events."""
        return self.tables('run', groups, 'case', 'case_events')

    def stability(self, **groups):
        """Steady sliding of such an input: the columns of its first row, numbers where they are."""
        first, = self.tables('stability', groups, 'case_stability', columns=first_row)
        return first

    def boundary(self, **groups):
        """Where steady sliding of such an input changes its stability over the keys of its sweep."""
        found, = self.tables('stability', groups, 'case_stability_boundary')
        return found

    def tables(self, verb, groups, *names, columns=None):
        text = ''.join(f'&{group}\n' + ''.join(f'  {key} = {spelt(value)}\n' for key, value in keys.items()) + '/\n'
                       for group, keys in groups.items() if keys)
        with tempfile.TemporaryDirectory() as folder:
            pathlib.Path(folder, 'case.nml').write_text(text, encoding='utf-8')
            result = subprocess.run([self.path, verb, 'case.nml', '--no-plot', '--quiet'], cwd=folder, text=True,
                                    capture_output=True, check=False)
            if result.returncode:
                raise RuntimeError(f'{result.stderr}\n{text}')
            return [(columns or table)(f'{folder}/case_out/{name}.csv') for name in names]


def spelt(value):
    """A value as namelists spell it."""
    if isinstance(value, str):
        return f"'{value}'"
    if isinstance(value, (list, tuple)):
        return ', '.join(map(spelt, value))
    return repr(value) if isinstance(value, int) else repr(float(value))


def first_row(name):
    with open(name, encoding='utf-8') as file:
        names, row, *_ = (line.strip().split(',') for line in file)
    words = ('stability', 'reason')
    return {key: value if key in words else float(value) for key, value in zip(names, row)}


def table(name):
    with open(name, encoding='utf-8') as file:
        names, *rows = (line.strip().split(',') for line in file)
    return dict(zip(names, numpy.array(rows, dtype=float).reshape(-1, len(names)).T))
