"""Loading programmes, the initial state, and the quasi-static mode, as a user meets them."""
import math
import unittest

from strict_build import release_only
from test_program import LAWS, Program, law_namelist, namelist
from worst_errors import worst_of


class Columns(Program):
    def run_columns(self, text):
        result = self.run_text(text, '--no-plot')
        self.assert_done(result)
        rows = self.rows('case_out/case.csv')
        return {key: [float(row[key]) for row in rows] for key in rows[0]}

    def with_file(self, content, *changes):
        (self.folder / 'load.csv').write_text(content)
        return namelist({('drive', 'file'): "'load.csv'", **dict(changes)},
                        without=[('drive', 'velocity')])


class Programme(Columns):
    def test_displacement_from_a_file_is_linear_between_its_rows(self):
        run = self.run_columns(self.with_file('time,displacement\n0,5\n0.04,5.08\n0.06,5.0\n'))
        for k, t in enumerate(run['time']):
            expected = 2 * t if t <= 0.04 else max(0.08 - 4 * (t - 0.04), 0.0)
            self.assertAlmostEqual(run['drive'][k], expected, delta=1e-12)

    def test_velocity_from_a_file_is_linear_between_its_rows_and_goes_on(self):
        run = self.run_columns(self.with_file('# ramp\ntime, velocity\r\n0, 1\n\n0.05, 3\n'))
        for k, t in enumerate(run['time']):
            ramp = min(t, 0.05)
            self.assertAlmostEqual(run['drive'][k], ramp + 20 * ramp**2 + 3 * (t - ramp), delta=1e-12)

    def test_a_step_of_the_normal_traction_does_not_hang_on_round_off_of_times(self):
        # sums of durations are above or below the multiples of dt (0.30000000000000004, 0.7999999999999999)
        text = namelist({('drive', 'duration'): '10*0.1', ('drive', 'normal'): ', '.join(['10', '20'] * 5), ('time', 't_end'): '0.96',
                         ('time', 'dt'): '0.02'})
        run = self.run_columns(text)
        for t, normal in zip(run['time'], run['normal_traction']):
            self.assertEqual(normal, 10 if int(t / 0.1 + 1e-6) % 2 == 0 else 20, t)

    def test_file_is_found_beside_the_input_file(self):
        (self.folder / 'deep').mkdir()
        (self.folder / 'deep/load.csv').write_text('time,velocity\n0,1\n1,1\n')
        (self.folder / 'deep/case.nml').write_text(
            namelist({('drive', 'file'): "'load.csv'"}, without=[('drive', 'velocity')]))
        self.assertEqual(self.run_program('check', 'deep/case.nml').returncode, 0)

    PLAIN = 'time,displacement,normal\n0,0,10\n0.05,0.05,10\n0.1,0.2,20\n'

    def test_tables_are_read_as_rigs_and_spreadsheets_write_them(self):
        expected = self.run_columns(self.with_file(self.PLAIN))
        for content in (
                self.PLAIN.replace(',', ';'), self.PLAIN.replace(',', '\t'), self.PLAIN.replace(',', '   '),
                self.PLAIN.replace(',', ';').replace('.', ','), self.PLAIN.replace('\n', '\r\n'), '\ufeff' + self.PLAIN,
                'time,force,displacement,normal\n0,x,0,10\n0.05,,0.05,10\n0.1,7,0.2,20\n',
                '"time","displacement","normal"\n"0","0","10"\n"0,05","0,05","10"\n"0,1","0,2","20"\n',
                'Rig 7, operator X\nDate: 2024-01-01\n' + self.PLAIN,
                '# a\n% b\n\n' + self.PLAIN.replace('\n0.05', '\n# c\n0.05'), '# ' + self.PLAIN, '%' + self.PLAIN.replace(',', ' '),
                'Time [s],DISPLACEMENT (mm),Normal/MPa\n[s],mm,MPa\n' + self.PLAIN.split('\n', 1)[1],
                'time,displacement,normal\nTest,Test,Test\ns,-,mm^2\n' + self.PLAIN.split('\n', 1)[1],
                'time,displacement,normal,\n12.5,3,10,\n12.55,3.05,10,\n12.6,3.2,20,\n,,,\n,,,\n',
                'time,displacement,normal\n-1e1,0,1D1\n-9.95,0.05,+10.\n-9.9,.2,20,,\n',
                '"  time"; "displacement"; "normal"\n"   0"; "   0"; "  10"\n"0.05 "; "0.05"; "10"\n"  .1"; " .2"; "20"\n',
                'X_Value\n***End_of_Header***\ntime\tdisplacement\tnormal\tComment\n0\t0\t10\tstart\n0.05\t0.05\t10\n0.1\t0.2\t20\n'):
            run = self.run_columns(self.with_file(content))
            for key in ('drive', 'displacement', 'friction_force'):
                for a, b in zip(run[key], expected[key]):
                    self.assertAlmostEqual(a, b, delta=1e-9, msg=content)   # round-off of times that start elsewhere

    def test_rows_of_units_are_left_alone(self):
        expected = self.run_columns(self.with_file(self.PLAIN))
        head, rows = self.PLAIN.split('\n', 1)
        for units in ('s,1/s,N m^-2', '1/min,mm/s^2,-', 'h,µm,°C', '[1/s],(1/s),1', '1 / s,10^-3 m,10^3 N', 'min,0.1 mm,1',
                      '10^6,"1/°C",--', ',1/s,', '%,%,%', 's,m,#', '1/(N m),1*s,%', 'min,m s-1,1', '10 s,1E-3 mm,1/µm'):
            for more in ('', '-,-,-\n'):
                run = self.run_columns(self.with_file(f'{head}\n{units}\n{more}{rows}'))
                self.assertEqual(run['friction_force'], expected['friction_force'], units)

    def test_dates_times_and_typing_errors_are_no_units(self):
        head, rows = self.PLAIN.split('\n', 1)
        for row in ('1/2/2026,0,10', '12:30,12:31,12:32', '2026-11-26,0,10', '10 000,0,10', '1.2.3,0,10', '0,1/s,10', '1_0,1_0,1_0',
                    '1/2,1/2,1/2', 'NaN,s,s', '1e5x,1,1', '1,m,N'):
            self.refused(self.with_file(f'{head}\n{row}\n{rows}'), 'line 2: ')
        self.refused(self.with_file(f'{head}\n1,1,1\n{rows}'), 'line 3: time must be larger')
        self.refused(self.with_file(f'{head}\n0 s,0 m,10 N\n1 s,1 m,10 N\n2 s,2 m,10 N\n{rows}'), "line 4: time = '2 s'")

    def test_utf_16_is_read(self):
        expected = self.run_columns(self.with_file(self.PLAIN))
        for code in ('utf-16-le', 'utf-16-be'):
            text = self.with_file(self.PLAIN)
            for start in ('\ufeff# \u00b5m \U0001f600\n', ''):   # with a mark and without
                (self.folder / 'load.csv').write_bytes((start + self.PLAIN).encode(code))
                self.assertEqual(self.run_columns(text), expected)

    def test_latin_1_is_read(self):
        # as rigs in Europe write it: the name of a column in a namelist of UTF-8, a degree sign in a unit, the unit of a millionth
        expected = self.run_columns(self.with_file(self.PLAIN))
        text = self.with_file(self.PLAIN, (('drive', 'time_column'), "'Prüfzeit'"), (('drive', 'normal_column'), "'Kraft [N/mm²]'"))
        content = self.PLAIN.replace('time', 'Prüfzeit').replace('normal', 'Kraft [N/mm²]').replace('displacement', 'Displacement [µm]')
        for code in ('latin-1', 'utf-8'):
            (self.folder / 'load.csv').write_bytes(('# 20 °C\n' + content).encode(code))
            self.assertEqual(self.run_columns(text), expected)
        (self.folder / 'case.nml').write_bytes(('! 20 °C\n' + text).encode('latin-1'))
        self.assert_done(self.run_program('run', 'case.nml', '--no-plot'))

    def test_commas_that_may_part_thousands_are_refused(self):
        rows = '0,0,10\n10,100,10\n20,"1,000",10\n30,"2,500",10\n'
        self.assertIn('line 4: displacement = \'1,000\': is its comma a decimal mark or a thousands separator?',
                      self.run_text(self.with_file('time,displacement,normal\n' + rows), verb='check').stderr)
        for content in (rows.replace('10\n30', '"10,5"\n30'), rows.replace('0,0,10', '"0,000",0,10')):   # one tells of all
            self.assert_done(self.run_text(self.with_file('time,displacement,normal\n' + content), verb='check'))
        semicolons = 'time;displacement;normal\n0;0;10\n10;1,000;10\n'
        self.assert_done(self.run_text(self.with_file(semicolons), verb='check'))

    def test_columns_and_factors_are_chosen_by_keys(self):
        expected = self.run_columns(self.with_file(self.PLAIN))
        content = ('Zeit;time;Weg;velocity;displacement;Kraft\n5000;0;0;9;9;-10000\n5050;0;50;9;9;-10000\n'
                   '5100;0;200;9;9;-20000\n')
        run = self.run_columns(self.with_file(
            content, (('drive', 'time_column'), "'Zeit'"), (('drive', 'time_factor'), '1e-3'),
            (('drive', 'displacement_column'), "'Weg'"), (('drive', 'displacement_factor'), '1e-3'),
            (('drive', 'normal_column'), "'kraft'"), (('drive', 'normal_factor'), '-1e-3')))
        for key in ('time', 'drive', 'displacement', 'friction_force'):
            for a, b in zip(run[key], expected[key]):
                self.assertAlmostEqual(a, b, delta=1e-9)

    def test_a_long_table_is_read_to_its_end(self):
        rows = ''.join(f'{k}.5,1.25,7.5\n' for k in range(200000))
        text = self.with_file('time,velocity,normal\n' + rows + '1e9,x,1\n')
        self.assertIn("line 200002: velocity = 'x'", self.run_text(text, verb='check').stderr)

    def normal_traction(self, text):
        """Sliding blocks show the normal traction: friction / (R mu)."""
        run = self.run_columns(text)
        return run['time'], [force / (r * mu) for force, r, mu
                             in zip(run['friction_force'], run['R'], run['mu'])]

    sliding = {('initial', 'r'): '1', ('initial', 'velocity'): '1', ('drive', 'velocity'): '1'}

    def test_normal_traction_from_a_file_is_linear_between_its_rows(self):
        text = self.with_file('time,velocity,normal\n0,1,10\n0.05,1,20\n', (('initial', 'r'), '1'),
                              (('initial', 'velocity'), '1')).replace('normal_traction = 10', '')
        for t, normal in zip(*self.normal_traction(text)):
            self.assertAlmostEqual(normal, 10 + 200 * min(t, 0.05), delta=1e-10)

    def test_normal_traction_ramps_to_each_value_within_its_duration(self):
        text = namelist({**self.sliding, ('drive', 'normal'): '10, 20', ('drive', 'duration'): '0.02, 0.04',
                         ('drive', 'normal_change'): "'ramp'"})
        for t, normal in zip(*self.normal_traction(text)):
            self.assertAlmostEqual(normal, 10 + 250 * min(max(t - 0.02, 0), 0.04), delta=1e-10)

    def test_the_first_ramp_starts_from_the_normal_traction_of_the_slider(self):
        ramp = {**self.sliding, ('drive', 'normal'): '20, 15', ('drive', 'duration'): '0.02, 0.04', ('drive', 'normal_change'): "'ramp'"}
        self.refused(namelist({**ramp, ('drive', 'normal'): '20'}, [('drive', 'duration')]), "normal_change = 'ramp': needs the key duration")
        for t, normal in zip(*self.normal_traction(namelist(ramp))):
            self.assertAlmostEqual(normal, 10 + 500 * min(t, 0.02) - 125 * min(max(t - 0.02, 0), 0.04), delta=1e-10)
        one = {**ramp, ('drive', 'normal'): '20', ('drive', 'duration'): '0.05'}   # a single piece; without the key it is held
        for more, start in (([], 10), ([('slider', 'normal_traction')], 20)):
            for t, normal in zip(*self.normal_traction(namelist(one, more))):
                self.assertAlmostEqual(normal, start + (20 - start) / 0.05 * min(t, 0.05), delta=1e-10)

    def test_normal_traction_oscillates(self):
        text = namelist({**self.sliding, ('drive', 'normal_amplitude'): '4',
                         ('drive', 'normal_frequency'): '3', ('drive', 'normal_phase'): '0.5'})
        for t, normal in zip(*self.normal_traction(text)):
            self.assertAlmostEqual(normal, 10 + 4 * math.sin(6 * math.pi * t + 0.5), delta=1e-10)


