"""What is written in several places says the same: version numbers and status codes."""
import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent


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


if __name__ == '__main__':
    unittest.main()
