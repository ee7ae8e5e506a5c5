"""Friction laws and systems."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from ._error import InputError
from ._text import is_text, quoted, table, units_of, value


def numbers(of: Any) -> NDArray[np.float64]:
    """Numbers as an array; what is masked is NaN."""
    if isinstance(of, np.ma.MaskedArray):
        of = np.ma.filled(of.astype(np.float64), np.nan)
    return np.asarray(of, dtype=np.float64)


@lru_cache(maxsize=256)
def subject(text: str) -> _core.Subject:
    """What the text of a setting describes, read once."""
    return _core.Subject(text)


class Friction:
    """A friction law: the coefficient of kinetic friction as a function of the speed.

    Parameters
    ----------
    law : str
        The name of a law, see ``slipmap.catalogue("laws")``.
    **numbers : float or str
        Its parameters by their names, such as ``mu0`` and ``v_s``; ``mu_s`` is the static coefficient. A
        string is a number with a unit, such as ``"5 mm/s"``.

    Examples
    --------
    >>> law = Friction("weakening", mu0=0.5, v_s=0.5)
    >>> float(law(0.0)), float(law.slope(0.0))
    (0.5, -1.0)
    """

    def __init__(self, law: str, /, **numbers: Any) -> None:
        self._rows: dict[str, Any] = {"law": law, **numbers}
        self.remarks: tuple[str, ...] = ()
        self.fitted: Mapping[str, Any] = {}
        self._text = table("friction", self._rows)
        subject(self._text)

    @classmethod
    def _of_text(cls, text: str) -> Friction:
        made = cls.__new__(cls)
        made._rows, made.remarks, made.fitted, made._text = {}, (), {}, text
        subject(text)
        return made

    @classmethod
    def table(cls, v: ArrayLike, mu: ArrayLike, /, **numbers: Any) -> Friction:
        """The law through points: increasing speeds `v` from 0 on, and the coefficients `mu` there."""
        v, mu = np.array(v, dtype=float), np.array(mu, dtype=float)
        return cls("table", speeds=v, mu_k=mu, **numbers)

    @classmethod
    def formula(cls, text: str, /, *, units: Mapping[str, str] | None = None, **numbers: Any) -> Friction:
        """The law of an expression in the speed ``v``, with values of its parameters.

        ``units`` are those of parameters that only this formula has.

        >>> law = Friction.formula("mu0 + sigma*v", mu0=0.3, sigma=0.1)
        >>> float(law(2.0))
        0.5
        """
        of_own = {} if units is None else {"units": dict(units)}
        return cls("formula", mu_k=text, **numbers, **of_own)

    @classmethod
    def fit(
        cls, v: ArrayLike, mu: ArrayLike, /, *, v0: float, law: str | None = None, mu_s: float | None = None
    ) -> Friction:
        """The law that describes measured points best near the sliding velocity `v0`, with its errors.

        Without `law` the one with the lowest Bayesian information criterion. ``fitted`` has ``law``,
        ``mu_k``, ``mu_prime`` and their standard errors at `v0`, ``noise``, and ``laws``, those that
        were compared. Points that determine no law raise `InputError`.
        """
        v, mu = (np.ascontiguousarray(numbers(of)).ravel() for of in (v, mu))
        if v.shape != mu.shape:
            raise ValueError(f"{v.size} speeds for {mu.size} coefficients")
        if not (np.isfinite(v).all() and np.isfinite(mu).all()):
            raise InputError("a speed or a coefficient is not finite", "leave such points out")
        found = _core.fit(v, mu, float(v0), law, mu_s)
        made = cls._of_text(found.pop("toml"))
        made.fitted = found
        return made

    @classmethod
    def from_csv(
        cls,
        path: str | os.PathLike[str],
        /,
        *,
        columns: str | None = None,
        normal_load: float | None = None,
        speed_unit: str | None = None,
        units: Any = None,
        **numbers: Any,
    ) -> Friction:
        """The law through the measured points of a file, as instruments and spreadsheets write it.

        Decimal commas, titles, units in titles, forces and both directions are understood. ``columns``
        names them (``"speed=2,force=4"``), ``normal_load`` divides forces, ``speed_unit`` is that of the
        file, ``units`` those of the law, such as ``"SI"``. ``remarks`` tells what was done with its rows; ``v`` and ``mu`` are all points, those
        backwards with negative speeds, for `Friction.fit`.
        """
        content = Path(path).read_bytes()
        of_law = ",".join(units) if isinstance(units, (list, tuple)) else units
        (v, mu), remarks = _core.read_curve(content, columns, normal_load, speed_unit, of_law)
        options = {"columns": columns, "speed_unit": speed_unit, "normal_load": normal_load}
        said = {name: of for name, of in options.items() if of is not None}
        named = table("friction", {"law": "table", **numbers, "table": {"file": "measured", **said}})
        text, _ = _core.inlined(units_of(units) + named, lambda _: content)
        # Units are said where the law is used.
        made = cls._of_text(text[text.index("[friction]") :])
        made.remarks, made._rows = tuple(remarks), {"v": v, "mu": mu}
        return made

    @property
    def v(self) -> NDArray[np.float64]:
        """The speeds of the points of a law from a file or a table."""
        return self._points("v", "speeds")

    @property
    def mu(self) -> NDArray[np.float64]:
        """The coefficients at these speeds."""
        return self._points("mu", "mu_k")

    def _points(self, *names: str) -> NDArray[np.float64]:
        for name in names:
            if isinstance(self._rows.get(name), np.ndarray):
                return np.asarray(self._rows[name], dtype=float)
        raise AttributeError("this law has no measured points")

    def __call__(self, v: ArrayLike, /) -> NDArray[np.float64]:
        """The coefficient of kinetic friction at speeds `v`, of the same shape; at 0 its limit."""
        return self._at(v, 0)

    def slope(self, v: ArrayLike, /) -> NDArray[np.float64]:
        """The slope of the coefficient at speeds `v`, time/length, of the same shape."""
        return self._at(v, 1)

    def _at(self, v: ArrayLike, which: int) -> NDArray[np.float64]:
        speeds = numbers(v)
        flat = np.ascontiguousarray(speeds).reshape(-1)
        return np.asarray(_core.law(subject(self._text), flat)[which].reshape(speeds.shape))

    def __repr__(self) -> str:
        if self.fitted:
            return f"<Friction {self.fitted['law']}, fitted: mu_prime = {self.fitted['mu_prime']:.4g} ± {self.fitted['mu_prime_error']:.2g}>"
        rows = {name: of for name, of in self._rows.items() if not isinstance(of, np.ndarray)}
        said = ", ".join(f"{name}={of!r}" for name, of in rows.items() if name != "law")
        return f"Friction({rows.get('law', 'table')!r}{', ' if said else ''}{said})"

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Friction) and other._text == self._text

    def __hash__(self) -> int:
        return hash(self._text)


class System:
    """A linear system with one delay, in the place of the block on its spring.

    Parameters
    ----------
    named : str or path
        The name of a system of slipmap (``slipmap.catalogue("systems")``), the path of a system file, or
        its text.
    P, Q : sequence of float or str
        In place of a name: polynomials of ``P(λ) + Q(λ) exp(-λτ) = 0``, highest power first.
    B, A : sequence of float or str, or str
        In place of P and Q: block and feedback of ``B(λ) = A(λ) (1 - exp(-λτ))``.
    **parameters
        Of an expression: a default value, or a table with ``default``, ``minimum``, ``maximum``, ``unit``.

    Examples
    --------
    >>> System(P=[1, 0.04, 1.2], Q=[-0.2]).parameters
    ('tau',)
    """

    def __init__(
        self,
        named: str | os.PathLike[str] | None = None,
        /,
        *,
        P: Any = None,
        Q: Any = None,
        B: Any = None,
        A: Any = None,
        **parameters: Any,
    ) -> None:
        given = {name: of for name, of in {"P": P, "Q": Q, "B": B, "A": A}.items() if of is not None}
        if (named is None) == (not given):
            raise InputError("a system is a name, a path or a text, or P and Q, or B and A")
        if named is None:
            if parameters:
                given["parameters"] = {
                    name: of if isinstance(of, Mapping) else {"default": of} for name, of in parameters.items()
                }
            self._text = f"system = {value(given)}\n"
        elif is_text(named):
            self._text, _ = _core.inlined('system = "given.toml"\n', lambda _: str(named).encode())
        else:
            path = Path(named)
            said = f"system = {quoted(os.fspath(named))}\n"
            self._text, _ = _core.inlined(said, lambda _: path.read_bytes())
        subject(self._text)

    @property
    def parameters(self) -> tuple[str, ...]:
        """The names of its parameters, the delay ``tau`` among them."""
        return tuple(subject(self._text).parameters())

    def __repr__(self) -> str:
        return f"<System {self._text.strip()}>"

    def __eq__(self, other: object) -> bool:
        return isinstance(other, System) and other._text == self._text

    def __hash__(self) -> int:
        return hash(self._text)


Given = Sequence[str] | str | Mapping[str, str] | None
_HEAD = "[friction]\n"


class Base(NamedTuple):
    """What is computed, without parameters: keys before all tables, and the rows of a friction law."""

    head: str
    law: str | None

    def text(self, rows: Mapping[str, Any] | None = None, tables: str = "") -> str:
        """The text of a setting with these parameters, those of the law in its table."""
        rows = rows or {}
        if self.law is None:
            return self.head + table("fixed", rows) + tables
        of_law = subject(self.head + _HEAD + self.law).of_law()
        fixed = {name: of for name, of in rows.items() if name not in of_law}
        law = {name: of for name, of in rows.items() if name in of_law}
        return self.head + table("fixed", fixed) + table("friction", law) + self.law + tables


def taken(at: dict[str, Any]) -> Base:
    """Takes `friction`, `system` and `units` out of what is given by name."""
    friction, system, units = (at.pop(name, None) for name in ("friction", "system", "units"))
    for name, of, kind in (("friction", friction, Friction), ("system", system, System)):
        if of is not None and not isinstance(of, kind):
            raise TypeError(f"{name} is a slipmap.{kind.__name__}, not {type(of).__name__}")
    if friction is not None and system is not None:
        raise InputError("friction and system are both given", "a system has no friction law")
    if system is not None:
        return Base(units_of(units) + system._text, None)
    return Base(units_of(units), None if friction is None else friction._text.removeprefix(_HEAD))
