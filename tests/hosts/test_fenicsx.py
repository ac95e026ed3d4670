"""FEniCSx with the package stickslip: the block of examples/fenicsx, on one process and on two; the routine as an external operator."""
import importlib.util
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

EXAMPLES = pathlib.Path(__file__).resolve().parents[2] / 'examples/fenicsx'
STEPS = 15
# Of Open MPI: root may start it, on fewer cores than processes, which then make room for one another.
ENVIRONMENT = {**os.environ, 'OMP_NUM_THREADS': '1', 'OMPI_ALLOW_RUN_AS_ROOT': '1', 'OMPI_ALLOW_RUN_AS_ROOT_CONFIRM': '1',
               'OMPI_MCA_rmaps_base_oversubscribe': '1', 'OMPI_MCA_mpi_yield_when_idle': '1'}
MPIRUN = pathlib.Path(sys.prefix, 'bin/mpiexec')   # of the same kind as the wheel's


def run(*command):
    """Standard output of a command in an empty folder, and the names of the files that it leaves."""
    with tempfile.TemporaryDirectory() as folder:
        result = subprocess.run(list(map(str, command)), cwd=folder, env=ENVIRONMENT, text=True, capture_output=True, check=False)
        if result.returncode != 0:
            raise AssertionError(result.stdout + result.stderr)
        return result.stdout, {path.name: path.stat().st_size for path in pathlib.Path(folder).iterdir()}


def numbers(text):
    """All numbers of each line."""
    return [[float(word) for word in re.findall(r'-?\d[\d.]*(?:e[+-]?\d+)?', line)] for line in text.splitlines()]


@unittest.skipUnless(importlib.util.find_spec('dolfinx'), 'dolfinx is not installed: ./dev fenicsx installs it')
class Block(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.output, _ = run(sys.executable, EXAMPLES / 'block_on_base.py', STEPS)
        cls.rows = numbers(cls.output)

    def test_the_front_runs_from_the_pushed_end_to_the_other(self):
        """Before it is through, the push grows above what sliding takes; then it falls to mu_k p L, but for the healing while
        it slides. Newton's iterations converge as with an exact tangent."""
        *steps, (left, right, most) = self.rows
        self.assertEqual(len(steps), STEPS)
        pushes, slipped = [row[1] for row in steps], [row[2] for row in steps]
        self.assertEqual(slipped, sorted(slipped))
        self.assertTrue(0 < slipped[0] < slipped[5] < 100 == slipped[-1], slipped)
        self.assertTrue(40 < pushes[-1] < 40.5, pushes)
        self.assertGreater(max(pushes), 43)
        self.assertGreater(left, right)
        self.assertLessEqual(most, 8)

    def test_two_processes_give_what_one_gives(self):
        """To the digits that are printed: sums of forces differ by round-off."""
        mpirun = MPIRUN if MPIRUN.exists() else shutil.which('mpirun')
        self.assertTrue(mpirun, 'no mpirun')
        shared = numbers(run(mpirun, '-n', 2, sys.executable, EXAMPLES / 'block_on_base.py', STEPS)[0])
        self.assertEqual(len(shared), len(self.rows))
        for one, two in zip(self.rows, shared):
            self.assertEqual(len(one), len(two))
            for a, b in zip(one, two):
                self.assertLess(abs(a - b), 1e-9 * abs(a) + 1e-12, (one, two))

    def test_the_picture_is_drawn(self):
        _, files = run(sys.executable, EXAMPLES / 'block_on_base.py')
        self.assertGreater(files['block_on_base.png'], 10_000)


@unittest.skipUnless(importlib.util.find_spec('dolfinx_external_operator'), 'dolfinx-external-operator is not installed')
class ExternalOperator(unittest.TestCase):
    def test_the_assembled_derivative_is_that_of_the_assembled_forces(self):
        """1e-6: what central differences with a step of 1e-8 leave of a traction of 10 and a stiffness of 1000."""
        output, _ = run(sys.executable, EXAMPLES / 'external_operator.py')
        self.assertLess(float(output.split()[-1]), 1e-6)


if __name__ == '__main__':
    unittest.main()