class InitialState(Columns):
    def test_block_starts_as_told_and_in_equilibrium(self):
        run = self.run_columns(namelist({('initial', 'mu'): '0.3', ('initial', 'r'): '0.5',
                                         ('initial', 'displacement'): '2', ('initial', 'velocity'): '0.1'}))
        self.assertEqual([run[key][0] for key in ('mu', 'R', 'displacement', 'velocity', 'acceleration')],
                         [0.3, 0.5, 2.0, 0.1, 0.0])
        self.assertAlmostEqual(run['friction_force'][0], 1.5, delta=1e-15)
        self.assertAlmostEqual(run['spring_force'][0], 1.5 + 0.01 * 0.1, delta=1e-15)
        self.assertAlmostEqual(run['friction_force'][1], 1.5, delta=0.2)   # the contact takes it up

    def test_a_spring_force_out_of_balance_accelerates_the_block(self):
        run = self.run_columns(namelist({('initial', 'spring_force'): '2'}))
        self.assertAlmostEqual(run['acceleration'][0], 2000.0, delta=1e-9)

    def test_a_block_in_steady_sliding_stays_in_it(self):
        mu = (10 * 0.2 + 10 * 0.4) / 20
        run = self.run_columns(namelist({('initial', 'mu'): repr(mu), ('initial', 'r'): '1',
                                         ('initial', 'velocity'): '1', ('slider', 'damping'): '1',
                                         ('time', 't_end'): '1'}))
        self.assertLess(worst_of(abs(v - 1) for v in run['velocity']), 1e-8)
        self.assertLess(worst_of(abs(m - mu) for m in run['mu']), 1e-8)

    def test_a_block_in_steady_sliding_with_rate_and_state_friction_stays_in_it(self):
        text = law_namelist('rate_and_state').replace('velocity = 1\n', 'velocity = 1e-3\n')
        text += '&initial mu = 0.6, velocity = 1e-3 /'
        for steps in ('dt = 1e-3', 'rtol = 1e-7'):
            run = self.run_columns(text.replace('dt = 1e-3', steps))
            self.assertAlmostEqual(run['friction_force'][0], 6.0, delta=1e-14)
            self.assertLess(worst_of(abs(v - 1e-3) for v in run['velocity']), 1e-9)
            self.assertLess(worst_of(abs(mu - 0.6) for mu in run['mu']), 1e-8)
            self.assertLess(worst_of(abs(theta - 10) for theta in run['theta']), 1e-5)

    def test_the_friction_coefficient_at_the_start_is_that_of_the_law_however_little_is_carried(self):
        # where an elastic contact has a strength it is the strength's, under a law of the slip rate what is carried but for cohesion
        for law in LAWS:
            text = law_namelist(law, cohesion='1')
            plain, shifted, loaded = (self.run_columns(text + start) for start in (
                '', '&initial displacement = 2 /', '&initial mu = 0.25 /'))
            self.assertEqual(plain['mu'], shifted['mu'], law)
            self.assertAlmostEqual(loaded['friction_force'][0], 2.5, delta=1e-14)
            self.assertAlmostEqual(loaded['mu'][0], 0.15 if 'f0' in LAWS[law] else plain['mu'][0], delta=1e-14, msg=law)

    def test_energy_that_was_there_at_the_start_is_booked(self):
        result = self.run_text(namelist({('initial', 'spring_force'): '2', ('time', 'dt'): '1e-5'}),
                               '--no-plot')
        unbalanced = float(result.stdout.split('unbalanced')[1].split()[0])
        self.assertIn('less the start', result.stdout)
        self.assertLess(abs(unbalanced), 1e-4)


class QuasiStatic(Columns):
    steady = {('slider', 'mass'): '0', ('slider', 'stiffness'): '100', ('friction', 'xi'): '1',
              ('slider', 'damping'): '0', ('time', 't_end'): '10', ('time', 'dt'): '5e-3',
              ('output', 'interval'): '10'}

    def test_steady_sliding_settles_at_the_closed_form(self):
        run = self.run_columns(namelist({**self.steady, ('drive', 'velocity'): '0.1'}))
        mu = (10 * 0.1 * 0.2 + 0.4) / 2
        self.assertAlmostEqual(run['mu'][-1], mu, delta=1e-6)
        self.assertAlmostEqual(run['friction_force'][-1], 10 * mu, delta=1e-5)
        self.assertAlmostEqual(run['velocity'][-1], 0.1, delta=1e-6)
        self.assertEqual(worst_of(run['acceleration']), 0.0)
        for spring, friction in zip(run['spring_force'], run['friction_force']):
            self.assertAlmostEqual(spring, friction, delta=1e-9 * (1 + abs(friction)))

    def test_mu_recovers_in_a_hold_by_the_closed_form(self):
        run = self.run_columns(namelist({**self.steady, ('drive', 'velocity'): '0.1, -20, 0',
                                         ('drive', 'duration'): '4.99, 0.01, 10', ('time', 'dt'): '1e-3'}))
        # unloaded by the drive's jump back, the block rests
        start = min(k for k, t in enumerate(run['time']) if t >= 5.1)
        for k in range(start, len(run['time'])):
            t = run['time'][k] - run['time'][start]
            self.assertAlmostEqual(run['mu'][k], 0.4 - (0.4 - run['mu'][start]) * math.exp(-t), delta=1e-4)

    def test_velocity_step_relaxes_at_the_rate_of_the_closed_form(self):
        # nearly rigid loading, so that the slip rate follows the drive at once
        run = self.run_columns(namelist({**self.steady, ('drive', 'velocity'): '0.1, 0.2',
                                         ('drive', 'duration'): '8, 10', ('slider', 'stiffness'): '1e5',
                                         ('time', 't_end'): '9', ('time', 'dt'): '1e-3'}))
        before, after, rate = (2 * 0.1 + 0.4) / 2, (10 * 0.2 * 0.2 + 0.4) / 3, 3.0
        for k, t in enumerate(run['time']):
            if t > 8.05:
                expected = after + (before - after) * math.exp(-rate * (t - 8))
                self.assertAlmostEqual(run['mu'][k], expected, delta=1e-3 * (before - after) + 2e-4)

    def test_an_unstable_slider_says_so_and_when(self):
        changes = {**self.steady, ('slider', 'stiffness'): '1', ('drive', 'velocity'): '1',
                   ('time', 't_end'): '20'}
        result = self.run_text(namelist(changes), '--no-plot')
        self.assertEqual(result.returncode, 1)
        self.assertRegex(result.stderr, r'the run failed at time  ?[\d.E+]+, step \d+: the slider is unstable')
        self.assertGreater(len(self.rows('case_out/case.csv')), 10)

    def test_the_last_row_of_a_run_that_fails_is_its_last_state(self):
        # there the block is about to jump, whatever rows were asked for
        unstable = {**self.steady, ('slider', 'stiffness'): '1', ('drive', 'velocity'): '1', ('time', 't_end'): '20'}
        del unstable['output', 'interval']
        adaptive = {**unstable, ('time', 'rtol'): '1e-4'}
        for changes, rows in ((unstable, ('interval', '1000')), (adaptive, ('interval', '100000')), (adaptive, ('every', '3'))):
            tables = []
            for key, value in (('interval', '1'), rows):
                text = namelist({**changes, ('output', key): value})
                self.assertEqual(self.run_text(text, '--no-plot').returncode, 1)
                tables.append((self.folder / 'case_out/case.csv').read_text().splitlines())
            whole, few = tables
            if rows[0] == 'interval':
                self.assertEqual(few[1:], [whole[1], whole[-1]])
            else:   # which has steps of its own
                self.assertEqual([float(row.split(',')[0]) for row in few[1:-1]], [0, 3])
                self.assertAlmostEqual(float(few[-1].split(',')[0]), float(whole[-1].split(',')[0]), delta=1e-3)

    def test_a_surface_that_weakens_with_slip_is_unstable_in_the_same_words(self):
        changes = {('slider', 'mass'): '0', ('slider', 'damping'): '0', ('slider', 'stiffness'): '100', ('drive', 'velocity'): '0.1',
                   ('time', 't_end'): '1'}
        text = namelist(changes, [('friction', None)]) + ("&friction law='slip_weakening', alpha_n=1000, alpha_t=1000, "
                                                          'mu_s=0.4, mu_k=0.2, d_c=0.01 /\n')
        result = self.run_text(text, '--no-plot')
        self.assertEqual(result.returncode, 1)
        self.assertIn('the slider is unstable without inertia', result.stderr)

    def test_stiffness_at_which_the_slider_becomes_unstable(self):
        # theory.md, section 6, at mu_ss: unstable iff K k_t/(K + k_t) < A
        a = 10 * 10 * ((10 * 0.1 * 0.2 + 0.4) / 2 - 0.2)
        critical = 1000 * a / (1000 - a)
        for factor, status in ((0.85, 1), (1.15, 0)):
            changes = {**self.steady, ('drive', 'velocity'): '0.1',
                       ('slider', 'stiffness'): repr(factor * critical),
                       ('initial', 'mu'): '0.3001', ('initial', 'r'): '1', ('time', 't_end'): '40'}
            self.assertEqual(self.run_text(namelist(changes), '--no-plot').returncode, status)


