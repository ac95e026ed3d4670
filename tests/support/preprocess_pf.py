#!/usr/bin/env python3
"""Turns a pFUnit test file (.pf) into Fortran for the in-tree stand-in of pFUnit.

Usage: preprocess_pf.py INPUT.pf OUTPUT.F90 MAIN.f90

Covers what the tests of this project use: @test before a subroutine without arguments, and @assert... on one
line, after which a failed test returns. MAIN.f90 is a program that runs the tests of the file in their order.
As pFUnit's, the output needs the preprocessor: compilers tell lines of the .pf file.
"""
import pathlib
import re
import sys

SUBROUTINE = re.compile(r'\s*subroutine\s+(\w+)', re.IGNORECASE)
DIRECTIVE = re.compile(r'(\s*)@(\w+)\s*(\(.*\))?\s*$')


def translate(source: pathlib.Path) -> tuple[list[str], list[str]]:
    """The Fortran lines of a .pf file and the names of its tests."""
    lines, tests, announced = [f'#line 1 "{source}"'], [], False
    for number, line in enumerate(source.read_text().splitlines(), start=1):
        directive = DIRECTIVE.match(line)
        if directive is None:
            start = SUBROUTINE.match(line)
            if announced and start:
                tests.append(start.group(1))
                announced = False
            lines.append(line)
        elif directive.group(2) == 'test':
            announced = True
            lines.append('')
        elif directive.group(2).startswith('assert') and directive.group(3):
            indent, name, arguments = directive.groups()
            lines.append(f'{indent}call at({number})')
            lines.append(f'{indent}call {name}{arguments}')
            lines.append(f'{indent}if (anyExceptions()) return')
            lines.append(f'#line {number + 1} "{source}"')
        else:
            sys.exit(f'{source}:{number}: the stand-in does not know @{directive.group(2)}; pFUnit itself may')
    return lines, tests


def main_program(module: str, tests: list[str]) -> list[str]:
    calls = []
    for test in tests:
        calls += [f"    call begin('{test}')", f'    call {test}()', '    call finish()']
    return ['program main', '    use funit, only : begin, finish, report', f'    use {module}', '    implicit none',
            *calls, f"    call report('{module}')", 'end program main']


def main() -> None:
    source, output, main_file = map(pathlib.Path, sys.argv[1:])
    lines, tests = translate(source)
    if not tests:
        sys.exit(f'{source}: holds no test')
    output.write_text('\n'.join(lines) + '\n')
    main_file.write_text('\n'.join(main_program(source.stem, tests)) + '\n')


if __name__ == '__main__':
    main()
