"""Numbers that broadcast as NumPy's do."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from . import _core, _ranges
from ._catalogue import fields
from ._error import InputError
from ._nouns import numbers, subject, taken

_FEW = 4096


class _Asked:
    """What is computed, with numbers and arrays of one shape by the names of parameters."""

    def __init__(self, at: dict[str, Any]) -> None:
        self.base = taken(at)
        self.said = dict(at)
        units = {name: of for name, of in at.items() if isinstance(of, str)}
        self.subject = subject(self.base.text(units)) if units else subject(self.base.text())
        self.like: Any = None
        self.shape: tuple[int, ...] | None = None
        self.at = {name: of for name, of in at.items() if name not in units}
        if not all(type(of) is float or type(of) is int for of in self.at.values()):
            self._broadcast()

    def _broadcast(self) -> None:
        at = self.at
        labelled = [name for name, of in at.items() if hasattr(of, "dims") and hasattr(of, "coords")]
        if labelled:
            import xarray as xr

            if any(np.ndim(of) for name, of in at.items() if name not in labelled):
                raise InputError("arrays with and without labels are mixed", "give all of them labels, or none")
            # Labels that differ would be points that nobody asked for.
            together = xr.broadcast(*xr.align(*(at[name] for name in labelled), join="exact"))
            self.like = together[0].drop_attrs() if hasattr(together[0], "drop_attrs") else together[0]
            at.update({name: of.data for name, of in zip(labelled, together, strict=True)})
        for name, of in at.items():
            if np.asarray(of).dtype.kind not in "fiub":
                raise TypeError(f"{name}: {type(of).__name__} is no number and no array of numbers")
            at[name] = numbers(of)
        shape = np.broadcast_shapes(*(of.shape for of in at.values()))
        self.shape = shape or None
        for name, of in at.items():
            at[name] = np.broadcast_to(of, shape) if of.ndim else float(of)
        if self.shape is None:
            self.said.update(at)

    def size(self) -> int:
        return 1 if self.shape is None else int(np.prod(self.shape))

    def threads(self, asked: int | None) -> int:
        if asked is None and self.size() < _FEW:
            return 1
        return min(_ranges.threads(asked), max(1, self.size()))

    def explain(self) -> None:
        """Raises what a file of these parameters would be told, with its place."""
        _core.answer("point", self.base.text(self.said), {"roots": 1})

    def call(self, function: Any, *more: Any) -> Any:
        """Calls a function of the core."""
        try:
            return function(self.subject, *more)
        except InputError as error:
            if error.line is None and self.shape is None:
                self.explain()
            raise

    def shaped(self, flat: Any, name: str, long_name: str, unit: str) -> Any:
        if self.shape is None:
            return flat
        array = flat.reshape(self.shape)
        if self.like is None:
            return array
        return self.like.copy(data=array).rename(name).assign_attrs(long_name=long_name, units=unit)


def n_unstable(*, threads: int | None = None, **at: Any) -> Any:
    """The number of unstable roots: characteristic roots with a positive real part.

    Parameters
    ----------
    **at : float, str, array or DataArray
        Parameters by their names, see ``slipmap.catalogue("parameters")``; arrays are broadcast. Beside
        them `friction`, a `Friction`; or `system`, a `System`; and `units`.
    threads : int, optional
        Threads to compute on; by default one for few points, and all for many.

    Returns
    -------
    int, or NDArray[int64] of the broadcast shape, or DataArray
        -1 where it is infinite or not known, and where a parameter is NaN.

    Examples
    --------
    >>> n_unstable(mu_prime=-0.3, alpha_v=-0.33, tau=[1.0, 4.15])
    array([2, 0])
    """
    asked = _Asked(at)
    flat = asked.call(_core.n_unstable, asked.at, asked.threads(threads))
    return asked.shaped(flat, "n_unstable", fields()["n_unstable"]["long_name"] if asked.like is not None else "", "1")


def abscissa(*, threads: int | None = None, **at: Any) -> Any:
    """The real part of the rightmost characteristic root, 1/time.

    Parameters and shapes are those of `n_unstable`.

    Returns
    -------
    float, or NDArray[float64], or DataArray
        NaN where it is not known, and where a parameter is NaN.

    Examples
    --------
    >>> round(abscissa(mu_prime=-0.3, alpha_v=-0.33, tau=4.15), 4)
    -0.0411
    """
    found = evaluate(["abscissa"], threads=threads, **at)["abscissa"]
    return found if getattr(found, "shape", ()) else float(found)


def evaluate(fields: Iterable[str] | str, *, threads: int | None = None, **at: Any) -> dict[str, Any]:
    """Fields of maps at points that need not be a grid.

    Parameters
    ----------
    fields : str or sequence of str
        Names of fields, see ``slipmap.catalogue("fields")``.
    **at
        As `n_unstable`.

    Returns
    -------
    dict of str to NDArray or DataArray
        The fields, what bounds their errors, and ``status``, in the types of maps. Reals are NaN where
        they have no value, counts and kinds the largest number of their type.

    Examples
    --------
    >>> found = evaluate(["n_unstable", "delay_margin"], mu_prime=-0.3, alpha_v=-0.33, tau=[1.0, 4.15])
    >>> sorted(found)
    ['delay_margin', 'n_unstable', 'status']
    """
    wanted = [fields] if isinstance(fields, str) else list(fields)
    asked = _Asked(at)
    if asked.shape is None:
        if any(of != of for of in asked.said.values()):
            asked.explain()
        asked.at = {name: np.full(1, float(of)) for name, of in asked.at.items()}
    found = asked.call(_core.evaluate, wanted, asked.at, asked.threads(threads))
    if asked.shape is None:
        return {name: flat[0] for name, (flat, _, _) in found.items()}
    return {name: asked.shaped(flat, name, long_name, unit) for name, (flat, long_name, unit) in found.items()}
