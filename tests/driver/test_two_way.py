"""A block that moves along and across the interface: motion against closed forms, stability against characteristic
polynomials and the flutter boundary of the minimal model of mode coupling (Hoffmann et al. 2002).

STICKSLIP names the program.
"""
import cmath
import itertools
import math
import unittest
from fractions import Fraction

from test_program import INPUTS, Program
from test_stability import Stability, exact, product, total
from worst_errors import worst_of

K, K_N, TILT, K_3 = 23.25, 7.75, 3.897114317029974, 11.0
FRICTION = {'law': "'coulomb'", 'alpha_n': '11', 'alpha_t': '1e4', 'mu': '0.5'}
SLIDER = {'mass': '1', 'stiffness': repr(K), 'normal_traction': '10', 'normal_mass': '1', 'normal_stiffness': repr(K_N),
          'tilt_stiffness': repr(TILT)}


def flutter(tilt=TILT, stiffness=K):
    """The friction coefficient at which both frequencies meet."""
    return ((stiffness - K_N - K_3)**2 / (4 * tilt) + tilt) / K_3


def two_way(friction=(), slider=(), **groups):
    """The minimal model with keys changed, as a namelist."""
    given = {'friction': {**FRICTION, **dict(friction)}, 'slider': {**SLIDER, **dict(slider)}, 'drive': {'velocity': '2'},
             'time': {'t_end': '1', 'dt': '1e-3'}}
    for group, keys in groups.items():
        given[group] = {**given.get(group, {}), **keys}
    return ''.join(f'&{group}\n' + ''.join(f'  {key} = {value}\n' for key, value in keys.items() if value is not None) + '/\n'
                   for group, keys in given.items())


def steady(mu, velocity=2.0, damping=0.0):
    """Pressure and stretch of the drive spring in steady sliding under 10, by the balance in both directions."""
    # K e = mu p + C V + t u, u = (10 - p)/11;  t e - K_n u - 10 + p = 0
    slope = TILT * (mu - TILT / K_3) / K + K_N / K_3 + 1
    constant = TILT * (damping * velocity + TILT * 10 / K_3) / K - K_N * 10 / K_3 - 10
    pressure = -constant / slope
    return pressure, (mu * pressure + damping * velocity + TILT * (10 - pressure) / K_3) / K


