"""No choice of units has a say in what happens: results in units that are powers of two of others are the same to the bit.

STICKSLIP names the program.
"""
import re
import unittest

from test_program import Program

# force, length, time
KEYS = {
    'alpha_n': (1, -3, 0), 'alpha_t': (1, -3, 0), 'kappa': (0, -1, 0), 'xi': (0, 0, -1), 'm': (0, -1, 0), 'v0': (0, 1, -1),
    'v_w': (0, 1, -1), 'tau_max': (1, -2, 0), 'cohesion': (1, -2, 0), 'eta_t': (1, -3, 1), 'd_c': (0, 1, 0),
    'mass': (1, -1, 2), 'stiffness': (1, -1, 0), 'damping': (1, -1, 1), 'area': (0, 2, 0), 'normal_traction': (1, -2, 0),
    'normal_mass': (1, -1, 2), 'normal_stiffness': (1, -1, 0), 'normal_damping': (1, -1, 1), 'tilt_stiffness': (1, -1, 0),
    'velocity': (0, 1, -1), 'duration': (0, 0, 1), 'normal': (1, -2, 0), 'normal_amplitude': (1, -2, 0),
    'normal_frequency': (0, 0, -1), 't_end': (0, 0, 1), 'dt': (0, 0, 1), 'coupling': (1, -1, 0)}
COLUMNS = {
    'time': (0, 0, 1), 'drive': (0, 1, 0), 'displacement': (0, 1, 0), 'velocity': (0, 1, -1), 'acceleration': (0, 1, -2),
    'spring_force': (1, 0, 0), 'friction_force': (1, 0, 0), 'mu': (0, 0, 0), 'R': (0, 0, 0), 'D': (0, 1, 0), 'theta': (0, 0, 1),
    'slip': (0, 1, 0), 'normal_traction': (1, -2, 0), 'normal_displacement': (0, 1, 0), 'normal_velocity': (0, 1, -1),
    'onset': (0, 0, 1), 'duration': (0, 0, 1), 'stress_drop': (1, -2, 0), 'peak_velocity': (0, 1, -1),
    'recurrence_time': (0, 0, 1), 'first_block': (0, 0, 0), 'blocks': (0, 0, 0), 'moment': (0, 3, 0), 'ended': (0, 0, 0)}

SUBLOADING = """&friction alpha_n=100, alpha_t=80, mu_s=0.6, mu_k=0.3, kappa=3, xi=0.2, m=40 /
    &slider mass=0.02, stiffness=1.5, damping=0.01, area=1.2, normal_traction=2 /
    &drive velocity=0.3, -0.3, duration=3, 3 /
    """
# its strength falls faster with slip than its contact spring unloads
HEALING = """&friction law='slip_weakening_healing', alpha_n=1.9, alpha_t=14.26, mu_s=0.608, mu_k=0.3, d_c=2.263e-4,
        xi=10, cohesion=0.0229 /
    &slider mass=1.43e-4, stiffness=0.514, area=0.308, normal_traction=0.0352 /
    &drive velocity=-0.102, 0.102, 0.0307, duration=0.25, 0.5, 0.25 /
    &time t_end=1, rtol=4.5e-5 /"""
STATIC_KINETIC = """&friction law='static_kinetic', alpha_n=100, alpha_t=80, mu_s=0.6, mu_k=0.3, tau_max=1.1, d_c=0.8 /
    &slider mass=0.02, stiffness=1.5, damping=0.02, area=1.2, normal_traction=2 /
    &drive velocity=0.3, normal_amplitude=0.5, normal_frequency=0.7 /
    &time t_end=10, rtol=1e-5 /"""
RELOADED = """&friction law='linker_dieterich', alpha_n=0.128, alpha_t=1.15, a=0.00315, b=0.00694, d_c=10.1, v0=3.37, f0=0.68,
        alpha=0.348, cohesion=12.4 /
    &slider mass=0, stiffness=0.969, damping=0.0235, area=1.28, normal_traction=19.6 /
    &drive velocity=0.047, -0.047, 0.142, 0.047, duration=635, 635, 635, 635, normal_amplitude=17.6, normal_frequency=0.0126 /
    &time t_end=2540, rtol=1e-5 /"""


