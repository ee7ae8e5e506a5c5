#!/usr/bin/env python3
# /// script
# requires-python = ">=3.11"
# dependencies = ["matplotlib>=3.8", "xarray>=2024.1", "netCDF4>=1.6.5", "numpy>=1.26"]
# ///
"""Draws the letter's Fig. 2 from two maps of slipmap, for print.

    uv run scripts/plot_fig2.py fig2a.h5 fig2b.h5 -o fig2.pdf

Lines are the exact boundaries that the maps hold; shaded is where their count of unstable roots is zero, the darker the more
of the slopes have it so. Nothing is computed again.
"""

import sys

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
import xarray as xr

import figures

# Size of the labels on the lines, in points.
LABEL_SIZE = 7

# Axis of the map across the panel: its symbol, and what the panel shows.
PANELS = {
    "alpha_v": (r"$\alpha_v$", "velocity control"),
    "alpha_n": (r"$\alpha_N$", "load control"),
}

STYLE = figures.STYLE | {
    "xtick.minor.visible": True,
    "ytick.minor.visible": True,
    "xtick.minor.width": 0.4,
    "ytick.minor.width": 0.4,
}


class Panel:
    """What one panel needs of a map."""

    def __init__(self, path):
        self.path = path
        cells, curves = read(path)
        self.gain = next((name for name in PANELS if cells.sizes.get(name, 1) > 1), None)
        if self.gain is None:
            raise figures.NoFigure(f"{path}: neither alpha_v nor alpha_n is an axis of the map")
        missing = {"mu_prime", "tau"} - set(cells.n_unstable.dims)
        other = set(cells.n_unstable.dims) - {"mu_prime", "tau", self.gain}
        if missing or other:
            raise figures.NoFigure(
                f"{path}: the axes are {', '.join(cells.n_unstable.dims)}; this figure needs mu_prime, tau and one gain"
            )
        if self.gain not in curves or "mu_prime" not in curves:
            raise figures.NoFigure(f"{path}: the boundaries are not those over {self.gain} and tau")
        self.x = cells[self.gain].values
        self.tau = cells["tau"].values
        self.slopes = cells["mu_prime"].values
        self.stable = (cells.n_unstable == 0).transpose("mu_prime", "tau", self.gain).values
        self.curves = stable_pieces(curves, self.gain)


def read(path):
    """The cells and the boundaries of a map, in memory."""
    cells = figures.read(path, "map")
    if "n_unstable" not in cells:
        raise figures.NoFigure(f"{path}: the map has no n_unstable; add it to the sweep's fields")
    try:
        return cells, figures.load(path, group="boundaries")
    except (OSError, ValueError) as error:
        raise figures.NoFigure(f"{path}: the map has no boundaries; set boundaries = true in the sweep") from error


def stable_pieces(curves, gain):
    """(mu_prime, x, tau) of every piece of a crossing curve with the stable region beside it."""
    degrees = curves.get("degree_of_stability", xr.zeros_like(curves["stable_side"])).values
    ends = np.cumsum(curves["vertex_count"].values)
    starts = ends - curves["vertex_count"].values
    return [
        (slope, curves[gain].values[start:end], curves["tau"].values[start:end])
        for slope, side, degree, start, end in zip(
            curves["mu_prime"].values, curves["stable_side"].values, degrees, starts, ends, strict=True
        )
        if side != 0 and degree == 0
    ]


def colours(slopes):
    """One colour for each slope, the same in both panels: dark where friction weakens least."""
    ordered = sorted(slopes, reverse=True)
    shades = mpl.colormaps["viridis"](np.linspace(0.0, 0.8, len(ordered)))
    return dict(zip(ordered, shades, strict=True))


def shade(axes, panel, colour):
    """A light veil over each slope's stable cells."""
    for slope, stable in zip(panel.slopes, panel.stable, strict=True):
        if stable.any():
            axes.contourf(panel.x, panel.tau, stable, levels=[0.5, 1.5], colors=[colour[slope]], alpha=0.10)


