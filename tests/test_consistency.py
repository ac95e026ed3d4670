"""What is written in several places says the same: version numbers, status codes, constants of the laws.

STICKSLIP_LIBRARY: the shared library.
"""
import pathlib
import re
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / 'tests'))

import law_examples  # noqa: E402


def find(path, pattern):
    """The first match of a pattern in a file of the project."""
    found = re.search(pattern, (ROOT / path).read_text(), re.MULTILINE)
    if found is None:
        raise AssertionError(f'{path}: nothing matches {pattern}')
    return found.group(1)


class Consistency(unittest.TestCase):
    def test_all_version_numbers_agree(self):
        version = find('src/friction_mod.f90', r"friction_version = '([^']+)'")
        self.assertEqual(version, find('CMakeLists.txt', r'project\(stickslip VERSION (\S+)'))
        self.assertEqual(version, find('fpm.toml', r'^version = "([^"]+)"'))
        self.assertEqual(version, find('CITATION.cff', r'^version: (\S+)'))
        self.assertEqual(version, find('CHANGELOG.md', r'^## ([0-9.]+)'))

    def test_c_codes_mirror_the_fortran_codes_one_to_one(self):
        fortran = dict(re.findall(r'public :: friction_(\w+) = (-?\d+)',
                                  (ROOT / 'src/friction_status.f90').read_text()))
        c = {name.lower(): value for name, value in
             re.findall(r'FRICTION_(\w+) = (-?\d+)', (ROOT / 'include/friction.h').read_text())}
        self.assertGreater(len(fortran), 9)
        self.assertEqual(fortran, c)
        interface = (ROOT / 'include/friction_interface.f90').read_text()
        self.assertEqual(fortran, dict(re.findall(r'public :: friction_(\w+) = (-?\d+)', interface)))

    def test_the_fortran_interface_declares_the_functions_of_the_header(self):
        header = re.sub(r'/\*.*?\*/', '', (ROOT / 'include/friction.h').read_text(), flags=re.DOTALL)
        interface = (ROOT / 'include/friction_interface.f90').read_text()
        self.assertEqual(set(re.findall(r'(friction_\w+)\s*\(', header)),
                         set(re.findall(r"bind\(C, name='(\w+)'\)", interface)))

    def test_the_pages_have_every_law_with_its_constants_places_and_units(self):
        page, options = ((ROOT / f'docs/{name}.md').read_text() for name in ('laws', 'law_options'))
        row = re.compile(r'^\| (\d+)(, optional)? \| `(\w+)`.*\| (\S+|F T/L\^3) \| `\w+` \|$', re.MULTILINE)
        of_every_law = row.findall(options)
        laws = law_examples.laws().values()
        self.assertEqual(sorted(map(int, re.findall(r'^## (\d+) ', page, re.MULTILINE))), [law.number for law in laws])
        for law in laws:
            self.assertIn(f"\n| {law.number} | `'{law.name}'` |", page)
            section = re.search(rf'^## {law.number} .*?(?=^## )', page, re.MULTILINE | re.DOTALL).group()
            own = row.findall(section)
            told = [(int(place), optional != '', name, unit) for place, optional, name, unit in own]
            told += [(int(place) + told[-1][0], True, name, unit) for place, _, name, unit in of_every_law]
            self.assertEqual(told, [(place, bool(facts.optional), facts.name.decode(), facts.unit.decode())
                                    for place, facts in enumerate(law.facts, 1) if place > 3])

    def test_constants_for_tests_are_those_of_the_library(self):
        known = law_examples.constants_by_law()
        laws = law_examples.laws()
        self.assertEqual(set(known), {'every', *laws})
        for name, law in laws.items():
            self.assertEqual(set(law.names), {'law', *known['every'], *known[name]})


if __name__ == '__main__':
    unittest.main()
