"""The program as a user runs it: good input, bad input, and what it leaves behind.

STICKSLIP names the program.
"""
import csv
import itertools
import math
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1]))   # here, for those that take from this file

from drawing import needs_gnuplot  # noqa: E402
from worst_errors import worst_of  # noqa: E402

PROGRAM = os.environ['STICKSLIP']
FAULT_ENGINE = pathlib.Path(PROGRAM).with_name('stickslip-fault').exists()
INPUTS = pathlib.Path(__file__).resolve().parents[2] / 'inputs'
GOOD = {
    'friction': {'law': "'subloading'", 'alpha_n': '1000', 'alpha_t': '1000', 'mu_s': '0.4',
                 'mu_k': '0.2', 'kappa': '10', 'xi': '10', 'm': '1000'},
    'slider': {'mass': '1e-3', 'stiffness': '1', 'damping': '0.01', 'normal_traction': '10'},
    'drive': {'velocity': '1'},
    'time': {'t_end': '0.1', 'dt': '1e-3'},
}


SPRINGS = {'alpha_n': '1000', 'alpha_t': '1000'}
LAWS = {
    'coulomb': {'mu': '0.3'},
    'static_kinetic': {'mu_s': '0.4', 'mu_k': '0.2', 'd_c': '0.1'},
    'rate_and_state': {'a': '0.01', 'b': '0.015', 'd_c': '0.01', 'v0': '0.001', 'f0': '0.6'},
    'slip_weakening': {'mu_s': '0.4', 'mu_k': '0.2', 'd_c': '0.05'},
    'flash_heating': {'a': '0.01', 'b': '0.015', 'd_c': '0.01', 'v0': '0.001', 'f0': '0.6', 'f_w': '0.2', 'v_w': '0.3'},
    'linker_dieterich': {'a': '0.01', 'b': '0.015', 'd_c': '0.01', 'v0': '0.001', 'f0': '0.6', 'alpha': '0.2'},
    'slip_weakening_healing': {'mu_s': '0.4', 'mu_k': '0.2', 'd_c': '0.05', 'xi': '10'},
}


def law_namelist(law, **changes):
    """A good input under one of LAWS, with some of its constants changed."""
    friction = ', '.join(f'{key} = {value}' for key, value in
                         {'law': f"'{law}'", **SPRINGS, **LAWS[law], **changes}.items())
    return namelist(without=[('friction', None)]) + f'&friction {friction} /\n'


def namelist(changes=(), without=()):
    """A good input with keys changed, {(group, key): text}, and groups or keys left out."""
    groups = {group: dict(keys) for group, keys in GOOD.items()}
    for (group, key), value in dict(changes).items():
        groups.setdefault(group, {})[key] = value
    for group, key in without:
        if key is None:
            del groups[group]
        else:
            del groups[group][key]
    return ''.join(f'&{group}\n' + ''.join(f'  {key} = {value}\n' for key, value in keys.items())
                   + '/\n' for group, keys in groups.items())


class Program(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)

    def assert_done(self, result):
        """The run came to its end; warnings are other tests' matter."""
        self.assertEqual((result.returncode, [line for line in result.stderr.splitlines() if ': warning: ' not in line]),
                         (0, []))

    def run_program(self, *arguments, **options):
        return subprocess.run([PROGRAM, *map(str, arguments)], cwd=self.folder, text=True,
                              errors='replace', capture_output=True, timeout=120, check=False,
                              **options)

    def run_text(self, text, *arguments, verb='run'):
        (self.folder / 'case.nml').write_text(text)
        return self.run_program(verb, 'case.nml', *arguments)

    def rows(self, name):
        with open(self.folder / name, newline='', encoding='utf-8') as file:
            return list(csv.DictReader(file))

    def refused(self, text, *said):
        """The input is refused with exit status 2, and the message says all these things."""
        for verb in ('check', 'run'):
            result = self.run_text(text, verb=verb)
            self.assertEqual(result.returncode, 2, result.stderr)
            for part in said:
                self.assertIn(part, result.stderr)
            self.assertIn('case.nml', result.stderr)
            self.assertEqual(result.stdout, '')
            self.assertFalse((self.folder / 'case_out').exists())


