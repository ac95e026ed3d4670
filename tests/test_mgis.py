"""libstickslip_mgis.so as an MFront host sees it, through a loader of our own (hosts/mfront_loader.py), against
`friction_update`. The loader is tried first on a behaviour that MFront itself made, where OpenGeoSys is installed.

STICKSLIP_LIBRARY, STICKSLIP_MGIS: the shared libraries.
"""
import ctypes
import ctypes.util
import importlib.util
import itertools
import math
import os
import pathlib
import re
import subprocess
import sys
import unittest

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE / 'hosts')]

import friction_point  # noqa: E402
import law_examples  # noqa: E402
import mfront_loader  # noqa: E402
from worst_errors import worst_of  # noqa: E402

MGIS = os.environ['STICKSLIP_MGIS']
DOCS = HERE.parent / 'docs'
ROOT2 = math.sqrt(2.0)
STIFFNESSES = ['NormalStiffness', 'TangentialStiffness']
LAYER = ['Thickness', 'InPlaneModulus']
THICKNESS, MODULUS = 0.1, 3.0
STATE = ['Status', 'NormalGap', 'ElasticShear1', 'ElasticShear2', 'FrictionCoefficient', 'Internal', 'Slip', 'DissipatedEnergy']
LAWS = {law.camel: law for law in law_examples.laws().values()}
OPTIONS = ('tau_max', 'mu_ratio', 'direction', 'cohesion', 'eta_t')
PLANE = ['Axisymmetrical', 'PlaneStress', 'PlaneStrain', 'GeneralisedPlaneStrain']
# pressed, sheared, reversed, held, lifted, closed, sheared: total gap, normal first
GAPS = [(-0.003, 0, 0), (-0.003, 3e-4, 1e-4), (-0.002, 1.2e-3, 4e-4), (-0.003, 3e-3, -2e-4), (-0.003, 2.5e-3, 1e-4),
        (-0.003, 1e-3, 2e-3), (-0.003, 1e-3, 2e-3), (0.002, 1e-3, 2e-3), (0.001, 2e-3, 2e-3), (-0.004, 3e-3, 1e-3),
        (-0.004, 5e-3, 3e-3)]


def promised_names(law):
    """Names of the constants after the stiffnesses, and how many of them have no default: the page of the laws and that
    of the options say so."""
    names, needed = [], 0
    for page, title in (('laws', rf'## {LAWS[law].number} [^\n]*'), ('law_options', '## Places and names')):
        text = re.search(rf'^{title}\n(.*?)(?=^## |\Z)', (DOCS / f'{page}.md').read_text(), re.MULTILINE | re.DOTALL).group(1)
        rows = re.findall(r'^\| ([^|]*) \|.*\| `([A-Za-z]+)` \|$', text, re.MULTILINE)
        names += [name for _, name in rows]
        needed += sum('optional' not in place for place, _ in rows) if page == 'laws' else 0
    return names, needed


def behaviour(law, hypothesis, layer=False, options=False):
    return mfront_loader.Behaviour(MGIS, f'StickSlip{law}' + ('Layer' if layer else '') + ('WithOptions' if options else ''),
                                   hypothesis)


def props_of(law, options=False):
    return LAWS[law].props(*(OPTIONS if options else ()))


def properties(law, layer=False, options=False, **changed):
    values = dict(zip(behaviour(law, 'PlaneStrain', options=options).properties, props_of(law, options)[1:]))
    if layer:
        values.update(Thickness=THICKNESS, InPlaneModulus=MODULUS)
    return {**values, **changed}


def places(hypothesis):
    """Of the contact's components in a layer's strain: normal, tangential."""
    return [2, 4, 5] if hypothesis == 'Tridimensional' else [1, 3]


def strain_of(gap, hypothesis):
    """A strain that makes this gap, and one in the plane of the layer."""
    strain = [1e-4, 0.0, 2e-4, 0.0, 0.0, 0.0] if hypothesis != 'Tridimensional' else [1e-4, 2e-4, 0.0, 3e-4, 0.0, 0.0]
    strain = strain[:6 if hypothesis == 'Tridimensional' else 4]
    for i, (place, value) in enumerate(zip(places(hypothesis), gap)):
        strain[place] = value / THICKNESS / (ROOT2 if i else 1)
    return strain


