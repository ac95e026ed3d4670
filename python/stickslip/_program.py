"""The program's slider in this process: include/stickslip_program.h by ctypes."""
from __future__ import annotations

import ctypes
import json
import threading
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from ._library import load

_library = load('stickslip_program')
_watch_type = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_double, ctypes.c_void_p)
_run = _library.stickslip_run
_run.argtypes = [ctypes.c_char_p, ctypes.c_char_p, _watch_type, ctypes.c_void_p, ctypes.POINTER(ctypes.c_void_p)]
_stability = _library.stickslip_stability
_stability.argtypes = [ctypes.c_char_p, ctypes.c_char_p, ctypes.POINTER(ctypes.c_void_p)]
_groups = _library.stickslip_groups
_groups.argtypes = [ctypes.c_char_p, ctypes.c_char_p, ctypes.c_int64, ctypes.POINTER(ctypes.c_void_p)]
_columns = _library.stickslip_columns
_columns.argtypes = [ctypes.c_char_p, ctypes.c_int64, ctypes.c_int, ctypes.c_void_p, ctypes.POINTER(ctypes.c_void_p)]
_table = _library.stickslip_table
_table.restype = ctypes.c_void_p
_table.argtypes = [ctypes.c_void_p, ctypes.c_char_p, ctypes.POINTER(ctypes.c_int64), ctypes.POINTER(ctypes.c_int),
                   ctypes.POINTER(ctypes.c_char_p)]
_report = _library.stickslip_report
_report.restype = ctypes.c_char_p
_report.argtypes = [ctypes.c_void_p, ctypes.c_char_p]
_free = _library.stickslip_free
_free.argtypes = [ctypes.c_void_p]

DONE, FAILED, BAD_INPUT = 0, 1, 2


class Table(NamedTuple):
    """Numbers, a row a line, with the names of the columns."""

    names: list[str]
    values: np.ndarray   #: (rows, columns)


class Output(NamedTuple):
    """What a run leaves."""

    status: int                #: DONE, FAILED or BAD_INPUT
    tables: dict[str, Table]   #: by name; none after BAD_INPUT
    reports: dict[str, str]    #: 'faults', 'failure', 'warnings'; empty texts where there is none


TABLES = ('series', 'events', 'catalogue', 'pieces', 'summary')
REPORTS = ('faults', 'failure', 'warnings')


def simulate(text: str, name: str = 'input', watch: Callable[[float], object] | None = None) -> Output:
    """Runs the slider on the text of a namelist. `watch` is told now and then which part of the run is done; what it
    raises ends the run, and is raised here, as is KeyboardInterrupt where there is a `watch`. Gives the interpreter's lock away."""
    raised: list[BaseException] = []

    def told(part: float, _context: int | None) -> int:
        try:
            if watch is not None:
                watch(part)
        except BaseException as error:   # it has to pass through the library's frames
            raised.append(error)
        return 1 if raised else 0

    def go() -> Output:
        result = ctypes.c_void_p()
        status = _run(name.encode(errors='replace'), text.encode(), _watch_type(told), None, ctypes.byref(result))
        try:
            tables = {} if status == BAD_INPUT or raised else {table: _read(result, table) for table in TABLES}
            return Output(status, tables, {report: _report(result, report.encode()).decode() for report in REPORTS})
        finally:
            _free(result)

    if watch is None or threading.current_thread() is not threading.main_thread():
        found = [go()]
    else:
        found = _interruptible(go, raised)
    if raised:
        raise raised[0]
    return found[0]


def _interruptible(go: Callable[[], Output], raised: list[BaseException]) -> list[Output]:
    """What a run gives that goes on in a thread of its own, which ends it once something has been raised. The interpreter raises
    KeyboardInterrupt in the main thread, and if that is in a run, as soon as a function is called from there, before the
    function could do anything about it."""
    found: list[Output] = []
    over = threading.Event()   # join() of an interrupted thread may take it for over (Python 3.11)

    def go_on() -> None:
        try:
            found.append(go())
        except BaseException as error:
            raised.append(error)
        finally:
            over.set()

    thread, started = threading.Thread(target=go_on), False
    while True:
        try:
            if not started:
                if raised:   # while it was being started: whether it is or not, it ends by itself
                    return found
                thread.start()
                started = True
            over.wait()
            return found
        except BaseException as error:
            raised.append(error)


def steady_sliding(text: str, name: str = 'input') -> Output:
    """Stability of steady sliding on the text of a namelist: the tables 'stability' and 'eigenvalues', the reports 'faults' and
    'reasons'."""
    result = ctypes.c_void_p()
    status = _stability(name.encode(errors='replace'), text.encode(), ctypes.byref(result))
    try:
        tables = {} if status == BAD_INPUT else {table: _read(result, table) for table in ('stability', 'eigenvalues')}
        return Output(status, tables, {report: _report(result, report.encode()).decode() for report in ('faults', 'reasons')})
    finally:
        _free(result)


class Namelists(NamedTuple):
    """What an input says."""

    groups: dict[str, dict[str, Any]]   #: of keys; empty where there are faults
    text: str
    faults: str                         #: one a line, with the input's name


def namelists(content: bytes, name: str = 'input') -> Namelists:
    """Takes an input apart as the program does, whatever wrote it."""
    result = ctypes.c_void_p()
    status = _groups(name.encode(errors='replace'), content, len(content), ctypes.byref(result))
    try:
        groups, text, faults = (_report(result, report).decode(errors='replace') for report in (b'groups', b'text', b'faults'))
        return Namelists(json.loads(groups) if status == DONE else {}, text, faults)
    finally:
        _free(result)


def columns(content: bytes, names: Sequence[str]) -> tuple[np.ndarray, str]:
    """Columns of a table, as the program reads measured files, one after the other; and what is wrong with it, a line each."""
    for name in names:
        if '\0' in name:   # C's texts end there
            return np.empty((0, 0)), f'column {name!r}: holds a character 0, which no name does'
    result = ctypes.c_void_p()
    wanted = (ctypes.c_char_p * len(names))(*[name.encode() for name in names])
    _columns(content, len(content), len(names), wanted, ctypes.byref(result))
    try:
        return _read(result, 'columns').values.T, _report(result, b'faults').decode(errors='replace')
    finally:
        _free(result)


def _read(result: ctypes.c_void_p, table: str) -> Table:
    """A copy of a table: the result's own memory is given back."""
    rows, columns, names = ctypes.c_int64(), ctypes.c_int(), ctypes.c_char_p()
    address = _table(result, table.encode(), ctypes.byref(rows), ctypes.byref(columns), ctypes.byref(names))
    shape = (rows.value, columns.value)
    titles = (names.value or b'').decode().split(',')
    if shape[0] == 0:
        return Table(titles, np.empty(shape))
    numbers = (ctypes.c_double * (shape[0] * shape[1])).from_address(address)
    return Table(titles, np.array(numbers).reshape(shape))