class GoodInput(Program):
    def test_small_numbers_are_shown_with_the_e_of_their_exponent(self):
        small = namelist({('friction', key): f'{value}e-60' for key, value in (('alpha_n', 1), ('alpha_t', 1))}
                         | {('friction', 'kappa'): '10e60', ('friction', 'm'): '1000e60', ('slider', 'mass'): '1e-63',
                            ('slider', 'stiffness'): '1e-60', ('slider', 'damping'): '1e-62', ('slider', 'normal_traction'): '1e-62',
                            ('drive', 'velocity'): '1e-60', ('time', 't_end'): '1'})
        result = self.run_text(small, '--no-plot')
        self.assertNotRegex(result.stdout, r'\d[-+]\d{3}')
        self.assertRegex(result.stdout, r'work of the drive    2\.\d{5}E-181 ')

    def test_run_leaves_the_promised_files(self):
        result = self.run_text(namelist(), '--no-plot')
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(result.stderr, '')
        rows = self.rows('case_out/case.csv')
        self.assertEqual(','.join(rows[0]), 'time,drive,displacement,velocity,acceleration,'
                         'spring_force,friction_force,mu,R,slip,normal_traction')
        self.assertEqual(len(rows), 101)
        self.assertEqual([float(rows[0][key]) for key in ('time', 'drive', 'mu', 'R', 'slip')],
                         [0, 0, 0.4, 0, 0])
        self.assertEqual(len(rows[7]['velocity'].lstrip('-').split('E')[0].replace('.', '')), 17)
        events = (self.folder / 'case_out/case_events.csv').read_text()
        self.assertEqual(events, 'onset,duration,stress_drop,slip,peak_velocity,recurrence_time\n')
        self.assertIn('unbalanced', result.stdout)
        self.assertIn('table              case_out/case.csv', result.stdout)
        self.assertFalse((self.folder / 'case_out/case.png').exists())

    def test_every_row_obeys_the_equation_of_motion(self):
        self.run_text(namelist({('slider', 'area'): '2.5', ('time', 't_end'): '5'}), '--no-plot')
        for row in self.rows('case_out/case.csv'):
            r = {key: float(value) for key, value in row.items()}
            self.assertAlmostEqual(r['spring_force'], r['drive'] - r['displacement'], delta=1e-13)
            inertia = 1e-3 * r['acceleration']
            rest = r['spring_force'] - 0.01 * r['velocity'] - r['friction_force'] - inertia
            self.assertLess(abs(rest), 1e-9 * (abs(r['spring_force']) + abs(r['friction_force'])
                                               + abs(inertia)) + 1e-300)
            self.assertAlmostEqual(abs(r['friction_force']), 2.5 * r['R'] * r['mu'] * 10,
                                   delta=1e-12)

    def test_a_nearly_rigid_contact_slips_as_a_softer_one_does(self):
        # Newton's method alternates between stick and slip there; it tries whether the block sticks. The contact is so stiff
        # that the event no longer depends on it; the steps are an 80th of the event.
        onsets = []
        for alpha_t in ('1e6', '1e9'):
            result = self.run_text(namelist({('friction', 'alpha_t'): alpha_t, ('slider', 'damping'): '0',
                                             ('time', 't_end'): '5'}), '--no-plot')
            self.assert_done(result)
            onsets.append(float(self.rows('case_out/case_events.csv')[0]['onset']))
        self.assertLess(abs(onsets[0] - onsets[1]), 1e-5)

    def test_rows_are_written_at_the_interval_and_at_the_end(self):
        self.run_text(namelist({('output', 'interval'): '30'}), '--no-plot')
        times = [float(row['time']) for row in self.rows('case_out/case.csv')]
        self.assertEqual([round(1e3 * t) for t in times], [0, 30, 60, 90, 100])

    def test_a_last_step_is_shortened_to_end_on_time(self):
        self.run_text(namelist({('time', 'dt'): '0.03'}), '--no-plot')
        times = [float(row['time']) for row in self.rows('case_out/case.csv')]
        self.assertEqual(len(times), 5)
        self.assertEqual(times[-1], 0.1)

    def test_drive_follows_its_pieces(self):
        self.run_text(namelist({('drive', 'velocity'): '1, -2, 0', ('drive', 'duration'): '3*0.02'}),
                      '--no-plot')
        rows = self.rows('case_out/case.csv')
        for step, position in ((10, 0.01), (20, 0.02), (30, 0.0), (40, -0.02), (100, -0.02)):
            self.assertAlmostEqual(float(rows[step]['drive']), position, delta=1e-15)

    def test_normal_traction_follows_its_pieces(self):
        self.run_text(namelist({('drive', 'normal'): '10, 0, 20', ('drive', 'duration'): '0.03 0.03 1'}),
                      '--no-plot')
        rows = self.rows('case_out/case.csv')
        self.assertEqual(float(rows[45]['friction_force']), 0.0)
        self.assertGreater(abs(float(rows[70]['friction_force'])), 0.0)

    def test_output_goes_where_it_is_told_to(self):
        result = self.run_text(namelist(), '--output', 'deep/er dir', '--no-plot', '--quiet')
        self.assertEqual((result.returncode, result.stdout, result.stderr), (0, '', ''))
        self.assertTrue((self.folder / 'deep/er dir/case.csv').exists())

    @needs_gnuplot
    def test_picture_is_drawn_with_its_script_beside_it(self):
        (self.folder / "it's a case.nml").write_text(namelist())
        result = self.run_program('run', "it's a case.nml")
        self.assertEqual((result.returncode, result.stderr), (0, ''))
        out = self.folder / "it's a case_out"
        self.assertEqual((out / "it's a case.png").read_bytes()[:4], b'\x89PNG')
        self.assertTrue((out / "it's a case.gp").exists())

    @needs_gnuplot
    def test_picture_of_a_block_at_rest(self):
        for law in ('subloading', 'rate_and_state'):
            text = law_namelist(law) if law in LAWS else namelist()
            result = self.run_text(text.replace('velocity = 1', 'velocity = 0'))
            self.assertEqual((result.returncode, result.stderr), (0, ''))
            self.assertGreater((self.folder / 'case_out/case.svg').stat().st_size, 1000)

    def test_without_gnuplot_the_run_succeeds_and_says_what_to_install(self):
        sh_only = self.folder / 'bin'
        sh_only.mkdir()
        (sh_only / 'sh').symlink_to(shutil.which('sh'))
        (self.folder / 'case.nml').write_text(namelist())
        result = self.run_program('run', 'case.nml', env={**os.environ, 'PATH': str(sh_only)})
        self.assertEqual(result.returncode, 0)
        self.assertIn('gnuplot is not installed', result.stderr)
        self.assertTrue((self.folder / 'case_out/case.gp').exists())

    def test_half_a_picture_is_told_and_removed(self):
        tool = self.folder / 'tools/gnuplot'
        tool.parent.mkdir()
        (self.folder / 'case.nml').write_text(namelist())
        whole = 'echo "<svg> a picture </svg>" >case.svg'
        for drawing, told in ((whole, False), (f'{whole}; truncate -s -8 case.svg', True), (':', True)):
            tool.write_text(f'#!/bin/sh\n{drawing}\n')
            tool.chmod(0o755)
            shutil.rmtree(self.folder / 'case_out', ignore_errors=True)
            result = self.run_program('run', 'case.nml', env={**os.environ, 'PATH': f"{tool.parent}:{os.environ['PATH']}"})
            self.assertEqual(result.returncode, 0)
            self.assertEqual('could not write the whole picture' in result.stderr, told, drawing)
            self.assertEqual((self.folder / 'case_out/case.svg').exists(), not told)

    def test_check_says_that_good_input_is_valid_and_runs_nothing(self):
        result = self.run_text(namelist(), verb='check')
        self.assertEqual((result.returncode, result.stderr), (0, ''))
        self.assertEqual(result.stdout, 'case.nml: valid, 100 steps, for stickslip run\n')
        self.assertEqual(os.listdir(self.folder), ['case.nml'])

    def test_every_verb_says_which_one_an_input_is_for(self):
        inputs = {'run': 'stick_slip.nml', 'sweep': 'sweep_map.nml', 'point': 'point_mixed.nml', 'fault': 'fault_bp1.nml'}
        for right, name in inputs.items():
            path = INPUTS / name
            for verb in ('run', 'sweep', 'point', 'stability') + (('fault',) if FAULT_ENGINE else ()):
                if verb == right or (verb == 'stability' and right in ('run', 'sweep')):
                    continue
                result = self.run_program(verb, path)
                self.assertEqual(result.returncode, 2, result.stderr)
                self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
                self.assertIn(f'this is an input of the verb {right}, not of {verb}', result.stderr)
                self.assertTrue(result.stderr.endswith(f': stickslip {right} {path}\n'), result.stderr)
        self.assertEqual(os.listdir(self.folder), [])
        (self.folder / 'rig.nml').write_text(f"{namelist()}&fit records='rig.csv' free='mu_s' /\n")
        for verb in ('run', 'check', 'sweep', 'point', 'stability') + (('fault',) if FAULT_ENGINE else ()):
            result = self.run_program(verb, 'rig.nml')
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertRegex(result.stderr, f'^rig.nml:[0-9]+: this is an input of .* fit, not of {verb}: stickslip-fit rig.nml\n$')

    def test_an_input_may_come_from_a_pipe(self):
        # it can be read once only
        for text in (namelist(), (INPUTS / 'point_mixed.nml').read_text(), (INPUTS / 'sweep_map.nml').read_text()):
            result = self.run_program('check', '/dev/stdin', input=text)
            self.assertEqual((result.returncode, result.stderr), (0, ''))
            self.assertIn('valid', result.stdout)
        result = self.run_program('run', '/dev/stdin', '--no-plot', '--output', 'out', input=namelist())
        self.assertEqual((result.returncode, result.stderr), (0, ''))

    def test_a_byte_order_mark_and_utf_16_do_not_matter(self):
        for code in ('utf-8', 'utf-16-le', 'utf-16-be'):
            (self.folder / 'case.nml').write_bytes(('\ufeff! \u00b5m\r\n' + namelist()).encode(code))
            result = self.run_program('check', 'case.nml')
            self.assertEqual((result.returncode, result.stderr), (0, ''))

    def test_help_and_version_answer_on_standard_output(self):
        for arguments in (['--help'], ['run', '--help']):
            result = self.run_program(*arguments)
            self.assertEqual((result.returncode, result.stderr), (0, ''))
            self.assertIn('usage: stickslip run INPUT.nml', result.stdout)
        result = self.run_program('--version')
        self.assertEqual((result.returncode, result.stderr), (0, ''))
        self.assertRegex(result.stdout, r'^stickslip \d+\.\d+\.\d+\n$')


