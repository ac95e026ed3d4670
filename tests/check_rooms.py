#!/usr/bin/env python3
"""The program's rooms: no module uses one of a later room.

    tests/check_rooms.py [DRIVER]

The order is system <- model <- {input, stepping} <- events <- output <- {verbs, fault}; input and stepping
do not know each other. Exit status 1 with a line for each arrow that runs back.
"""
import pathlib
import re
import sys

FLOORS = {'system': 0, 'model': 1, 'input': 2, 'stepping': 2, 'events': 3, 'output': 4, 'fault': 5, 'verbs': 6,
          '.': 7}
MODULE = re.compile(r'^\s*(?:module|program)\s+(?!procedure\b)(\w+)\s*$', re.IGNORECASE | re.MULTILINE)
USE = re.compile(r'^\s*use\s*(?:,\s*non_intrinsic\s*::)?\s*(\w+)', re.IGNORECASE | re.MULTILINE)


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


def main():
    here = pathlib.Path(__file__).resolve().parent.parent
    driver = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else here / 'driver'
    faults = arrows(driver)
    print('\n'.join(faults) if faults else 'rooms: no arrow runs back')
    sys.exit(bool(faults))


if __name__ == '__main__':
    main()
