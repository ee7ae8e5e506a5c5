#!/usr/bin/env python3
# /// script
# requires-python = ">=3.11"
# dependencies = ["matplotlib>=3.8", "xarray>=2024.1", "netCDF4>=1.6.5", "numpy>=1.26"]
# ///
"""Draws the letter's Fig. 4 from a map of slipmap, for print.

    uv run scripts/plot_fig4.py fig4.h5 -o fig4.pdf

(a) The critical velocity and the lift-off as solid lines, the letter's approximations dotted, as in the letter. (b) How far each
approximation is off. Nothing is computed again.
"""

import sys

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np

import figures

EXACT, WEAK, STRONG, LIFTOFF = "#440154", "#31688e", "#1f9e89", "#6b6b6b"
DOTTED = (0, (1, 1.6))
# How far down the velocities are shown, and how small and large the errors.
LOWEST_VELOCITY = 1e-3
ERRORS = (1e-3, 10.0)

VELOCITIES = [
    ("liftoff_over_vtilde", LIFTOFF, "-", "lift-off"),
    ("vc_weak_control", WEAK, DOTTED, r"$v_c$ for $\gamma\to 0$"),
    ("vc_strong_control", STRONG, DOTTED, r"$v_c$ for $\gamma\to 1$"),
    ("vc_over_vtilde", EXACT, "-", r"$v_c$"),
]
APPROXIMATIONS = [
    ("weak_control_error", WEAK, r"$\gamma\to 0$"),
    ("strong_control_error", STRONG, r"$\gamma\to 1$"),
]


def read(path):
    """The map's cells over gamma, in memory."""
    cells = figures.read(path, "map").squeeze()
    fields = [name for name, *_ in VELOCITIES + APPROXIMATIONS]
    missing = [name for name in fields if name not in cells]
    if missing:
        raise figures.NoFigure(f"{path}: the map has no {missing[0]}; this figure needs one of protocol = \"limit\"")
    if cells.vc_over_vtilde.dims != ("gamma",):
        axes = ", ".join(cells.vc_over_vtilde.dims)
        raise figures.NoFigure(f"{path}: the axes are {axes}; this figure needs gamma alone")
    return cells


def draw_velocities(axes, cells):
    for name, colour, style, label in VELOCITIES:
        axes.semilogy(cells.gamma, cells[name], color=colour, linestyle=style, label=label)
    axes.set_ylim(LOWEST_VELOCITY, cells.liftoff_over_vtilde.values.max())
    axes.set_ylabel(r"$v_0/\tilde{v}$")
    ratio = float(cells.mu_ratio)
    axes.set_title(rf"(a) $\mu_K/\mu_S = {ratio:g}$", loc="left", fontsize=9, pad=4)
    axes.legend(loc="upper right", fontsize=8, frameon=False, handlelength=1.6)


def draw_errors(axes, cells):
    for name, colour, label in APPROXIMATIONS:
        axes.semilogy(cells.gamma, np.abs(cells[name]), color=colour, label=label)
    axes.set_ylim(*ERRORS)
    axes.set_ylabel("relative error")
    axes.set_title("(b) how far the approximations are off", loc="left", fontsize=9, pad=4)
    axes.legend(loc="lower center", fontsize=8, frameon=False, handlelength=1.6)


def figure(paths):
    cells = read(paths[0])
    with mpl.rc_context(figures.STYLE):
        fig, (velocities, errors) = plt.subplots(1, 2, figsize=(7.0, 2.9), layout="constrained")
        draw_velocities(velocities, cells)
        draw_errors(errors, cells)
        for axes in (velocities, errors):
            axes.set_xlabel(r"$\gamma$")
            axes.set_xlim(0.0, max(1.0, float(cells.gamma.max())))
        return fig


if __name__ == "__main__":
    sys.exit(figures.main(__doc__, figures.STYLE, figure, ["the map of sweeps/fig4.toml"], "fig4.pdf"))
