"""Stability of steady sliding as a user asks for it, against closed forms and characteristic polynomials.

A root of a polynomial is checked by its distance to the exact root, P/P', in exact arithmetic: nothing of the
program's way to it is used. STICKSLIP names the program.
"""
import itertools
import math
import unittest
from fractions import Fraction

from drawing import needs_gnuplot
from strict_build import release_only
from test_program import INPUTS, Program, namelist

TIGHT = 1e-10
COLUMNS = ('piece,velocity,normal_traction,friction,stability,growth_rate,frequency,critical_stiffness,'
           'critical_velocity,critical_damping,critical_mass,reason')
NAMES = {'slider%stiffness': 'critical_stiffness', 'drive%velocity': 'critical_velocity',
         'slider%damping': 'critical_damping', 'slider%mass': 'critical_mass'}


def product(*factors):
    """Of polynomials, the highest power first."""
    result = [Fraction(1)]
    for factor in factors:
        terms = [Fraction(0)] * (len(result) + len(factor) - 1)
        for i, j in itertools.product(range(len(result)), range(len(factor))):
            terms[i + j] += result[i] * factor[j]
        result = terms
    return result


def total(*terms):
    length = max(map(len, terms))
    return [sum(column) for column in zip(*([Fraction(0)] * (length - len(term)) + list(term) for term in terms))]


def exact(*numbers):
    return [Fraction(number) for number in numbers]


def distance(polynomial, root):
    """Of a number to the root of a polynomial next to it, as part of its own size."""
    real, imaginary = Fraction(root.real), Fraction(root.imag)
    value, slope = (Fraction(0), Fraction(0)), (Fraction(0), Fraction(0))

    def times_root(z):
        return z[0] * real - z[1] * imaginary, z[0] * imaginary + z[1] * real

    for coefficient in polynomial:
        turned = times_root(slope)
        slope = turned[0] + value[0], turned[1] + value[1]
        turned = times_root(value)
        value = turned[0] + coefficient, turned[1]
    return abs(complex(*map(float, value)) / complex(*map(float, slope))) / abs(root)


class Stability(Program):
    def told(self, text, *arguments):
        result = self.run_text(text, '--no-plot', *arguments, verb='stability')
        self.assertEqual((result.returncode, result.stderr), (0, ''))
        return self.rows('case_out/case_stability.csv')

    def eigenvalues(self, row=1):
        return [complex(float(line['real_part']), float(line['imaginary_part']))
                for line in self.rows('case_out/case_eigenvalues.csv') if line['row'] == str(row)]

    def assert_near(self, value, expected, tolerance=TIGHT):
        self.assertLessEqual(abs(float(value) / float(expected) - 1), tolerance, (value, expected))

    def assert_roots(self, polynomial):
        """The eigenvalues are the roots of a polynomial."""
        while polynomial[0] == 0:
            polynomial = polynomial[1:]
        roots = self.eigenvalues()
        self.assertEqual(len(roots), len(polynomial) - 1)
        for root in roots:
            self.assertLessEqual(distance(polynomial, root), TIGHT, root)
        self.assertEqual(len(set(roots)), len(roots))


def rate_and_state(mass, stiffness, velocity, evolution="'ageing'", damping=0.0, contact=None, area=1.0, pressure=1.0):
    friction = {'law': "'rate_and_state'", 'alpha_n': 1, 'alpha_t': contact or 1, 'a': 0.005, 'b': 0.01, 'd_c': 10.0, 'v0': 1.0,
                'f0': 0.6, 'evolution': evolution}
    if contact is None:
        friction['contact'] = "'rigid'"
    return namelist({**{('friction', key): str(value) for key, value in friction.items()}, ('slider', 'mass'): repr(mass),
                     ('slider', 'stiffness'): repr(stiffness), ('slider', 'damping'): repr(damping), ('slider', 'area'): repr(area),
                     ('slider', 'normal_traction'): repr(pressure), ('drive', 'velocity'): repr(velocity),
                     ('time', 'rtol'): '1e-6'},
                    [('friction', key) for key in ('mu_s', 'mu_k', 'kappa', 'xi', 'm')] + [('time', 'dt')])


