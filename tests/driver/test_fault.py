"""The verb fault: a benchmark, restarts, any number of processes, input that is wrong."""
import contextlib
import csv
import filecmp
import math
import os
import pathlib
import pty
import select
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest
import xml.etree.ElementTree

from drawing import needs_gnuplot
from field_reader import read_fields
from strict_build import STRICT, release_only

PROGRAM = os.environ['STICKSLIP']
ENGINE = pathlib.Path(PROGRAM).with_name('stickslip-fault')
MPIRUN = os.environ.get('MPIRUN', '')
INPUTS = pathlib.Path(__file__).resolve().parents[2] / 'inputs'
YEAR = 365 * 86400
# More processes than cores, not bound to any, since tests beside this one have the same first cores: words of Open MPI
# up to 4, then of its launcher from 5 on.
ENVIRONMENT = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT='1', OMPI_ALLOW_RUN_AS_ROOT_CONFIRM='1', OMPI_MCA_mpi_yield_when_idle='1',
                   OMPI_MCA_rmaps_base_oversubscribe='1', OMPI_MCA_hwloc_base_binding_policy='none',
                   PRTE_MCA_rmaps_default_mapping_policy=':oversubscribe', PRTE_MCA_hwloc_default_binding_policy='none')

SMALL = """
&fault geometry = 'antiplane_half', width = 40e3, nz = 64, shear_modulus = 32.04e9, wave_speed = 3464,
       plate_rate = 1e-9, normal_traction = 50e6 /
&friction law = 'rate_and_state', a = '@a.csv', b = 0.015, d_c = 0.032, v0 = 1e-6, f0 = 0.6 /
&time t_end = 1.0e10, rtol = 1e-4 /
&output stations = 0, 10e3, checkpoint = 0, slip_contours = 3e8, 10 /
"""
LONG = SMALL.replace('nz = 64', 'nz = 100').replace('d_c = 0.032', 'd_c = 0.015').replace('1.0e10', '7.0e9')
PLANE = """
&fault geometry = 'whole', length = 60e3, width = 40e3, nx = 30, nz = 21, shear_modulus = 32.04e9,
       wave_speed = 3464, plate_rate = 1e-9, normal_traction = 50e6, initial = 'file', initial_file = 'start.csv' /
&friction law = 'rate_and_state', a = 0.007, b = 0.013, d_c = 0.04, v0 = 1e-6, f0 = 0.6 /
&time t_end = 3e8, rtol = 1e-3 /
&output stations = 20e3, stations_x = 5e3, checkpoint = 0, fields = 5 /
"""
HALF = PLANE.replace("'whole'", "'half'").replace('nx = 30', 'nx = 31')
SUBLOADING = """
&fault geometry = 'antiplane_half', width = 40e3, nz = 96, shear_modulus = 32.04e9, wave_speed = 3464,
       plate_rate = 1e-9, normal_traction = 50e6, initial = 'file', initial_file = 'a.csv' /
&friction law = 'subloading', mu_s = 0.6, mu_k = '@a.csv', kappa = 10, xi = 1e-9, m = 1000, scheme = 'exact_rate' /
&time t_end = 1.5e10, rtol = 2e-3 /
&output stations = 0, 10e3, checkpoint = 0 /
"""
A = 'z,a,mu_k,traction\n0,0.010,0.51,22.5e6\n15e3,0.010,0.51,22.5e6\n18e3,0.025,0.60,22.5e6\n'
FIELDS = ('slip_rate', 'slip', 'traction', 'internal')
# files of fields have room for 60 records of so many cells
PARTS = PLANE.replace('nx = 30, nz = 21', 'nx = 96, nz = 90').replace('fields = 5', 'fields = 1').replace('3e8', '2e9')
START = 'x,z,traction,slip_rate\n' + ''.join(
    f'{x},{z},{32e6 if (x, z) == (0, 20e3) else 30e6},{1e-9}\n'
    for z in (0, 10e3, 20e3, 30e3, 40e3) for x in (-30e3, -10e3, 0, 10e3, 30e3))


def descendants(process):
    """A process after those that it (any of its threads) has started, which a launcher's death would not end at once."""
    children = []
    for thread in pathlib.Path(f'/proc/{process}/task').glob('*/children'):
        with contextlib.suppress(OSError):
            children += thread.read_text().split()
    return [each for child in children for each in descendants(int(child))] + [process]


