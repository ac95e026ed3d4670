"""NAFEMS contact benchmark CGS-4, a block pushed up a slope by a horizontal force, in Kratos.

usage: python block_on_slope.py PATH/libstickslip_kratos.so    prints F/G; run by a Python that has Kratos
"""
import math
import os
import pathlib
import subprocess
import sys

PROJECT = pathlib.Path(__file__).resolve().parents[1]
SLOPE, FRICTION = 0.1, 0.3          # tan(alpha), mu
COULOMB = 2


def force_over_weight(library):
    """The block of examples/kratos/two_blocks.py on a slope, its foot pushed up in horizontal steps until it slides."""
    sys.path.insert(0, str(PROJECT / 'examples/kratos'))
    import KratosMultiphysics as KM
    import two_blocks

    class Slope(two_blocks.TwoBlocks):
        def make_mesh(self):
            super().make_mesh()
            cosine, sine = 1 / math.hypot(1, SLOPE), SLOPE / math.hypot(1, SLOPE)
            for node in self.part.Nodes:
                x, y = node.X0, node.Y0
                node.X0 = node.X = cosine * x - sine * y
                node.Y0 = node.Y = sine * x + cosine * y

        def fix(self):
            super().fix()
            for node in self.layers[3]:
                node.Free(KM.DISPLACEMENT_X)
                node.Free(KM.DISPLACEMENT_Y)
            for node in self.layers[2]:
                node.Fix(KM.DISPLACEMENT_X)
            for node in self.layers[3]:   # only these: the interface element, too, has a mass
                node.SetSolutionStepValue(KM.VOLUME_ACCELERATION, 0, KM.Array3([0.0, -1e-3, 0.0]))

    blocks = Slope(library, 2, friction=(COULOMB, 1000.0, 1000.0, FRICTION))
    blocks.layers[2:] = blocks.layers[3], blocks.layers[2]   # what is moved is the last: the foot of the block
    foot = blocks.layers[3]
    for node in foot:
        node.Fix(KM.DISPLACEMENT_Y)
    blocks.step((0.0, -1e-3))            # pressed on: an open contact would leave the block in the air
    for node in foot:
        node.Free(KM.DISPLACEMENT_Y)
    for step in range(1, 41):
        blocks.step((5e-4 * step,))
    if not all(abs(state - 2) <= 1e-9 for state in states(blocks.part.Elements[3], blocks.part.ProcessInfo)):
        raise RuntimeError('the block does not slide')
    weight = sum(node.GetSolutionStepValue(KM.REACTION_Y) for node in blocks.layers[0])
    force = sum(node.GetSolutionStepValue(KM.REACTION_X) for node in foot)
    return force / weight


def states(contact, info):
    """Open, stick or slip, at each point of the contact."""
    import KratosMultiphysics as KM
    return contact.CalculateOnIntegrationPoints(KM.KratosGlobals.GetVariable('STATE_VARIABLE_1'), info)


def validate(build, report):
    expected = (SLOPE + FRICTION) / (1 - FRICTION * SLOPE)
    claim = f'NAFEMS CGS-4: force over weight to push a block up a slope, `tan(alpha) = {SLOPE}`, `mu = {FRICTION}`, in Kratos'
    source = '`(tan(alpha) + mu)/(1 - mu tan(alpha))`'
    report.section('In a finite-element host', 'Coulomb friction through the adapter for interface elements.')
    python = pathlib.Path(os.environ.get('STICKSLIP_HOSTS', PROJECT / 'build/hosts'), 'python/bin/python')
    library = next((build / 'src').rglob('libstickslip_kratos.*'), None)
    if not python.exists() or library is None:
        report.skip(claim, source, expected, 'no Kratos; `./dev hosts` installs it')
        return
    result = subprocess.run([python, __file__, library], text=True, capture_output=True, check=False)
    if result.returncode:
        print(result.stdout[-2000:], result.stderr[-2000:])
    found = float(result.stdout.split('F/G =')[1].split()[0]) if result.returncode == 0 else math.nan
    report.row(claim, source, expected, found, 1e-6)


if __name__ == '__main__':
    print('F/G =', repr(force_over_weight(sys.argv[1])))
