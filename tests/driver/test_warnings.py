"""Warnings: one line each on standard error, where results may not be what the model means; never else.

STICKSLIP names the program.
"""
import math
import pathlib
import unittest

from test_program import Program, namelist

INPUTS = pathlib.Path(__file__).resolve().parents[2] / 'inputs'

# a textbook: mass 10 kg, spring 4000 N/m, 0.01 m/s, friction 0.3 and 0.2 under 98.1 N
TEXTBOOK = """&friction law='static_kinetic', alpha_n=1e8, alpha_t=1e8, mu_s=0.3, mu_k=0.2, d_c=1e4 /
&slider mass=10, stiffness=4000, normal_traction=98.1 /
&drive velocity=0.01 /
&time t_end=3, dt=1e-4 /
"""
CHAIN = """&friction law='static_kinetic' alpha_n=100.0 alpha_t=100.0 mu_s=1.0 mu_k=0.0 d_c=6.0 /
&slider mass=1.0 stiffness=1.0 normal_traction=1.0 /
&drive velocity=0.01 /
&chain n_blocks=50 coupling=36.0 ends='periodic' scatter=0.01 /
&time t_end=300.0 dt=0.01 /
&output interval=50 /
"""


class Warnings(Program):
    def warnings(self, text, **options):
        result = self.run_text(text, '--no-plot', **options)
        self.assertEqual(result.returncode, 0, result.stderr)
        lines = result.stderr.splitlines()
        for line in lines:
            self.assertTrue(line.startswith('stickslip: case.nml: warning: '), line)
        return lines

    def test_a_contact_that_rings_undamped_is_named_and_so_is_the_remedy(self):
        lines = self.warnings(TEXTBOOK)
        self.assertEqual(len(lines), 1)
        self.assertIn('contact spring (alpha_t) rings undamped', lines[0])
        self.assertIn('rho_infinity = 0', lines[0])
        # the remedy helps: the textbook's period is 0.668, its drop 20.0
        self.assertEqual(self.warnings(TEXTBOOK.replace('dt=1e-4', 'dt=1e-4, rho_infinity=0')), [])
        events = self.rows('case_out/case_events.csv')
        self.assertAlmostEqual(float(events[-1]['recurrence_time']), 0.668, delta=0.004)
        self.assertAlmostEqual(float(events[-1]['stress_drop']), 20.0, delta=0.2)

    def test_a_damped_contact_and_one_that_never_slips_are_left_alone(self):
        self.assertEqual(self.warnings(TEXTBOOK.replace('mass=10', 'mass=10, damping=1e4')), [])
        self.assertEqual(self.warnings(TEXTBOOK.replace('mu_k=0.2', 'mu_k=0.3')), [])
        self.assertEqual(self.warnings(TEXTBOOK.replace('t_end=3', 't_end=0.2')), [])

    def test_what_damps_too_little_is_told_and_remedies_are_right(self):
        """A contact 300 times as stiff as the drive. Textbook: 0.668 and 20.0; steady sliding under a strong damper: mu_k."""
        text = TEXTBOOK.replace('1e8', '1.2e6')
        for time in ('dt=1e-3, rho_infinity=0', 'dt=1e-4, rho_infinity=0', 'dt=1e-4, gamma=0.6, beta=0.31', 'rtol=1e-4',
                     'rtol=1e-4, rho_infinity=0', 'rtol=1e-3, dt=1e-2'):   # the first step of adaptive ones has no say
            lines = self.warnings(text.replace('dt=1e-4', time))
            self.assertEqual(sum('rings undamped' in line for line in lines), 1, time)
            period = [float(row['recurrence_time']) for row in self.rows('case_out/case_events.csv')][1:]
            self.assertGreater(abs(sum(period) / len(period) / 0.668 - 1), 0.05, time)
        self.assertIn("contact = 'rigid'", lines[0])
        self.assertIn('rho_infinity = 0 with dt = 2.88E-03', lines[0])
        self.assertIn('eta_t above 9.81E+04', lines[0])
        for old, new in (('dt=1e-4', "dt=2.88e-3, rho_infinity=0"), ('d_c=1e4', 'd_c=1e4, eta_t=1e5'), ('d_c=1e4', "d_c=1e4, contact='rigid'")):
            calm = text.replace(old, new)
            self.assertEqual(self.warnings(calm.replace('dt=1e-4', 'rtol=1e-5') if 'rigid' in new else calm), [], new)
            events = self.rows('case_out/case_events.csv')
            self.assertAlmostEqual(float(events[-1]['recurrence_time']), 0.668, delta=0.02, msg=new)
            self.assertAlmostEqual(float(events[-1]['stress_drop']), 20.0, delta=0.6, msg=new)
        pair = text.replace('1.2e6', '1.2e4').replace('t_end=3', 't_end=1.2') + '&chain n_blocks=2, coupling=1e3 /'
        for time, told in (('dt=1e-3', 'depend on it. Use eta_t above 9.81E+04'), ('rtol=1e-4', 'Use eta_t above 9.81E+04 in fixed steps')):
            self.assertTrue(any(line.endswith(told) for line in self.warnings(pair.replace('dt=1e-4', time))), time)
        strong = text.replace('mass=10', 'mass=10, damping=1e3').replace('t_end=3', 't_end=2')
        self.assertIn('sticks in between', self.warnings(strong)[0])   # friction 24.4, 25 % too large
        self.assertEqual(self.warnings(strong.replace('dt=1e-4', 'dt=4e-3')), [])
        self.assertAlmostEqual(float(self.rows('case_out/case.csv')[-1]['friction_force']), 19.62, delta=0.01)

    def test_friction_that_drops_at_once_in_two_ways_to_move_asks_for_continuous_time(self):
        text = """&friction law='static_kinetic', alpha_n=4655, alpha_t=10761, mu_s=0.427, mu_k=0.15, d_c=2122 /
            &slider mass=2.908e-5, stiffness=4.6, area=0.326, normal_traction=1, normal_mass=1e-5, normal_stiffness=1.96,
                tilt_stiffness=-1.38 /
            &drive velocity=3.77e-3 / """
        told = [line for line in self.warnings(text + '&time t_end=12.5, rtol=1e-5, beta=0.25 /') if 'energy balance' in line]
        self.assertEqual(len(told), 1)
        self.assertIn('use adaptive steps (rtol) without beta, gamma and rho_infinity', told[0])
        for time in ('rtol=1e-5', 'dt=1e-4'):
            told = self.warnings(text + f'&output interval=1000 /\n&time t_end=12.5, {time} /')
            self.assertFalse([line for line in told if 'energy balance' in line])

    def test_energy_that_is_out_of_balance_is_told_with_its_part(self):
        lines = self.warnings(CHAIN)
        told = [line for line in lines if 'energy balance has an error of' in line]
        self.assertEqual(len(told), 1)
        said = float(told[0].split('error of')[1].split('%')[0])
        summary = self.run_text(CHAIN, '--no-plot').stdout
        unbalanced = float(summary.split('unbalanced')[1].split()[0])
        work = float(summary.split('work of the drive')[1].split()[0])
        self.assertGreater(abs(unbalanced / work), 0.02)
        self.assertAlmostEqual(said, 100 * abs(unbalanced / work), delta=0.1)

    def test_the_remedy_for_an_open_balance_is_one_that_the_input_has(self):
        told = [line for line in self.warnings(CHAIN) if 'energy balance' in line]
        self.assertTrue(told[0].endswith('use shorter steps (dt), or adaptive steps (rtol)'), told)
        told = [line for line in self.warnings(CHAIN.replace('dt=0.01', 'rtol=1e-3, rho_infinity=0.5').replace(
            't_end=300', 't_end=150')) if 'energy balance' in line]
        self.assertTrue(told[0].endswith('use a smaller rtol; energy that rho_infinity or gamma damps is part of this error'), told)

    def test_a_step_too_long_for_the_slip(self):
        lasts = math.pi * math.sqrt(1e-3)   # of the slider of test_program
        long = {('time', 't_end'): '12', ('time', 'rho_infinity'): '0'}
        lines = self.warnings(namelist({**long, ('time', 'dt'): str(0.3 * lasts)}))
        self.assertTrue(any('the step dt = 2.98E-02 is long for slip events' in line for line in lines), lines)
        self.assertEqual(self.warnings(namelist({('time', 't_end'): '12'})), [])   # dt = 1e-3
        # no slip is too fast for a block that does not stick
        slow = (INPUTS / 'slow_steady.nml').read_text().replace('dt = 1e-3', 'dt = 1e-2')
        self.assertFalse(any('long for slip' in line for line in self.warnings(slow)))

    def test_a_state_that_leaves_the_range_of_numbers_as_the_load_vanishes(self):
        text = ("&friction law='linker_dieterich', alpha_n=50, alpha_t=50, a=0.01, b=0.015, d_c=0.02, v0=0.01, f0=0.6, alpha={} /\n"
                '&slider mass=0.01, stiffness=1, damping=0.05, normal_traction=1 /\n'
                '&drive velocity=0.1, normal_amplitude={}, normal_frequency=0.25 /\n&time t_end=0.5, {} /\n')
        told = self.warnings(text.format(0.405, 1.3, 'dt=1e-2'))
        self.assertEqual(len(told), 1)
        self.assertIn('(alpha is 27.0 times b) that the contact counts as open too early', told[0])
        for calm in ((0.1, 1.3, 'dt=1e-2'), (0.405, 0.9, 'dt=1e-2'), (0.405, 1.3, 'rtol=1e-4')):
            self.assertEqual(self.warnings(text.format(*calm)), [])

    def test_a_measured_file_that_ends_before_the_run(self):
        (self.folder / 'drive.csv').write_text('time,velocity\n0,1\n2,1\n')
        text = namelist({('drive', 'file'): "'drive.csv'", ('time', 't_end'): '2'}, [('drive', 'velocity')])
        self.assertEqual(self.warnings(text), [])
        lines = self.warnings(text.replace('t_end = 2', 't_end = 3'))
        self.assertEqual(len(lines), 1)
        self.assertIn('the file of the drive ends at time  2.00000E+00, before t_end', lines[0])

    def test_sweeps_have_a_column_of_them(self):
        sweep = TEXTBOOK + "&sweep key='slider%damping', values=0, 1e4 /"
        self.assertEqual(self.warnings(sweep, verb='sweep'), [])
        rows = self.rows('case_out/case_sweep.csv')
        self.assertEqual([row['warnings'] for row in rows], ['undamped_contact', ''])

    def test_the_inputs_of_the_project_have_none(self):
        for name in ('stick_slip', 'slow_steady', 'velocity_steps', 'adaptive', 'oscillating_normal', 'from_file'):
            (self.folder / 'from_file.csv').write_text((INPUTS / 'from_file.csv').read_text())
            self.assertEqual(self.warnings((INPUTS / f'{name}.nml').read_text()), [], name)


if __name__ == '__main__':
    unittest.main()
