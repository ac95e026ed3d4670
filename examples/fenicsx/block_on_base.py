#!/usr/bin/env python3
"""An elastic block is pressed on a rough base and pushed at its left side, in FEniCSx: the front of slip runs from there to the other end.

Usage: block_on_base.py [STEPS], also under mpirun. Needs dolfinx (0.5 or later, real numbers), the package stickslip and, for
the picture block_on_base.png, matplotlib. Prints the push and the length of the base that has slipped, step by step.

The contact is a traction on the lower side that depends on the displacement there: `stickslip.update` gives it at the nodes,
with its derivative, and quadrature at the nodes hands both to the forms. Points on the border of two processes are updated by
both, and alike.
"""
import sys

import numpy as np
import ufl
from dolfinx import fem, mesh
from dolfinx.fem import petsc
from mpi4py import MPI
from petsc4py import PETSc

import stickslip

# N, mm, s; plane strain, thickness 1
LENGTH, HEIGHT, CELLS = 100.0, 10.0, (160, 8)
YOUNG, POISSON = 1000.0, 0.3
PRESSURE = 1.0                  # on the upper side
SPEED, END = 0.1, 0.3           # of the left side; how far it is pushed
STEPS = 60
LAW = stickslip.laws.Subloading(alpha_n=1000, alpha_t=500, mu_s=0.6, mu_k=0.4, kappa=50, xi=0.05, m=500)
SLIPPED = 1e-2                  # slip that counts as such [mm]


def vector_space(domain):
    """Displacements, linear in each cell."""
    if hasattr(fem, 'functionspace'):
        return fem.functionspace(domain, ('Lagrange', 1, (2,)))
    return fem.VectorFunctionSpace(domain, ('Lagrange', 1))


def tensor_space(domain):
    """The same for the derivative of the traction."""
    if hasattr(fem, 'functionspace'):
        return fem.functionspace(domain, ('Lagrange', 1, (2, 2)))
    return fem.TensorFunctionSpace(domain, ('Lagrange', 1))


def nodes_on(domain, space, where):
    """Nodes of a space on a part of the boundary, those of neighbouring processes included."""
    facets = mesh.locate_entities_boundary(domain, 1, where)
    return fem.locate_dofs_topological(space, 1, facets), facets


class Contact:
    """Traction on the lower side and its derivative as functions of the displacement, from the friction routine."""

    def __init__(self, domain, displacement):
        self.displacement = displacement
        self.nodes, self.facets = nodes_on(domain, displacement.function_space, lambda x: np.isclose(x[1], 0.0))
        self.traction = fem.Function(displacement.function_space)
        self.tangent = fem.Function(tensor_space(domain))
        self.state = np.zeros((self.nodes.size, 8))
        self.result = None
        self.start = self.at_nodes(displacement, 2).copy()   # of the step

    def at_nodes(self, function, size):
        """The values of a function at the nodes of the lower side."""
        return function.x.array.reshape(-1, size)[self.nodes]

    def update(self, dt):
        """Puts traction and derivative in place for the present displacement. The routine's order is normal, tangential:
        y, x; the contact pulls the block back with what it transmits."""
        moved = self.at_nodes(self.displacement, 2) - self.start
        self.result = stickslip.update(moved[:, ::-1].copy(), dt, LAW, self.state)
        bad = self.result.status < 0
        if bad.any():
            raise RuntimeError(stickslip.message(self.result.status[bad][0]))
        self.traction.x.array.reshape(-1, 2)[self.nodes] = self.result.traction[:, ::-1]
        self.tangent.x.array.reshape(-1, 4)[self.nodes] = self.result.tangent[:, ::-1, ::-1].reshape(-1, 4)

    def accept(self):
        """The step is over."""
        self.state = self.result.state
        self.start = self.at_nodes(self.displacement, 2).copy()


