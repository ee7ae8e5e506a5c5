#!/usr/bin/env python3
# /// script
# requires-python = ">=3.11"
# dependencies = ["matplotlib>=3.8", "xarray>=2024.1", "netCDF4>=1.6.5", "numpy>=1.26"]
# ///
"""Draws the critical velocity of Coulomb friction under load control over γ, at finite delays, for print.

    uv run scripts/plot_coulomb_load.py coulomb_load.h5 fig4.h5 -o coulomb_load.pdf

(a) At some delays, and the limit of a short delay from the map of the letter's Fig. 4. (b) Over γ = −μ_K α_N τ/(2√(κM)) and τ:
where stick-slip is never sustained, and where the load reaches 0 before stick-slip ends. Nothing is computed again.
"""

import sys

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import LogNorm
from matplotlib.patches import Patch

import figures

LIMIT, NEVER, LIFTOFF = "0.1", "#bfe3ff", "#c994c7"
DELAYS = [0.02, 0.2, 0.5, 0.9, 1.1]
GAMMAS = (0.05, 5.0)
# How far down the velocities are shown.
LOWEST_VELOCITY = 1e-4


def read(path):
    """The map over alpha_n and tau, with γ and v_c/ṽ of every cell."""
    cells = figures.read(path, "map").squeeze()
    if "vc" not in cells or "outcome" not in cells or set(cells.vc.dims) != {"alpha_n", "tau"}:
        raise figures.NoFigure(f"{path}: this figure needs vc and outcome over alpha_n and tau")
    if "mu0" not in cells or "v_s" in cells:
        raise figures.NoFigure(f"{path}: this figure needs Coulomb friction")
    cells = cells.transpose("alpha_n", "tau")
    unit = np.sqrt(float(cells.mass) * float(cells.stiffness))
    mu0, load = float(cells.mu0), float(cells.normal_load)
    cells["gamma"] = -0.5 * mu0 * cells.alpha_n * cells.tau / unit
    cells["reduced"] = cells.vc * unit / ((float(cells.mu_s) - mu0) * load)
    return cells


def read_limit(path, ratio):
    """The limit's curve over gamma, for the same ratio of the coefficients."""
    limit = figures.read(path, "map").squeeze()
    if "vc_over_vtilde" not in limit or limit.vc_over_vtilde.dims != ("gamma",):
        raise figures.NoFigure(f"{path}: this figure needs vc_over_vtilde over gamma")
    if abs(float(limit.mu_ratio) - ratio) > 1e-12:
        raise figures.NoFigure(f"{path}: mu_ratio is {float(limit.mu_ratio):g}, not {ratio:g} as in the other map")
    return limit


def draw_curves(axes, cells, limit):
    colours = mpl.colormaps["viridis"](np.linspace(0.0, 0.8, len(DELAYS)))
    axes.semilogy(limit.gamma, limit.vc_over_vtilde, color=LIMIT, linestyle=(0, (3, 1.5)), label=r"$\tau\to 0$")
    for delay, colour in zip(DELAYS, colours, strict=True):
        column = cells.sel(tau=delay, method="nearest").sortby("gamma")
        shown = np.where(column.reduced > LOWEST_VELOCITY, column.reduced, np.nan)
        axes.semilogy(column.gamma, shown, color=colour, label=rf"$\tau = {float(column.tau):.2g}$")
    axes.set_xlim(0.0, 2.9)
    axes.set_ylim(1e-3, 2.0)
    axes.set_xlabel(r"$\gamma$")
    axes.set_ylabel(r"$v_c/\tilde{v}$")
    axes.set_title("(a) some delays", loc="left", fontsize=9, pad=4)
    axes.legend(loc="lower right", fontsize=8, frameon=False, handlelength=1.6)


def edges(values):
    """Geometric middles between positive values, and as far beyond the ends."""
    logarithms = np.log(values)
    inner = 0.5 * (logarithms[1:] + logarithms[:-1])
    return np.exp(np.concatenate([[2 * logarithms[0] - inner[0]], inner, [2 * logarithms[-1] - inner[-1]]]))


def draw_cells(axes, cells, values, **style):
    """The cells of every delay as rectangles over γ."""
    delays = edges(cells.tau.values)
    for j in range(cells.sizes["tau"]):
        gamma = cells.gamma.values[:, j]
        drawn = axes.pcolormesh(edges(gamma), delays[j : j + 2], values[None, :, j], rasterized=True, **style)
    return drawn


def draw_plane(fig, axes, cells):
    positive = np.where(cells.reduced > 0.0, cells.reduced, np.nan)
    drawn = draw_cells(axes, cells, positive, norm=LogNorm(LOWEST_VELOCITY, 2.0), cmap="viridis")
    for name, colour in (("never", NEVER), ("lift-off", LIFTOFF)):
        ends = np.where(cells.outcome == cells.outcome.flag_meanings.split().index(name), 1.0, np.nan)
        draw_cells(axes, cells, ends, cmap=mpl.colors.ListedColormap([colour]))
    axes.axvline(1.0, color=LIMIT, linewidth=0.7, linestyle=(0, (3, 1.5)))
    axes.set(xscale="log", yscale="log", xlim=GAMMAS, ylim=(cells.tau.min(), cells.tau.max()))
    axes.set_xlabel(r"$\gamma$")
    axes.set_ylabel(r"$\tau\sqrt{\kappa/M}$")
    axes.set_title("(b) over the delay", loc="left", fontsize=9, pad=4)
    names = [Patch(color=NEVER, label="$v_c = 0$"), Patch(color=LIFTOFF, label="lift-off")]
    axes.legend(handles=names, loc="lower left", fontsize=8, handlelength=1.0, borderpad=0.4)
    fig.colorbar(drawn, ax=axes, label=r"$v_c/\tilde{v}$", pad=0.02)


def figure(paths):
    cells = read(paths[0])
    limit = read_limit(paths[1], float(cells.mu0) / float(cells.mu_s))
    with mpl.rc_context(figures.STYLE):
        fig, (curves, plane) = plt.subplots(1, 2, figsize=(7.0, 2.9), layout="constrained")
        draw_curves(curves, cells, limit)
        draw_plane(fig, plane, cells)
        return fig


if __name__ == "__main__":
    files = ["the map of sweeps/coulomb_load.toml", "the map of sweeps/fig4.toml"]
    sys.exit(figures.main(__doc__, figures.STYLE, figure, files, "coulomb_load.pdf"))
