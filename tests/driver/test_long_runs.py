"""Runs that stop before their end, and go on: checkpoints, --resume, interrupts; and --verify."""
import itertools
import os
import random
import re
import shutil
import signal
import subprocess
import time
import unittest

from strict_build import release_only
from test_program import PROGRAM, Program, namelist

FIXED = namelist({('time', 't_end'): '40', ('time', 'dt'): '2e-4', ('output', 'interval'): '10',
                  ('output', 'checkpoint'): '0.02'})
ADAPTIVE = namelist({('time', 't_end'): '400', ('time', 'rtol'): '1e-7', ('output', 'interval'): '3',
                     ('drive', 'velocity'): '1, 0.5, 2', ('drive', 'duration'): '31.7, 20, 100',
                     ('drive', 'normal_amplitude'): '1', ('drive', 'normal_frequency'): '0.3',
                     ('output', 'checkpoint'): '0.02'}, [('time', 'dt')])


class LongRun(Program):
    def start(self, *arguments):
        return subprocess.Popen([PROGRAM, 'run', 'case.nml', '--no-plot', *arguments], cwd=self.folder,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def wait_for(self, name, size=1):
        for _ in range(1000):
            file = self.folder / name
            if file.exists() and file.stat().st_size >= size:
                return
            time.sleep(0.01)
        self.fail(f'{name} does not come')

    def let_it_write(self, name, size, process):
        """Waits until a file has grown by so many bytes, or the process has ended. Not by time: the machine may
        be busier or less than before."""
        file = self.folder / name
        size += file.stat().st_size if file.exists() else 0
        while process.poll() is None and not (file.exists() and file.stat().st_size >= size):
            time.sleep(0.002)

    def results(self, folder):
        return [(self.folder / folder / name).read_bytes() for name in ('case.csv', 'case_events.csv')]

    def whole_run(self, text):
        (self.folder / 'case.nml').write_text(text)
        process = self.start('--output', 'whole')
        summary = process.communicate(timeout=120)[0]
        self.assertEqual(process.returncode, 0)
        return summary

    def stop_and_go(self, text, stop, times):
        """Stopped at random moments and resumed each time, a run leaves what an undisturbed one does."""
        shutil.rmtree(self.folder / 'parts', ignore_errors=True)
        summary = self.whole_run(text)
        whole = self.results('whole')[0]
        chance = random.Random(20)
        stopped = 0
        arguments = ['--output', 'parts']
        for _ in range(times):
            process = self.start(*arguments)
            self.let_it_write('parts/case.csv', chance.uniform(0.1, 0.4) * len(whole), process)
            process.send_signal(stop)
            process.communicate(timeout=120)
            stopped += process.returncode != 0
            if process.returncode == 0:
                break
            if (self.folder / 'parts/case.checkpoint').exists():
                arguments = ['--output', 'parts', '--resume']
        self.assertGreater(stopped, 0)
        if process.returncode != 0:
            process = self.start(*arguments)
            resumed, errors = process.communicate(timeout=120)
            self.assertEqual((process.returncode, errors), (0, ''))
            self.assertEqual(resumed.replace('parts/', 'whole/'), summary)
        self.assertEqual(self.results('parts'), self.results('whole'))
        self.assertFalse((self.folder / 'parts/case.checkpoint').exists())


class StopAndGo(LongRun):
    def test_killed_fixed_steps_resume_to_the_same_bytes(self):
        self.stop_and_go(FIXED, signal.SIGKILL, 5)

    @release_only
    def test_killed_adaptive_steps_resume_to_the_same_bytes(self):
        self.stop_and_go(ADAPTIVE, signal.SIGKILL, 5)

    @release_only
    def test_interrupted_steps_resume_to_the_same_bytes(self):
        self.stop_and_go(ADAPTIVE, signal.SIGINT, 3)

    def test_steps_by_their_error_need_nothing_but_the_state_under_every_law(self):
        # cut where the tables have a part of their size, a run goes on to the same bytes; it did not once D had been beyond d_c
        creep = 'a=0.012, b=0.01, d_c=0.05, v0=1, f0=0.5'
        weakening = 'mu_s=0.6, mu_k=0.3'
        laws = (f"'subloading', {weakening}, kappa=10, xi=1, m=100", "'coulomb', mu=0.5", f"'static_kinetic', {weakening}, d_c=0.2",
                f"'slip_weakening', {weakening}, d_c=0.1", f"'slip_weakening_healing', {weakening}, d_c=0.05, xi=7, tau_max=0.25",
                f"'rate_and_state', {creep}", f"'flash_heating', {creep}, f_w=0.2, v_w=2", f"'linker_dieterich', {creep}, alpha=0.005")
        for law, mass, load in itertools.product(laws, (0, 1e-2), ('', ', normal_amplitude=0.4, normal_frequency=0.7')):
            text = f"""&friction law={law}, alpha_n=100, alpha_t=30 /
                &slider mass={mass}, stiffness=1, damping=0.1, normal_traction=1 /
                &drive velocity=1, -0.5, 0, 1, duration=1.5, 1, 2, 1, normal=1, 0.7, 0.7, 1 {load} /
                &time t_end=5.5, rtol=1e-5 / &output table_limit=10 /"""
            with self.subTest(law=law, mass=mass, load=load):
                self.whole_run(text)
                size = sum(file.stat().st_size for file in (self.folder / 'whole').glob('*.csv'))
                for part in (0.3, 0.5, 0.7, 0.9):
                    shutil.rmtree(self.folder / 'parts', ignore_errors=True)
                    (self.folder / 'case.nml').write_text(text.replace('table_limit=10', f'table_limit={part * size * 1e-9}'))
                    self.assertEqual(self.run_program('run', 'case.nml', '--no-plot', '--output', 'parts').returncode, 1)
                    (self.folder / 'case.nml').write_text(text)
                    result = self.run_program('run', 'case.nml', '--no-plot', '--output', 'parts', '--resume')
                    self.assertEqual(result.returncode, 0, result.stderr)
                    self.assertTrue(self.results('parts') == self.results('whole'), part)

    def test_an_interrupt_says_so_and_leaves_whole_rows_and_a_checkpoint(self):
        (self.folder / 'case.nml').write_text(FIXED.replace('0.02\n', '1e9\n').replace("t_end = 40", "t_end = 4e4"))
        process = self.start()
        self.wait_for('case_out/case.csv', 10000)
        process.send_signal(signal.SIGINT)
        errors = process.communicate(timeout=120)[1]
        self.assertEqual(process.returncode, 1)
        self.assertIn('interrupted; stickslip run with --resume', errors)
        self.assertTrue((self.folder / 'case_out/case.checkpoint').exists())
        lines = (self.folder / 'case_out/case.csv').read_text().splitlines()
        self.assertEqual({len(line.split(',')) for line in lines}, {11})
        self.assertRegex(errors, re.escape(f"{float(lines[-1].split(',')[0]):.6E}"), 'the last row is the last state')

    def test_an_interrupted_run_draws_no_picture(self):
        (self.folder / 'case.nml').write_text(FIXED.replace('t_end = 40', 't_end = 4e4'))
        process = subprocess.Popen([PROGRAM, 'run', 'case.nml'], cwd=self.folder, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, text=True)
        self.wait_for('case_out/case.csv', 10000)
        process.send_signal(signal.SIGTERM)
        process.communicate(timeout=60)
        self.assertEqual(process.returncode, 1)
        self.assertFalse((self.folder / 'case_out/case.gp').exists())

    def slow_gnuplot(self):
        """A gnuplot that never ends; tells its process number."""
        tool = self.folder / 'tools/gnuplot'
        tool.parent.mkdir()
        tool.write_text('#!/bin/sh\necho >case.png\necho $$ >../started\nexec sleep 1000\n')
        tool.chmod(0o755)
        (self.folder / 'case.nml').write_text(namelist({('time', 't_end'): '0.1'}))
        return subprocess.Popen([PROGRAM, 'run', 'case.nml'], cwd=self.folder, stdout=subprocess.PIPE,
                                stderr=subprocess.PIPE, text=True,
                                env={**os.environ, 'PATH': f"{tool.parent}:{os.environ['PATH']}"})

    def test_a_signal_ends_gnuplot_and_the_program_with_it(self):
        process = self.slow_gnuplot()
        self.wait_for('started', 2)
        process.send_signal(signal.SIGTERM)
        errors = process.communicate(timeout=20)[1]
        self.assertEqual(process.returncode, 0)   # the run is done, its picture is not
        self.assertIn('gnuplot was stopped', errors)
        self.assertFalse((self.folder / 'case_out/case.png').exists())   # it is not whole
        with self.assertRaises(ProcessLookupError):
            os.kill(int((self.folder / 'started').read_text()), 0)

    def test_a_second_signal_ends_at_once(self):
        (self.folder / 'case.nml').write_text(FIXED.replace('t_end = 40', 't_end = 4e4'))
        process = self.start()
        self.wait_for('case_out/case.csv', 100)
        process.send_signal(signal.SIGSTOP)   # both signals wait until it goes on
        os.waitpid(process.pid, os.WUNTRACED)
        process.send_signal(signal.SIGTERM)
        process.send_signal(signal.SIGINT)
        process.send_signal(signal.SIGCONT)
        process.communicate(timeout=20)
        self.assertIn(process.returncode, (128 + signal.SIGTERM, 128 + signal.SIGINT))

    def test_resuming_what_cannot_be_resumed_is_refused(self):
        text = FIXED.replace('t_end = 40', 't_end = 4e4')
        (self.folder / 'case.nml').write_text(text)
        result = self.run_program('run', 'case.nml', '--resume')
        self.assertEqual(result.returncode, 2)
        self.assertIn('there is no checkpoint', result.stderr)
        process = self.start()
        self.wait_for('case_out/case.checkpoint')
        process.kill()
        process.communicate()
        kept = (self.folder / 'case_out/case.checkpoint').read_bytes()
        rows = (self.folder / 'case_out/case.csv').read_bytes()
        for change, said in ((text.replace('kappa = 10', 'kappa = 11'), 'the input is not the one'),
                             (text, 'is damaged')):
            (self.folder / 'case.nml').write_text(change)
            if change == text:
                (self.folder / 'case_out/case.checkpoint').write_bytes(kept[:-10])
            result = self.run_program('run', 'case.nml', '--resume')
            self.assertEqual(result.returncode, 2)
            self.assertIn(said, result.stderr)
            self.assertEqual((self.folder / 'case_out/case.csv').read_bytes(), rows)

    def test_a_checkpoint_with_one_flipped_bit_is_refused(self):
        (self.folder / 'case.nml').write_text(FIXED.replace('t_end = 40', 't_end = 4e4'))
        process = self.start()
        self.wait_for('case_out/case.checkpoint')
        process.kill()
        process.communicate()
        checkpoint = self.folder / 'case_out/case.checkpoint'
        kept = checkpoint.read_bytes()
        rows = (self.folder / 'case_out/case.csv').read_bytes()
        for bit in range(3, 8 * len(kept), 8 * len(kept) // 97):   # places all over the file
            damaged = bytearray(kept)
            damaged[bit // 8] ^= 1 << bit % 8
            checkpoint.write_bytes(damaged)
            result = self.run_program('run', 'case.nml', '--resume', '--no-plot')
            self.assertEqual(result.returncode, 2, bit)
            self.assertIn('is no checkpoint of this version' if bit < 64 else 'is damaged', result.stderr)
        self.assertEqual((self.folder / 'case_out/case.csv').read_bytes(), rows)

    def test_bad_checkpoint_interval(self):
        self.refused(namelist({('output', 'checkpoint'): '-1'}), '&output checkpoint = -1: must be >= 0')


class Verify(Program):
    def test_verify_says_that_there_are_no_events(self):
        result = self.run_text(namelist(), '--no-plot', '--verify')
        self.assertIn('no events to compare', result.stdout)

    def test_verify_tells_the_error_of_event_times(self):
        truth = 3.987831136299   # an explicit Runge-Kutta 5(4) solution at rtol 1e-11
        for change in ({('time', 'dt'): '1e-3'}, {('time', 'rtol'): '1e-5'}):
            result = self.run_text(namelist({('time', 't_end'): '6', **change}), '--no-plot', '--verify')
            self.assertEqual((result.returncode, result.stderr), (0, ''))
            said = float(result.stdout.split('largest')[1].split(',')[0])
            onset = float(self.rows('case_out/case_events.csv')[0]['onset'])
            self.assertLess(abs(onset - truth), 10 * said)
            self.assertGreater(abs(onset - truth), 0.1 * said)


if __name__ == '__main__':
    unittest.main()
