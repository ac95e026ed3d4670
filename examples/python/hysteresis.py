#!/usr/bin/env python3
"""Slides a contact point forth and back through the C interface and draws the hysteresis loop.

Usage: python hysteresis.py PATH/libstickslip.so    (needs numpy and matplotlib)
"""
import ctypes
import sys

import matplotlib
import numpy as np

matplotlib.use('Agg')
import matplotlib.pyplot as plt  # noqa: E402

library = ctypes.CDLL(sys.argv[1])
library.friction_message.restype = ctypes.c_char_p
array = np.ctypeslib.ndpointer(np.float64, flags='C_CONTIGUOUS')
library.friction_update.argtypes = [ctypes.c_int, array, ctypes.c_double, ctypes.c_int, array, ctypes.c_int, array,
                                    array, array]

# law, alpha_n, alpha_t [N/mm^3], mu_s, mu_k [-], kappa [1/mm], xi [1/s], m [1/mm]
props = np.array([1, 1000, 800, 0.45, 0.25, 8, 0.2, 500], float)
statev, traction, tangent = np.zeros(8), np.zeros(2), np.zeros(4)


def update(normal, tangential, dt=0.001):
    """Moves the point by an increment; gives the shear traction."""
    status = library.friction_update(2, np.array([normal, tangential]), dt, len(props), props, 8, statev, traction,
                                     tangent)
    if status < 0:
        sys.exit(library.friction_message(status).decode())
    return traction[1]


update(-0.01, 0.0)
position = 0.05 * np.sin(np.linspace(0, 6 * np.pi, 3001))
shear = [0.0] + [update(0.0, step) for step in np.diff(position)]
plt.plot(position, shear)
plt.xlabel('displacement [mm]')
plt.ylabel('shear traction [N/mm$^2$]')
plt.grid(True)
plt.savefig('hysteresis.png', dpi=120)
print(f'largest shear {max(shear):.6f} N/mm^2, dissipated {statev[7]:.6f} N/mm; picture: hysteresis.png')
