"""Chains of blocks: against one block, against themselves turned round, and what they leave behind.

STICKSLIP names the program.
"""
import math
import os
import random
import re
import shutil
import signal
import subprocess
import unittest
import xml.etree.ElementTree

from drawing import needs_gnuplot
from field_reader import read_fields
from strict_build import release_only
from test_long_runs import LongRun
from test_program import Program, namelist
from worst_errors import worst_of

RUN = {('time', 't_end'): '6', ('output', 'interval'): '50', ('chain', 'n_blocks'): '20',
       ('chain', 'coupling'): '3'}


class Chain(Program):
    def run_chain(self, changes, *arguments):
        result = self.run_text(namelist({**RUN, **changes}), '--no-plot', *arguments)
        self.assertEqual((result.returncode, result.stderr), (0, ''))
        return result.stdout

    def series(self):
        return [[float(value) for value in row.values()] for row in self.rows('case_out/case.csv')]

    def slips(self, blocks=20):
        """Slip of the blocks, time by time."""
        return [slip for _, _, slip, _ in self.fields(blocks)]

    def fields(self, blocks):
        """Time, slip rates, slips and friction coefficients of the blocks, record by record."""
        times, fields = read_fields(self.folder / 'case_out' / 'case', ('slip_rate', 'slip', 'mu'), blocks)
        return list(zip(times, fields['slip_rate'], fields['slip'], fields['mu']))

    def assert_close(self, one, other, part):
        """Column by column, as parts of the largest number in a column."""
        self.assertEqual(len(one), len(other))
        for a, b in zip(zip(*one), zip(*other)):
            largest = max(map(abs, a)) or 1
            self.assertLess(worst_of(abs(x - y) for x, y in zip(a, b)), part * largest)