class PressureInTheState(Columns):
    """Linker and Dieterich's state has no bound as the pressure vanishes; theta p^(alpha/b) has a limit."""

    def test_the_state_after_an_opening_does_not_hang_on_where_in_a_step_it_comes(self):
        # a block at 0.9 slips 45 dt d_c in a step, by which ln theta is uncertain; it was off by 10 and 40, whatever dt
        text = ("&friction law='linker_dieterich', alpha_n=50, alpha_t=50, a=0.01, b=0.015, d_c=0.02, v0=0.01, f0=0.6, alpha=0.1 /\n"
                '&slider mass=0.01, stiffness=1, damping=0.05, normal_traction=1{} /\n&drive velocity=0.1, normal_amplitude=1.3, '
                'normal_frequency=0.25, normal_phase={} /\n{}&output interval=1000000 /\n&time t_end=4.2, {} /\n')
        for across, chain in (('', ''), (', normal_mass=0.02, normal_damping=0.5', ''), ('', '&chain n_blocks=2, coupling=0 /\n')):
            for phase in (0, 0.01):
                right = math.log(self.run_columns(text.format(across, phase, '', 'rtol=1e-7'))['theta'][-1])
                for dt in (1.7e-3, 4.1e-4):
                    theta = self.run_columns(text.format(across, phase, chain, f'dt={dt}'))['theta'][-1]
                    self.assertLess(abs(math.log(theta) - right), 45 * dt, (across, chain, phase, dt))


class Balance(Columns):
    """One block has a balance of forces in every fixed step, found where Newton's method alone goes astray."""
    cases = (
        ("law='rate_and_state', alpha_t=79720000.0, a=0.01, b=0.08873, d_c=4.933e-07, v0=1e-6, f0=0.3",
         'mu=0.35', 0.015148, 0.007574),
        ("law='static_kinetic', alpha_t=1e9, mu_s=0.3, mu_k=0.2, d_c=1e4", 'mu=0.29999', 0.002, 1e-4),
        ("law='subloading', alpha_t=967600000.0, mu_s=0.3, mu_k=0.2, kappa=84850000.0, xi=213.8, m=1921000.0",
         'r=0.99', 0.0013528, 0.0006764))

    def test_steps_onto_a_stiff_contact_that_weakens_find_their_balance(self):
        for law, initial, t_end, dt in self.cases:
            run = self.run_columns(f'&friction {law}, alpha_n=1e8 /\n&slider mass=10, stiffness=4000, normal_traction=98.1 /\n'
                                   f'&drive velocity=0.01 /\n&initial {initial} /\n&time t_end={t_end}, dt={dt} /\n')
            self.assertEqual(len(run['time']), round(t_end / dt) + 1)
            for spring, friction, a in zip(run['spring_force'][1:], run['friction_force'][1:], run['acceleration'][1:]):
                self.assertLess(abs(spring - friction - 10 * a), 1e-10 * (abs(spring) + abs(friction) + 10 * abs(a)))


class Opening(Columns):
    """A normal traction below zero opens the contact, and cohesion ends with it."""
    laws = ("law='coulomb', mu=0.6", "law='subloading', mu_s=0.6, mu_k=0.5, kappa=26, xi=1.7, m=40",
            "law='slip_weakening_healing', mu_s=0.7, mu_k=0.3, d_c=0.2, xi=0.15",
            "law='rate_and_state', a=0.01, b=0.014, d_c=0.01, v0=0.01, f0=0.6")

    def test_adaptive_steps_agree_with_small_fixed_ones_and_nothing_is_carried_while_it_is_open(self):
        for law in self.laws:
            for cohesion in (0, 0.2):
                with self.subTest(law=law, cohesion=cohesion):
                    text = (f'&friction {law}, alpha_n=50, alpha_t=500, cohesion={cohesion} /\n&slider mass=0.01, stiffness=1, '
                            'damping=0.05, normal_traction=1 /\n&drive velocity=0.2, normal_amplitude=1.2, normal_frequency=0.1 /\n')
                    fixed = self.run_columns(text + '&time t_end=20, dt=1e-3 /\n&output interval=100 /\n')
                    adaptive = self.run_columns(text + '&time t_end=20, rtol=1e-7 /\n&output every=0.1 /\n')
                    self.assertEqual(len(fixed['time']), len(adaptive['time']))
                    opened = 0
                    for row, one in enumerate(fixed['spring_force']):   # an error in time of dt at each opening
                        self.assertAlmostEqual(one, adaptive['spring_force'][row], delta=1e-3)
                        for run in (fixed, adaptive):
                            self.assertGreaterEqual(run['normal_traction'][row], 0)
                            if 1 + 1.2 * math.sin(0.2 * math.pi * run['time'][row]) < -1e-3:
                                opened += 1
                                self.assertEqual((run['friction_force'][row], run['normal_traction'][row]), (0, 0))
                    self.assertGreater(opened, 50)

    def test_a_closed_contact_without_normal_traction_carries_its_cohesion(self):
        for time in ('dt=1e-3', 'rtol=1e-6'):
            run = self.run_columns("&friction law='coulomb', alpha_n=50, alpha_t=500, mu=0.6, cohesion=0.2 /\n&slider mass=0.01, "
                                   'stiffness=1, damping=1 /\n&drive velocity=0.2, normal=0 /\n&time t_end=20, ' + time + ' /\n')
            self.assertAlmostEqual(run['friction_force'][-1], 0.2, delta=1e-9)


RADAU_ONSETS = (37847148.4, 322538406.0, 606768808.0, 890999216.0, 1175229620.0, 1459460030.0, 1743690430.0, 2027920840.0,
                2312151250.0, 2596381650.0, 2880612060.0)


