"""What the shared objects show to the programs that load them: their own entries and no other symbol; and what they need
themselves: the C library and its mathematics, and OpenMP, but no Fortran run-time library.

LIBRARIES: the files, separated by semicolons; STRICT: ON in a build whose run-time checks need that library.
"""
import os
import pathlib
import re
import subprocess
import unittest

INCLUDE = pathlib.Path(__file__).resolve().parent.parent / 'include'
C_LIBRARIES = {'libc', 'libm', 'libmvec', 'ld-linux-x86-64', 'ld-linux-aarch64'}
OPENMP = {'libgomp', 'libomp', 'libiomp5'}


def output(*command):
    return subprocess.run(command, text=True, check=True, capture_output=True).stdout


def declared_functions(header='friction.h'):
    """The names in a header, without its comments."""
    text = re.sub(r'/\*.*?\*/', '', (INCLUDE / header).read_text(), flags=re.DOTALL)
    return set(re.findall(r'((?:friction|stickslip)_\w+)\s*\(', text))


def exported(library):
    return set(line.split()[-1] for line in output('nm', '-D', '--defined-only', library).splitlines())


def entries(library):
    """The symbols that a library is there for; behaviours of MFront have names in front of theirs."""
    if library.name == 'libstickslip_mgis.so':
        return {name for name in exported(library) if re.match('StickSlip[A-Z]', name)} | {'StickSlipCoulomb_Tridimensional'}
    if library.name.startswith('libstickslip_program.so'):
        return declared_functions('stickslip_program.h')
    return declared_functions() if library.name.startswith('libstickslip.so') else {'umat_'}


class SharedObjects(unittest.TestCase):
    libraries = [pathlib.Path(name) for name in os.environ['LIBRARIES'].split(';')]

    def test_each_exports_its_own_entries_and_nothing_else(self):
        self.assertGreater(len(declared_functions()), 4)
        for library in self.libraries:
            with self.subTest(library=library.name):
                self.assertEqual(exported(library), entries(library))

    @unittest.skipIf(os.environ.get('STRICT') == 'ON', 'run-time checks call the run-time library')
    def test_none_needs_the_fortran_run_time_library(self):
        for library in self.libraries:
            if library.name.startswith('libstickslip_program.so'):
                continue   # the program's numerics and texts are Fortran's
            with self.subTest(library=library.name):
                undefined = output('nm', '-D', '--undefined-only', library).split()
                self.assertEqual([name for name in undefined if re.match('_gfortran|_Fortran|_F[A-Z]|_Q[MQ]', name)], [])
                needed = re.findall(r'NEEDED.*\[(.*?)\.so', output('readelf', '-d', library))
                self.assertEqual(set(needed) - C_LIBRARIES - OPENMP, set())


if __name__ == '__main__':
    unittest.main()