class Motion(Chain):
    def test_a_chain_of_one_block_is_the_single_slider(self):
        self.run_chain({('chain', 'n_blocks'): '1'})
        chain = self.series()
        self.run_text(namelist({key: RUN[key] for key in RUN if key[0] != 'chain'}), '--no-plot')
        self.assertEqual(chain, self.series())

    @release_only
    def test_identical_blocks_move_as_one(self):
        # by the routine for one block and by the batch, whose logarithms differ in the last bit;
        # events amplify that, and Newton's tolerance of 1e-10, by the order of 1e3
        self.run_chain({('chain', 'n_blocks'): '1'})
        one = self.series()
        for blocks in ('2', '700'):
            for ends in ("'free'", "'periodic'"):
                self.run_chain({('chain', 'n_blocks'): blocks, ('chain', 'ends'): ends})
                self.assert_close(one, self.series(), 1e-6)

    def test_strongly_coupled_blocks_move_as_one_of_their_mean_strength(self):
        # their difference is the scatter of strength over the coupling: 1e-7 of a slip
        self.run_chain({('chain', 'n_blocks'): '2', ('chain', 'coupling'): '1e7',
                        ('chain', 'scatter'): '0.2', ('output', 'fields'): '50'})
        for first, second in self.slips(2):
            self.assertAlmostEqual(first, second, delta=5e-3)   # R differs a little: 1/m of slip
        self.assertGreater(first, 1.0)

    def test_a_fixed_wall_holds_its_neighbours_back(self):
        self.run_chain({('chain', 'ends'): "'fixed'", ('output', 'fields'): '50'})
        last = self.slips()[-1]
        self.assertLess(last[0], 0.8 * last[10])
        for a, b in zip(last, reversed(last)):
            self.assertAlmostEqual(a, b, delta=1e-6 * last[10])

    @release_only
    def test_energy_balance_with_coupling_closes_with_the_step(self):
        for ends in ("'free'", "'fixed'", "'periodic'"):
            rest = []
            for dt in ('4e-4', '1e-4'):
                said = self.run_chain({('chain', 'scatter'): '0.3', ('chain', 'ends'): ends,
                                       ('time', 't_end'): '4.5', ('time', 'dt'): dt})
                work, left = (float(said.split(word)[1].split()[0])
                              for word in ('work of the drive', 'unbalanced'))
                rest.append(abs(left) / work)
            self.assertLess(rest[1], 0.4 * rest[0])   # first order: a quarter
            self.assertLess(rest[1], 2e-3)

    def test_blocks_start_from_random_places_that_the_seed_decides(self):
        # Marsaglia's xorshift generator, written down a second time; the series shows the means over the blocks
        def drawn(seed, n):
            mask, bits, numbers = 2**64 - 1, 88172645463325252 ^ 1181783497276652981 ^ seed, []
            for i in range(64 + n):
                bits ^= bits << 13 & mask
                bits ^= bits >> 7
                bits ^= bits << 17 & mask
                if i >= 64:
                    numbers.append(2 * (bits >> 11) / 2**53 - 1)
            return numbers

        for seed in (1, 2, 77):
            self.run_chain({('chain', 'displacement_scatter'): '0.01', ('chain', 'seed'): str(seed), ('time', 't_end'): '0.1',
                            ('initial', 'displacement'): '3', ('output', 'interval'): '1'})
            first = self.rows('case_out/case.csv')[0]
            mean = sum(drawn(seed, 20)) / 20
            self.assertAlmostEqual(float(first['displacement']), 3 + 0.01 * mean, delta=1e-14)
            self.assertAlmostEqual(float(first['spring_force']), -0.01 * mean, delta=1e-14)
            self.assertEqual(float(first['drive']), 3.0)
        numbers = drawn(5, 10000)   # they are even, and other ones than those of the strengths
        self.assertLess(abs(sum(numbers) / 10000), 4 / 3**0.5 / 100)
        self.assertLess(abs(sum(x * x for x in numbers) / 10000 - 1 / 3), 4 * (4 / 45)**0.5 / 100)

    def test_random_places_make_equal_blocks_move_apart(self):
        self.run_chain({('output', 'fields'): '500'})
        self.assertLess(worst_of(worst_of(slips) - min(slips) for slips in self.slips()), 1e-9)   # Newton's tolerance
        self.run_chain({('output', 'fields'): '500', ('chain', 'displacement_scatter'): '0.1'})
        self.assertGreater(max(max(slips) - min(slips) for slips in self.slips()), 0.1)

    @needs_gnuplot
    def test_the_picture_of_the_catalogue_tells_the_b_value(self):
        text = namelist({**RUN, ('chain', 'scatter'): '0.3'})
        result = self.run_text(text)
        self.assertEqual((result.returncode, result.stderr), (0, ''))
        chance = random.Random(4)
        b, least, n = 0.8, -1.5, 4000   # magnitudes are exponential; a few events more before the catalogue is complete
        magnitudes = [least + chance.expovariate(b * math.log(10)) for _ in range(n)] + [least - 0.1 * k for k in range(20)]
        head = (self.folder / 'case_out/case_events.csv').read_text().splitlines()[0]
        rows = [f'{k},1,1,1,1,{10**(1.5 * m)!r},1,1' for k, m in enumerate(magnitudes)] + ['9,1,1,1,1,1e30,1,0']
        (self.folder / 'case_out/case_events.csv').write_text('\n'.join([head, *rows]) + '\n')
        subprocess.run(['gnuplot', 'case_events.gp'], cwd=self.folder / 'case_out', check=True, capture_output=True)
        told = re.search(r'b = ([\d.]+) \+- ([\d.]+), from (\d+) events', (self.folder / 'case_out/case_events.svg').read_text())
        found, error, number = (float(told.group(k)) for k in (1, 2, 3))
        self.assertAlmostEqual(error, b / n**0.5, delta=0.005)
        self.assertAlmostEqual(found, b, delta=4 * b / n**0.5)
        self.assertTrue(0.7 * n < number <= n + 1)

    def test_the_seed_decides_and_nothing_else(self):
        found = []
        for seed in ('1', '1', '2'):
            self.run_chain({('chain', 'scatter'): '0.3', ('chain', 'seed'): seed})
            found.append(self.series())
        self.assertEqual(found[0], found[1])
        self.assertNotEqual(found[0], found[2])

    def test_no_block_carries_more_than_its_strength_where_friction_drops(self):
        # a step as a whole and in halves may find a block at rest and sliding: the mean of both is neither. Walls keep both alike
        for slider, drive in (('', ''), ('', 'normal_amplitude=0.4, normal_frequency=1.3'), ('normal_mass=0.02, normal_damping=0.4,', '')):
            chain = '' if slider else '&chain n_blocks=2, coupling=0.5 ends="fixed" /'
            self.run_text(f"""&friction law='static_kinetic' alpha_n=100 alpha_t=30 mu_s=0.3 mu_k=0.2 d_c=1 /
                &slider mass=0.002, stiffness=1, damping=0.02, {slider} normal_traction=1 /
                &drive velocity=0.3, {drive} /
                {chain}
                &time t_end=4, rtol=1e-3, beta=0.25 /""", '--no-plot')
            rows = self.rows('case_out/case.csv')
            self.assertGreater(len(rows), 100)
            for row in rows:
                self.assertLessEqual(float(row['mu']), 0.3)
                self.assertLessEqual(abs(float(row['friction_force'])), 0.302 * float(row['normal_traction']))

    def test_a_balance_is_found_where_newtons_method_does_not_settle(self):
        # friction that drops at once, in long steps; without coupling as of single blocks (Newton's tolerance, grown in events)
        text = """&friction law='static_kinetic' alpha_n=100 alpha_t=100 mu_s=1 mu_k=0.3 d_c=30 /
&slider mass=1 stiffness=1 normal_traction={} /
&drive velocity=0.05 /
&chain n_blocks={} coupling={} scatter={} slip_rate=0.1 /
&time t_end=60 dt={} tolerance=1e-13 {} /
&output interval=1 {} /
"""
        for coupling, dt, more in (('4', '0.2', ''), ('36', '0.2', ''), ('4', '0.5', ''), ('36', '0.5', 'rho_infinity=0')):
            self.assert_done(self.run_text(text.format('1', '20', coupling, '0.3', dt, more, ''), '--no-plot'))
        # where friction falls faster than the contact spring unloads, a block must still go the way it is pulled
        self.assert_done(self.run_text("""&friction law='slip_weakening' alpha_n=100 alpha_t=3597.1 mu_s=1 mu_k=0.3 d_c=6.014e-4 /
&slider mass=1 stiffness=1 normal_traction=1 /
&drive velocity=0.45163498 normal_amplitude=1.2 normal_frequency=0.1 /
&chain n_blocks=100 coupling=149.39539 ends='fixed' scatter=0.9 slip_rate=0.1 /
&time t_end=60 dt=0.1535096590150057 rho_infinity=0.5 /
""", '--no-plot'))
        self.assert_done(self.run_text(text.format('1', '3', '0', '0.3', '0.2', '', 'fields=1'), '--no-plot'))
        slips = self.slips(3)
        loads = [float(row['load_factor']) for row in self.rows('case_out/case_blocks.csv')]
        for block, load in enumerate(loads):
            self.assert_done(self.run_text(text.format(repr(load), '1', '0', '0', '0.2', '', ''), '--no-plot'))
            single = [row[9] for row in self.series()]
            self.assertGreater(single[-1], 1)
            self.assertLess(worst_of(abs(a - row[block]) for a, row in zip(single, slips)), 1e-5)   # undamped contacts amplify round-off: 4e-7

    def test_adaptive_steps_agree_with_small_fixed_ones(self):
        late = []
        for change in ({('time', 'dt'): '5e-5', ('output', 'interval'): '1000000'},
                       {('time', 'rtol'): '1e-6', ('output', 'interval'): '1000000'}):
            self.run_chain({('chain', 'scatter'): '0.3', ('chain', 'n_blocks'): '20',
                            ('time', 't_end'): '3.2', **change})
            late.append(self.series()[-1])
        self.assertAlmostEqual(late[0][5], late[1][5], delta=0.02 * late[1][5])   # spring force

    @release_only
    def test_rate_and_state_chains_are_followed_by_few_adaptive_steps_to_what_fixed_steps_tend_to(self):
        text = """
&friction law='rate_and_state' alpha_n=1 alpha_t=1 a=0.01 b=0.015 d_c=0.01 v0=1e-3 f0=0.6 theta_0=10 /
&slider mass=1e-3 stiffness=1 damping=0.01 area=1000 normal_traction=0.01 /
&drive velocity=0.2 /
&initial mu=0.6 velocity=0.2 /
&chain n_blocks=5 coupling=5 ends='periodic' scatter=0.2 slip_rate=0.5 /
&time t_end=6.5 {0} /
&output interval=100000 /
"""
        onsets = []
        for steps in ('dt=1e-4', 'dt=5e-5', 'rtol=1e-5'):
            result = self.run_text(text.format(steps), '--no-plot')
            self.assert_done(result)
            onsets.append([float(row['onset']) for row in self.rows('case_out/case_events.csv')][1:])
        self.assertEqual([len(times) for times in onsets], [2, 2, 2])
        for long, short, adaptive in zip(*onsets):   # fixed steps are of first order; theirs is the error, not less than a step
            self.assertAlmostEqual(adaptive, 2 * short - long, delta=3e-3)
        self.assertLess(int(result.stdout.split('steps')[1].split()[0]), 4000)

    RATE_AND_STATE = "'rate_and_state' a=0.01 b=0.015 d_c=0.02 v0=0.05 f0=0.6"
    LINKER_DIETERICH = RATE_AND_STATE.replace('rate_and_state', 'linker_dieterich') + ' alpha=0.02'
    SINE, STEPS = 'normal_amplitude=0.3 normal_frequency=0.17', "normal=1 1.2 1.1 normal_change='step'"

    def between_walls(self, law, drive, **keys):
        text = (f"&friction law={law} alpha_n=1000 alpha_t=100 /\n&slider mass=0.1 stiffness=1 damping=0.05 normal_traction=1 /\n"
                f"&chain n_blocks=3 coupling=1 ends='fixed' /\n&drive velocity=0.1 0.3 0.05 duration=3*10 {drive} /\n"
                '&time t_end=30 rtol={rtol} /\n&output {output} /\n').format(**{'rtol': '1e-6', 'output': 'every=3', **keys})
        return text, self.run_text(text, '--no-plot')

    def test_creeping_blocks_resume_to_the_same_bytes(self):
        """Stopped where the load varies, where blocks slide at a cap."""
        for law, drive in ((self.LINKER_DIETERICH, self.STEPS), (self.LINKER_DIETERICH + ' tau_max=0.58', self.SINE),
                           (self.RATE_AND_STATE, "normal=1 0 0.9 normal_change='ramp'")):
            text, result = self.between_walls(law, drive, output='interval=1')
            self.assert_done(result)
            names = ('case.csv', 'case_events.csv')
            whole = [(self.folder / 'case_out' / name).read_bytes() for name in names]
            capped = sum(abs(float(row['friction_force']) - 0.58) < 1e-9 for row in self.rows('case_out/case.csv'))
            self.assertEqual(capped > 100, 'tau_max' in law)
            for part in (0.2, 0.4, 0.6, 0.8):
                shutil.rmtree(self.folder / 'case_out')
                stopped = text.replace('interval=1', f'interval=1 table_limit={part * len(whole[0]) / 1e9:.3e}')
                self.assertEqual(self.run_text(stopped, '--no-plot').returncode, 1)
                self.assert_done(self.run_text(text, '--no-plot', '--resume'))
                self.assertEqual([(self.folder / 'case_out' / name).read_bytes() for name in names], whole)

    def test_loads_that_vary_and_caps_of_creeping_blocks_in_continuous_time(self):
        # ends and energies of an integration by Dormand and Prince's method with located events, tolerance 1e-10; extrapolated steps of
        # Newmark's were 2e-5 to 1e-4 off at 12
        for law, drive, at_12, friction, at_30, dissipated in (
                (self.RATE_AND_STATE, self.STEPS, 0.56538272639, 0.70748312869, 2.3745702161, 4.9300847305),
                ("'flash_heating' a=0.01 b=0.015 d_c=0.02 v0=0.05 f0=0.6 f_w=0.3 v_w=0.5", "normal=1.2 0.7 1.1 normal_change='ramp'",
                 0.55068158286, 0.65762018841, 2.3727253023, 4.045439744),
                (self.LINKER_DIETERICH, self.SINE, 0.59073631216, 0.6389525251, 2.5145739479, 4.3700276974),
                (self.LINKER_DIETERICH, self.STEPS, 0.56459131335, 0.70769085244, 2.3745697517, 4.930018373),
                (self.RATE_AND_STATE + " evolution='slip' tau_max=0.58", '', 0.60942727056, 0.58, 2.425073866, 4.2093931412),
                (self.LINKER_DIETERICH + ' tau_max=0.58', self.SINE, 0.59777878706, 0.58, 2.5147013649, 3.9234194963)):
            _, result = self.between_walls(law, drive)
            self.assert_done(result)
            rows = {round(float(row['time'])): row for row in self.rows('case_out/case.csv')}
            for found, expected in ((rows[12]['displacement'], at_12), (rows[12]['friction_force'], friction), (rows[30]['displacement'], at_30),
                                    (re.search(r'dissipated +(\S+)', result.stdout)[1], dissipated)):
                self.assertAlmostEqual(float(found), expected, delta=1e-6 * expected)

    def test_creeping_blocks_without_springs_between_them_open_and_close_as_one_does(self):
        for law, drive in ((self.RATE_AND_STATE, 'normal_amplitude=1.3 normal_frequency=0.17'),
                           (self.LINKER_DIETERICH + ' tau_max=0.58', "normal=1 0 0.9 normal_change='ramp'")):
            text, _ = self.between_walls(law, drive)
            ends = []
            for blocks in (1, 3):
                self.assert_done(self.run_text(re.sub('&chain .*/', f'&chain n_blocks={blocks} coupling=0 /', text), '--no-plot'))
                rows = self.rows('case_out/case.csv')
                ends.append([float(rows[-1][column]) for column in ('displacement', 'friction_force', 'slip')])
            for one, three in zip(*ends, strict=True):
                self.assertAlmostEqual(three, one, delta=1e-5 * abs(one))   # 4e-5 to 0.02 in Newmark's steps

    def test_a_sudden_load_slips_creeping_blocks_in_no_time(self):
        # friction after it: the slip rate times exp(37), which no step is short enough for
        told = []
        for rtol in ('1e-5', '1e-7'):
            _, result = self.between_walls(self.RATE_AND_STATE, "normal=1 1.3 0.8 normal_change='step'", rtol=rtol)
            self.assert_done(result)
            energies = {name: float(value) for name, value in re.findall(r'(dissipated|unbalanced) +(\S+)', result.stdout)}
            self.assertLess(abs(energies['unbalanced']), 1e-6 * energies['dissipated'])   # 1e-3 in steps that were not looked at
            told.append(energies['dissipated'])
        self.assertAlmostEqual(told[0], told[1], delta=1e-5 * told[1])

    def test_a_single_block_between_walls_is_held_by_them_with_adaptive_steps_too(self):
        late = []
        for law, change in (("'subloading'", {}), ("'rate_and_state'", {('friction', key): value for key, value in (
                ('a', '0.01'), ('b', '0.015'), ('d_c', '0.1'), ('v0', '1'), ('f0', '0.4'))})):
            for steps in ({('time', 'dt'): '2e-5'}, {('time', 'rtol'): '1e-7'}):
                text = namelist({**RUN, **change, **steps, ('friction', 'law'): law, ('chain', 'n_blocks'): '1',
                                 ('chain', 'ends'): "'fixed'", ('chain', 'coupling'): '3', ('time', 't_end'): '3',
                                 ('output', 'interval'): '1000000', ('slider', 'damping'): '0.02'},
                                without=[('friction', key) for key in ('mu_s', 'mu_k', 'kappa', 'xi', 'm')] if change else ())
                self.assert_done(self.run_text(text, '--no-plot'))
                late.append(self.series()[-1][2])
        for fixed, adaptive in (late[:2], late[2:]):
            self.assertAlmostEqual(adaptive, fixed, delta=2e-3 * fixed)


