"""stickslip.fit: constants from synthetic records, and records that it refuses."""
import dataclasses
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np

import stickslip
from stickslip._records import analyse, find_falls

TRUE = {'mu_s': 0.4, 'mu_k': 0.2}
INPUT = {'friction': {'law': 'subloading', 'alpha_n': 1.0, 'alpha_t': 0.2, 'mu_s': 0.35, 'mu_k': 0.25, 'kappa': 3.0, 'xi': 2.0,
                      'm': 100.0},
         'slider': {'mass': 1e-3, 'stiffness': 1.0, 'damping': 0.02, 'area': 1000.0, 'normal_traction': 0.01},
         'drive': {'velocity': 1.0}, 'time': {'t_end': 17.0, 'rtol': 1e-8}, 'output': {'every': 0.01}}
BOUNDS = {'mu_s': (0.3, 0.6), 'mu_k': (0.1, 0.29)}
SETTINGS = {'free': list(TRUE), 'bounds': BOUNDS, 'starts': 8, 'progress': lambda text: None}


def synthetic(noise=0.01, seed=1, **changes):
    """A record of the model with the true constants."""
    run = stickslip.run({**INPUT, 'friction': {**INPUT['friction'], **TRUE}, **changes})
    force = run.table['spring_force'].to_numpy()
    return run.table['time'].to_numpy(), force + noise * force.max() * np.random.default_rng(seed).normal(size=force.size)


