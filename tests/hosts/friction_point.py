"""`friction_update` of libstickslip.so for the tests of finite-element hosts.

STICKSLIP_LIBRARY names the shared library.
"""
import ctypes
import math
import os
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))

import law_examples  # noqa: E402



def host_laws():
    """Every law by its name, and some with options: constants under which a host is run."""
    laws = law_examples.laws()
    found = {name: law.props(*({'theta_0'} & set(law.names))) for name, law in laws.items()}
    found['subloading, exact rate'] = laws['subloading'].props('scheme', scheme=1.0)
    found['coulomb, capped'] = laws['coulomb'].props('tau_max')
    found[WITH_OPTIONS] = laws['coulomb'].props('cohesion', 'eta_t')
    found['subloading, cohesion and damper'] = laws['subloading'].props('cohesion', 'eta_t')
    return found


WITH_OPTIONS = 'coulomb, cohesion and damper'   # has a closed form of its own: CoulombPoint
LAWS = host_laws()
CREEPING = [name for name in LAWS if 'theta_0' in law_examples.laws().get(name, law_examples.laws()['coulomb']).names]

Numbers = ctypes.POINTER(ctypes.c_double)


class FrictionPoint:
    """One contact point and its state."""

    library = None

    def __init__(self, props):
        if FrictionPoint.library is None:
            FrictionPoint.library = ctypes.CDLL(os.environ['STICKSLIP_LIBRARY'])
            FrictionPoint.library.friction_update.argtypes = [
                ctypes.c_int, Numbers, ctypes.c_double, ctypes.c_int, Numbers, ctypes.c_int, Numbers, Numbers, Numbers]
        self.props = (ctypes.c_double * len(props))(*props)
        self.statev = (ctypes.c_double * 8)()
        self.tangent = []   # of the last update, column by column

    def update(self, du, dt):
        """Traction at the end of an increment: normal, then tangential."""
        n = len(du)
        traction, tangent = (ctypes.c_double * n)(), (ctypes.c_double * (n * n))()
        status = self.library.friction_update(n, (ctypes.c_double * n)(*du), dt, len(self.props), self.props, 8,
                                              self.statev, traction, tangent)
        if status < 0:
            raise RuntimeError(f'friction_update: code {status}')
        self.tangent = list(tangent)
        return list(traction)


class CoulombPoint:
    """The same under Coulomb friction with cohesion and damper, from docs/theory.md, sections 3, 15 and 16, without the
    library: spring and damper in parallel, slip at mu p + c along the trial traction.

    props: number of the law, alpha_n, alpha_t, mu, three options that are off, cohesion, eta_t.
    """

    def __init__(self, props):
        self.alpha_n, self.alpha_t, self.mu = props[1:4]
        self.cohesion, self.eta = props[7:]
        self.statev = [0.0] * 8

    def update(self, du, dt):
        gap, normal, spring = self.statev[1], self.statev[1] + du[0], self.statev[2:2 + len(du) - 1]
        self.statev[1], self.statev[4] = normal, self.mu
        if normal > 0:
            self.statev[0], self.statev[2:4] = 3, [0.0, 0.0]
            return [0.0] * len(du)
        touched = min(1.0, normal / du[0]) if gap > 0 else 1.0   # the share of the increment after touchdown
        moved, pressure, rate = [touched * x for x in du[1:]], -self.alpha_n * normal, self.eta / dt
        trial = [self.alpha_t * (e + x) + rate * x for e, x in zip(spring, moved)]
        size, strength = math.hypot(*trial), self.mu * pressure + self.cohesion
        kept = min(1.0, strength / size) if size > 0 else 1.0
        traction = [kept * x for x in trial]
        new = [(x + rate * e) / (self.alpha_t + rate) for x, e in zip(traction, spring)]
        slip = (1 - kept) * size / (self.alpha_t + rate)
        self.statev[0], self.statev[2:2 + len(new)] = 2 if kept < 1 else 1, new
        self.statev[6] += slip
        self.statev[7] += kept * size * slip + rate * sum((b - a)**2 for a, b in zip(spring, new))
        return [-pressure, *traction]
