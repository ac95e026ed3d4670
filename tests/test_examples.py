"""The examples build against an installed package, in an empty folder, and run.

BUILD names the build directory; CMAKE, the cmake program; FC, the Fortran compiler of the build;
STICKSLIP_LIBRARY, the library there, which tells the laws.
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / 'hosts'))

import friction_point  # noqa: E402

FORTRAN = os.environ.get('FC', 'gfortran')
ROOT = pathlib.Path(__file__).resolve().parent.parent
EXAMPLES = ROOT / 'examples'


class Installed(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp())
        cls.prefix = cls.folder / 'installed here'   # a path with a space, as users have them
        cls.call(os.environ['CMAKE'], '--install', os.environ['BUILD'], '--prefix', cls.prefix)
        cls.libraries = next(cls.prefix.rglob('libstickslip.so')).parent
        os.environ['STICKSLIP_LIBRARY'] = str(cls.libraries / 'libstickslip.so')

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    @classmethod
    def call(cls, *command, **options):
        result = subprocess.run(list(map(str, command)), text=True, check=False, stdout=subprocess.PIPE,
                                stderr=subprocess.STDOUT, **options)
        if result.returncode != 0:
            raise AssertionError(f'{command}: {result.stdout}')
        return result.stdout

    def last_line(self, output):
        """Of 20 slips forth and 20 back, the last: step, shear, mu, R; must be what the library says."""
        point = friction_point.FrictionPoint([1, 1000, 800, 0.45, 0.25, 8, 0.2, 60])
        for du in [(-0.002, 0.0)] + 20 * [(0.0, 0.0005)] + 20 * [(0.0, -0.0005)]:
            shear = point.update(du, 0.01)[1]
        words = output.splitlines()[-1].split()
        self.assertEqual(words[0], '40')
        self.assertAlmostEqual(float(words[1]), shear, delta=1e-9)
        self.assertAlmostEqual(float(words[3]), point.statev[5], delta=1e-5)
        return words

    def build_with_cmake(self, language):
        build = self.folder / f'build_{language}'
        # targets named as the libraries that stickslip needs are no part of it
        names = self.folder / 'names.cmake'
        names.write_text(''.join(f'add_library({name} INTERFACE)\n' for name in ('m', 'gomp', 'omp', 'pthread')))
        self.call(os.environ['CMAKE'], '-S', EXAMPLES / language, '-B', build, f'-DCMAKE_PREFIX_PATH={self.prefix}',
                  f'-DCMAKE_PROJECT_stickslip_example_INCLUDE={names}', env={**os.environ, 'FC': FORTRAN})
        self.call(os.environ['CMAKE'], '--build', build)
        return self.last_line(self.call(build / 'slide'))

    def find(self, *wanted):
        """What find_package says of the installed package."""
        project = self.folder / 'find'
        shutil.rmtree(project, ignore_errors=True)
        project.mkdir()
        (project / 'CMakeLists.txt').write_text('cmake_minimum_required(VERSION 3.21)\nproject(find LANGUAGES C)\n'
            f'find_package(stickslip {" ".join(wanted)})\n'
            'message(STATUS "found=${stickslip_FOUND}, ${stickslip_NOT_FOUND_MESSAGE}")\n')
        output = self.call(os.environ['CMAKE'], '-S', project, '-B', project / 'build', f'-DCMAKE_PREFIX_PATH={self.prefix}')
        return re.search('found=(.*)', output).group(1)

    def test_the_package_is_found_by_version_and_components(self):
        for wanted in ((), ('0.1',), ('COMPONENTS', 'shared'), ('0.1', 'COMPONENTS', 'static', 'shared'),
                       ('OPTIONAL_COMPONENTS', 'other')):
            self.assertRegex(self.find(*wanted), '^(1|TRUE), $')
        self.assertRegex(self.find('0.2'), '^(0|FALSE), ')
        self.assertRegex(self.find('COMPONENTS', 'shared', 'other'), '^(0|FALSE), .*components shared and static, but no other')

    def pkg_config(self, *query):
        if shutil.which('pkg-config') is None:
            self.skipTest('pkg-config is not installed')
        return self.call('pkg-config', *query, env={**os.environ, 'PKG_CONFIG_PATH': str(self.libraries / 'pkgconfig')}).strip()

    def build(self, name, compiler, source, flags):
        program = self.folder / name
        # a module of this compiler, should it make one
        self.call(f'{compiler} {source} {flags} -o "{program}"', shell=True, cwd=self.folder)
        return self.last_line(self.call(program, env={**os.environ, 'LD_LIBRARY_PATH': str(self.libraries)}))

    def test_all_roads_lead_to_the_same_numbers(self):
        lines = [self.build_with_cmake('c'), self.build_with_cmake('fortran')]
        self.assertEqual(lines[0], lines[1])

    def test_pkg_config_tells_c_and_fortran_how_to_link_shared_and_static(self):
        c, modules, any_compiler = (f'"{EXAMPLES / name}"' for name in
                                    ('c/slide.c', 'fortran/slide.f90', 'fortran/slide_any_compiler.f90'))
        any_compiler = self.pkg_config('--variable=interface', 'stickslip') + ' ' + any_compiler
        shared = self.pkg_config('--cflags', '--libs', 'stickslip')
        static = '-static ' + self.pkg_config('--static', '--cflags', '--libs', 'stickslip')
        lines = [self.build('c_shared', 'cc', c, shared), self.build('c_static', 'cc', c, static),
                 self.build('fortran_shared', FORTRAN, any_compiler, shared),
                 self.build('fortran_static', FORTRAN, any_compiler, static),
                 self.build('modules', FORTRAN, modules, self.pkg_config('--cflags', '--libs', 'stickslip-fortran')),
                 self.build('modules_static', FORTRAN, modules,
                            '-static ' + self.pkg_config('--static', '--cflags', '--libs', 'stickslip-fortran'))]
        self.assertEqual(lines, lines[:1] * len(lines))

    def test_c_sources_need_nothing_that_cmake_makes(self):
        """fpm compiles every file below src as it lies there."""
        sources = sorted(ROOT.glob('src/**/*.c'))
        self.assertGreater(len(sources), 2)
        for source in sources:
            self.call('cc', '-c', f'-I{ROOT / "include"}', source, '-o', self.folder / 'alone.o')

    def test_everything_a_host_needs_is_installed(self):
        for name in ('libstickslip.a', 'libSTICKSLIP.so', 'libstickslip_kratos.so', 'libstickslip_mgis.so', 'friction.h',
                     'stickslip_abaqus_standard_routines.f90', 'stickslip_abaqus_explicit_routines.f90', 'friction_mod.mod',
                     'stickslip_abaqus_standard.f90', 'stickslip_abaqus_explicit.f90', 'stickslip.pc', 'stickslip-fortran.pc',
                     'friction_interface.f90'):
            self.assertEqual(len(list(self.prefix.rglob(name))), 1, name)

    def test_the_single_files_for_abaqus_compile_alone(self):
        for name in ('standard', 'explicit', 'standard_routines', 'explicit_routines'):
            source = next(self.prefix.rglob(f'stickslip_abaqus_{name}.f90'))
            alone = self.folder / name
            alone.mkdir()
            shutil.copy(source, alone)
            kinds = [[]]
            if 'gfortran' in FORTRAN:
                kinds += [['-Wall', '-Wno-unused-dummy-argument'], ['-fdefault-integer-8']]
            for options in kinds:
                self.assertEqual(self.call(FORTRAN, '-c', *options, source.name, cwd=alone), '')

    def test_a_job_has_a_umat_of_its_own_beside_friction(self):
        alone = self.folder / 'own'
        alone.mkdir()
        shutil.copy(next(self.prefix.rglob('stickslip_abaqus_standard_routines.f90')), alone / 'routines.f90')
        shutil.copy(EXAMPLES / 'abaqus/own_umat.f', alone)
        (alone / 'host.f90').write_text(HOST)
        self.call(FORTRAN, '-c', 'routines.f90', cwd=alone)
        defined = self.call('nm', '--defined-only', 'routines.o', cwd=alone).split()
        for name in ('fric', 'uinter', 'umat'):
            self.assertIn(f'stickslip_{name}_', defined)
            self.assertNotIn(f'{name}_', defined)
        self.call(FORTRAN, 'host.f90', 'own_umat.f', 'routines.o', '-o', 'host', cwd=alone)
        own, friction = (float(word) for word in self.call(alone / 'host').split())
        point = friction_point.FrictionPoint([2, 1000, 800, 0.4])
        self.assertAlmostEqual(friction, point.update((-0.003, 0.01, 0.0), 0.1)[1], delta=1e-12)
        self.assertAlmostEqual(own, 0.5 * 70 * 0.1, delta=1e-12)


# calls UMAT for an elastic material and for a layer of friction, and prints a shear stress of each
HOST = """program host
    implicit none
    integer, parameter :: dp = kind(1.0d0)
    real(dp) :: stress(6), statev(8), ddsdde(6, 6), other(36), strain(6), pnewdt
    integer :: step(4), k
    real(dp), parameter :: layer(6) = [0.1_dp, 1.0_dp, 2.0_dp, 1000.0_dp, 800.0_dp, 0.4_dp], elastic(6) = 70.0_dp
    character(len=80) :: name
    step = 0
    other = 0.0_dp
    strain = [0.0_dp, 0.0_dp, -0.03_dp, 0.0_dp, 0.1_dp, 0.0_dp]
    do k = 1, 2
        stress = 0.0_dp
        statev = 0.0_dp
        name = merge('ELASTIC ', 'FRICTION', k == 1)
        call umat(stress, statev, ddsdde, other(1), other(2), other(3), other(4), other, other, other(5), other, strain, &
            other, 0.1_dp, 0.0_dp, 0.0_dp, other, other, name, 3, 3, 6, 8, merge(elastic, layer, k == 1), 6, other, &
            reshape([1, 0, 0, 0, 1, 0, 0, 0, 1] * 1.0_dp, [3, 3]), pnewdt, 1.0_dp, other, other, 1, 1, 1, 1, step, 1)
        print *, stress(5)
    end do
end program host
subroutine stdb_abqerr()
end subroutine stdb_abqerr
"""

if __name__ == '__main__':
    unittest.main()