class Block:
    """The boundary value problem and its Newton iterations."""

    def __init__(self):
        self.domain = mesh.create_rectangle(MPI.COMM_WORLD, [np.zeros(2), np.array([LENGTH, HEIGHT])], CELLS,
                                            mesh.CellType.quadrilateral)
        self.domain.topology.create_connectivity(1, 2)
        self.space = vector_space(self.domain)
        self.displacement = fem.Function(self.space)
        self.contact = Contact(self.domain, self.displacement)
        left, _ = nodes_on(self.domain, self.space, lambda x: np.isclose(x[0], 0.0))
        self.pushed = 2 * left        # places of their x component
        _, upper = nodes_on(self.domain, self.space, lambda x: np.isclose(x[1], HEIGHT))
        sides = [(self.contact.facets, 1), (upper, 2)]
        facets = np.concatenate([facets for facets, _ in sides]).astype(np.int32)
        marks = np.concatenate([np.full(facets.size, mark) for facets, mark in sides]).astype(np.int32)
        order = np.argsort(facets)
        self._forms(ufl.Measure('ds', self.domain, subdomain_data=mesh.meshtags(self.domain, 1, facets[order], marks[order])))
        space = self.space.sub(0)
        self.fixed = fem.dirichletbc(PETSc.ScalarType(0.0), fem.locate_dofs_topological(
            space, 1, mesh.locate_entities_boundary(self.domain, 1, lambda x: np.isclose(x[0], 0.0))), space)
        self.solver = PETSc.KSP().create(self.domain.comm)
        self.solver.setType('preonly')
        self.solver.getPC().setType('lu')
        self.solver.getPC().setFactorSolverType('mumps')

    def _forms(self, side):
        u, test, trial = self.displacement, ufl.TestFunction(self.space), ufl.TrialFunction(self.space)
        shear, lame = YOUNG / (2 + 2 * POISSON), YOUNG * POISSON / (1 + POISSON) / (1 - 2 * POISSON)

        def strain(v):
            return ufl.sym(ufl.grad(v))

        def stress(v):
            return 2 * shear * strain(v) + lame * ufl.tr(strain(v)) * ufl.Identity(2)

        base = side(1, metadata={'quadrature_rule': 'GLL', 'quadrature_degree': 1})
        load = fem.Constant(self.domain, np.array([0.0, -PRESSURE]))
        residual = ufl.inner(stress(u), strain(test)) * ufl.dx + ufl.inner(self.contact.traction, test) * base \
            - ufl.inner(load, test) * side(2)
        derivative = ufl.inner(stress(trial), strain(test)) * ufl.dx \
            + ufl.inner(ufl.dot(self.contact.tangent, trial), test) * base
        self.residual, self.derivative = fem.form(residual), fem.form(derivative)

    def step(self, position, dt):
        """Equilibrium with the left side at a position; gives the push and how many iterations it took."""
        u = self.displacement.x
        u.array[self.pushed] = position
        owned = self.space.dofmap.index_map.size_local * 2
        fixed = self.pushed[self.pushed < owned]
        scale = None
        for iterations in range(30):
            self.contact.update(dt)
            forces = petsc.assemble_vector(self.residual)
            forces.ghostUpdate(addv=PETSc.InsertMode.ADD, mode=PETSc.ScatterMode.REVERSE)
            push = self.domain.comm.allreduce(float(forces.array[fixed].sum()))
            forces.array[fixed] = 0.0
            size = forces.norm()
            scale = max(scale or 0.0, size)
            if iterations and size < 1e-11 * max(scale, PRESSURE * LENGTH):
                self.contact.accept()
                return push, iterations
            matrix = petsc.assemble_matrix(self.derivative, bcs=[self.fixed])
            matrix.assemble()
            self.solver.setOperators(matrix)
            change = forces.duplicate()
            self.solver.solve(forces, change)
            u.array[:owned] -= change.array
            u.scatter_forward()
            for used in (matrix, forces, change):
                used.destroy()
        raise RuntimeError('Newton iterations do not converge')

    def slip(self):
        """Places and slip of the nodes of the lower side, from left to right, all processes' together."""
        places = self.space.tabulate_dof_coordinates()[self.contact.nodes, 0]
        parts = self.domain.comm.allgather((places, self.contact.state[:, 6]))
        places, slip = (np.concatenate(values) for values in zip(*parts))
        places, first = np.unique(np.round(places, 9), return_index=True)
        return places, slip[first]


def draw(places, positions, pushes, slips):
    """The front in place and time, and the push."""
    import matplotlib
    matplotlib.use('Agg')
    import matplotlib.pyplot as plt
    figure, (front, force) = plt.subplots(1, 2, figsize=(10, 4), sharey=True, width_ratios=(2, 1), layout='constrained')
    picture = front.pcolormesh(places, positions, 1e3 * np.array(slips), shading='nearest', cmap='viridis')
    front.contour(places, positions, slips, levels=[SLIPPED], colors='w', linewidths=1)
    figure.colorbar(picture, label='slip [um]', location='left')
    front.set(xlabel='place along the base [mm]', ylabel='position of the pushed side [mm]', title='slip; white: its front')
    force.plot(pushes, positions)
    force.axvline(LAW.mu_s * PRESSURE * LENGTH, color='0.7', ls=':', label='static, whole base')
    force.axvline(LAW.mu_k * PRESSURE * LENGTH, color='0.7', ls='--', label='kinetic')
    force.set(xlabel='push [N/mm]')
    force.legend(fontsize='small')
    figure.savefig('block_on_base.png', dpi=120)


def main():
    steps = int(sys.argv[1]) if len(sys.argv) > 1 else STEPS
    block = Block()
    chief = block.domain.comm.rank == 0
    block.displacement.x.array[1::2] = -PRESSURE / LAW.alpha_n   # touching, or nothing would hold it
    block.step(0.0, 1.0)          # pressed on the base
    dt = END / SPEED / steps
    positions, pushes, slips = [], [], []
    most = 0
    for k in range(1, steps + 1):
        push, iterations = block.step(k * END / steps, dt)
        places, slip = block.slip()
        slipped = LENGTH * float(np.mean(slip > SLIPPED))
        most = max(most, iterations)
        positions.append(k * END / steps)
        pushes.append(push)
        slips.append(slip)
        if chief:
            print(f'position {positions[-1]:.4f} mm  push {push:.9f} N/mm  slipped {slipped:.3f} mm  iterations {iterations}')
    if chief:
        print(f'slip at the left end {slips[-1][0]:.12e}, at the right end {slips[-1][-1]:.12e}; at most {most} iterations')
        if len(sys.argv) < 2:
            draw(places, positions, pushes, slips)


if __name__ == '__main__':
    main()
