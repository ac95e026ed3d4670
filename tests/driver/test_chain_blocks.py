"""Chains whose blocks have constants of their own: against single blocks, against equal ones, and what is refused.

STICKSLIP names the program.
"""
import random
import re
import shutil
import signal
import unittest

from drawing import needs_gnuplot
from strict_build import release_only
from test_chain import RUN, Chain
from test_long_runs import LongRun
from test_program import GOOD, INPUTS, LAWS, SPRINGS, namelist
from worst_errors import worst_of

MASK = 2**64 - 1
CONSTANTS = {**LAWS, 'subloading': {key: value for key, value in GOOD['friction'].items() if key not in ('law', *SPRINGS)}}


def stream_of(name):
    """Mixed from the letters of a constant's name."""
    mixed = 0
    for letter in name.encode():
        mixed = ((mixed << 23 | mixed >> 41) & MASK) ^ letter
        mixed ^= mixed << 13 & MASK
        mixed ^= mixed >> 7
    return mixed


def drawn(seed, name, n):
    """Marsaglia's xorshift generator, written down a second time."""
    bits, numbers = 88172645463325252 ^ stream_of(name) ^ seed, []
    for i in range(64 + n):
        bits ^= bits << 13 & MASK
        bits ^= bits >> 7
        bits ^= bits << 17 & MASK
        if i >= 64:
            numbers.append(2 * (bits >> 11) / 2**53 - 1)
    return numbers


class OwnConstants(Chain):
    def write_profile(self, columns, name='profile.csv'):
        rows = zip(*columns.values())
        (self.folder / name).write_text('\n'.join([','.join(columns), *(','.join(map(repr, row)) for row in rows)]) + '\n')

    def law_chain(self, law, constants, load, more='', group='', time='t_end = 3, dt = 1e-3'):
        friction = ', '.join(f'{key} = {value}' for key, value in {'law': f"'{law}'", **constants}.items())
        return (f'&friction {friction} /\n&slider mass = 1e-3, stiffness = 1, damping = 0.05, normal_traction = {load} /\n'
                f'&drive velocity = 1 /\n{group}\n&time {time}, tolerance = 1e-13 /\n&output interval = 50 {more} /\n')

    def single_slips(self, law, constants, load):
        result = self.run_text(self.law_chain(law, constants, load), '--no-plot')
        self.assertEqual((result.returncode, result.stderr), (0, ''))
        return [row[9] for row in self.series()]


