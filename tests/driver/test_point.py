"""The point mode as a user runs it: one contact point along a prescribed path.

STICKSLIP names the program.
"""
import csv
import os
import pathlib
import shutil
import signal
import subprocess
import tempfile
import time
import unittest

from drawing import needs_gnuplot

PROGRAM = os.environ['STICKSLIP']
INPUTS = pathlib.Path(__file__).resolve().parents[2] / 'inputs'
FRICTION = ("&friction law='subloading', alpha_n=1000, alpha_t=2000, mu_s=0.4, mu_k=0.2, kappa=10,"
            " xi=0.1, m=1000 /\n")
PRESS_AND_SHEAR = {'ndir': '2', 'control_n': "'traction'", 'duration': '1, 1', 'steps': '1, 100',
                   'target_n': '-10', 'target_t1': '0, 0.1'}


def namelist(changes=(), without=()):
    """A point pressed with 10 and then sheared by 0.1, with keys changed or left out."""
    keys = {**PRESS_AND_SHEAR, **dict(changes)}
    for key in without:
        del keys[key]
    return FRICTION + '&point\n' + ''.join(f'  {key} = {value}\n' for key, value in keys.items()) + '/\n'


class Point(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)

    def run_program(self, *arguments):
        return subprocess.run([PROGRAM, *map(str, arguments)], cwd=self.folder, text=True,
                              capture_output=True, timeout=120, check=False)

    def run_text(self, text, *arguments, verb='point'):
        (self.folder / 'case.nml').write_text(text)
        return self.run_program(verb, 'case.nml', *arguments)

    def rows(self, name='case_out/case.csv'):
        with open(self.folder / name, newline='', encoding='utf-8') as file:
            return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]

    def followed(self, text):
        """The rows of a path that is followed to its end."""
        result = self.run_text(text, '--no-plot')
        self.assertEqual((result.returncode, result.stderr), (0, ''))
        return self.rows()

    def refused(self, text, *said):
        """The input is refused with exit status 2, and the message says all these things."""
        for verb in ('check', 'point'):
            result = self.run_text(text, verb=verb)
            self.assertEqual(result.returncode, 2, result.stderr)
            for part in said:
                self.assertIn(part, result.stderr)
            self.assertIn('case.nml', result.stderr)
            self.assertEqual(result.stdout, '')
            self.assertFalse((self.folder / 'case_out').exists())


