"""The shared library through its C interface, include/friction.h."""
import ctypes

Numbers = ctypes.POINTER(ctypes.c_double)
SUBLOADING, COULOMB, STATIC_KINETIC, RATE_AND_STATE, SLIP_WEAKENING, SLIP_WEAKENING_HEALING, FLASH_HEATING, \
    LINKER_DIETERICH = range(1, 9)


class Library:
    def __init__(self, path):
        self.functions = ctypes.CDLL(str(path))
        self.functions.friction_update.argtypes = [
            ctypes.c_int, Numbers, ctypes.c_double, ctypes.c_int, Numbers, ctypes.c_int, Numbers, Numbers, Numbers]
        self.functions.friction_version.restype = ctypes.c_char_p

    def version(self):
        return self.functions.friction_version().decode()

    def point(self, *props):
        return Point(self.functions.friction_update, props)


class Point:
    """One contact point, three-dimensional, and its state."""

    def __init__(self, update, props):
        self.function = update
        self.props = (ctypes.c_double * len(props))(*props)
        self.statev = (ctypes.c_double * 8)()
        self.traction = (ctypes.c_double * 3)()
        self.tangent = (ctypes.c_double * 9)()
        self.press = 0.0

    def update(self, normal, first, second, dt):
        """Moves the point by an increment; gives the tangential traction along the first axis."""
        status = self.function(3, (ctypes.c_double * 3)(normal, first, second), dt, len(self.props), self.props, 8,
                               self.statev, self.traction, self.tangent)
        if status < 0:
            raise RuntimeError(f'friction_update: code {status}')
        return self.traction[1]

    def pressed(self, pressure):
        """Puts the point under a pressure."""
        self.update(-pressure / self.props[1], 0.0, 0.0, 0.0)
        return self

    def shear(self, du, dt):
        return self.update(0.0, du, 0.0, dt)

    @property
    def mu(self):
        return self.statev[4]

    @property
    def internal(self):
        """R, theta or D, as the law has it."""
        return self.statev[5]

    @property
    def slip(self):
        return self.statev[6]

    @property
    def dissipated(self):
        return self.statev[7]
