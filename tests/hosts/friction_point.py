"""`friction_update` of libstickslip.so for the tests of finite-element hosts.

STICKSLIP_LIBRARY names the shared library.
"""
import ctypes
import os

# law, alpha_n, alpha_t and what follows (docs/laws.md): constants under which a host is run, for N, mm and s, its
# pressures of 3 to 4 N/mm^2, and slips of some hundredths of a millimetre
LAWS = {
    'subloading': [1, 1000, 800, 0.45, 0.25, 8, 0.2, 60],
    'subloading, exact rate': [1, 1000, 800, 0.45, 0.25, 8, 0.2, 60, 0.45, 1],
    'Coulomb, capped': [2, 1000, 800, 0.4, 0.8],
    'static-kinetic': [3, 1000, 800, 0.45, 0.25, 1],
    'rate-and-state': [4, 1000, 800, 0.01, 0.015, 1e-2, 1e-2, 0.4, 0, 0.5],
    'slip-weakening': [5, 1000, 800, 0.45, 0.25, 1e-2],
    'slip-weakening, healing': [6, 1000, 800, 0.45, 0.25, 1e-2, 1],
    'Linker-Dieterich': [8, 1000, 800, 0.01, 0.015, 1e-2, 1e-2, 0.4, 0.1, 0, 0.5],
    'flash heating': [7, 1000, 800, 0.01, 0.015, 1e-2, 1e-2, 0.4, 0.25, 0.05, 8, 0.5],
}
CREEPING = ('rate-and-state', 'flash heating', 'Linker-Dieterich')   # under any load


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