class GoodInput(Point):
    def test_point_leaves_the_promised_files(self):
        rows = self.followed(namelist())
        self.assertEqual(','.join(rows[0]),
                         'time,u_n,u_t1,t_n,t_t1,status,mu,R,slip,dissipation,iterations')
        self.assertEqual(len(rows), 102)
        self.assertEqual(list(rows[0].values()), [0, 0, 0, 0, 0, 3, 0.4, 0, 0, 0, 0])
        self.assertEqual((rows[1]['time'], rows[-1]['time'], rows[-1]['u_t1']), (1, 2, 0.1))
        self.assertFalse((self.folder / 'case_out/case.png').exists())

    def test_three_directions_and_the_tangent_have_their_columns(self):
        rows = self.followed(namelist({'ndir': '3', 'tangent': '.true.', 'target_t2': '0, 0.05'}))
        self.assertEqual(','.join(rows[0]), 'time,u_n,u_t1,u_t2,t_n,t_t1,t_t2,status,mu,R,slip,'
                         'dissipation,iterations,d11,d21,d31,d12,d22,d32,d13,d23,d33')
        last = rows[-1]
        self.assertEqual(last['d11'], 1000)
        self.assertAlmostEqual(last['t_t1'], 2 * last['t_t2'], delta=1e-12)
        # sliding: friction follows the pressure, -(d_t1 + d_t2) is about the friction coefficient
        self.assertAlmostEqual((last['d21']**2 + last['d31']**2)**0.5, last['R'] * last['mu'] * 1000,
                               delta=1.0)
        self.assertLess(last['d21'], 0)

    def test_stick_has_the_slope_of_the_contact_spring(self):
        # out, and a little back: elastic
        rows = self.followed(namelist({'duration': '1, 1, 1', 'steps': '1, 100, 10',
                                       'target_t1': '0, 0.1, 0.099'}))
        for before, after in zip(rows[101:], rows[102:]):
            self.assertEqual(after['status'], 1)
            self.assertAlmostEqual((after['t_t1'] - before['t_t1']) / (after['u_t1'] - before['u_t1']),
                                   2000, delta=1e-6)

    def test_long_sliding_settles_at_the_closed_form(self):
        rows = self.followed(namelist({'duration': '1, 100', 'steps': '1, 4000', 'target_t1': '0, 20'}))
        speed = 0.2
        steady = (10 * speed * 0.2 + 0.1 * 0.4) / (10 * speed + 0.1)
        self.assertAlmostEqual(rows[-1]['mu'], steady, delta=1e-9)
        self.assertAlmostEqual(rows[-1]['t_t1'], 10 * steady, delta=1e-8)

    def test_orthotropic_sliding_settles_at_the_closed_form(self):
        speed, ratio = (0.16, 0.12), 0.5
        steady = 10 * (10 * 0.2 * 0.2 + 0.1 * 0.4) / (10 * 0.2 + 0.1)
        for direction, expected in (('associated', (speed[0], ratio**2 * speed[1])), ('radial', speed)):
            text = namelist({'ndir': '3', 'duration': '1, 100', 'steps': '1, 4000', 'target_t1': '0, 16',
                             'target_t2': '0, 12'})
            last = self.followed(text.replace(' m=', f" mu_ratio={ratio}, direction='{direction}', m="))[-1]
            scale = steady / (expected[0]**2 + (expected[1] / ratio)**2)**0.5
            for key, component in zip(('t_t1', 't_t2'), expected):
                self.assertAlmostEqual(last[key], scale * component, delta=1e-8)

    def test_hold_heals_as_the_closed_form_says(self):
        rows = self.followed(namelist({'duration': '1, 0.1, 5', 'steps': '1, 100, 2000',
                                       'target_t1': '0, 0.1, 0.1'}))
        start, end = rows[101], rows[-1]
        self.assertAlmostEqual(end['mu'], 0.4 - (0.4 - start['mu']) * 2.718281828459045**-0.5,
                               delta=1e-4)   # first order: 0.1*0.5*dt*xi/2

    def test_prescribed_tractions_are_reached(self):
        rows = self.followed(namelist({'control_t1': "'traction'", 'target_t1': '0, 3.5'}))
        for k, row in enumerate(rows[1:]):
            self.assertAlmostEqual(row['t_n'], -10, delta=1e-9)
            self.assertAlmostEqual(row['t_t1'], 0.035 * k, delta=1e-10 * 10)
        self.assertGreater(rows[-1]['slip'], 1e-3)
        self.assertGreater(max(row['iterations'] for row in rows), 0)

    def test_mixed_run_equals_its_dual_under_displacements(self):
        mixed = self.followed((INPUTS / 'point_mixed.nml').read_text())
        names = ('time', 'u_n', 'u_t1', 'u_t2')
        with open(self.folder / 'dual.csv', 'w', newline='', encoding='utf-8') as file:
            writer = csv.writer(file)
            writer.writerow(names)
            writer.writerows([repr(row[name]) for name in names] for row in mixed)
        friction = (INPUTS / 'point_mixed.nml').read_text().split('&point')[0]
        dual = self.followed(friction + "&point file='dual.csv' /\n")
        self.assertEqual(len(dual), len(mixed))
        for a, b in zip(mixed, dual):
            self.assertEqual(b['iterations'], 0)
            for name in ('t_n', 't_t1', 't_t2', 'mu', 'R', 'slip', 'dissipation'):
                self.assertAlmostEqual(a[name], b[name], delta=1e-10)

    def test_cycles_repeat_the_segments_and_time_goes_on(self):
        rows = self.followed(namelist({'duration': '1, 1, 2, 1', 'steps': '1, 20, 40, 20', 'cycles': '3',
                                       'target_t1': '0, 0.1, -0.1, 0'}))
        self.assertEqual(len(rows), 3 * 81 + 1)
        self.assertEqual(rows[-1]['time'], 15)
        self.assertEqual(rows[81 + 21]['u_t1'], 0.1)
        self.assertEqual([a['time'] < b['time'] for a, b in zip(rows, rows[1:])], [True] * 243)

    def test_path_from_a_file_is_the_same_path(self):
        listed = self.followed(namelist())
        (self.folder / 'path.csv').write_text('t_n, u_t1, time\n\n-10, 0, 1\r\n-10,0.1,2')
        result = self.run_text(FRICTION + "&point ndir=2 file='path.csv' substeps=100 /", '--no-plot')
        self.assertEqual((result.returncode, result.stderr), (0, ''))
        self.assertEqual({k: v for k, v in self.rows()[-1].items() if k != 'iterations'},
                         {k: v for k, v in listed[-1].items() if k != 'iterations'})

    def test_columns_of_a_measured_path_are_chosen_by_keys(self):
        # a rig records displacements and forces, in its own units, from any time on; compression is positive
        keys = "t_n_column='Load', t_n_factor=-0.1, u_t1_column='Shear', u_t1_factor=1e-3, time_factor=0.5"
        (self.folder / 'path.csv').write_text('Time [s];Load [N];Shear [um];u_n;t_t1\ns;N;um;mm;MPa\n'
                                              '100;0,0;0;7;7\n102;100;0;7;7\n104;100;100;7;7\n')
        result = self.run_text(FRICTION + f"&point ndir=2 file='path.csv' substeps=100 {keys} /", '--no-plot')
        self.assertEqual((result.returncode, result.stderr), (0, ''))
        measured = self.rows()[-1]
        listed = self.followed(namelist())[-1]
        for key in ('time', 'u_n', 'u_t1', 't_n', 't_t1', 'mu', 'slip'):
            self.assertAlmostEqual(measured[key], listed[key], delta=1e-12)

    def test_file_is_looked_for_beside_the_namelist(self):
        (self.folder / 'deep').mkdir()
        (self.folder / 'deep/path.csv').write_text('time,u_n,u_t1\n0,0,0\n1,-0.01,0\n')
        (self.folder / 'deep/a.nml').write_text(FRICTION + "&point ndir=2, file='path.csv' /\n")
        result = self.run_program('point', 'deep/a.nml', '--no-plot', '--quiet', '--output', 'there')
        self.assertEqual((result.returncode, result.stdout, result.stderr), (0, '', ''))
        self.assertEqual([row['t_n'] for row in self.rows('there/a.csv')], [0, -10])

    def test_summary_balances_the_energy(self):
        coarse, fine = [], []
        for steps, unbalanced in (('1, 100', coarse), ('1, 1000', fine)):
            result = self.run_text(namelist({'steps': steps}), '--no-plot')
            for line in result.stdout.splitlines():
                if line.split()[0] in ('work', 'stored', 'dissipated', 'unbalanced'):
                    unbalanced.append(float(line.split()[1]))
        self.assertAlmostEqual(coarse[0], sum(coarse[1:]), delta=1e-6)
        self.assertLess(abs(fine[3]), 0.15 * abs(coarse[3]))   # first order
        self.assertLess(abs(fine[3]), 1e-3 * fine[0])

    @needs_gnuplot
    def test_picture_is_drawn_with_its_script_beside_it(self):
        result = self.run_text(namelist())
        self.assertEqual((result.returncode, result.stderr), (0, ''))
        self.assertEqual((self.folder / 'case_out/case.png').read_bytes()[:4], b'\x89PNG')
        self.assertTrue((self.folder / 'case_out/case.gp').exists())

    def test_check_counts_the_increments_and_runs_nothing(self):
        result = self.run_text(namelist({'cycles': '2'}), verb='check')
        self.assertEqual((result.returncode, result.stderr), (0, ''))
        self.assertEqual(result.stdout, 'case.nml: valid, 202 increments, for stickslip point\n')
        self.assertFalse((self.folder / 'case_out').exists())

    def test_shipped_inputs_run_to_their_ends(self):
        for path in sorted(INPUTS.glob('point_*.nml')):
            result = self.run_program('point', path, '--no-plot')
            self.assertEqual((result.returncode, result.stderr), (0, ''), path)


