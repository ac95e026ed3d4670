"""Kratos with libstickslip_kratos.so: two blocks against the same path through `friction_update`.

STICKSLIP_LIBRARY and STICKSLIP_KRATOS name the shared libraries.
"""
import importlib.util
import os
import pathlib
import sys
import unittest

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent), str(HERE.parents[1] / 'examples/kratos')]

import friction_point  # noqa: E402
from worst_errors import worst_of  # noqa: E402

os.environ['OMP_NUM_THREADS'] = '1'   # for Kratos: on three elements threads wait for each other, and wait busily
HAVE_KRATOS = importlib.util.find_spec('KratosMultiphysics') is not None
PRESSED, DT = -0.004, 0.01
# one of them has a test of its own
LAWS = {name: props for name, props in friction_point.LAWS.items() if name != friction_point.WITH_OPTIONS}


def programme():
    """Pressed in, sheared, reversed, held, sheared again, opened and closed again: x, y and normal."""
    path = [(0.0, 0.0, PRESSED * k / 5) for k in range(1, 6)]
    x = y = 0.0
    for dx, dy, steps in ((4e-4, 1e-4, 20), (-4e-4, 2e-4, 25), (0.0, 0.0, 5), (4e-4, -3e-4, 20), (-1e-6, 0.0, 2)):
        for _ in range(steps):
            x, y = x + dx, y + dy
            path.append((x, y, PRESSED))
    path += [(x, y, 0.002), (x, y, 0.004)]
    for _ in range(10):
        x += 4e-4
        path.append((x, y, PRESSED))
    return path


@unittest.skipUnless(HAVE_KRATOS, 'Kratos is not installed: ./dev hosts installs it')
class Blocks(unittest.TestCase):
    def run_blocks(self, dimension, name, friction, point=friction_point.FrictionPoint):
        import two_blocks
        blocks = two_blocks.TwoBlocks(os.environ['STICKSLIP_KRATOS'], dimension, friction, dt=DT)
        normal = dimension - 1
        points = [point(friction) for _ in blocks.layers[1]]
        old = [[0.0] * dimension for _ in points]
        area = 1.0 / len(points)
        worst, worst_state, most, sticking, slipping = 0.0, 0.0, 0, 0, 0
        for x, y, n in programme():
            most = max(most, blocks.step((x, n) if dimension == 2 else (x, y, n)))
            expected = [0.0] * dimension
            for k, (each, gap) in enumerate(zip(points, blocks.gaps())):
                du = [b - a for a, b in zip(old[k], gap)]
                traction = each.update([du[normal], *du[:normal]], DT)
                for i, value in enumerate([*traction[1:], traction[0]]):
                    expected[i] += area * value
                old[k] = gap
            slipping += points[0].statev[0] == 2
            sticking += points[0].statev[0] == 1
            for found, wanted in zip(blocks.force(), expected):
                worst = worst_of([worst, abs(found - wanted) / abs(1e3 * PRESSED)])
            for place, found in enumerate(blocks.state()):
                wanted = sum(each.statev[place] for each in points) / len(points)
                scale = abs(PRESSED) if place in (1, 2, 3) else 1.0
                worst_state = worst_of([worst_state, abs(found - wanted) / scale])
        print(f'\n  {dimension}D, {name}: {len(programme())} steps, worst difference {worst:.1e} of the pressing force, '
              f'{worst_state:.1e} in the state, '
              f'most Newton iterations {most}; slip in {slipping} steps, stick in {sticking}')
        self.assertLess(worst, 1e-7)
        self.assertLess(worst_state, 1e-7)
        self.assertLessEqual(most, 4)
        self.assertGreater(slipping, 20)
        if name not in friction_point.CREEPING:
            self.assertGreater(sticking, 5)

    def test_two_dimensions_under_every_law(self):
        for name, friction in LAWS.items():
            with self.subTest(law=name):
                self.run_blocks(2, name, friction)

    def test_three_dimensions_under_every_law(self):
        for name, friction in LAWS.items():
            with self.subTest(law=name):
                self.run_blocks(3, name, friction)

    def test_cohesion_and_damper_follow_their_closed_form(self):
        name = friction_point.WITH_OPTIONS
        for dimension in (2, 3):
            self.run_blocks(dimension, name, friction_point.LAWS[name], friction_point.CoulombPoint)

    def test_a_hundred_interface_elements_pressed_unevenly(self):
        import two_blocks
        for name in ('subloading', 'rate_and_state'):
            with self.subTest(law=name):
                friction, n = friction_point.LAWS[name], 100
                blocks = two_blocks.TwoBlocks(os.environ['STICKSLIP_KRATOS'], 2, friction, dt=DT, n=n, uneven=0.5)
                points = [friction_point.FrictionPoint(friction) for _ in range(n + 1)]
                share = [1 / n if 0 < k < n else 0.5 / n for k in range(n + 1)]
                old, worst, counts = [[0.0, 0.0] for _ in points], 0.0, []
                for x, _, normal in programme()[:60]:
                    counts.append(blocks.step((x, normal)))
                    expected = [0.0, 0.0]
                    for k, (point, gap) in enumerate(zip(points, blocks.gaps())):
                        traction = point.update([gap[1] - old[k][1], gap[0] - old[k][0]], DT)
                        expected[0] += share[k] * traction[1]
                        expected[1] += share[k] * traction[0]
                        old[k] = gap
                    worst = worst_of([worst, *(abs(a - b) / abs(1e3 * PRESSED) for a, b in zip(blocks.force(), expected))])
                print(f'\n  Kratos, {n} interface elements, {name}: {len(counts)} steps, worst difference {worst:.1e} of the '
                      f'pressing force, Newton iterations at most {max(counts)}, mean {sum(counts) / len(counts):.2f}')
                # Newton's method stops at 1e-10 of the first residual, some thousand times the pressing force here
                self.assertLess(worst, 1e-6)
                self.assertLessEqual(max(counts), 4)

    def test_a_force_presses_bodies_that_just_touch(self):
        import KratosMultiphysics as kratos
        import KratosMultiphysics.StructuralMechanicsApplication   # noqa: F401 (knows POINT_LOAD)
        import two_blocks
        load = kratos.KratosGlobals.GetVariable('POINT_LOAD')

        class Loaded(two_blocks.TwoBlocks):
            def make_mesh(self):
                self.part.AddNodalSolutionStepVariable(load)
                super().make_mesh()

            def fix(self):
                super().fix()
                for k, node in enumerate(self.layers[3]):
                    node.Free(kratos.DISPLACEMENT_Y if self.dimension == 2 else kratos.DISPLACEMENT_Z)
                    self.part.CreateNewCondition(f'UPwForceCondition{self.dimension}D1N', k + 1, [node.Id],
                                                 self.part.CreateNewProperties(k + 3))

        for dimension in (2, 3):
            blocks = Loaded(os.environ['STICKSLIP_KRATOS'], dimension)
            for force in (0.0, 1.0, 2.0):
                vector = [0.0, 0.0, 0.0]
                vector[dimension - 1] = -force / len(blocks.layers[3])
                for node in blocks.layers[3]:
                    node.SetSolutionStepValue(load, 0, vector)
                blocks.step([0.0] * dimension)
                for gap in blocks.gaps():
                    self.assertAlmostEqual(gap[-1], -force / friction_point.LAWS['subloading'][1], delta=1e-12)

    def test_the_example_s_own_constants_are_these(self):
        import two_blocks
        self.assertEqual(two_blocks.FRICTION, friction_point.LAWS['subloading'])


if __name__ == '__main__':
    unittest.main()