class ContinuousTime(Columns):
    """Adaptive steps of one block follow its rate equations."""
    def summary(self, text, *keys, warning=''):
        result = self.run_text(text, '--no-plot')
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(len(result.stderr.splitlines()), len(warning.splitlines()), result.stderr)
        self.assertIn(warning, result.stderr)
        return [float(result.stdout.split(key)[1].split()[0]) for key in keys]

    def events(self):
        return [{key: float(value) for key, value in row.items()} for row in self.rows('case_out/case_events.csv')]

    def test_a_free_block_stops_where_friction_has_taken_its_energy(self):
        text = ("&friction law='coulomb', alpha_n=1e6, alpha_t=1e6, mu=0.3 /\n&slider mass=1, stiffness=1e-6, "
                'normal_traction=9.8 /\n&drive velocity=0 /\n&initial velocity=10, spring_force=0, mu=0.3 /\n')
        run = self.run_columns(text + '&time t_end=6, rtol=1e-6 /\n')
        self.assertAlmostEqual(run['displacement'][-1], 10**2 / (2 * 0.3 * 9.8), delta=1e-4)   # the spring takes 5e-5

    def test_a_swing_that_turns_back_from_beyond_zero_traction_slips_there(self):
        # own integration of the rate equations; the drive turns back, and the traction follows with a swing
        mass, damping, stiffness, pressure = 0.22271517813391495, 9.45411119576097e-4, 0.29654880580196913, 6.196072420702041
        alpha, mu_s, mu_k, kappa, xi, m, speed = (3.5821407509404075, 0.30990858823653683, 0.175715557484935, 2.1541017020878632,
                                                  3.7292312990149655e-3, 1.2355569279471057, 0.16081704156866258)
        turn, end, step = 103.3522577647973, 140.0, 0.004

        def rates(drive, x, v, u, mu):
            sense = math.copysign(1, u)
            r = min(1, max(abs(u) * alpha / (mu * pressure), 1e-300))
            heal = xi * (mu_s - mu)
            slip = max(0, (sense * alpha * v - r * heal * pressure)
                       / (alpha - m * math.log(r) * mu * pressure - r * pressure * kappa * (mu - mu_k)))
            return (v, (stiffness * (drive - x) - damping * v - alpha * u) / mass, v - sense * slip, heal - kappa * (mu - mu_k) * slip)

        def follow(state, start, duration, drive):
            n = math.ceil(duration / step)
            h = duration / n
            for i in range(n):
                stages = [(0.0,) * 4]
                for part in (0, 0.5, 0.5, 1):
                    stages.append(rates(drive(start + (i + part) * h), *(y + part * h * k for y, k in zip(state, stages[-1]))))
                state = [y + h / 6 * (a + 2 * (b + c) + d) for y, a, b, c, d in zip(state, *stages[1:])]
            return state

        state = follow([0.0, 0.0, 0.0, mu_s], 0.0, turn, lambda t: speed * t)
        state = follow(state, turn, end - turn, lambda t: speed * (2 * turn - t))
        run = self.run_columns(f"""
&friction law='subloading', alpha_n=1000, alpha_t={alpha}, mu_s={mu_s}, mu_k={mu_k}, kappa={kappa}, xi={xi}, m={m} /
&slider mass={mass}, stiffness={stiffness}, damping={damping}, normal_traction={pressure} /
&drive velocity={speed}, {-speed}, duration={turn}, 100 /
&time t_end={end}, rtol=1e-8 /
""")
        self.assertAlmostEqual(run['displacement'][-1] / state[0], 1, delta=1e-6)
        self.assertAlmostEqual(run['mu'][-1], state[3], delta=1e-6)

    def test_the_error_of_a_free_block_follows_the_tolerance(self):
        # subloading friction that heals and a damper: a motion without a closed form
        end = []
        for rtol in ('1e-4', '1e-6', '1e-12'):
            run = self.run_columns(namelist({('slider', 'stiffness'): '1e-6', ('slider', 'damping'): '2e-3', ('drive', 'velocity'): '0',
                                             ('initial', 'velocity'): '100', ('initial', 'spring_force'): '0', ('initial', 'r'): '1',
                                             ('time', 'rtol'): rtol, ('time', 't_end'): '0.04'}, [('time', 'dt')]))
            end.append(run['displacement'][-1])
        self.assertLess(abs(end[0] - end[2]), 1e-3 * end[2])
        self.assertLess(abs(end[1] - end[2]), 1e-5 * end[2])

    def test_a_quasi_dynamic_slider_runs_by_default(self):
        # mass 0, radiation damping, a hundred years; onsets of an implicit Runge-Kutta (Radau) solution at rtol 1e-10
        text = ("&friction law='rate_and_state', alpha_n=1e5, alpha_t=1e5, a=0.01, b=0.014, d_c=1e-3, v0=1e-6, f0=0.6, "
                'theta_0=1e6 /\n&slider mass=0, stiffness=41.25, damping=5, normal_traction=100 /\n&drive velocity=1e-9 /\n'
                '&initial mu=0.627 /\n&time t_end=3.15e9, rtol=1e-5 /\n')
        steps, work, unbalanced = self.summary(text, 'steps', 'work of the drive', 'unbalanced')
        self.assertLess(steps, 5000)
        self.assertLess(abs(unbalanced), 1e-3 * work)
        events = self.events()
        self.assertEqual(len(events), 11)
        for event, onset in zip(events, RADAU_ONSETS):
            self.assertLess(abs(event['onset'] - onset), 2.5e-4 * onset)

    inertial = ("&friction law='rate_and_state', alpha_n=1e10, alpha_t=1e10, a=0.0144, b=0.02312, d_c=0.09, v0=1e-3, f0=0.64395 /\n"
                '&slider mass=60e6, stiffness=1e6, normal_traction=20e6 /\n&drive velocity=1e-3 /\n&initial mu=0.60 /\n'
                '&time t_end=40000, rtol=1e-5 /\n')

    def test_an_inertial_rate_and_state_slider_takes_few_steps(self):
        self.assertLess(self.summary(self.inertial, 'steps')[0], 15000)
        last = self.events()[-1]
        self.assertAlmostEqual(last['recurrence_time'], 3778.623, delta=0.06)
        self.assertAlmostEqual(last['stress_drop'], 3.55e6, delta=1e3)

    def test_a_rigid_contact_needs_no_stiffness_of_its_spring(self):
        friction = "&friction contact='rigid', law='coulomb', alpha_n=1000, mu=0.4"
        rest = ' /\n&slider mass=1, stiffness=1, normal_traction=1 /\n&drive velocity=1 /\n&time t_end=5, rtol=1e-6 /\n'
        tables = set()
        for spring in ('', ', alpha_t=100', ', alpha_t=1e9'):
            self.run_columns(friction + spring + rest)
            tables.add((self.folder / 'case_out/case.csv').read_bytes())
        self.assertEqual(len(tables), 1)
        result = self.run_text(friction + rest + '&chain n_blocks=3, coupling=1 /', verb='check')
        self.assertEqual(result.stderr.count('&friction'), 1, result.stderr)
        self.assertIn("contact = 'rigid': needs adaptive steps (&time rtol) of one block", result.stderr)
        result = self.run_text(friction.replace('rigid', 'elastic') + rest, verb='check')
        self.assertIn('&friction alpha_t: is missing and has no default', result.stderr)

    def test_a_rigid_contact_is_the_limit_of_stiff_ones(self):
        # scipy's Radau at rtol 1e-9: 3778.0755
        steps, = self.summary(self.inertial.replace('&friction', "&friction contact='rigid',").replace('1e-5 /', '1e-7 /'), 'steps')
        self.assertLess(steps, 10000)
        self.assertAlmostEqual(self.events()[-1]['recurrence_time'], 3778.0755, delta=0.01)
        self.summary(self.inertial.replace('alpha_t=1e10', 'alpha_t=1e12').replace('1e-5 /', '1e-7 /'), 'steps')
        self.assertAlmostEqual(self.events()[-1]['recurrence_time'], 3778.0755, delta=0.02)

    def steps_in_units(self, friction, slider, drive, time):
        """Numbers of steps of a run in three systems of units; keys with the powers of length and time in their units."""
        steps = []
        for length, second in ((1.0, 1.0), (2.0**-29, 2.0**23), (2.0**20, 2.0**-14)):
            def group(name, keys):
                return f'&{name} ' + ', '.join(f'{key}={value}' if isinstance(value, str) else f'{key}=' + ', '.join(
                    repr(number * length**powers[0] * second**powers[1]) for number in value)
                    for key, (value, *powers) in keys.items()) + ' /\n'
            steps += self.summary(''.join(map(group, ('friction', 'slider', 'drive', 'time'), (friction, slider, drive, time))), 'steps')
        return steps

    def test_steps_are_few_in_all_units(self):
        # a rigid contact: round-off in the derivatives of its rates would take four times as many, another number in other units
        steps = self.steps_in_units(
            {'law': ("'flash_heating'",), 'contact': ("'rigid'",), 'alpha_n': ([62], -1, 0), 'alpha_t': ([514], -1, 0), 'a': ([0.009], 0, 0),
             'b': ([0.0085], 0, 0), 'd_c': ([0.025], 1, 0), 'v0': ([0.036], 1, -1), 'f0': ([0.58], 0, 0), 'f_w': ([0.17], 0, 0),
             'v_w': ([8.7], 1, -1)},
            {'mass': ([0.2], -1, 2), 'stiffness': ([6.8], -1, 0), 'normal_traction': ([3.7], 0, 0)},
            {'velocity': ([8.7, 0, -8.7], 1, -1), 'duration': ([0.77, 0.39, 0.77], 0, 1)}, {'t_end': ([1.9], 0, 1), 'rtol': ([7e-6], 0, 0)})
        self.assertLess(max(steps), 600)
        self.assertLess(max(steps), 1.02 * min(steps))
        # a damper beside the contact spring: theta, which grows as the pressure vanishes, is known to its own digits, no more
        steps = self.steps_in_units(
            {'law': ("'linker_dieterich'",), 'alpha_n': ([47], -1, 0), 'alpha_t': ([44], -1, 0), 'a': ([0.019], 0, 0), 'b': ([0.0192], 0, 0),
             'd_c': ([0.06], 1, 0), 'v0': ([0.06], 1, -1), 'f0': ([0.66], 0, 0), 'alpha': ([0.168], 0, 0), 'eta_t': ([33], -1, 1)},
            {'mass': ([0.023], -1, 2), 'stiffness': ([0.21], -1, 0), 'normal_traction': ([0.8], 0, 0)},
            {'velocity': ([0.067], 1, -1), 'normal_amplitude': ([0.78], 0, 0), 'normal_frequency': ([0.016], 0, -1)},
            {'t_end': ([150], 0, 1), 'rtol': ([9e-5], 0, 0)})
        self.assertLess(max(steps), 600)
        self.assertLess(max(steps), 1.02 * min(steps))

    def test_slip_far_slower_than_the_drive_is_known_to_its_own_digits(self):
        friction = "&friction contact='rigid', law='rate_and_state', alpha_n=1, alpha_t=1, a=0.015, b=0.0166, d_c=0.0043, v0=0.0027, f0=0.7"
        for slider in ('mass=0.09, damping=0', 'mass=0, damping=0.01'):
            # with a cap, which it reaches at a slip rate of 1e-10: what was lost of that made it come and go for ever
            steps, = self.summary(f'{friction}, tau_max=0.26 /\n&slider {slider}, stiffness=0.24, normal_traction=0.56 /\n'
                                  '&drive velocity=1.27 /\n&time t_end=3, rtol=1e-6 /\n', 'steps')
            self.assertLess(steps, 2000)
            for row in self.rows('case_out/case.csv'):
                mu, theta, velocity = (float(row[key]) for key in ('mu', 'theta', 'velocity'))
                if mu * 0.56 < 0.2599:
                    law = 2 * 0.0027 * math.sinh(mu / 0.015) * math.exp(-(0.7 + 0.0166 * math.log(0.0027 * theta / 0.0043)) / 0.015)
                    self.assertAlmostEqual(velocity, law, delta=1e-8 * law)

    def test_a_rigid_contact_without_mass_is_the_quasi_dynamic_limit(self):
        text = ("&friction contact='rigid', law='rate_and_state', alpha_n=1e5, alpha_t=1e5, a=0.01, b=0.014, d_c=1e-3, v0=1e-6, f0=0.6, "
                'theta_0=1e6 /\n&slider mass=0, stiffness=41.25, damping=5, normal_traction=100 /\n&drive velocity=1e-9 /\n'
                '&initial mu=0.627 /\n&time t_end=3.15e9, rtol=1e-6 /\n')
        self.summary(text, 'steps')
        rigid = self.events()
        self.summary(text.replace("contact='rigid', ", '').replace('alpha_t=1e5', 'alpha_t=1e8'), 'steps')
        self.assertEqual(len(rigid), 11)
        for a, b in zip(rigid, self.events()):
            self.assertLess(abs(a['onset'] - b['onset']), 1e-5 * b['onset'])
            self.assertLess(abs(a['stress_drop'] - b['stress_drop']), 1e-4 * b['stress_drop'])

    textbook = ("&friction law='static_kinetic', alpha_n=1e8, alpha_t=1e8, mu_s=0.3, mu_k=0.2, d_c=1e6 /\n"
                '&slider mass=10, stiffness=4000, normal_traction=98.1 /\n&drive velocity=0.01 /\n&time t_end=4, rtol=1e-8 /\n')

    def test_static_kinetic_friction_on_a_rigid_contact_is_the_textbook_case(self):
        # stick at v = 0, slip against mu_k p: half a swing about mu_k p/K + the drive
        fall, omega = 0.1 * 98.1 / 4000, math.sqrt(4000 / 10)
        period = 2 * fall / 0.01 + 2 / omega * (math.pi - math.atan(fall * omega / 0.01))
        drop = 2 * 4000 * math.hypot(fall, 0.01 / omega)
        self.summary(self.textbook.replace('&friction', "&friction contact='rigid',"), 'steps')
        events = self.events()
        self.assertGreater(len(events), 3)
        for event in events[1:]:
            self.assertAlmostEqual(event['recurrence_time'], period, delta=1e-4)
            self.assertAlmostEqual(event['stress_drop'], drop, delta=1e-2)

    def test_static_kinetic_friction_has_a_solution_on_an_elastic_contact_too(self):
        # to which steps converge; the contact rings, so that it is another one
        onsets = []
        for rtol in ('1e-6', '1e-8', '1e-10'):
            self.summary(self.textbook.replace('1e-8 /', rtol + ' /').replace('t_end=4', 't_end=1.5'), 'steps',
                         warning="Use contact = 'rigid' in &friction and rtol in &time")
            onsets.append([event['onset'] for event in self.events()])
        for first, second, third in zip(*onsets):
            self.assertLess(abs(second - third), 1e-5)
            self.assertLess(abs(second - third), abs(first - third) + 1e-9)

    def test_slip_weakening_softer_than_its_contact_slides_and_stiffer_jumps(self):
        # a block pulled slowly over its peak: at rest it carries mu_k p in the end, and nothing is lost from the books
        for d_c in ('1e-2', '1e-4'):
            text = law_namelist('slip_weakening', d_c=d_c).replace('dt = 1e-3', 'rtol = 1e-8').replace('t_end = 0.1', 't_end = 6')
            work, unbalanced = self.summary(text.replace('damping = 0.01', 'damping = 1'), 'work of the drive', 'unbalanced')
            self.assertLess(abs(unbalanced), 1e-6 * work)

    @release_only
    def test_the_stress_drop_grows_with_the_time_between_events(self):
        # d_c next to nothing: half a swing, damped, against mu_k p; then rest until K V T is the drop again, the strength being
        # mu = mu_s - (mu_s - mu_k) exp(-xi T)
        damping = 2e-3
        share = damping / (2 * math.sqrt(1e-3 * 1))
        swing = 1 + math.exp(-math.pi * share / math.sqrt(1 - share**2))
        for contact, velocity in (('rigid', 0.1), ('rigid', 0.03), ('elastic', 0.1)):
            text = (f"&friction law='slip_weakening_healing', contact='{contact}', alpha_n=1, alpha_t=20, mu_s=0.6, mu_k=0.4, d_c=2e-4, "
                    f'xi=0.05 /\n&slider mass=1e-3, stiffness=1, damping={damping}, area=1000, normal_traction=0.01 /\n'
                    f'&drive velocity={velocity} /\n&time t_end={25 / velocity}, rtol=1e-7 /\n&output every=1 /\n')
            self.summary(text, 'steps')
            events, period = self.events(), 30.0
            for _ in range(200):
                period = swing * 10 * 0.2 * -math.expm1(-0.05 * period) / velocity
            self.assertGreater(len(events), 4)
            self.assertAlmostEqual(events[-1]['recurrence_time'], period, delta=0.01 * period)

    def test_a_cap_under_every_law_is_never_passed(self):
        for law in ('coulomb', 'slip_weakening', 'slip_weakening_healing', 'static_kinetic', 'rate_and_state'):
            text = law_namelist(law, tau_max='1.5').replace('dt = 1e-3', 'rtol = 1e-7').replace('t_end = 0.1', 't_end = 4')
            run = self.run_columns(text)
            self.assertLess(worst_of(run['friction_force']), 1.5 * (1 + 1e-9), law)
            self.assertGreater(max(run['friction_force']), 1.5 * (1 - 1e-9), law)

    MASSLESS = ("&friction law = '{law}', alpha_n = 1e4, alpha_t = 1e6, contact = '{contact}', {constants} /\n"
                '&slider mass = 0, stiffness = 1, damping = {damping}, normal_traction = 1 /\n'
                '&drive velocity = {sign}0.5 /\n&time t_end = 6, rtol = 1e-7 /\n')

    def test_a_damper_alone_tells_the_velocity_under_laws_with_a_yield_point(self):
        # C v = K e - mu(v) p, e' = V - v; Coulomb: K e = mu p + C V (1 - exp(-K (t - t_0)/C)) from t_0 on
        def coulomb(pull):
            return max(0, pull - 0.6) / 0.5

        def static_kinetic(pull):
            low, high = 0, max(0, (pull - 0.4) / 0.5)
            for _ in range(60 if pull > 0.6 else 0):
                v = 0.5 * (low + high)
                low, high = (v, high) if 0.5 * v + 0.4 + 0.2 * math.exp(-2 * v) < pull else (low, v)
            return low
        for law, constants, velocity in (('coulomb', 'mu = 0.6', coulomb),
                                         ('static_kinetic', 'mu_s = 0.6, mu_k = 0.4, d_c = 2', static_kinetic)):
            pulls, h = [0.6], 1e-3   # from onset on
            for _ in range(4800):
                half = pulls[-1] + 0.5 * h * (0.5 - velocity(pulls[-1]))
                pulls.append(pulls[-1] + h * (0.5 - velocity(half)))
            for contact in ('rigid', 'elastic'):
                for sign in ('', '-'):
                    run = self.run_columns(self.MASSLESS.format(law=law, constants=constants, contact=contact, damping=0.5,
                                                                sign=sign))
                    with self.subTest(law=law, contact=contact, sign=sign):
                        for t, force in zip(run['time'], run['spring_force']):
                            if t < 1.2:
                                self.assertAlmostEqual(abs(force), 0.5 * t, delta=1e-6)
                                continue
                            i = min(int((t - 1.2) / h), 4799)
                            truth = pulls[i] + ((t - 1.2) / h - i) * (pulls[i + 1] - pulls[i])
                            self.assertAlmostEqual(abs(force), truth, delta=3e-6)

    QUIET = ("&friction alpha_n=1e4, alpha_t=1e4, {friction} /\n&slider mass=1, stiffness=100, damping={damping}, normal_traction=10 /\n"
             '&drive velocity={v} /\n&time t_end={end}, rtol=1e-5 /\n')

    def test_slow_drives_are_stepped_over_while_the_block_swings_below_the_tolerance(self):
        # explicit steps would swing with it, 1e14 times
        v, end = 1e-10, 1e12
        for damping in (0, 0.01, 1, 30):
            for contact in ('elastic', 'rigid'):
                for friction in ("law='coulomb', mu=0.3", "law='slip_weakening', mu_s=0.3, mu_k=0.2, d_c=0.1"):
                    with self.subTest(damping=damping, contact=contact, friction=friction):
                        text = self.QUIET.format(friction=f"{friction}, contact='{contact}'", damping=damping, v=v, end=end)
                        run = self.run_columns(text)
                        self.assertLess(len(run['time']), 600)
                        carried = 2 if 'weakening' in friction else 3
                        for t, force in zip(run['time'], run['spring_force']):
                            if t < 2.9e8:
                                stiffness = 100 if contact == 'rigid' else 100 * 1e4 / (100 + 1e4)
                                self.assertAlmostEqual(force, stiffness * v * t, delta=1e-5 * 3)
                        self.assertAlmostEqual(run['friction_force'][-1], carried, delta=1e-5)
                        self.assertAlmostEqual(run['displacement'][-1], v * end - carried / 100, delta=1e-5)
                        self.assertAlmostEqual(run['velocity'][-1] / v, 1, delta=1e-3)

    def test_a_slow_drive_loads_a_block_without_mass(self):
        # its velocity is a small difference of forces, whose tolerated errors turned it back and forth: a subloading surface slipped
        # each time, and a slow drive gave no traction at all. Under mu alone V t = S alpha u/K + u + s(R), s = -li(R)/m
        def slip(r):
            log = math.log(r)
            term, total = 1.0, 0.5772156649015329 + math.log(-log)
            for k in range(1, 60):
                term *= log / k
                total += term / k
            return -total / 1000
        for v in (1e-3, 1e-5, 1e-8):
            for sign in (1, -1):
                run = self.run_columns(f"""&friction law='subloading', alpha_n=450, alpha_t=450, mu_s=0.3, mu_k=0.3, kappa=1, xi=0, m=1000 /
                    &slider mass=0, stiffness=2, damping=2e-3, normal_traction=1.5 /
                    &drive velocity={sign * v} /
                    &time t_end={0.4 / v}, rtol=1e-5 /""")
                with self.subTest(v=v, sign=sign):
                    self.assertLess(len(run['time']), 500)
                    self.assertAlmostEqual(abs(run['friction_force'][-1]), 0.45, delta=1e-5)
                    for drive, force, r in zip(run['drive'], run['friction_force'], run['R']):
                        if r < 0.01 or r > 1 - 1e-4:   # the damper's start; the logarithm's end
                            continue
                        elastic = 0.45 * r / 450
                        self.assertAlmostEqual(abs(force), 0.45 * r, delta=1e-12)
                        self.assertAlmostEqual(abs(drive), 0.45 * r / 2 + elastic + slip(r), delta=1e-5)

    def test_explicit_steps_do_not_follow_a_slow_drive_through_what_decays(self):
        # as long as they may be, they kept a block on a damper of the contact between rest and slip, without an end
        v, end = 1e-8, 6e7
        for damping in (0.2, 10):
            for friction, carried in (("law='coulomb', mu=0.3", 3), ("law='slip_weakening', mu_s=0.3, mu_k=0.2, d_c=0.5", 2)):
                with self.subTest(damping=damping, friction=friction):
                    run = self.run_columns(self.QUIET.format(friction=f'{friction}, eta_t=1e6', damping=damping, v=v, end=end)
                                           .replace('mass=1,', 'mass=2e-3,').replace('alpha_t=1e4', 'alpha_t=1e3'))
                    self.assertLess(len(run['time']), 200)
                    self.assertAlmostEqual(run['friction_force'][-1], carried, delta=1e-5)
                    self.assertAlmostEqual(run['displacement'][-1], v * end - (carried + damping * v) / 100, delta=1e-5)

    def test_a_block_that_loads_slowly_and_slips_a_little_comes_to_rest(self):
        # each swing lets a subloading surface slip: one that the steps keep up would let the traction fall
        text = self.QUIET.format(friction="law='subloading', mu_s=0.3, mu_k=0.2, kappa=300, xi=1e-6, m=3000", damping=0.05, v=1e-8,
                                 end=2e7).replace('rtol=1e-5', 'rtol=1e-6')
        run = self.run_columns(text)
        self.assertLess(len(run['time']), 100_000)   # 5 slip events and their ringing
        events = self.rows('case_out/case_events.csv')
        self.assertEqual(len(events), 5)
        period = [float(row['recurrence_time']) * 1e-8 for row in events[1:]]
        self.assertAlmostEqual(sum(period) / 4, 0.0094, delta=3e-4)   # 0.00938 at rtol = 1e-9 and a drive of 1e-6

    def test_a_subloading_surface_carries_no_more_than_its_strength(self):
        # errors of long steps beyond it added up, to 50 times the tolerance
        for rtol in (3e-4, 1e-4, 3e-5, 1e-5):
            run = self.run_columns(f"""&friction law='subloading', alpha_n=1000, alpha_t=1000, mu_s=0.4, mu_k=0.2, kappa=10, xi=1, m=1000 /
                &slider mass=1e-3, stiffness=1, damping=0.1, normal_traction=10 /
                &drive velocity=5 /
                &time t_end=2, rtol={rtol} /""")
            for force, mu in zip(run['friction_force'], run['mu']):
                self.assertLess(force, 10 * mu + 4 * rtol)
            self.assertAlmostEqual(run['friction_force'][-1], 10 * (10 * 5 * 0.2 + 0.4) / 51, delta=4 * rtol)

    def test_sliding_that_is_not_steady_is_not_stepped_over(self):
        # a disturbance of a part of the drive's velocity, which no tolerance sees, grows within seconds
        period = []
        for v in (1e-6, 1e-10):
            text = self.QUIET.format(friction="law='static_kinetic', mu_s=0.3, mu_k=0.2, d_c=100", damping=1, v=v, end=0.1 / v)
            run = self.run_columns(text)
            self.assertLess(len(run['time']), 40_000)
            onsets = [float(row['onset']) * v for row in self.rows('case_out/case_events.csv')]
            self.assertGreater(len(onsets), 3)
            period.append(onsets[3] - onsets[2])
        self.assertAlmostEqual(period[0] / period[1], 1, delta=1e-3)

    def test_what_leaves_the_velocity_of_a_block_without_mass_open_is_refused(self):
        for law, constants in (('coulomb', 'mu = 0.6'), ('slip_weakening', 'mu_s = 0.6, mu_k = 0.4, d_c = 1')):
            self.refused(self.MASSLESS.format(law=law, constants=constants, contact='rigid', damping=0, sign=''),
                         "&slider damping = 0: or mass must be > 0 with contact = 'rigid'")
        for contact in ('rigid', 'elastic'):
            self.refused(self.MASSLESS.format(law='static_kinetic', constants='mu_s = 0.6, mu_k = 0.4, d_c = 2', contact=contact,
                                              damping=0.39, sign=''),
                         '&slider damping = 0.39: must exceed area d_c (mu_s - mu_k) normal_traction without mass')

    def test_limits_are_named_and_inertia_only_where_it_is_missing(self):
        jump = namelist({('slider', 'mass'): '0', ('slider', 'damping'): '0', ('slider', 'stiffness'): '1', ('drive', 'velocity'): '1',
                         ('friction', 'xi'): '1', ('time', 't_end'): '20', ('time', 'rtol'): '1e-6'}, [('time', 'dt')])
        result = self.run_text(jump, '--no-plot')
        self.assertEqual(result.returncode, 1)
        self.assertIn('unstable without inertia', result.stderr)
        result = self.run_text(jump.replace('rtol = 1e-6', 'rtol = 1e-9\n  dt_min = 1e-2\n  dt = 1e-2'), '--no-plot')
        self.assertEqual(result.returncode, 1)
        self.assertIn('steps as short as dt_min = 1.000E-02', result.stderr)
        self.assertNotIn('inertia', result.stderr)
        # flash heating lets friction fall with slip faster than this contact spring unloads
        jump = ("&friction law='flash_heating', alpha_n=1, alpha_t=15, a=0.007, b=0.03, d_c=0.03, v0=0.05, f0=0.6, "
                'f_w=0.15, v_w=1 /\n&slider mass=0.05, stiffness=2, normal_traction=5, damping=0.1 /\n'
                '&drive velocity=2 /\n&time t_end=5, rtol=1e-6 /\n')
        for text in (jump, jump + '&chain n_blocks=3, coupling=1, scatter=0.1 /\n'):
            result = self.run_text(text, '--no-plot')
            self.assertEqual(result.returncode, 1)
            self.assertIn('the contact jumps: friction falls faster than the contact spring unloads', result.stderr)
        # without mass and damper a rate has no bound, though it exists at each moment
        result = self.run_text("&friction law='rate_and_state', alpha_n=200, alpha_t=200, a=0.01, b=0.02, d_c=0.001, v0=0.01, f0=0.4 /\n"
                               '&slider mass=0, stiffness=0.1, normal_traction=5 /\n&drive velocity=0.05 /\n&time t_end=1000, rtol=1e-6 /\n',
                               '--no-plot')
        self.assertEqual(result.returncode, 1)
        self.assertIn('the slider is unstable without inertia', result.stderr)

    def test_friction_that_weakens_by_many_times_b(self):
        flash = ("&friction law='flash_heating', a=0.01, b={}, d_c=0.01, v0=1e-6, f0=0.6, f_w=0.1, v_w=0.1, alpha_n=1000, alpha_t=1000 /\n"
                 '&slider mass=1e-3, stiffness=1, damping=0.02, normal_traction=10 /\n'
                 '&drive velocity=1 /\n&time t_end=9, {} /\n&output {} /\n')
        forces = []
        for time, output in (('rtol=1e-6', 'every=0.1'), ('dt=2e-5', 'interval=5000')):   # theta comes down to 1e-160
            self.assert_done(self.run_text(flash.format(0.0015, time, output), '--no-plot'))
            forces.append([float(row['spring_force']) for row in self.rows('case_out/case.csv')])
        self.assertEqual(len(forces[0]), 91)
        self.assertLess(worst_of(abs(a - b) for a, b in zip(*forces, strict=True)), 0.01)
        for chain in ('', '&chain n_blocks=3, coupling=1, scatter=0.1 /\n'):
            result = self.run_text(flash.format(0.0009, 'rtol=1e-6', 'every=0.1') + chain, '--no-plot')
            self.assertEqual(result.returncode, 1)
            self.assertIn('theta leaves the range of numbers', result.stderr)

    def test_a_rigid_contact_is_refused_where_it_makes_no_sense(self):
        self.refused(namelist({('friction', 'contact'): "'rigid'", ('time', 'rtol'): '1e-6'}),
                     "&friction contact = 'rigid': is not possible for the law subloading, whose R needs the contact spring")
        self.refused(law_namelist('coulomb').replace('law =', "contact = 'rigid', law ="),
                     "&friction contact = 'rigid': needs adaptive steps (&time rtol) of one block, without beta, gamma and rho_infinity")