class Motion(OwnConstants):
    def test_uncoupled_blocks_move_as_single_sliders_with_their_constants_do(self):
        # every law, all its constants and options; by the routine for one point and in lanes. What Newton's tolerance
        # leaves, 1e-13, grows in slip events: 4e-12 was seen
        options = {'cohesion': '0.1', 'tau_max': '0.9', 'eta_t': '0.02'}
        for law, constants in CONSTANTS.items():
            for n, more in (3, options), (20, {}):
                chance = random.Random(law)
                base = {**SPRINGS, **constants, **more}
                own = {key: [float(value) * chance.uniform(0.9, 1.1) for _ in range(n)] for key, value in base.items()}
                load = [chance.uniform(2, 4) for _ in range(n)]
                self.write_profile({'block': range(1, n + 1), 'normal_traction': load, **own})
                result = self.run_text(self.law_chain(
                    law, {key: "'@profile.csv'" for key in base}, "'@profile.csv'", ', fields = 50',
                    f'&chain n_blocks = {n}, coupling = 0, slip_rate = 1 /'), '--no-plot')
                self.assert_done(result)
                slips = self.slips(n)
                for block in range(3):
                    one = self.single_slips(law, {key: repr(values[block]) for key, values in own.items()}, repr(load[block]))
                    self.assertEqual(len(one), len(slips))
                    self.assertGreater(one[-1], 0.3)
                    self.assertLess(worst_of(abs(a - row[block]) for a, row in zip(one, slips)), 1e-10, (law, n, block))

    def test_a_profile_of_equal_numbers_changes_no_byte(self):
        found = []
        keys = {'mu_s': 0.4, 'kappa': 10.0, 'alpha_t': 1000.0, 'alpha_n': 1000.0}
        self.write_profile({'block': [1, 7, 20], **{key: 3 * [value] for key, value in keys.items()},
                            'normal_traction': 3 * [10.0]})
        for changes in ({}, {**{('friction', key): "'@profile.csv'" for key in keys},
                             ('slider', 'normal_traction'): "'@profile.csv'"}):
            self.run_chain({**changes, ('chain', 'displacement_scatter'): '0.1', ('output', 'fields'): '50'})
            fields = sorted((self.folder / 'case_out').glob('case_fields*'))
            self.assertGreater(len(fields), 0)
            found.append([path.read_bytes() for path in (self.folder / 'case_out/case.csv',
                                                         self.folder / 'case_out/case_events.csv', *fields)])
        self.assertEqual(found[0], found[1])

    def test_the_strong_block_holds_the_others_back(self):
        self.write_profile({'block': [9, 10, 11], 'mu_s': [0.4, 2.0, 0.4]})
        self.run_chain({('friction', 'mu_s'): "'@profile.csv'", ('output', 'fields'): '50'})
        last = self.slips()[-1]
        self.assertEqual(min(last), last[9])
        self.assertLess(last[9], 0.1 * last[0])

    def test_adaptive_steps_agree_with_small_fixed_ones(self):
        late = []
        for change in ({('time', 'dt'): '5e-5'}, {('time', 'rtol'): '1e-6'}):
            self.run_chain({('chain', 'mu_s_scatter'): '0.2', ('chain', 'mu_k_scatter'): '0.1', ('chain', 'kappa_scatter'): '0.5',
                            ('time', 't_end'): '3.2', ('output', 'interval'): '1000000', **change})
            late.append(self.series()[-1])
        self.assertAlmostEqual(late[0][5], late[1][5], delta=0.02 * late[1][5])   # spring force

    def test_the_energy_balance_closes_with_the_step(self):
        rest = []
        for dt in ('4e-4', '1e-4'):
            said = self.run_chain({('chain', 'mu_s_scatter'): '0.3', ('chain', 'alpha_t_scatter'): '0.5',
                                   ('time', 't_end'): '4.5', ('time', 'dt'): dt})
            work, left = (float(said.split(word)[1].split()[0]) for word in ('work of the drive', 'unbalanced'))
            rest.append(abs(left) / work)
        self.assertLess(rest[1], 0.4 * rest[0])
        self.assertLess(rest[1], 2e-3)

    def test_a_start_in_motion_has_each_blocks_own_friction(self):
        self.write_profile({'block': [1, 2], 'mu_s': [0.4, 0.6], 'cohesion': [0.0, 1.0]})
        self.run_chain({('friction', 'mu_s'): "'@profile.csv'", ('friction', 'cohesion'): "'@profile.csv'",
                        ('chain', 'n_blocks'): '2', ('initial', 'r'): '0.5', ('time', 't_end'): '1e-3', ('output', 'interval'): '1'})
        self.assertAlmostEqual(self.series()[0][6], (0.5 * 0.4 * 10 + 0.5 * (0.6 * 10 + 1)) / 2, delta=1e-13)
        self.assertAlmostEqual(self.series()[0][7], 0.5, delta=1e-15)   # virgin