class LongSteps(Chain):
    """Steps as long as slip events: a step may carry a block past the fall of its friction, where Newton's
    method alone finds nothing."""
    LAWS = {'coulomb': {'mu': 0.6},
            'static_kinetic': {'mu_s': 0.6, 'mu_k': 0.3, 'd_c': 2},
            'subloading': {'mu_s': 0.6, 'mu_k': 0.5, 'kappa': 26, 'xi': 1.7, 'm': 40},
            'slip_weakening': {'mu_s': 0.7, 'mu_k': 0.3, 'd_c': 0.02},
            'slip_weakening_healing': {'mu_s': 0.7, 'mu_k': 0.3, 'd_c': 0.02, 'xi': 0.15},
            'rate_and_state': {'a': 0.01, 'b': 0.02, 'd_c': 0.01, 'v0': 0.01, 'f0': 0.6},
            'flash_heating': {'a': 0.01, 'b': 0.014, 'd_c': 0.01, 'v0': 0.01, 'f0': 0.6, 'f_w': 0.2, 'v_w': 1},
            'linker_dieterich': {'a': 0.01, 'b': 0.02, 'd_c': 0.01, 'v0': 0.01, 'f0': 0.6, 'alpha': 0.2}}

    def test_each_step_ends_in_a_balance_of_forces(self):
        mass = 1e-3
        for law, constants in self.LAWS.items():
            friction = {'law': f"'{law}'", 'alpha_n': 50, 'alpha_t': 500, **constants}
            for blocks, ends, coupling in ((9, 'free', 1), (9, 'periodic', 30), (8, 'periodic', 1), (1, 'free', 1)):
                with self.subTest(law=law, blocks=blocks, ends=ends):
                    groups = {'friction': friction,
                              'slider': {'mass': mass, 'stiffness': 1, 'normal_traction': 1},
                              'drive': {'velocity': 0.2, 'normal_amplitude': 0.9, 'normal_frequency': 0.1},
                              'time': {'t_end': 30, 'dt': 0.3},
                              'chain': {'n_blocks': blocks, 'coupling': coupling, 'scatter': 0.3,
                                        'ends': f"'{ends}'", 'slip_rate': 0.2}}
                    result = self.run_text(''.join(f'&{group}\n' + ''.join(f'{key} = {value}\n' for key, value in
                                                   keys.items()) + '/\n' for group, keys in groups.items()), '--no-plot')
                    self.assertEqual(result.returncode, 0, result.stderr)
                    rows = self.rows('case_out/case.csv')
                    self.assertEqual(len(rows), 101)
                    for row in rows:   # means over the blocks: what couples them cancels
                        spring, friction_force, acceleration = (
                            float(row[key]) for key in ('spring_force', 'friction_force', 'acceleration'))
                        self.assertAlmostEqual(spring, friction_force + mass * acceleration, delta=1e-8)


