"""Presses contact points, slides them forth and back, and prints the friction of the first: through MGIS's Python module.

    python slide.py LIBSTICKSLIP_MGIS.so
"""
import sys

import mgis.behaviour as mgis
import numpy

CONSTANTS = {'NormalStiffness': 1000, 'TangentialStiffness': 800, 'StaticFriction': 0.45, 'KineticFriction': 0.25,
             'AdhesionBreakingExponent': 8, 'AdhesionFormingExponent': 0.2, 'SubloadingExponent': 60}
POINTS, DT = 10, 0.01

behaviour = mgis.load(sys.argv[1], 'StickSlipSubloading', mgis.Hypothesis.PLANESTRAIN)
points = mgis.MaterialDataManager(behaviour, POINTS)
for state in (points.s0, points.s1):
    for name, value in CONSTANTS.items():
        mgis.setMaterialProperty(state, name, float(value))
print(' step   shear [N/mm^2]     mu        R')
slid = numpy.zeros(POINTS)
for step in range(41):
    if step > 0:
        slid += 0.0005 if step <= 20 else -0.0005
    points.s1.gradients[:, 0] = -0.002
    points.s1.gradients[:, 1] = slid
    if mgis.integrate(points, mgis.IntegrationType.INTEGRATION_CONSISTENT_TANGENT_OPERATOR, DT, 0, POINTS) != 1:
        sys.exit('the integration failed')
    mgis.update(points)
    shear = points.s1.thermodynamic_forces[0, 1]
    variables = points.s1.internal_state_variables[0]
    print(f'{step:5d} {shear:16.9f} {variables[4]:8.5f} {variables[5]:8.5f}')
