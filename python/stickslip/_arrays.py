"""Arrays of whatever kind as 64-bit floats."""
from __future__ import annotations

from typing import Any

import numpy as np


def numbers(values: Any, what: str) -> np.ndarray:
    """An array of 64-bit floats; what is masked is NaN. TypeError where there are no numbers, or complex ones, or dates; text that
    is a number counts as one."""
    if isinstance(values, np.ma.MaskedArray):
        values = np.ma.filled(values.astype(values.dtype if values.dtype.kind == 'c' else float), np.nan)
    try:
        array = np.asarray(values)
        if array.dtype.kind == 'O' and any(isinstance(item, (list, tuple, np.ndarray)) for item in array.flat):
            raise ValueError('some are lists')   # as numpy says from 1.24 on
    except ValueError as error:   # of lists whose lengths differ
        raise ValueError(f'{what}: numbers in rows of one length are needed ({error})') from None
    if array.dtype.kind == 'c':
        raise TypeError(f'{what}: numbers are needed, not complex ones')
    if array.dtype.kind in 'mM':
        raise TypeError(f'{what}: numbers are needed, not dates: (t - t[0]) / numpy.timedelta64(1, "s") are seconds')
    try:
        return array.astype(np.float64, copy=False)
    except (TypeError, ValueError) as error:
        raise TypeError(f'{what}: numbers are needed ({error})') from None
    except OverflowError:
        raise ValueError(f'{what}: has a number that is larger than the largest 64-bit float') from None


def number(value: Any, what: str) -> float:
    """A single number; TypeError where it is none, or text."""
    if isinstance(value, (str, bytes)):
        raise TypeError(f'{what} = {value!r}: a number is needed')
    try:
        return float(value)
    except (TypeError, ValueError):
        raise TypeError(f'{what} = {value!r}: a number is needed') from None
    except OverflowError:
        raise ValueError(f'{what}: must be finite, and is larger than the largest 64-bit float') from None


def row_of(values: Any, what: str) -> np.ndarray:
    """The same in one dimension; ValueError where there are more than one. MATLAB and pandas have rows and columns of two."""
    array = numbers(values, what)
    if max(array.shape, default=1) != array.size:
        raise ValueError(f'{what} has the shape {array.shape}: one number per sample is needed')
    return array.ravel()