class AdaptiveSteps(Columns):
    def events_of(self, changes, without=()):
        text = namelist({('time', 't_end'): '12', ('output', 'interval'): '1000', **changes}, without)
        result = self.run_text(text, '--no-plot')
        self.assertEqual((result.returncode, result.stderr), (0, ''))
        self.assertIn('rejected steps', result.stdout) if ('time', 'rtol') in changes else None
        self.assertIn('rate evaluations' if ('time', 'rtol') in changes else 'Newton iterations', result.stdout)
        unbalanced = float(result.stdout.split('unbalanced')[1].split()[0])
        return [float(row['onset']) for row in self.rows('case_out/case_events.csv')], unbalanced

    def test_event_times_come_closer_to_the_truth_as_the_tolerance_tightens(self):
        # an explicit Runge-Kutta 5(4) solution at rtol 1e-11 has its first two onsets here
        truth = [3.987831136299, 7.132989343357]
        error = {}
        for rtol in ('1e-4', '1e-6', '1e-10'):
            onsets, _ = self.events_of({('time', 'rtol'): rtol}, [('time', 'dt')])
            error[rtol] = worst_of(abs(a - b) for a, b in zip(onsets, truth))
        self.assertLess(error['1e-6'], 0.5 * error['1e-4'])
        self.assertLess(error['1e-10'], 0.1 * error['1e-6'])
        self.assertLess(error['1e-10'], 1e-7)

    def test_ringing_after_events_is_followed_to_the_tolerance(self):
        # Each swing back slips a little and shifts the next event; slip begins and ends between the steps.
        # Truth: an explicit Runge-Kutta 5(4) solution at rtol 1e-13, 1e-12 is 1e-9 away.
        truth = [3.98783113667, 7.13298934409, 10.27814755326, 13.42330576242]
        text = namelist({('friction', 'scheme'): "'exact_rate'", ('time', 'rtol'): '1e-10', ('time', 't_end'): '16'},
                        [('time', 'dt')])
        result = self.run_text(text, '--no-plot')
        self.assertEqual((result.returncode, result.stderr), (0, ''))
        onsets = [float(row['onset']) for row in self.rows('case_out/case_events.csv')]
        self.assertEqual(len(onsets), 4)
        slip = [float(row['slip']) for row in self.rows('case_out/case.csv')]
        self.assertEqual(slip, sorted(slip))   # what accumulates never falls, not even by round-off
        for computed, true in zip(onsets, truth):
            self.assertLess(abs(computed - true), 3e-7)

    def test_energy_balance_closes_with_the_tolerance(self):
        rest = [abs(self.events_of({('time', 'rtol'): rtol}, [('time', 'dt')])[1])
                for rtol in ('1e-5', '1e-7')]
        self.assertLess(rest[1], 0.3 * rest[0])

    def test_energy_balance_closes_in_steps_longer_than_the_oscillation(self):
        # Once the damper has ended the oscillation, the explicit method's stability would bind the steps to its
        # period, 10 s of it to some 10 000: the stiff method takes over.
        text = namelist({('time', 'rtol'): '1e-7', ('time', 't_end'): '10'}, [('friction', None), ('time', 'dt')])
        text += "&friction law = 'coulomb', alpha_n = 1000, alpha_t = 1000, mu = 0.3 /\n"
        result = self.run_text(text, '--no-plot')
        self.assertEqual((result.returncode, result.stderr), (0, ''))
        self.assertLess(int(result.stdout.split('steps')[1].split()[0]), 4000)
        work, unbalanced = (float(result.stdout.split(key)[1].split()[0])
                            for key in ('work of the drive', 'unbalanced'))
        self.assertGreater(float(result.stdout.split('damped')[1].split()[0]), 1e-3 * work)
        self.assertLess(abs(unbalanced), 1e-7 * work)

    def test_steps_end_where_pieces_of_the_programme_end(self):
        run = self.run_columns(namelist({('drive', 'velocity'): '1, -2, 0', ('drive', 'duration'): '3*0.03',
                                         ('time', 'rtol'): '1e-6'}, [('time', 'dt')]))
        for t in (0.03, 0.06, 0.1):
            self.assertLess(min(abs(t - time) for time in run['time']), 1e-15)

    def test_long_steps_show_all_falls_of_the_force(self):
        # While the contact is open the block swings on its spring, exactly in a step of any length. Rows show each fall
        # all the same, as those of Newmark's steps do because they are short; none is a slip event: nothing slips.
        counts = []
        for changes in ({('time', 'rtol'): '1e-5'}, {('time', 'rtol'): '1e-7', ('time', 'rho_infinity'): '1'}):
            run = self.run_columns(namelist({('time', 't_end'): '10', ('drive', 'velocity'): '1', ('drive', 'duration'): '3, 2, 5',
                                             ('drive', 'normal'): '10, 0, 10', **changes}, [('time', 'dt')]))
            force = [f for t, f in zip(run['time'], run['spring_force']) if 3 < t <= 5]
            counts.append(sum(b < a and b <= c and b < -0.1 for a, b, c in zip(force, force[1:], force[2:])))
            onsets = [float(row['onset']) for row in self.rows('case_out/case_events.csv')]
            self.assertFalse([onset for onset in onsets if 3 < onset < 5])
        self.assertEqual(counts[0], counts[1])
        self.assertGreater(counts[0], 2)

    def test_rows_come_at_even_times_and_do_not_change_the_events(self):
        text = namelist({('time', 't_end'): '5', ('time', 'rtol'): '1e-8', ('friction', 'scheme'): "'exact_rate'",
                         ('output', 'every'): '0.07'}, [('time', 'dt')])
        run = self.run_columns(text)
        self.assertEqual(len(run['time']), 73)   # 0 to 71 times 0.07, and the end
        for k, time in enumerate(run['time'][:-1]):
            self.assertAlmostEqual(time, 0.07 * k, delta=1e-14)
        onset = float(self.rows('case_out/case_events.csv')[0]['onset'])
        self.assertAlmostEqual(onset, 3.98783113667, delta=1e-6)   # as above

    def test_no_rows_come_beside_the_even_times(self):
        run = self.run_columns(namelist({('time', 'rtol'): '1e-6', ('time', 'dt'): '1e-9', ('output', 'every'): '0.05'}))
        self.assertEqual(run['time'], [0.0, 0.05, 0.1])   # though the first steps are a few 1e-9 long

    def test_no_step_leads_over_round_off(self):
        # 0.57 * 100 is a little less than 57, and there is no time in the middle of the second piece
        run = self.run_columns(namelist({('time', 't_end'): '57', ('time', 'rtol'): '1e-5', ('slider', 'damping'): '1',
                                         ('output', 'every'): '0.57'}, [('time', 'dt')]))
        self.assertEqual((len(run['time']), run['time'][-1]), (101, 57.0))
        run = self.run_columns(namelist({('drive', 'velocity'): '1, 2, 0.5', ('drive', 'duration'): '1, 2.3e-16, 1',
                                         ('time', 'rtol'): '1e-5', ('time', 't_end'): '2'}, [('time', 'dt')]))
        self.assertAlmostEqual(run['drive'][-1], 1.5, delta=1e-14)

    def test_bad_times_of_rows(self):
        self.refused(namelist({('output', 'every'): '0.1'}), '&output every = 0.1: needs &time rtol')
        self.refused(namelist({('output', 'every'): '-1', ('time', 'rtol'): '1e-6'}), '&output every = -1: must be > 0')
        self.refused(namelist({('output', 'every'): '1e-12', ('output', 'interval'): '2', ('time', 'rtol'): '1e-6'}),
                     '&output every = 1e-12: give it or interval, not both',
                     '&output every = 1e-12: gives more than 1e9 rows')

    def test_steps_stay_within_their_bounds(self):
        run = self.run_columns(namelist({('time', 'rtol'): '1e-3', ('time', 'dt_max'): '2e-3'}, [('time', 'dt')]))
        steps = [b - a for a, b in zip(run['time'], run['time'][1:])]
        self.assertLess(worst_of(steps), 2.01e-3)
        result = self.run_text(namelist({('time', 'rtol'): '1e-10', ('time', 'dt_min'): '1e-2',
                                         ('time', 'dt'): '1e-2', ('time', 't_end'): '5'}), '--no-plot')
        self.assertEqual(result.returncode, 1)
        self.assertIn('steps as short as dt_min', result.stderr)

    def test_opening_and_closing_are_met_exactly(self):
        loads = {('drive', 'normal_amplitude'): '20', ('drive', 'normal_frequency'): '5', ('time', 'rtol'): '1e-4',
                 ('time', 't_end'): '0.4'}
        # the subloading law has the contact open up to 1e-6 of the largest normal traction
        for text, pressure in ((namelist(loads, [('time', 'dt'), ('friction', None)])
                                + "&friction law='coulomb', alpha_n=1e3, alpha_t=1e3, mu=0.3 /\n", 0),
                               (namelist(loads, [('time', 'dt')]), 30e-6)):
            run = self.run_columns(text)
            # 10 + 20 sin(10 pi t) = 0 at sin = -1/2, with a slope of 100 sqrt(3) pi
            for t, rises in ((7 / 60, -1), (11 / 60, 1), (7 / 60 + 0.2, -1)):
                t += rises * pressure / (100 * math.sqrt(3) * math.pi)
                self.assertLess(min(abs(t - time) for time in run['time']), 1e-12)

    def test_a_touchdown_in_full_flight_is_met_at_any_tolerance(self):
        # that moves past the base: a part of a step that ends behind the touchdown would slip all the way
        result = self.run_text(namelist({('friction', 'scheme'): "'exact_rate'", ('friction', 'kappa'): '600',
                                         ('drive', 'normal_amplitude'): '11', ('drive', 'normal_frequency'): '0.5',
                                         ('slider', 'mass'): '10', ('slider', 'damping'): '0', ('time', 'rtol'): '1e-12',
                                         ('time', 't_end'): '2.2'}, [('time', 'dt')]), '--no-plot')
        self.assertEqual((result.returncode, result.stderr), (0, ''))

    def test_an_open_contact_does_not_slip(self):
        # 7.3 + 11.7 sin(10.6 pi t + 1.1) is far from a number of digits: round-off must not hold the contact closed
        opening = {('slider', 'normal_traction'): '7.3', ('drive', 'normal_amplitude'): '11.7',
                   ('drive', 'normal_frequency'): '5.3', ('drive', 'normal_phase'): '1.1',
                   ('friction', 'alpha_n'): '943.7', ('time', 't_end'): '2'}
        for steps in ({('time', 'dt'): '1e-3'}, {('time', 'dt'): '1e-4', ('time', 'rtol'): '1e-5'}):
            run = self.run_columns(namelist({**opening, **steps}))
            load = [7.3 + 11.7 * math.sin(10.6 * math.pi * t + 1.1) for t in run['time']]
            flight = [k for k in range(1, len(load)) if max(load[k - 1:k + 1]) < -0.1]
            self.assertGreater(len(flight), 20)
            for k in flight:
                self.assertEqual((run['friction_force'][k], run['R'][k]), (0.0, 0.0))
                self.assertAlmostEqual(run['slip'][k], run['slip'][k - 1], delta=1e-12)

    def test_a_step_of_the_normal_traction_reaches_a_rate_and_state_contact(self):
        # at rest under twice the load: mu = 0.3 = 0.6 + 0.005 ln(theta v0/d_c) + 0.01 ln(v/v0) leaves no slip to see
        text = law_namelist('rate_and_state', b='0.005').replace('velocity = 1\n',
                                                                 'velocity = 1e-3, normal = 10, 20, duration = 5, 5\n')
        text = text.replace('normal_traction = 10', '').replace('t_end = 0.1', 't_end = 10')
        text = text.replace('dt = 1e-3', 'rtol = 1e-6') + '&initial mu = 0.6, velocity = 1e-3 /'
        run = self.run_columns(text)
        self.assertAlmostEqual(run['mu'][-1], run['friction_force'][-1] / 20, delta=1e-12)
        self.assertAlmostEqual(run['slip'][-1], 5e-3, delta=1e-6)

    def test_a_rate_and_state_contact_that_is_relieved_at_once_slips_at_once(self):
        # mu would be 1.2 at half the load: no step is short enough for the rate of that
        text = law_namelist('rate_and_state').replace('velocity = 1\n',
                                                      'velocity = 1e-3, normal = 10, 5, duration = 5, 5\n')
        text = text.replace('normal_traction = 10', '').replace('t_end = 0.1', 't_end = 10').replace('damping = 0.01', '')
        text = text.replace('dt = 1e-3', 'rtol = 1e-6') + '&initial mu = 0.6, velocity = 1e-3 /'
        run = self.run_columns(text)
        self.assertLess(run['mu'][-1], 0.7)
        self.assertAlmostEqual(run['mu'][-1], run['friction_force'][-1] / 5, delta=1e-12)

    RELIEVED = ("&friction law = '{law}', alpha_n = 1e5, alpha_t = 1e5, a = 0.01, b = {b}, d_c = 0.01, v0 = 1, f0 = 0.6 {more} /\n"
                '&slider mass = 1, stiffness = 1000, damping = 30 /\n'
                '&drive velocity = 1, normal = {normal}, duration = {each} /\n&time t_end = {end}, rtol = 1e-8 /\n')

    def relieved(self, law, b, more, normal, scale=1):
        text = self.RELIEVED.format(law=law, b=b, more=more, normal=normal, each=f'{normal.count(",") + 1}*{scale}',
                                    end=(normal.count(',') + 1) * scale)
        if scale != 1:
            for old, new in (('v0 = 1', f'v0 = {1 / scale!r}'), ('velocity = 1', f'velocity = {1 / scale!r}'),
                             ('mass = 1', f'mass = {scale**2}'), ('damping = 30', f'damping = {30 * scale}'),
                             ('v_w = 1000', f'v_w = {1000 / scale!r}')):
                text = text.replace(old, new)
        return self.run_columns(text)

    def test_a_relieved_contact_whose_state_keeps_creeps_by_the_closed_form(self):
        # at first e^60 times faster than the block, then v = V/(1 - (1 - V/v_1) exp(-k V t)), k = alpha_t/(a p)
        run = self.relieved('rate_and_state', '0', '', '100, 50')
        after = [i for i, t in enumerate(run['time']) if 1 + 1e-8 < t < 1 + 1e-6]
        self.assertGreater(len(after), 20)
        for i in after:
            v = 1 / -math.expm1(-2e5 * (run['time'][i] - 1))
            self.assertAlmostEqual(run['friction_force'][i] / 50, 0.6 + 0.01 * math.log(v), delta=1e-6)

    def test_what_a_relieved_contact_remembers_falls_with_its_slip(self):
        # d(ln theta)/ds = -ln(v theta/d_c)/d_c under the slip law, too, while the spring unloads with the slip
        run = self.relieved('rate_and_state', '0.008', ", evolution = 'slip'", '100, 50')
        last = max(i for i, t in enumerate(run['time']) if t <= 1)
        end = run['slip'][last + 1] - run['slip'][last]
        self.assertGreater(end, 2e-4)

        def fall(s, ln_theta):
            ln_v = (run['friction_force'][last] - 1e5 * s) / 0.5 - 60 - 0.8 * (ln_theta - math.log(0.01))
            return -100 * (ln_v + ln_theta - math.log(0.01))
        ln_theta = math.log(run['theta'][last])
        h = end / 1000
        for i in range(1000):
            half = ln_theta + 0.5 * h * fall(i * h, ln_theta)
            ln_theta += h * fall((i + 0.5) * h, half)
        self.assertAlmostEqual(math.log(run['theta'][last + 1]), ln_theta, delta=1e-5)

    def test_steps_of_the_normal_traction_are_followed_under_every_rate_and_state_law(self):
        for law, more in (('rate_and_state', ", evolution = 'slip'"), ('flash_heating', ', f_w = 0.2, v_w = 1000'),
                          ('linker_dieterich', ', alpha = 0.3'), ('linker_dieterich', ", alpha = 0.3, evolution = 'slip'"),
                          ('linker_dieterich', ", alpha = 0.3, contact = 'rigid'"),
                          ('linker_dieterich', ', alpha = 0.3, tau_max = 55')):
            for scale in (1, 10000000):
                with self.subTest(law=law, more=more, scale=scale):
                    run = self.relieved(law, '0.008', more, '100, 50, 150, 20, 100', scale)
                    force = 55 if 'tau_max' in more else 60
                    self.assertAlmostEqual(run['friction_force'][-1], force, delta=0.01 * force)

    def test_a_surface_that_has_weakened_for_good_slides_at_tight_tolerances(self):
        text = law_namelist('slip_weakening', d_c='1e-4').replace('dt = 1e-3', 'rtol = 1e-12')
        run = self.run_columns(text.replace('t_end = 0.1', 't_end = 6').replace('damping = 0.01', 'damping = 1'))
        self.assertGreater(run['slip'][-1], 1)

    def test_contacts_whose_coefficient_jumps_take_few_steps(self):
        # it jumps at a touchdown, and where a shear cap begins to hold; what the law remembers does not
        opening = {('drive', 'normal_amplitude'): '20', ('drive', 'normal_frequency'): '5'}
        for cap, changes in (('0', opening), ('1.5', {})):
            text = law_namelist('rate_and_state', b='0', tau_max=cap)
            text = text.replace('dt = 1e-3', 'rtol = 1e-6').replace('t_end = 0.1', 't_end = 4')
            for (_, key), value in changes.items():
                text = text.replace('velocity = 1\n', f'velocity = 1\n  {key} = {value}\n')
            result = self.run_text(text, '--no-plot')
            self.assertEqual((result.returncode, result.stderr), (0, ''))
            self.assertLess(int(result.stdout.split('steps')[1].split()[0]), 30000)

    def test_energy_balance_closes_under_a_shear_cap(self):
        # sliding back and forth while the load falls; the cap holds at first
        text = namelist({('friction', 'scheme'): "'exact_rate'", ('friction', 'tau_max'): '1.5',
                         ('friction', 'kappa'): '0', ('friction', 'xi'): '0', ('drive', 'normal'): '10, 1',
                         ('drive', 'duration'): '1, 10', ('drive', 'normal_change'): "'ramp'",
                         ('slider', 'mass'): '1', ('time', 't_end'): '11', ('time', 'rtol'): '1e-7'}, [('time', 'dt')])
        result = self.run_text(text, '--no-plot')
        self.assertEqual((result.returncode, result.stderr), (0, ''))
        work, unbalanced = (float(result.stdout.split(key)[1].split()[0]) for key in ('work of the drive', 'unbalanced'))
        self.assertLess(abs(unbalanced), 1e-4 * work)   # 6e-3 where the order is taken for the second

    def test_quasi_static_steps_adapt_too(self):
        changes = {**QuasiStatic.steady, ('drive', 'velocity'): '0.1', ('time', 'rtol'): '1e-6'}
        run = self.run_columns(namelist(changes, [('time', 'dt')]))
        self.assertAlmostEqual(run['mu'][-1], 0.3, delta=1e-5)

    def test_numerical_damping_calms_the_contact(self):
        rough = {}
        for rho in ('1.0', '0.5'):
            run = self.run_columns(namelist({('time', 't_end'): '4.8', ('time', 'dt'): '2e-3',
                                             ('slider', 'damping'): '0', ('time', 'rho_infinity'): rho}))
            late = [v for t, v in zip(run['time'], run['velocity']) if t > 4.5]
            rough[rho] = worst_of(late) - min(late)
        self.assertLess(rough['0.5'], 0.5 * rough['1.0'])

    def test_bad_keys_of_adaptive_steps_and_damping(self):
        self.refused(namelist({('time', 'dt_min'): '1', ('time', 'dt_max'): '1'}),
                     '&time dt_min = 1: needs rtol', '&time dt_max = 1: needs rtol')
        self.refused(namelist({('time', 'rtol'): '1'}), '&time rtol = 1: must be from 1e-12 to 0.1\n')
        self.refused(namelist({('time', 'beta'): '0'}), '&time beta = 0: must be from 0.01 to 1\n')
        for changes in ({('friction', 'mu_s'): '0', ('friction', 'mu_k'): '0'}, {('drive', 'normal'): '0'}):
            self.refused(namelist({('time', 'rtol'): '1e-6', **changes}),
                         '&time rtol = 1e-6: is relative to the static friction force, which is 0 here')
        self.refused(namelist({('time', 'rtol'): '1', ('time', 'dt_min'): '1', ('time', 'dt_max'): '0.5'}),
                     '&time rtol = 1: must be from', '&time dt_min = 1: must not exceed dt_max')
        self.refused(namelist({('time', 'rho_infinity'): '1.5', ('time', 'beta'): '0.25',
                               ('time', 'gamma'): '0.5', ('slider', 'mass'): '0'}),
                     '&time rho_infinity = 1.5: must be from 0 to 1', '&time beta = 0.25: follows from rho',
                     '&time gamma = 0.5: follows from rho', '&time rho_infinity = 1.5: needs a mass')


