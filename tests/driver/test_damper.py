"""A damper beside the contact spring (eta_t) with adaptive steps: closed forms, fixed steps, energy, refused input.

STICKSLIP names the program.
"""
import math
import re
import unittest

from test_program import Program
from worst_errors import worst_of

SLIDING = {   # friction beside the springs, and whether the block has a mass
    'coulomb': "law='coulomb', mu=0.4",
    'slip_weakening': "law='slip_weakening', mu_s=0.4, mu_k=0.2, d_c=0.02",
    'slip_weakening_healing': "law='slip_weakening_healing', mu_s=0.4, mu_k=0.2, d_c=0.02, xi=5",
    'rate_and_state': "law='rate_and_state', a=0.01, b=0.015, d_c=0.01, v0=1, f0=0.4",
    'flash_heating': "law='flash_heating', a=0.01, b=0.015, d_c=0.01, v0=1, f0=0.4, f_w=0.1, v_w=5",
    'linker_dieterich': "law='linker_dieterich', a=0.01, b=0.015, d_c=0.01, v0=1, f0=0.4, alpha=0.2",
    'static_kinetic': "law='static_kinetic', mu_s=0.4, mu_k=0.2, d_c=0.02",
    'subloading': "law='subloading', mu_s=0.4, mu_k=0.2, kappa=10, xi=1, m=1000",
    'subloading, cotangent': "law='subloading', mu_s=0.4, mu_k=0.2, kappa=10, xi=1, m=100, u_of_r='cotangent'",
    'subloading, reciprocal': "law='subloading', mu_s=0.4, mu_k=0.2, kappa=10, xi=1, m=100, u_of_r='reciprocal'",
    'subloading, cap, cohesion': "law='subloading', mu_s=0.4, mu_k=0.2, kappa=10, xi=1, m=1000, tau_max=3.2, cohesion=0.3",
}


