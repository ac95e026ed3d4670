"""OpenGeoSys with libstickslip_mgis.so: two blocks and a layer (examples/ogs), against `friction_update` along the gaps
that OpenGeoSys finds in the layer's integration points.

STICKSLIP_LIBRARY, STICKSLIP_MGIS: the shared libraries.
"""
import ctypes
import importlib.util
import itertools
import os
import pathlib
import shutil
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent), str(HERE.parents[1] / 'examples/ogs')]

import law_examples  # noqa: E402
from worst_errors import worst_of  # noqa: E402

HAVE_OGS = all(importlib.util.find_spec(name) for name in ('ogs', 'numpy'))
LAWS = {law.camel: law.props() for law in law_examples.laws().values()}
OPTIONS = ('Subloading', 'Coulomb')   # run with cohesion and damper, too


class Points:
    """Contact points and their states, through friction_update_batch."""

    def __init__(self, n, components, props):
        import numpy
        self.n, self.components = n, components
        self.props = numpy.array(props, float)
        self.statev, self.old = numpy.zeros((8, n)), numpy.zeros((components, n))
        self.routine = ctypes.CDLL(os.environ['STICKSLIP_LIBRARY']).friction_update_batch

    def update(self, gap, dt):
        """Tractions (component, point) at these gaps."""
        import numpy

        def address(values):
            return ctypes.c_void_p(values.ctypes.data)

        c, n = self.components, self.n
        du, traction = numpy.ascontiguousarray(gap - self.old), numpy.zeros((c, n))
        tangent, status = numpy.zeros((c, c, n)), numpy.zeros(n, numpy.int32)
        worst = self.routine(ctypes.c_int64(n), c, address(du), ctypes.c_double(dt), len(self.props), address(self.props), 8,
                             address(self.statev), address(traction), address(tangent), address(status))
        if worst < 0:
            raise RuntimeError(f'friction_update_batch: code {worst}')
        self.old = gap
        return traction


def layer_gaps(blocks, displacement):
    """Gaps (component: normal, tangential; integration point) of the layer: thickness times strain."""
    import numpy
    d = blocks.dimension
    u = numpy.array(displacement)
    size = numpy.array([20.0 / blocks.n] * (d - 1) + [blocks.constants['Thickness']])
    corners = list(itertools.product((0, 1), repeat=d))   # of an element: offset along each axis, the normal last
    nodes = numpy.array([[blocks.node(i + c[0], (j + c[1]) if d == 3 else 0, 1 + c[-1]) for c in corners]
                         for i, j in blocks.columns()])
    gaps = []
    for point in itertools.product((-3**-0.5, 3**-0.5), repeat=d):
        weights = [[(1 + point[k] * (2 * c[k] - 1)) / 2 for k in range(d)] for c in corners]
        slopes = numpy.array([[(2 * c[a] - 1) / size[a] * numpy.prod([w[k] for k in range(d) if k != a]) for a in range(d)]
                              for c, w in zip(corners, weights)])
        gradient = numpy.einsum('eci,ca->eia', u[nodes], slopes)   # du_i/dx_a
        normal = d - 1
        strains = [gradient[:, normal, normal]] + [gradient[:, k, normal] + gradient[:, normal, k] for k in range(d - 1)]
        gaps.append(blocks.constants['Thickness'] * numpy.array(strains))
    return numpy.concatenate(gaps, axis=1)


@unittest.skipUnless(HAVE_OGS, 'OpenGeoSys is not installed: ./dev hosts installs it')
class Blocks(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)

    def run_blocks(self, law, dimension, n, ending='', props=None):
        import two_blocks
        props = props or LAWS[law]
        name = f'StickSlip{law}Layer{ending}'
        blocks = two_blocks.TwoBlocks(os.environ['STICKSLIP_MGIS'], name, dict(zip(self.properties_of(name), props[1:])), n,
                                      dimension)
        iterations = blocks.run(self.folder)
        self.assertEqual(len(iterations), two_blocks.STEPS + 1)   # the first, at time 0, solves nothing
        elements = len(blocks.columns())
        points = Points(elements * 2**dimension, dimension, props)
        share = 20.0 ** (dimension - 1) / points.n
        worst = largest = 0.0
        counts = {1: 0, 2: 0, 3: 0}
        for step in range(1, two_blocks.STEPS + 1):
            displacement, forces = blocks.fields(self.folder, step)
            traction = points.update(layer_gaps(blocks, displacement), two_blocks.DT) * share
            found = [sum(forces[node][k] for node in blocks.nodes_of(3)) for k in range(dimension)]
            expected = [*traction[1:].sum(axis=1), traction[0].sum()]
            largest = max(largest, *map(abs, found))
            worst = worst_of([worst, *(abs(a - b) for a, b in zip(found, expected))])
            for status in counts:
                counts[status] += int((points.statev[0] == status).sum())
        share = {status: count / points.n / two_blocks.STEPS for status, count in counts.items()}
        print(f'\n  OpenGeoSys {dimension}D, {name}: {elements} elements in the layer, worst difference {worst / largest:.1e} of '
              f'{largest:.0f} N, Newton iterations at most {max(iterations)}, mean {sum(iterations) / two_blocks.STEPS:.2f}; '
              f'stick {share[1]:.0%}, slip {share[2]:.0%}, open {share[3]:.0%}')
        self.assertLess(worst / largest, 1e-7)
        self.assertLessEqual(max(iterations), 6)
        self.assertGreater(share[2], 0.3)
        self.assertGreater(share[3], 0.04)

    def properties_of(self, name):
        import mfront_loader
        behaviour = mfront_loader.Behaviour(os.environ['STICKSLIP_MGIS'], name, 'PlaneStrain')
        return behaviour.properties[2:]

    def test_two_dimensions_under_every_law(self):
        for law in LAWS:
            with self.subTest(law=law):
                self.run_blocks(law, 2, 100 if law == 'Subloading' else 10)

    def test_three_dimensions_under_every_law(self):
        for law in LAWS:
            with self.subTest(law=law):
                self.run_blocks(law, 3, 10 if law == 'Subloading' else 2)

    def test_cohesion_and_damper_reach_the_host(self):
        for law in OPTIONS:
            props = law_examples.laws()[law.lower()].props('cohesion', 'eta_t')
            for dimension, n in ((2, 10), (3, 2)):
                with self.subTest(law=law, dimension=dimension):
                    self.run_blocks(law, dimension, n, 'WithOptions', props)


if __name__ == '__main__':
    unittest.main()
