"""The library of include/friction.h, loaded by ctypes: prototypes, and nothing else."""
from __future__ import annotations

import ctypes
import pathlib
import sys

FOLDER = pathlib.Path(__file__).resolve().parent / 'lib'

_int, _int64, _double, _pointer = ctypes.c_int, ctypes.c_int64, ctypes.c_double, ctypes.c_void_p
_arrays = [_int, _pointer, _double, _int, _pointer, _int, _pointer, _pointer, _pointer]


def load(name: str) -> ctypes.CDLL:
    """A shared library of this package."""
    ending = 'dylib' if sys.platform == 'darwin' else 'so'
    path = FOLDER / f'lib{name}.{ending}'
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
library.friction_message.restype = ctypes.c_char_p
library.friction_version.restype = ctypes.c_char_p

version: str = library.friction_version().decode()


def message(status: int) -> str:
    """What a status of the friction routine says, in one line (docs/user_guide.md, Codes)."""
    return library.friction_message(int(status)).decode()