def draw(axes, panel, colour):
    shade(axes, panel, colour)
    for slope, x, tau in panel.curves:
        axes.plot(x, tau, color=colour[slope], solid_joinstyle="round", clip_on=True)
    axes.set_xlim(panel.x.min(), panel.x.max())
    axes.set_ylim(panel.tau.min(), panel.tau.max())
    label(axes, panel, colour)


def label(axes, panel, colour):
    """Writes each slope near its own line and leads to it, through as few other lines as can be."""
    point = axes.figure.dpi / 72
    lines = {}
    for slope, x, tau in panel.curves:
        lines.setdefault(slope, []).append(axes.transData.transform(np.column_stack([x, tau])))
    labels = Labels(axes.get_window_extent(), lines, point)
    to_data = axes.transData.inverted().transform
    # The smallest regions first: they have the fewest places to choose from.
    for slope in sorted(lines):
        text = f"${slope:g}$"
        if slope == max(lines):
            text = rf"$\mu′ = {slope:g}$"
        found = labels.place(slope, LABEL_SIZE * point * (0.5 * len(f"{slope:g}") + 1.8 * (slope == max(lines))))
        if found is None:
            print(f"{panel.path}: no room for the label of mu_prime = {slope:g}", file=sys.stderr)
            continue
        centre, start, end = found
        x, y = to_data(centre)
        axes.text(x, y, text, color=colour[slope], fontsize=LABEL_SIZE, ha="center", va="center")
        (x0, x1), (y0, y1) = to_data([start, end]).T
        axes.plot(
            [x0, x1],
            [y0, y1],
            color=colour[slope],
            linewidth=0.45,
            marker="o",
            markevery=[1],
            markersize=1.6,
            markeredgewidth=0,
        )


class Labels:
    """Finds places for the labels of one panel, one after the other; all lengths in pixels."""

    def __init__(self, frame, lines, point):
        self.frame, self.lines, self.point = frame, lines, point
        self.height = 1.15 * LABEL_SIZE * point
        self.boxes, self.leaders = [], []
        # Points of all lines, so close that no box slips between two of them.
        self.ink = {slope: np.vstack([dense(piece, 2 * point) for piece in pieces]) for slope, pieces in lines.items()}

    def place(self, slope, width):
        """(centre of the label, start and end of its leader), or None."""
        size = np.array([width, self.height])
        centres = self.free_centres(size)
        pieces = [dense(piece, 6 * self.point) for piece in self.lines[slope]]
        anchors = np.vstack(pieces)
        if len(centres) == 0:
            return None
        strangers = [other for other in self.lines if other != slope]
        ink = np.vstack([np.zeros((0, 2)), *(self.ink[other] for other in strangers)])
        strangers = self.segments_of(strangers)
        own = self.segments_of([slope])
        apart = np.array([np.abs(ink - end).max(axis=1).min(initial=np.inf) for end in anchors])
        crowded = np.clip(1.0 - apart / (4 * self.point), 0.0, 1.0)
        # A leader costs its length, and much more where lines are dense and for each line it runs through.
        best, best_cost = None, np.inf
        for length, i, centre, start in leaders(centres, size, anchors):
            end = anchors[i]
            cost = max(length, 10 * self.point - length) / self.height
            if cost >= best_cost and length > 5 * self.point:
                break
            cost += 2.0 * crowded[i]
            if cost >= best_cost:
                continue
            cost += 2.0 * crossings(start, end, strangers)
            cost += 3.0 * crossings(start, start + 0.98 * (end - start), own)
            if cost < best_cost and self.leader_is_free(start, end):
                best, best_cost = (centre, start, end), cost
        if best is not None:
            self.boxes.append((best[0], size))
            self.leaders.append((best[1], best[2]))
        return best

    def free_centres(self, size):
        """Centres of boxes of this size in the frame, clear of lines, labels and leaders."""
        frame, margin = self.frame, 2.5 * self.point
        half = 0.5 * size + margin
        step = 5 * self.point
        x = np.arange(frame.x0 + half[0] + step, frame.x1 - half[0] - step, step)
        y = np.arange(frame.y0 + half[1] + step, frame.y1 - half[1] - step, step)
        centres = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
        taken = [*self.ink.values()]
        taken += [dense(np.array(leader), 2 * self.point) for leader in self.leaders]
        for points in taken:
            inside = [(np.abs(points - c) < half).all(axis=1).any() for c in centres]
            centres = centres[~np.array(inside, dtype=bool)]
        for other, other_size in self.boxes:
            near = (np.abs(centres - other) < 0.5 * other_size + half).all(axis=1)
            centres = centres[~near]
        return centres

    def leader_is_free(self, start, end):
        """True if the leader runs through no label and no other leader."""
        points = dense(np.array([start, end]), 2 * self.point)
        for centre, size in self.boxes:
            if (np.abs(points - centre) < 0.5 * size + 2 * self.point).all(axis=1).any():
                return False
        if not self.leaders:
            return True
        return crossings(start, end, np.array(self.leaders)) == 0

    def segments_of(self, slopes):
        pieces = [piece for slope in slopes for piece in self.lines[slope]]
        segments = [np.stack([piece[:-1], piece[1:]], axis=1) for piece in pieces]
        return np.concatenate(segments) if segments else np.zeros((0, 2, 2))


