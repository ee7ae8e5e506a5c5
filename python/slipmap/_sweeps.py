"""Sweeps, maps and motions."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from datetime import datetime, timezone
from typing import TYPE_CHECKING, Any, cast

from . import _core, _ranges
from ._answers import Plan
from ._error import InputError
from ._nouns import taken
from ._text import Sweep, read, table

if TYPE_CHECKING:
    from xarray import Dataset, DataTree

Progress = bool | str | Callable[[int, int], object] | None


def _xarray() -> Any:
    try:
        import xarray
    except ImportError:
        raise ImportError('maps need xarray: pip install "slipmap[maps]"; evaluate() works without') from None
    return xarray


def _history(name: str) -> str:
    return f"{datetime.now(timezone.utc).isoformat(timespec='seconds')}: slipmap.{name} in Python"


def plan(sweep: Sweep, *, timed: bool = False) -> Plan:
    """What a sweep comes to: its cells, bytes, memory, pieces and hash.

    Parameters
    ----------
    sweep : path, str or mapping
        A sweep file, its text, or the same as a dict.
    timed : bool
        Also the seconds on one thread, from a sample of its pieces.

    Examples
    --------
    >>> plan({"axes": {"tau": [1, 2]}, "fixed": {"mu_prime": -0.3}}).cells
    2
    """
    text = read(sweep)
    return Plan(_core.plan(text, timed), None, text)


def run(
    sweep: Sweep,
    *,
    threads: int | None = None,
    memory: int | str | None = None,
    progress: Progress = "auto",
) -> DataTree:
    """The map of a sweep: what `open_map` reads from the file of ``slipmap run``.

    Parameters
    ----------
    sweep : path, str or mapping
        A sweep file, its text, or the same as a dict.
    threads : int, optional
        By default all that the machine offers.
    memory : int or str, optional
        The most bytes to use, such as ``"500MB"``: fewer threads are taken if they would use more. By
        default the memory of the machine.
    progress : bool, "auto" or callable
        A bar of tqdm; ``"auto"`` shows it in a terminal or a notebook. A callable gets the cells that
        are done and all cells; an exception of it ends the run.

    Examples
    --------
    >>> tree = run({"axes": {"tau": [1.0, 4.15]}, "fixed": {"mu_prime": -0.3, "alpha_v": -0.33}})
    >>> tree["n_unstable"].values.tolist()
    [2, 0]
    """
    _xarray()
    used = _ranges.threads(threads)
    most = _machine() if memory is None else _bytes(memory)
    with _Bar(progress) as bar:
        groups = _core.run(read(sweep), used, most, _history("run"), bar)
    return _tree(groups)


def open_map(path: str | os.PathLike[str]) -> DataTree:
    """A map or trace file as a tree of datasets, read when it is needed.

    Counts and kinds stay integers: their values are those of the file, and `DataTree.slipmap.known`
    tells which are values.

    Raises
    ------
    InputError
        Where it is no file of slipmap.
    OSError
        Where there is none, or it cannot be read.
    """
    _xarray()
    with open(path, "rb"):
        pass
    try:
        tree = _opened(path)
    except (OSError, ValueError, KeyError, RuntimeError, AttributeError) as error:
        raise OSError(f"{os.fspath(path)} cannot be read as HDF5: {error}") from error
    if not any(name in tree.attrs for name in ("slipmap_format_version", "slipmap_trace_format_version")):
        tree.close()
        raise InputError(f"{os.fspath(path)} is no map or trace of slipmap", "slipmap run SWEEP.toml makes one")
    for node in tree.subtree:
        for variable in node.to_dataset(inherit=False).variables.values():
            _filled(variable)
    return tree


def _opened(path: str | os.PathLike[str]) -> DataTree:
    """The groups of a file. Single numbers that have the name of an axis, which h5netcdf takes for it, are
    read at once."""
    import h5py  # type: ignore[import-untyped, unused-ignore]

    xarray = _xarray()
    options = {"engine": "h5netcdf", "mask_and_scale": False, "decode_times": False, "decode_timedelta": False}
    parts = {}
    with h5py.File(path, "r") as file:
        found: dict[str, Any] = {name: of for name, of in file.items() if isinstance(of, h5py.Group)}
        groups = list(found)
        for name, group in found.items():
            if any(of.shape == () and key in file for key, of in group.items()):
                parts[f"/{name}"] = _read(group)
    for name in ["", *groups]:
        if f"/{name}" not in parts:
            parts[f"/{name}"] = xarray.open_dataset(path, group=name or None, **options)
    order = ["/", *(f"/{name}" for name in groups)]
    return cast("DataTree", xarray.DataTree.from_dict({name: parts[name] for name in order}))


def _read(group: Any) -> Dataset:
    """A group of single numbers."""

    def told(of: Any) -> dict[str, Any]:
        attributes = {}
        for name, value in of.attrs.items():
            plain = value.decode() if isinstance(value, bytes) else value
            attributes[name] = plain[0] if getattr(plain, "shape", ()) == (1,) else plain
        return attributes

    return _dataset(told(group), [(name, (), of[()], told(of)) for name, of in group.items()])


def simulate(case: Sweep | None = None, /, *, until: float | None = None, **at: Any) -> DataTree:
    """A motion in time: samples, the group ``event``, and the outcome as attributes.

    Parameters
    ----------
    case : path, str or mapping, optional
        A case file, its text, or the same as a dict; or parameters in ``**at``, with `friction`, ``v0``
        and the start ``x_dot0``, ``a0`` or ``switch_on_phase``.
    until : float, optional
        The end of the trace; by default when the outcome is known.

    Examples
    --------
    >>> import slipmap
    >>> law = slipmap.Friction("weakening", mu0=0.5, v_s=0.5)
    >>> simulate(friction=law, v0=0.35, alpha_v=-0.33, tau=4.15).attrs["outcome"]
    'sliding'
    """
    _xarray()
    if case is None:
        if at.get("system") is not None:
            raise InputError("a system has no motions", "a friction law has them")
        text = taken(at).text(at)
    else:
        if at:
            raise InputError(f"a case says {', '.join(at)} itself", "leave them out, or the case")
        text = read(case)
    end = "" if until is None else "\n" + table("trace", {"until": until})
    return _tree(_core.simulate(text, end, _history("simulate")))


def _filled(variable: Any) -> None:
    """Puts the fill value of reals, which is NaN, where readers that mask put it."""
    if variable.dtype.kind == "f" and "_FillValue" in variable.attrs:
        variable.encoding["_FillValue"] = variable.attrs.pop("_FillValue")


def _dataset(attributes: dict[str, Any], variables: list[Any]) -> Dataset:
    xarray = _xarray()
    made = {name: (dimensions, numbers, told) for name, dimensions, numbers, told in variables}
    raw = xarray.Dataset(made, attrs=attributes)
    decoded = xarray.decode_cf(raw, mask_and_scale=False, decode_times=False, decode_timedelta=False)
    for variable in decoded.variables.values():
        _filled(variable)
    return cast("Dataset", decoded)


def _tree(groups: list[Any]) -> DataTree:
    parts = {f"/{name}": _dataset(attributes, variables) for name, attributes, variables in groups}
    return cast("DataTree", _xarray().DataTree.from_dict(parts))


def _machine() -> int | None:
    """The memory of the machine, where it tells it."""
    try:
        return os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    except (AttributeError, OSError, ValueError):
        return None


def _bytes(of: int | str) -> int:
    if not isinstance(of, str):
        return int(of)
    units = {"": 1, "B": 1, "KB": 10**3, "MB": 10**6, "GB": 10**9, "TB": 10**12}
    units |= {"KIB": 2**10, "MIB": 2**20, "GIB": 2**30, "TIB": 2**40}
    number = of.strip().rstrip("BbIiKkMmGgTt ")
    unit = of.strip()[len(number) :].strip().upper()
    try:
        size = float(number) * units[unit if unit.endswith("B") or not unit else f"{unit}B"]
        if not 0 <= size < 2**63:
            raise ValueError(of)
        return int(size)
    except (ValueError, KeyError):
        raise InputError(f"memory: {of!r} is no size", "such as 500MB or 2GiB") from None


class _Bar:
    """What is called with the cells that are done and all cells."""

    def __init__(self, progress: Progress) -> None:
        self._call = progress if callable(progress) else None
        self._wanted = self._call is None and (progress is True or (progress == "auto" and _watched()))
        if not (progress is None or callable(progress) or progress in (True, False, "auto")):
            raise TypeError('progress is True, False, "auto" or a function of the cells done and all cells')
        self._bar: Any = None

    def __enter__(self) -> Callable[[int, int], object] | None:
        if self._call is not None:
            return self._call
        if not self._wanted:
            return None
        try:
            from tqdm.auto import tqdm  # type: ignore[import-untyped, unused-ignore]
        except ImportError:
            return None
        self._bar = tqdm(unit="cell", unit_scale=True, leave=False)
        return self._show

    def _show(self, done: int, of: int) -> None:
        self._bar.total = of
        self._bar.update(done - self._bar.n)

    def __exit__(self, *_: object) -> None:
        if self._bar is not None:
            self._bar.close()


def _watched() -> bool:
    """Whether somebody looks on: a terminal, or a notebook."""
    if "ipykernel" in sys.modules:
        return True
    return sys.stderr is not None and sys.stderr.isatty()