class FailedRun(Point):
    def failed(self, text, *said):
        result = self.run_text(text, '--no-plot')
        self.assertEqual(result.returncode, 1)
        for part in said:
            self.assertIn(part, result.stderr)
        return self.rows()

    def test_traction_beyond_the_strength_keeps_the_rows_up_to_it(self):
        rows = self.failed(namelist({'control_t1': "'traction'", 'target_t1': '0, 8'}),
                           'the run failed at time  1.4', 'gives way')
        self.assertGreater(len(rows), 40)
        last = rows[-1]
        self.assertGreater(last['t_t1'], 0.98 * last['mu'] * 10)
        self.assertLess(last['t_t1'], last['mu'] * 10)
        self.assertAlmostEqual(last['t_t1'], 8 * (last['time'] - 1), delta=1e-9)

    def test_an_interrupt_leaves_whole_rows_and_says_so(self):
        (self.folder / 'case.nml').write_text(namelist({'steps': '1, 20000000'}))
        with subprocess.Popen([PROGRAM, 'point', 'case.nml', '--no-plot'], cwd=self.folder, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
            table = self.folder / 'case_out/case.csv'
            while not (table.exists() and table.stat().st_size > 20000):
                self.assertIsNone(process.poll())
                time.sleep(0.01)
            process.send_signal(signal.SIGTERM)
            said = process.communicate(timeout=60)[1]
        self.assertEqual(process.returncode, 1)
        self.assertIn('interrupted', said)
        text = table.read_text()
        self.assertTrue(text.endswith('\n'))
        self.assertEqual({line.count(',') for line in text.splitlines()}, {text.split('\n', 1)[0].count(',')})

    def test_tension_cannot_be_carried(self):
        rows = self.failed(namelist({'target_n': '-10, 10'}), 'a contact carries no tension',
                           'the run failed at time  1.5')
        self.assertEqual(rows[-1]['t_n'], 0)

    def test_open_contact_carries_no_shear(self):
        self.failed(namelist({'control_t1': "'traction'", 'target_n': '0', 'target_t1': '0, 1'}),
                    'an open contact carries no tangential traction')


class BadInput(Point):
    def test_groups_and_keys_that_are_missing(self):
        self.refused(namelist(without=['duration', 'steps', 'target_n', 'target_t1']),
                     *[f'&point {key}: is missing' for key in ('duration', 'steps', 'target_n', 'target_t1')])
        self.refused(namelist().replace(FRICTION, ''), 'group &friction is missing')
        result = self.run_text(FRICTION)
        self.assertEqual(result.returncode, 2)
        self.assertIn('group &point is missing', result.stderr)

    def test_groups_and_keys_that_are_unknown(self):
        self.refused(namelist({'duratoin': '1'}) + '&slider mass=1 /\n', '&point duratoin: unknown key',
                     '&slider: unknown group')

    def test_input_of_one_mode_given_to_the_other(self):
        result = self.run_program('point', INPUTS / 'stick_slip.nml')
        self.assertEqual(result.returncode, 2)
        self.assertIn('which needs a group &point', result.stderr)
        result = self.run_text(namelist(), verb='run')
        self.assertEqual(result.returncode, 2)
        self.assertIn('an input of the verb point, not of run', result.stderr)
        self.assertIn('stickslip point case.nml', result.stderr)
        self.assertEqual(len(result.stderr.splitlines()), 1)

    def test_values_out_of_range_and_of_the_wrong_type(self):
        self.refused(namelist({'ndir': '4', 'cycles': '0', 'tangent': '3', 'control_n': "'force'",
                               'control_t1': 'traction', 'steps': '0, 1.5', 'duration': '-1, 1'}),
                     '&point ndir = 4: must be from 2 to 3', '&point cycles = 0: must be >= 1',
                     '&point tangent = 3: must be .true. or .false.',
                     "&point control_n = 'force': must be one of 'displacement', 'traction'",
                     '&point control_t1 = traction: must be text in quotes',
                     '&point steps = 0: must be >= 1', '&point steps: must be whole numbers',
                     '&point duration = -1: must be >= 0')
        self.refused(namelist({'target_n': 'x', 'target_t1': '0, NaN', 'tangent': "'.true.'"}),
                     '&point target_n = x: must be a number', '&point target_t1 = NaN: must be finite',
                     "&point tangent = '.true.': must be .true. or .false.")

    def test_lists_that_do_not_fit_together(self):
        self.refused(namelist({'target_t1': '1, 2, 3', 'steps': '3*1', 'control_t1': "'traction', 'traction', 'traction'"}),
                     '&point target_t1: must have one value or 2', '&point steps: must have one value',
                     '&point control_t1: must have one value')

    def test_keys_of_a_direction_that_is_not_there(self):
        self.refused(namelist({'target_t2': '1', 'control_t2': "'traction'"}),
                     '&point target_t2 = 1: needs ndir = 3', "&point control_t2 = 'traction': needs ndir = 3")

    def test_targets_beyond_the_range_of_the_routine(self):
        self.refused(namelist({'target_t1': '0, 1e200'}), '&point target_t1 = 1e200: must not exceed 1e100 in size')

    def test_more_increments_than_can_be_counted(self):
        self.refused(namelist({'cycles': '1000000000'}), '&point cycles', 'more than 2147483647 increments')

    def test_file_and_lists_exclude_each_other(self):
        (self.folder / 'path.csv').write_text('time,u_n,u_t1\n1,-0.01,0\n')
        self.refused(namelist({'file': "'path.csv'"}), '&point duration: cannot be given together with file',
                     '&point target_n = -10: cannot be given together with file')
        self.refused(namelist({'substeps': '3'}), '&point substeps = 3: needs a file')

    def test_columns_that_are_not_there_or_exclude_each_other(self):
        (self.folder / 'path.csv').write_text('time,Load,Shear\n0,0,0\n1,1,1\n')
        text = FRICTION + "&point ndir=2 file='path.csv' "
        self.refused(text + "u_n_column='a' t_n_column='b' u_t1_column='c' t_t1_factor=2 /",
                     "&point t_n_column = 'b': cannot be given together with u_n_column")
        self.refused(text + "u_n_column='a' t_t1_factor=2 u_t1_column='Shear' /", "line 1: column 'a' is missing")
        self.refused(text + "t_n_column='Load', u_t1_column='Shear', t_t1_factor=2 /", "line 1: no column 't_t1' for its factor")
        self.refused(namelist({'time_factor': '2'}), '&point time_factor = 2: needs a file')

    def test_files_that_are_none(self):
        text = FRICTION + "&point ndir=2, file='path.csv', substeps=0 /\n"
        self.refused(text, "&point file = 'path.csv'", 'No such file', '&point substeps = 0: must be >= 1')
        self.refused(text.replace("'path.csv'", "''"), "&point file = '': must be text")
        for content, said in (
                ('', ['is empty']),
                ('time,u_n,u_t1\n', ['must hold rows of numbers']),
                ('time,u_n,u_t1\n0,0,0\n', ['line 2: there is nothing but the starting point']),
                ('t,u_n,t_n,x\n1,2,3,4\n', ["must have a column 'time'", "'u_n' or 't_n', and not both",
                                            'choose one by its key, u_n_column or t_n_column', "'u_t1' or 't_t1'"]),
                ('time,u_n,u_n\n', ["column 'u_n' is given twice"]),
                ('time,u_n,u_t1\n1,2\n1,2,3,4\n1,a,\n1,NaN,1-3\n',
                 ['line 2: does not have as many cells', 'line 3: does not have as many', "line 4: u_n = 'a': must be",
                  "line 4: u_t1 = '': must be a finite number", "line 5: u_n = 'NaN': must be a finite",
                  "line 5: u_t1 = '1-3': must be a finite number"]),
                ('time,u_n,u_t1\n-1,0,1\n3,0,0\n2,0,0\n', ['line 2: time must be >= 0',
                                                           'line 4: time must not go back']),
                ('time,u_n,u_t1\n' + 5000 * '1,', ['line 2: does not have as many cells as the header: 5001 for 3'])):
            (self.folder / 'path.csv').write_text(content)
            self.refused(text, *said)
        (self.folder / 'path.csv').write_bytes(bytes(range(256)) * 20)
        self.refused(text)
        (self.folder / 'path.csv').unlink()
        (self.folder / 'path.csv').mkdir()
        self.refused(text)

    def test_bad_usage_shows_the_usage(self):
        for arguments in (['point'], ['point', 'a.nml', 'b.nml'], ['point', '--fast', 'a.nml']):
            result = self.run_program(*arguments)
            self.assertEqual(result.returncode, 2, arguments)
            self.assertIn('usage: stickslip', result.stderr)


if __name__ == '__main__':
    unittest.main()
