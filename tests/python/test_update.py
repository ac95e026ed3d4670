"""stickslip.update and stickslip.laws, from the installed package."""
import copy
import dataclasses
import math
import pathlib
import pickle
import pydoc
import sys
import threading
import unittest

import numpy as np

import stickslip

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))

import law_examples  # noqa: E402

CONSTANTS = law_examples.constants_by_law()


def example(name):
    """A law with the constants that have no default."""
    made = stickslip.laws.classes[name]
    needed = {field.name for field in dataclasses.fields(made) if field.init and field.default is dataclasses.MISSING}
    return made(**{key: value for key, value in {**CONSTANTS['every'], **CONSTANTS[name]}.items() if key in needed})


LAWS = {name: example(name) for name in stickslip.laws.classes}


def motions(n, ndir, seed=1):
    """Increments that press the points on the base and shear them, some of them into sliding."""
    draw = np.random.default_rng(seed)
    return np.column_stack([np.full(n, -0.01), draw.normal(scale=3e-3, size=(n, ndir - 1))])


class Update(unittest.TestCase):
    def test_first_lines_of_a_newcomer(self):
        result = stickslip.update([-0.01, 0.001], 0.1, LAWS['coulomb'])
        np.testing.assert_allclose(result.traction, [-10, 0.8], rtol=1e-14)    # sticks: alpha_n u_n, alpha_t u_t
        np.testing.assert_allclose(result.tangent, [[1000, 0], [0, 800]], rtol=1e-14)
        self.assertEqual(result.status, 0)
        result = stickslip.update([0, 0.1], 0.1, LAWS['coulomb'], result.state)
        np.testing.assert_allclose(result.traction, [-10, 4], rtol=1e-14)      # slides: mu p
        np.testing.assert_allclose(result.tangent, [[1000, 0], [-400, 0]], rtol=1e-14, atol=1e-9)

    def test_every_layout_gives_the_same(self):
        for name, law in LAWS.items():
            for ndir in (2, 3):
                du = motions(140, ndir)
                results = {}
                start = stickslip.update(motions(140, ndir, 2), 0.1, law).state
                for order in 'CF':
                    results[order] = stickslip.update(np.array(du, order=order), 0.1, law, start)
                every_other = np.repeat(du, 2, axis=0)[::2]
                results['strided'] = stickslip.update(every_other, 0.1, law, start)
                results['list'] = stickslip.update(du.tolist(), 0.1, law, start.tolist())
                for kind, result in results.items():
                    for i in range(len(du)):
                        one = stickslip.update(du[i], 0.1, law, start[i])
                        for a, b in zip(one, result):
                            np.testing.assert_allclose(a, b[i], rtol=1e-12, atol=1e-12 * np.abs(a).max(),
                                                       err_msg=f'{name} {kind} {ndir}')
                    self.assertEqual(result.traction.flags.f_contiguous, kind == 'F')

    def test_the_tangent_is_the_derivative_of_the_traction(self):
        """Within the error of central differences, for the roots sought here 1e-6 of the stiffness."""
        step = 1e-8
        for name, law in LAWS.items():
            du = motions(50, 3)
            result = stickslip.update(du, 0.1, law)
            for j in range(3):
                ahead, behind = du.copy(), du.copy()
                ahead[:, j] += step
                behind[:, j] -= step
                slope = (stickslip.update(ahead, 0.1, law).traction - stickslip.update(behind, 0.1, law).traction) / (2 * step)
                self.assertLess(abs(slope - result.tangent[:, :, j]).max(), 1e-3, name)

    def test_the_state_given_is_left_alone_unless_it_is_asked_for(self):
        law, du = LAWS['subloading'], motions(10, 3)
        start = stickslip.update(du, 0.1, law).state
        kept = start.copy()
        after = stickslip.update(du, 0.1, law, start)
        np.testing.assert_array_equal(start, kept)
        self.assertFalse(np.array_equal(after.state, kept))
        place = stickslip.Result(np.empty((10, 3)), np.empty((10, 3, 3)), start, np.empty(10, np.int32))
        again = stickslip.update(du, 0.1, law, start, out=place)
        self.assertIs(again.state, start)
        np.testing.assert_array_equal(start, after.state)
        one = stickslip.update(du[0], 0.1, law)
        other = stickslip.update(du[0], 0.1, law, one.state, out=one)
        self.assertIs(other.state, one.state)

    def test_a_bad_point_is_told_and_harms_no_other(self):
        law = LAWS['subloading']
        for order in 'CF':
            du = np.array(motions(5, 3), order=order)
            good = stickslip.update(du, 0.1, law)
            du[3, 1] = np.nan
            bad = stickslip.update(du, 0.1, law)
            self.assertEqual(bad.status.tolist(), [0, 0, 0, -4, 0])
            self.assertTrue(np.isnan(bad.traction[3]).all() and np.isnan(bad.tangent[3]).all())
            self.assertEqual(bad.state[3].tolist(), 8 * [0.0])
            np.testing.assert_array_equal(np.delete(bad.tangent, 3, 0), np.delete(good.tangent, 3, 0))
        one = stickslip.update([np.nan, 0.0], 0.1, law)
        self.assertEqual(one.status, -4)
        self.assertTrue(np.isnan(one.traction).all())
        self.assertIn('not finite', stickslip.message(one.status))

    def test_no_points_are_no_fault(self):
        self.assertEqual(stickslip.update(np.empty((0, 3)), 0.1, LAWS['coulomb']).traction.shape, (0, 3))

    def test_wrong_shapes_are_told(self):
        law = LAWS['coulomb']
        for du, state in (([1.0], None), ([[1.0] * 4], None), (np.zeros((2, 2, 2)), None), ([0.0, 0.0], np.zeros(7)),
                          (np.zeros((4, 3)), np.zeros((3, 8))), (np.zeros((4, 3)), np.zeros((4, 9)))):
            with self.assertRaises(ValueError):
                stickslip.update(du, 0.1, law, state)
        other = stickslip.update(np.zeros((4, 3)), 0.1, law)
        with self.assertRaisesRegex(ValueError, 'out.traction'):
            stickslip.update(np.zeros((5, 3)), 0.1, law, out=other)
        with self.assertRaises(TypeError):
            stickslip.update([0.0, 0.0], 'long', law)

    def test_masked_numbers_are_missing_and_other_things_are_no_numbers(self):
        law, du = LAWS['subloading'], motions(6, 3)
        hidden = np.zeros((6, 3), bool)
        hidden[2, 1] = hidden[4, 0] = True
        masked, plain = np.ma.array(du, mask=hidden), stickslip.update(du, 0.1, law)
        found = stickslip.update(masked, 0.1, law)
        self.assertEqual(list(np.flatnonzero(found.status)), [2, 4])
        np.testing.assert_array_equal(found.state[[0, 1, 3, 5]], plain.state[[0, 1, 3, 5]])
        self.assertLess(stickslip.update(masked[2], 0.1, law).status, 0)
        state = np.ma.array(plain.state, mask=False)
        state[1, 4] = np.ma.masked
        self.assertEqual(list(np.flatnonzero(stickslip.update(du, 0.1, law, state).status)), [1])
        self.assertLess(stickslip.update(du[1], 0.1, law, state[1]).status, 0)
        self.assertLess(stickslip.rates(du[1], law, state[1]).status, 0)
        self.assertLess(stickslip.slip_rates(np.ma.array([1.0], mask=[True]), 1.0, LAWS['rate_and_state'], 1.0).status[0], 0)
        with self.assertRaisesRegex(ValueError, 'point 1: mu_s = nan: must be finite'):
            law.at_points(mu_s=np.ma.array([0.5, 0.6], mask=[False, True]))
        for values, words in ((du + 0j, 'du: numbers are needed, not complex'), ([['a', 'b']], 'du: numbers are needed .could not'),
                              (du.astype('timedelta64[s]'), 'du: numbers are needed, not dates')):
            with self.assertRaisesRegex(TypeError, words):
                stickslip.update(values, 0.1, law)
        with self.assertRaisesRegex(ValueError, 'du: has a number that is larger'):
            stickslip.update([10**400, 0.0], 0.1, law)
        self.assertEqual(stickslip.message(np.int32(-2)), stickslip.message(-2))
        for status in (None, 'x', 0.5, [1]):
            with self.assertRaisesRegex(TypeError, 'status = .*: a whole number is needed'):
                stickslip.message(status)

    def test_what_is_no_law_or_fits_nowhere_is_told(self):
        law, one, many = LAWS['coulomb'], np.array([-0.01, 0.1]), motions(3, 2)
        points, none = law.at_points(mu=[0.1, 0.2, 0.3]), 'an object of stickslip.laws'
        for bad in (None, 3, stickslip.laws.Coulomb):
            for call in (lambda: stickslip.update(one, 0.1, bad), lambda: stickslip.update(many, 0.1, bad),
                         lambda: stickslip.rates(one, bad, np.zeros(8)), lambda: stickslip.slip_rates([1.0], [1.0], bad, [1.0])):
                with self.assertRaisesRegex(TypeError, none):
                    call()
        with self.assertRaisesRegex(TypeError, 'the same at all points'):
            stickslip.rates(many, points, np.zeros((3, 8)))
        for du in (one, many):
            for dt in ('soon', '0.1', None, [0.1], np.array([0.1, 0.1]), 1j):
                with self.assertRaisesRegex(TypeError, '(?s)dt = .*: a number is needed'):
                    stickslip.update(du, dt, law)
            with self.assertRaisesRegex(ValueError, 'dt: must be finite'):
                stickslip.update(du, 10**400, law)
            for state in (3, 'rest', [0.0, [1.0, 2.0]], '12345678', {'mu': 0.5}):
                with self.assertRaisesRegex((TypeError, ValueError), '^state'):
                    stickslip.update(du, 0.1, law, state)
        with self.assertRaisesRegex(ValueError, '^du: numbers in rows of one length'):
            stickslip.update([[0.0, 1.0], [2.0]], 0.1, law)
        with self.assertRaisesRegex(TypeError, 'damping = .*: a number is needed'):
            stickslip.slip_rates(1.0, 1.0, LAWS['rate_and_state'], 1.0, damping=[1.0, 2.0])
        with self.assertRaisesRegex(ValueError, 'Coulomb: alpha_n is larger than the largest number'):
            stickslip.laws.Coulomb(alpha_n=10**400, alpha_t=1, mu=0.4)

    def test_results_to_write_again_are_results_of_that_shape(self):
        law, one, many = LAWS['coulomb'], np.array([-0.01, 0.1]), motions(3, 2)
        for du, other in ((one, many), (many, one)):
            good = stickslip.update(du, 0.1, law)
            for out, words in ((stickslip.update(other, 0.1, law), 'out.traction: an array of shape'), (tuple(good), 'out: an earlier'),
                               (good._replace(state=good.state.astype(int)), 'out.state: an array of shape .* float64'),
                               (good._replace(tangent=good.tangent.tolist()), 'out.tangent: an array is needed')):
                with self.assertRaisesRegex((TypeError, ValueError), words):
                    stickslip.update(du, 0.1, law, out=out)

    def test_arrays_that_share_memory_give_no_wrong_numbers(self):
        for law in (LAWS['coulomb'], LAWS['coulomb'].at_points(mu=[0.1, 0.2, 0.3])):
            plain = stickslip.update(motions(3, 2), 0.1, law)
            memory = np.zeros(60)
            shared = plain._replace(traction=memory[:6].reshape(3, 2), tangent=memory[4:16].reshape(3, 2, 2))
            with self.assertRaisesRegex(ValueError, 'out.traction and out.tangent share memory'):
                stickslip.update(motions(3, 2), 0.1, law, out=shared)
            for name, size in (('traction', 6), ('tangent', 12), ('state', 24)):   # of the result, where the increments are
                for first in (0, 1, 3):
                    memory = np.zeros(60)
                    du = memory[first:first + 6].reshape(3, 2)
                    du[...] = motions(3, 2)
                    out = stickslip.update(motions(3, 2), 0.1, law)
                    out = out._replace(**{name: memory[:size].reshape(getattr(out, name).shape)})
                    found = stickslip.update(du, 0.1, law, out=out)
                    for array, right in zip(found, plain):
                        np.testing.assert_array_equal(array, right)

    def test_threads_do_not_meet(self):
        law, du = LAWS['subloading'], motions(5000, 3)
        right = stickslip.update(du, 0.1, law)
        results = [None] * 4
        def work(k):
            results[k] = stickslip.update(du, 0.1, law)
        threads = [threading.Thread(target=work, args=(k,)) for k in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for result in results:
            np.testing.assert_array_equal(result.tangent, right.tangent)


class AtPoints(unittest.TestCase):
    """Constants of their own at each point: the same as one point after the other."""

    def laws_of(self, n):
        """Every law, with constants that vary; of some also what their own defaults follow from."""
        draw = np.random.default_rng(5)
        return [(law, {field.name: getattr(law, field.name) * draw.uniform(0.98, 1.02, n) for field in dataclasses.fields(law)
                       if field.init and field.default is dataclasses.MISSING}) for law in LAWS.values()]

    def test_each_point_is_as_if_it_were_alone(self):
        n = 150
        for law, constants in self.laws_of(n):
            points = law.at_points(**constants)
            self.assertEqual(len(points), n)
            alone = [dataclasses.replace(law, **{name: values[i] for name, values in constants.items()}) for i in range(n)]
            np.testing.assert_array_equal(points.props.T, [each.props for each in alone])
            for ndir in (2, 3):
                for order in 'CF':
                    first, then = (np.array(motions(n, ndir, seed), order=order) for seed in (1, 2))
                    start = stickslip.update(first, 0.1, points)
                    result = stickslip.update(then, 0.1, points, start.state)
                    self.assertEqual(result.traction.flags.f_contiguous, order == 'F')
                    for i in range(n):
                        one = stickslip.update(then[i], 0.1, alone[i], stickslip.update(first[i], 0.1, alone[i]).state)
                        for a, b in zip(one, result):
                            np.testing.assert_allclose(a, b[i], rtol=1e-11, atol=1e-11 * np.abs(a).max(), err_msg=str(alone[i]))
                    again = stickslip.update(then, 0.1, points, start.state, out=start)
                    self.assertIs(again.tangent, start.tangent)
                    np.testing.assert_array_equal(again.tangent, result.tangent)

    def test_bad_points_and_constants_are_told(self):
        law = LAWS['subloading']
        mu_s = np.array([0.4, 0.5, 0.2, 0.1])
        with self.assertRaisesRegex(ValueError, 'Subloading, point 2: .*mu_k'):
            law.at_points(mu_s=mu_s)
        points = law.at_points(mu_s=mu_s + 0.3)
        for order in 'CF':
            du = np.array(motions(4, 3), order=order)
            du[1, 0] = np.inf
            bad = stickslip.update(du, 0.1, points)
            self.assertEqual(bad.status.tolist(), [0, -4, 0, 0])
            self.assertTrue(np.isnan(bad.traction[1]).all() and np.isfinite(bad.traction[[0, 2, 3]]).all())
        with self.assertRaisesRegex(ValueError, 'constants of 4 points, du of 5'):
            stickslip.update(motions(5, 3), 0.1, points)
        with self.assertRaisesRegex(ValueError, 'du needs the shape'):
            stickslip.update([0.0, 0.0], 0.1, points)
        for constants, words in (({'mu_s': mu_s, 'kappa': [1, 2]}, 'one number a point'), ({}, 'one number a point'),
                                 ({'mu_s': 0.3}, 'one number a point'), ({'scheme': [0, 1]}, 'a choice')):
            with self.assertRaisesRegex(ValueError, words):
                law.at_points(**constants)
        with self.assertRaisesRegex(TypeError, 'no constant mu'):
            law.at_points(mu=[0.3])


class Rates(unittest.TestCase):
    LAW = stickslip.laws.RateAndState(alpha_n=1, alpha_t=1, a=0.01, b=0.015, d_c=0.01, v0=1e-3, f0=0.6)

    def strength(self, rate, theta, pressure, a=0.01):
        """a p asinh(V/(2 v0) exp((f0 + b ln(v0 theta/d_c))/a))."""
        return a * pressure * np.arcsinh(rate / 2e-3 * np.exp((0.6 + 0.015 * np.log(0.1 * theta)) / a))

    def test_slip_rates_balance_the_traction(self):
        draw = np.random.default_rng(2)
        theta, pressure = 10.0 ** draw.uniform(-1, 3, (40, 50)), draw.uniform(1, 9, 50)
        tau = 0.6 * pressure * draw.uniform(0.9, 1.1, (40, 50))
        found = stickslip.slip_rates(tau, pressure, self.LAW, theta, damping=0.3)
        self.assertEqual(found.rate.shape, (40, 50))
        self.assertEqual(found.status.max(), 0)
        np.testing.assert_allclose(self.strength(found.rate, theta, pressure) + 0.3 * found.rate, tau, rtol=1e-10)
        np.testing.assert_allclose(found.theta_rate, 1 - found.rate * theta / 0.01, rtol=1e-9, atol=1e-9)

    def test_slip_rates_with_constants_of_each_point(self):
        a = np.linspace(0.008, 0.02, 300)
        found = stickslip.slip_rates(3.0, 5.0, self.LAW.at_points(a=a), 10.0)
        np.testing.assert_allclose(self.strength(found.rate, 10.0, 5.0, a), 3.0, rtol=1e-10)
        with self.assertRaisesRegex(ValueError, 'constants of 300 points'):
            stickslip.slip_rates(np.ones((2, 300)), 5.0, self.LAW.at_points(a=a), 10.0)

    def test_bad_slip_rates_are_told(self):
        found = stickslip.slip_rates([3.0, -1.0, 3.0], 5.0, self.LAW, 10.0)
        self.assertEqual((found.status < 0).tolist(), [False, True, False])
        self.assertEqual(np.isnan(found.rate).tolist(), [False, True, False])
        self.assertEqual(stickslip.slip_rates(3.0, 5.0, LAWS['coulomb'], 1.0).status, -2)
        with self.assertRaises(ValueError):
            stickslip.slip_rates([1.0, 2.0], [1.0, 2.0, 3.0], self.LAW, 1.0)

    def test_rates_are_what_short_updates_tend_to(self):
        """Differences over dt: their error is of its order."""
        dt = 1e-7
        velocity = np.array([0.0, 0.02, 0.01])
        for name in ('subloading', 'rate_and_state'):
            law = LAWS[name]
            state = stickslip.update([-0.01, 0.004, 0.001], 0.1, law).state
            found = stickslip.rates(velocity, law, state)
            self.assertEqual(found.status, 0)
            after = stickslip.update(velocity * dt, dt, law, state).state
            slope = (after - state)[1:] / dt
            np.testing.assert_allclose(found.rates[1:], slope, rtol=1e-3, atol=1e-4 * np.abs(slope).max(), err_msg=name)

    def test_rates_of_many_points_and_bad_ones(self):
        law = LAWS['subloading']
        state = stickslip.update(motions(5, 2), 0.1, law).state
        velocity = np.tile([0.0, 0.01], (5, 1))
        velocity[3] = np.nan
        found = stickslip.rates(velocity, law, state)
        self.assertEqual((found.status < 0).tolist(), [False, False, False, True, False])
        self.assertTrue(np.isnan(found.rates[3]).all())
        np.testing.assert_array_equal(found.rates[4], stickslip.rates(velocity[4], law, state[4]).rates)
        for velocity, state, shape in (([0.0], np.zeros(8), r'\(1,\)'), ([0.0, 1.0], np.zeros(7), r'\(7,\)'),
                                       (np.zeros((3, 2)), np.zeros((2, 8)), r'\(2, 8\)'), (1.0, np.zeros(8), r'\(\)')):
            with self.assertRaisesRegex(ValueError, f'has the shape {shape}: '):
                stickslip.rates(velocity, law, state)


class Laws(unittest.TestCase):
    def test_every_law_of_the_library_has_a_class_that_tells_its_constants(self):
        self.assertEqual([law.number for law in LAWS.values()], list(range(1, 1 + stickslip._library.law_count())))
        for name, made in stickslip.laws.classes.items():
            self.assertEqual(made.__name__.lower(), name.replace('_', ''))
            self.assertIs(getattr(stickslip.laws, made.__name__), made)
            self.assertIn(made.__name__, stickslip.laws.__all__)
            constants = stickslip._library.constants_of(made.number)
            self.assertEqual([constant.name for constant in constants],
                             [field.name for field in dataclasses.fields(made) if field.init], name)
            described = pydoc.plain(pydoc.render_doc(made))
            for constant in constants:
                self.assertIn(f'{constant.name}: {constant.meaning}', described)

    def test_defaults_are_the_library_s(self):
        self.assertEqual(LAWS['subloading'].props[8], 0.45)      # mu_0 = mu_s
        self.assertEqual(LAWS['rate_and_state'].props[9], 1)     # theta_0 = d_c/v0
        law = LAWS['subloading']
        self.assertEqual((law.mu_0, law.scheme, law.tau_max, law.mu_ratio, law.direction), (None, 'backward_euler', 0, 1, 'associated'))
        self.assertEqual(stickslip.laws.FlashHeating(**{**CONSTANTS['every'], **CONSTANTS['flash_heating'], 'direction': 1}).n, 6)
        self.assertEqual(LAWS['flash_heating'].n, 8)

    def slid(self, law, rate, slip, steps, state):
        """After sliding at a rate, on a contact that is next to rigid."""
        for _ in range(steps):
            result = stickslip.update([0.0, slip / steps], slip / steps / rate, law, state)
            state = result.state
        return state

    def test_slip_weakening_that_heals_recovers_at_rest(self):
        law = dataclasses.replace(LAWS['slip_weakening_healing'], alpha_t=1e9)
        state = stickslip.update([-0.01, 0.0], 0.1, law).state
        state = self.slid(law, 1.0, 0.015, 50, state)
        weak = state[4]
        self.assertLess(weak, law.mu_s - 0.4 * (law.mu_s - law.mu_k))
        state = stickslip.update([0.0, 0.0], 0.7, law, state).state
        self.assertAlmostEqual(state[4], law.mu_s - (law.mu_s - weak) * math.exp(-0.7 * law.xi), delta=1e-12)

    def test_flash_heating_weakens_in_fast_sliding(self):
        law = dataclasses.replace(LAWS['flash_heating'], alpha_t=1e9, f_w=0.1)
        start = stickslip.update([-0.01, 0.0], 0.1, law).state
        for rate in (1e-3, 0.5, 20.0):
            low = law.a * math.asinh(rate / (2 * law.v0) * math.exp((law.f0 - law.b * math.log(rate / law.v0)) / law.a))
            steady = law.f_w + (low - law.f_w) / (1 + (rate / law.v_w)**law.n)**(1 / law.n)
            self.assertAlmostEqual(self.slid(law, rate, 40 * law.d_c, 400, start)[4], steady, delta=2e-6)

    def test_linker_dieterich_s_friction_falls_as_the_pressure_rises(self):
        law = dataclasses.replace(LAWS['linker_dieterich'], alpha_t=1e13)
        state = stickslip.update([-0.01, 0.0], 0.1, law).state
        state = self.slid(law, law.v0, 30 * law.d_c, 300, state)
        self.assertAlmostEqual(state[4], law.f0, delta=1e-8)
        step = 1e-6 * law.d_c
        stepped = stickslip.update([-0.005, step], step / law.v0, law, state).state
        self.assertAlmostEqual(stepped[4], law.f0 - law.alpha * math.log(1.5), delta=1e-6)
        self.assertAlmostEqual(self.slid(law, law.v0, 30 * law.d_c, 300, stepped)[4], law.f0, delta=1e-8)

    def test_bad_constants_are_refused_in_the_library_s_words(self):
        make = stickslip.laws.Subloading
        good = {'alpha_n': 1, 'alpha_t': 1, 'mu_s': 0.4, 'mu_k': 0.2, 'kappa': 1, 'xi': 1, 'm': 1}
        make(**good)
        for bad in ({'mu_k': 0.5}, {'alpha_n': 0}, {'m': -1}, {'mu_0': 0.1}, {'tau_max': -1},
                    {'scheme': 'exact_rate', 'u_of_r': 'cotangent'}):
            with self.assertRaisesRegex(ValueError, 'Subloading: .*' + next(reversed(bad))):
                make(**{**good, **bad})
        with self.assertRaisesRegex(ValueError, 'Subloading: .*finite'):
            make(**{**good, 'xi': float('nan')})
        with self.assertRaisesRegex(ValueError, 'backward_euler, exact_rate'):
            make(**good, scheme='exact')
        for bad in ('0.4', None, [1], True):
            with self.assertRaises(TypeError):
                make(**{**good, 'mu_s': bad})

    def test_laws_are_values(self):
        law = LAWS['subloading']
        self.assertEqual(law, dataclasses.replace(law))
        self.assertNotEqual(law, dataclasses.replace(law, m=61))
        with self.assertRaises(dataclasses.FrozenInstanceError):
            law.m = 3
        with self.assertRaises(ValueError):
            law.props[3] = 3
        self.assertEqual(hash(law), hash(dataclasses.replace(law)))
        given = np.array(0.3)
        law = dataclasses.replace(LAWS['coulomb'], mu=given)   # keeps no array that the caller may change
        given[...] = 0.9
        self.assertEqual((law.mu, hash(law)), (0.3, hash(dataclasses.replace(law, mu=0.3))))
        self.assertNotEqual(dataclasses.replace(law, mu=np.float32(0.3)), law)   # which is 0.30000001

    def test_laws_are_pickled_and_copied(self):
        """Processes and caches do that; a pointer of another process would be rubbish."""
        for law in LAWS.values():
            for other in (pickle.loads(pickle.dumps(law)), copy.deepcopy(law), copy.copy(law)):
                self.assertEqual(other, law)
                np.testing.assert_array_equal(stickslip.update([-0.01, 0.1], 0.1, other).state,
                                              stickslip.update([-0.01, 0.1], 0.1, law).state)
            points = law.at_points(alpha_t=[1.0, 2.0])
            for other in (pickle.loads(pickle.dumps(points)), copy.deepcopy(points)):
                np.testing.assert_array_equal(other.props, points.props)
                self.assertFalse(other.props.flags.writeable)

    def test_choices_are_given_by_word_or_number(self):
        by_number, by_word = (dataclasses.replace(LAWS['subloading'], u_of_r=choice) for choice in (1, 'cotangent'))
        self.assertEqual(by_number, by_word)
        self.assertEqual(by_number.constants()['u_of_r'], 'cotangent')   # which the program takes
        with self.assertRaisesRegex(ValueError, 'u_of_r must be 0'):
            dataclasses.replace(LAWS['subloading'], u_of_r=1.5)

    def test_a_constant_that_is_no_number_is_named(self):
        for value, words in ((math.nan, 'mu = nan: must be finite'), (math.inf, 'mu = inf: must be finite')):
            with self.assertRaisesRegex(ValueError, words):
                dataclasses.replace(LAWS['coulomb'], mu=value)
        with self.assertRaisesRegex(ValueError, 'point 1: mu = nan'):
            LAWS['coulomb'].at_points(mu=[0.1, math.nan])
        with self.assertRaisesRegex(TypeError, 'not a number'):
            dataclasses.replace(LAWS['coulomb'], mu=np.bool_(True))

    def test_options_reach_the_library(self):
        capped = stickslip.laws.Coulomb(alpha_n=1000, alpha_t=800, mu=0.3, tau_max=1.5)
        np.testing.assert_allclose(stickslip.update([-0.01, 0.1], 0.1, capped).traction, [-10, 1.5], rtol=1e-14)
        wide = stickslip.laws.Coulomb(alpha_n=1000, alpha_t=800, mu=0.3, mu_ratio=2, direction='radial')
        np.testing.assert_allclose(stickslip.update([-0.01, 0, 0.1], 0.1, wide).traction, [-10, 0, 6], rtol=1e-14)


if __name__ == '__main__':
    unittest.main()
