#!/usr/bin/env python3
# /// script
# requires-python = ">=3.11"
# dependencies = ["matplotlib>=3.8", "xarray>=2024.1", "netCDF4>=1.6.5", "numpy>=1.26"]
# ///
"""Draws the letter's Fig. 3 from two traces of slipmap, for print.

    uv run scripts/plot_fig3.py fig3a.h5 fig3b.h5 -o fig3.pdf

One column for each trace: the velocities of the block and of the pull, the elongation, and the quantity that is controlled;
shaded where the block sticks, dashed where control is switched on. Nothing is computed again.
"""

import sys

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np

import figures

BLOCK, PULL, STUCK = "#440154", "#7ad151", "#e2d8c0"

def read(path):
    """The samples and the events of a trace, in memory."""
    return figures.read(path, "trace"), figures.load(path, group="event")


def times(events, kind):
    """When events of a kind are."""
    number = events.kind.flag_meanings.split().index(kind)
    return events.t.values[events.kind.values == number]


def sticks(trace):
    """(from, to) of every stretch of time in which the block sticks."""
    number = trace.mode.flag_meanings.split().index("stick")
    stuck = np.concatenate([[False], trace.mode.values == number, [False]])
    t = trace.t.values
    starts, ends = np.flatnonzero(np.diff(stuck.astype(int)) == 1), np.flatnonzero(np.diff(stuck.astype(int)) == -1)
    return [(t[start], t[min(end, len(t) - 1)]) for start, end in zip(starts, ends, strict=True)]


def unit(variable):
    return "" if variable.units == "1" else f" ({variable.units})"


def draw(column, trace, events):
    t = trace.t.values
    controlled = ("N", "$N$") if float(trace.alpha_n) != 0.0 else ("v", "$v$")
    velocity, elongation, control = column
    velocity.plot(t, trace.v, color=PULL, label="$v$")
    velocity.plot(t, trace.x_dot, color=BLOCK, label=r"$\dot{x}$")
    velocity.set_ylabel(r"$\dot{x},\ v$" + unit(trace.x_dot))
    velocity.legend(loc="upper right", fontsize=8, frameon=False, handlelength=1.2, ncols=2, columnspacing=1.0)
    elongation.plot(t, trace.a, color=BLOCK)
    elongation.set_ylabel("$a$" + unit(trace.a))
    control.plot(t, trace[controlled[0]], color=PULL)
    control.set_ylabel(controlled[1] + unit(trace[controlled[0]]))
    control.set_xlabel("$t$" + unit(trace.t))
    for axes in column:
        axes.set_xlim(t[0], t[-1])
        axes.margins(y=0.08)
        for start, end in sticks(trace):
            axes.axvspan(start, end, color=STUCK, linewidth=0, zorder=0)
        for switched in times(events, "switch_on"):
            axes.axvline(switched, color="0.35", linewidth=0.7, linestyle=(0, (4, 3)))


def figure(paths):
    traces = [read(path) for path in paths]
    with mpl.rc_context(figures.STYLE):
        fig, rows = plt.subplots(3, len(traces), figsize=(7.0, 4.2), sharex="col", layout="constrained", squeeze=False)
        for column, (trace, events), letter in zip(rows.T, traces, "ab", strict=True):
            draw(column, trace, events)
            control = "load" if float(trace.alpha_n) != 0.0 else "velocity"
            column[0].set_title(f"({letter}) {control} control", loc="left", fontsize=9, pad=4)
        fig.align_ylabels()
        return fig


if __name__ == "__main__":
    columns = ["the trace of column (a)", "the trace of column (b)"]
    sys.exit(figures.main(__doc__, figures.STYLE, figure, columns, "fig3.pdf"))