class RateAndState(Stability):
    """`k_c = (b - a) sigma/d_c (1 + M v^2/(sigma a d_c))`, at `omega_c = v/d_c sqrt((b - a)/a)` (Rice and Ruina 1983)."""

    A, B, D_C = 0.005, 0.01, 10.0

    def critical(self, mass, velocity):
        return (self.B - self.A) / self.D_C * (1 + mass * velocity**2 / (self.A * self.D_C))

    @release_only
    def test_critical_stiffness_and_its_frequency(self):
        for evolution in ("'ageing'", "'slip'"):
            for mass, velocity in ((0.0, 1.0), (0.025, 1.0), (0.025, 2.0), (0.025, 0.1)):
                expected = self.critical(mass, velocity)
                row = self.told(rate_and_state(mass, 0.9 * expected, velocity, evolution))[0]
                self.assertEqual(row['stability'], 'unstable')
                self.assert_near(row['critical_stiffness'], expected)
                row = self.told(rate_and_state(mass, 1.1 * expected, velocity, evolution))[0]
                self.assertEqual(row['stability'], 'stable')
                self.assert_near(row['critical_stiffness'], expected)
                row = self.told(rate_and_state(mass, float(row['critical_stiffness']), velocity, evolution))[0]
                self.assertEqual(row['stability'], 'neutral')
                self.assert_near(row['frequency'], velocity / self.D_C * math.sqrt((self.B - self.A) / self.A) / (2 * math.pi))

    def test_critical_velocity_and_mass_are_the_same_line(self):
        stiffness = self.critical(0.025, 2.0)
        for mass, velocity in ((0.025, 1.0), (0.025, 3.0), (0.01, 2.0), (0.05, 2.0)):
            row = self.told(rate_and_state(mass, stiffness, velocity))[0]
            excess = (stiffness / self.critical(0.0, 1.0) - 1) * self.A * self.D_C
            self.assert_near(row['critical_velocity'], math.sqrt(excess / mass))
            self.assert_near(row['critical_mass'], excess / velocity**2)

    def test_where_there_is_no_change_it_says_so(self):
        """Without mass the velocity does not matter."""
        result = self.run_text(rate_and_state(0.0, 1e-3, 1.0), '--no-plot', verb='stability')
        self.assertRegex(result.stdout, 'critical velocity +none from +1.0E-06 to +1.0E.06')
        row = self.rows('case_out/case_stability.csv')[0]
        self.assertEqual(row['critical_velocity'], 'NaN')

    def test_eigenvalues_with_and_without_contact_spring_mass_and_damper(self):
        a, b, d_c = map(Fraction, (self.A, self.B, self.D_C))
        for contact, mass, damping in itertools.product((None, 3.0, 1e4), (0.0, 0.3), (0.0, 0.07)):
            pressure, area, velocity, stiffness = 0.7, 1.3, 0.6, 2e-4
            self.told(rate_and_state(mass, stiffness, velocity, damping=damping, contact=contact, area=area, pressure=pressure))
            p, s, v = map(Fraction, (pressure, area, velocity))
            ageing = exact(1, v / d_c)
            surface = total(product([a * p / v], ageing), [-b * p / d_c])   # traction over slip rate, times `ageing`
            softness = Fraction(1, Fraction(contact)) if contact else Fraction(0)
            self.assert_roots(total(product(exact(mass, damping, stiffness), total(ageing, product(surface, exact(softness, 0)))),
                                    product(surface, exact(s, 0))))


SUBLOADING = dict(alpha_t=1000.0, mu_s=0.4, mu_k=0.2, m=1000.0, normal=10.0)


def subloading(mass, stiffness, damping, velocity, kappa, xi, **changes):
    of = {**SUBLOADING, **changes}
    return namelist({('friction', 'alpha_t'): repr(of['alpha_t']), ('friction', 'kappa'): repr(kappa), ('friction', 'xi'): repr(xi),
                     ('friction', 'm'): repr(of['m']), **{('friction', key): of[key] for key in ('u_of_r', 'scheme') if key in of},
                     ('slider', 'mass'): repr(mass), ('slider', 'stiffness'): repr(stiffness), ('slider', 'damping'): repr(damping),
                     ('slider', 'normal_traction'): repr(of['normal']), ('drive', 'velocity'): repr(velocity)})


