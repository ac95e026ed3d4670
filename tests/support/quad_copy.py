#!/usr/bin/env python3
"""Copies the library's sources for tests, with other names of modules.

Usage: quad_copy.py quad|counted OUTPUT_DIRECTORY SOURCE...

quad_friction_mod is friction_mod to 30 digits: the reference for round-off and for derivatives of every law, present
and future. counted_friction_mod counts how often the search asks a law (`evaluations` of counted_friction_kinds).
"""
import pathlib
import re
import sys

# What looks at the bits of numbers, which stand elsewhere in longer ones.
BY_VALUE = {
    'same': """    pure function same(x, y)
        real(wp), intent(in) :: x, y
        logical :: same

        same = .not. (x < y .or. x > y)
    end function same""",
    'excess': """    pure function excess(x) result(difference)
        real(wp), intent(in) :: x
        integer(int64) :: difference

        difference = 0
        if (abs(x) < 2.0_wp**333) difference = -1
    end function excess"""}


def renamed(text: str, prefix: str) -> str:
    text = re.sub(r'\b((?:sub)?module|use|submodule\(\w+\)) friction_', rf'\1 {prefix}_friction_', text)
    return text.replace('submodule(friction_', f'submodule({prefix}_friction_')


def with_a_counter(text: str) -> str:
    text = renamed(text, 'counted')
    if 'use counted_friction_' not in text:
        return text.replace('    integer, parameter, public :: wp', '    integer, public :: evaluations = 0\n    integer, parameter, public :: wp')
    text = re.sub(r'\bpure ', '', text)
    text = text.replace('use counted_friction_kinds, only : ', 'use counted_friction_kinds, only : evaluations, ')
    count = r'\1evaluations = evaluations + 1\n\1\2'
    text = re.sub(r'( +)(call (?:(?:surface|self)%slide|slide)\()', count, text)
    if 'pair (s, ' in text:   # laws whose own method does not call `slide`
        text = re.sub(r'(        do iteration = 1, max_iterations\n)', r'\1            evaluations = evaluations + 1\n', text)
    return text


def in_quadruple_precision(text: str) -> str:
    text = renamed(text, 'quad').replace('real64', 'real128')
    for name, function in BY_VALUE.items():
        text = re.sub(rf' *pure function {name}\(.*?end function {name}\b', function, text, flags=re.DOTALL)
    # Iterations stop before a step of which the square or the cube is round-off.
    text = re.sub(r'\bsmall_step = 1\.0e-5_wp', 'small_step = 1.0e-11_wp', text)
    return re.sub(r'\bsmall_newton_step = 1\.0e-8_wp', 'small_newton_step = 1.0e-17_wp', text)


def main() -> None:
    kind, output = sys.argv[1], pathlib.Path(sys.argv[2])
    copy = {'quad': in_quadruple_precision, 'counted': with_a_counter}[kind]
    output.mkdir(parents=True, exist_ok=True)
    for source in map(pathlib.Path, sys.argv[3:]):
        (output / f'{kind}_{source.name}').write_text(copy(source.read_text()))


if __name__ == '__main__':
    main()
