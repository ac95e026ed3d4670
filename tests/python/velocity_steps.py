"""Velocity steps whose constants are known, for the tests of stickslip.fit_rate_and_state."""
import unittest

import numpy as np


class VelocitySteps(unittest.TestCase):
    TIME, CHANGES, VELOCITY = np.arange(0.0, 130.0, 0.1), np.array([40.0, 80.0]), np.array([3.0, 10.0, 3.0])
    TRUE = {'a': 0.01, 'b': 0.014, 'd_c': 5.0, 'stiffness': 0.02}

    def independent(self, t, changes, velocity, evolution='ageing', true=None):
        """Friction by scipy's solver: d(friction)/dt = k (v - V), friction = f0 + a ln(V/v0) + b ln(theta v0/d_c)."""
        from scipy.integrate import solve_ivp
        a, b, d_c, stiffness = (true or self.TRUE).values()
        found, state = np.empty_like(t), [0.6, np.log(d_c / velocity[0])]
        for begin, end, drive in zip([t[0], *changes], [*changes, t[-1]], velocity):
            def rates(_, y, drive=drive):
                slip = velocity[0] * np.exp((y[0] - 0.6 - b * (y[1] - np.log(d_c / velocity[0]))) / a)
                steady = slip * np.exp(y[1]) / d_c
                return [stiffness * (drive - slip),
                        np.exp(-y[1]) * (1 - steady if evolution == 'ageing' else -steady * np.log(steady))]
            inner = (t >= begin) & (t <= end)
            run = solve_ivp(rates, (begin, end), state, method='LSODA', rtol=1e-9, atol=1e-11, dense_output=True)
            found[inner], state = run.sol(t[inner])[0], run.y[:, -1]
        return found