class Laws(Program):
    def slide(self, law, **changes):
        """Rows of a run in which the block comes to slide, as numbers."""
        text = law_namelist(law, **changes).replace('t_end = 0.1', 't_end = 9')
        result = self.run_text(text, '--no-plot')
        self.assert_done(result)
        rows = [{key: float(value) for key, value in row.items()}
                for row in self.rows('case_out/case.csv')]
        self.assertGreater(rows[-1]['slip'], 0.5)
        return rows, list(zip(rows, rows[1:]))

    def test_coulomb_friction_is_constant_while_it_slides(self):
        for old, new in self.slide('coulomb')[1]:
            if new['slip'] > old['slip']:
                self.assertAlmostEqual(abs(new['friction_force']), 3.0, delta=1e-12)

    def test_static_kinetic_friction_depends_on_the_slip_rate(self):
        for old, new in self.slide('static_kinetic')[1]:
            if new['slip'] > old['slip']:
                rate = (new['slip'] - old['slip']) / (new['time'] - old['time'])
                self.assertAlmostEqual(new['mu'], 0.2 + 0.2 * math.exp(-0.1 * rate), delta=1e-9)

    def test_slip_weakening_friction_depends_on_the_slip(self):
        for row in self.slide('slip_weakening')[0]:
            self.assertAlmostEqual(row['mu'], max(0.2, 0.4 - 0.2 * row['slip'] / 0.05), delta=1e-9)

    def test_slip_weakening_friction_heals_with_time(self):
        healed = 0
        for old, new in self.slide('slip_weakening_healing')[1]:
            y = 10 * (new['time'] - old['time'])
            slip = new['slip'] - old['slip']
            self.assertAlmostEqual(new['D'], min(0.05, old['D'] * math.exp(-y) - slip * math.expm1(-y) / y), delta=1e-12)
            self.assertAlmostEqual(new['mu'], 0.4 - 0.2 * new['D'] / 0.05, delta=1e-9)
            healed += new['D'] < old['D']
        self.assertGreater(healed, 10)

    def test_rate_and_state_friction_depends_on_the_slip_rate_and_its_state(self):
        for evolution in ('ageing', 'slip'):
            for old, new in self.slide('rate_and_state', evolution=f"'{evolution}'")[1]:
                slip, dt = new['slip'] - old['slip'], new['time'] - old['time']
                if slip < 1e-6:   # cancellation
                    continue
                x = slip / 0.01
                if evolution == 'ageing':
                    theta = old['theta'] * math.exp(-x) - dt * math.expm1(-x) / x
                else:
                    theta = old['theta'] * (dt / (x * old['theta']))**-math.expm1(-x)
                self.assertAlmostEqual(new['theta'] / theta, 1.0, delta=1e-6)
                mu = 0.01 * math.asinh(slip / dt / 0.002
                                       * math.exp((0.6 + 0.015 * math.log(theta / 10)) / 0.01))
                self.assertAlmostEqual(new['mu'], mu, delta=1e-8)

    def test_r_approaches_one_by_the_function_asked_for(self):
        self.refused(namelist({('friction', 'u_of_r'): "'linear'"}),
                     "&friction u_of_r = 'linear': must be one of 'logarithm', 'cotangent', 'reciprocal'")
        self.refused(namelist({('friction', 'u_of_r'): "'cotangent'", ('friction', 'scheme'): "'exact_rate'"}),
                     "must be 'logarithm' with scheme = 'exact_rate'")
        functions = {'logarithm': lambda r: -math.log(r), 'reciprocal': lambda r: 1 / r - 1,
                     'cotangent': lambda r: 1 / math.tan(math.pi / 2 * r)}
        for name, u in functions.items():
            result = self.run_text(namelist({('friction', 'u_of_r'): f"'{name}'", ('time', 't_end'): '4.2'}),
                                   '--no-plot')
            self.assertEqual((result.returncode, result.stderr), (0, ''))
            rows = [{key: float(value) for key, value in row.items()} for row in self.rows('case_out/case.csv')]
            seen = 0
            for old, new in zip(rows, rows[1:]):
                slip = new['slip'] - old['slip']
                if new['R'] - old['R'] > 1e-6 and slip > 1e-6:   # R falls back where it sticks
                    self.assertAlmostEqual((new['R'] - old['R']) / (1000 * slip * u(new['R'])), 1, delta=1e-5)
                    seen += 1
            self.assertGreater(seen, 20)

    def test_a_shear_cap_holds_for_every_law(self):
        self.refused(law_namelist('coulomb', tau_max='-1'), '&friction tau_max = -1: must be >= 0')
        for law in LAWS:
            rows, _ = self.slide(law, tau_max='1.5')
            self.assertAlmostEqual(worst_of(row['friction_force'] for row in rows), 1.5, delta=1e-12)

    def test_orthotropic_friction_is_not_for_blocks(self):
        for law in LAWS:
            self.refused(law_namelist(law, mu_ratio='0.5', direction="'radial'"),
                         '&friction mu_ratio = 0.5: has no effect on blocks, which slide along one line: it is for the verb '
                         'point',
                         "&friction direction = 'radial': has no effect on blocks, which slide along one line: it is for the "
                         'verb point')

    def test_constants_of_another_law_are_unknown_keys(self):
        for law in LAWS:
            self.refused(law_namelist(law, kappa='1'), "&friction kappa: unknown key; it belongs to the law 'subloading'")
        self.refused(namelist({('friction', 'mu'): '0.3', ('friction', 'evolution'): "'slip'"}),
                     "&friction mu: unknown key; it belongs to the law 'coulomb'",
                     "&friction evolution: unknown key; it belongs to the law 'rate_and_state'")
        self.refused(namelist({('friction', 'kapa'): '0.3'}), "&friction kapa: unknown key; did you mean 'kappa'?")
        # keys without a default, which are read only where they are given; the last two were beyond room for 32
        for group, wrong, right in (('events', 'slip_rat', 'slip_rate'), ('slider', 'normal_mas', 'normal_mass'),
                                    ('time', 'rho_infinit', 'rho_infinity'), ('drive', 'normal_amplitud', 'normal_amplitude'),
                                    ('drive', 'velocity_colum', 'velocity_column'), ('output', 'evry', 'every'),
                                    ('output', 'checkpont', 'checkpoint')):
            self.refused(namelist({(group, wrong): '1'}), f"&{group} {wrong}: unknown key; did you mean '{right}'?")

    def test_the_name_of_a_law_is_the_only_fault_where_nothing_else_is_wrong(self):
        for law in LAWS:
            for wrong, meant in ((law.replace('_', '-') + 's', law), (law[:-3], law), ('anisotropic', None)):
                told = self.run_text(law_namelist(law).replace(f"'{law}'", f"'{wrong}'"), verb='check').stderr
                self.assertEqual(len(told.splitlines()), 1, told)
                self.assertIn(f"&friction law = '{wrong}': must be one of 'subloading', 'coulomb'", told)
                self.assertTrue(told.strip().endswith(f"; did you mean '{meant}'?" if meant else "'linker_dieterich'"), told)

    def test_a_key_is_told_of_a_law_only_in_the_group_of_the_law(self):
        for law in LAWS:
            self.refused(law_namelist(law) + '&chain n = 5, coupling = 1 /\n',
                         "&chain n: unknown key; did you mean 'n_blocks'?")
        for key in ('kappa', 'mu_k', 'theta_0', 'v_w', 'evolution'):   # of laws that the input does not have
            friction = f"&friction law = 'coulomb', mu = 0.3, alpha_n = 1, alpha_t = 1, {key} = 1 /\n"
            groups = ('slider', 'drive', 'time', 'chain', 'events', 'output', 'initial')
            slider = friction + namelist({(group, key): '1' for group in groups}, without=[('friction', None)])
            sweep = f"&sweep key = 'time%dt', values = 1e-3, {key} = 1 /"
            for verb, text, known in (('run', slider, 8), ('stability', slider, 8), ('sweep', slider + sweep, 9),
                                      ('point', friction + f'&point {key} = 1 /', 2),
                                      ('fault', friction + f'&fault {key} = 1 / &time {key} = 1 / &output {key} = 1 /', 4)):
                told = self.run_text(text, verb='check' if verb == 'fault' else verb).stderr.splitlines()
                told = [line for line in told if f' {key}: unknown key' in line]
                self.assertEqual(len(told), known, told)
                self.assertEqual([line for line in told if 'belongs to the law' in line],
                                 [line for line in told if '&friction' in line])

    def test_constants_left_out_or_out_of_range_are_all_named(self):
        for law, constants in LAWS.items():
            self.refused(law_namelist(law, **{key: '-1' for key in constants}),
                         *(f'&friction {key} = -1' for key in constants))
            without = namelist(without=[('friction', None)]) + f"&friction law = '{law}' /\n"
            self.refused(without, *(f'&friction {key}: is missing' for key in constants))
        self.refused(law_namelist('slip_weakening', mu_s='0.1'), '&friction mu_s = 0.1: must be >= mu_k')
        self.refused(law_namelist('slip_weakening_healing', xi='-1'), '&friction xi = -1: must be >= 0')
        self.refused(law_namelist('flash_heating', f_w='0.7'), '&friction f_w = 0.7: must be from 0 to f0')
        self.refused(law_namelist('linker_dieterich', alpha='-0.1'), '&friction alpha = -0.1: must be >= 0')
        self.refused(law_namelist('flash_heating', n='0.5', v_w='0'), '&friction n = 0.5: must be',
                     '&friction v_w = 0: must be > 0')
        self.refused(law_namelist('rate_and_state', evolution="'growing'", theta_0='0'),
                     "&friction evolution = 'growing': must be one of 'ageing', 'slip'",
                     '&friction theta_0 = 0: must be > 0')


