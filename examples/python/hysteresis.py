#!/usr/bin/env python3
"""Slides a contact point forth and back and draws the hysteresis loop. Needs the package stickslip and matplotlib."""
import matplotlib
import numpy as np

import stickslip

matplotlib.use('Agg')
import matplotlib.pyplot as plt  # noqa: E402

# N, mm, s
law = stickslip.laws.Subloading(alpha_n=1000, alpha_t=800, mu_s=0.45, mu_k=0.25, kappa=8, xi=0.2, m=500)

point = stickslip.update([-0.01, 0.0], 0.001, law)   # pressed on its base
position = 0.05 * np.sin(np.linspace(0, 6 * np.pi, 3001))
shear = [point.traction[1]]
for step in np.diff(position):
    point = stickslip.update([0.0, step], 0.001, law, point.state)
    shear.append(point.traction[1])

plt.plot(position, shear)
plt.xlabel('displacement [mm]')
plt.ylabel('shear traction [N/mm$^2$]')
plt.grid(True)
plt.savefig('hysteresis.png', dpi=120)
print(f'largest shear {max(shear):.6f} N/mm^2, dissipated {point.state[7]:.6f} N/mm; picture: hysteresis.png')