class Subloading(Stability):
    """`A < C c + (C K/b)/(M b c + C)`, quasi-static `A < K k_t/(K + k_t)` (theory.md, section 6)."""

    CASES = (dict(kappa=10.0, xi=10.0, velocity=1.0, mass=1e-3, stiffness=1.0), dict(kappa=10.0, xi=10.0, velocity=3.0, mass=1e-2, stiffness=5.0),
             dict(kappa=2.0, xi=0.5, velocity=0.5, mass=1e-3, stiffness=1.0), dict(kappa=100.0, xi=100.0, velocity=1.0, mass=1e-3, stiffness=10.0))

    @staticmethod
    def terms(kappa, xi, velocity, alpha_t=1000.0):
        mu = (kappa * velocity * 0.2 + xi * 0.4) / (kappa * velocity + xi)
        weakening = 10.0 * kappa * (mu - 0.2)
        return mu, weakening, kappa * velocity + xi, alpha_t / (alpha_t - weakening)

    def test_critical_damping_and_stiffness(self):
        for case, alpha_t in itertools.product(self.CASES, (1000.0, 1e6)):
            mu, weakening, c, b = self.terms(case['kappa'], case['xi'], case['velocity'], alpha_t)
            inertia = case['mass'] * b * c
            linear = c * inertia + case['stiffness'] / b - weakening
            damping = (-linear + math.sqrt(linear**2 + 4 * c * weakening * inertia)) / (2 * c)
            for part, verdict in ((0.9, 'unstable'), (1.1, 'stable')):
                row = self.told(subloading(damping=part * damping, alpha_t=alpha_t, **case))[0]
                self.assertEqual(row['stability'], verdict)
                self.assert_near(row['friction'], mu, 1e-14)
                self.assert_near(row['critical_damping'], damping)
                stiffness = (weakening - c * part * damping) * b * (inertia + part * damping) / (part * damping)
                if stiffness > 0:
                    self.assert_near(row['critical_stiffness'], stiffness)
                else:
                    self.assertEqual(row['critical_stiffness'], 'NaN')

    def test_quasi_static(self):
        mu, weakening, c, b = self.terms(10.0, 10.0, 1.0, 30.0)
        expected = weakening * 30.0 / (30.0 - weakening)   # K k_t/(K + k_t) = A
        for part, verdict in ((0.9, 'unstable'), (1.1, 'stable')):
            row = self.told(subloading(0.0, part * expected, 0.0, 1.0, 10.0, 10.0, alpha_t=30.0))[0]
            self.assertEqual(row['stability'], verdict)
            self.assert_near(row['critical_stiffness'], expected)

    def test_without_damper_it_is_never_stable(self):
        for stiffness in ('1', '1e6'):
            self.assertEqual(self.told(namelist({('slider', 'stiffness'): stiffness, ('slider', 'damping'): '0'}))[0]['stability'],
                             'unstable')

    def test_eigenvalues(self):
        """Those of R, by the slope of U(R) at 1, stand for themselves."""
        slopes = {'logarithm': 1.0, 'reciprocal': 1.0, 'cotangent': math.pi / 2}
        for (name, slope), scheme in itertools.product(slopes.items(), ("'backward_euler'", "'exact_rate'")):
            if name != 'logarithm' and scheme == "'exact_rate'":
                continue
            self.told(subloading(0.01, 5.0, 0.03, 3.0, 10.0, 10.0, alpha_t=40.0, m=20.0, u_of_r=f"'{name}'", scheme=scheme))
            weakening, c, k_t = Fraction(10 * 10) * Fraction(1, 20), Fraction(40), Fraction(40)
            # slip rate: k_t (v - s') = -A (s' + c f/A) with the friction force f: f (p + c) = -A s', k_t (p x - s') = p f
            forces = total(product(exact(0.01, 0.03, 5.0), total(product([k_t], exact(1, c)), [0], product([-weakening], exact(1, 0)))),
                           product([-weakening * k_t], exact(1, 0)))
            own = [root for root in self.eigenvalues() if abs(root + 20.0 * 3.0 * slope) < 1e-8]
            self.assertEqual(len(own), 1)
            others = [root for root in self.eigenvalues() if root not in own]
            self.assertEqual(len(others), 3)
            for root in others:
                self.assertLessEqual(distance(forces, root), TIGHT, root)