class BadInput(Program):
    def test_an_end_that_is_not_there_is_no_end_before_the_first_step(self):
        result = self.run_text(namelist({('time', 't_end'): ''}), verb='check')
        self.assertEqual([line.split(': ', 1)[1] for line in result.stderr.splitlines()], ['&time t_end: has no value'])

    def test_unknown_key_and_group(self):
        self.refused(namelist({('slider', 'masss'): '1', ('slides', 'x'): '1'}),
                     '&slider masss: unknown key', '&slides: unknown group')

    def test_missing_groups_and_keys(self):
        self.refused(namelist(without=[('drive', None), ('slider', 'mass')]),
                     'group &drive is missing', '&slider mass: is missing')

    def test_whatever_parts_an_input_lacks_it_is_refused_in_words(self):
        """Rules between groups are for groups that are there: adaptive steps of a block without mass, a damper, ..."""
        adaptive = {('time', 'rtol'): '1e-4', ('slider', 'mass'): '0'}
        others = namelist(adaptive, [('friction', None), ('time', 'dt')])
        friction = len(namelist(without=[('friction', None)]))
        texts = [path.read_text() for path in sorted(INPUTS.glob('*.nml')) if not path.name.startswith('fault')]
        texts += [others + law_namelist(law, eta_t='1')[friction:] for law in LAWS]
        for text in texts:
            groups = re.findall(r'^&.*?/$', text, re.MULTILINE | re.DOTALL)
            for count in range(len(groups)):
                for part in itertools.combinations(groups, count):
                    result = self.run_text('\n'.join(part) + '\n', verb='check')
                    self.assertIn(result.returncode, (0, 2), f'{part}: {result.stderr}')
                    self.assertEqual(result.returncode == 2, 'case.nml' in result.stderr, result.stderr)

    def test_empty_file(self):
        self.refused('', 'group &friction is missing', 'group &slider is missing',
                     'group &drive is missing', 'group &time is missing')
        result = self.run_text('')
        self.assertEqual(len(result.stderr.splitlines()), 4, result.stderr)

    def test_wrong_types(self):
        self.refused(namelist({('slider', 'mass'): "'heavy'", ('time', 'dt'): 'fast',
                               ('friction', 'law'): 'subloading', ('output', 'interval'): '1.5',
                               ('time', 'max_iterations'): '1e30', ('slider', 'area'): '1, 2',
                               ('friction', 'scheme'): "'trapezoidal'"}),
                     "&slider mass = 'heavy': must be a number", '&time dt = fast: must be a number',
                     '&friction law = subloading: must be text in quotes',
                     "&friction scheme = 'trapezoidal': must be one of 'backward_euler', 'exact_rate'",
                     '&output interval = 1.5: must be a whole number',
                     '&time max_iterations = 1e30', '&slider area: takes one value, not 2')

    def test_values_out_of_range(self):
        self.refused(namelist({('slider', 'stiffness'): '-1', ('slider', 'mass'): '-1',
                               ('friction', 'alpha_t'): '0', ('friction', 'xi'): '-1',
                               ('time', 'beta'): '0', ('time', 'gamma'): '0.4',
                               ('output', 'interval'): '0', ('friction', 'law'): "'magic'"}),
                     '&slider stiffness = -1: must be > 0', '&slider mass = -1: must be >= 0',
                     '&friction alpha_t = 0: must be > 0', '&friction xi = -1: must be >= 0',
                     '&time beta = 0: must be from', '&time gamma = 0.4: must be from',
                     '&output interval = 0: must be >= 1', "&friction law = 'magic': must be")

    def test_numbers_that_are_none(self):
        self.refused(namelist({('slider', 'mass'): 'NaN', ('time', 't_end'): 'Inf',
                               ('drive', 'velocity'): '1, -Infinity', ('slider', 'area'): '1e999'}),
                     '&slider mass = NaN: must be finite', '&time t_end = Inf: must be finite',
                     '&drive velocity = -Infinity: must be finite', '&slider area = 1e999')
        # a load whose strength were no number any more was valid, and the run failed at its start
        self.refused(namelist({('slider', 'normal_traction'): '1e300', ('drive', 'velocity'): '1, -2e100'}),
                     '&slider normal_traction = 1e300: must not exceed 1e100 in size', '&drive velocity = -2e100: must not exceed')

    def test_constants_that_contradict_each_other(self):
        self.refused(namelist({('friction', 'mu_s'): '0.1'}), '&friction mu_s = 0.1: must be >= mu_k')
        self.refused(namelist({('friction', 'mu_0'): '0.9'}), '&friction mu_0 = 0.9: must be from mu_k')
        self.refused(namelist({('friction', 'm'): '1e200'}), '&friction')

    def test_keys_and_groups_given_twice(self):
        self.refused(namelist().replace('mass', 'mass = 1\n mass'), '&slider mass', 'is given twice')
        self.refused(namelist() + '&drive velocity = 1 /\n', 'group &drive is given twice')

    def test_lists_that_do_not_fit_together(self):
        self.refused(namelist({('drive', 'velocity'): '1, 2, 3', ('drive', 'duration'): '1, 2'}),
                     '&drive duration: must have 3 values')
        self.refused(namelist({('drive', 'velocity'): '1, 2'}), '&drive duration: must have 2 values')
        self.assertEqual(len(self.run_text(namelist({('drive', 'velocity'): '1, 2'})).stderr.splitlines()), 1)
        self.refused(namelist({('drive', 'velocity'): '1, 2', ('drive', 'duration'): '3*1'}),
                     '&drive velocity: must have one value or 3 values')
        self.refused(namelist({('drive', 'velocity'): '1, 2', ('drive', 'duration'): '1, -1'}),
                     '&drive duration = -1: must be > 0')

    def test_more_steps_than_can_be_counted(self):
        self.refused(namelist({('time', 'dt'): '1e-12', ('time', 't_end'): '1e5'}), '&time dt = 1e-12',
                     'more than 2147483647 steps')
        self.refused(namelist({('time', 'dt'): '1'}), '&time dt = 1: must not exceed t_end')

    def test_syntax_faults_are_named_with_their_lines(self):
        self.refused(namelist() + 'stray words\n&output interval 3 /\n', ":24: text outside any group",
                     ":25: &output interval: expected '='")
        self.refused(namelist().rstrip('\n/'), "group &time is not ended by '/'")

    def test_text_that_other_readers_take_silently_or_in_another_way(self):
        # each is one fault, in its line, with its reason
        for old, new, said in (
                ("'subloading'", "'subloading", ":2: &friction law: the text 'subloading is not ended by a quote"),
                ('mass = 1e-3', 'mass = 1e-400', ':12: &slider mass = 1e-400: is not 0, but below the smallest number'),
                ('velocity = 1', 'velocity(1:2) = 1, 2, 3', ':18: &drive velocity: has 3 values for the 2 places'),
                ('velocity = 1', 'velocity(1:3:2) = 1, 2', ':18: &drive velocity: has gaps between its subscripts'),
                ('velocity = 1', 'velocity = 1,, 2', ':18: &drive velocity: a value is missing before a comma'),
                ('velocity = 1\n/', 'velocity = 1\n/ done', ":19: text after the '/' that ends &drive: 'done'"),
                ('mass = ', 'area(2) = 1 mass = ', ':12: &slider area'),
                ("law = '", "law(1:3) = '", ":2: &friction law = 'subloading': takes one value, and no subscript"),
                ('&drive\n', "&output time_unit(2:3) = 'ms' /\n&drive\n", ":17: &output time_unit = 'ms': takes one value, and no sub"),
                ('&drive\n', '&\n' * 200 + '&drive\n', ":17: text outside any group: '&'")):
            result = self.run_text(namelist().replace(old, new), verb='check')
            self.assertEqual((result.returncode, len(result.stderr.splitlines())), (2, 1), result.stderr)
            self.assertIn('case.nml' + said, result.stderr)

    def test_subscripts_with_strides_and_long_lists_are_read(self):
        places = namelist({('drive', 'velocity(1:3:2)'): '1, 3', ('drive', 'velocity(2)'): '2', ('drive', 'duration'): '3*0.03'},
                          without=[('drive', 'velocity')])
        self.run_text(places, '--no-plot', '--output', 'a')
        self.run_text(namelist({('drive', 'velocity'): '1, 2, 3', ('drive', 'duration'): '3*0.03'}), '--no-plot', '--output', 'b')
        self.assertEqual(self.rows('a/case.csv'), self.rows('b/case.csv'))
        long = namelist({('drive', 'velocity'): '8000*1', ('drive', 'duration'): ', '.join(['1'] * 8000)})
        self.assertEqual(self.run_text(long, verb='check').returncode, 0)

    def test_unknown_names_come_with_what_was_meant(self):
        self.refused(namelist({('slider', 'stifness'): '1', ('slider', 'velocity'): '1', ('ouptut', 'interval'): '1'}),
                     "&slider stifness: unknown key; did you mean 'stiffness'?",
                     '&slider velocity: unknown key; &drive has a key of that name',
                     "&ouptut: unknown group; did you mean '&output'?")

    def test_every_fault_is_listed_not_only_the_first(self):
        result = self.run_text(namelist({('slider', 'mass'): '-1', ('slider', 'x'): '1',
                                         ('time', 'dt'): 'z'}, without=[('friction', 'm')]))
        self.assertEqual(len(result.stderr.splitlines()), 4, result.stderr)

    def test_no_such_file_and_a_directory(self):
        for verb in ('run', 'check'):
            result = self.run_program(verb, 'nowhere.nml')
            self.assertEqual(result.returncode, 2)
            self.assertIn('nowhere.nml', result.stderr)
            result = self.run_program(verb, '.')
            self.assertEqual(result.returncode, 2)
            self.assertIn('is a directory', result.stderr)

    def test_binary_rubbish(self):
        (self.folder / 'case.nml').write_bytes(bytes(range(256)) * 20)
        result = self.run_program('check', 'case.nml')
        self.assertEqual(result.returncode, 2)

    def test_output_directory_that_cannot_be(self):
        (self.folder / 'file').write_text('')
        result = self.run_text(namelist(), '--output', 'file/below')
        self.assertEqual(result.returncode, 2)
        self.assertIn("cannot write to the directory 'file/below'", result.stderr)
        result = self.run_text(namelist(), '--output', '/proc')
        self.assertEqual(result.returncode, 2)
        self.assertNotEqual(result.stderr, '')

    def test_no_verb_writes_over_what_it_reads(self):
        drive = namelist({('drive', 'file'): "'READ'"}, [('drive', 'velocity')])
        record = 'time,velocity\n0,1\n1,1\n'
        for verb, name, text, table in (
                ('run', 'case.csv', drive, record),
                ('run', 'case_blocks.csv', namelist({('chain', 'n_blocks'): '3', ('chain', 'coupling'): '1',
                                                     ('friction', 'mu_s'): "'@READ'"}), 'block,mu_s\n1,0.4\n3,0.5\n'),
                ('point', 'case.csv', "&friction law = 'coulomb', alpha_n = 1, alpha_t = 1, mu = 0.5 /\n&point file = 'READ' /\n",
                 'time,t_n,u_t1,u_t2\n0,0,0,0\n1,-1,1,0\n'),
                ('stability', 'case_stability.csv', drive, record),
                ('sweep', 'case_sweep.csv', drive + "&sweep key = 'slider%damping', values = 0, 0.1 /\n", record)):
            (self.folder / 'data').mkdir()
            (self.folder / 'data' / 'link.csv').symlink_to(f'../{name}')
            (self.folder / name).write_text(table)
            for given, output in ((name, '.'), (self.folder / name, self.folder), ('data/link.csv', 'data/..')):
                result = self.run_text(text.replace('READ', str(given)), '--output', output, verb=verb)
                self.assertEqual(result.returncode, 2, (verb, given, result.stderr))
                self.assertIn(f"the results would overwrite the input '{given}'", result.stderr)
                self.assertEqual((self.folder / name).read_text(), table)
            self.assertNotIn('overwrite', self.run_text(text.replace('READ', name), '--no-plot', verb=verb).stderr)
            shutil.rmtree(self.folder / 'data')

    def test_bad_usage_shows_the_usage(self):
        for arguments in ([], ['walk'], ['run'], ['run', 'a.nml', 'b.nml'], ['run', '--fast', 'a.nml'],
                          ['run', 'a.nml', '--output'], ['check', 'a.nml', '--no-plot'],
                          ['point', 'a.nml', '--verify'], ['sweep', 'a.nml', '--resume']):
            result = self.run_program(*arguments)
            self.assertEqual(result.returncode, 2, arguments)
            self.assertIn('usage: stickslip', result.stderr)
            self.assertEqual(result.stdout, '')
        self.assertIn("unknown option '--outptu'", self.run_program('run', 'a.nml', '--outptu', 'b').stderr)


