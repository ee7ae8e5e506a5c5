# /// script
# requires-python = ">=3.10"
# dependencies = ["slipmap[maps]", "scipy>=1.11"]
# ///
"""Reads a map of decay rates with xarray: a value, a condition on the status, a picture with the exact boundaries.

    slipmap run sweeps/decay_load.toml
    python read_xarray.py decay_load.h5 picture.png
"""

import sys

import slipmap

path, picture = sys.argv[1:]
tree = slipmap.open_map(path)
cells = tree.dataset

# By physical value: the nearest cell, and between cells.
nearest = cells.sel(mu_prime=-0.3, alpha_n=-1.5, tau=0.8, method="nearest")
print("nearest", *(float(nearest[name]) for name in ["mu_prime", "alpha_n", "tau", "abscissa"]))
plane = cells.sel(mu_prime=-0.3, method="nearest")
print("interpolated", float(plane.abscissa.interp(alpha_n=-1.5, tau=0.8)))

# By status: only cells whose abscissa a second method has confirmed.
certified = tree.slipmap.flag("certified").sel(mu_prime=-0.3, method="nearest")
print("certified", int(certified.sum()), "of", certified.size)

# A field with the boundary of stability as exact curves.
tree.slipmap.plot("abscissa", mu_prime=-0.3).figure.savefig(picture, dpi=150)
