"""Sweeps as a user runs them: tables, pictures, bad input, failures, and going on after a kill.

STICKSLIP names the program.
"""
import math
import os
import pathlib
import re
import shutil
import signal
import subprocess
import time
import unittest

from drawing import needs_gnuplot
from strict_build import release_only
from test_program import INPUTS, PROGRAM, Program, namelist

COLUMNS = ('status,regime,events,late_events,period,stress_drop,peak_velocity,mean_force,energy_defect,'
           'stability,growth_rate,warnings,reason')
TWO_KEYS = {('sweep', 'key'): "'drive%velocity'", ('sweep', 'values'): '0.5, 1, 2, 4',
            ('sweep', 'key2'): "'slider%stiffness'", ('sweep', 'values2'): '1, 2, 4'}


def sweep(key, values, changes=(), without=()):
    return namelist({('sweep', 'key'): f"'{key}'", ('sweep', 'values'): values, **dict(changes)}, without)


class Sweep(Program):
    def run_sweep(self, text, *arguments):
        return self.run_text(text, '--no-plot', *arguments, verb='sweep')

    def table(self, folder='case_out'):
        return (self.folder / folder / 'case_sweep.csv').read_bytes()

    def journal(self, folder='case_out'):
        return self.folder / folder / 'case_sweep.journal'

    def journal_rows(self):
        if not self.journal().exists():
            return []
        whole = self.journal().read_text().rpartition('\n')[0].splitlines()
        return [line for line in whole if not line.startswith('#')]

    def begin(self, text):
        """A sweep in the background, one run at a time."""
        (self.folder / 'case.nml').write_text(text)
        process = subprocess.Popen([PROGRAM, 'sweep', 'case.nml', '--no-plot', '--jobs', '1'],
                                   cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        return process

    def wait_until(self, condition, process):
        while not condition():
            self.assertIsNone(process.poll(), 'the sweep ended too soon')
            time.sleep(1e-3)


class Table(Sweep):
    def test_one_row_a_combination_in_order(self):
        result = self.run_sweep(namelist(TWO_KEYS))
        self.assertEqual((result.returncode, result.stderr), (0, ''))
        lines = self.table().decode().splitlines()
        self.assertEqual(lines[0], 'drive%velocity,slider%stiffness,' + COLUMNS)
        self.assertEqual([line.split(',')[:3] for line in lines[1:]],
                         [[v, k, 'ok'] for v in ('0.5', '1', '2', '4') for k in ('1', '2', '4')])
        self.assertEqual(sorted(os.listdir(self.folder / 'case_out')),
                         ['case_sweep.csv', 'case_sweep.journal'])

    def test_the_table_is_the_same_for_any_number_of_runs_at_a_time(self):
        for jobs in ('1', '2', '7'):
            result = self.run_sweep(namelist({**TWO_KEYS, ('time', 't_end'): '4'}), '--output', jobs,
                                    '--jobs', jobs)
            self.assertEqual((result.returncode, result.stderr), (0, ''))
        self.assertEqual(self.table('1'), self.table('2'))
        self.assertEqual(self.table('1'), self.table('7'))

    def test_a_row_says_what_a_run_of_its_own_says(self):
        """Within the rounding of the drive's position, which is computed from half time on."""
        changes = {('slider', 'normal_traction'): '10', ('time', 't_end'): '40', ('slider', 'area'): '2'}
        self.run_sweep(sweep('drive%velocity', '1', changes))
        row, = self.rows('case_out/case_sweep.csv')
        self.run_text(namelist(changes), '--no-plot', '--output', 'alone')
        events = [{key: float(value) for key, value in event.items()}
                  for event in self.rows('alone/case_events.csv')]
        late = [event for event in events if event['onset'] >= 20]
        periods = [b['onset'] - a['onset'] for a, b in zip(late, late[1:])]
        self.assertGreater(len(late), 3)
        self.assertEqual(int(row['events']), len(events))
        self.assertEqual(int(row['late_events']), len(late))
        self.assertEqual(row['regime'], 'stick-slip')
        for column, expected in (
                ('period', sum(periods) / len(periods)),
                ('stress_drop', sum(event['stress_drop'] for event in late) / len(late)),
                ('peak_velocity', max(event['peak_velocity'] for event in late))):
            self.assertAlmostEqual(float(row[column]) / expected, 1, delta=1e-6, msg=column)
        # trapezoidal work of the spring over the drive's path, as the energy balance books it
        series = [(float(r['drive']), float(r['spring_force'])) for r in self.rows('alone/case.csv')]
        work = sum((b[0] - a[0]) * (a[1] + b[1]) / 2 for a, b in zip(series, series[1:]))
        self.assertAlmostEqual(float(row['mean_force']) * 40 / work, 1, delta=1e-3)
        self.assertLess(abs(float(row['energy_defect'])), 1e-2)

    def test_steady_sliding_has_no_period(self):
        self.run_sweep(sweep('drive%velocity', '1000, 0'))
        for row in self.rows('case_out/case_sweep.csv'):
            self.assertEqual((row['status'], row['regime']), ('ok', 'steady'))
            self.assertTrue(math.isnan(float(row['period'])))
            self.assertTrue(math.isnan(float(row['stress_drop'])))

    def test_one_value_replaces_a_list(self):
        self.run_sweep(sweep('drive%velocity', '1', {('drive', 'velocity'): '5, 6, 7',
                                                     ('drive', 'duration'): '3*0.03'}))
        changed = self.table()
        self.run_sweep(sweep('drive%velocity', '1', {('drive', 'velocity'): '1, 1, 1',
                                                     ('drive', 'duration'): '3*0.03'}), '--output', 'other')
        self.assertEqual(changed, self.table('other'))

    def test_check_counts_the_combinations_and_runs_nothing(self):
        result = self.run_text(namelist(TWO_KEYS), verb='check')
        self.assertEqual((result.returncode, result.stderr), (0, ''))
        self.assertEqual(result.stdout, 'case.nml: valid, 12 combinations, for stickslip sweep\n')
        self.assertEqual(os.listdir(self.folder), ['case.nml'])

    def test_quiet_says_nothing(self):
        result = self.run_sweep(sweep('drive%velocity', '1'), '--quiet')
        self.assertEqual((result.returncode, result.stdout, result.stderr), (0, '', ''))


class Picture(Sweep):
    @needs_gnuplot
    def test_pictures_are_drawn_also_where_nothing_sticks_or_all_has_failed_or_periods_are_long(self):
        failing = {('time', 'max_iterations'): '1'}
        slow = {**TWO_KEYS, ('sweep', 'values'): '1e-3, 2e-3', ('sweep', 'values2'): '1, 2', ('time', 't_end'): '4e4',
                ('time', 'rtol'): '1e-3'}
        for number, text in enumerate((
                sweep('drive%velocity', '1'), sweep('drive%velocity', '-1, 0, 1000'), namelist(TWO_KEYS),
                sweep('time%dt', '1e-3 2e-3', failing), namelist({**TWO_KEYS, **failing}),
                namelist(slow, [('time', 'dt')]))):
            result = self.run_text(text, '--output', f'out {number}', verb='sweep')
            self.assertNotIn('gnuplot', result.stderr)
            out = self.folder / f'out {number}'
            self.assertEqual((out / 'case_sweep.png').read_bytes()[:4], b'\x89PNG')
            self.assertTrue((out / 'case_sweep.gp').exists())
        periods = [float(row['period']) for row in self.rows('out 5/case_sweep.csv')]
        self.assertGreater(min(periods), 2)   # more than there are cells

    @needs_gnuplot
    def test_each_cell_of_the_map_lies_at_the_values_of_its_row(self):
        self.run_text(namelist({**TWO_KEYS, ('time', 't_end'): '5', ('slider', 'damping'): '0.5',
                                ('sweep', 'values'): '0.5, 1, 2000'}), verb='sweep')
        script = (self.folder / 'case_out/case_sweep.gp').read_text()
        places = re.search(r'using (\(regime\("steady"\).*?\):\(up\(0\)\))', script)[1]
        before = script[:script.index('\nplot') + 1].replace('set multiplot', '#')
        (self.folder / 'case_out/cells.gp').write_text(
            before + f'set table "cells"\nplot file using {places}\n')
        subprocess.run(['gnuplot', 'cells.gp'], cwd=self.folder / 'case_out', check=True, capture_output=True)
        cells = {tuple(map(int, line.split()[:2]))
                 for line in (self.folder / 'case_out/cells').read_text().splitlines()
                 if line.split() and line.split()[-1] == 'i'}
        rows = self.rows('case_out/case_sweep.csv')
        expected = {divmod(k, 3) for k, row in enumerate(rows) if row['regime'] == 'steady'}
        self.assertTrue(0 < len(expected) < 9, expected)
        self.assertEqual(cells, expected)


class BadInput(Sweep):
    def refused(self, text, *said):
        for verb in ('check', 'sweep'):
            result = self.run_text(text, verb=verb)
            self.assertEqual(result.returncode, 2, result.stderr)
            for part in said:
                self.assertIn(part, result.stderr)
            self.assertEqual(result.stdout, '')
            self.assertFalse((self.folder / 'case_out').exists())
        return result.stderr

    def test_what_the_group_lacks(self):
        self.refused(namelist({('sweep', 'key'): "'drive%velocity'"}), '&sweep values: is missing')
        self.refused(namelist({('sweep', 'values'): '1'}), '&sweep key: is missing')
        self.refused(sweep('drive%velocity', '1', {('sweep', 'key2'): "'time%dt'"}),
                     '&sweep values2: is missing')
        self.refused(sweep('drive%velocity', '1', {('sweep', 'values2'): '1'}), '&sweep key2: is missing')
        result = self.run_text(namelist(), verb='sweep')
        self.assertEqual(result.returncode, 2)
        self.assertIn('which needs a group &sweep', result.stderr)

    def test_keys_that_no_run_knows(self):
        self.refused(sweep('slider%masss', '1'), '&slider masss: unknown key')
        self.refused(sweep('slides%mass', '1'), '&slides: unknown group')
        self.refused(sweep('sweep%values', '1'), "&sweep key = 'sweep%values': must be a key of a run")
        self.refused(sweep('drive%velocity', '1', {('sweep', 'jobs'): '1'}), '&sweep jobs: unknown key')
        for key in ('velocity', 'drive%', '%velocity', 'drive velocity', '  '):
            self.refused(sweep(key, '1'), '&sweep key')
        self.refused(namelist({('sweep', 'key'): 'drive', ('sweep', 'values'): '1'}),
                     '&sweep key = drive: must be text in quotes')

    def test_values_that_break_the_rules_of_their_key(self):
        said = self.refused(namelist({**TWO_KEYS, ('sweep', 'key'): "'time%dt'",
                                      ('sweep', 'values'): '1e-3, 0, -1, 2', ('sweep', 'values2'): '1, -3'}),
                            '&time dt = 0: must be > 0', '&time dt = -1: must be > 0',
                            '&time dt = 2: must not exceed t_end', '&slider stiffness = -3: must be > 0')
        self.assertEqual(len(said.splitlines()), 4, said)
        self.refused(sweep('drive%velocity', "1, 'fast', NaN"), "&sweep values = 'fast': must be a number",
                     '&sweep values = NaN: must be finite')
        self.refused(sweep('output%interval', '1, 1.5'), '&output interval', 'must be a whole number')

    def test_values_that_break_the_rule_of_another_key_are_told(self):
        said = self.refused(sweep('friction%mu_k', '0.1, 0.5, 0.7'),
                            '&friction mu_s = 0.4: must be >= mu_k (at friction%mu_k = 0.5)')
        self.assertEqual(len(said.splitlines()), 1, said)

    def test_keys_that_are_not_numbers(self):
        self.refused(sweep('friction%law', '1, 2'), '&friction law = 1: must be text in quotes')

    def test_too_many_combinations_and_one_key_twice(self):
        self.refused(namelist({**TWO_KEYS, ('sweep', 'values'): '101*1', ('sweep', 'values2'): '100*1'}),
                     '&sweep values2: makes 10100 combinations; the most are 10000')
        self.refused(namelist({**TWO_KEYS, ('sweep', 'key2'): "'Drive%Velocity'"}),
                     'must differ from key')

    def test_faults_of_the_run_itself_are_listed_once(self):
        said = self.refused(sweep('drive%velocity', '1, 2, 3', {('slider', 'mass'): '-1'},
                                  without=[('friction', 'm')]),
                            '&slider mass = -1: must be >= 0', '&friction m: is missing')
        self.assertEqual(len(said.splitlines()), 2, said)

    def test_groups_and_drive_that_are_missing(self):
        self.refused(sweep('friction%m', '1, 2', without=[('drive', None)]), 'group &drive is missing')
        self.refused(sweep('friction%m', '1, 2', without=[('drive', 'velocity')]),
                     '&drive velocity: is missing')

    def test_a_run_does_not_take_a_sweep(self):
        result = self.run_text(sweep('drive%velocity', '1'))
        self.assertEqual(result.returncode, 2)
        self.assertIn('an input of the verb sweep, not of run', result.stderr)
        self.assertIn('stickslip sweep case.nml', result.stderr)

    def test_bad_usage(self):
        for arguments in (['sweep'], ['sweep', 'a.nml', '--jobs'], ['sweep', 'a.nml', '--jobs', '0'],
                          ['sweep', 'a.nml', '--jobs', 'all'], ['run', 'a.nml', '--jobs', '2'],
                          ['check', 'a.nml', '--jobs', '2'], ['run', 'a.nml', '--part', '1/2'],
                          *(['sweep', 'a.nml', '--part', part]
                            for part in ('', '1', '0/2', '3/2', '1/', '/2', '1/2/3', '-1/2', '1.0/2', '1/10000'))):
            result = self.run_program(*arguments)
            self.assertEqual(result.returncode, 2, arguments)
            self.assertIn('usage: stickslip', result.stderr)

    def test_output_directory_that_cannot_be(self):
        (self.folder / 'file').write_text('')
        result = self.run_sweep(sweep('drive%velocity', '1'), '--output', 'file/below')
        self.assertEqual(result.returncode, 2)
        self.assertIn("cannot write to the directory 'file/below'", result.stderr)


class Failures(Sweep):
    def test_one_failing_combination_does_not_stop_the_others(self):
        # friction falls faster than the soft spring unloads, and without a mass nothing takes that up
        result = self.run_sweep(sweep('slider%mass', '1e-3, 0, 2e-3', {
            ('time', 't_end'): '10', ('slider', 'damping'): '0'}))
        self.assertEqual(result.returncode, 1)
        self.assertIn('1 of 3 combinations failed', result.stderr)
        rows = self.rows('case_out/case_sweep.csv')
        self.assertEqual([row['status'] for row in rows], ['ok', 'failed', 'ok'])
        self.assertRegex(rows[1]['reason'], r'^at time .*, step \d+: ')
        self.assertEqual([rows[1]['regime'], rows[1]['period'], rows[0]['reason']], ['', 'NaN', ''])

    def test_a_run_that_crashes_fails_alone_and_is_tried_again(self):
        process = self.begin(sweep('drive%velocity', '1, 2, 3', {('time', 't_end'): '50'}))
        children = pathlib.Path(f'/proc/{process.pid}/task/{process.pid}/children')
        if not children.exists():
            self.skipTest('needs Linux to find the process of the run')
        self.wait_until(lambda: self.journal().exists() and not self.journal_rows()
                        and children.read_text().split(), process)
        os.kill(int(children.read_text().split()[0]), signal.SIGKILL)
        said = process.communicate(timeout=60)[1]
        self.assertEqual(process.returncode, 1, said)
        rows = self.rows('case_out/case_sweep.csv')
        self.assertEqual([row['status'] for row in rows], ['failed', 'ok', 'ok'])
        self.assertEqual(rows[0]['reason'], 'the run crashed')
        result = self.run_program('sweep', 'case.nml', '--no-plot')
        self.assertEqual((result.returncode, result.stderr), (0, ''))
        self.assertIn('1 run now, 2 taken from the journal', result.stdout)
        self.assertEqual([row['status'] for row in self.rows('case_out/case_sweep.csv')], ['ok'] * 3)

    def test_a_full_disk_is_a_failure(self):
        small = self.folder / 'case_out'
        small.mkdir()
        mounted = subprocess.run(['mount', '-t', 'tmpfs', '-o', 'size=8k', 'small', str(small)],
                                 capture_output=True, check=False)
        if mounted.returncode != 0:
            self.skipTest('needs the right to mount a small file system')
        self.addCleanup(subprocess.run, ['umount', str(small)], check=True)
        result = self.run_sweep(sweep('drive%velocity', ', '.join(map(str, range(1, 81)))))
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertIn('cannot write', result.stderr)


class Continuing(Sweep):
    LONG = namelist({**TWO_KEYS, ('time', 't_end'): '50'})

    def test_a_killed_sweep_goes_on_where_it_stopped_to_the_same_table(self):
        process = self.begin(self.LONG)
        self.wait_until(lambda: len(self.journal_rows()) >= 3, process)
        process.send_signal(signal.SIGKILL)
        process.communicate()
        self.assertFalse((self.folder / 'case_out/case_sweep.csv').exists())
        with open(self.journal(), 'a', encoding='utf-8') as file:
            file.write('4,4,ok,stick-sl')   # what a torn write leaves
        finished = len(self.journal_rows())
        result = self.run_program('sweep', 'case.nml', '--no-plot')
        self.assertEqual((result.returncode, result.stderr), (0, ''))
        self.assertIn(f'combinations       12: {12 - finished} run now, {finished} taken', result.stdout)
        self.run_program('sweep', 'case.nml', '--no-plot', '--output', 'whole')
        self.assertEqual(self.table(), self.table('whole'))
        self.assertEqual(sorted(self.journal().read_text().splitlines()),
                         sorted(self.journal('whole').read_text().splitlines()))

    def test_finished_rows_are_taken_as_they_are(self):
        self.run_sweep(namelist(TWO_KEYS))
        text = self.journal().read_text()
        self.assertEqual(text.count('\n1,2,ok,'), 1)
        self.journal().write_text(text.replace('\n1,2,ok,', '\n1,2,ok,marked '))
        result = self.run_sweep(namelist(TWO_KEYS))
        self.assertIn('0 run now, 12 taken from the journal', result.stdout)
        self.assertIn(b'\n1,2,ok,marked ', self.table())

    def test_a_row_torn_anywhere_is_run_again(self):
        self.run_sweep(namelist(TWO_KEYS))
        table, journal = self.table(), self.journal().read_bytes()
        for cut in (1, 2, 40, 100, 300, len(journal) - 3, len(journal)):
            self.journal().write_bytes(journal[:-cut])
            result = self.run_sweep(namelist(TWO_KEYS))
            self.assertEqual((result.returncode, result.stderr), (0, ''), cut)
            self.assertEqual(self.table(), table)

    def test_parts_merge_into_the_table_of_a_sweep_in_one_go(self):
        self.run_sweep(namelist(TWO_KEYS), '--output', 'whole')
        for part in ('2/3', '3/3', '1/3'):
            result = self.run_sweep(namelist(TWO_KEYS), '--part', part)
            self.assertEqual((result.returncode, result.stderr), (0, ''))
            self.assertIn('4: 4 run now, 0 taken from the journal', result.stdout)
            self.assertFalse((self.folder / 'case_out/case_sweep.csv').exists())
        second = (self.folder / 'case_out/case_sweep_part_2.journal').read_text().splitlines()
        self.assertEqual(sorted(line.split(',')[:2] for line in second if not line.startswith('#')),
                         [['0.5', '2'], ['1', '1'], ['2', '4'], ['4', '2']])
        result = self.run_sweep(namelist(TWO_KEYS))
        self.assertEqual((result.returncode, result.stderr), (0, ''))
        self.assertIn('12: 0 run now, 12 taken from the journal', result.stdout)
        self.assertEqual(self.table(), self.table('whole'))

    def test_a_part_that_is_missing_or_torn_is_run_by_whoever_comes_next(self):
        self.run_sweep(namelist(TWO_KEYS), '--output', 'whole')
        self.run_sweep(namelist(TWO_KEYS), '--part', '2/2')
        journal = self.folder / 'case_out/case_sweep_part_2.journal'
        journal.write_bytes(journal.read_bytes()[:-5])
        result = self.run_sweep(namelist(TWO_KEYS), '--part', '2/4')
        self.assertIn('part               2 of 4', result.stdout)
        self.assertRegex(result.stdout, '3: [23] run now, [01] taken from the journal')
        result = self.run_sweep(namelist(TWO_KEYS), '--part', '13/13')
        self.assertIn('0: 0 run now, 0 taken from the journal', result.stdout)
        self.run_sweep(namelist(TWO_KEYS))
        self.assertEqual(self.table(), self.table('whole'))

    def test_a_part_of_another_input_is_not_taken(self):
        self.run_sweep(namelist(TWO_KEYS), '--part', '1/2')
        result = self.run_sweep(namelist({**TWO_KEYS, ('slider', 'area'): '2'}))
        self.assertEqual(result.returncode, 2)
        self.assertIn('case_sweep_part_1.journal holds results of another input', result.stderr)

    def test_runs_of_a_sweep_that_is_killed_end_too(self):
        # they hold its standard output open: who waits for that would wait for them
        for chain in ('', '&chain n_blocks = 1000, coupling = 10 /\n'):
            process = self.begin(sweep('drive%velocity', '1, 2', {('time', 't_end'): '1e6'}) + chain)
            children = pathlib.Path(f'/proc/{process.pid}/task/{process.pid}/children')
            if not children.exists():
                self.skipTest('/proc tells of no children')
            self.wait_until(lambda: children.read_text(), process)
            process.kill()
            process.communicate(timeout=60)
            shutil.rmtree(self.folder / 'case_out')   # the journal is that of another input

    def test_a_part_tells_the_failures_among_its_own(self):
        text = sweep('slider%mass', '1e-3, 0, 2e-3', {('time', 't_end'): '10', ('slider', 'damping'): '0'})
        first = self.run_sweep(text, '--part', '1/2')
        self.assertEqual((first.returncode, first.stderr), (0, ''))
        second = self.run_sweep(text, '--part', '2/2')
        self.assertEqual(second.returncode, 1)
        self.assertIn('1 of 2 combinations failed; the reasons are in case_out/case_sweep_part_2.journal', second.stderr)

    def test_more_values_add_to_what_is_there(self):
        self.run_sweep(sweep('drive%velocity', '1, 2'))
        result = self.run_sweep('! comments do not matter\n' + sweep('drive%velocity', '3, 2, 1, 4'))
        self.assertIn('2 run now, 2 taken from the journal', result.stdout)
        self.assertEqual([row['drive%velocity'] for row in self.rows('case_out/case_sweep.csv')],
                         ['3', '2', '1', '4'])

    def test_a_changed_input_does_not_go_on_with_the_old_journal(self):
        self.run_sweep(sweep('drive%velocity', '1, 2'))
        before = self.table(), self.journal().read_bytes()
        for changed in (sweep('drive%velocity', '1, 2', {('slider', 'damping'): '0.02'}),
                        sweep('slider%stiffness', '1, 2'), namelist(TWO_KEYS)):
            result = self.run_sweep(changed)
            self.assertEqual((result.returncode, result.stdout), (2, ''))
            self.assertIn('case_sweep.journal holds results of another input', result.stderr)
            self.assertEqual((self.table(), self.journal().read_bytes()), before)


class ShippedInputs(Sweep):
    def test_period_and_drop_fall_with_the_drive_velocity_until_sliding_is_steady(self):
        result = self.run_program('sweep', INPUTS / 'sweep_velocity.nml', '--no-plot')
        self.assertEqual((result.returncode, result.stderr), (0, ''))
        rows = self.rows('sweep_velocity_out/sweep_velocity_sweep.csv')
        regimes = [row['regime'] for row in rows]
        sticking = regimes.count('stick-slip')
        self.assertEqual(regimes, ['stick-slip'] * sticking + ['steady'] * (len(rows) - sticking))
        self.assertTrue(3 < sticking < len(rows))
        for column in ('period', 'stress_drop'):
            values = [float(row[column]) for row in rows[:sticking]]
            self.assertEqual(values, sorted(values, reverse=True))

    @release_only
    def test_stiffer_springs_and_faster_drives_slide_steadily(self):
        """On every other line of the map's grid."""
        text = re.sub(r'(values2?) = (.*)', lambda found: found[1] + ' = ' + ','.join(
            found[2].split(',')[::2]), (INPUTS / 'sweep_map.nml').read_text(encoding='utf-8'))
        self.assertEqual(self.run_sweep(text).returncode, 0)
        steady = {(float(row['drive%velocity']), float(row['slider%stiffness'])): row['regime'] == 'steady'
                  for row in self.rows('case_out/case_sweep.csv')}
        self.assertEqual(len(steady), 30)
        self.assertTrue(0 < sum(steady.values()) < 30)
        for (velocity, stiffness), is_steady in steady.items():
            if is_steady:
                self.assertTrue(all(other for (v, k), other in steady.items()
                                    if v >= velocity and k >= stiffness), (velocity, stiffness))


if __name__ == '__main__':
    unittest.main()
