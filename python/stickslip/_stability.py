"""The program `stickslip stability` as a function (docs/stability.md)."""
from __future__ import annotations

import dataclasses
import pathlib
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from . import _namelist, _program
from ._optional import needed
from ._namelist import InputError

if TYPE_CHECKING:
    import numpy as np
    import pandas

VERDICTS = ('none', 'stable', 'neutral', 'unstable')


@dataclasses.dataclass(frozen=True, eq=False)
class Stability:
    """Growth of small disturbances of steady sliding."""

    table: pandas.DataFrame          #: one row a piece of the programme in which the drive moves: the columns of STEM_stability.csv
    eigenvalues: list[np.ndarray]    #: of each row, complex, the one that grows fastest first [1/T]


def stability(input: str | pathlib.Path | Mapping[str, Any]) -> Stability:
    """Finds whether steady sliding of the program's slider is stable, and at which stiffness, velocity, damping and mass this changes.

    input: as for `run`.

    Raises InputError with all errors of the input. If there is no steady sliding, `stability` of the row is 'none', its numbers are
    NaN, and `reason` says why.
    """
    pandas = needed('pandas', 'run')
    output = _program.steady_sliding(*_namelist.named_text(input))
    if output.status == _program.BAD_INPUT:
        raise InputError(output.reports['faults'].rstrip())
    found, roots = output.tables['stability'], output.tables['eigenvalues'].values
    table = pandas.DataFrame(found.values, columns=found.names)
    table['piece'] = table['piece'].astype(int)
    table['stability'] = [VERDICTS[int(verdict)] for verdict in table['stability']]
    table['reason'] = output.reports['reasons'].split('\n')[:len(table)]
    of_row = [roots[roots[:, 0] == row + 1] for row in range(len(table))]
    return Stability(table, [rows[:, 1] + 1j * rows[:, 2] for rows in of_row])
