"""stickslip.stability: what the program tells of steady sliding, in this process."""
import unittest

import numpy as np

import stickslip

LAW = stickslip.laws.Subloading(alpha_n=1.0, alpha_t=1.0, mu_s=0.4, mu_k=0.2, kappa=10.0, xi=10.0, m=1000.0)
INPUT = {'friction': LAW, 'slider': {'mass': 1e-3, 'stiffness': 1.0, 'damping': 0.01, 'area': 1000.0, 'normal_traction': 0.01},
         'drive': {'velocity': [1.0, 0.0, 20.0], 'duration': [1.0, 1.0, 1.0]}, 'time': {'t_end': 3.0, 'dt': 1e-3}}


class Stability(unittest.TestCase):
    def test_rows_and_eigenvalues_of_moving_pieces(self):
        found = stickslip.stability(INPUT)
        self.assertEqual(list(found.table['piece']), [1, 3])
        self.assertEqual(list(found.table['stability']), ['unstable', 'stable'])
        for row, roots in enumerate(found.eigenvalues):
            self.assertEqual(len(roots), 4)
            self.assertEqual(roots[0].real, found.table['growth_rate'][row])
        # theory.md, section 6: where A = C c + (C K/b)/(M b c + C)
        velocity = found.table['critical_velocity'][0]
        c = 10 * velocity + 10
        weakening = 10 * 10 * 0.2 * 10 / c
        b = 1000 / (1000 - weakening)
        np.testing.assert_allclose(weakening, 0.01 * c + 0.01 / b / (1e-3 * b * c + 0.01), rtol=1e-10)

    def test_no_steady_sliding_has_its_reason(self):
        found = stickslip.stability({**INPUT, 'drive': {'velocity': 0.0}})
        self.assertEqual(list(found.table['stability']), ['none'])
        self.assertEqual(list(found.table['reason']), ['the drive stands still'])
        self.assertTrue(np.isnan(found.table['growth_rate'][0]))
        self.assertEqual(len(found.eigenvalues[0]), 0)

    def test_faults_are_listed(self):
        with self.assertRaisesRegex(stickslip.InputError, '&slider stiffness = -1'):
            stickslip.stability({**INPUT, 'slider': {**INPUT['slider'], 'stiffness': -1.0}})


if __name__ == '__main__':
    unittest.main()