class Mgis(unittest.TestCase):
    def near(self, found, expected, scale):
        self.assertLessEqual(worst_of(abs(a - b) for a, b in zip(found, expected)), 1e-12 * scale)

    def test_the_loader_reads_a_behaviour_that_mfront_made(self):
        ogs = importlib.util.find_spec('ogs')
        if ogs is None:
            self.skipTest('OpenGeoSys is not installed: ./dev hosts installs it')
        library = next(pathlib.Path(ogs.origin).parent.parent.rglob('libOgsMFrontBehaviour.so'))
        brick = mfront_loader.Behaviour(library, 'StandardElasticityBrick', 'Tridimensional')
        self.assertEqual((brick.type, brick.kinematic, brick.gradients, brick.blocks),
                         (1, 1, [('Strain', 1)], [('Stress', 'Strain')]))
        young, poisson, strain = 200e3, 0.3, 1e-3
        result = brick.integrate([0] * 6, [strain, 0, 0, 0, 0, 0], {'YoungModulus': young, 'PoissonRatio': poisson},
                                 [0.0] * brick.state_size, 1.0)
        lame, shear = young * poisson / (1 + poisson) / (1 - 2 * poisson), young / 2 / (1 + poisson)
        self.assertEqual(result.code, 1, result.message)
        self.near(result.forces, [(lame + 2 * shear) * strain, lame * strain, lame * strain, 0, 0, 0], young * strain)
        self.near(result.tangent[0], [lame + 2 * shear, lame, lame, 0, 0, 0], young)

    def test_names_and_kinds_are_those_promised(self):
        for law, options, layer in itertools.product(LAWS, (False, True), (False, True)):
            names, needed = promised_names(law)
            names = names if options else names[:needed]
            for hypothesis in PLANE + ['Tridimensional']:
                if layer and hypothesis == 'PlaneStress':
                    continue
                with self.subTest(law=law, layer=layer, options=options, hypothesis=hypothesis):
                    found = behaviour(law, hypothesis, layer, options)
                    self.assertEqual(found.properties, (LAYER if layer else []) + STIFFNESSES + names)
                    self.assertEqual([name for name, _ in found.variables], STATE)
                    self.assertEqual({kind for _, kind in found.variables}, {0})
                    self.assertEqual((found.external, found.parameters, found.energies), ([], [], (1, 1)))
                    gradient, force, code = ('Strain', 'Stress', 1) if layer else ('OpeningDisplacement', 'CohesiveForce', 2)
                    self.assertEqual((found.gradients, found.forces, found.blocks),
                                     ([(gradient, code)], [(force, code)], [(force, gradient)]))
                    self.assertEqual((found.type, found.kinematic), (1, 1) if layer else (3, 2))
                    self.assertIn(hypothesis, found.names('ModellingHypotheses'))
                    self.assertEqual(found.text('mfront_ept'), found.name)
                    self.assertEqual(found.text('mfront_interface'), 'Generic')

    def follow(self, law, hypothesis, options):
        """Along the path, cohesive zone and layer against friction_update, point by point."""
        n = mfront_loader.DIMENSION[hypothesis]
        zone = behaviour(law, hypothesis, options=options)
        layer = None if hypothesis == 'PlaneStress' else behaviour(law, hypothesis, True, options)
        point = friction_point.FrictionPoint(props_of(law, options))
        states, old = [[0.0] * 8, [0.0] * 8], [0.0] * n
        for gap in ([component for component in gap[:n]] for gap in GAPS):
            traction = point.update([a - b for a, b in zip(gap, old)], 0.1)
            tangent = point.tangent
            result = zone.integrate(old, gap, properties(law, options=options), states[0], 0.1)
            self.assertEqual(result.code, 1, result.message)
            self.near(result.forces, traction, 3.0)
            self.near(result.state, list(point.statev), 1.0)
            for i in range(n):   # row by row here, column by column there
                self.near(result.tangent[i], [tangent[j * n + i] for j in range(n)], 1000.0)
            elastic = 0.5 * (1000 * min(point.statev[1], 0)**2 + 800 * (point.statev[2]**2 + point.statev[3]**2))
            self.near(result.energies, [elastic, point.statev[7]], 1.0)
            states[0] = result.state
            if layer is not None:
                states[1] = self.compare_layer(layer, (law, options), (old, gap), states[1], (traction, tangent, elastic, point))
            old = gap

    def compare_layer(self, layer, law, gaps, state, expected):
        traction, tangent, elastic, point = expected
        start, end = (strain_of(gap, layer.hypothesis) for gap in gaps)
        result = layer.integrate(start, end, properties(law[0], True, law[1]), state, 0.1)
        self.assertEqual(result.code, 1, result.message)
        at, n = places(layer.hypothesis), len(traction)
        factor = [1.0] + [ROOT2] * (n - 1)
        stress = [MODULUS * component for component in end]
        operator = [[MODULUS if i == j else 0.0 for j in range(layer.size)] for i in range(layer.size)]
        for i in range(n):
            stress[at[i]] = factor[i] * traction[i]
            for j in range(n):
                operator[at[i]][at[j]] = factor[i] * factor[j] * THICKNESS * tangent[j * n + i]
        # the gap is made from a strain and back: its round-off passes through the stiffness
        self.assertLessEqual(worst_of(abs(a - b) for a, b in zip(result.forces, stress)), 1e-10)
        for row, expected_row in zip(result.tangent, operator):
            self.assertLessEqual(worst_of(abs(a - b) for a, b in zip(row, expected_row)), 1e-8)
        self.assertLessEqual(worst_of(abs(a - b) for a, b in zip(result.state, point.statev)), 1e-10)
        in_plane = 0.5 * MODULUS * sum(end[i]**2 for i in range(layer.size) if i not in at)
        self.near(result.energies, [elastic / THICKNESS + in_plane, point.statev[7] / THICKNESS], 10.0)
        return result.state

    def test_every_law_follows_friction_update_under_every_hypothesis(self):
        for law, options, hypothesis in itertools.product(LAWS, (False, True), PLANE + ['Tridimensional']):
            with self.subTest(law=law, options=options, hypothesis=hypothesis):
                self.follow(law, hypothesis, options)

    def test_the_operator_of_a_layer_is_the_derivative_of_its_stress(self):
        layer, constants = behaviour('Subloading', 'Tridimensional', layer=True), properties('Subloading', layer=True)
        state = layer.integrate([0.0] * 6, strain_of((-0.003, 0, 0), 'Tridimensional'), constants, [0.0] * 8, 0.1).state
        start, end = (strain_of(gap, 'Tridimensional') for gap in ((-0.003, 0, 0), (-0.0031, 2e-3, -1e-3)))
        result, step = layer.integrate(start, end, constants, state, 0.1), 1e-6
        for j in range(6):
            sides = []
            for sign in (1, -1):
                moved = list(end)
                moved[j] += sign * step
                sides.append(layer.integrate(start, moved, constants, state, 0.1).forces)
            for i in range(6):
                self.assertAlmostEqual(result.tangent[i][j], (sides[0][i] - sides[1][i]) / (2 * step), delta=1e-4)

    def test_the_energy_in_the_plane_of_a_layer_does_not_drown_in_its_slip(self):
        for hypothesis, in_plane in (('Tridimensional', [0, 1, 3]), ('PlaneStrain', [0, 2])):
            layer, strain = behaviour('Coulomb', hypothesis, layer=True), strain_of((1e-3, 0, 0), hypothesis)
            strain = [1e-9 if i in in_plane else 5.0 if i == places(hypothesis)[0] else 0.0 for i in range(len(strain))]
            result = layer.integrate([0.0] * layer.size, strain, properties('Coulomb', layer=True), [0.0] * 8, 0.1)
            expected = 0.5 * MODULUS * len(in_plane) * 1e-18   # the layer is open: nothing else is stored
            self.assertAlmostEqual(result.energies[0] / expected, 1.0, delta=1e-12)

    def test_a_prediction_integrates_nothing_and_a_virgin_point_predicts_its_springs(self):
        zone = behaviour('Coulomb', 'Tridimensional')
        for asked in (-1.0, -2.0, -3.0, 99.0):
            result = zone.integrate([0.0] * 3, [math.nan] * 3, properties('Coulomb'), [0.0] * 8, 0.1, asked=asked)
            self.assertEqual(result.code, 1)
            self.assertEqual(result.tangent, [[1000, 0, 0], [0, 800, 0], [0, 0, 800]])
            self.assertEqual(result.forces, [0.0] * 3)
            self.assertTrue(math.isnan(result.state[0]))
        open_point = zone.integrate([0.0] * 3, [1.0, 0.0, 0.0], properties('Coulomb'), [0.0] * 8, 0.1).state
        result = zone.integrate([1.0, 0, 0], [1.0, 0, 0], properties('Coulomb'), open_point, 0.1, asked=-3.0)
        self.assertEqual(result.tangent, [[0.0] * 3] * 3)

    def test_bodies_that_just_touch_are_held_by_the_springs(self):
        zone, springs = behaviour('Coulomb', 'PlaneStrain'), [[1000, 0], [0, 800]]
        at_rest = zone.integrate([0, 0], [0, 0], properties('Coulomb'), [0.0] * 8, 0.1)
        self.assertEqual((at_rest.forces, at_rest.tangent), ([0, 0], springs))
        for asked in (4.0, -3.0):   # in the increment after that, too
            again = zone.integrate([0, 0], [0, 0], properties('Coulomb'), at_rest.state, 0.1, asked=asked)
            self.assertEqual(again.tangent, springs)
        slid = zone.integrate([0, 0], [0, 1e-3], properties('Coulomb'), at_rest.state, 0.1)
        self.assertEqual(slid.tangent, [[0, 0], [0, 0]])

    def test_operators_and_speed_of_sound_as_asked_for(self):
        zone, sliding = behaviour('Coulomb', 'PlaneStrain'), [-1e-3, 1.0]
        for asked, expected in ((0.0, [0, 0]), (1.0, [0, 800]), (2.0, [0, 800]), (3.0, [-400, 0]), (4.0, [-400, 0])):
            result = zone.integrate([0, 0], sliding, properties('Coulomb'), [0.0] * 8, 0.1, asked=asked)
            self.near(result.tangent[1], expected, 1000.0)
            self.assertEqual(result.forces[0], -1.0)
        sound = []
        layer = behaviour('Coulomb', 'PlaneStrain', layer=True)
        result = layer.integrate([0.0] * 4, [0.0] * 4, properties('Coulomb', layer=True), [0.0] * 8, 0.1, asked=104.0,
                                 sound=sound)
        self.assertEqual(result.code, 1)
        self.assertAlmostEqual(sound[0], math.sqrt(THICKNESS * 1000))

    def test_bad_input_is_told_in_words_and_touches_nothing(self):
        zone, layer = behaviour('Subloading', 'PlaneStrain'), behaviour('Subloading', 'PlaneStrain', layer=True)
        cases = [(zone, properties('Subloading', StaticFriction=0.1), 0.1, '-3'),
                 (zone, properties('Subloading'), float('nan'), '-4'),
                 (behaviour('RateAndState', 'PlaneStrain'), properties('RateAndState'), 0.0, '-9')]
        cases += [(layer, properties('Subloading', layer=True, **{name: value}), 0.1, '-3')
                  for name, value in (('Thickness', 0.0), ('Thickness', float('nan')), ('Thickness', 1e-320),
                                      ('Thickness', 1e200), ('InPlaneModulus', -1.0), ('InPlaneModulus', 1e200))]
        for found, constants, dt, code in cases:
            moved = [-1e-3] * found.size
            result = found.integrate([0.0] * found.size, moved, constants, [0.0] * 8, dt)
            self.assertEqual((result.code, result.rdt), (-1, 0.1))
            self.assertIn(f'stickslip, code {code}: ', result.message)
            if code == '-3':
                self.assertRegex(result.message, ': (mu_s must be >= mu_k|Thickness must be > 0, .*)$')
            self.assertEqual(result.forces, [0.0] * found.size)
        for strain, modulus in ((float('nan'), 1.0), (1e160, 1.0), (1e160, 0.0), (1e90, 1e90)):
            constants = properties('Subloading', layer=True, InPlaneModulus=modulus)
            result = layer.integrate([0.0] * 4, [strain, 0, 0, 0], constants, [0.0] * 8, 0.1)
            self.assertIn('code -4', result.message)
            self.assertEqual(result.forces, [0.0] * 4)

    def test_forces_as_they_stand_need_no_time(self):
        zone, constants = behaviour('RateAndState', 'Tridimensional'), properties('RateAndState')
        moved = zone.integrate([0, 0, 0], [-1e-2, 2e-3, 1e-3], constants, [0.0] * 8, 0.1)
        quiet = zone.integrate([-1e-2, 2e-3, 1e-3], [-1e-2, 2e-3, 1e-3], constants, moved.state, 0.0)
        self.assertEqual(quiet.code, 1)
        self.near(quiet.forces, moved.forces, 10.0)
        springs = [[1000, 0, 0], [0, 800, 0], [0, 0, 800]]
        self.assertEqual(quiet.tangent, springs)
        predicted = zone.integrate([-1e-2, 2e-3, 1e-3], [math.nan] * 3, constants, moved.state, 0.1, asked=-3.0)
        self.assertEqual(predicted.tangent, springs)   # a prediction lets no time pass

    def test_what_is_no_number_raises_no_exception_in_the_host(self):
        arithmetic, serious = ctypes.CDLL(ctypes.util.find_library('m')), 1   # FE_INVALID of x86 and ARM
        layer, constants = behaviour('Coulomb', 'PlaneStrain', layer=True), properties('Coulomb', layer=True)
        nan, infinite = float('nan'), float('inf')
        cases = [({}, start, end) for start, end in itertools.product((nan, infinite, 0.0), (nan, infinite, 0.0)) if start or end]
        cases += [({name: nan}, 0.0, 0.0) for name in ('Thickness', 'InPlaneModulus', 'Friction')]
        for changed, start, end in cases:
            arithmetic.feclearexcept(serious)
            result = layer.integrate([0, start, 0, 0], [0, end, 0, 0], {**constants, **changed}, [0.0] * 8, 0.1)
            self.assertEqual((result.code, arithmetic.fetestexcept(serious)), (-1, 0), (changed, start, end))

    def test_where_the_contact_can_snap_back_the_host_is_asked_for_a_smaller_step(self):
        weak = behaviour('Subloading', 'PlaneStrain')
        constants = properties('Subloading', TangentialStiffness=100.0, StaticFriction=0.6, KineticFriction=0.1,
                               AdhesionBreakingExponent=100.0, AdhesionFormingExponent=0.0, SubloadingExponent=1e4)
        slid = [2.0, -1e-2, 0.054, 0.0, 0.6, 0.9, 0.0, 0.0]
        for largest, expected in ((1.0, 0.5), (0.6, 0.5), (0.4, 0.4), (0.05, 0.05)):
            result = weak.integrate([-1e-2, 0.0], [-1e-2, 2e-3], constants, slid, 0.1, largest_rdt=largest)
            self.assertEqual((result.code, result.rdt), (0, expected))
            result = weak.integrate([-1e-2, 0.0], [-1e-2, math.nan], constants, slid, 0.1, largest_rdt=largest / 4)
            self.assertEqual((result.code, result.rdt), (-1, min(largest / 4, 0.1)))

    def test_any_directory_and_any_number_of_threads(self):
        # as MGIS loads it: by its path alone, all symbols resolved at once
        call = 'import ctypes, os, sys; ctypes.CDLL(sys.argv[1], mode=os.RTLD_NOW).StickSlipCoulomb_Tridimensional'
        subprocess.run([sys.executable, '-c', call, MGIS], cwd='/', check=True, env={'PATH': os.environ['PATH']})


if __name__ == '__main__':
    unittest.main()
