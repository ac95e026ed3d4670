#!/usr/bin/env python3
"""The friction routine as an external operator of dolfinx: the traction of an interface is a function of the jump of displacement
over it, and `ufl.derivative` finds the routine's exact tangent. Compares the assembled derivative with differences of the
assembled forces.

Needs dolfinx with dolfinx-external-operator (0.11) and the package stickslip.
"""
import basix.ufl
import numpy as np
import ufl
from dolfinx import fem, mesh
from dolfinx_external_operator import (FEMExternalOperator, evaluate_external_operators, evaluate_operands,
                                       replace_external_operators)
from mpi4py import MPI

import stickslip

LAW = stickslip.laws.Subloading(alpha_n=1000, alpha_t=800, mu_s=0.45, mu_k=0.25, kappa=8, xi=0.2, m=60)
DT = 0.01


def external(derivatives):
    """The function for the operator, or for its derivative, at all quadrature points: jumps in, numbers out."""
    def traction(jump):
        return stickslip.update(np.reshape(jump, (-1, 2)), DT, LAW).traction.ravel()

    def tangent(jump):
        return stickslip.update(np.reshape(jump, (-1, 2)), DT, LAW).tangent.ravel()

    return {(0,): traction, (1,): tangent}[derivatives]


def main():
    interface = mesh.create_unit_interval(MPI.COMM_WORLD, 8)
    space = fem.functionspace(interface, ('Lagrange', 1, (2,)))
    jump = fem.Function(space)   # normal, tangential
    jump.interpolate(lambda x: np.vstack([-1e-3 * (1 + x[0]), 1e-3 * x[0]**2]))
    points = fem.functionspace(interface, basix.ufl.quadrature_element(interface.basix_cell(), degree=2, value_shape=(2,)))
    traction = FEMExternalOperator(jump, function_space=points, external_function=external)
    dx = ufl.Measure('dx', metadata={'quadrature_degree': 2, 'quadrature_scheme': 'default'})
    forces = ufl.inner(traction, ufl.TestFunction(space)) * dx
    derivative = ufl.algorithms.expand_derivatives(ufl.derivative(forces, jump, ufl.TrialFunction(space)))
    (forces, of_forces), (derivative, of_derivative) = map(replace_external_operators, (forces, derivative))
    forces, derivative = fem.form(forces), fem.form(derivative)

    def assembled(form, operators, assemble):
        evaluate_external_operators(operators, evaluate_operands(operators))
        return assemble(form)

    exact = assembled(derivative, of_derivative, fem.assemble_matrix).to_dense()
    step = 1e-8
    worst = 0.0
    values = jump.x.array
    for i in range(values.size):
        each = []
        for move in (step, -step):
            values[i] += move
            each.append(assembled(forces, of_forces, fem.assemble_vector).array.copy())
            values[i] -= move
        worst = max(worst, np.abs((each[0] - each[1]) / (2 * step) - exact[:, i]).max())
    print(f'assembled derivative against differences: {worst / np.abs(exact).max():.1e}')


if __name__ == '__main__':
    main()
