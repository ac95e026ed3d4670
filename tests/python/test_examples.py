"""The Python examples run, and say what is right."""
import importlib.util
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

EXAMPLES = pathlib.Path(__file__).resolve().parents[2] / 'examples/python'


class Examples(unittest.TestCase):
    def run_example(self, name):
        """Its output; it must leave a picture."""
        with tempfile.TemporaryDirectory() as folder:
            result = subprocess.run([sys.executable, EXAMPLES / f'{name}.py'], cwd=folder, text=True, capture_output=True,
                                    check=False)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertGreater(pathlib.Path(folder, f'{name}.png').stat().st_size, 10_000)
        return result.stdout

    def number(self, pattern, text):
        return float(re.search(pattern + r' (-?[\d.]+)', text).group(1))

    def test_hysteresis(self):
        output = self.run_example('hysteresis')
        shear = self.number('largest shear', output)
        self.assertTrue(0.25 * 10 < shear < 0.45 * 10, output)   # mu_k p to mu_s p

    def test_velocity_steps_and_holds(self):
        """The steady change is that of the law; healing grows by b ln(t) but for slip during the hold."""
        output = self.run_example('velocity_steps_and_holds')
        self.assertAlmostEqual(self.number('a - b =', output), -0.004, delta=4e-5)
        self.assertAlmostEqual(self.number('healing:', output), 0.014, delta=0.002)

    @unittest.skipUnless(importlib.util.find_spec('jax'), 'jax is not installed')
    def test_jax_traction(self):
        """1e-6: what central differences with a step of 1e-7 leave."""
        result = subprocess.run([sys.executable, EXAMPLES / 'jax_traction.py'], text=True, capture_output=True, check=False)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertLess(float(result.stdout.split()[-1]), 1e-6)


if __name__ == '__main__':
    unittest.main()
