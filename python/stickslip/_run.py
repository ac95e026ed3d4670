"""The program `stickslip run` as a function (docs/python.md)."""
from __future__ import annotations

import dataclasses
import pathlib
import warnings as python_warnings
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _namelist, _program
from ._namelist import InputError
from ._optional import needed

if TYPE_CHECKING:
    import matplotlib.figure
    import pandas


class RunError(RuntimeError):
    """A run that failed before its end; `run` has the results up to there."""

    def __init__(self, why: str, run: Run) -> None:
        super().__init__(why, run)
        self.run = run

    def __str__(self) -> str:
        return self.args[0]


@dataclasses.dataclass(frozen=True, eq=False)
class Run:
    """Results of a run: the columns of the program's files (docs/driver.md)."""

    table: pandas.DataFrame            #: time series; row 0 is the initial state
    events: pandas.DataFrame           #: one row a slip event; of a chain those of its mean force, which `summary` counts
    catalogue: pandas.DataFrame        #: of a chain: one row an event of its blocks (docs/chains.md); without rows for one block
    pieces: pandas.DataFrame           #: one row a piece of the programme: what is read off velocity steps and holds
    summary: dict[str, float]          #: counts, means, energies; NaN for means of nothing
    warnings: list[str]

    def plot(self, path: str | pathlib.Path | None = None) -> matplotlib.figure.Figure:
        """Draws the spring force, its slip events and the friction coefficient against time.

        path: where to save the picture, PNG, PDF or SVG by its ending.
        """
        figure = needed('matplotlib.figure', 'run').Figure(figsize=(8, 5), layout='constrained')
        force, coefficient = figure.subplots(2, 1, sharex=True)
        table = self.table.iloc[::max(1, len(self.table) // 100_000)]
        force.plot(table['time'], table['spring_force'], lw=1, label='spring')
        force.plot(table['time'], table['friction_force'], lw=0.6, label='friction')
        onset = self.events['onset']
        force.plot(onset, np.interp(onset, self.table['time'], self.table['spring_force']), 'v', ms=5, color='0.2',
                   label='onset of a slip event')
        force.set_ylabel('force [F]')
        force.legend(loc='lower right', fontsize='small')
        coefficient.plot(table['time'], table['mu'], lw=1)
        coefficient.set_ylabel('friction coefficient [-]')
        coefficient.set_xlabel('time [T]')
        if path is not None:
            figure.savefig(path)
        return figure


def run(input: str | pathlib.Path | Mapping[str, Any]) -> Run:
    """Runs the program's slider in this process, without files.

    input: a namelist (the name of its file, or its text), or a dict of groups, each a dict of keys; the group
        ``friction`` may be a law: ``{'friction': law, 'slider': {...}, 'drive': {...}, 'time': {...}}``. Keys, units
        and defaults: docs/driver.md.

    Raises InputError with all errors of the input, RunError if the run fails. Warnings of the program are in `warnings`
    and are also issued as Python warnings. Several runs may run at once, each in its thread.
    """
    pandas = needed('pandas', 'run')
    text, name = _namelist.named_text(input)
    output = _program.simulate(text, name, lambda _part: None)
    if output.status == _program.BAD_INPUT:
        raise InputError(output.reports['faults'].rstrip())
    frames = {key: pandas.DataFrame(table.values, columns=table.names) for key, table in output.tables.items()}
    told = output.reports['warnings'].splitlines()
    catalogue = frames['catalogue'].astype(dict.fromkeys(('first_block', 'blocks', 'ended'), int))
    result = Run(frames['series'], frames['events'], catalogue, frames['pieces'],
                 {key: float(value[0]) for key, value in frames['summary'].items()}, told)
    for warning in told:
        python_warnings.warn(warning, stacklevel=2)
    if output.status == _program.FAILED:
        raise RunError(f'{name}: the run failed {output.reports["failure"]}', result)
    return result


def check_runs(settings: dict[str, dict[str, Any]]) -> None:
    """Raises InputError with the faults of groups of keys, or ValueError where their run fails."""
    output = _program.simulate(_namelist.written(settings))
    if output.status == _program.BAD_INPUT:
        raise InputError(output.reports['faults'].rstrip())
    if output.status == _program.FAILED:
        raise ValueError(f'the run fails {output.reports["failure"]}')


def spring_force(settings: dict[str, dict[str, Any]]) -> tuple[np.ndarray, np.ndarray] | None:
    """Time and spring force of a run on groups of keys; None where it fails, or where its constants are not valid
    together, as candidates of a search may be."""
    found = series(settings, 'time', 'spring_force')
    return None if found is None else (found[0], found[1])


def series(settings: dict[str, dict[str, Any]], *columns: str) -> tuple[np.ndarray, ...] | None:
    """Columns of the time series of a run on groups of keys; None as for `spring_force`."""
    output = _program.simulate(_namelist.written(settings))
    if output.status != _program.DONE:
        return None
    table = output.tables['series']
    return tuple(table.values[:, table.names.index(column)] for column in columns)