class FaultTest(unittest.TestCase):
    def setUp(self):
        if not ENGINE.exists():
            self.skipTest('built without FFTW')
        self.place = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.place)
        # a launcher that is killed leaves its files, megabytes of them
        self.environment = dict(ENVIRONMENT, TMPDIR=str(self.place))
        (self.place / 'a.csv').write_text(A)
        (self.place / 'start.csv').write_text(START)

    def write(self, text, name='case.nml'):
        (self.place / name).write_text(text)
        return name

    def command(self, processes, *arguments):
        launcher = [MPIRUN, '-n', str(processes)] if processes > 1 else []
        return launcher + [PROGRAM, 'fault', '--no-plot', *arguments]

    def run_fault(self, *arguments, processes=1, expect=0):
        done = subprocess.run(self.command(processes, *arguments), cwd=self.place, env=self.environment,
                              capture_output=True, text=True)
        self.assertEqual(done.returncode, expect, done.stdout + done.stderr)
        return done

    def assert_same_files(self, a, b):
        names = sorted(path.name for path in (self.place / a).iterdir())
        self.assertEqual(names, sorted(path.name for path in (self.place / b).iterdir()))
        self.assertGreater(len(names), 3)
        for name in names:
            self.assertTrue(filecmp.cmp(self.place / a / name, self.place / b / name, shallow=False), name)

    def kill_and_resume(self, name, seconds, processes, then_processes, checkpoints=2):
        self.kill(name, seconds, processes, checkpoints)
        self.resume(name, then_processes)

    def kill(self, name, seconds, processes, checkpoints=2):
        """Kills a run some time after its first checkpoint, that of its start, or a later one."""
        shutil.rmtree(self.place / 'parts', ignore_errors=True)
        run = subprocess.Popen(self.command(processes, name, '--output', 'parts', '--quiet'), cwd=self.place,
                               env=self.environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        seen = set()
        while len(seen) < checkpoints and run.poll() is None:
            with contextlib.suppress(FileNotFoundError):
                seen.add((self.place / 'parts' / 'case.checkpoint').stat().st_mtime_ns)
            time.sleep(0.002)
        time.sleep(seconds)
        for process in descendants(run.pid):
            os.kill(process, signal.SIGKILL)
        run.wait()

    def resume(self, name, processes):
        """A run that was killed leaves the files of 'whole' in the end."""
        if (self.place / 'parts' / 'case.checkpoint').exists():   # else the run was done before
            self.run_fault(name, '--output', 'parts', '--quiet', '--resume', processes=processes)
        for path in (self.place / 'parts').glob('*.new'):
            path.unlink()
        self.assert_same_files('whole', 'parts')

    def rows(self, name):
        with open(self.place / name, newline='') as file:
            return {float(row['time']): row for row in csv.DictReader(file)}

    def events(self, directory, stem):
        with open(self.place / directory / f'{stem}_events.csv', newline='') as file:
            return list(csv.DictReader(file))


class Benchmark(FaultTest):
    @release_only
    def test_bp1_has_the_events_of_other_codes(self):
        """78 m cells: the onsets are those of the community's codes at 25 m within a tenth of a year."""
        self.run_fault(str(INPUTS / 'fault_bp1.nml'), '--output', 'bp1', '--quiet')
        events = self.events('bp1', 'fault_bp1')
        self.assertEqual(len(events), 3)
        for event, onset in zip(events, (196.49, 272.16, 350.02)):
            self.assertAlmostEqual(float(event['onset']) / YEAR, onset, delta=0.1)
        self.assertAlmostEqual(float(events[-1]['peak_slip_rate']), 4.18, delta=0.1)
        with open(self.place / 'bp1' / 'fault_bp1_station_1.csv', newline='') as file:
            rows = list(csv.DictReader(file))
        self.assertAlmostEqual(float(rows[0]['log10_slip_rate']), -9, delta=1e-12)
        # traction 26.546122 MPa of the benchmark's description, less radiation damping
        self.assertAlmostEqual(float(rows[0]['traction']), 26546122 - 32.03812032e9 / 2 / 3464 * 1e-9, delta=1)


    def test_bp5_repeats_as_in_other_codes(self):
        """2 km cells: the first recurrence of two boundary-element codes is 236.8 years, at 1 km 234.3."""
        text = (INPUTS / 'fault_half_space.nml').read_text()
        shutil.copy(INPUTS / 'fault_half_space.csv', self.place)
        for old, new in (('nx = 100', 'nx = 50'), ('nz = 40', 'nz = 20'), ('1.6e10', '8e9'), ('fields = 100', '')):
            self.assertIn(old, text)
            text = text.replace(old, new)
        self.run_fault(self.write(text), '--quiet')
        events = self.events('case_out', 'case')
        self.assertEqual(len(events), 2)
        self.assertAlmostEqual(float(events[1]['onset']) / YEAR, 235.5, delta=2.5)


# a procedure of MPI that divides by zero before it does its work
RAISE = """
#define _GNU_SOURCE
#include <dlfcn.h>
volatile double zero = 0.0, quotient;
void FUNCTION(void *error)
{
    quotient = zero / zero;
    ((void (*)(void *)) dlsym(RTLD_NEXT, "FUNCTION"))(error);
}
"""


class Processes(FaultTest):
    def setUp(self):
        super().setUp()
        if not MPIRUN:
            self.skipTest('built without MPI')

    def test_what_all_processes_would_tell_is_told_once(self):
        self.write(SMALL)
        self.write(SMALL.replace('nz = 64', 'nz = 0'), 'bad.nml')
        no_engine = self.place / 'elsewhere'
        no_engine.mkdir()
        shutil.copy(PROGRAM, no_engine)
        for arguments, status, words in ((['fault'], 2, 'fault needs an input file'), (['falt', 'case.nml'], 2, "command 'falt'"),
                                         ([], 2, 'no command given'), (['fault', 'case.nml', '--part', '1/2'], 2, '--part is for'),
                                         (['fault', 'bad.nml'], 2, 'nz = 0'), (['fault', 'none.nml'], 2, 'Cannot open file'),
                                         (['fault', '--help'], 0, 'usage: stickslip run'), (['--version'], 0, 'stickslip ')):
            told = self.launch([PROGRAM, *arguments], status)
            self.assertEqual(told.count(words), 1, told)
        told = self.launch([no_engine / pathlib.Path(PROGRAM).name, 'fault', 'case.nml'], 1)
        self.assertEqual(told.count('there is no fault engine'), 1, told)
        # what one process alone cannot do is told by that one; runs of their own tell each its own
        # (chosen by rank: mpirun of Open MPI 5.0.7 breaks down at a second program after a colon)
        last = 'case $OMPI_COMM_WORLD_RANK$PMI_RANK in 2) exec "$0" fault none.nml;; *) exec "$0" fault case.nml;; esac'
        told = self.launch(['sh', '-c', last, PROGRAM], 2)
        self.assertEqual(told.count('Cannot open file'), 1, told)
        self.assertEqual(self.launch([PROGRAM, 'check', 'case.nml'], 0).count('valid'), 3)

    @unittest.skipUnless(sys.platform == 'linux' and shutil.which('cc'), 'puts a library before MPI')
    def test_floating_point_exceptions_while_mpi_starts_end_nothing(self):
        """A build with run-time checks traps them, its own alone."""
        self.write(SMALL.replace('1.0e10', '1.0e3'))   # a few steps
        for function, ends in (('mpi_init_f08_', False), ('mpi_finalize_f08_', STRICT)):
            (self.place / 'raise.c').write_text(RAISE.replace('FUNCTION', function))
            library = self.place / f'{function}.so'
            subprocess.run(['cc', '-shared', '-fPIC', 'raise.c', '-o', library, '-ldl'], cwd=self.place, check=True)
            done = subprocess.run([MPIRUN, '-n', '2', 'env', f'LD_PRELOAD={library}', PROGRAM, 'fault', 'case.nml', '--no-plot'],
                                  cwd=self.place, env=self.environment, capture_output=True, text=True)
            self.assertEqual(done.returncode != 0, ends, function + done.stdout + done.stderr)

    def launch(self, command, status):
        """What three processes say."""
        done = subprocess.run([MPIRUN, '-n', '3', *command], cwd=self.place, env=self.environment, capture_output=True, text=True)
        self.assertEqual(done.returncode, status, done.stdout + done.stderr)
        return done.stdout + done.stderr

    def test_files_do_not_depend_on_the_number_of_processes(self):
        # odd numbers of cells: what is left over from vectors must not be rounded otherwise
        odd = SMALL.replace('nz = 64', 'nz = 63')
        for text, counts in ((odd, (2,)), (odd.replace('1.0e10', '4.0e9'), (4,)), (PLANE, (3,)), (HALF, (2, 4)),
                             (SUBLOADING.replace('nz = 96', 'nz = 91').replace('1.5e10', '1e9'), (2,))):
            name = self.write(text)
            shutil.rmtree(self.place / 'on1', ignore_errors=True)
            self.run_fault(name, '--output', 'on1', '--quiet')
            for processes in counts:
                shutil.rmtree(self.place / f'on{processes}', ignore_errors=True)
                self.run_fault(name, '--output', f'on{processes}', '--quiet', processes=processes)
                self.assert_same_files('on1', f'on{processes}')

    def test_implicit_steps_take_logarithms_alike_on_any_number_of_processes(self):
        """Of cells left over from vectors, and of `theta` of some tens, where functions that round otherwise show."""
        (self.place / 'start.csv').write_text(START.replace('1e-09', '1e-3'))
        text = PLANE
        for old, new in (('nx = 30, nz = 21', 'nx = 7, nz = 3'), ('fields = 5', 'fields = 1'), ('3464', '3464e6'), ('3e8', '3e2'),
                         ('plate_rate = 1e-9', 'plate_rate = 1e-3'), ('v0 = 1e-6', 'v0 = 1'), ('1e-3 /', "1e-3, scheme = 'implicit' /")):
            text = text.replace(old, new)
        name = self.write(text)
        for processes in (1, 3):
            self.run_fault(name, '--output', f'on{processes}', '--quiet', processes=processes)
        self.assert_same_files('on1', 'on3')

    def test_killed_and_resumed_on_another_number_of_processes(self):
        name = self.write(LONG)
        self.run_fault(name, '--output', 'whole', '--quiet')
        self.kill_and_resume(name, 0.3, 2, 1)
        self.kill_and_resume(name, 0.05, 1, 2)

    def test_killed_runs_leave_the_fields_that_were_saved_and_go_on_to_the_same(self):
        name = self.write(PARTS)
        self.run_fault(name, '--output', 'whole', '--quiet')
        self.assertGreater(len(list((self.place / 'whole').glob('case_fields_0*'))), 1)
        whole = read_fields(self.place / 'whole' / 'case', FIELDS, 96 * 90)
        for seconds, processes, then in ((0.1, 2, 3), (0.4, 1, 2), (0.7, 3, 1))[:1 if STRICT else 3]:
            self.kill(name, seconds, processes)
            times, fields = read_fields(self.place / 'parts' / 'case', FIELDS, 96 * 90)
            self.assertGreater(len(times), 3)
            self.assertEqual(times, whole[0][:len(times)])
            for field in FIELDS:
                self.assertEqual(fields[field], whole[1][field][:len(times)])
            self.resume(name, then)

    def test_ctrl_c_at_a_launchers_terminal_leaves_a_checkpoint(self):
        """Open MPI ends its processes some time after Ctrl-C, and with 0 s at once: no step is done by then."""
        name = self.write(SMALL.replace('checkpoint = 0', 'checkpoint = 3600').replace('1.0e10', '1.0e13'))
        for seconds in ('1', '0'):
            shutil.rmtree(self.place / 'parts', ignore_errors=True)
            self.press_ctrl_c(self.command(2, name, '--output', 'parts'), seconds)
            table = self.place / 'parts' / 'case_global.csv'
            before = table.stat().st_size
            run = subprocess.Popen(self.command(1, name, '--output', 'parts', '--quiet', '--resume'), cwd=self.place,
                                   stderr=subprocess.PIPE, text=True)
            while table.stat().st_size == before and run.poll() is None:   # rows are cut off, and written again
                time.sleep(0.01)
            run.send_signal(signal.SIGINT)
            self.assertIn('--resume goes on', run.communicate()[1])

    def press_ctrl_c(self, command, seconds):
        """Runs a command at a terminal of its own until it has a checkpoint, and presses Ctrl-C."""
        pid, terminal = pty.fork()
        if pid == 0:
            os.chdir(self.place)
            os.execvpe(command[0], command, dict(ENVIRONMENT, OMPI_MCA_odls_base_sigkill_timeout=seconds,
                                                 PRTE_MCA_odls_base_sigkill_timeout=seconds))
        checkpoint = self.place / 'parts' / 'case.checkpoint'
        patience = time.monotonic() + 60
        while not checkpoint.exists() and time.monotonic() < patience:
            select.select([terminal], [], [], 0.005)
        os.write(terminal, b'\x03')
        with contextlib.suppress(OSError):   # the other end is closed
            while os.read(terminal, 4096):
                pass
        os.waitpid(pid, 0)
        self.assertTrue(checkpoint.exists())


class Restart(FaultTest):
    def test_killed_runs_go_on_to_the_same_files(self):
        name = self.write(LONG)
        self.run_fault(name, '--output', 'whole', '--quiet')
        for seconds in (0.0, 0.03, 0.1):
            self.kill_and_resume(name, seconds, 1, 1)
        for text in (LONG, SUBLOADING.replace('1.5e10', '1e9')):   # from the checkpoint of the start
            name = self.write(text.replace('checkpoint = 0', 'checkpoint = 3600'))
            shutil.rmtree(self.place / 'whole')
            self.run_fault(name, '--output', 'whole', '--quiet')
            self.kill_and_resume(name, 0.05, 1, 1, checkpoints=1)

    def test_interrupted_run_says_how_to_go_on(self):
        name = self.write(SMALL.replace('1.0e10', '1.0e13'))
        run = subprocess.Popen(self.command(1, name, '--quiet'), cwd=self.place, stderr=subprocess.PIPE, text=True)
        while not (self.place / 'case_out' / 'case.checkpoint').exists() and run.poll() is None:
            time.sleep(0.01)
        run.send_signal(signal.SIGINT)
        self.assertIn('--resume goes on', run.communicate()[1])
        self.assertEqual(run.returncode, 1)

    def test_run_stops_at_the_limit_of_its_tables_and_goes_on_with_a_larger_one(self):
        self.run_fault(self.write(SMALL), '--output', 'whole', '--quiet')
        limited = self.write(SMALL.replace('stations', 'table_limit = 3e-4, stations'))
        for more in ((), ('--resume',)):
            self.assertIn('reached &output table_limit',
                          self.run_fault(limited, '--output', 'parts', '--quiet', *more, expect=1).stderr)
        self.write(SMALL.replace('stations', 'table_limit = 1, stations').replace('checkpoint = 0', 'checkpoint = 5'))
        self.resume('case.nml', 1)

    def test_one_step_does_not_fill_the_disk(self):
        """An event that never ends, in which a step has thousands of contours: 24 MB in the first one, where 10 are allowed."""
        text = SMALL.replace('stations', 'seismic_rate = 1e-12, table_limit = 1e-2, stations').replace('3e8, 10', '3e8, 0.1')
        self.assertIn('reached &output table_limit', self.run_fault(self.write(text), '--quiet', expect=1).stderr)
        self.assertLess(sum(path.stat().st_size for path in (self.place / 'case_out').iterdir()), 1.1e7)
        self.write(text.replace('1e-2', '2e-2'))
        self.assertIn('have reached', self.run_fault('case.nml', '--quiet', '--resume', expect=1).stderr)
        self.assertLess(sum(path.stat().st_size for path in (self.place / 'case_out').iterdir()), 2.1e7)

    def test_files_that_are_not_those_of_the_checkpoint_are_told_by_name(self):
        name = self.write(PLANE.replace('3e8', '1e13').replace('fields = 5', 'fields = 1'))
        run = subprocess.Popen(self.command(1, name, '--quiet'), cwd=self.place, stderr=subprocess.PIPE, text=True)
        while not list((self.place / 'case_out').glob('case_fields.*')) and run.poll() is None:
            time.sleep(0.01)
        run.send_signal(signal.SIGINT)
        run.communicate()
        for pattern, told in (('case_fields_000001.*', 'case_fields*'), ('case_events.csv', 'case_*.csv')):
            path, = (self.place / 'case_out').glob(pattern)
            path.rename(self.place / 'aside')
            self.assertIn(f'the files case_out/{told} are not those', self.run_fault(name, '--resume', expect=1).stderr)
            (self.place / 'aside').rename(path)

    def test_another_input_or_a_damaged_checkpoint_is_refused(self):
        name = self.write(LONG.replace('7.0e9', '1.0e13'))   # it never ends before it is told to
        run = subprocess.Popen(self.command(1, name, '--quiet'), cwd=self.place, stderr=subprocess.PIPE, text=True)
        checkpoint = self.place / 'case_out' / 'case.checkpoint'
        while not checkpoint.exists() and run.poll() is None:
            time.sleep(0.01)
        run.send_signal(signal.SIGINT)
        run.communicate()
        for other in ('z,a\n0,0.011\n15e3,0.010\n18e3,0.025\n', A.replace('15e3', '14e3')):   # values, places
            (self.place / 'a.csv').write_text(other)
            self.assertIn('not the one that wrote', self.run_fault(name, '--resume', expect=1).stderr)
        (self.place / 'a.csv').write_text(A)
        damaged = bytearray(checkpoint.read_bytes())
        damaged[len(damaged) // 2] ^= 4
        checkpoint.write_bytes(damaged)
        self.assertIn('damaged', self.run_fault(name, '--resume', expect=1).stderr)
        checkpoint.unlink(missing_ok=True)
        self.assertIn('no checkpoint', self.run_fault(name, '--resume', expect=1).stderr)


class Output(FaultTest):
    def test_a_new_run_removes_what_an_older_one_has_left(self):
        name = self.write(PLANE)
        (self.place / 'case_out').mkdir()
        for old in ('case.png', 'case_station_1.csv', 'case_station_2.csv', 'case_fields_000001.h5', 'case_contours.csv', 'case_notes.txt'):
            (self.place / 'case_out' / old).write_text('old')
        self.run_fault(name, '--quiet')
        self.assertEqual({path.name for path in (self.place / 'case_out').iterdir() if path.read_bytes() == b'old'}, {'case_notes.txt'})

    def test_fields_hold_what_the_station_does(self):
        self.run_fault(self.write(PLANE), '--quiet')
        times, fields = read_fields(self.place / 'case_out' / 'case', FIELDS, 30 * 21)
        cell = 17 + 30 * 10   # x = 5 km, z = 20 km
        rows = self.rows('case_out/case_station_1.csv')
        self.assertGreater(len(times), 3)
        for k, time_ in enumerate(times):
            row = rows[time_]
            self.assertEqual(float(row['slip']), fields['slip'][k][cell])
            self.assertEqual(float(row['traction']), fields['traction'][k][cell])
            self.assertAlmostEqual(float(row['log10_slip_rate']), math.log10(fields['slip_rate'][k][cell]), delta=1e-14)
            self.assertAlmostEqual(float(row['log10_theta']), fields['internal'][k][cell] / math.log(10), delta=1e-14)
        described = xml.etree.ElementTree.parse(self.place / 'case_out' / 'case_fields.xdmf')
        self.assertEqual([float(time_.get('Value')) for time_ in described.findall('.//Time')], times)
        last = described.findall('.//Attribute[@Name="internal"]/DataItem')[-1]
        self.assertEqual(last.get('Dimensions'), '21 30')
        if last.get('Format') == 'Binary':
            self.assertEqual(int(last.get('Seek')), 8 * (len(times) * (1 + 4 * 30 * 21) - 30 * 21))
        else:
            self.assertEqual([part.text for part in last], [f'{len(times) - 1} 0 0 1 1 1 1 21 30', 'case_fields.h5:/internal'])

    def test_contours_are_of_an_event_or_between(self):
        """With times so short that several fall into the steps in which an event begins and ends."""
        self.run_fault(self.write(SMALL.replace('3e8, 10', '2e8, 0.3')), '--quiet')
        events = self.events('case_out', 'case')
        self.assertEqual(len(events), 1)
        onset, duration = (float(events[0][name]) for name in ('onset', 'duration'))
        with open(self.place / 'case_out' / 'case_contours.csv', newline='') as file:
            times = {(float(row['time']), float(row['event'])) for row in csv.DictReader(file) if row['time']}
        during = sorted(time_ for time_, event in times if event)
        self.assertEqual(len(during), 1 + int(duration / 0.3))
        for k, time_ in enumerate(during):
            self.assertAlmostEqual(time_, onset + 0.3 * k, delta=1e-3)
        between = [time_ for time_, event in times if not event]
        self.assertEqual(sorted(between), [2e8 * k for k in range(1, 51)])

    def test_fields_are_read_by_h5py(self):
        python = next((python for python in (sys.executable, '/usr/bin/python3') if not subprocess.run(
            [python, '-c', 'import h5py'], capture_output=True).returncode), None)
        self.run_fault(self.write(PLANE), '--quiet')
        if python is None or not (self.place / 'case_out' / 'case_fields.h5').exists():
            self.skipTest('no h5py, or built without HDF5')
        told = subprocess.run([python, '-c', 'import h5py; f = h5py.File("case_out/case_fields.h5"); '
                               'print(*f["slip"].shape, f["z"][20], f["x"][0], repr(float(f["slip"][-1, 10, 17])))'],
                              cwd=self.place, check=True, capture_output=True, text=True).stdout.split()
        times, fields = read_fields(self.place / 'case_out' / 'case', FIELDS, 30 * 21)
        self.assertEqual(told[:3], [str(len(times)), '21', '30'])
        self.assertAlmostEqual(float(told[3]), 40e3 * 20.5 / 21, delta=1e-9)
        self.assertEqual(float(told[4]), -29e3)
        self.assertEqual(float(told[5]), fields['slip'][-1][17 + 30 * 10])

    def test_full_disk_leaves_whole_records(self):
        name = self.write(PLANE.replace('3e8', '1e10').replace('fields = 5', 'fields = 1'))
        (self.place / 'small').mkdir()
        mounted = subprocess.run(['mount', '-t', 'tmpfs', '-o', 'size=1m', 'none', 'small'], cwd=self.place,
                                 capture_output=True)
        if mounted.returncode:
            self.skipTest('no small disk can be mounted')
        self.addCleanup(subprocess.run, ['umount', self.place / 'small'])
        for processes in (1, 2) if MPIRUN else (1,):
            done = self.run_fault(name, '--quiet', '--output', 'small', expect=1, processes=processes)
            self.assertIn('_fields* (disk full?)', done.stderr)
            times, fields = read_fields(self.place / 'small' / 'case', FIELDS, 30 * 21)
            rows = self.rows('small/case_station_1.csv')
            self.assertGreater(len(times), 3)
            self.assertEqual(list(rows)[:len(times)], times)
            for row, slip in zip(rows.values(), fields['slip']):
                self.assertEqual(float(row['slip']), slip[17 + 30 * 10])
            self.assertEqual(list((self.place / 'small').glob('*.h5.new')), [])

    def test_fields_that_cannot_be_written_are_told(self):
        name = self.write(PLANE)
        (self.place / 'case_out').mkdir()
        for kind in ('h5', 'bin'):
            (self.place / 'case_out' / f'case_fields_000001.{kind}.new').mkdir()
        self.assertIn('cannot write to case_out/case_fields*', self.run_fault(name, '--quiet', expect=1).stderr)

    def test_energy_is_balanced(self):
        for text, allowed in ((SMALL, 1e-6), (PLANE, 1e-6), (HALF, 1e-6), (SUBLOADING, 1e-4)):
            self.assertIn('of the largest term', self.run_fault(self.write(text)).stdout)
            with open(self.place / 'case_out' / 'case_global.csv', newline='') as file:
                *_, last = csv.DictReader(file)
            loading, *others = (float(last[name]) for name in ('loading_work', 'elastic_energy', 'dissipated', 'radiated'))
            self.assertLess(abs(loading - sum(others)), allowed * loading)
            self.assertGreater(min(others), 1e-4 * loading if text not in (PLANE, HALF) else 0)

    def test_the_peak_of_an_event_is_found_within_steps(self):
        """Of steps' ends it was 0.7 % less than with the smaller `rtol`; now 0.03 % more."""
        peaks = []
        for rtol in ('3e-4', '1e-6'):
            self.run_fault(self.write(SMALL.replace('rtol = 1e-4', f'rtol = {rtol}')), '--quiet')
            event, = self.events('case_out', 'case')
            peaks.append(float(event['peak_slip_rate']))
        self.assertAlmostEqual(peaks[0] / peaks[1], 1.0, delta=1e-3)

    def test_the_last_row_is_the_last_state_however_a_run_ends(self):
        """Waves so fast that slip takes less than the time's round-off; Ctrl-C, twice."""
        tables = []
        for steps in (1, 10**6):
            text = SMALL.replace('3464', '1e12').replace('checkpoint', f'interval = {steps}, checkpoint')
            self.assertIn('no step is short enough', self.run_fault(self.write(text), '--quiet', expect=1).stderr)
            tables.append([list(self.rows(f'case_out/case_{table}.csv').values()) for table in ('global', 'station_1')])
        for all_rows, rows in zip(*tables):
            self.assertTrue(rows == [all_rows[0], all_rows[-1]])
        name = self.write(SMALL.replace('1.0e10', '1.0e13').replace('checkpoint', 'interval = 1000000000, checkpoint'))
        checkpoint, written = self.place / 'case_out' / 'case.checkpoint', 0
        checkpoint.unlink(missing_ok=True)
        times = [0.0]
        for more in ((), ('--resume',)):
            run = subprocess.Popen(self.command(1, name, '--quiet', *more), cwd=self.place, stderr=subprocess.DEVNULL)
            while not checkpoint.exists() or checkpoint.stat().st_mtime_ns == written:
                time.sleep(0.01)
            run.send_signal(signal.SIGINT)
            run.wait()
            written = checkpoint.stat().st_mtime_ns
            first, last = self.rows('case_out/case_global.csv')
            self.assertEqual(first, 0)
            times.append(last)
        self.assertEqual(times, sorted(set(times)))

    @needs_gnuplot
    def test_picture_is_drawn(self):
        for t_end in ('1.0e8', '1.0e9'):   # before the first contour, and after it
            name = self.write(SMALL.replace('1.0e10', t_end))
            done = subprocess.run([PROGRAM, 'fault', name, '--quiet'], cwd=self.place, check=True, capture_output=True, text=True)
            self.assertNotIn('gnuplot', done.stderr)
            self.assertGreater((self.place / 'case_out' / 'case.png').stat().st_size, 5000)

    @needs_gnuplot
    def test_picture_is_in_years_and_kilometres_where_units_are_told(self):
        for units, labels in (("length_unit = 'm', time_unit = 's', ", ('time [years]', 'depth [km]', 'slip [m]')),
                              ('', ('time [T]', 'depth [L]', 'slip [L]'))):
            name = self.write(SMALL.replace('1.0e10', '1.0e9').replace('stations', units + 'stations'))
            subprocess.run([PROGRAM, 'fault', name, '--quiet'], cwd=self.place, check=True, capture_output=True)
            picture = (self.place / 'case_out' / 'case.svg').read_text()
            for label in labels:
                self.assertIn(f'>{label}<', picture)


class Laws(FaultTest):
    def test_a_longer_run_begins_with_the_shorter_one(self):
        """Explicit and implicit steps: t_end has no say in steps before the last ones."""
        for text, ends in ((SMALL, (4e9, 8e9)), (SUBLOADING.replace('nz = 96', 'nz = 32'), (4e9, 6e9))):
            tables = []
            for end in ends:
                self.run_fault(self.write(text.replace('1.0e10', str(end)).replace('1.5e10', str(end))), '--quiet')
                tables.append([row for time, row in self.rows('case_out/case_global.csv').items() if time < 0.8 * ends[0]])
            self.assertGreater(len(tables[0]), 20)
            self.assertTrue(tables[0] == tables[1])

    def test_subloading_friction_gives_earthquakes(self):
        """The first one after 454 years, as an independent trial code has it with other steps (docs/fault.md)."""
        name = self.write(SUBLOADING)
        self.run_fault(name, '--output', 'whole', '--quiet')
        events = self.events('whole', 'case')
        self.assertEqual(len(events), 1)
        self.assertAlmostEqual(float(events[0]['onset']) / YEAR, 454, delta=4)
        self.assertGreater(float(events[0]['peak_slip_rate']), 0.1)
        self.kill_and_resume(name, 0.5, 1, 1)

    @release_only
    def test_later_subloading_events_follow_neither_rtol_nor_cells(self):
        """Steps that pass over the loss of stability begin events when rtol has it so."""
        onsets = []
        for nz, rtol in ((192, '1e-3'), (192, '1e-4'), (256, '1e-3')):   # 3.4 and 4.6 cells to the cohesive length
            text = SUBLOADING.replace('xi = 1e-9', 'xi = 3e-10').replace('1.5e10', '1.51e10')
            self.run_fault(self.write(text.replace('nz = 96', f'nz = {nz}').replace('2e-3', rtol)), '--quiet')
            onsets.append([float(event['onset']) / YEAR for event in self.events('case_out', 'case')])
        self.assertGreaterEqual(min(len(some) for some in onsets), 2)
        self.assertAlmostEqual(onsets[0][1], onsets[1][1], delta=0.01)
        self.assertAlmostEqual(onsets[0][1], onsets[2][1], delta=1.0)   # first order in the size of cells

    def test_implicit_steps_agree_with_explicit_ones(self):
        text = SMALL.replace('1.0e10', '3e9').replace('rtol = 1e-4', "rtol = 1e-3, scheme = 'implicit'")
        self.run_fault(self.write(text, 'implicit.nml'), '--quiet')
        self.run_fault(self.write(text.replace("'implicit'", "'explicit'"), 'explicit.nml'), '--quiet')
        last = {}
        for stem in ('implicit', 'explicit'):
            with open(self.place / f'{stem}_out' / f'{stem}_station_1.csv', newline='') as file:
                last[stem] = list(csv.DictReader(file))[-1]
        self.assertAlmostEqual(float(last['implicit']['slip']), float(last['explicit']['slip']), delta=0.01)
        self.assertAlmostEqual(float(last['implicit']['traction']) / 50e6, float(last['explicit']['traction']) / 50e6,
                               delta=1e-3)
        self.assertAlmostEqual(float(last['implicit']['log10_theta']), float(last['explicit']['log10_theta']), delta=0.01)

    def test_what_slides_under_a_cap_is_stepped_implicitly(self):
        """Steady sliding would take 31.7 MPa: under the cap the whole fault slides at the plate rate for ever."""
        for cap in ('10e6', '28e6'):   # below and above the traction of the start
            text = SMALL.replace('f0 = 0.6', f'f0 = 0.6, tau_max = {cap}').replace('1.0e10', '3.0e10')
            self.run_fault(self.write(text), '--quiet')
            *_, end = self.rows('case_out/case_station_2.csv').values()
            self.assertAlmostEqual(float(end['traction']) / float(cap), 1, delta=1e-12)
            self.assertAlmostEqual(float(end['log10_slip_rate']), -9, delta=1e-3)

    def test_flash_heating_weakens_what_slips_fast_and_nothing_else(self):
        text = SMALL.replace('d_c = 0.032', 'd_c = 0.132').replace('1.0e10', '1.2e10')
        law = "law = 'rate_and_state'"
        events = {}
        for stem, other in (('plain', law + ", evolution = 'slip'"), ('cold', "law = 'flash_heating', f_w = 0.2, v_w = 1e9"),
                            ('hot', "law = 'flash_heating', f_w = 0.2, v_w = 0.1")):
            self.run_fault(self.write(text.replace(law, other), f'{stem}.nml'), '--quiet')
            events[stem] = self.events(f'{stem}_out', stem)
        self.assertEqual(len(events['cold']), len(events['plain']))
        for cold, plain in zip(events['cold'], events['plain']):
            self.assertAlmostEqual(float(cold['onset']), float(plain['onset']), delta=1.0)
            self.assertAlmostEqual(float(cold['largest_slip']), float(plain['largest_slip']), delta=1e-5)
        slips = {stem: max(float(event['largest_slip']) for event in events[stem]) for stem in events}
        self.assertGreater(slips['hot'], 4 * slips['cold'])

    def test_linker_dieterich_friction_is_rate_and_state_under_a_constant_normal_traction(self):
        """One that changes with depth, from 1 MPa at the surface on, but not with time; explicit and implicit."""
        (self.place / 'n.csv').write_text('z,normal_traction\n0,1e6\n2e3,50e6\n')
        text = SMALL.replace('normal_traction = 50e6', "normal_traction = '@n.csv'")
        law = "law = 'linker_dieterich', alpha = 0.3"
        early = text.replace("law = 'rate_and_state'", law).replace('1.0e10, rtol = 1e-4', '1.0e9, rtol = 1e-3')
        for stem, case in (('plain', text), ('explicit', text.replace("law = 'rate_and_state'", law)), ('early', early),
                           ('implicit', early.replace('rtol = 1e-3', "rtol = 1e-3, scheme = 'implicit'"))):
            self.run_fault(self.write(case, f'{stem}.nml'), '--quiet')
        *_, plain = self.rows('plain_out/plain_station_2.csv').values()
        *_, other = self.rows('explicit_out/explicit_station_2.csv').values()
        for name in ('slip', 'traction', 'log10_theta'):   # round-off grows in the course of an event
            self.assertAlmostEqual(float(other[name]) / float(plain[name]), 1, delta=1e-6)
        *_, implicit = self.rows('implicit_out/implicit_station_2.csv').values()
        *_, explicit = self.rows('early_out/early_station_2.csv').values()
        self.assertAlmostEqual(float(implicit['slip']), float(explicit['slip']), delta=0.01)
        self.assertAlmostEqual(float(implicit['traction']) / 50e6, float(explicit['traction']) / 50e6, delta=1e-3)

    def test_slip_weakening_that_heals_gives_earthquakes_and_balances_energy(self):
        text = self.with_law("law = 'slip_weakening_healing', mu_s = 0.6, mu_k = '@a.csv', d_c = 0.3, xi = 3e-10")
        self.run_fault(self.write(text), '--quiet')
        self.assertGreater(max(float(event['peak_slip_rate']) for event in self.events('case_out', 'case')), 0.5)
        *_, end = self.rows('case_out/case_global.csv').values()
        loading, *others = (float(end[name]) for name in ('loading_work', 'elastic_energy', 'dissipated', 'radiated'))
        self.assertLess(abs(loading - sum(others)), 1e-3 * loading)

    def test_an_earthquake_is_not_stepped_over(self):
        """A cell under a stiffer neighbour that does not slip: its onset, and its slip until the traction is back at mu_k, in closed
        form. Before and after it the cell sticks, so that both ends of a long step are stable."""
        self.write('z,mu_s,traction\n500,0.59,22.68e6\n1500,0.9,22.68e6\n', 'cells.csv')

        def effect(distance):
            return 30e9 / (2 * math.pi * 1e3) * (1 / (distance - 0.5) - 1 / (distance + 0.5))

        own = effect(0) + effect(1)
        onset = (0.59 * 50e6 - 22.68e6) / -(own + effect(1) + effect(2)) / 1e-9
        for law, off in (("'slip_weakening', d_c = 0.1", 1e-6), ("'slip_weakening_healing', d_c = 0.1, xi = 1e-14", 1e-6),
                         ("'subloading', kappa = 40, xi = 0, m = 1e6", 1e-3)):   # which slips a little before
            for rtol in ('1e-3', '1e-5'):
                self.run_fault(self.write(f"""
&fault geometry = 'antiplane_half', width = 2000, nz = 2, shear_modulus = 30e9, wave_speed = 3000, plate_rate = 1e-9,
       normal_traction = 50e6, initial = 'file', initial_file = 'cells.csv' /
&friction law = {law}, mu_s = '@cells.csv', mu_k = 0.55 /
&time t_end = {1.1 * onset}, rtol = {rtol} /
"""), '--quiet', '--no-plot')
                events = self.events('case_out', 'case')
                self.assertEqual(len(events), 1, law)
                self.assertAlmostEqual(float(events[0]['onset']) / onset, 1.0, delta=off, msg=law)
                self.assertAlmostEqual(float(events[0]['largest_slip']), 0.04 * 50e6 / -own, delta=0.02 * 0.157, msg=law)

    def test_slip_and_duration_of_an_event_are_those_between_its_ends(self):
        """The cell of above, whose slip rate is closed in its slip: growing while it weakens, falling at mu_k. Ends lie within steps."""
        self.write('z,mu_s,traction\n500,0.59,29.4999e6\n1500,0.9,29.4999e6\n', 'cells.csv')
        damping, own = 30e9 / 6e3, 30e9 / (2 * math.pi * 1e3) * (4 - (2 - 2 / 3))
        for rtol, off in (('3e-3', 3e-3), ('1e-4', 1e-3)):
            self.run_fault(self.write(f"""
&fault geometry = 'antiplane_half', width = 2000, nz = 2, shear_modulus = 30e9, wave_speed = 3000, plate_rate = 1e-9,
       normal_traction = 50e6, initial = 'file', initial_file = 'cells.csv' /
&friction law = 'slip_weakening', d_c = 0.1, mu_s = '@cells.csv', mu_k = 0.55 /
&time t_end = 1e5, rtol = {rtol} /
&output seismic_rate = 0.05 /
"""), '--quiet')
            event, = self.events('case_out', 'case')
            slip = 2e6 / own - damping * 0.05 * (1 / own + 1 / (2e7 - own))
            duration = damping * (1 / own + 1 / (2e7 - own)) * math.log((2e7 - own) * 0.1 / damping / 0.05)
            self.assertAlmostEqual(float(event['duration']), duration, delta=off * duration, msg=rtol)
            self.assertAlmostEqual(float(event['largest_slip']), slip, delta=off * slip, msg=rtol)
            self.assertAlmostEqual(float(event['potency']), 1e3 * slip, delta=1e3 * off * slip, msg=rtol)

    def test_cells_about_to_slip_do_not_shorten_steps(self):
        """No event: 371 steps. The balance of cells that stick was not followed beside those that slip, and they slipped and stuck in
        turns while it was looked for: 26 645 steps, and with `rtol` of 1e-6 no end."""
        self.write('z,mu_k,traction\n320,0.54,9e6\n1240,0.62,9e6\n', 'cells.csv')
        for rtol in ('1e-5', '1e-6'):
            self.run_fault(self.write(f"""
&fault geometry = 'whole', width = 1500, nz = 5, length = 1100, nx = 3, shear_modulus = 52e9, wave_speed = 3000, plate_rate = 6e-9,
       normal_traction = 42e6, initial = 'file', initial_file = 'cells.csv' /
&friction law = 'slip_weakening_healing', mu_s = 0.67, mu_k = '@cells.csv', d_c = 0.066, xi = 1e-7 /
&time t_end = 8e7, rtol = {rtol} /
"""), '--quiet')
            self.assertLess(len(self.rows('case_out/case_global.csv')), 2000, rtol)

    def with_law(self, law):
        first, last = SUBLOADING.index('law ='), SUBLOADING.index("'exact_rate'") + len("'exact_rate'")
        return (SUBLOADING[:first] + law + SUBLOADING[last:]).replace('nz = 96', 'nz = 64')

    def test_laws_that_cannot_are_refused_with_the_reason(self):
        static_kinetic = "law = 'static_kinetic', mu_s = 0.6, mu_k = '@a.csv', d_c = 1e6"
        self.assertIn('falls with the slip rate alone', self.run_fault(self.write(self.with_law(static_kinetic)), expect=2).stderr)
        constant = self.with_law("law = 'static_kinetic', mu_s = 0.6, mu_k = 0.6, d_c = 1e6").replace('1.5e10', '1e8')
        self.run_fault(self.write(constant), '--quiet')
        explicit = SUBLOADING.replace('2e-3', "2e-3, scheme = 'explicit'")
        self.assertIn('needs a law that gives the slip rate', self.run_fault(self.write(explicit), expect=2).stderr)

    def test_a_law_that_is_refused_is_the_only_fault(self):
        text = SUBLOADING.replace("kappa = 10, ", '')
        stderr = self.run_fault(self.write(text), expect=2).stderr
        self.assertIn('&friction kappa: is missing', stderr)
        self.assertNotIn('slip_rate', stderr)

    def test_constant_friction_slides_at_the_plate_rate(self):
        text = SMALL.replace("law = 'rate_and_state', a = '@a.csv', b = 0.015, d_c = 0.032, v0 = 1e-6, f0 = 0.6",
                             "law = 'coulomb', mu = 0.6")
        self.run_fault(self.write(text), '--quiet')
        with open(self.place / 'case_out' / 'case_station_2.csv', newline='') as file:
            last = list(csv.DictReader(file))[-1]
        self.assertAlmostEqual(float(last['slip']), 1e-9 * 1.0e10, delta=1e-6)
        self.assertAlmostEqual(float(last['traction']), 30e6, delta=1)

    def test_constant_friction_that_differs_slides_in_steps(self):
        """Cells begin to slide one after the other: a step over all of that has a right end, and no history."""
        (self.place / 'start.csv').write_text('z,mu,traction\n0,0.35,14e6\n40e3,0.3,14e6\n')
        text = self.with_law("law = 'coulomb', mu = '@start.csv'").replace("'a.csv'", "'start.csv'")
        self.run_fault(self.write(text), '--quiet')
        rows = list(self.rows('case_out/case_global.csv').values())
        self.assertGreater(len(rows), 30)
        loading, *others = (float(rows[-1][name]) for name in ('loading_work', 'elastic_energy', 'dissipated', 'radiated'))
        self.assertLess(abs(loading - sum(others)), 1e-3 * loading)

    def start(self, traction, slip_rate):
        (self.place / 'start.csv').write_text(f'z,traction,slip_rate\n0,{traction},{slip_rate}\n')
        return SMALL.replace('= 50e6', "= 50e6, initial = 'file', initial_file = 'start.csv'").replace('1.0e10', '1.0e7')

    def test_a_run_may_start_in_an_event(self):
        """Friction that strengthens: the slip rate falls from the start on."""
        name = self.write(self.start('30.9e6', 0.03).replace('b = 0.015', 'b = 0.008'))
        self.run_fault(name, '--quiet')
        event, = self.events('case_out', 'case')
        self.assertEqual(float(event['onset']), 0)
        self.assertAlmostEqual(float(event['peak_slip_rate']), 0.03, delta=1e-15)
        first, *rows = self.rows('case_out/case_station_1.csv').values()
        slip = next(float(row['slip']) for row in rows if float(row['time']) >= float(event['duration']))
        self.assertAlmostEqual(float(event['largest_slip']) / slip, 1, delta=0.2)

    def test_an_event_under_way_at_the_end_is_a_warning(self):
        name = self.write(self.start('30.9e6', 0.03).replace('1.0e7', '1.0'))
        self.assertIn('still in progress at t_end', self.run_fault(name, '--quiet').stderr)
        self.assertEqual(self.events('case_out', 'case'), [])

    def test_a_start_far_from_steady_sliding_has_its_slip_rate(self):
        """A traction that would drive what has slid steadily beyond all that is counted: e^94 s of age hold it."""
        self.run_fault(self.write(self.start('80e6', 4e-10).replace('b = 0.015', 'b = 0.012')), '--quiet')
        first, *_ = self.rows('case_out/case_station_1.csv').values()
        self.assertAlmostEqual(float(first['log10_slip_rate']), math.log10(4e-10), delta=1e-9)
        self.assertAlmostEqual(float(first['traction']), 80e6, delta=1)

    def test_a_start_above_the_cap_is_refused_with_its_place(self):
        text = self.start('30e6', 1e-9).replace('f0 = 0.6', 'f0 = 0.6, tau_max = 29e6')
        for processes in (1, 3) if MPIRUN else (1,):
            told = self.run_fault(self.write(text), expect=1, processes=processes).stderr
            self.assertIn('z = 312.500, under a traction of 3.00000E+07 and at a slip rate of 1.00000E-09: the traction must '
                          'not exceed tau_max = 2.90000E+07', told)
        (self.place / 'a.csv').write_text(A.replace('22.5e6', '22.6e6'))
        told = self.run_fault(self.write(SUBLOADING.replace('m = ', 'tau_max = 22e6, m = ')), expect=1).stderr
        self.assertIn('the traction must not exceed tau_max = 2.20000E+07', told)

    def test_a_start_beyond_the_strength_is_refused(self):
        (self.place / 'a.csv').write_text(A.replace('22.5e6', '40e6'))
        told = self.run_fault(self.write(SUBLOADING), expect=1).stderr
        self.assertIn('at the start, at x = 0.00000, z = 208.333, under a traction of 4.00000E+07', told)
        self.assertIn('the traction exceeds the strength', told)


class Input(FaultTest):
    def faults(self, text):
        done = self.run_fault(self.write(text), expect=2)
        self.assertFalse((self.place / 'case_out').exists())
        checked = subprocess.run([PROGRAM, 'check', 'case.nml'], cwd=self.place, capture_output=True, text=True)
        self.assertEqual(checked.stderr, done.stderr)
        return done.stderr

    def test_all_faults_are_told_at_once(self):
        text = self.faults(SMALL.replace('nz = 64', 'nz = 1, nx = 3').replace('b = 0.015', 'b = -1')
                           .replace('rtol', 'tol'))
        for part in ('&fault nz = 1: must be from 2', '&fault nx', '&friction b = -1: must be >= 0', '&time tol'):
            self.assertIn(part, text)

    def test_files_that_do_not_fit_are_faults(self):
        self.assertIn('no_such.csv', self.faults(SMALL.replace('@a.csv', '@no_such.csv')))
        (self.place / 'b.csv').write_text('x,z,a\n0,0,0.010\n')
        self.assertIn("no column 'b'", self.faults(SMALL.replace('b = 0.015', "b = '@b.csv'")))
        (self.place / 'a.csv').write_text('z,a\n0,0.010\n15e3,-0.010\n')
        self.assertIn('a = -', self.faults(SMALL))
        for rows in ('0,0,0.010\n1e3,15e3,0.010\n', '0,0,0.010\n0,15e3,0.010\n1e3,0,0.010\n1e3,0,0.010\n'):
            (self.place / 'a.csv').write_text('x,z,a\n' + rows)
            self.assertIn('each node of a grid once', self.faults(SMALL))

    def test_values_out_of_place_are_faults(self):
        self.assertIn('must be from 0 to width', self.faults(SMALL.replace('stations = 0', 'stations = 50e3')))
        self.assertIn("law = 'rate_and_state'", self.faults(
            SMALL.replace("law = 'rate_and_state', a = '@a.csv', b = 0.015, d_c = 0.032, v0 = 1e-6, f0 = 0.6",
                          "law = 'coulomb', mu = 0.6").replace('rtol = 1e-4', "rtol = 1e-4, scheme = 'explicit'")))
        self.assertIn('two values', self.faults(SMALL.replace('3e8, 10', '3e8')))
        self.assertIn('at least 1e-12 of t_end', self.faults(SMALL.replace('3e8, 10', '3e8, 1e-3')))
        self.assertIn('GB, more than table_limit', self.faults(SMALL.replace('3e8, 10', '1, 10')))

    def test_faults_that_follow_from_others_are_not_told(self):
        for old, new, told in (('width = 40e3', 'width = 0', '&fault width = 0: must be > 0'),
                               ('nz = 64', 'nz = 0', '&fault nz = 0: must be from 2'),
                               ('shear_modulus = 32.04e9', "shear_modulus = 'a'", "shear_modulus = 'a': must be a number"),
                               ('plate_rate = 1e-9', 'plate_rate = -1', "plate_rate = -1: must be > 0 with initial = 'steady'"),
                               ('normal_traction = 50e6', 'normal_traction = -1', 'normal_traction = -1: must be > 0')):
            stderr = self.faults(SMALL.replace(old, new))
            self.assertIn(told, stderr)
            self.assertEqual(stderr.count('\n'), 1, stderr)

    def test_keys_without_effect_are_faults(self):
        self.assertIn("belongs to geometry = 'antiplane_half'", self.faults(
            PLANE.replace('fields = 5', 'slip_contours = 3e8, 10')))
        for key in ('theta_0 = 1', 'mu_ratio = 0.5', 'eta_t = 1e6'):
            self.assertIn('has no effect on', self.faults(SMALL.replace('f0 = 0.6', 'f0 = 0.6, ' + key)))

    def test_the_initial_file_is_looked_for_whatever_else_is_wrong(self):
        text = SMALL.replace('= 50e6', "= 50e6, initial = 'file', initial_file = 'no_such.csv'").replace('b = 0.015', 'b = -1')
        stderr = self.faults(text)
        for part in ('&friction b = -1', 'no_such.csv'):
            self.assertIn(part, stderr)
        self.assertNotIn('unknown key', stderr)
        (self.place / 'start.csv').write_text('z,traction,slip_rate\n0,0,1e-9\n')
        self.assertIn('traction must be > 0', self.faults(SMALL.replace(
            '= 50e6', "= 50e6, initial = 'file', initial_file = 'start.csv'")))

    def test_cells_too_large_are_a_warning(self):
        text = self.run_fault(self.write(SMALL.replace('1.0e10', '1.0e6').replace('0.032', '0.008'))).stderr
        self.assertIn('do not resolve the cohesive length', text)
        self.assertNotIn('cohesive', self.run_fault(self.write(SMALL.replace('1.0e10', '1.0e6').replace(
            '0.032', '0.08'))).stderr)


class NetCDF(FaultTest):
    """Profiles as NetCDF files, made by the library's own ncgen."""
    VALUES = {(x, z): 0.007 + 1e-4 * i for i, (x, z) in enumerate((x, z) for x in (-30e3, 0, 30e3) for z in (0, 15e3, 40e3))}
    TEXT = PLANE.replace('a = 0.007', "a = '@a.csv'")

    def setUp(self):
        super().setUp()
        if shutil.which('ncgen') is None:
            self.skipTest('no ncgen (Debian: netcdf-bin)')
        self.make('a', 'dimensions: z = 2; variables: double z(z); data: z = 0, 1;')
        told = self.run_fault(self.write(SMALL.replace('@a.csv', '@a.nc')), expect=2).stderr
        if 'built without NetCDF' in told:
            self.skipTest('built without NetCDF, as it says')

    def make(self, stem, text, kind='nc3'):
        (self.place / 'text.cdl').write_text(f'netcdf {stem} {{ {text} }}')
        subprocess.run(['ncgen', '-k', kind, '-o', f'{stem}.nc', 'text.cdl'], cwd=self.place, check=True)

    def test_the_same_numbers_give_the_same_files_as_a_table(self):
        places = sorted(self.VALUES)
        (self.place / 'a.csv').write_text('x,z,a\n' + ''.join(f'{x},{z},{self.VALUES[x, z]!r}\n' for x, z in places))
        self.run_fault(self.write(self.TEXT), '--quiet', '--output', 'table')
        xs, zs = sorted({x for x, _ in places}), sorted({z for _, z in places}, reverse=True)

        def listed(numbers):
            return ', '.join(map(repr, numbers)) + '; '

        axes = f'x = {listed(xs)} z = {listed(zs)} '
        by_rows = listed(self.VALUES[x, z] for z in zs for x in xs)
        by_columns = listed(self.VALUES[x, z] for x in xs for z in zs)
        nodes = f'x = {listed(x for x, _ in places)} z = {listed(z for _, z in places)} a = {listed(self.VALUES[p] for p in places)}'
        grid = 'dimensions: time = 1; x = 3; z = 3; variables: double x(x); double z(z); double a'
        for kind, text in (('nc3', f'{grid}(z, x); data: {axes} a = {by_rows}'), ('nc4', f'{grid}(x, z); data: {axes} a = {by_columns}'),
                           ('nc6', f'{grid}(time, z, x); data: {axes} a = {by_rows}'),
                           ('nc7', f'dimensions: n = 9; variables: double x(n); double z(n); double a(n); data: {nodes}')):
            self.make('a', text, kind)
            self.run_fault(self.write(self.TEXT.replace('a.csv', 'a.nc')), '--quiet', '--output', kind)
            self.assert_same_files('table', kind)
        whole = [round(1e4 * self.VALUES[x, z]) for z in zs for x in xs]   # packed as CF has it; 1e-4 is not exact
        self.make('a', f'{grid.replace("double a", "short a")}(z, x); a:scale_factor = 1e-4; a:add_offset = 0.; data: {axes} a = {listed(whole)}')
        self.run_fault(self.write(self.TEXT.replace('a.csv', 'a.nc')), '--quiet', '--output', 'packed')
        last = {name: list(self.rows(f'{name}/case_station_1.csv').values())[-1] for name in ('table', 'packed')}
        self.assertAlmostEqual(float(last['packed']['slip']), float(last['table']['slip']), delta=1e-12)

    def test_what_does_not_fit_is_told_by_both_verbs(self):
        for text, told in (('dimensions: z = 3; variables: double z(z); double a(z); data: z = 0, 1, 2; a = 1, _, NaN;',
                            "variable 'a' has no number at 2 of its places, first at number 2"),
                           ('dimensions: z = 3; variables: double z(z); char a(z); data: z = 0, 1, 2;', "variable 'a' holds no numbers"),
                           ('dimensions: z = 3; variables: double z(z); data: z = 0, 1, 2;', "its file has no column 'a'"),
                           ('dimensions: z = 3; variables: double a(z); data: a = 0, 1, 2;', "its file has no column 'z'"),
                           ('dimensions: z = 2; y = 2; variables: double z(z); double a(y); data: z = 0, 1; a = 1, 2;', 'each node of a grid once'),
                           ('dimensions: z = 2; y = 2; x = 2; variables: double z(z); double a(y, x); data: z = 0, 1;', '3 dimensions'),
                           ('dimensions: z = 2; variables: double z(z); double a(z); a:scale_factor = -1.; data: z = 0, 1; a = 1, 2;',
                            'a = -1.0')):
            self.make('a', text)
            name = self.write(SMALL.replace('@a.csv', '@a.nc'))
            done = self.run_fault(name, expect=2)
            self.assertIn(told, done.stderr)
            if 'no column' in told:
                self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)   # and nothing that follows from it
            checked = subprocess.run([PROGRAM, 'check', name], cwd=self.place, capture_output=True, text=True)
            self.assertEqual((checked.returncode, checked.stderr), (2, done.stderr))
        (self.place / 'a.nc').write_text(A)
        self.assertIn('cannot be read as NetCDF', self.run_fault(name, expect=2).stderr)
        (self.place / 'a.nc').unlink()
        self.assertIn('no such file', self.run_fault(name, expect=2).stderr)


class Absent(unittest.TestCase):
    def test_without_the_engine_the_program_says_what_to_install(self):
        with tempfile.TemporaryDirectory() as place:
            alone = pathlib.Path(place) / 'stickslip'
            shutil.copy(PROGRAM, alone)
            done = subprocess.run([alone, 'fault', INPUTS / 'fault_bp1.nml'], capture_output=True, text=True)
            self.assertEqual(done.returncode, 1)
            self.assertIn('libfftw3-dev', done.stderr)
            checked = subprocess.run([alone, 'check', INPUTS / 'fault_bp1.nml'], capture_output=True, text=True)
            self.assertEqual(checked.returncode, 0, checked.stderr)
            (pathlib.Path(place) / 'case.nml').write_text(SMALL.replace('a.csv', 'a.nc'))
            checked = subprocess.run([alone, 'check', 'case.nml'], cwd=place, capture_output=True, text=True)
            self.assertEqual(checked.returncode, 2)
            self.assertIn("a = '@a.nc': is a NetCDF file, which the fault engine alone reads", checked.stderr)


if __name__ == '__main__':
    unittest.main()