class LongChain(Chain):
    def test_the_number_of_threads_changes_no_bit(self):
        """More parts than it takes for two threads to share them, through the first events."""
        (self.folder / 'case.nml').write_text(namelist({
            **RUN, ('chain', 'n_blocks'): '8000', ('chain', 'scatter'): '0.9', ('chain', 'ends'): "'periodic'",
            ('chain', 'coupling'): '1', ('chain', 'slip_rate'): '1',
            ('time', 't_end'): '0.8', ('time', 'dt'): '1e-2', ('output', 'interval'): '10'}))
        found = []
        for threads in '1', '2':
            result = self.run_program('run', 'case.nml', '--no-plot', env={**os.environ, 'OMP_NUM_THREADS': threads})
            self.assertEqual((result.returncode, result.stderr), (0, ''))
            found.append([(self.folder / 'case_out' / name).read_bytes()
                          for name in ('case.csv', 'case_events.csv')] + [result.stdout])
        self.assertEqual(found[0], found[1])
        self.assertGreater(found[0][1].count(b'\n'), 100)


class Catalogue(Chain):
    def test_the_slip_rate_of_an_event_is_ten_times_the_drive_s_where_friction_has_no_fall_to_tell_it(self):
        text = """
&friction law={law} alpha_n=1 alpha_t=1 /
&slider mass=1e-3 stiffness=1 damping=0.01 area=1000 normal_traction=0.01 /
&drive velocity={velocity} duration=3, 4 /
&initial mu=0.6 velocity=0.2 /
&chain n_blocks=5 coupling=5 ends='periodic' scatter=0.2 {slip_rate} /
&time t_end=6.5 rtol=1e-5 /
&output interval=100000 /
"""
        rate_and_state = "'rate_and_state' a=0.01 b=0.015 d_c=0.01 v0=1e-3 f0=0.6 theta_0=10"
        catalogues = []
        for slip_rate in ('', 'slip_rate=2', 'slip_rate=1'):
            self.assert_done(self.run_text(text.format(law=rate_and_state, velocity='0.1 -0.2', slip_rate=slip_rate),
                                           '--no-plot'))
            catalogues.append((self.folder / 'case_out/case_events.csv').read_text())
        self.assertGreater(catalogues[0].count('\n'), 1)
        self.assertEqual(catalogues[0], catalogues[1])
        self.assertNotEqual(catalogues[0], catalogues[2])
        shutil.rmtree(self.folder / 'case_out')
        for law in (rate_and_state, "'coulomb' mu=0.6", "'subloading' mu_s=0.6 mu_k=0.6 kappa=1 xi=0 m=100"):
            self.refused(text.format(law=law, velocity='0 0', slip_rate=''), 'case.nml:6: &chain slip_rate: is missing: give',
                         'if friction does not fall from static to kinetic and the drive never moves')

    def test_a_chain_that_moves_as_one_has_events_of_all_its_blocks(self):
        self.run_chain({('output', 'fields'): '1'})
        rows = self.rows('case_out/case_events.csv')
        self.assertEqual(','.join(rows[0]), 'onset,duration,first_block,blocks,slip,moment,peak_velocity,ended')
        self.assertEqual((rows[0]['first_block'], rows[0]['blocks']), ('1', '20'))
        self.assertAlmostEqual(float(rows[0]['moment']), 20 * float(rows[0]['slip']), delta=1e-12)
        self.assertGreater(float(rows[0]['slip']), 0.5)

    def test_events_are_slip_that_is_connected_in_space_and_time(self):
        """The catalogue against one made from the fields of every step, by another way."""
        for ends, seed in ('free', '1'), ('periodic', '1'), ('periodic', '2'):
            self.run_chain({('chain', 'coupling'): '0.5', ('chain', 'scatter'): '0.5', ('chain', 'slip_rate'): '1',
                            ('chain', 'ends'): f"'{ends}'", ('chain', 'seed'): seed,
                            ('output', 'fields'): '1', ('time', 't_end'): '8'})
            ended, under_way = self.connected(self.slips(), ends == 'periodic')
            rows = self.rows('case_out/case_events.csv')
            self.assertGreater(len(rows), 10)
            for events, mark in (ended, '1'), (under_way, '0'):
                listed = [[float(row[name]) for name in ('first_block', 'blocks', 'moment', 'onset')]
                          for row in rows if row['ended'] == mark]
                self.assertEqual(len(events), len(listed))
                for ours, theirs in zip(sorted(events), sorted(listed)):
                    self.assertEqual(ours[:2], tuple(theirs[:2]))
                    self.assertAlmostEqual(ours[2], theirs[2], delta=1e-9)
                    self.assertAlmostEqual(ours[3], theirs[3], delta=1e-9)
            over_seam = sum(first + blocks - 1 > 20 for first, blocks, *_ in ended)
            self.assertEqual(over_seam > 0, ends == 'periodic')

    def connected(self, slips, ring):
        """(first block, blocks, moment, onset) of the events that ended, and of the others."""
        def touch(a, b):
            return any(abs(i - j) <= 1 or (ring and abs(i - j) == 19) for i in a for j in b)

        # an event reaches over all blocks it has moved: what touches any of them while it lasts is its
        under_way, ended = [], []
        for step, (before, now) in enumerate(zip(slips, slips[1:])):
            moving = {i: now[i] - before[i] for i in range(20) if now[i] - before[i] > 1e-3}
            groups = [({i}, slip, step) for i, slip in moving.items()] + under_way
            a = 0
            while a < len(groups):
                for b in range(a + 1, len(groups)):
                    if touch(groups[a][0], groups[b][0]):
                        one, other = groups[a], groups.pop(b)
                        groups[a] = (one[0] | other[0], one[1] + other[1], min(one[2], other[2]))
                        a = -1   # once more from the start
                        break
                a += 1
            under_way = [group for group in groups if group[0] & set(moving)]
            ended += [group for group in groups if not group[0] & set(moving)]

        def row(blocks, slip, step):
            first = min(blocks)
            if ring and len(blocks) < 20 and first == 0:
                first = next((i for i in sorted(blocks) if i - 1 not in blocks and i > 0), 0)
            return first + 1, len(blocks), slip, step * 1e-3

        return [row(*event) for event in ended], [row(*event) for event in under_way]

    def test_contact_springs_that_let_go_and_slips_within_one_step_are_no_events(self):
        # Carlson and Langer's chain on undamped contact springs: each drops its traction in one step, again and again
        text = """&friction law='static_kinetic' alpha_n=100 alpha_t=100 mu_s=1 mu_k=0 d_c=6 /
&slider mass=1 stiffness=1 normal_traction=1 /
&drive velocity=0.01 /
&chain n_blocks=100 coupling=36 ends='periodic' scatter=0.01 /
&time t_end=120 dt=0.01 /
&output interval=100 /
"""
        result = self.run_text(text, '--no-plot')
        rows = self.rows('case_out/case_events.csv')
        self.assertEqual(result.returncode, 0)
        self.assertGreater(len(rows), 10)
        for row in rows:
            self.assertGreater(float(row['duration']), 0.015)
        self.assertIn('slips of blocks, which begin and end within it: they are not listed', result.stderr)
        self.assertIn('energy balance has an error of', result.stderr)
        # what a contact spring holds moves no block, however small the limit of the step
        quiet = self.run_text(text.replace('t_end=120', 't_end=60'), '--no-plot')
        self.assertEqual(self.rows('case_out/case_events.csv'), [])
        self.assertNotIn('slips of blocks', quiet.stderr)

    def test_what_is_under_way_at_the_end_is_listed_and_counted(self):
        said = self.run_chain({('time', 't_end'): '4.05'})
        rows = self.rows('case_out/case_events.csv')
        cut = [row for row in rows if row['ended'] == '0']
        self.assertEqual(len(cut), 1)
        self.assertAlmostEqual(float(cut[0]['onset']) + float(cut[0]['duration']), 4.05, delta=2e-3)
        self.assertIn(f'events of blocks   {len(rows) - 1}, and 1 still in progress at the end', said)

    def test_fields_have_all_their_digits(self):
        self.run_chain({('chain', 'n_blocks'): '2', ('output', 'fields'): '1', ('output', 'interval'): '1',
                        ('time', 't_end'): '3.5'})
        fields, series = self.fields(2), self.series()
        self.assertEqual(len(fields), len(series))
        for (time_, _, slip, mu), row in zip(fields, series):
            self.assertEqual(time_, row[0])
            self.assertAlmostEqual(sum(slip) / 2, row[9], delta=4e-16 * (1 + row[9]))
            self.assertAlmostEqual(sum(mu) / 2, row[7], delta=4e-16)

    def test_fields_can_be_read_where_a_part_has_more_records_than_they_tell(self):
        """As between two saves, where a run may be killed: HDF5 2 broke down."""
        part, later = (self.folder / place / 'case_fields_000001.h5' for place in ('case_out', ''))
        self.run_chain({('output', 'fields'): '50'})
        if not part.exists():
            self.skipTest('built without HDF5')
        part.rename(later)
        self.run_chain({('output', 'fields'): '50', ('time', 't_end'): '3'})
        records = self.fields(20)
        self.assertGreater(len(records), 2)
        later.rename(part)
        self.assertEqual(self.fields(20), records)

    def test_fields_are_described_for_paraview(self):
        self.run_chain({('output', 'fields'): '100'})
        records = self.fields(20)
        root = xml.etree.ElementTree.parse(self.folder / 'case_out/case_fields.xdmf').getroot()
        grid, = root.findall('Domain/Grid/Grid')
        self.assertEqual(grid.find('Topology').get('Dimensions'), f'{len(records)} 20')
        blocks, times = grid.findall('Geometry/DataItem')
        self.assertEqual(blocks.text.split(), [str(i) for i in range(1, 21)])
        items = {'time': times, **{field.get('Name'): field.find('DataItem') for field in grid.findall('Attribute')}}
        self.assertEqual(set(items), {'time', 'slip_rate', 'slip', 'mu'})
        for name, item in items.items():
            shape = str(len(records)) if name == 'time' else f'{len(records)} 20'
            self.assertEqual(item.get('Dimensions'), shape)
            if item.get('Format') == 'Binary':
                place = 8 * len(records) * [0, 1, 21, 41][['time', 'slip_rate', 'slip', 'mu'].index(name)]
                self.assertEqual((item.text, item.get('Seek')), ('case_fields_000001.bin', str(place)))
            else:
                slab, data = item
                zeros, ones = (' '.join(digit * len(shape.split())) for digit in '01')
                self.assertEqual((slab.text, data.text), (f'{zeros} {ones} {shape}', f'case_fields.h5:/{name}'))

    def test_fields_of_many_records_are_read_as_one(self):
        self.run_chain({('chain', 'n_blocks'): '700', ('output', 'fields'): '4', ('time', 't_end'): '5',
                        ('output', 'interval'): '4'})
        self.assertGreater(len(list((self.folder / 'case_out').glob('case_fields_0*'))), 1)
        fields, series = self.fields(700), self.series()
        self.assertEqual([record[0] for record in fields], [row[0] for row in series])
        for (_, _, slip, _), row in zip(fields, series):
            self.assertAlmostEqual(math.fsum(slip) / 700, row[9], delta=1e-13 * (1 + row[9]))

    def test_fields_of_another_run_do_not_stay(self):
        self.run_chain({('output', 'fields'): '1', ('chain', 'n_blocks'): '700', ('time', 't_end'): '1.5'})
        self.assertGreater(len(list((self.folder / 'case_out').glob('case_fields_0*'))), 1)
        self.run_chain({('output', 'fields'): '100', ('chain', 'n_blocks'): '700', ('time', 't_end'): '1'})
        self.assertEqual(len(list((self.folder / 'case_out').glob('case_fields_0*'))), 1)
        self.assertEqual(self.fields(700)[-1][0], 1.0)

    @needs_gnuplot
    def test_a_picture_of_fields_is_drawn_from_few_points_and_keeps_the_largest(self):
        (self.folder / 'case.nml').write_text(namelist({
            **RUN, ('chain', 'n_blocks'): '700', ('output', 'fields'): '4'}))
        result = self.run_program('run', 'case.nml')
        self.assertEqual((result.returncode, result.stderr), (0, ''))
        corners = [[tuple(map(float, line.split())) for line in column.splitlines()] for column in
                   (self.folder / 'case_out/case_fields.dat').read_text().strip().split('\n\n')]
        self.assertLess(sum(map(len, corners)), 1e5)
        records = self.fields(700)
        self.assertEqual((corners[0][0][:2], corners[-1][-1][:2]), ((0.0, 0.5), (records[-1][0], 700.5)))
        for column, after in zip(corners, corners[1:]):
            within = [rates for time, rates, _, _ in records if column[0][0] < time <= after[0][0]]
            for (_, low, rate), (_, high, _) in zip(column, column[1:]):
                self.assertEqual(rate, max(max(rates[int(low + 0.5) - 1:int(high + 0.5) - 1]) for rates in within))

    @needs_gnuplot
    def test_pictures_are_drawn(self):
        (self.folder / 'case.nml').write_text(namelist({**RUN, ('output', 'fields'): '50'}))
        result = self.run_program('run', 'case.nml')
        self.assertEqual((result.returncode, result.stderr), (0, ''))
        for name in ('case', 'case_events', 'case_fields'):
            self.assertEqual((self.folder / f'case_out/{name}.png').read_bytes()[:4], b'\x89PNG')
            self.assertIn(b'</svg>', (self.folder / f'case_out/{name}.svg').read_bytes())


