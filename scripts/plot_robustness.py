#!/usr/bin/env python3
# /// script
# requires-python = ">=3.11"
# dependencies = ["matplotlib>=3.8", "xarray>=2024.1", "netCDF4>=1.6.5", "numpy>=1.26"]
# ///
"""Draws how robust velocity and load control are, from two maps of slipmap, for print.

    uv run scripts/plot_robustness.py robust_velocity.h5 robust_load.h5 -o robustness.pdf

The share of the plane of gain and delay in which sliding is stable and free of stick-slip, (a) against the pulling velocity, (b)
against how long the uncontrolled block sticks there, over how long it slips. The times of the uncontrolled cycle are computed by
`slipmap simulate`: the program that SLIPMAP names, or else target/release/slipmap, or else slipmap on the path.
"""

import functools
import json
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np

import figures

VELOCITY, LOAD = "#440154", "#35978f"
STYLES = ["-", (0, (4, 1.5)), (0, (1, 1.2))]
VELOCITIES = np.geomspace(0.02, 2.0, 41)
CASE = """
[friction]
law = "weakening"
mu0 = {mu0!r}
mu_prime_rest = {slope!r}
[fixed]
v0 = {v0!r}
[start]
x_dot0 = 0.0
a0 = 1.0
"""


def program():
    """The path of slipmap."""
    built = Path(__file__).resolve().parent.parent / "target/release/slipmap"
    found = os.environ.get("SLIPMAP") or (built if built.is_file() else shutil.which("slipmap"))
    if not found:
        raise figures.NoFigure("slipmap is not found: build it, or set SLIPMAP to its path")
    return str(found)


def read(path, gain):
    """The map of v_smooth over the slope at rest, the gain and the delay."""
    cells = figures.read(path, "map")
    if "v_smooth" not in cells or set(cells.v_smooth.dims) != {"mu_prime_rest", gain, "tau"}:
        raise figures.NoFigure(f"{path}: this figure needs v_smooth over mu_prime_rest, {gain} and tau")
    scales = [float(cells[name]) for name in ("mass", "stiffness", "normal_load", "mu_s")]
    if scales != [1.0] * 4:
        raise figures.NoFigure(f"{path}: this figure is for mass, stiffness, normal_load and mu_s of 1")
    return cells


def shares(cells, slope):
    """For each velocity, the share of the cells in which sliding is smooth above it; undecided cells are not."""
    plane = cells.sel(mu_prime_rest=slope)
    flags = dict(zip(plane.status.flag_meanings.split(), plane.status.flag_masks, strict=True))
    decided = (plane.status.values & flags["not_converged"]) == 0
    smooth = np.where(decided, plane.v_smooth.values, np.nan)
    return np.array([np.mean(smooth <= v0) for v0 in VELOCITIES])


@functools.cache
def uncontrolled(slipmap, mu0, slope, v0):
    """Stick time over slip time of the cycle that follows release without control; NaN where the block does not stick again."""
    with tempfile.TemporaryDirectory() as folder:
        case = Path(folder, "case.toml")
        case.write_text(CASE.format(mu0=mu0, slope=slope, v0=v0))
        done = subprocess.run(
            [slipmap, "simulate", case, "-o", case.with_suffix(".h5"), "--json"], capture_output=True, text=True
        )
    if done.returncode != 0:
        raise figures.NoFigure(f"slipmap simulate: {done.stderr.strip()}")
    found = json.loads(done.stdout)
    if found["outcome"] != "stick-slip":
        return np.nan
    return found["stick_time"] / found["slip_time"]


def draw(against_velocity, against_times, maps, slipmap):
    for (cells, name, colour), first in zip(maps, (True, False), strict=True):
        slopes = cells.mu_prime_rest.values.tolist()
        if len(slopes) > len(STYLES):
            raise figures.NoFigure(f"at most {len(STYLES)} slopes can be told apart")
        for slope, style in zip(slopes, STYLES, strict=False):
            share = 100.0 * shares(cells, slope)
            times = [uncontrolled(slipmap, float(cells.mu0), slope, float(v0)) for v0 in VELOCITIES]
            label = f"{name} control" if style == "-" else None
            against_velocity.semilogx(VELOCITIES, share, color=colour, linestyle=style, label=label)
            against_times.semilogx(times, share, color=colour, linestyle=style)
            if first:
                against_times.plot([], [], color="0.3", linestyle=style, label=rf"$\mu'(0) = {slope:g}$")


def figure(paths):
    maps = [(read(paths[0], "alpha_v"), "velocity", VELOCITY), (read(paths[1], "alpha_n"), "load", LOAD)]
    slipmap = program()
    with mpl.rc_context(figures.STYLE):
        fig, (left, right) = plt.subplots(1, 2, figsize=(7.0, 2.9), sharey=True, layout="constrained")
        draw(left, right, maps, slipmap)
        left.set_xlim(VELOCITIES[0], VELOCITIES[-1])
        left.set_ylim(0.0, None)
        left.set_xlabel("$v_0$")
        left.set_ylabel("stable and free of stick-slip (%)")
        left.set_title("(a) against the pulling velocity", loc="left", fontsize=9, pad=4)
        left.legend(loc="upper left", fontsize=8, frameon=False, handlelength=1.6)
        right.set_xlim(0.03, 30.0)
        right.set_xlabel("stick time over slip time without control")
        right.set_title("(b) against the uncontrolled cycle", loc="left", fontsize=9, pad=4)
        right.legend(loc="upper right", fontsize=8, frameon=False, handlelength=2.2)
        return fig


if __name__ == "__main__":
    files = ["the map of sweeps/robust_velocity.toml", "the map of sweeps/robust_load.toml"]
    sys.exit(figures.main(__doc__, figures.STYLE, figure, files, "robustness.pdf"))