class Motion(Program):
    def series(self, text):
        result = self.run_text(text, '--no-plot')
        self.assert_done(result)
        rows = self.rows('case_out/case.csv')
        return [{key: float(value) for key, value in row.items()} for row in rows]

    def sliding(self, mu, **time):
        """Sliding from the start, next to steady sliding: as fast as the drive, under the traction of rest."""
        _, stretch = steady(mu, 20.0)
        return two_way({'mu': repr(mu)}, drive={'velocity': '20'}, time={'t_end': '8', 'dt': None, **time},
                       initial={'mu': repr(mu), 'velocity': '20', 'spring_force': repr(K * stretch)})

    def test_where_the_block_is_does_not_matter(self):
        there = [self.series(two_way(time={'t_end': '0.5', 'dt': '2e-5'}, initial={'displacement': str(place)})) for place in (0, 2**22)]
        for key in ('velocity', 'normal_traction'):
            largest = max(abs(row[key] - there[0][0][key]) for row in there[0])
            apart = worst_of(abs(a[key] - b[key]) for a, b in zip(*there, strict=True))
            self.assertGreater(largest, 0.1)
            self.assertLess(apart, 2e-7 * largest)

    @staticmethod
    def modes(mu, t):
        """Distance across from steady sliding: the solution of the linear equations in both directions."""
        pressure, stretch = steady(mu, 20.0)
        along, across = 0.0, (pressure - 10) / K_3   # disturbances at the start: the block stands where it rests
        square, mean = cmath.sqrt((K - K_N - K_3)**2 + 4 * TILT * (TILT - mu * K_3)), (K + K_N + K_3) / 2
        omega_2 = [mean + square / 2, mean - square / 2]
        shape = [(w - K_N - K_3) / TILT for w in omega_2]   # along over across
        part = (along - shape[1] * across) / (shape[0] - shape[1])
        return (part * cmath.cos(cmath.sqrt(omega_2[0]) * t) + (across - part) * cmath.cos(cmath.sqrt(omega_2[1]) * t)).real

    def error(self, mu, **time):
        """Part of the largest disturbance."""
        pressure, _ = steady(mu, 20.0)
        return worst_of(abs(row['normal_displacement'] + pressure / K_3 - self.modes(mu, row['time']))
                        for row in self.series(self.sliding(mu, **time))) / max(abs(self.modes(mu, 0.01 * k)) for k in range(800))

    def test_disturbances_grow_and_swing_as_the_linear_equations_say(self):
        """Below the flutter boundary and above it, where they grow by 2.6 meanwhile. Newmark's swing takes (omega dt)^2/12 longer."""
        for mu in (0.3, 0.5):
            errors = [self.error(mu, dt=dt) for dt in ('0.02', '0.01')]
            self.assertGreater(errors[0] / errors[1], 3.8)
            self.assertLess(errors[1], (4.9 * 0.01)**2 / 12 * 4.9 * 8)

    def test_the_generalised_alpha_method_is_of_second_order_too(self):
        errors = [self.error(0.5, dt=dt, rho_infinity='0.5') for dt in ('0.02', '0.01')]
        self.assertGreater(errors[0] / errors[1], 3.6)
        self.assertLess(errors[1], (4.9 * 0.01)**2 * 4.9 * 8)

    def test_adaptive_steps_do_the_same(self):
        for mu in (0.3, 0.5):
            coarse, fine = (self.error(mu, rtol=rtol) for rtol in ('1e-4', '1e-6'))
            self.assertLess(fine, 3e-3)
            self.assertLess(fine, 0.2 * coarse)

    def test_the_contact_carries_what_it_is_pressed_to(self):
        for row in self.series(two_way(slider={'damping': '0.3', 'normal_damping': '0.2', 'area': '1.5'}, time={'t_end': '20'})):
            self.assertAlmostEqual(row['normal_traction'], max(0.0, -11 * row['normal_displacement']), 12)
            self.assertLessEqual(abs(row['friction_force']), 1.5 * 0.5 * row['normal_traction'] + 1e-12)
            self.assertAlmostEqual(row['spring_force'], K * (row['drive'] - row['displacement'])
                                   - TILT * (row['normal_displacement'] + 10 / 11), 9)

    def test_a_block_let_go_leaves_the_base_and_comes_back(self):
        """Without load and tilt it is thrown up by the contact spring, swings half a period on its own spring alone, and so on."""
        rows = self.series(two_way(slider={'tilt_stiffness': '0', 'normal_stiffness': '0.5'}, time={'t_end': '6', 'dt': '5e-4'},
                                   drive={'velocity': '0.1', 'normal': '10, 0', 'duration': '1, 5'}))
        # K_n (u + 10/11) - k_3 (-u): about u_0 = -K_n (10/11)/(K_n + k_3), from -10/11 at t = 1
        rest, omega = -0.5 * (10 / 11) / 11.5, math.sqrt(11.5)
        away = -10 / 11 - rest
        lift = 1 + math.acos(-rest / away) / omega
        speed = -away * omega * math.sin(omega * (lift - 1))
        free = math.sqrt(0.5)
        for row in rows:
            t = row['time']
            if t <= 1:
                expected = -10 / 11
            elif t <= lift:
                expected = rest + away * math.cos(omega * (t - 1))
            else:
                expected = -10 / 11 + 10 / 11 * math.cos(free * (t - lift)) + speed / free * math.sin(free * (t - lift))
                if expected < 0:
                    break
                self.assertEqual((row['normal_traction'], row['friction_force']), (0.0, 0.0) if expected > 1e-2 else
                                 (row['normal_traction'], row['friction_force']))
            self.assertLess(abs(row['normal_displacement'] - expected), 5e-3)
        self.assertGreater(t, 1 + math.pi / omega)
        self.assertGreater(max(row['normal_traction'] for row in rows if row['time'] > t), 5.0)

    def test_the_balance_of_energy_closes(self):
        unbalanced = []
        for dt in ('2e-3', '5e-4'):
            result = self.run_text(two_way(slider={'damping': '0.1', 'normal_damping': '0.05'}, time={'t_end': '20', 'dt': dt}), '--no-plot')
            self.assert_done(result)
            told = {line.split()[0]: float(line.split()[-1]) for line in result.stdout.splitlines() if line.startswith('  ')}
            unbalanced.append(abs(told['unbalanced']) / told['dissipated'])
        self.assertLess(unbalanced[0], 5e-3)
        self.assertLess(unbalanced[1], 0.5 * unbalanced[0])

    def test_every_law_goes_both_ways(self):
        laws = {'subloading': dict(mu_s='0.5', mu_k='0.4', kappa='1', xi='1', m='1000'), 'static_kinetic': dict(mu_s='0.5', mu_k='0.45', d_c='0.1'),
                'rate_and_state': dict(a='0.01', b='0.015', d_c='0.1', v0='0.1', f0='0.5'), 'slip_weakening': dict(mu_s='0.5', mu_k='0.45', d_c='0.1')}
        for law, constants in laws.items():
            for time in ({'t_end': '10', 'dt': '1e-3'}, {'t_end': '10', 'dt': None, 'rtol': '1e-4'}):
                rows = self.series(two_way({'mu': None, 'law': f"'{law}'", **constants}, {'normal_damping': '0.3', 'damping': '0.3'}, time=time))
                self.assertGreater(rows[-1]['displacement'], 10.0)
                self.assertGreater(rows[-1]['normal_traction'], 0.0)

    def test_a_resumed_run_is_the_same(self):
        text = two_way(time={'t_end': '10', 'dt': None, 'rtol': '1e-4'})
        self.assert_done(self.run_text(text, '--no-plot', '--output', 'whole'))
        self.assertEqual(self.run_text(text + '&output table_limit = 3e-5 /\n', '--no-plot').returncode, 1)
        self.assertLess(len(self.rows('case_out/case.csv')), len(self.rows('whole/case.csv')))
        self.assert_done(self.run_text(text, '--no-plot', '--resume'))
        for table in ('case.csv', 'case_events.csv'):
            self.assertEqual((self.folder / 'case_out' / table).read_bytes(), (self.folder / 'whole' / table).read_bytes())


