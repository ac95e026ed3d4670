"""Projects in C, C++ and Fortran build stickslip as a part of themselves (FetchContent, from the sources here), run, and
find nothing of theirs changed.

CMAKE, the cmake program; FC, the Fortran compiler.
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent
PARENTS = ROOT / 'examples/fetch_content'
PLAIN = ['-DSTICKSLIP_VECTOR_KERNELS=OFF']   # their copies take most of a build; the C project has them


class Parents(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)

    def call(self, *command):
        result = subprocess.run(list(map(str, command)), text=True, check=False, stdout=subprocess.PIPE,
                                stderr=subprocess.STDOUT)
        self.assertEqual(result.returncode, 0, f'{command}: {result.stdout}')
        return result.stdout

    def build(self, language, *options):
        build = self.folder / language
        # targets named as the libraries that stickslip needs are no part of it
        names = self.folder / 'names.cmake'
        names.write_text(''.join(f'add_library({name} INTERFACE)\n' for name in ('m', 'gomp', 'omp', 'pthread')))
        fortran = [] if 'FC' not in os.environ else [f'-DCMAKE_Fortran_COMPILER={os.environ["FC"]}']
        self.call(os.environ['CMAKE'], '-S', PARENTS / language, '-B', build, f'-DSTICKSLIP_SOURCE={ROOT}',
                  f'-DCMAKE_PROJECT_parent_INCLUDE={names}', *fortran, *options)
        self.call(os.environ['CMAKE'], '--build', build, '-j2')
        return build

    def check(self, language, *options):
        build = self.build(language, *options)
        self.assertEqual(self.call(build / 'slide').splitlines()[-1].split()[:2], ['40', '-0.511635412'])
        cache = (build / 'CMakeCache.txt').read_text()
        self.assertRegex(cache, r'(?m)^CMAKE_BUILD_TYPE:\w+=$')
        for name in ('BUILD_TESTING', 'CMAKE_INSTALL_LIBDIR', 'PFUNIT'):
            self.assertNotRegex(cache, rf'(?m)^{name}')
        targets = re.findall(r'^\.\.\. ([\w-]+)$', self.call(os.environ['CMAKE'], '--build', build, '--target', 'help'),
                             re.MULTILINE)
        own = {'slide', 'all', 'clean', 'depend', 'edit_cache', 'rebuild_cache', 'list_install_components'}
        self.assertGreater(len(targets), 2)
        self.assertEqual([name for name in targets if not name.startswith('stickslip_') and name not in own], [])
        prefix = self.folder / f'{language}_installed'
        self.call(os.environ['CMAKE'], '--install', build, '--prefix', prefix)
        self.assertEqual(list(prefix.rglob('*')), [])

    def test_a_c_project_that_knows_no_fortran_links_the_static_library(self):
        self.check('c', '-DSTICKSLIP_BUILD_HOSTS=ON')
        # without optimisation, too, hosts find all that the shared objects call
        for name in ('STICKSLIP', 'stickslip_kratos', 'stickslip_mgis'):
            library = next((self.folder / 'c').rglob(f'lib{name}.so'))
            self.call(sys.executable, '-c', f'import ctypes, os; ctypes.CDLL({str(library)!r}, mode=os.RTLD_NOW)')

    @unittest.skipIf('CXX' not in os.environ and shutil.which('c++') is None, 'no C++ compiler')
    def test_a_c_plus_plus_project(self):
        self.check('cpp', *PLAIN)

    def test_a_fortran_project_uses_the_modules(self):
        self.check('fortran', *PLAIN)


if __name__ == '__main__':
    unittest.main()