class BadProgramme(Columns):
    def test_files_that_are_no_programme(self):
        for content, said in (
                ('', 'is empty'),
                ('time,velocity\n', 'fewer than two rows'),
                ('time,speed\n0,1\n1,1\n', "line 1: needs one of the columns 'velocity' and 'displacement'"),
                ('time,velocity,time\n0,1,0\n1,1,1\n', "column 'time' is given twice"),
                ('velocity,normal\n0,1\n1,1\n', "line 1: column 'time' is missing"),
                ('time,normal\n0,1\n1,1\n', "one of the columns 'velocity' and 'displacement'"),
                ('time,velocity,displacement\n0,1,0\n1,1,1\n', 'choose by velocity_column or displacement_column'),
                ('speed\n0\n', "line 1: no line of column names is found from here on: column 'time' is missing"),
                ('0,1\n1,1\n', 'line 1: no line of column names'),
                ('0,1\ntime,velocity\n1,1\n2,1\n', 'line 1: numbers stand before the line of column names'),
                ('time [s],time [min],velocity\n0,0,1\n1,1,1\n', "line 1: columns 'time [s]' and 'time [min]' may both"),
                ('time,velocity\n0,1\n1\n', 'line 3: does not have as many cells as the header: 1 for 2'),
                ('time,velocity\n0,1\n1,1,5\n', 'line 3: does not have as many cells as the header: 3 for 2'),
                ('time,velocity,\n0,1,5,\n1,2,5,\n', 'line 2: does not have as many cells as the header: 4 for 2 (cells with a dec'),
                ('time,velocity,note\n0,1,a\n1,1.25,b\n2,1.', 'line 4: does not have as many cells as the header: 2 for 3, and the row'),
                ('time velocity note\n0 1 a\n1 1.25\n2 1 b\n', 'line 3: does not have as many cells as the header: 2 for 3'),
                ('time,velocity\n0,0,1\n1,1,5\n', 'line 2: does not have as many cells as the header: 3 for 2 (cells with a dec'),
                ('time,velocity\n0,1\n,,\n2,1\n', 'line 3: the row is empty, and other rows follow it'),
                ('time,velocity,x\n0,1,\n1,,2\n', "line 3: velocity = '': must be a finite number, and the cell is empty"),
                ('time,velocity\n0,1\n1,1e-999\n', "line 3: velocity = '1e-999': is not 0, but below the smallest number"),
                ('time,velocity\n0,1\n1,1\x00\n', 'line 3: holds a character 0'),
                ('time,velocity\n0,1\n1,"1\n2,1\n', 'line 3: a quote is not closed'),
                ('"time\n[s]","velocity\n[m/s]"\n0,1\n1,1\n', 'line 1: a quote is not closed in this line'),
                ('time,velocity,"normal\n[Pa]"\n0,1,1\n1,1,1\n', 'line 1: a quote is not closed in this line'),
                ('time s,velocity mm/s\n0,1\n1,1\n', "displacement': there are 'time s', 'velocity mm/s'"),
                ('time,displacement\n0,1\n1,-1e101\n', 'line 3: displacement: the number, times its factor, must not'),
                ('time,velocity\n0,1\n1e-20,1e99\n', 'line 3: changes faster than by 1e100 in unit time'),
                ('time;velocity\n0;0,5\n1;0.5\n', "line 3: velocity = '0.5': has a decimal point, and line 2 has"),
                ('time;velocity\n0;0\n1;1.000,5\n', "line 3: velocity = '1.000,5': has a decimal point and a comma"),
                ('time,velocity\n0,1\n1,1 mm/s\n', "line 3: velocity = '1 mm/s': must be a finite number"),
                ('time,velocity\n0,1\n1,2\ntime,velocity\n0,1\n', "line 4: time = 'time': must be a finite number"),
                ('velocity,time\n1,0\n#N/A,1\n2,2\n', "line 3: velocity = '#N/A': must be a finite number"),
                ('velocity;time\n1;0\n1;1\n #DIV/0!;2\n', "line 4: velocity = '#DIV/0!': must be a finite number"),
                ('time,velocity\n0,1\n1,fast\n', "line 3: velocity = 'fast': must be a finite number"),
                ('time,velocity\n0,1\nNaN,1\n', "line 3: time = 'NaN': must be a finite number"),
                ('time,velocity\n0,1\n1,1e999\n', "line 3: velocity = '1e999'"),
                ('time,velocity\n0,1\n1,\n', "line 3: velocity = ''"),
                ('time,velocity\n0,1\n1,1\n1,2\n', 'line 4: time must be larger'),
                ('time,velocity,normal\n0,1,1\n1,1,-1\n', 'line 3: normal must be >= 0'),
                ('time,velocity\n0,' + '1' * 5000 + '\n', "line 2: velocity = '1111")):
            self.refused(self.with_file(content), '&drive file', said)

    def test_columns_that_are_asked_for_must_be_there(self):
        content = 'Zeit;Weg\n0;0\n1;1\n'
        self.refused(self.with_file(content, (('drive', 'time_column'), "'Zeit'"), (('drive', 'displacement_column'), "'Pfad'")),
                     "line 1: column 'Pfad' is missing: there are 'Zeit', 'Weg'")
        self.refused(self.with_file('time,displacement\n0,0\n1,20\n', (('drive', 'displacement_factor'), '-1e99')),
                     'line 3: displacement: the number, times its factor, must not exceed 1e100')
        self.refused(self.with_file(content, (('drive', 'time_column'), "'Zeit'"), (('drive', 'displacement_column'), "'weg'"),
                                    (('drive', 'normal_factor'), '2')), "line 1: no column 'normal' for its factor")
        self.refused(self.with_file(content, (('drive', 'velocity_column'), "'Weg'"), (('drive', 'displacement_column'), "'Weg'"),
                                    (('drive', 'time_factor'), '0')),
                     "&drive displacement_column = 'Weg': cannot be given together with velocity_column",
                     '&drive time_factor = 0: must be a number other than 0')
        self.refused(namelist({('drive', 'time_column'): "'t'", ('drive', 'normal_factor'): '2'}),
                     "&drive time_column = 't': needs a file", '&drive normal_factor = 2: needs a file')

    def test_every_fault_of_a_file_is_listed_up_to_a_screenful(self):
        result = self.run_text(self.with_file('time,velocity\n' + 'x,y\n' * 100), verb='check')
        self.assertGreater(len(result.stderr.splitlines()), 15)
        self.assertLess(len(result.stderr.splitlines()), 25)

    def test_a_key_that_has_no_place_is_not_unknown_as_well(self):
        for text in (namelist({('time', 'dt_min'): '1'}),
                     self.with_file('time,velocity\n0,1\n1,1\n').replace('file =', 'normal_change = "ramp"\n file =')):
            said = self.run_text(text, verb='check').stderr
            self.assertEqual(len(said.splitlines()), 1, said)

    def test_file_that_is_not_there_and_lists_beside_it(self):
        self.refused(namelist({('drive', 'file'): "'none.csv'", ('drive', 'duration'): '1'}),
                     '&drive velocity = 1: cannot be given together with file', '&drive duration = 1: cannot',
                     "&drive file = 'none.csv'")
        self.refused(namelist({('drive', 'file'): '12'}), '&drive file = 12: must be text in quotes')

    def test_oscillation_and_changes(self):
        self.refused(namelist({('drive', 'normal_amplitude'): '1'}), '&drive normal_frequency: is missing')
        self.refused(namelist({('drive', 'normal_frequency'): '1', ('drive', 'normal_phase'): '1'}),
                     '&drive normal_frequency = 1: needs a normal_amplitude', '&drive normal_phase = 1: needs')
        self.refused(namelist({('drive', 'normal_amplitude'): '-1', ('drive', 'normal_frequency'): '0',
                               ('drive', 'normal_change'): "'jump'"}),
                     '&drive normal_amplitude = -1: must be >= 0', '&drive normal_frequency = 0: must be > 0',
                     "&drive normal_change = 'jump': must be one of 'step', 'ramp'")

    def test_an_oscillation_of_amplitude_0_is_none(self):
        tables = set()
        for keys in ('', 'normal_amplitude=0', 'normal_amplitude=0, normal_phase=1', 'normal_amplitude=0, normal_frequency=3'):
            self.run_columns(namelist().replace('&drive', '&drive ' + keys))
            tables.add((self.folder / 'case_out/case.csv').read_bytes())
        self.assertEqual(len(tables), 1)

    def test_a_law_without_r_refuses_an_initial_r(self):
        self.refused(law_namelist('rate_and_state') + '&initial r=0.5 /', '&initial r = 0.5: belongs to the law subloading')

    def test_an_initial_friction_beyond_the_strength_is_refused(self):
        for law, strength in (('coulomb', '0.3'), ('static_kinetic', '0.4'), ('slip_weakening', '0.4')):
            self.refused(law_namelist(law) + '&initial mu=0.41 /',
                         f'&initial mu = 0.41: must not exceed the static friction coefficient, {strength}\n')
        self.refused(law_namelist('rate_and_state', tau_max='2') + '&initial mu=0.3 /',
                     '&initial mu = 0.3: makes a tangential traction above tau_max = 2\n')
        self.refused(namelist({('friction', 'tau_max'): '2', ('initial', 'r'): '0.8', ('initial', 'mu'): '0.3'}),
                     '&initial r = 0.8: makes a tangential traction above tau_max = 2\n')
        result = self.run_text(law_namelist('coulomb', tau_max='3') + '&initial mu=0.3 /', '--no-plot')
        self.assertEqual(result.returncode, 0, result.stderr)

    def test_initial_values_out_of_range(self):
        self.refused(namelist({('initial', 'mu'): '0.1', ('initial', 'r'): '1.1',
                               ('initial', 'velocity'): 'NaN', ('initial', 'speed'): '1'}),
                     '&initial mu = 0.1: must be from mu_k to mu_s', '&initial r = 1.1: must be from 0 to 1',
                     '&initial velocity = NaN: must be finite', '&initial speed: unknown key')
        self.refused(namelist({('initial', 'spring_force'): '1', ('slider', 'mass'): '0',
                               ('initial', 'velocity'): '1'}),
                     '&initial spring_force = 1: needs a mass', '&initial velocity = 1: needs a mass')
        self.refused(namelist({('initial', 'r'): '1', ('drive', 'normal'): '0, 1',
                               ('drive', 'duration'): '1, 1'}), '&initial r = 1: must be 0')


if __name__ == '__main__':
    unittest.main()
