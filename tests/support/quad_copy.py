#!/usr/bin/env python3
"""Copies the library's sources in quadruple precision: quad_friction_mod is friction_mod to 30 digits.

Usage: quad_copy.py OUTPUT_DIRECTORY SOURCE...

What the copy computes is the reference for round-off and for derivatives of every law, present and future.
"""
import pathlib
import re
import sys

OVERSIZE = """    pure function oversize(x) result(bits)
        real(wp), intent(in) :: x
        integer(int64) :: bits

        bits = 0
        if (.not. abs(x) < 2.0_wp**333) bits = ibset(bits, 62)
    end function oversize"""


def in_quadruple_precision(text: str) -> str:
    text = re.sub(r'\b((?:sub)?module|use|submodule\(friction_mod\)) friction_', r'\1 quad_friction_', text)
    text = text.replace('submodule(friction_mod)', 'submodule(quad_friction_mod)')
    text = text.replace('real64', 'real128')
    # The exponent stands elsewhere in a longer number.
    text = re.sub(r' *pure function oversize\(.*?end function oversize', OVERSIZE, text, flags=re.DOTALL)
    # Iterations stop before a step of which the square or the cube is round-off.
    text = re.sub(r'\bsmall_step = 1\.0e-5_wp', 'small_step = 1.0e-11_wp', text)
    return re.sub(r'\bsmall_newton_step = 1\.0e-8_wp', 'small_newton_step = 1.0e-17_wp', text)


def main() -> None:
    output = pathlib.Path(sys.argv[1])
    output.mkdir(parents=True, exist_ok=True)
    for source in map(pathlib.Path, sys.argv[2:]):
        (output / f'quad_{source.name}').write_text(in_quadruple_precision(source.read_text()))


if __name__ == '__main__':
    main()
