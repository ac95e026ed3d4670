"""The package as pip builds it: what it holds, and what is said where it cannot be built."""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

import stickslip

ROOT = pathlib.Path(__file__).resolve().parents[2]


class Build(unittest.TestCase):
    def test_the_package_is_the_installed_one_not_the_source(self):
        self.assertNotIn(ROOT / 'python', pathlib.Path(stickslip.__file__).resolve().parents)

    def test_wheels_are_small(self):
        for wheel in (ROOT / 'build/wheel').glob('*.whl'):
            self.assertLess(wheel.stat().st_size, 4e6)

    def test_libraries_lie_in_the_package_s_own_folder(self):
        """pip removes an empty folder, but none above it: an editable installation, which has nothing but the libraries
        there, would leave an empty package behind."""
        folder = pathlib.Path(stickslip.__file__).parent
        self.assertEqual([path.parent for path in folder.rglob('lib*')], 2 * [folder])

    def test_only_numpy_is_needed_and_what_else_is_told(self):
        program = """import sys
for name in ('pandas', 'scipy', 'matplotlib'):
    sys.modules[name] = None
import stickslip
law = stickslip.laws.Coulomb(alpha_n=1, alpha_t=1, mu=0.3)
assert stickslip.update([-1.0, 0.0], 1.0, law).traction[0] == -1
for call, words in ((lambda: stickslip.run({'friction': law}), "needs pandas: install the package as 'stickslip[run]'"),
                    (lambda: stickslip.run('&friction /'), 'needs pandas'),
                    (lambda: stickslip.Record.read('rig.mat'), 'needs scipy')):
    try:
        call()
    except ImportError as error:
        assert words in str(error), error
    else:
        raise AssertionError(words)
"""
        result = subprocess.run([sys.executable, '-c', program], text=True, capture_output=True, check=False)
        self.assertEqual(result.returncode, 0, result.stderr)

    def test_modules_and_libraries_may_lie_apart_as_editable_installations_have_them(self):
        program = """import importlib.util, sys
spec = importlib.util.spec_from_file_location('stickslip', sys.argv[1] + '/__init__.py', submodule_search_locations=sys.argv[1:])
sys.modules['stickslip'] = stickslip = importlib.util.module_from_spec(spec)
spec.loader.exec_module(stickslip)
print(stickslip.update([-1.0, 0.0], 1.0, stickslip.laws.Coulomb(alpha_n=1, alpha_t=1, mu=0.3)).traction[0])
"""
        folders = [ROOT / 'python' / 'stickslip', pathlib.Path(stickslip.__file__).parent]
        result = subprocess.run([sys.executable, '-c', program, *map(str, folders)], text=True, capture_output=True, check=False)
        self.assertEqual(result.stdout, '-1.0\n', result.stderr)

    def test_a_missing_lapack_is_told_with_what_to_install(self):
        with tempfile.TemporaryDirectory() as build:
            result = subprocess.run([shutil.which('cmake'), '-S', ROOT, '-B', build, '-DCMAKE_DISABLE_FIND_PACKAGE_LAPACK=ON'],
                                    text=True, capture_output=True, check=False)
            self.assertNotEqual(result.returncode, 0)
            words = ' '.join(result.stderr.split())
            self.assertIn('needs LAPACK', words)
            self.assertIn('apt install liblapack-dev', words)
            self.assertIn('-DSTICKSLIP_BUILD_DRIVER=OFF', words)

    @unittest.skipUnless(sys.platform == 'linux', 'asks libraries as Linux has them')
    def test_a_library_for_another_mpi_is_seen(self):
        with tempfile.TemporaryDirectory() as folder:
            def library(name, soname, *needs):
                path = f'{folder}/lib{name}.so'
                subprocess.run(['cc', '-shared', '-o', path, f'-Wl,-soname,{soname}', '-Wl,--no-as-needed', '-x', 'c', '/dev/null',
                                '-x', 'none', *needs], check=True)
                return path

            open_mpi = library('mpi', 'libmpi.so.40')
            mpich = library('mpich', 'libmpich.so.12')
            bindings = [library('mpi_mpifh', 'libmpi_mpifh.so.40', open_mpi), library('mpichfort', 'libmpichfort.so.12')]
            fftw = library('fftw3_mpi', 'libfftw3_mpi.so.3', open_mpi)
            for found, other in (([bindings[0], open_mpi], ''), ([bindings[1], mpich], 'libmpi.so.40'), ([], '')):
                script = pathlib.Path(folder, 'ask.cmake')
                script.write_text(f'include({ROOT}/driver/fault/OtherMpi.cmake)\n'
                                  f'stickslip_other_mpi(other {fftw} {" ".join(found)})\nmessage("other: ${{other}}")\n')
                result = subprocess.run([shutil.which('cmake'), '-P', script], text=True, capture_output=True, check=False)
                self.assertEqual(result.stderr, f'other: {other}\n')

    def test_a_missing_compiler_is_told_with_what_to_install(self):
        with tempfile.TemporaryDirectory() as folder:
            tools = pathlib.Path(folder, 'bin')
            tools.mkdir()
            for tool in ('ar', 'as', 'cc', 'cmake', 'gcc', 'ld', 'make', 'nm', 'ranlib', 'strip', 'uname'):
                if shutil.which(tool):
                    (tools / tool).symlink_to(shutil.which(tool))
            environment = {name: value for name, value in os.environ.items() if name not in ('FC', 'CONDA_PREFIX')}
            result = subprocess.run([shutil.which('cmake'), '-S', ROOT, '-B', pathlib.Path(folder, 'build')], text=True,
                                    capture_output=True, check=False, env={**environment, 'PATH': str(tools)})
            self.assertNotEqual(result.returncode, 0)
            words = ' '.join(result.stderr.split())
            self.assertIn('no Fortran compiler was found', words)
            self.assertIn('apt install gfortran', words)


if __name__ == '__main__':
    unittest.main()