class Constants(OwnConstants):
    def blocks(self):
        return [{key: float(value) for key, value in row.items()} for row in self.rows('case_out/case_blocks.csv')]

    def test_profiles_are_linear_between_their_blocks_and_constant_beyond(self):
        self.write_profile({'block': [15, 5], 'mu_s': [0.6, 0.4], 'other': [1, 2]})
        self.write_profile({'block': [1, 20], 'normal_traction': [5.0, 15.0]}, 'load.csv')
        self.run_chain({('friction', 'mu_s'): "'@profile.csv'", ('slider', 'normal_traction'): "'@load.csv'",
                        ('time', 't_end'): '0.1'})
        rows = self.blocks()
        self.assertEqual(list(rows[0]), ['block', 'load_factor', 'mu_s', 'mu_0'])   # mu_0 follows mu_s
        for i, row in enumerate(rows, 1):
            self.assertAlmostEqual(row['mu_s'], 0.4 + 0.02 * (min(max(i, 5), 15) - 5), delta=1e-15)
            self.assertEqual(row['mu_0'], row['mu_s'])
            self.assertAlmostEqual(row['load_factor'], (5 + 10 * (i - 1) / 19) / 10, delta=1e-15)
        self.assertAlmostEqual(self.series()[0][10], 10, delta=1e-14)

    def test_scatter_is_drawn_for_each_constant_by_itself(self):
        changes = {('chain', 'mu_s_scatter'): '0.2', ('chain', 'seed'): '7', ('time', 't_end'): '0.1'}
        self.run_chain(changes)
        alone = [row['mu_s'] for row in self.blocks()]
        self.run_chain({**changes, ('chain', 'kappa_scatter'): '0.99', ('chain', 'scatter'): '0.3'})
        rows = self.blocks()
        self.assertEqual([row['mu_s'] for row in rows], alone)
        for row, a, b in zip(rows, drawn(7, 'mu_s', 20), drawn(7, 'kappa', 20)):
            self.assertAlmostEqual(row['mu_s'], 0.4 * (1 + 0.2 * a), delta=1e-15)
            self.assertAlmostEqual(row['kappa'], 10 * (1 + 0.99 * b), delta=1e-14)

    def test_scatter_acts_on_a_profile(self):
        self.write_profile({'block': [1, 20], 'mu_s': [0.3, 0.5]})
        self.run_chain({('friction', 'mu_s'): "'@profile.csv'", ('chain', 'mu_s_scatter'): '0.1', ('time', 't_end'): '0.1'})
        for i, (row, u) in enumerate(zip(self.blocks(), drawn(1, 'mu_s', 20))):
            self.assertAlmostEqual(row['mu_s'], (0.3 + 0.2 * i / 19) * (1 + 0.1 * u), delta=1e-15)

    def test_equal_blocks_have_no_table(self):
        self.run_chain({('time', 't_end'): '0.1'})
        self.assertFalse((self.folder / 'case_out/case_blocks.csv').exists())

    @needs_gnuplot
    def test_a_picture_shows_the_blocks(self):
        result = self.run_text(namelist({**RUN, ('chain', 'kappa_scatter'): '0.2', ('chain', 'scatter'): '0.2',
                                         ('output', 'length_unit'): "'mm'", ('time', 't_end'): '0.1'}))
        self.assertEqual((result.returncode, result.stderr), (0, ''))
        self.assertEqual((self.folder / 'case_out/case_blocks.png').read_bytes()[:4], b'\x89PNG')
        shown = (self.folder / 'case_out/case_blocks.svg').read_text()
        self.assertIn('kappa [1/mm]', shown)
        self.assertIn('load factor', shown)

    def test_the_input_with_own_constants_runs(self):
        text = re.sub(r't_end = [\d.]+', 't_end = 1', (INPUTS / 'chain_blocks.nml').read_text())
        shutil.copy(INPUTS / 'chain_blocks.csv', self.folder)
        result = self.run_text(text, '--no-plot')
        self.assertEqual((result.returncode, result.stderr), (0, ''))
        self.assertGreater(len(self.blocks()[0]), 3)