class FailedRun(Program):
    def test_a_run_that_fails_says_when_and_keeps_what_it_has(self):
        # friction falls faster than the soft spring unloads, and without a mass nothing takes that up
        result = self.run_text(namelist({('time', 't_end'): '20', ('time', 'dt'): '5e-3', ('slider', 'mass'): '0',
                                         ('slider', 'damping'): '0'}), '--no-plot')
        self.assertEqual(result.returncode, 1)
        self.assertRegex(result.stderr, r'the run failed at time .*, step \d+: .* Give it a mass')
        self.assertGreater(len(self.rows('case_out/case.csv')), 5)

    def test_standard_output_that_cannot_be_written_is_a_failure(self):
        (self.folder / 'case.nml').write_text(namelist({('time', 't_end'): '0.1'}))
        for arguments in (['run', 'case.nml', '--no-plot'], ['check', 'case.nml'], ['--version'], ['--help']):
            with open('/dev/full', 'w', encoding='ascii') as full:
                result = subprocess.run([PROGRAM, *arguments], cwd=self.folder, stdout=full, stderr=subprocess.PIPE,
                                        text=True, check=False)
            self.assertEqual(result.returncode, 1, arguments)
            self.assertIn('standard output cannot be written', result.stderr)
        self.assertGreater(len(self.rows('case_out/case.csv')), 50)   # the results are there all the same

    def test_tables_too_large_are_refused_before_the_run_unless_allowed(self):
        long = {('time', 't_end'): '1e5', ('time', 'dt'): '1e-4'}
        result = self.run_text(namelist(long), '--no-plot')
        self.assertEqual(result.returncode, 2)
        self.assertRegex(result.stderr, r'&output table_limit: the tables are going to take 2\.64E\+02 GB, more than 1\.00E\+01')
        self.assertEqual(self.run_text(namelist(long), verb='check').returncode, 2)
        allowed = self.run_text(namelist({**long, ('output', 'table_limit'): '300'}), verb='check')
        self.assertEqual((allowed.returncode, allowed.stderr), (0, ''))
        self.assertIn('tables of about 264.', allowed.stdout)
        self.assertEqual(self.run_text(namelist({**long, ('output', 'interval'): '1000'}), verb='check').returncode, 0)
        # the same input says nothing against verbs that write no such tables
        swept = namelist({**long, ('sweep', 'key'): "'drive%velocity'", ('sweep', 'values'): '1'})
        for verb, text in (('stability', namelist(long)), ('check', swept)):
            self.assertNotIn('table_limit', self.run_text(text, verb=verb).stderr)

    def test_adaptive_steps_stop_at_the_limit_and_can_be_resumed(self):
        text = namelist({('time', 't_end'): '12', ('time', 'rtol'): '1e-5'}, [('time', 'dt')])
        self.assertEqual(self.run_text(text, '--no-plot', '--output', 'whole').returncode, 0)
        result = self.run_text(text.replace('&time', '&output table_limit = 2e-4 /\n&time'), '--no-plot')
        self.assertEqual(result.returncode, 1)
        self.assertIn('reached &output table_limit', result.stderr)
        result = self.run_program('run', 'case.nml', '--no-plot', '--resume')   # still too small
        self.assertEqual(result.returncode, 1)
        (self.folder / 'case.nml').write_text(text.replace('&time', '&output table_limit = 1 /\n&time'))
        result = self.run_program('run', 'case.nml', '--no-plot', '--resume')
        self.assertEqual((result.returncode, result.stderr), (0, ''))
        self.assertEqual((self.folder / 'case_out/case.csv').read_bytes(), (self.folder / 'whole/case.csv').read_bytes())

    def test_a_long_series_is_drawn_from_few_rows_with_all_its_extremes(self):
        text = namelist({('time', 't_end'): '31.7', ('time', 'dt'): '5e-4'})   # 63400 rows, no power of two
        self.assertEqual(self.run_text(text, '--no-plot').returncode, 0)
        every = {tuple(row.values()) for row in self.rows('case_out/case.csv')}
        few = self.rows('case_out/case_picture.csv')
        self.assertGreater(len(few), 1e4)
        self.assertLess(len(few), 3.1e4)
        self.assertTrue({tuple(row.values()) for row in few} <= every)
        times = [float(row['time']) for row in few]
        self.assertEqual(times, sorted(times))
        self.assertLess(worst_of(b - a for a, b in zip(times, times[1:])), 31.7 / 3000)
        for name in ('spring_force', 'velocity'):
            place = list(few[0]).index(name)
            values = [float(row[place]) for row in every]
            seen = [float(row[name]) for row in few]
            self.assertEqual(max(map(abs, seen)), max(map(abs, values)))
        self.assertEqual(min(float(row['spring_force']) for row in few), min(float(row[5]) for row in every))

    def test_a_full_disk_is_a_failed_run(self):
        small = self.folder / 'case_out'
        small.mkdir()
        mounted = subprocess.run(['mount', '-t', 'tmpfs', '-o', 'size=100k', 'small', str(small)],
                                 capture_output=True, check=False)
        if mounted.returncode != 0:
            self.skipTest('needs the right to mount a small file system')
        self.addCleanup(subprocess.run, ['umount', str(small)], check=True)
        result = self.run_text(namelist({('time', 't_end'): '5'}), '--no-plot')
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertIn('cannot write the time series', result.stderr)
        self.assertGreater(len(self.rows('case_out/case.csv')), 100)
        last = (small / 'case.csv').read_text(encoding='ascii')[-27:]
        self.assertRegex(last, r',[ -]?\d\.\d{16}E[+-]\d{3}\n$', 'the last row is whole')