class BadChains(Chain):
    def test_every_key(self):
        self.refused(namelist({('chain', 'n_blocks'): '0', ('chain', 'coupling'): '-1',
                               ('chain', 'ends'): "'loose'", ('chain', 'scatter'): '1',
                               ('chain', 'seed'): '-1', ('chain', 'slip_rate'): '0',
                               ('chain', 'colour'): '3', ('output', 'fields'): '-1'}),
                     '&chain n_blocks = 0: must be from 1', '&chain coupling = -1: must be >= 0',
                     "&chain ends = 'loose': must be one of", '&chain scatter = 1: must be from 0 to 0.99',
                     '&chain seed = -1: must be >= 0', '&chain slip_rate = 0: must be > 0',
                     '&chain colour: unknown key', '&output fields = -1: must be >= 0')

    def test_every_key_with_what_it_cannot_be(self):
        self.refused(namelist({('chain', 'n_blocks'): '1000001', ('chain', 'coupling'): 'stiff',
                               ('chain', 'ends'): '3', ('chain', 'scatter'): 'nan', ('chain', 'seed'): '1.5',
                               ('chain', 'slip_rate'): "'fast'", ('output', 'fields'): '1.5'}),
                     '&chain n_blocks = 1000001: must be from 1 to 1000000', '&chain coupling = stiff: must be a number',
                     "&chain ends = 3: must be text in quotes, one of 'free', 'fixed', 'periodic'",
                     '&chain scatter = nan: must be finite', '&chain seed = 1.5: must be a whole number',
                     "&chain slip_rate = 'fast': must be a number", '&output fields = 1.5: must be a whole number')
        self.refused(namelist({**RUN, ('chain', 'seed'): '1\n  seed = 2'}), '&chain seed')
        self.refused(namelist({('chain', 'n_blocks'): '1', ('chain', 'coupling'): '1', ('chain', 'displacement_scatter'): '1',
                               ('slider', 'mass'): '0'}), '&chain displacement_scatter = 1: must be 0 without a mass')

    def test_what_is_missing_or_does_not_fit(self):
        self.refused(namelist({('chain', 'seed'): '1'}), '&chain n_blocks: is missing',
                     '&chain coupling: is missing')
        self.refused(namelist({**RUN, ('slider', 'mass'): '0'}), '&chain n_blocks = 20: must be 1 without a mass')
        self.refused(namelist({**RUN, ('friction', 'mu_k'): '0.4', ('drive', 'velocity'): '0'}), '&chain slip_rate: is missing')
        self.refused(namelist({('output', 'fields'): '5'}), '&output fields = 5: needs a chain')


