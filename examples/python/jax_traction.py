#!/usr/bin/env python3
"""The friction routine in JAX: traction as a function of the increment, with the routine's exact tangent as derivative.

Needs the package stickslip and jax. Compares a gradient with central differences.
"""
import jax
import jax.numpy as jnp
import numpy as np

import stickslip

jax.config.update('jax_enable_x64', True)

LAW = stickslip.laws.Subloading(alpha_n=1000, alpha_t=800, mu_s=0.45, mu_k=0.25, kappa=8, xi=0.2, m=60)
DT = 0.01


def host(du, state):
    """The update of n points outside JAX: traction (n, ndir) and tangent (n, ndir, ndir)."""
    result = stickslip.update(np.asarray(du), DT, LAW, np.asarray(state))
    return result.traction, result.tangent


def call(du, state):
    """The same as a part of a JAX program."""
    n, ndir = du.shape
    shapes = (jax.ShapeDtypeStruct((n, ndir), jnp.float64), jax.ShapeDtypeStruct((n, ndir, ndir), jnp.float64))
    return jax.pure_callback(host, shapes, du, state)


@jax.custom_jvp
def traction(du, state):
    """Traction at the end of the increment; differentiable with respect to du."""
    return call(du, state)[0]


@traction.defjvp
def traction_jvp(values, changes):
    """The tangent times the change of the increment; the state is a constant of the step."""
    result, tangent = call(*values)
    return result, jnp.einsum('nij,nj->ni', tangent, changes[0])


def main():
    draw = np.random.default_rng(0)
    n = 200
    state = stickslip.update(np.tile([-0.01, 0.0, 0.0], (n, 1)), DT, LAW).state
    du = draw.normal(scale=2e-3, size=(n, 3)) * [0.1, 1.0, 1.0]

    def energy(du):
        return jnp.sum(traction(du, state)**2)

    gradient = np.asarray(jax.jit(jax.grad(energy))(du))
    step = 1e-7
    worst = 0.0
    for j in range(3):
        ahead, behind = du.copy(), du.copy()
        ahead[:, j] += step
        behind[:, j] -= step
        each = [np.sum(np.asarray(traction(moved, state))**2, axis=1) for moved in (ahead, behind)]
        worst = max(worst, np.abs((each[0] - each[1]) / (2 * step) - gradient[:, j]).max())
    print(f'gradient against differences: {worst / np.abs(gradient).max():.1e}')


if __name__ == '__main__':
    main()
