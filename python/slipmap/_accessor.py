"""What maps can do: ``tree.slipmap`` and ``dataset.slipmap``."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from . import _core
from ._answers import Point
from ._catalogue import fields
from ._error import InputError


class Curve(NamedTuple):
    """A crossing curve: its vertices, and what it bounds."""

    x: NDArray[np.float64]
    y: NDArray[np.float64]
    names: tuple[str, str]
    degree_of_stability: float
    direction: int
    stable_side: int
    at: dict[str, float]


class MapAccessor:
    """The cells of a map: which are known, flagged or stable; its curves, points and pictures."""

    def __init__(self, of: Any) -> None:
        self._of = of
        self._cells = of.dataset if hasattr(of, "dataset") else of
        if "axes" not in self._cells.attrs or "status" not in self._cells:
            raise InputError("this is no map of slipmap: it has no axes and status")

    @property
    def axes(self) -> tuple[str, ...]:
        """The names of the axes, the last one fastest."""
        return tuple(self._cells.attrs["axes"].split())

    @property
    def fields(self) -> tuple[str, ...]:
        """The names of the fields."""
        return tuple(name for name in self._cells.data_vars if name != "status")

    def known(self, field: str) -> Any:
        """Where a field has a value, of its shape."""
        cells = self._field(field)
        if cells.dtype.kind == "f":
            return cells.notnull()
        return cells != np.iinfo(cells.dtype).max

    def flag(self, name: str) -> Any:
        """Where the status has a flag: ``certified``, ``marginal``, ``disagree`` and so on."""
        status = self._cells["status"]
        flags = dict(zip(status.attrs["flag_meanings"].split(), np.atleast_1d(status.attrs["flag_masks"]), strict=True))
        if name not in flags:
            raise InputError(f"the status has no flag {name}", f"it has {', '.join(flags)}")
        computed = status != np.iinfo(status.dtype).max
        return computed & ((status & flags[name]) != 0)

    @property
    def stable(self) -> Any:
        """Where sliding is known to be stable."""
        for field in ("n_unstable", "abscissa"):
            if field in self._cells:
                cells = self._cells[field]
                found = cells == 0 if field == "n_unstable" else cells < 0
                return found & self.known(field)
        raise InputError("stable needs the field n_unstable or abscissa", f"the map has {', '.join(self.fields)}")

    def boundaries(self, **sel: float) -> list[Curve]:
        """The exact crossing curves and curves of degrees of stability.

        ``sel`` picks those at values of the axes outside their plane.
        """
        self._check(sel)
        groups = getattr(self._of, "children", {})
        if "boundaries" not in groups:
            raise InputError("the map has no curves", "boundaries = true in the sweep traces them, and the tree has them")
        # Its own variables have names of axes.
        curves = groups["boundaries"].to_dataset(inherit=False)
        names = tuple(curves.attrs["plane"].split())
        ends = np.cumsum(curves["vertex_count"].values)[:-1]
        x, y = (np.split(curves[self._named(curves, name)].values, ends) for name in names)
        outer = [name for name in self.axes if name not in names]
        found = []
        for place in range(curves.sizes["curve"]):
            at = {name: float(curves[self._named(curves, name)].values[place]) for name in outer}
            if all(at[name] == self._nearest(name, value) for name, value in sel.items() if name in at):
                numbers = (curves[name].values[place] for name in ("degree_of_stability", "direction", "stable_side"))
                degree, direction, side = numbers
                found.append(Curve(x[place], y[place], (names[0], names[1]), float(degree), int(direction), int(side), at))
        return found

    def point(self, *, roots: int = 16, **sel: float) -> Point:
        """All about the cell nearest to these values of the axes."""
        self._check(sel)
        cell = self._cells.sel(sel, method="nearest")
        left = [name for name in self.axes if cell[name].ndim]
        if left:
            raise InputError(f"values of {', '.join(left)} are missing", "point() is of one cell")
        at = [(name, float(cell[name])) for name in self.axes]
        text = _core.cell(self._cells.attrs["sweep"], at)
        told = _core.answer("point", text, {"roots": roots})
        return Point(told["answer"], told["command"], told["toml"])

    def plot(self, field: str | None = None, ax: Any = None, **sel: float) -> Any:
        """A picture of a field over the last two axes, with the exact boundary of stability.

        Values of other axes are picked by ``sel``, nearest; by default their first. Returns the axes of
        matplotlib.
        """
        try:
            import matplotlib.pyplot as plt
        except ImportError:
            raise ImportError('pictures need matplotlib: pip install "slipmap[maps]"') from None
        name = field or self.fields[0]
        picked = {axis: self._nearest(axis, value) for axis, value in sel.items()}
        free = [axis for axis in self.axes if axis not in picked]
        for axis in free[:-2]:
            picked[axis] = float(self._cells[axis][0])
        drawn = free[-2:]
        if not drawn:
            raise InputError("all axes have a value: nothing is left to draw", "leave one or two of them free")
        cells = self._field(name).where(self.known(name)).sel(picked)
        if ax is None:
            _, ax = plt.subplots(layout="constrained")
        if len(drawn) == 1:
            ax.plot(cells[drawn[0]], cells)
            ax.set(xlabel=self._label(drawn[0]), ylabel=self._label(name))
        else:
            self._fill(ax, cells.transpose(drawn[1], drawn[0]), name, drawn)
            self._draw_boundary(ax, drawn, picked)
        ax.set_title(", ".join(f"{axis} = {value:g}" for axis, value in picked.items()))
        return ax

    def _fill(self, ax: Any, cells: Any, name: str, drawn: list[str]) -> None:
        sign = fields().get(name, {}).get("stable_sign")
        finite = np.abs(cells.values[np.isfinite(cells.values)])
        scale: dict[str, Any] = {}
        if sign is not None and finite.size and finite.max() > 0:
            most = float(np.quantile(finite, 0.98)) or float(finite.max())
            scale = {"cmap": "BrBG_r" if sign < 0 else "BrBG", "vmin": -most, "vmax": most}
        drawing = ax.pcolormesh(cells[drawn[0]], cells[drawn[1]], cells, shading="nearest", **scale)
        ax.figure.colorbar(drawing, ax=ax, label=self._label(name))
        ax.set(xlabel=self._label(drawn[0]), ylabel=self._label(drawn[1]))

    def _draw_boundary(self, ax: Any, drawn: list[str], picked: dict[str, float]) -> None:
        if "boundaries" not in getattr(self._of, "children", {}):
            return
        for curve in self.boundaries(**picked):
            if set(curve.names) == set(drawn) and curve.degree_of_stability == 0 and curve.stable_side != 0:
                x, y = (curve.x, curve.y) if curve.names[0] == drawn[0] else (curve.y, curve.x)
                ax.plot(x, y, "k", linewidth=1)

    def _field(self, name: str) -> Any:
        if name not in self._cells.data_vars:
            raise InputError(f"the map has no field {name}", f"it has {', '.join(self.fields)}")
        return self._cells[name]

    def _check(self, names: Iterable[str]) -> None:
        for axis in names:
            if axis not in self.axes:
                raise InputError(f"{axis} is no axis of the map", f"its axes: {', '.join(self.axes)}")

    def _nearest(self, axis: str, value: float) -> float:
        self._check([axis])
        return float(self._cells[axis].sel({axis: value}, method="nearest"))

    def _label(self, name: str) -> str:
        of = self._cells[name].attrs
        unit = of.get("units", "1")
        said = fields().get(name, {}).get("short_name", of.get("long_name", name))
        return f"{said}{'' if unit == '1' else f' / {unit}'}"

    @staticmethod
    def _named(curves: Any, name: str) -> str:
        if name in curves:
            return name
        held = (of for of in curves.variables if curves[of].attrs.get("parameter") == name)
        return next((str(of) for of in held if not str(of).startswith("corner_")), name)


def register() -> None:
    """Makes the accessor known to xarray, where it is installed."""
    try:
        import xarray
    except ImportError:
        return
    registered: list[Any] = [xarray.register_dataset_accessor, xarray.register_datatree_accessor]
    for register_one in registered:
        register_one("slipmap")(MapAccessor)