class ContinuousTime(Motion):
    """Adaptive steps against an independent integration (scipy's DOP853 and Radau with the ends of phases located, rtol 1e-11)."""
    SLIDER = {'mass': '1', 'stiffness': '20', 'damping': '0.2', 'normal_mass': '1', 'normal_stiffness': '10', 'normal_damping': '0.5',
              'tilt_stiffness': '3'}
    STATIC_KINETIC = {'law': "'static_kinetic'", 'alpha_n': '1000', 'alpha_t': '1000', 'mu': None, 'mu_s': '0.5', 'mu_k': '0.4', 'd_c': '20'}
    FLASH_HEATING = dict(law="'flash_heating'", alpha_n='1000', alpha_t='1000', mu=None, a='0.01', b='0.015', d_c='0.01', v0='0.001', f0='0.6',
                         f_w='0.2', v_w='0.03')

    def told(self, friction, slider=(), sense=1, **groups):
        """Last row, energies and rows of a run."""
        time = {'t_end': '10', 'dt': None, 'rtol': '1e-7', **groups.pop('time', {})}
        groups = {'drive': {'velocity': '0.1'}, **groups}
        groups['drive']['velocity'] = repr(sense * float(groups['drive']['velocity']))
        slider = {**self.SLIDER, **dict(slider)}
        slider['tilt_stiffness'] = repr(sense * float(slider['tilt_stiffness']))
        result = self.run_text(two_way(friction, slider, time=time, **groups), '--no-plot')
        self.assert_done(result)
        energies = {line.split()[0]: float(line.split()[-1]) for line in result.stdout.splitlines() if line.startswith('  ')}
        rows = self.rows('case_out/case.csv')
        return {key: float(value) for key, value in rows[-1].items()}, energies, rows

    def assert_motion(self, told, displacement, away, dissipated):
        last, energies, _ = told
        self.assertAlmostEqual(last['displacement'], displacement, delta=1e-6 * abs(displacement))
        self.assertAlmostEqual(last['normal_displacement'], away, delta=1e-6 * abs(away) + 1e-8)
        self.assertAlmostEqual(energies['dissipated'], dissipated, delta=2e-6 * dissipated)
        self.assertLess(abs(energies['unbalanced']), 1e-6 * dissipated)

    def test_friction_that_drops_at_once(self):
        # 17 slips, each after a drop of the contact spring's force; Newmark's steps dissipated 11 % more
        self.assert_motion(self.told(self.STATIC_KINETIC), 0.83294791016, -0.009505806733, 3.15647199984)

    def test_on_a_rigid_contact(self):
        self.assert_motion(self.told({**self.STATIC_KINETIC, 'contact': "'rigid'"}), 0.75349105818, -0.009262747472, 2.86172828107)

    def test_beside_a_damper(self):
        self.assert_motion(self.told({**self.STATIC_KINETIC, 'eta_t': '30'}), 0.76689486761, -0.009306942951, 2.90331236940)

    def test_a_block_that_leaves_the_base_and_comes_back_three_times(self):
        self.assert_motion(self.told(self.STATIC_KINETIC, {'normal_damping': '5', 'normal_traction': None}, time={'t_end': '5'},
                                     drive={'velocity': '0.5', 'duration': '2, 0.3, 2.7', 'normal': '10, 0, 8'}),
                           2.26736636443, -0.007287877468, 6.38542161674)

    def test_flash_heating(self):
        self.assert_motion(self.told(self.FLASH_HEATING), 0.86197988313, -0.009492648028, 1.97982274812)

    def test_a_mirrored_motion_has_the_mirrored_table(self):
        for friction in (self.STATIC_KINETIC, self.FLASH_HEATING):
            rows, mirrored = (self.told(friction, sense=sense)[2] for sense in (1, -1))
            self.assertEqual(len(rows), len(mirrored))
            for row, image in zip(rows, mirrored, strict=True):
                self.assertEqual(float(row['velocity']), -float(image['velocity']))
                self.assertEqual(row['normal_traction'], image['normal_traction'])

    def test_a_resumed_run_is_the_same(self):
        """Stopped where it sticks, slides or flies."""
        for friction in (self.STATIC_KINETIC, {**self.STATIC_KINETIC, 'contact': "'rigid'"}, self.FLASH_HEATING):
            text = two_way(friction, {**self.SLIDER, 'normal_damping': '5', 'normal_traction': None}, time={'t_end': '5', 'dt': None, 'rtol': '1e-6'},
                           drive={'velocity': '0.5', 'duration': '2, 0.3, 2.7', 'normal': '10, 0, 8'})
            self.assert_done(self.run_text(text, '--no-plot', '--output', 'whole'))
            size = (self.folder / 'whole/case.csv').stat().st_size
            for part in (0.3, 0.6, 0.8):
                self.assertEqual(self.run_text(text + f'&output table_limit = {part * size / 1e9:.3e} /\n', '--no-plot').returncode, 1)
                self.assert_done(self.run_text(text, '--no-plot', '--resume'))
                self.assertEqual((self.folder / 'case_out/case.csv').read_bytes(), (self.folder / 'whole/case.csv').read_bytes())


