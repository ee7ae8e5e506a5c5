"""Answers about one setting."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from . import _core, _ranges
from ._answers import Answer, Basin, Best, CriticalVelocity, Margins, Point
from ._error import InputError
from ._nouns import taken
from ._ranges import whole
from ._text import quoted

A = TypeVar("A", bound=Answer)


def _text(at: dict[str, Any], head: str = "") -> str:
    """The text of a setting."""
    subject = taken(at)
    for name, of in at.items():
        if np.ndim(of) != 0:
            raise TypeError(f"{name}: one setting takes one number; evaluate() takes arrays")
    rows = {name: of.item() if hasattr(of, "item") else of for name, of in at.items()}
    return head + subject.text(rows)


def _asked(kind: type[A], name: str, text: str, **options: Any) -> A:
    given = {option: of for option, of in options.items() if of is not None}
    told = _core.answer(name, text, given)
    if told["warning"] is not None:
        warnings.warn(told["warning"], stacklevel=3)
    return kind(told["answer"], told["command"], told["toml"])


def point(*, roots: int = 16, **at: Any) -> Point:
    """Linear stability at a point: count, complex roots, stable delays, margins.

    Parameters
    ----------
    roots : int
        How many rightmost roots are told, 1 to 64; pairs count once.
    **at : float or str
        Parameters by their names, with `friction`, `system` and `units`, as in `slipmap.n_unstable`.

    Returns
    -------
    Point

    Examples
    --------
    >>> found = point(mu_prime=-0.3, alpha_v=-0.33, tau=4.15)
    >>> found.n_unstable, found.certified
    (0, True)
    >>> found.roots[0].round(4)
    np.complex128(-0.0411+1.1728j)
    """
    return _asked(Point, "point", _text(at), roots=whole("roots", roots, 1, 64))


def stable_delays(*, most: int = 1000, **at: Any) -> NDArray[np.float64]:
    """The intervals of delays in which sliding is stable, by growing delay.

    Returns
    -------
    NDArray of shape (n, 2), n at most `most`
        From and to, in units of time; inf where the last one has no end.

    Examples
    --------
    >>> stable_delays(mu_prime=-0.3, alpha_v=-0.33).round(3)
    array([[2.342, 4.46 ]])
    """
    most = whole("most", most, 1, 100_000)
    at.setdefault("tau", 0.0)
    found = point(roots=1, **at).stable_delays
    if found is None:
        raise ArithmeticError("the stable delays of this system are not known")
    return found[:most]


def margins(*, decay: float = 0.0, **at: Any) -> Margins:
    """How far a setting is from the boundary of stability, or from the decay rate `decay`, 1/time.

    Examples
    --------
    >>> round(margins(mu_prime=-0.3, alpha_v=-0.33, tau=4.15).tau_margin.upper, 4)
    0.3099
    """
    return _asked(Margins, "margins", _text(at), decay=float(decay))


def best(
    *,
    search: str | tuple[str, str] = "alpha_v",
    ranges: Mapping[str, tuple[float, float]] | None = None,
    robust: float | str | None = None,
    **at: Any,
) -> Best:
    """The settings of fastest decay over the delay and the parameter `search`, or over two of them.

    Parameters
    ----------
    search : str or (str, str)
        ``"alpha_v"``, ``"alpha_n"`` or, of a system, one of its parameters; or two of them, at the
        delay `tau` or, without it, over the delay too.
    ranges : mapping of str to (from, to), optional
        Ranges of the search, by names.
    robust : float or "fit", optional
        Also the setting whose slowest decay is fastest when gain, delay and slope may be off by this
        part, or friction by three standard errors of its fit.

    Examples
    --------
    >>> found = best(mu_prime=-0.3, search="alpha_n")
    >>> round(found.best.alpha, 3), round(found.best.tau, 3)
    (-3.653, 0.465)
    """
    names = [search] if isinstance(search, str) else list(search)
    delay = len(names) == 1 or "tau" in (ranges or {})
    for name in names + ["tau"] * delay:
        if name in at:
            raise InputError(f"a value of {name} is given, which is searched", "ranges={...} bounds the search")
    given = {} if ranges is None else {name: (float(of[0]), float(of[1])) for name, of in ranges.items()}
    said = None if robust is None else str(robust)
    return _asked(Best, "best", _text(at), search=names, ranges=given, robust=said)


def vc(*, protocol: str = "follow", phase: float | str = 0.0, **at: Any) -> CriticalVelocity:
    """The critical velocity, below which stick-slip survives.

    Parameters
    ----------
    protocol : {"follow", "switch-on"}
        v0 raised under control, or control switched on at a phase of uncontrolled stick-slip.
    phase : float or "worst"
        With ``"switch-on"``: the time from a release to switch-on, or the worst of 32 phases.

    Examples
    --------
    >>> import slipmap
    >>> law = slipmap.Friction("weakening", mu0=0.5, v_s=0.5)
    >>> round(vc(friction=law, alpha_v=-0.33, tau=4.15).vc, 4)
    0.3445
    """
    if at.get("system") is not None:
        raise InputError("a system has no motions, and no critical velocity", "a friction law has one")
    head = f"protocol = {quoted(protocol)}\n"
    if isinstance(phase, str) and phase == "worst":
        head += 'phase = "worst"\n'
    elif isinstance(phase, str) or phase != 0.0:
        at["switch_on_phase"] = phase
    return _asked(CriticalVelocity, "vc", _text(at, head))


def basin(*, over: str = "state", starts: int = 4096, threads: int | None = None, **at: Any) -> Basin:
    """The share of starts from which control ends in sliding, with its error.

    Parameters
    ----------
    over : {"state", "phase"}
        States of the block, or phases of uncontrolled stick-slip at which control is switched on.
    starts : int
        A power of two from 64 to 1,048,576.
    threads : int, optional
        By default all that the machine offers.

    Examples
    --------
    >>> import slipmap
    >>> law = slipmap.Friction("weakening", mu0=0.5, v_s=0.5)
    >>> basin(friction=law, v0=0.9, alpha_v=-0.33, tau=4.15, starts=64).basin_share
    1.0
    """
    used = _ranges.threads(threads)
    return _asked(Basin, "basin", _text(at), over=over, starts=whole("starts", starts, 64, 1 << 20), threads=used)