def in_other_units(text, powers, law_with_rate=False):
    """The namelist with units of force, length and time 2**-powers as large."""
    def scaled(match):
        key, values = match.group(1), match.group(2)
        if key not in KEYS:
            return match.group(0)
        dimension = (0, -1, 1) if key == 'd_c' and law_with_rate else KEYS[key]
        factor = 2.0**sum(p * d for p, d in zip(powers, dimension))
        return f'{key} = ' + ', '.join(repr(float(value) * factor) for value in values.split(','))
    return re.sub(r"(\w+) *= *([-+.\de]+(?:, *[-+.\de]+(?![\w=]))*)", scaled, text)


class OtherUnits(Program):
    cases = (
        ({'law': "'coulomb'", 'mu': 0.5, 'cohesion': 0.25}, {'normal_amplitude': 1.25, 'normal_frequency': 0.3}, {'dt': 2e-3}),
        ({'mu_s': 0.6, 'mu_k': 0.4, 'kappa': 10, 'xi': 0.3, 'm': 100}, {}, {'dt': 1e-2}),
        ({'mu_s': 0.6, 'mu_k': 0.4, 'kappa': 10, 'xi': 0.3, 'm': 100, 'tau_max': 0.55, 'eta_t': 0.1}, {}, {'dt': 2e-3}),
        ({'law': "'slip_weakening_healing'", 'mu_s': 0.7, 'mu_k': 0.3, 'd_c': 0.02, 'xi': 0.15}, {}, {'dt': 1e-3}),
        ({'law': "'slip_weakening_healing'", 'mu_s': 0.7, 'mu_k': 0.3, 'd_c': 0.2, 'xi': 0.15},
         {'normal_amplitude': 0.5, 'normal_frequency': 0.3}, {'rtol': 1e-5}),
        # stiff: steps of Rodas4
        ({'mu_s': 0.6, 'mu_k': 0.3, 'kappa': 85, 'xi': 9.2, 'm': 29, 'alpha_t': 134, 'scheme': "'exact_rate'"}, {'velocity': 0.01},
         {'t_end': 44, 'rtol': 7e-5}, {'mass': 2e-4, 'stiffness': 1.1, 'damping': 5e-3, 'normal_traction': 0.2}))

    def tables(self, text):
        self.assert_done(self.run_text(text, '--no-plot'))
        return {name: self.rows(f'case_out/{name}') for name in ('case.csv', 'case_events.csv')}

    def compare(self, text, powers, law_with_rate=False, part=0.0):
        """Series and events in both units; how many rows the series has."""
        usual, others = (self.tables(t) for t in (text, in_other_units(text, powers, law_with_rate)))
        for name, rows in usual.items():
            self.assertEqual(len(rows), len(others[name]), name)
            for column in usual[name][0] if rows else ():
                factor = 2.0**sum(p * d for p, d in zip(powers, COLUMNS[column]))
                values = [float(row[column]) for row in rows]
                allowed = part * max((abs(value) for value in values if value == value), default=0.0)
                for value, row in zip(values, others[name]):
                    other = float(row[column]) / factor
                    self.assertTrue(abs(value - other) <= allowed or value != value and other != other, (name, column, value, row))
        return len(usual['case.csv'])

    def test_fixed_and_adaptive_steps(self):
        for friction, drive, steps, *slider in self.cases:
            groups = {'friction': {'alpha_n': 50, 'alpha_t': 300, **friction},
                      'slider': {'mass': 0.01, 'stiffness': 1, 'damping': 0.02, 'area': 1, 'normal_traction': 1,
                                 **(slider[0] if slider else {})},
                      'drive': {'velocity': 0.3, **drive}, 'time': {'t_end': 8, **steps}}
            text = ''.join(f'&{group} ' + ', '.join(f'{key} = {value}' for key, value in keys.items()) + ' /\n'
                           for group, keys in groups.items())
            with self.subTest(friction=friction):
                for powers in ((11, -7, 5), (-20, 24, -17)):
                    self.assertGreater(self.compare(text, powers), 500)

    def test_adaptive_steps(self):
        for powers in ((24, 0, 0), (0, -20, 0), (0, 0, 16), (-12, 8, -20)):
            self.compare(SUBLOADING + '&time t_end=6, rtol=1e-5 /', powers)
            self.compare(HEALING, powers)
            self.compare(STATIC_KINETIC, powers, law_with_rate=True)

    def test_fixed_steps_chains_and_two_ways_to_move(self):
        for powers in ((24, -16, 12), (-12, 20, 8)):
            self.compare(SUBLOADING + '&time t_end=6, dt=0.002 /', powers)
            # R of several points at once is the same to round-off
            self.compare(SUBLOADING + '&time t_end=6, dt=0.002 / &chain n_blocks=20, coupling=3, scatter=0.2 /', powers,
                         part=1e-9)
            self.compare(SUBLOADING + '&time t_end=6, rtol=1e-4 / &chain n_blocks=5, coupling=3, scatter=0.2 /', powers,
                         part=1e-9)
            two_ways = SUBLOADING.replace('&slider', '&slider normal_mass=0.03, normal_stiffness=2, tilt_stiffness=0.4,')
            self.compare(two_ways + '&time t_end=6, dt=0.002 /', powers)

    def test_events_beside_a_large_cohesion(self):
        # the logarithm of theta is not the same to the bit
        counts = [len(self.tables(text)['case_events.csv']) for text in
                  (RELOADED, in_other_units(RELOADED, (-4, -28, 0)), in_other_units(RELOADED, (32, 0, 0)))]
        self.assertEqual(counts, [8, 8, 8])

    def test_stability_of_steady_sliding(self):
        # states of an eigenvector far apart in size were taken for two eigenvectors that have met: neither stable nor unstable
        case = """&friction law='rate_and_state', alpha_n=6900, alpha_t=43500, a=0.0207, b=0.0303, d_c=1.31e-5, v0=1.75e-3, f0=0.403 /
            &slider mass=5.8e-7, stiffness=281, area=1.21, normal_traction=0.431 /
            &drive velocity=5.1e-4 /
            &time t_end=10, dt=0.01 /"""
        stiffness = (0.0303 - 0.0207) * 0.431 * 1.21 / 1.31e-5   # of both springs, at which it is critical without inertia
        stiffness = 1 / (1 / stiffness - 1 / (43500 * 1.21))
        for powers in ((0, 0, 0), (20, 32, 0), (-30, 10, 0), (0, 12, 20), (0, -20, -20)):
            result = self.run_text(in_other_units(case, powers), '--no-plot', verb='stability')
            self.assertEqual((result.returncode, result.stderr), (0, ''))
            row = self.rows('case_out/case_stability.csv')[0]
            self.assertEqual(row['stability'], 'unstable', powers)
            found = float(row['critical_stiffness']) / 2.0**(powers[0] - powers[1])
            self.assertAlmostEqual(found / stiffness, 1, delta=1e-5)

    def test_a_rigid_contact_begins_to_creep_with_the_first_step(self):
        # its slip rate grows from 0 through all decades; steps of 1e-144 and on told nothing of it
        rows = self.tables("""&friction law='rate_and_state', alpha_n=1, alpha_t=1, a=0.05, b=0.06, d_c=0.006, v0=0.0025, f0=0.6,
                contact='rigid' /
            &slider mass=100, stiffness=28, damping=0.2, area=7, normal_traction=8.6 /
            &drive velocity=0.011 /
            &time t_end=100, rtol=1e-5 /""")['case.csv']
        self.assertAlmostEqual(float(rows[1]['time']), 1e-4, delta=1e-12)   # a millionth of t_end
        self.assertLess(len(rows), 300)


if __name__ == '__main__':
    unittest.main()