class Keys(Program):
    def test_what_needs_what(self):
        self.refused(two_way(slider={'normal_mass': None}), 'normal_stiffness', 'tilt_stiffness', 'needs a normal_mass')
        self.refused(two_way(slider={'mass': '0'}), 'normal_mass', 'needs a mass > 0')
        self.refused(two_way(slider={'normal_mass': '0'}), 'normal_mass', 'must be > 0')
        self.refused(two_way(slider={'tilt_stiffness': '13.5'}), 'tilt_stiffness', 'must not exceed sqrt(stiffness normal_stiffness)')
        self.refused(two_way(chain={'n_blocks': '2', 'coupling': '1'}), 'normal_mass', 'is for one block')
        self.refused(two_way({'contact': "'rigid'"}, time={'rtol': '1e-5', 'dt': None, 'beta': '0.25'}), 'contact', 'without beta')
        self.refused(two_way({'law': "'linker_dieterich'", 'mu': None, 'contact': "'rigid'", **dict(a='0.01', b='0.015', d_c='0.1', v0='0.1', f0='0.5',
                              alpha='0.2')}, time={'rtol': '1e-5', 'dt': None}), 'contact', 'normal_mass')

    def test_the_input_with_a_picture(self):
        text = (INPUTS / 'mode_coupling.nml').read_text(encoding='utf-8')
        self.assert_done(self.run_text(text, '--no-plot'))
        header = (self.folder / 'case_out/case.csv').read_text().split('\n')[0]
        self.assertTrue(header.endswith(',normal_traction,normal_displacement,normal_velocity'))
        self.assertGreater(len(self.rows('case_out/case_events.csv')), 10)