def leaders(centres, size, anchors):
    """(length, anchor, centre, start) of ways from boxes to anchors, by length: the nearest anchor and some others."""
    found = []
    for centre in centres:
        starts = edge_of_box(centre, size, anchors)
        lengths = np.hypot(*(anchors - starts).T)
        for i in {int(lengths.argmin()), *range(0, len(anchors), 5)}:
            found.append((lengths[i], i, centre, starts[i]))
    return sorted(found, key=lambda leader: leader[:2])


def dense(polyline, step):
    """Points along a polyline, no farther than `step` from one another."""
    lengths = np.hypot(*np.diff(polyline, axis=0).T)
    along = np.concatenate([[0], np.cumsum(lengths)])
    at = np.linspace(0, along[-1], int(np.ceil(along[-1] / step)) + 2)
    return np.column_stack([np.interp(at, along, polyline[:, i]) for i in (0, 1)])


def edge_of_box(centre, size, towards):
    """Where the straight way from the centre of a box to each of the points leaves the box."""
    way = towards - centre
    with np.errstate(divide="ignore"):
        part = np.min(0.5 * size / np.abs(way), axis=1)
    return centre + np.minimum(part, 1.0)[:, None] * way


def side(p, q, r):
    """Positive where r lies to the left of the way from p to q, negative to the right."""
    way, other = q - p, r - p
    return way[..., 0] * other[..., 1] - way[..., 1] * other[..., 0]


def crossings(start, end, segments):
    """How many of the segments the way from start to end crosses."""
    if len(segments) == 0:
        return 0
    a, b = segments[:, 0], segments[:, 1]
    apart = side(start, end, a) * side(start, end, b) < 0
    a, b = a[apart], b[apart]
    return int((side(a, b, start) * side(a, b, end) < 0).sum())


def figure(paths):
    panels = [Panel(path) for path in paths]
    with mpl.rc_context(STYLE):
        fig, all_axes = plt.subplots(1, len(panels), figsize=(7.0, 2.9), layout="constrained")
        colour = colours({slope for panel in panels for slope in panel.slopes})
        # Labels are placed in pixels: the layout has to be final before.
        for axes, panel, letter in zip(all_axes, panels, "ab", strict=True):
            symbol, name = PANELS[panel.gain]
            axes.set_xlabel(symbol)
            axes.set_ylabel(r"$\tau$")
            axes.set_title(f"({letter}) {name}", loc="left", fontsize=9, pad=4)
        fig.draw_without_rendering()
        fig.set_layout_engine("none")
        for axes, panel in zip(all_axes, panels, strict=True):
            draw(axes, panel, colour)
        return fig


if __name__ == "__main__":
    sys.exit(figures.main(__doc__, STYLE, figure, ["the map of panel (a)", "the map of panel (b)"], "fig2.pdf"))
