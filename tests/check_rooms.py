#!/usr/bin/env python3
"""The program's rooms: no module uses one of a later room, and no procedure is longer than a screen.

    tests/check_rooms.py [DRIVER]

The order is system <- model <- {input, stepping} <- events <- output <- {verbs, fault}; input and stepping
do not know each other. Exit status 1 with a line for each arrow that runs back.
"""
import pathlib
import re
import sys

FLOORS = {'system': 0, 'model': 1, 'input': 2, 'stepping': 2, 'events': 3, 'output': 4, 'fault': 5, 'verbs': 6,
          '.': 7}
LONGEST = 60   # lines of a procedure, without the procedures inside it
MODULE = re.compile(r'^\s*(?:module|program)\s+(?!procedure\b)(\w+)\s*$', re.IGNORECASE | re.MULTILINE)
USE = re.compile(r'^\s*use\s*(?:,\s*non_intrinsic\s*::)?\s*(\w+)', re.IGNORECASE | re.MULTILINE)
PREFIX = r'(?:(?:pure|elemental|impure|recursive|module|integer|real|logical|character|type)(?:\s*\([^)]*\))?\s+)*'
PROCEDURE = re.compile(r'^\s*(end\s+)?' + PREFIX + r'(subroutine|function)\s+(\w+)')


def arrows(driver):
    """The faults of the `use` lines below a folder whose own folders are the rooms."""
    room, uses, faults = {}, {}, []
    for path in sorted(driver.rglob('*.f90')):
        text = path.read_text()
        for name in MODULE.findall(text):
            room[name] = path.parent.relative_to(driver).parts[:1] or ('.',)
            uses[name] = USE.findall(text)
    for name, (here,) in room.items():
        if here not in FLOORS:
            faults.append(f'{here}/ is no room of the order in {pathlib.Path(__file__).name}')
            continue
        for used in uses[name]:
            there = room.get(used, (here,))[0]
            if there != here and FLOORS.get(there, 0) >= FLOORS[here]:
                faults.append(f'{here}/{name} uses {there}/{used}: that arrow runs back')
    return faults


def long_procedures(driver):
    """Procedures of more lines than a screen has, those inside them not counted."""
    faults = []
    for path in sorted(driver.rglob('*.f90')):
        stack = []
        interface = False
        for line in path.read_text().splitlines():
            if re.match(r'^\s*(abstract\s+)?interface\b', line):
                interface = True
            if re.match(r'^\s*end\s+interface\b', line):
                interface = False
            found = PROCEDURE.match(line)
            if stack:
                stack[-1][1] += 1
            if not found or interface:
                continue
            if found.group(1):
                name, lines = stack.pop()
                if lines > LONGEST:
                    faults.append(f'{path.relative_to(driver)}: {name} has {lines} lines, more than {LONGEST}')
            else:
                if stack:
                    stack[-1][1] -= 1   # its first line belongs to the procedure inside
                stack.append([found.group(3), 1])
    return faults


def main():
    here = pathlib.Path(__file__).resolve().parent.parent
    driver = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else here / 'driver'
    faults = arrows(driver) + long_procedures(driver)
    print('\n'.join(faults) if faults else 'rooms: no arrow runs back, no procedure is too long')
    sys.exit(bool(faults))


if __name__ == '__main__':
    main()
