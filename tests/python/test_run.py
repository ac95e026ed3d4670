"""stickslip.run: the program in this process, the same numbers as from its files."""
import concurrent.futures
import ctypes
import os
import pathlib
import pickle
import subprocess
import sys
import tempfile
import threading
import time
import types
import unittest
import unittest.mock
import warnings

import numpy as np

import stickslip
from stickslip import _namelist, _program

ROOT = pathlib.Path(__file__).resolve().parents[2]
SLIDER = {'mass': 1e-3, 'stiffness': 1.0, 'damping': 0.01, 'area': 1000.0, 'normal_traction': 0.01}
LAW = stickslip.laws.Subloading(alpha_n=1.0, alpha_t=1.0, mu_s=0.4, mu_k=0.2, kappa=10.0, xi=10.0, m=1000.0)
INPUT = {'friction': LAW, 'slider': SLIDER, 'drive': {'velocity': 1.0}, 'time': {'t_end': 8.0, 'dt': 1e-3}}
SHORT = {**INPUT, 'time': {'t_end': 0.02, 'dt': 1e-3}}


class Run(unittest.TestCase):
    def test_a_dict_is_a_namelist_is_a_file(self):
        by_dict = stickslip.run(INPUT)
        text = ("&friction law='subloading' alpha_n=1 alpha_t=1 mu_s=.4 mu_k=.2 kappa=10 xi=10 m=1000 /\n"
                '&slider mass=1e-3 stiffness=1 damping=.01 area=1000 normal_traction=.01 /\n'
                '&drive velocity=1 /\n&time t_end=8 dt=1e-3 /\n')
        by_text = stickslip.run(text)
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, 'slider.nml')
            path.write_text(text)
            by_path = stickslip.run(path)
        for other in (by_text, by_path):
            np.testing.assert_array_equal(by_dict.table, other.table)
            np.testing.assert_array_equal(by_dict.events, other.events)
            self.assertEqual(repr(by_dict.summary), repr(other.summary))
        self.assertEqual(len(by_dict.table), 8001)
        self.assertGreater(len(by_dict.events), 1)
        self.assertEqual(by_dict.summary['events'], len(by_dict.events))
        self.assertAlmostEqual(by_dict.table['spring_force'].max(), 4.0, delta=0.1)   # mu_s S f_n

    @unittest.skipUnless(os.access(ROOT / 'build/release/driver/stickslip', os.X_OK), 'the program is not built')
    def test_every_input_gives_the_same_numbers_as_the_program_writes(self):
        for name in ('stick_slip', 'slow_steady', 'velocity_steps', 'adaptive', 'rate_and_state', 'from_file', 'chain_blocks'):
            path = ROOT / 'inputs' / f'{name}.nml'
            with warnings.catch_warnings():
                warnings.simplefilter('ignore')
                found = stickslip.run(path)
            with tempfile.TemporaryDirectory() as folder:
                subprocess.run([ROOT / 'build/release/driver/stickslip', 'run', path, '--output', folder, '--no-plot',
                                '--quiet'], check=True, capture_output=True)
                events = found.catalogue if name == 'chain_blocks' else found.events
                self.assertEqual(len(found.catalogue) > 0, name == 'chain_blocks')
                for ending, table in (('', found.table), ('_events', events), ('_pieces', found.pieces)):
                    if ending == '_pieces' and len(table) == 1:
                        continue   # the program writes it for programmes of several pieces
                    lines = pathlib.Path(folder, f'{name}{ending}.csv').read_text().splitlines()
                    self.assertEqual(lines[0], ','.join(table.columns))
                    written = np.array([line.split(',') for line in lines[1:]], float).reshape(-1, len(table.columns))
                    np.testing.assert_array_equal(table.to_numpy(), written, err_msg=name)

    def test_faults_are_all_listed_as_by_the_program(self):
        with self.assertRaises(stickslip.InputError) as caught:
            stickslip.run({**INPUT, 'slider': {**SLIDER, 'stiffness': -1.0, 'weight': 3}, 'friction': {**LAW.constants(), 'm': 0}})
        for word in ('stiffness', 'weight', 'm = 0'):
            self.assertIn(word, str(caught.exception))
        with self.assertRaises(OSError):
            stickslip.run('no such file.nml')
        with self.assertRaises(stickslip.InputError):
            stickslip.run('&slider mass=1 /\n')
        with self.assertRaises(TypeError):
            stickslip.run({'friction': 3})

    def test_a_file_is_read_as_the_program_reads_it(self):
        """Whatever wrote it, and whatever its folder is called."""
        text = f'! \xb5m, \xe4\n{_namelist.written(_namelist.groups_of(SHORT))}'
        rows = stickslip.run(SHORT).table
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, 'a&b', 'x.nml')
            path.parent.mkdir()
            for content in (*map(text.encode, ('utf-8', 'utf-8-sig', 'utf-16', 'utf-16-le', 'utf-16-be', 'latin-1')),
                            text.replace('\n', '\r\n').encode()):
                path.write_bytes(content)
                np.testing.assert_array_equal(stickslip.run(str(path)).table, rows)
                self.assertEqual(len(stickslip.stability(path).table), 1)
            path.write_bytes(text.encode() + b'\n\0&slider /')
            with self.assertRaisesRegex(stickslip.InputError, 'x.nml: line [0-9]+: holds a character 0'):
                stickslip.run(path)
        with self.assertRaisesRegex(stickslip.InputError, 'a character 0'):
            stickslip.run(text + '\0')

    def test_what_is_written_is_read_back_to_the_last_bit(self):
        draw = np.random.default_rng(5)
        words = ["it's", 'a "b" \\ c', '\xb5m', ' & / ! $ ', 'x = 1, y', '1.5', '.true.', '']
        for _ in range(300):
            numbers = (draw.normal(size=draw.integers(1, 20)) * 10.0**draw.uniform(-300, 300)).tolist()
            groups = {'a': {'reals': numbers if len(numbers) > 1 else numbers[0], 'whole': int(draw.integers(-10**17, 10**17))},
                      'b_2': {'text': str(draw.choice(words)), 'texts': draw.choice(words, 3).tolist(), 'yes': True},
                      'c': {'no': [False, True], 'mixed': [1, -0.0, 5e-324, 'x', 1.7e308]}, 'empty': {}}
            self.assertEqual(_namelist.groups_of(_namelist.written(groups)), groups)
        self.assertEqual(_namelist.groups_of("&A x(2::-1) = 2*5 X(3:) = 1d1, +07 /\n&b t = T f = .FALSE. /"),
                         {'a': {'x': [5, 5, 10.0, 7]}, 'b': {'t': True, 'f': False}})

    def test_missing_arguments_of_the_c_interface_are_told(self):
        names = (ctypes.c_char_p * 2)(b'time', None)
        place = ctypes.c_void_p()
        for routine, *arguments in ((_program._groups, None, b'', 0), (_program._groups, b'x', None, 0), (_program._groups, b'x', b'', -1),
                                    (_program._columns, None, 0, 1, names), (_program._columns, b'', 0, 1, None),
                                    (_program._columns, b'', 0, 2, names), (_program._columns, b'', 0, 0, names)):
            self.assertEqual(routine(*arguments, place), -8)
            self.assertIsNone(place.value)
        self.assertEqual(_program._groups(b'x', b'', 0, None), -8)

    def test_a_dict_may_hold_whatever_holds_numbers(self):
        import pandas
        pieces = {'velocity': [1.0, 2.0], 'duration': [0.01, 0.01]}
        rows = stickslip.run({**SHORT, 'drive': pieces}).table
        for kind in (tuple, np.array, pandas.Series, lambda numbers: np.array(numbers, np.float32).astype(object)):
            drive = {'velocity': kind(pieces['velocity']), 'duration': pieces['duration']}
            np.testing.assert_array_equal(stickslip.run({**SHORT, 'drive': drive}).table, rows)
        self.assertEqual(len(stickslip.run({**SHORT, 'drive': {'velocity': np.array(1.0)}}).table), 21)
        self.assertEqual(len(stickslip.run(types.MappingProxyType(SHORT)).table), 21)
        for hidden in (np.ma.masked, np.ma.array([1.0], mask=[True]), np.ma.array([1, 2], mask=[False, True])):
            with self.assertRaisesRegex(stickslip.InputError, '&drive velocity = .*nan: must be finite'):
                stickslip.run({**SHORT, 'drive': {'velocity': hidden, 'duration': pieces['duration'][:np.size(hidden)]}})
        for value, error, words in ((np.timedelta64(3, 's'), TypeError, 'drive.velocity: .* a time'),
                                    ('a\nb', stickslip.InputError, 'drive.velocity = .*: must be text of one line'),
                                    ('a\0b', stickslip.InputError, 'drive.velocity = .*: must be text of one line'),
                                    ('\udcff', stickslip.InputError, 'drive.velocity = .*: must be text of one line')):
            with self.assertRaisesRegex(error, words):
                stickslip.run({**SHORT, 'drive': {'velocity': value}})
        for other in (None, 3, [], b'&drive /'):
            with self.assertRaisesRegex(TypeError, 'input: the name or the text of a namelist, or a dict'):
                stickslip.run(other)
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, 'drive.csv')
            path.write_text('time,velocity\n0,1\n1,1\n')
            self.assertEqual(len(stickslip.run({**SHORT, 'drive': {'file': path}}).table), 21)

    def test_a_dict_that_says_a_thing_twice_is_refused(self):
        for changes, words in (({'Drive': {'velocity': 2.0}}, 'group drive: given twice'),
                               ({'drive': {'velocity': 1.0, 'Velocity': 2.0}}, 'key velocity: given twice')):
            with self.assertRaisesRegex(stickslip.InputError, words):
                stickslip.run({**SHORT, **changes})
        for name in ('', '!', 'velocity = 2 /\n&drive', 'a b', 'velo\0city'):   # what is written would say something else
            for changes in ({'drive': {'velocity': 1.0, name: 2.0}}, {name: {}}):
                with self.assertRaisesRegex(stickslip.InputError, 'must be a name'):
                    stickslip.run({**SHORT, **changes})
        for changes in ({3: {}}, {'drive': {3: 1.0}}):
            with self.assertRaisesRegex(TypeError, '3: a name is needed'):
                stickslip.run({**SHORT, **changes})

    def test_what_was_computed_before_a_failure_is_kept(self):
        unstable = {'friction': stickslip.laws.SlipWeakening(alpha_n=1000, alpha_t=1000, mu_s=0.4, mu_k=0.2, d_c=0.01),
                    'slider': {**SLIDER, 'mass': 0.0, 'damping': 0.0, 'stiffness': 100.0, 'area': 1.0,
                               'normal_traction': 10.0},
                    'drive': {'velocity': 0.1}, 'time': {'t_end': 1.0, 'dt': 1e-3}}
        with self.assertRaisesRegex(stickslip.RunError, 'unstable without inertia') as caught:
            stickslip.run(unstable)
        self.assertGreater(len(caught.exception.run.table), 100)
        again = pickle.loads(pickle.dumps(caught.exception))   # as on its way from another process
        self.assertEqual((str(again), len(again.run.table)), (str(caught.exception), len(caught.exception.run.table)))

    def test_threads_give_what_one_after_another_gives(self):
        """Different inputs at once, faults and failures among them."""
        def work(k):
            settings = {**INPUT, 'drive': {'velocity': 1.0 + k}}
            if k % 5 == 3:
                settings['slider'] = {**SLIDER, 'x' * (k + 1): k}
            try:
                return stickslip.run(settings).table.to_numpy().tobytes()
            except stickslip.InputError as error:
                return str(error)
        alone = [work(k) for k in range(40)]
        with concurrent.futures.ThreadPoolExecutor(8) as pool:
            for _ in range(3):
                self.assertEqual(list(pool.map(work, range(40))), alone)

    def test_null_pointers_and_unknown_names_are_no_crash(self):
        import ctypes

        result, names, rows, columns = ctypes.c_void_p(), ctypes.c_char_p(), ctypes.c_int64(), ctypes.c_int()
        nobody = _program._watch_type()
        self.assertEqual(_program._run(b'x', None, nobody, None, ctypes.byref(result)), -8)
        self.assertIsNone(result.value)
        self.assertEqual(_program._run(b'x', b'', nobody, None, None), -8)
        self.assertEqual(_program._run(b'x', b'', nobody, None, ctypes.byref(result)), _program.BAD_INPUT)
        for table in (b'series', b'nonsense'):
            self.assertIsNone(_program._table(result, table, ctypes.byref(rows), ctypes.byref(columns), ctypes.byref(names)))
            self.assertEqual((rows.value, columns.value), (0, 0))
        self.assertIsNone(_program._report(result, b'nonsense'))
        self.assertIn(b'&slider is missing', _program._report(result, b'faults'))
        _program._free(result)
        _program._free(None)

    def test_an_interrupt_ends_a_run(self):
        from stickslip import _namelist, _program

        def interrupt(part):
            raise KeyboardInterrupt

        with self.assertRaises(KeyboardInterrupt):
            _program.simulate(_namelist.written({**_namelist.groups_of(INPUT), 'time': {'t_end': 1e4, 'dt': 1e-3}}),
                              watch=interrupt)

    def test_ctrl_c_ends_a_run_wherever_it_is(self):
        """In the first moment or later, with fixed and with adaptive steps."""
        program = """import os, signal, sys, threading, time
import stickslip
from stickslip import _namelist
groups = _namelist.groups_of(sys.stdin.read())
signal.signal(signal.SIGINT, signal.default_int_handler)   # it is ignored in what a shell starts in the background
def press(wait):
    while threading.active_count() < 3:   # main, this one, the run
        time.sleep(0.001)
    time.sleep(wait)
    os.kill(os.getpid(), signal.SIGINT)
for steps in ({'dt': 1e-3}, {'rtol': 1e-6}):
    for wait in (0.0, 0.3):
        try:
            presses = threading.Thread(target=press, args=(wait,))
            presses.start()
            stickslip.run({**groups, 'time': {'t_end': 1e5, **steps}})
        except KeyboardInterrupt:
            print('interrupted')
        presses.join()
"""
        result = subprocess.run([sys.executable, '-c', program], input=_namelist.written(_namelist.groups_of(INPUT)), text=True,
                                capture_output=True, check=False, timeout=600)
        self.assertEqual(result.stdout.split(), 4 * ['interrupted'], result.stderr)

    def test_an_interrupt_while_the_run_is_started_ends_it(self):
        class Interrupted(threading.Thread):
            def start(self):
                super().start()
                raise KeyboardInterrupt

        before = threading.active_count()
        with unittest.mock.patch('stickslip._program.threading.Thread', Interrupted), self.assertRaises(KeyboardInterrupt):
            stickslip.run({**INPUT, 'time': {'t_end': 1e5, 'dt': 1e-3}})   # a minute, if it goes on
        end = time.monotonic() + 20.0
        while threading.active_count() > before and time.monotonic() < end:
            time.sleep(0.01)
        self.assertEqual(threading.active_count(), before)

    def test_a_picture_is_drawn(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, 'run.png')
            stickslip.run(INPUT).plot(path)
            self.assertGreater(path.stat().st_size, 10_000)


if __name__ == '__main__':
    unittest.main()