class Damper(Program):
    def sliding(self, friction, dt=None, mass=1e-3):
        """Pulled, held and pulled back; the table by time, and the energies that the summary tells."""
        time, rows = (f'dt={dt}', f'interval={round(0.01 / dt)}') if dt else ('rtol=1e-8', 'every=0.01')
        result = self.run_text(f"""&friction {friction}, alpha_n=1000, alpha_t=1000, eta_t=0.2 /
            &slider mass={mass}, stiffness=1, damping=0.02, normal_traction=10 /
            &drive velocity=1, 0, -2, duration=5, 0.5, 20, normal=10, 10, 12 /
            &time t_end=7, {time} /
            &output {rows} /""", '--no-plot')
        self.assert_done(result)
        table = {round(float(row['time']), 6): float(row['spring_force']) for row in self.rows('case_out/case.csv')}
        energies = {name: float(value) for name, value in re.findall(r'(dissipated|unbalanced) +(\S+)', result.stdout)}
        return table, energies

    def test_adaptive_steps_are_what_fixed_steps_tend_to(self):
        for name, friction in SLIDING.items():
            with self.subTest(law=name):
                exact, energies = self.sliding(friction)
                self.assertLess(abs(energies['unbalanced']), 1e-7 * energies['dissipated'])
                errors = []
                for dt in (5e-4, 1e-4):
                    fixed, _ = self.sliding(friction, dt)
                    common = fixed.keys() & exact.keys()
                    self.assertGreater(len(common), 600)
                    errors.append(worst_of(abs(fixed[time] - exact[time]) for time in common))
                print(f'\n  {name}: largest error of dt = 5e-4 {errors[0]:.1e}, of a fifth of that {errors[1]:.1e}')
                # first order, or second of Newmark's method
                self.assertGreater(errors[0] / errors[1], 4)
                self.assertLess(errors[1], 0.05)

    def test_without_mass_too(self):
        for name in ('coulomb', 'rate_and_state', 'subloading'):
            with self.subTest(law=name):
                exact, energies = self.sliding(SLIDING[name], mass=0)
                self.assertLess(abs(energies['unbalanced']), 1e-5 * energies['dissipated'])
                fixed, _ = self.sliding(SLIDING[name], 1e-4, mass=0)
                errors = [abs(fixed[time] - exact[time]) for time in fixed.keys() & exact.keys()]
                self.assertLess(sum(errors) / len(errors), 0.01)

    def slow(self, friction, damper, speed):
        """A slow drive beside a stiff damper, in few steps: a run that does not get on fills its table."""
        result = self.run_text(f"""&friction {friction}, alpha_n=1000, alpha_t=1000, eta_t={damper} /
            &slider mass=1e-3, stiffness=1, damping=0.02, normal_traction=10 /
            &drive velocity={speed} /
            &time t_end={8 / speed}, rtol=1e-5 /
            &output table_limit=1e-3 /""", '--no-plot')
        self.assert_done(result)
        rows = self.rows('case_out/case.csv')
        self.assertLess(len(rows), 200)
        return [(float(row['time']), float(row['spring_force'])) for row in rows]

    def test_a_slow_drive_over_a_stiff_damper_keeps_its_closed_form(self):
        spring, contact, strength = 1.0, 1000.0, 4.0
        for speed, damper in ((1e-6, 1e8), (1e-2, 1e3)):
            late = damper / (spring + contact)
            for time, force in self.slow(SLIDING['coulomb'], damper, speed):   # without inertia
                elastic = speed * spring / (spring + contact) * (time - late + late * math.exp(-time / late))
                carried = min(spring * (speed * time - elastic), strength)
                self.assertAlmostEqual(force, carried, delta=1e-5 * strength + 0.04 * speed)

    def test_so_does_creep_that_comes_to_a_shear_cap(self):
        for b in (0.005, 0.03):
            rows = self.slow(f"law='rate_and_state', a=0.01, b={b}, d_c=0.01, v0=1e-6, f0=0.4, tau_max=3.9", 1e8, 1e-6)
            self.assertAlmostEqual(rows[-1][1], 3.9, delta=1e-6)

    def test_slow_slip_under_a_load_that_varies_dissipates_what_the_drive_gives(self):
        # in steps far longer than the block swings: 667 was dissipated of 3.4, or 7.5; on blocks that move across, too, 4.396 of 4.415
        across = ', normal_mass=0.1, normal_stiffness=1, normal_damping=0.1, tilt_stiffness='
        for damper, across in ((0, ''), (0.1, ''), (10, ''), (0.1, across + '-0.5'), (10, across + '-0.5'), (10, across + '0.5')):
            result = self.run_text(f"""&friction {SLIDING['coulomb']}, alpha_n=1000, alpha_t=100, eta_t={damper} /
                &slider mass=0.1, stiffness=1, damping=0.1, normal_traction=1 {across} /
                &drive velocity=3e-8, normal_amplitude=0.4, normal_frequency=2e-8 /
                &time t_end=2.5e8, rtol=1e-5 /""", '--no-plot')
            self.assertEqual((result.returncode, result.stderr), (0, ''))
            energies = {name: float(value) for name, value in re.findall(r'(dissipated|unbalanced) +(\S+)', result.stdout)}
            self.assertLess(abs(energies['unbalanced']), 1e-3 * energies['dissipated'])

    def test_creep_beside_a_stiff_damper_keeps_rtol(self):
        forces = []
        for tolerance in (1e-5, 1e-8):
            result = self.run_text(f"""&friction law='rate_and_state', a=0.01, b=0.015, d_c=0.01, v0=0.01, f0=0.4,
                    alpha_n=1000, alpha_t=1000, eta_t=1e4 /
                &slider mass=1e-3, stiffness=1, damping=0.02, normal_traction=10 /
                &drive velocity=0.01, -0.01, duration=600, 700 /
                &time t_end=1300, rtol={tolerance} /
                &output every=13 /""", '--no-plot')
            self.assert_done(result)
            forces.append([float(row['friction_force']) for row in self.rows('case_out/case.csv')])
        self.assertEqual(len(forces[0]), 101)
        self.assertLess(worst_of(abs(a - b) for a, b in zip(*forces, strict=True)), 5 * 1e-5 * 4)

    def test_a_block_that_sticks_rings_down_as_a_damped_oscillator(self):
        mass, spring, contact, damping, v0 = 1e-3, 1.0, 1000.0, 0.1, 0.1
        result = self.run_text(f"""&friction law='coulomb', alpha_n=1000, alpha_t={contact}, mu=0.4, eta_t={damping} /
            &slider mass={mass}, stiffness={spring}, normal_traction=10 /
            &drive velocity=0 /
            &initial velocity={v0} /
            &time t_end=0.05, rtol=1e-10 /""", '--no-plot')
        self.assert_done(result)
        natural = math.sqrt((spring + contact) / mass)
        ratio = damping / (2 * mass * natural)
        damped = natural * math.sqrt(1 - ratio**2)
        for row in self.rows('case_out/case.csv'):
            t = float(row['time'])
            expected = v0 / damped * math.exp(-ratio * natural * t) * math.sin(damped * t)
            self.assertAlmostEqual(float(row['displacement']), expected, delta=1e-7 * v0 / natural)

    def test_what_cannot_be_is_refused_by_name(self):
        base = {'friction': "law='coulomb', mu=0.3", 'mass': 1e-3, 'damping': 0.1, 'more': '', 'time': 'rtol=1e-6'}
        cases = (({'more': '&chain n_blocks=3, coupling=1 /'}, 'eta_t = 0.2: needs fixed steps (&time dt) in a chain\n'),
                 ({'time': 'rtol=1e-6, beta=0.3'}, 'needs fixed steps (&time dt) beside beta, gamma and rho_infinity'),
                 ({'friction': "law='coulomb', mu=0.3, contact='rigid'"}, 'has no contact spring, and so no damper'),
                 ({'mass': 0, 'damping': 0}, 'needs a mass or a damping'),
                 ({'friction': "law='static_kinetic', mu_s=0.4, mu_k=0.2, d_c=0.1"}, 'must exceed d_c (mu_s - mu_k)'))
        for changes, words in cases:
            with self.subTest(words=words):
                case = {**base, **changes}
                result = self.run_text(f"""&friction {case['friction']}, alpha_n=1000, alpha_t=1000, eta_t=0.2 /
                    &slider mass={case['mass']}, stiffness=1, damping={case['damping']}, normal_traction=10 /
                    &drive velocity=1 /
                    &time t_end=1, {case['time']} / {case['more']}""", verb='check')
                self.assertEqual(result.returncode, 2)
                self.assertIn(words, result.stderr)


if __name__ == '__main__':
    unittest.main()