class ShippedInputs(Program):
    """The files in inputs/ run as they stand and show what they are there to show."""

    def shipped(self, name):
        result = self.run_program('run', INPUTS / f'{name}.nml', '--no-plot')
        self.assertEqual((result.returncode, result.stderr), (0, ''))
        return result.stdout

    def events(self, name):
        return [{key: float(value) for key, value in row.items()}
                for row in self.rows(f'{name}_out/{name}_events.csv')]

    def test_all_shipped_inputs_are_valid(self):
        for path in INPUTS.glob('*.nml'):
            result = self.run_program('check', path)
            self.assertEqual((result.returncode, result.stderr), (0, ''))

    def test_stick_slip_goes_on_with_one_period(self):
        self.shipped('stick_slip')
        events = self.events('stick_slip')
        self.assertGreater(len(events), 15)
        periods = [event['recurrence_time'] for event in events]
        self.assertTrue(math.isnan(periods[0]))
        self.assertLess(worst_of(periods[1:]) - min(periods[1:]), 0.01 * periods[1])
        for event in events:   # drops are sudden: short against the stick before them
            self.assertLess(event['duration'], 0.1 * periods[1])
            self.assertGreater(event['stress_drop'], 0.5 * 0.4 * 0.01)
            self.assertGreater(event['peak_velocity'], 10.0)

    def peak_spring_force(self, scheme, dt):
        """Of the first loading, before the first drop; from a parabola through the three highest rows."""
        text = namelist({('friction', 'scheme'): f"'{scheme}'", ('time', 't_end'): '4.2',
                         ('friction', 'm'): '20', ('time', 'dt'): str(dt)})
        self.assertEqual(self.run_text(text, '--no-plot').returncode, 0)
        force = [float(row['spring_force']) for row in self.rows('case_out/case.csv')]
        i = force.index(max(force))
        below, peak, above = force[i - 1:i + 2]
        return peak + (above - below)**2 / (8 * (2 * peak - above - below))

    def test_exact_rate_makes_the_peak_force_second_order_accurate(self):
        limit = self.peak_spring_force('exact_rate', 1.25e-4)
        for scheme, least, most in ('exact_rate', 1.9, 2.5), ('backward_euler', 0.8, 1.2):
            coarse, fine = (abs(self.peak_spring_force(scheme, dt) - limit) for dt in (4e-3, 1e-3))
            order = math.log2(coarse / fine) / 2
            self.assertTrue(least < order < most, f'{scheme}: order {order}')

    def test_slow_steady_settles_at_the_closed_form(self):
        self.shipped('slow_steady')
        self.assertEqual(self.events('slow_steady'), [])
        last = self.rows('slow_steady_out/slow_steady.csv')[-1]
        self.assertAlmostEqual(float(last['mu']), (10 * 0.1 * 0.2 + 1 * 0.4) / (10 * 0.1 + 1), delta=1e-6)
        self.assertAlmostEqual(float(last['velocity']), 0.1, delta=1e-6)

    def test_rate_and_state_is_unstable_below_its_critical_stiffness_and_steady_above(self):
        self.shipped('rate_and_state')
        events = self.events('rate_and_state')
        self.assertGreater(len(events), 2)
        for event in events:
            self.assertGreater(event['peak_velocity'], 10.0)
        text = (INPUTS / 'rate_and_state.nml').read_text()
        result = self.run_text(text.replace('stiffness = 1.0 ', 'stiffness = 10.0 '), '--no-plot')
        self.assertEqual((result.returncode, result.stderr), (0, ''))
        last = self.rows('case_out/case.csv')[-1]
        self.assertAlmostEqual(float(last['velocity']), 0.1, delta=1e-6)
        self.assertAlmostEqual(float(last['mu']), 0.6 - 0.005 * math.log(100), delta=1e-6)

    def test_period_and_drop_fall_with_the_drive_velocity(self):
        table = self.shipped('velocity_steps').split('peak velocity\n')[-1].splitlines()[:4]
        period = [float(line.split()[4]) for line in table]
        drop = [float(line.split()[5]) for line in table]
        self.assertEqual(period, sorted(period, reverse=True))
        self.assertEqual(drop, sorted(drop, reverse=True))
        self.assertLess(drop[3], 0.5 * drop[0])


if __name__ == '__main__':
    unittest.main()
