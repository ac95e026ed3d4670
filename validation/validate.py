"""Compares the library and the program with independent solutions; writes docs/validation.md and its pictures.

usage: python validate.py BUILD DOCS

BUILD is where the project is built, DOCS where the page goes. Exit status 1 if a row does not hold.
"""
import pathlib
import sys

import matplotlib

matplotlib.use('Agg')

import block_on_slope  # noqa: E402
import closed_forms  # noqa: E402
import fault  # noqa: E402
import flash_heating  # noqa: E402
import linker_dieterich  # noqa: E402
import options  # noqa: E402
import orders  # noqa: E402
import rate_and_state  # noqa: E402
import stability  # noqa: E402
from library import Library  # noqa: E402
from program import Program  # noqa: E402
from report import Report  # noqa: E402

INTRODUCTION = """
Made by `./dev validate`, which runs the library and the program and compares them with closed forms and with solutions that
it computes itself by other methods. Nothing on this page is written by hand. Errors are relative unless marked as absolute;
"allowed" is the bound that decides.
"""


def main():
    build, docs = (pathlib.Path(name).resolve() for name in sys.argv[1:3])
    library = Library(next((build / 'src').glob('libstickslip.[sd][oy]*')))
    program = Program(build / 'driver/stickslip')
    report = Report(docs)
    closed_forms.validate(library, report)
    rate_and_state.validate(program, report)
    flash_heating.validate(library, program, report)
    linker_dieterich.validate(library, program, report)
    options.validate(library, program, report)
    stability.validate(program, report)
    orders.validate(program, report)
    fault.validate(program, report)
    block_on_slope.validate(build, report)
    sys.exit(not report.write(INTRODUCTION))


if __name__ == '__main__':
    main()