class Resumed(LongRun):
    def stop_and_compare(self, changes):
        (self.folder / 'case.nml').write_text(namelist({
            **RUN, ('time', 't_end'): '8', ('output', 'fields'): '20', ('output', 'checkpoint'): '0.01',
            ('chain', 'scatter'): '0.3', ('chain', 'ends'): "'periodic'", **changes}))
        process = self.start('--output', 'whole')
        process.communicate(timeout=120)
        self.assertEqual(process.returncode, 0)
        whole = (self.folder / 'whole/case.csv').stat().st_size
        chance = random.Random(6)
        stopped = 0
        resume = []
        for _ in range(3):
            process = self.start('--output', 'parts', *resume)
            self.let_it_write('parts/case.csv', chance.uniform(0.1, 0.25) * whole, process)
            process.send_signal(signal.SIGKILL)
            process.communicate()
            if process.returncode == 0:
                break
            stopped += 1
            if (self.folder / 'parts/case.checkpoint').exists():
                resume = ['--resume']
        self.assertGreater(stopped, 0)
        if process.returncode != 0:
            self.assertEqual(resume, ['--resume'])
            process = self.start('--output', 'parts', *resume)
            self.assertEqual((process.communicate(timeout=120)[1], process.returncode), ('', 0))
        names = sorted(path.name for path in (self.folder / 'whole').iterdir())
        self.assertGreaterEqual(len(names), 5)   # series, events, fields and their description, what each block has
        for name in names:
            self.assertEqual((self.folder / 'parts' / name).read_bytes(),
                             (self.folder / 'whole' / name).read_bytes())

    @release_only
    def test_a_killed_chain_with_fixed_steps_resumes_to_the_same_bytes(self):
        self.stop_and_compare({('time', 'dt'): '1e-4', ('output', 'fields'): '200'})

    def test_a_killed_chain_with_adaptive_steps_resumes_to_the_same_bytes(self):
        self.stop_and_compare({('time', 'rtol'): '1e-5', ('output', 'fields'): '200', ('time', 't_end'): '4'})

    @release_only
    def test_a_killed_long_chain_resumes_to_the_same_bytes(self):
        self.stop_and_compare({('chain', 'n_blocks'): '1100', ('output', 'fields'): '5', ('time', 't_end'): '6'})


if __name__ == '__main__':
    unittest.main()