class Fit(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.time, cls.force = synthetic()
        cls.record = stickslip.Record(cls.time, cls.force)
        cls.fit = stickslip.fit(cls.record, INPUT, **SETTINGS)

    def test_the_constants_lie_in_their_intervals(self):
        for name, true in TRUE.items():
            low, high = self.fit.intervals[name]
            self.assertLess(abs(np.log(self.fit.values[name] / true)), 1.3 * 0.5 * np.log(high / low), str(self.fit))
            self.assertLess(abs(self.fit.values[name] / true - 1), 0.02)
        self.assertEqual(self.fit.undetermined, [])
        self.assertLess(max(self.fit.misfit['record'].values()), 2.0)

    def test_the_namelist_runs_as_it_stands(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, 'fitted.nml')
            self.fit.write_namelist(path)
            run = stickslip.run(path)
        falls = find_falls(run.table['time'].to_numpy(), run.table['spring_force'].to_numpy(), 0.5)
        measured = analyse(self.record).falls
        np.testing.assert_allclose(falls.middle[:5], measured.middle[:5], rtol=0.01)

    def test_the_picture_is_drawn(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, 'fit.png')
            self.fit.plot(path)
            self.assertGreater(path.stat().st_size, 10_000)

    def test_stopped_and_resumed_gives_the_same(self):
        with tempfile.TemporaryDirectory() as folder:
            checkpoint = pathlib.Path(folder, 'fit.checkpoint')
            stopped = stickslip.fit(self.record, INPUT, **SETTINGS, checkpoint=checkpoint,
                                    most_evaluations=6 * self.fit.evaluations // 10)
            self.assertIn('stopped', ' '.join(stopped.warnings))
            with checkpoint.open('a') as file:
                file.write('{"kind": "fu')   # cut short
            resumed = stickslip.fit(self.record, INPUT, **SETTINGS, checkpoint=checkpoint, jobs=2)
            self.assertEqual(resumed.values, self.fit.values)
            self.assertEqual(resumed.intervals, self.fit.intervals)
            self.assertLess(resumed.evaluations, self.fit.evaluations)
            with self.assertRaisesRegex(ValueError, 'another fit'):
                stickslip.fit(self.record, INPUT, **{**SETTINGS, 'seed': 2}, checkpoint=checkpoint)

    def test_what_a_record_does_not_determine_is_named(self):
        """The normal spring does not: the normal traction is given."""
        found = stickslip.fit(self.record, INPUT, **{**SETTINGS, 'free': ['mu_s', 'alpha_n'], 'starts': 4,
                                                     'bounds': {'mu_s': (0.35, 0.45), 'alpha_n': (0.1, 10.0)}})
        self.assertEqual(found.undetermined, ['alpha_n'])
        self.assertEqual(found.intervals['alpha_n'], (0.0, np.inf))

    def test_a_wrong_velocity_is_told_and_can_be_found(self):
        """The record was taken at v = 1; the input says 0.9."""
        record = stickslip.Record(self.time, self.force, {'drive': {'velocity': 0.9}}, name='rig')
        wrong = stickslip.fit(record, INPUT, **{**SETTINGS, 'starts': 4})
        told = [warning for warning in wrong.warnings if 'faster than stiffness times velocity' in warning]
        self.assertEqual(len(told), 1, wrong.warnings)
        self.assertRegex(told[0], "rig: .* a velocity of (0.9[5-9]|1.0).* 'velocity_factor' or 'slider.stiffness'")
        found = stickslip.fit(record, INPUT, **{**SETTINGS, 'free': [*TRUE, 'velocity_factor']})
        low, high = found.intervals['velocity_factor']
        self.assertLess(abs(np.log(found.values['velocity_factor'] * 0.9)), 1.3 * 0.5 * np.log(high / low), str(found))
        self.assertAlmostEqual(found.values['velocity_factor'], 1 / 0.9, delta=0.005)
        self.assertAlmostEqual(found.settings()['drive']['velocity'], 1.0, delta=0.005)
        with self.assertRaisesRegex(ValueError, 'velocity_factor: rig has no drive.velocity'):
            stickslip.fit(dataclasses.replace(record, settings={}), {**INPUT, 'drive': {}}, free=['velocity_factor'])

    def test_the_command_does_the_same(self):
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            np.savetxt(folder / 'rig.csv', np.column_stack([1e3 * self.time, self.force]), header='t (ms),pull', delimiter=',',
                       comments='')
            text = stickslip._namelist.written({**INPUT, 'fit': {
                'records': 'rig.csv', 'time_column': 't (ms)', 'time_factor': 1e-3, 'force_column': 'pull', 'free': list(TRUE),
                'lower': [BOUNDS[name][0] for name in TRUE], 'upper': [BOUNDS[name][1] for name in TRUE], 'starts': 8}})
            (folder / 'rig.nml').write_text(text)
            result = subprocess.run([sys.executable, '-m', 'stickslip._fit_command', 'rig.nml'], cwd=folder, text=True,
                                    capture_output=True, check=False)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertIn('mu_k', result.stdout)
            self.assertEqual(sorted(path.name for path in (folder / 'rig_fit').iterdir()), ['rig.nml', 'rig.png', 'rig.txt'])
            for broken, words in ((text[:text.index("rig.csv") + 3], 'no namelist that can be read'), ('hello', '&fit is missing'),
                                  (text.replace("'rig.csv'", "'none.csv'"), 'none.csv')):
                (folder / 'broken.nml').write_text(broken)
                result = subprocess.run([sys.executable, '-m', 'stickslip._fit_command', 'broken.nml'], cwd=folder, text=True,
                                        capture_output=True, check=False)
                self.assertEqual(result.returncode, 2)
                self.assertRegex(result.stderr, f'^stickslip-fit: broken.nml: .*{words}')
            (folder / 'bad.nml').write_text(text.replace('records', 'recordings'))
            result = subprocess.run([sys.executable, '-m', 'stickslip._fit_command', 'bad.nml'], cwd=folder, text=True,
                                    capture_output=True, check=False)
            self.assertEqual(result.returncode, 2)
            self.assertIn('recordings: unknown key', result.stderr)
            self.assertIn('records is missing', result.stderr)

    def test_an_input_that_cannot_run_is_told_in_the_program_s_words(self):
        slider = {**INPUT['slider'], 'colour': 3}
        for changes, free, bounds, words in (
                ({}, ['nonsense'], (1, 2), 'nonsense.*unknown'), ({'slider': slider}, ['mu_s'], (0.3, 0.5), 'colour.*unknown'),
                ({}, 'mu_s', (0.01, 0.02), 'mu_k'), ({}, ['mu_s'], (0.25001, 0.2502), 'no candidate within the bounds')):
            with self.assertRaisesRegex(ValueError, f'fit: (?s:.*){words}'):
                name = free if isinstance(free, str) else free[0]
                stickslip.fit(self.record, {**INPUT, **changes}, free=free, bounds={name: bounds}, starts=4)
        with self.assertRaisesRegex(ValueError, 'twice'):
            stickslip.fit(self.record, INPUT, free=['mu_s', 'mu_s'])
        with self.assertRaisesRegex(TypeError, 'stickslip.Record'):
            stickslip.fit((self.time, self.force), INPUT, free=['mu_s'])

    def test_bounds_and_names_are_checked(self):
        for free, bounds, words in ((['mu_s'], {'mu_s': (0.5, 0.4)}, '0 < lower < upper'), (['mu_s'], {}, 'no bounds for mu_s'),
                                    (['mu_0'], 5.0, 'give bounds by name'), ([], 5.0, 'no free'), (['mu_s'], 0.5, 'above 1')):
            with self.assertRaisesRegex(ValueError, words):
                stickslip.fit(self.record, INPUT, free=free, bounds=bounds)


class Records(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.time, cls.force = synthetic()

    def refused(self, time, force, words):
        with self.assertRaisesRegex(stickslip.RecordError, words):
            analyse(stickslip.Record(time, force, name='rig'))

    def test_what_cannot_be_fitted_is_refused_in_words(self):
        t, force = self.time, self.force
        draw = np.random.default_rng(3)
        self.refused(t, 3.0 + draw.normal(size=t.size), 'rig: no sustained stick-slip')
        self.refused(t, 3.0 * (1 - np.exp(-t)) + 0.01 * draw.normal(size=t.size), 'no sustained stick-slip|too few')
        few = t < 5.5
        self.refused(t[few], force[few], r'\d slip events, which are too few')
        self.refused(t, -force, 'negative')
        self.refused(t, force + 4.0 * draw.normal(size=t.size), 'noise')
        gap = (t < 10) | (t > 12)
        self.refused(t[gap], force[gap], 'nothing was recorded from 9.99 to 12')
        self.refused(t[::-1], force, 'time does not increase')
        self.refused(t[:20], force[:20], 'too few')
        self.refused(t, np.where(t > 3, np.nan, force), 'not a finite number')
        longer = np.concatenate([t, t[-1] + 0.01 * np.arange(1, 2000)])
        rest = force[-1] + 0.01 * draw.normal(size=1999)
        self.refused(longer, np.concatenate([force, rest]), 'the last event ends')

    def test_a_drift_is_taken_out_and_told(self):
        found = analyse(stickslip.Record(self.time, self.force + 0.05 * self.time))
        self.assertTrue(any('drift' in warning for warning in found.warnings))
        clean = analyse(stickslip.Record(self.time, self.force))
        self.assertEqual(clean.warnings, ())
        np.testing.assert_allclose(np.ptp(found.falls.peak[1:]), np.ptp(clean.falls.peak[1:]), atol=0.1)

    def test_a_turned_force_with_an_offset_is_refused_by_its_shape(self):
        self.refused(self.time, 5.0 - self.force, 'falls slowly .* and rises fast .* wrong sign')
        walk = np.cumsum(np.random.default_rng(1).normal(size=4000))
        for time, force in ((self.time, 3.0 + np.sin(5.0 * self.time)), (np.arange(4000.0), 20.0 - walk.min() + walk)):
            told = analyse(stickslip.Record(time, force)).warnings
            self.assertTrue(any('oscillation or noise' in warning for warning in told), told)

    def test_single_samples_that_stand_out_are_left_out_and_told(self):
        draw = np.random.default_rng(4)
        places = draw.choice(np.arange(100, self.time.size, 20), 8, replace=False)
        force = self.force.copy()
        force[places] = draw.choice([0.0, 50.0], 8)
        found, clean = (analyse(stickslip.Record(self.time, values)) for values in (force, self.force))
        self.assertRegex(found.warnings[0], '8 samples stand out')
        np.testing.assert_allclose(found.falls.middle, clean.falls.middle, atol=0.02)

    def test_a_drive_that_starts_late_is_told(self):
        idle = np.arange(0.0, 20.0, 0.01)
        found = analyse(stickslip.Record(np.concatenate([idle, 20.0 + self.time]), np.concatenate([0.0 * idle, self.force])))
        self.assertFalse(found.from_rest)
        self.assertRegex(found.warnings[0], 'begins to rise at about (19.9|20.0)')
        self.assertGreater(found.noise, 0.0)

    def test_a_drift_from_a_slack_start_leaves_the_start_where_it_was(self):
        found = analyse(stickslip.Record(self.time, self.force + 0.02 * self.time))
        self.assertRegex(found.warnings[0], 'drift by 0.1[78]')
        np.testing.assert_allclose(found.falls.peak, analyse(stickslip.Record(self.time, self.force)).falls.peak, atol=0.04)

    def test_wrong_units_are_told_before_the_search(self):
        for time, force in ((1e3 * self.time, self.force), (self.time, 1e3 * self.force), (self.time, 1e-3 * self.force)):
            with self.assertRaisesRegex(stickslip.RecordError, 'stiffness times velocity is 1: the units'):
                stickslip.fit(stickslip.Record(time, force), INPUT, **SETTINGS)

    def test_arrays_that_are_no_numbers_are_told(self):
        t, force = self.time, self.force
        for time, pull, words in ((['a'] * 60, ['b'] * 60, 'time: numbers are needed'), (t, [None] * t.size, 'force: numbers'),
                                  (np.stack([t, t]), np.stack([force, force]), r'time has the shape \(2, 1701\)'),
                                  (t, force + 0j, 'not complex'), ([], [], '0 samples')):
            self.refused(time, pull, words)
        self.assertEqual(stickslip.Record(t[:, None], force[None, :]).force.shape, t.shape)

    def test_files_of_many_writers_are_read(self):
        plain = [f'{t:.4f},{force:.5f}' for t, force in zip(self.time, self.force)]
        commas = [line.replace(',', ';').replace('.', ',') for line in plain]
        texts = {'plain': ['time,spring_force', *plain], 'decimal commas': ['time;spring_force', *commas],
                 'decimal commas, tabs': ['time\tspring_force', *(line.replace(';', '\t') for line in commas)],
                 'quoted': ['"time","spring_force"', *('"' + line.replace(';', '","') + '"' for line in commas)],
                 'spaces': ['time   spring_force', *(line.replace(',', '   ') for line in plain)],
                 'units': ['time,spring_force', 's,N', *plain], 'head': ['Rig 3', '', 'date: today', 'time,spring_force', *plain],
                 'comments': ['# time,spring_force', '# made by hand', *plain], 'others': ['n,spring_force,time', *(
                     f'{k},' + ','.join(reversed(line.split(','))) for k, line in enumerate(plain))]}
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, 'rig.csv')
            for kind, lines in texts.items():
                for end, code in (('\n', 'utf-8'), ('\r\n', 'utf-8-sig'), ('\n', 'utf-16')):
                    path.write_bytes(end.join(lines).encode(code))
                    read = stickslip.Record.read(path)
                    np.testing.assert_allclose(read.force, self.force, atol=1e-5, err_msg=f'{kind} {code}')
            path.write_bytes('\n'.join(['time,spring_force,\xb5', *(f'{line},1' for line in plain)]).encode('latin-1'))
            np.testing.assert_allclose(stickslip.Record.read(path).time, self.time, atol=1e-4)

    def test_files_that_cannot_be_read_are_told(self):
        plain = [f'{t:.4f},{force:.5f}' for t, force in zip(self.time, self.force)]
        head = 'time,spring_force'
        with tempfile.TemporaryDirectory() as folder:
            for name, lines, words in (('cut.csv', [head, *plain, '17.'], "cut.csv, line 1703: '17.' has no number for each"),
                                       ('text.csv', [head, *plain[:5], 'pause', *plain], "line 7: 'pause'"),
                                       ('none.csv', plain, "no column 'time'; there are 0.0000"), ('empty.csv', [], 'is empty'),
                                       ('gap.csv', [head, '0,', *plain[1:]], 'sample 1 of 1701 is not a finite number'),
                                       ('no.mat', ['text'], 'not a MATLAB file')):
                path = pathlib.Path(folder, name)
                path.write_text('\n'.join(lines))
                with self.assertRaisesRegex(stickslip.RecordError, words):
                    stickslip.Record.read(path)
            with self.assertRaises(OSError):
                stickslip.Record.read(pathlib.Path(folder, 'missing.csv'))

    def test_offsets_units_and_starts_do_not_matter(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, 'rig.txt')
            np.savetxt(path, np.column_stack([1e3 * (self.time + 50), np.ones_like(self.time), 2 * self.force - 3]),
                       header='ms\tother\tload cell', delimiter='\t', comments='')
            found = analyse(stickslip.Record.read(path, time='ms', force='load cell', time_factor=1e-3, force_factor=0.5,
                                                  force_offset=1.5))
            with self.assertRaisesRegex(stickslip.RecordError, "no column 'force'; there are ms, other, load cell"):
                stickslip.Record.read(path, time='ms', force='force')
        plain = analyse(stickslip.Record(self.time, self.force))
        np.testing.assert_allclose(found.falls.middle, plain.falls.middle, rtol=1e-6)

    def test_records_whose_events_scatter_are_known_as_such(self):
        draw = np.random.default_rng(1)
        t, force, out = 0.0, 2.0, []
        while t < 60:
            peak, drop = draw.normal(3.0, 0.1), draw.normal(1.0, 0.3)
            n = max(5, round((peak - force) / 0.01))
            out += [*np.linspace(force, peak, n), *np.linspace(peak, peak - max(drop, 0.3), 6)[1:-1]]
            force = peak - max(drop, 0.3)
            t += 0.01 * (n + 4)
        found = analyse(stickslip.Record(0.01 * np.arange(len(out)), np.array(out) + 0.01 * draw.normal(size=len(out))))
        self.assertTrue(found.scattered)
        self.assertFalse(found.from_rest)
        self.assertAlmostEqual(found.drop, 1.0, delta=0.15)


class RateAndState(unittest.TestCase):
    def test_a_velocity_step_and_a_hold_give_their_constants_back(self):
        true = {'a': 0.01, 'b': 0.014, 'd_c': 5.0, 'stiffness': 0.02}
        t = np.concatenate([np.arange(0, 40, 0.5), np.arange(40, 80, 0.1), np.arange(80, 130, 0.5)])
        from stickslip._rate_state import _Steps
        velocity, changes = np.array([3.0, 10.0, 0.0, 10.0]), np.array([40.0, 80.0, 110.0])
        steps = _Steps(t, t, changes, velocity, np.ones_like(t))
        friction = steps.model(np.array(list(true.values())), 'ageing')
        noisy = friction + 1e-4 * t / 130 + 1e-4 * np.random.default_rng(1).normal(size=t.size)
        found = stickslip.fit_rate_and_state(t, noisy, changes=changes, velocity=velocity, starts=16,
                                             bounds={'d_c': (1.0, 50.0), 'stiffness': (0.005, 0.1)})
        for name, value in true.items():
            low, high = found.intervals[name]
            self.assertLess(abs(np.log(found.values[name] / value)), 1.3 * 0.5 * np.log(high / low), f'{name}: {found}')
            self.assertAlmostEqual(found.values[name], value, delta=0.1 * value)
        law = found.law(alpha_n=1, alpha_t=1, v0=3, f0=0.6)
        self.assertEqual(law.props[3], found.values['a'])

    def test_bad_records_are_told(self):
        t = np.arange(100.0)
        for arguments, words in (({'changes': [200.0], 'velocity': [1, 2]}, 'between 0 and 99'),
                                 ({'changes': [50.0], 'velocity': [1]}, '1 velocities for 1 changes'),
                                 ({'changes': [50.0]}, 'either displacement or velocity'),
                                 ({'changes': [50.0], 'velocity': [0, 1]}, 'the first above 0'),
                                 ({'changes': [5.0], 'velocity': [1, 2]}, 'too few')):
            with self.assertRaisesRegex(ValueError, words):
                stickslip.fit_rate_and_state(t, np.ones(100), **arguments)


if __name__ == '__main__':
    unittest.main()