class OtherLaws(Stability):
    def law(self, law, constants, contact="'elastic'", **slider):
        changes = {('friction', 'law'): f"'{law}'", ('friction', 'contact'): contact, ('time', 'rtol'): '1e-6',
                   **{('friction', key): repr(value) for key, value in constants.items()},
                   **{('slider', key): repr(value) for key, value in slider.items()}}
        others = [('friction', key) for key in ('mu_s', 'mu_k', 'kappa', 'xi', 'm') if key not in constants]
        return namelist(changes, [*others, ('time', 'dt')])

    def test_constant_friction_leaves_the_oscillator(self):
        for law, constants in (('coulomb', {'mu': 0.3}), ('slip_weakening', {'mu_s': 0.4, 'mu_k': 0.2, 'd_c': 0.05})):
            for contact, damping in itertools.product(("'elastic'", "'rigid'"), (0.0, 0.02)):
                row = self.told(self.law(law, constants, contact, damping=damping))[0]
                self.assertEqual(row['stability'], 'stable' if damping else 'neutral')
                self.assert_roots(exact(1e-3, damping, 1.0))
                self.assert_near(row['friction'], constants.get('mu', 0.2), 1e-15)

    def test_friction_that_falls_with_the_slip_rate_is_a_negative_damper(self):
        mu_s, mu_k, d_c, velocity, force = 0.4, 0.2, 0.1, 1.0, 10.0
        critical = force * (mu_s - mu_k) * d_c * math.exp(-d_c * velocity)
        for contact in ("'elastic'", "'rigid'"):
            row = self.told(self.law('static_kinetic', {'mu_s': mu_s, 'mu_k': mu_k, 'd_c': d_c}, contact, damping=0.1))[0]
            self.assertEqual(row['stability'], 'unstable')
            self.assert_near(row['critical_damping'], critical)
            self.assert_near(row['critical_velocity'], math.log(force * (mu_s - mu_k) * d_c / 0.1) / d_c)
            self.assert_roots([Fraction(1e-3), Fraction(0.1) - Fraction(critical), Fraction(1)])

    def test_slip_weakening_that_heals_slides_at_what_slip_and_healing_leave(self):
        """D = V/xi below d_c, friction mu_s - (mu_s - mu_k) V/(xi d_c); from V = xi d_c on it is constant."""
        mu_s, mu_k, d_c, xi, velocity, damping, force = 0.4, 0.2, 5.0, 0.5, 1.0, 0.3, 10.0
        constants = {'mu_s': mu_s, 'mu_k': mu_k, 'd_c': d_c, 'xi': xi}
        for contact in ("'elastic'", "'rigid'"):
            row = self.told(self.law('slip_weakening_healing', constants, contact, damping=damping))[0]
            self.assert_near(row['friction'], mu_s - (mu_s - mu_k) * velocity / (xi * d_c), 1e-14)
            weakening = Fraction(force) * (Fraction(mu_s) - Fraction(mu_k)) / Fraction(d_c)
            memory = exact(1, xi)
            closed = memory if contact == "'rigid'" else total(memory, product([-weakening / 1000], exact(1, 0)))
            self.assert_roots(total(product(exact(1e-3, damping, 1.0), closed), product([-weakening], exact(1, 0))))
            self.assert_near(self.told(self.law('slip_weakening_healing', {**constants, 'xi': 0.1}, contact))[0]['friction'], mu_k, 1e-15)

    def test_flash_heating_weakens_as_its_steady_friction_falls(self):
        """`k_c = -(sigma/d_c) df_ss/d(ln v) (1 + M v^2/(sigma a d_c))`: Rice and Ruina 1983, for any steady friction."""
        a, b, d_c, v_0, f_0, f_w, v_w, n = 0.016, 0.02, 0.01, 1e-6, 0.7, 0.2, 0.1, 8.0
        constants = {'a': a, 'b': b, 'd_c': d_c, 'v0': v_0, 'f0': f_0, 'f_w': f_w, 'v_w': v_w}
        for mass, velocity in itertools.product((0.0, 1e-3), (1e-3, 0.1, 0.3)):
            low = a * math.asinh(velocity / (2 * v_0) * math.exp((f_0 - b * math.log(velocity / v_0)) / a))
            hot = (velocity / v_w)**n
            share = (1 + hot)**(-1 / n)
            steady = f_w + (low - f_w) * share
            slope = (a - b) * math.tanh(low / a) * share - (low - f_w) * share * hot / (1 + hot)
            direct = a * math.tanh(steady / a)
            text = self.law('flash_heating', constants, "'rigid'", mass=mass, damping=0.0)
            row = self.told(text.replace('velocity = 1\n', f'velocity = {velocity!r}\n'))[0]
            self.assert_near(row['friction'], steady, 1e-13)
            self.assert_near(row['critical_stiffness'], -10 * slope / d_c * (1 + mass * velocity**2 / (10 * direct * d_c)))

    def test_a_damper_beside_the_contact_spring(self):
        """Spring and damper in parallel, in series with the surface: alpha u + eta v = (N/D + eta) s', u' = v - s'."""
        alpha, eta = 40.0, 0.7
        for law, mass in itertools.product(('coulomb', 'static_kinetic', 'rate_and_state'), (0.3, 0.0)):
            constants = {'coulomb': dict(mu=0.3), 'static_kinetic': dict(mu_s=0.4, mu_k=0.3, d_c=0.5),
                         'rate_and_state': dict(a=0.05, b=0.09, d_c=0.3, v0=0.5, f0=0.5)}[law]
            damping = 0.9
            row, = self.told(namelist({('friction', 'law'): f"'{law}'", ('friction', 'alpha_t'): repr(alpha), ('friction', 'eta_t'): repr(eta),
                                **{('friction', key): repr(value) for key, value in constants.items()}, ('slider', 'mass'): repr(mass),
                                ('slider', 'damping'): repr(damping), ('slider', 'stiffness'): '3'},
                               [('friction', key) for key in ('mu_s', 'mu_k', 'kappa', 'xi', 'm') if key not in constants]))
            part = 10 * Fraction(math.tanh(float(row['friction']) / 0.05))
            surface, memory = {'coulomb': (exact(0), exact(1)), 'static_kinetic': (exact(-10 * 0.1 * 0.5 * math.exp(-0.5)), exact(1)),
                               'rate_and_state': (total(product([part * Fraction(0.05)], exact(1, 1 / Fraction(0.3))),
                                                        [-part * Fraction(0.09) / Fraction(0.3)]), exact(1, 1 / Fraction(0.3)))}[law]
            dynamic = exact(mass, damping, 3.0)
            self.assert_roots(total(
                product(dynamic, total(product(total(surface, product([Fraction(eta)], memory)), exact(1, 0)), product([Fraction(alpha)], memory))),
                product(surface, exact(1, 0), exact(eta, alpha))))

    def test_cohesion_stands_beside_friction(self):
        row = self.told(self.law('static_kinetic', {'mu_s': 0.4, 'mu_k': 0.2, 'd_c': 0.1, 'cohesion': 3.0}, damping=0.1))[0]
        self.assert_near(row['friction'], 0.2 + 0.2 * math.exp(-0.1) + 0.3, 1e-14)
        self.assert_near(row['critical_damping'], 10 * 0.2 * 0.1 * math.exp(-0.1))

    def test_at_a_shear_cap_friction_is_constant(self):
        row = self.told(namelist({('friction', 'tau_max'): '1.5', ('slider', 'damping'): '0.02'}))[0]
        self.assertEqual(row['stability'], 'stable')
        self.assert_near(row['friction'], 0.15, 1e-15)
        for root in (root for root in self.eigenvalues() if root.imag):
            self.assertLessEqual(distance(exact(1e-3, 0.02, 1.0), root), TIGHT)