class Flutter(Stability):
    def test_eigenvalues_of_the_minimal_model(self):
        for mu, damping, normal_damping, sense in itertools.product((0.2, 0.5), (0.0, 0.07), (0.0, 0.3), (1, -1)):
            row = self.told(two_way({'mu': repr(mu)}, {'damping': repr(damping), 'normal_damping': repr(normal_damping)},
                                    drive={'velocity': str(2 * sense)}))[0]
            self.assert_roots(total(product(exact(1, damping, K), exact(1, normal_damping, K_N + K_3)),
                                    product(exact(-TILT), [Fraction(TILT) - sense * Fraction(mu) * 11])))
            if sense > 0 and not damping:
                pressure, _ = steady(mu)
                self.assert_near(row['normal_traction'], pressure, 1e-13)
            if not damping and not normal_damping:
                self.assertEqual(row['stability'], 'unstable' if mu > flutter() and sense > 0 else 'neutral')

    def test_flutter_boundary(self):
        """mu_c = ((k11 - k22)^2/(4 k12) + k12)/k3, along a line of stiffnesses."""
        self.told(two_way(sweep={'key': "'slider%stiffness'", 'values': '16, 40', 'key2': "'friction%mu'", 'values2': '0.1, 5'}))
        boundary = self.rows('case_out/case_stability_boundary.csv')
        self.assertGreater(len(boundary), 40)
        for point in boundary:
            self.assert_near(point['friction%mu'], flutter(stiffness=float(point['slider%stiffness'])), 1e-10)

    def test_laws_with_memory_answer_to_a_varying_pressure(self):
        """As long as the block swings across, the traction is that of the slip rate plus friction times the pressure."""
        tilt, area, velocity = 2.0, 1.3, 0.6
        for law, damping in itertools.product(('rate_and_state', 'linker_dieterich', 'subloading'), (0.0, 0.1)):
            constants = dict(a='0.05', b='0.09', d_c='0.3', v0='0.5', f0='0.5') if law != 'subloading' else dict(
                mu_s='0.5', mu_k='0.2', kappa='3', xi='2', m='30')
            if law == 'linker_dieterich':
                constants['alpha'] = '0.2'
            row = self.told(two_way({'law': f"'{law}'", 'mu': None, 'alpha_t': '50', **constants},
                                    {'tilt_stiffness': repr(tilt), 'area': repr(area), 'damping': repr(damping), 'normal_damping': '0.2'},
                                    drive={'velocity': repr(velocity)}))[0]
            friction, pressure = Fraction(float(row['friction'])), Fraction(float(row['normal_traction']))
            v, s = Fraction(velocity), Fraction(area)
            pressed = None
            if law != 'subloading':
                a, b, d_c = Fraction(0.05), Fraction(0.09), Fraction(0.3)
                memory = exact(1, v / d_c)
                a *= Fraction(math.tanh(float(friction) / 0.05))
                b *= Fraction(math.tanh(float(friction) / 0.05))
                surface = total(product([a * pressure / v], memory), [-b * pressure / d_c])
                if law == 'linker_dieterich':   # (ln theta)' has -alpha/(b p) p' besides
                    pressed = [-Fraction(0.2) * b / Fraction(0.09), Fraction(0)]
            else:
                memory = exact(1, 3 * v + 2)
                surface = [-pressure * 3 * (friction - Fraction(0.2))]
            pressed = total(product([friction], memory), pressed or exact(0))
            closed = total(memory, product(surface, exact(Fraction(1, 50), 0)))
            polynomial = total(
                product(total(product(exact(1, damping, K), closed), product(surface, exact(s, 0))), exact(1, 0.2, Fraction(K_N) + 11 * s)),
                product([-Fraction(tilt)], total(product([Fraction(tilt)], closed), product(exact(-s * 11), pressed))))
            if law == 'subloading':   # R stands for itself
                polynomial = product(polynomial, exact(1, 30 * velocity))
            self.assert_roots(polynomial)

    def test_where_the_block_would_lift_or_lock_it_says_so(self):
        for tilt, velocity, damping, why in (('13', '1', '30', 'lift the block off'), ('13', '-1', '0', 'it locks')):
            result = self.run_text(two_way({'mu': '3'}, {'tilt_stiffness': tilt, 'damping': damping}, drive={'velocity': velocity}),
                                   '--no-plot', verb='stability')
            self.assertEqual(result.returncode, 1)
            self.assertIn(why, result.stdout)


if __name__ == '__main__':
    unittest.main()
