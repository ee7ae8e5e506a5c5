# /// script
# requires-python = ">=3.11"
# dependencies = ["h5py>=3.10", "matplotlib>=3.8", "numpy>=1.26"]
# ///
"""Reads a map of decay rates with h5py: a value, a condition on the status, a picture. A part of a large map is read on its own.

    slipmap run sweeps/decay_load.toml
    python read_h5py.py decay_load.h5 picture.png
"""

import sys

import h5py
import matplotlib.pyplot as plt
import numpy as np

path, picture = sys.argv[1:]


def text(item, attribute):
    return item.attrs[attribute].decode()


def nearest(axis, value):
    """Number of the cell nearest to a physical value."""
    return int(np.abs(axis - value).argmin())


with h5py.File(path) as cells:
    # The dimensions of each field have the axes as scales.
    mu_prime, alpha_n, tau = (scale[0][:] for scale in cells["abscissa"].dims)

    # By physical value: the nearest cell.
    i, j, k = nearest(mu_prime, -0.3), nearest(alpha_n, -1.5), nearest(tau, 0.8)
    print("nearest", *map(float, (mu_prime[i], alpha_n[j], tau[k], cells["abscissa"][i, j, k])))

    # One plane; of a large map, only its chunks are read.
    abscissa, status = cells["abscissa"][i], cells["status"][i]
    flags = dict(zip(text(cells["status"], "flag_meanings").split(), cells["status"].attrs["flag_masks"]))
    labels = {name: text(cells[name], "long_name") for name in ["alpha_n", "tau"]}

# By status: only cells whose abscissa a second method has confirmed.
certified = (status & flags["certified"]) != 0
print("certified", certified.sum(), "of", certified.size)

plt.pcolormesh(alpha_n, tau, np.where(certified, abscissa, np.nan).T, vmin=-1, vmax=1, cmap="BrBG_r")
plt.colorbar(label="abscissa")
plt.xlabel(labels["alpha_n"])
plt.ylabel(labels["tau"])
plt.title(f"mu_prime = {mu_prime[i]}")
plt.savefig(picture, dpi=150)