class NoSteadySliding(Stability):
    def test_it_says_why(self):
        for text, why in ((namelist({('drive', 'velocity'): '0'}), 'the drive stands still'),
                          (namelist({('drive', 'normal_amplitude'): '1', ('drive', 'normal_frequency'): '1'}), 'normal traction changes'),
                          ((INPUTS / 'from_file.nml').read_text().replace("'from_file.csv'", f"'{INPUTS / 'from_file.csv'}'"), 'follows a file'),
                          (namelist({('chain', 'n_blocks'): '3', ('chain', 'coupling'): '1'}), 'a chain of blocks'),
                          (OtherLaws.law(self, 'coulomb', {'mu': 0.3, 'eta_t': 1.0}, mass=0.0, damping=0.0)
                           .replace('rtol = 1e-6', 'dt = 1e-3'), 'it needs a mass')):
            result = self.run_text(text, '--no-plot', verb='stability')
            self.assertEqual(result.returncode, 1)
            self.assertIn('case.nml: nothing slides steadily', result.stderr)
            self.assertIn(why, self.rows('case_out/case_stability.csv')[0]['reason'])
            self.assertIn(why, result.stdout)

    def test_holds_are_left_out_and_pieces_have_rows(self):
        rows = self.told(namelist({('drive', 'velocity'): '1, 0, 20', ('drive', 'duration'): '1, 1, 1'}))
        self.assertEqual([(row['piece'], row['stability']) for row in rows], [('1', 'unstable'), ('3', 'stable')])

    def test_bad_input_is_refused_as_by_run(self):
        result = self.run_text(namelist({('slider', 'stiffness'): '-1'}), verb='stability')
        self.assertEqual(result.returncode, 2)
        self.assertIn('&slider stiffness = -1', result.stderr)
        self.assertEqual(result.stdout, '')
        result = self.run_text('&point /', verb='stability')
        self.assertEqual((result.returncode, result.stderr.count('an input of the verb point, not of stability')), (2, 1))

    def test_the_sense_of_the_drive_does_not_matter(self):
        there = self.told(namelist())[0]
        back = self.told(namelist({('drive', 'velocity'): '-1'}))[0]
        self.assertEqual({**back, 'velocity': there['velocity']}, there)