class Refused(OwnConstants):
    def test_a_constant_out_of_its_range_is_told_with_its_block_and_rule(self):
        self.write_profile({'block': [1, 3, 20], 'mu_k': [0.2, -0.1, 0.2], 'kappa': [1.0, 1.0, -2.0],
                            'normal_traction': [1.0, 1.0, 0.0]})
        self.refused(namelist({**RUN, ('friction', 'mu_k'): "'@profile.csv'"}),
                     "&friction mu_k = ", 'block 3: must be >= 0, and is -0.1')
        self.refused(namelist({**RUN, ('friction', 'kappa'): "'@profile.csv'"}), 'block 9: must be >= 0, and is -5.88', '2 more blocks are refused')
        self.refused(namelist({**RUN, ('slider', 'normal_traction'): "'@profile.csv'"}),
                     '&slider normal_traction', 'block 20: must be > 0, and is 0')
        factors = drawn(1, 'mu_k', 20)
        result = self.run_text(namelist({**RUN, ('chain', 'mu_k_scatter'): '0.99', ('friction', 'mu_k'): '0.3'}), verb='check')
        self.assertEqual(result.returncode, 2)
        wrong = [i for i, u in enumerate(factors, 1) if 0.3 * (1 + 0.99 * u) > 0.4]
        self.assertGreater(len(wrong), 2)
        self.assertLess(len(wrong), 11)
        self.assertEqual([int(n) for n in re.findall(r'block (\d+):', result.stderr)], wrong)
        self.assertIn('&chain mu_k_scatter = 0.99: block', result.stderr)
        self.assertIn('mu_s must be >= mu_k', result.stderr)

    def test_many_blocks_are_counted(self):
        self.refused(namelist({**RUN, ('chain', 'n_blocks'): '3000', ('chain', 'mu_k_scatter'): '0.99',
                               ('friction', 'mu_k'): '0.3'}), 'more blocks are refused')

    def test_what_a_profile_needs(self):
        self.write_profile({'place': [1, 2], 'mu_s': [0.4, 0.5]})
        profile = {('friction', 'mu_s'): "'@profile.csv'"}
        self.refused(namelist({**RUN, **profile}), "its file has no column 'block'")
        self.refused(namelist(profile), 'needs two or more')
        self.refused(namelist({('slider', 'normal_traction'): "'@profile.csv'"}), 'needs two or more')
        self.write_profile({'block': [1, 2], 'mu_k': [0.4, 0.5]})
        self.refused(namelist({**RUN, **profile}), "its file has no column 'mu_s'")
        self.write_profile({'block': [1, 1], 'mu_s': [0.4, 0.5]})
        self.refused(namelist({**RUN, **profile}), 'must have each block once')
        (self.folder / 'profile.csv').unlink()
        self.refused(namelist({**RUN, **profile}), '&friction mu_s', 'profile.csv')

    def test_what_scatters(self):
        self.refused(namelist({**RUN, ('chain', 'mu_s_scatter'): '1', ('chain', 'm_scatter'): '-0.1', ('chain', 'scheme_scatter'): '0.1',
                               ('chain', 'a_scatter'): '0.1'}),
                     '&chain mu_s_scatter = 1: must be from 0 to 0.99', '&chain m_scatter = -0.1: must be from 0 to 0.99',
                     '&chain scheme_scatter: unknown key', '&chain a_scatter: unknown key')
        self.refused(namelist({('chain', 'n_blocks'): '1', ('chain', 'mu_s_scatter'): '0.1'}), 'needs two or more blocks')
        # a number of blocks out of range was taken to fill tables all the same
        for n in ('0', '-3', '1000001', '2000000000'):
            self.refused(namelist({**RUN, ('chain', 'n_blocks'): n, ('chain', 'alpha_t_scatter'): '0.1', ('chain', 'scatter'): '0.1'}),
                         f'&chain n_blocks = {n}: must be from 1 to 1000000')

    def test_a_start_that_a_block_cannot_have(self):
        self.write_profile({'block': [1, 2, 3], 'mu_s': [0.4, 0.3, 0.4], 'tau_max': [10.0, 10.0, 1.0]})
        self.refused(namelist({**RUN, ('friction', 'mu_s'): "'@profile.csv'", ('initial', 'mu'): '0.35'}),
                     '&initial mu = 0.35: block 2: exceeds its static friction coefficient, 0.3\n')
        self.refused(namelist({**RUN, ('friction', 'tau_max'): "'@profile.csv'", ('initial', 'r'): '0.5'}),
                     '&initial r = 0.5: block 3: makes a tangential traction above its tau_max = 1\n')


class Resumed(LongRun):
    @release_only
    def test_killed_runs_resume_to_the_same_bytes(self):
        for time in {('time', 'dt'): '2e-4'}, {('time', 'rtol'): '1e-4'}:
            self.stop_and_go(namelist({**RUN, ('time', 't_end'): '8', ('output', 'interval'): '2', ('output', 'checkpoint'): '0.02',
                                       ('chain', 'mu_s_scatter'): '0.2', ('chain', 'scatter'): '0.2', **time}), signal.SIGKILL, 3)

    def test_another_profile_is_another_input(self):
        (self.folder / 'profile.csv').write_text('block,mu_s\n1,0.4\n20,0.5\n')
        text = namelist({**RUN, ('friction', 'mu_s'): "'@profile.csv'", ('time', 't_end'): '1', ('time', 'rtol'): '1e-6', ('output', 'table_limit'): '2e-5',
                         ('output', 'interval'): '1'})
        self.assertEqual(self.run_text(text, '--no-plot').returncode, 1)   # the table is full
        (self.folder / 'profile.csv').write_text('block,mu_s\n1,0.4\n20,0.51\n')
        result = self.run_text(text.replace('2e-5', '1'), '--no-plot', '--resume')
        self.assertEqual(result.returncode, 2)
        self.assertIn('the input is not the one', result.stderr)
        (self.folder / 'profile.csv').write_text('block,mu_s\n1,0.4\n20,0.5\n')
        self.assertEqual(self.run_text(text.replace('2e-5', '1'), '--no-plot', '--resume').returncode, 0)
        parts = (self.folder / 'case_out/case.csv').read_bytes()
        shutil.rmtree(self.folder / 'case_out')
        self.run_text(text.replace('2e-5', '1'), '--no-plot')
        self.assertEqual((self.folder / 'case_out/case.csv').read_bytes(), parts)


if __name__ == '__main__':
    unittest.main()
