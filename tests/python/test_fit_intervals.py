"""stickslip.fit_rate_and_state: are its intervals as wide as errors are?"""
import unittest

import numpy as np
from velocity_steps import VelocitySteps

import stickslip


class Intervals(VelocitySteps):
    def test_intervals_hold_the_constants_as_often_as_they_say(self):
        """Of 5 records with noise of each kind: white, and lasting from sample to sample; of 40, and more kinds: bench/rate_state_errors.py."""
        clean = self.independent(self.TIME, self.CHANGES, self.VELOCITY)
        for part in (0.0, 0.9):
            off = []
            for seed in range(5):
                white = np.random.default_rng(seed).normal(size=self.TIME.size + 100)
                noise = np.convolve(white, part**np.arange(101.0) * np.sqrt(1.0 - part**2), 'valid')
                found = stickslip.fit_rate_and_state(self.TIME, clean + 2e-4 * noise, changes=self.CHANGES, velocity=self.VELOCITY,
                                                     starts=16)
                off += [np.log(found.values[name] / true) / np.log(np.divide(*found.intervals[name][::-1])) * 2 * 1.96
                        for name, true in self.TRUE.items()]
            self.assertLess(np.sqrt(np.mean(np.square(off))), 1.4, part)
            self.assertGreater(np.sqrt(np.mean(np.square(off))), 0.6, part)
        slow = np.convolve(np.random.default_rng(2).normal(size=self.TIME.size + 999), 0.99**np.arange(1000.0), 'valid')
        found = stickslip.fit_rate_and_state(self.TIME, clean + 3e-5 * slow, changes=self.CHANGES, velocity=self.VELOCITY, starts=16)
        self.assertRegex('\n'.join(found.warnings), 'the residuals are correlated over .* may be twice those given')

    def test_intervals_of_what_a_record_does_not_tell_are_open(self):
        """A rig that is too stiff for its stiffness to show, a record too coarse for d_c, a state that evolves over more than the
        record slips: bounds that are too near, and slopes in valleys that are flat to one side, gave other constants wrongly, up
        to 25 standard deviations."""
        coarse = np.arange(0.0, 130.0, 2.0)
        for t, true, undetermined in ((self.TIME, {**self.TRUE, 'stiffness': 5.0}, {'stiffness'}), (coarse, self.TRUE, {'a', 'b'}),
                                      (self.TIME, {**self.TRUE, 'd_c': 300.0}, set())):
            clean = self.independent(t, self.CHANGES, self.VELOCITY, true=true)
            for seed in range(2):
                noisy = clean + 2e-4 * np.random.default_rng(seed).normal(size=t.size)
                found = stickslip.fit_rate_and_state(t, noisy, changes=self.CHANGES, velocity=self.VELOCITY, starts=16,
                                                     changes_error=0)
                self.assertLessEqual(undetermined, set(found.undetermined), found)
                for name, value in true.items():
                    low, high = found.intervals[name]
                    self.assertGreater(value, low * (low / found.values[name])**0.3, f'{name}: {found}')
                    self.assertLess(value, high * (high / found.values[name])**0.3, f'{name}: {found}')
                if 'stiffness' in undetermined:
                    self.assertEqual(found.intervals['stiffness'][1], np.inf)
                    self.assertLess(found.intervals['a'][1], 1.2 * true['a'])   # which it tells


if __name__ == '__main__':
    unittest.main()