class Boundary(Stability):
    def test_the_map_of_a_sweep(self):
        """Every point of the boundary obeys the criterion; it divides the rows of the table."""
        text = (INPUTS / 'sweep_map.nml').read_text(encoding='utf-8')
        rows = self.told(text)
        self.assertEqual(','.join(rows[0]), 'drive%velocity,slider%stiffness,' + COLUMNS)
        self.assertEqual(len(rows), 120)

        def excess(velocity, stiffness):
            """Of the criterion's right side; sliding is stable where it is positive."""
            weakening, c = 10 * 10.0 * 0.2 / (10 * velocity + 1), 10 * velocity + 1
            b = 1000 / (1000 - weakening)
            return 0.01 * c + 0.01 * stiffness / b / (1e-3 * b * c + 0.01) - weakening, weakening

        for row in rows:
            self.assertEqual(row['stability'] == 'stable', excess(float(row['velocity']), float(row['slider%stiffness']))[0] > 0)
        boundary = self.rows('case_out/case_stability_boundary.csv')
        self.assertGreater(len(boundary), 50)
        for point in boundary:
            left, scale = excess(float(point['drive%velocity']), float(point['slider%stiffness']))
            self.assertLess(abs(left), TIGHT * scale)

    def test_keys_of_the_law_can_be_axes(self):
        self.told(namelist({('sweep', 'key'): "'friction%kappa'", ('sweep', 'values'): '1, 100'}))
        boundary = self.rows('case_out/case_stability_boundary.csv')
        self.assertEqual(list(boundary[0])[:2], ['friction%kappa', 'slider%stiffness'])
        for point in boundary:
            kappa, stiffness = (float(point[key]) for key in list(point)[:2])
            _, weakening, c, b = Subloading.terms(kappa, 10.0, 1.0)
            self.assert_near(0.01 * c + 0.01 * stiffness / b / (1e-3 * b * c + 0.01), weakening)

    @needs_gnuplot
    def test_the_picture_is_drawn(self):
        lonely = {('sweep', 'key'): "'drive%velocity'", ('sweep', 'values'): '1', ('sweep', 'key2'): "'slider%stiffness'",
                  ('sweep', 'values2'): '0.5, 1, 2'}
        # disturbances grow at a frequency of 3, beyond the values of both keys
        slow = {**lonely, ('sweep', 'values'): '1, 1.01', ('sweep', 'values2'): '6, 6.1', ('slider', 'damping'): '0'}
        for change in ({}, {('sweep', 'key'): "'slider%mass'", ('sweep', 'values'): '1e-3, 1e-1'}, {('friction', 'mu_k'): '0.4'},
                       lonely, slow):
            result = self.run_text(namelist(change), verb='stability')
            self.assertEqual((result.returncode, result.stderr), (0, ''))
            for ending in ('png', 'svg', 'gp'):
                self.assertGreater((self.folder / f'case_out/case_stability.{ending}').stat().st_size, 1000)

    def test_what_has_no_boundary_has_no_map(self):
        result = self.run_text(namelist({('sweep', 'key'): "'time%dt'", ('sweep', 'values'): '1e-3, 1e-4'}), '--no-plot', verb='stability')
        self.assertEqual(result.returncode, 0)
        self.assertIn('does not depend on time%dt', result.stderr)


if __name__ == '__main__':
    unittest.main()
