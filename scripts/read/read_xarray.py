# /// script
# requires-python = ">=3.11"
# dependencies = ["matplotlib>=3.8", "xarray>=2024.1", "netCDF4>=1.6.5", "scipy>=1.11"]
# ///
"""Reads a map of decay rates with xarray: a value, a condition on the status, a picture with the exact boundaries.

    slipmap run sweeps/decay_load.toml
    python read_xarray.py decay_load.h5 picture.png
"""

import sys

import matplotlib.pyplot as plt
import numpy as np
import xarray as xr

path, picture = sys.argv[1:]

# Without mask_and_scale the status would become a floating-point number.
cells = xr.open_dataset(path, mask_and_scale=False)

# By physical value: the nearest cell, and between cells.
nearest = cells.sel(mu_prime=-0.3, alpha_n=-1.5, tau=0.8, method="nearest")
print("nearest", *(float(nearest[name]) for name in ["mu_prime", "alpha_n", "tau", "abscissa"]))
plane = cells.sel(mu_prime=-0.3, method="nearest")
print("interpolated", float(plane.abscissa.interp(alpha_n=-1.5, tau=0.8)))

# By status: only cells whose abscissa a second method has confirmed.
flags = dict(zip(cells.status.flag_meanings.split(), cells.status.flag_masks))
certified = (plane.status & flags["certified"]) != 0
print("certified", int(certified.sum()), "of", certified.size)

plane.abscissa.where(certified).plot(x="alpha_n", y="tau", vmin=-1, vmax=1, cmap="BrBG_r", cbar_kwargs={"label": "abscissa"})
plt.title(f"mu_prime = {float(plane.mu_prime)}")

# The boundary of stability as exact curves, one after the other.
curves = xr.open_dataset(path, group="boundaries", mask_and_scale=False)
ends = np.cumsum(curves.vertex_count.values)[:-1]
boundary = (curves.mu_prime == plane.mu_prime) & (curves.degree_of_stability == 0) & (curves.stable_side != 0)
for alpha_n, tau, drawn in zip(np.split(curves.alpha_n.values, ends), np.split(curves.tau.values, ends), boundary):
    if drawn:
        plt.plot(alpha_n, tau, "k", linewidth=1)
plt.savefig(picture, dpi=150)
