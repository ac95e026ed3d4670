#!/usr/bin/env python3
"""Two elastic blocks pressed together and sheared in Kratos, with the friction of stickslip between them.

Usage: python two_blocks.py PATH/libstickslip_kratos.so

Needs Kratos 10.4: pip install KratosMultiphysics KratosGeoMechanicsApplication
KratosStructuralMechanicsApplication KratosLinearSolversApplication
"""
import sys

import KratosMultiphysics as KM
import KratosMultiphysics.GeoMechanicsApplication as Geo
import KratosMultiphysics.LinearSolversApplication  # noqa: F401 (registers the direct solver)

# law, alpha_n, alpha_t [N/mm^3], mu_s, mu_k [-], kappa [1/mm], xi [1/s], m [1/mm]
FRICTION = [1, 1000.0, 800.0, 0.45, 0.25, 8.0, 0.2, 60.0]


def properties(model_part, number, values):
    prop = model_part.CreateNewProperties(number)
    for name, value in values.items():
        prop.SetValue(KM.KratosGlobals.GetVariable(name), value)
    return prop


class TwoBlocks:
    """Two unit blocks (2 or 3 dimensions) and interface elements between them: one of each, in the plane `n` of each.

    The pressing displacement grows along x by the part `uneven` of it.
    """

    def __init__(self, library, dimension, friction=tuple(FRICTION), dt=0.01, youngs_modulus=1e4, n=1, uneven=0.0):
        if n > 1 and dimension > 2:
            raise ValueError('many elements are for the plane')
        self.dimension, self.dt, self.n, self.uneven = dimension, dt, n, uneven
        self.model = KM.Model()
        self.part = part = self.model.CreateModelPart('blocks', 2)
        KM.Logger.GetDefaultOutput().SetSeverity(KM.Logger.Severity.WARNING)
        part.ProcessInfo.SetValue(KM.DOMAIN_SIZE, dimension)
        for variable in (KM.DISPLACEMENT, KM.VELOCITY, KM.ACCELERATION, KM.REACTION, KM.VOLUME_ACCELERATION,
                         KM.WATER_PRESSURE, KM.REACTION_WATER_PRESSURE, Geo.DT_WATER_PRESSURE):
            part.AddNodalSolutionStepVariable(variable)
        self.make_mesh()
        self.make_materials(library, friction, youngs_modulus)
        self.fix()
        self.make_solver()

    def make_mesh(self):
        """Layers of nodes at heights 0, 1 (twice: the interface) and 2."""
        corners = [(k / self.n, 0) for k in range(self.n + 1)] if self.dimension == 2 else [(0, 0), (1, 0), (1, 1), (0, 1)]
        self.layers = []
        for layer, height in enumerate((0.0, 1.0, 1.0, 2.0)):
            nodes = []
            for corner, (x, y) in enumerate(corners):
                number = layer * len(corners) + corner + 1
                place = (x, height, 0.0) if self.dimension == 2 else (x, y, height)
                nodes.append(self.part.CreateNewNode(number, *map(float, place)))
            self.layers.append(nodes)

    def make_materials(self, library, friction, youngs_modulus):
        porous = {'DENSITY_SOLID': 2e3, 'DENSITY_WATER': 1e3, 'POROSITY': 0.3, 'BULK_MODULUS_SOLID': 1e9,
                  'BULK_MODULUS_FLUID': 2e9, 'PERMEABILITY_XX': 1e-9, 'PERMEABILITY_YY': 1e-9,
                  'PERMEABILITY_ZZ': 1e-9, 'PERMEABILITY_XY': 0.0, 'PERMEABILITY_YZ': 0.0, 'PERMEABILITY_ZX': 0.0,
                  'DYNAMIC_VISCOSITY': 1e-3, 'BIOT_COEFFICIENT': 1.0, 'THICKNESS': 1.0,
                  'GEO_DRAINAGE_TYPE': 'drained', 'RETENTION_LAW': 'SaturatedLaw', 'SATURATED_SATURATION': 1.0}
        elastic = properties(self.part, 1, {**porous, 'YOUNG_MODULUS': youngs_modulus, 'POISSON_RATIO': 0.0})
        contact = properties(self.part, 2, {
            **porous, 'UDSM_NAME': library, 'IS_FORTRAN_UDSM': True, 'UMAT_PARAMETERS': KM.Vector(list(friction)),
            'STATE_VARIABLES': KM.Vector([0.0] * 8), 'MINIMUM_JOINT_WIDTH': 1e-3, 'TRANSVERSAL_PERMEABILITY': 0.0})
        plane = self.dimension == 2
        law = 'GeoLinearElasticPlaneStrain2DLaw' if plane else 'GeoIncrementalLinearElastic3DLaw'
        elastic.SetValue(KM.CONSTITUTIVE_LAW, KM.KratosGlobals.GetConstitutiveLaw(law).Clone())
        law = f'SmallStrainUMAT{self.dimension}DInterfaceLaw'
        contact.SetValue(KM.CONSTITUTIVE_LAW, KM.KratosGlobals.GetConstitutiveLaw(law).Clone())
        shape = '2D4N' if plane else '3D8N'
        number = 0
        for kind, low, high, prop in (('', 0, 1, elastic), ('', 2, 3, elastic), ('Interface', 1, 2, contact)):
            for at in range(self.n):
                number += 1
                self.part.CreateNewElement(f'UPwSmallStrain{kind}Element{shape}', number, self.ring(low, high, at), prop)

    def ring(self, low, high, at):
        """Node numbers of an element between two layers, in the order that Kratos counts them."""
        nodes = slice(at, at + 2) if self.dimension == 2 else slice(4)
        lower = [node.Id for node in self.layers[low][nodes]]
        upper = [node.Id for node in self.layers[high][nodes]]
        return lower + (upper[::-1] if self.dimension == 2 else upper)

    def fix(self):
        for variable, reaction in ((KM.DISPLACEMENT_X, KM.REACTION_X), (KM.DISPLACEMENT_Y, KM.REACTION_Y),
                                   (KM.DISPLACEMENT_Z, KM.REACTION_Z), (KM.WATER_PRESSURE, KM.REACTION_WATER_PRESSURE)):
            if variable == KM.DISPLACEMENT_Z and self.dimension == 2:
                continue
            for node in self.part.Nodes:
                node.AddDof(variable, reaction)
            held = self.part.Nodes if variable == KM.WATER_PRESSURE else self.layers[0] + self.layers[3]
            for node in held:
                node.Fix(variable)

    def make_solver(self):
        scheme = KM.ResidualBasedIncrementalUpdateStaticScheme()
        solver = KM.LinearSolversApplication.SparseLUSolver()
        builder = KM.ResidualBasedBlockBuilderAndSolver(solver)
        criterion = KM.ResidualCriteria(1e-10, 1e-9)
        self.strategy = KM.ResidualBasedNewtonRaphsonStrategy(self.part, scheme, criterion, builder, 30, True,
                                                              False, False)
        self.strategy.SetEchoLevel(0)
        self.strategy.Initialize()

    def step(self, displacement):
        """Moves the top of the upper block to a displacement; gives the number of Newton iterations."""
        self.part.CloneTimeStep(self.part.ProcessInfo[KM.TIME] + self.dt)
        self.part.ProcessInfo[KM.STEP] += 1
        for node in self.layers[3]:
            moved = [*displacement[:-1], displacement[-1] * (1 + self.uneven * node.X0)]
            for variable, value in zip((KM.DISPLACEMENT_X, KM.DISPLACEMENT_Y, KM.DISPLACEMENT_Z), moved):
                node.SetSolutionStepValue(variable, 0, value)
        self.strategy.InitializeSolutionStep()
        self.strategy.Predict()
        converged = self.strategy.SolveSolutionStep()
        self.strategy.FinalizeSolutionStep()
        if not converged:
            raise RuntimeError(f'no convergence in step {self.part.ProcessInfo[KM.STEP]}')
        return self.part.ProcessInfo[KM.NL_ITERATION_NUMBER]

    def gaps(self):
        """Displacement of the upper side of the interface relative to the lower, at each pair of nodes."""
        return [[b - a for a, b in zip(low.GetSolutionStepValue(KM.DISPLACEMENT), high.GetSolutionStepValue(KM.DISPLACEMENT))]
                [:self.dimension] for low, high in zip(self.layers[1], self.layers[2])]

    def state(self):
        """State variables of the first interface element, means over its points."""
        contact, info = self.part.Elements[2 * self.n + 1], self.part.ProcessInfo
        values = [contact.CalculateOnIntegrationPoints(KM.KratosGlobals.GetVariable(f'STATE_VARIABLE_{k}'), info)
                  for k in range(1, 9)]
        return [sum(value) / len(value) for value in values]

    def force(self):
        """Force of the upper block's support on it."""
        return [sum(node.GetSolutionStepValue(KM.REACTION)[k] for node in self.layers[3])
                for k in range(self.dimension)]


def main():
    blocks = TwoBlocks(sys.argv[1], 2)
    print(' step   shift [mm]   shear force [N]   pressing force [N]   Newton iterations')
    for step in range(1, 41):
        press = -0.004 * min(1.0, step / 5)
        shift = 0.0004 * (max(0, step - 5) if step <= 25 else 45 - step)
        iterations = blocks.step((shift, press))
        force = blocks.force()
        print(f'{step:5d} {shift:12.4f} {force[0]:17.6f} {-force[1]:20.6f} {iterations:19d}')


if __name__ == '__main__':
    main()
