"""Answers: frozen objects whose attributes are the keys of the program's JSON."""

from __future__ import annotations

import html
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray


class Answer(Mapping[str, Any]):
    """What is known of one setting, frozen: attributes, and a mapping of the same names.

    Numbers that do not exist or are not known are NaN, without bound inf; None stands for the rest.
    """

    __slots__ = ("_of", "command", "toml")
    command: str | None
    toml: str

    def __init__(self, of: Mapping[str, Any], command: str | None = None, toml: str = "") -> None:
        object.__setattr__(self, "_of", {name: self._made(name, part) for name, part in of.items()})
        object.__setattr__(self, "command", command)
        object.__setattr__(self, "toml", toml)

    def _made(self, name: str, part: Any) -> Any:
        if isinstance(part, dict):
            return Record(part)
        if isinstance(part, list):
            return tuple(Record(of) if isinstance(of, dict) else of for of in part)
        return part

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        try:
            return self._of[name]
        except KeyError:
            raise AttributeError(f"{type(self).__name__} has no {name}; it has {', '.join(self._of)}") from None

    def __setattr__(self, name: str, value: Any) -> None:
        raise AttributeError(f"{type(self).__name__} is frozen")

    def __delattr__(self, name: str) -> None:
        raise AttributeError(f"{type(self).__name__} is frozen")

    def __getitem__(self, name: str) -> Any:
        return self._of[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._of)

    def __len__(self) -> int:
        return len(self._of)

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self._of]

    def __eq__(self, other: object) -> bool:
        return type(other) is type(self) and isinstance(other, Answer) and other._key() == self._key()

    def __hash__(self) -> int:
        return hash(self._key())

    def _key(self) -> tuple[Any, ...]:
        """All values as what can be compared; NaN equals itself."""
        return tuple((name, part.tobytes() if isinstance(part, np.ndarray) else repr(part)) for name, part in self._of.items())

    def __reduce__(self) -> tuple[Any, ...]:
        return (_again, (type(self), self._of, self.command, self.toml))

    def __repr__(self) -> str:
        rows = ", ".join(f"{name}={_short(part)}" for name, part in self._of.items())
        return f"{type(self).__name__}({rows})"

    def _repr_html_(self) -> str:
        rows = "".join(
            f"<tr><th style='text-align:left'>{html.escape(name)}</th>"
            f"<td style='text-align:left'>{html.escape(_short(part))}</td></tr>"
            for name, part in self._of.items()
        )
        said = "" if self.command is None else f"<code>{html.escape(self.command)}</code>"
        return f"<div><strong>{type(self).__name__}</strong><table>{rows}</table>{said}</div>"


class Record(Answer):
    """A part of an answer."""

    __slots__ = ()


def _again(kind: type[Answer], of: dict[str, Any], command: str | None, toml: str) -> Answer:
    made = object.__new__(kind)
    for name, part in (("_of", of), ("command", command), ("toml", toml)):
        object.__setattr__(made, name, part)
    return made


def _short(part: Any) -> str:
    if isinstance(part, np.ndarray):
        return np.array2string(part, threshold=6, precision=6)
    if isinstance(part, tuple) and len(part) > 6:
        return f"({', '.join(map(repr, part[:6]))}, … {len(part)} in all)"
    return repr(part)


def _frozen(of: NDArray[Any]) -> NDArray[Any]:
    of.flags.writeable = False
    return of


def _pairs(of: Any) -> NDArray[np.float64]:
    return _frozen(np.array(of, dtype=float).reshape(-1, 2))


class Point(Answer):
    """Linear stability at a point, with its roots and margins; see the guide, *In Python*."""

    __slots__ = ()
    n_unstable: int | None
    stable: bool
    marginal: bool
    reason: str | None
    tau: float
    abscissa: float
    frequency: float
    roots: NDArray[np.complex128]
    certified: bool
    certified_line: float
    certificate_margin: float
    stable_delays: NDArray[np.float64] | None
    stable_delays_truncated: bool
    stable_latencies: NDArray[np.float64] | None
    stable_latencies_truncated: bool
    delay_margin: float
    delay_margin_kind: str
    delay_margin_sign: int
    n_at_zero_delay: int | None
    first_crossing: float | None
    first_change: int | None
    crossings: tuple[Record, ...] | None
    essential_abscissa: float
    latency_margin: float

    def _made(self, name: str, part: Any) -> Any:
        if name == "roots":
            pairs = _pairs(part)
            return _frozen(pairs[:, 0] + 1j * pairs[:, 1])
        if name in ("stable_delays", "stable_latencies") and part is not None:
            return _pairs(part)
        return super()._made(name, part)


class Margins(Answer):
    """How far a setting is from the boundary of stability, or from a required decay rate."""

    __slots__ = ()
    required_decay: float
    decays: bool
    gain_margin: Record | None
    phase_margin: float
    latency_margin: float
    modulus_margin: float
    tau_margin: Record | None
    mu_prime_margin: Record | None
    v0_margin: Record | None
    stability_radius: float
    stability_box: Record | None
    crossing_frequencies: Record
    undecided: tuple[str, ...]
    looked_up_to: Record
    fit: Record | None


class Best(Answer):
    """The settings of fastest decay; ``toml`` is that of the one that is recommended."""

    __slots__ = ()
    searched: Record
    best: Record
    regions: tuple[Record, ...]
    regions_left_out: int
    robust: Record | None
    margins: Record
    vc: Record | None


class CriticalVelocity(Answer):
    """The velocity below which stick-slip survives."""

    __slots__ = ()
    vc: float
    vc_lower: float
    vc_upper: float
    protocol: str
    outcome: str
    windows: NDArray[np.float64]
    v_liftoff: float
    stick_time: float
    slip_time: float
    n_min: float
    method: str
    decided: bool

    def _made(self, name: str, part: Any) -> Any:
        return _pairs(part) if name == "windows" else super()._made(name, part)

    def __float__(self) -> float:
        return float(self.vc)


class Basin(Answer):
    """The share of starts from which control ends in sliding."""

    __slots__ = ()
    basin_share: float
    basin_share_error: float
    basin_share_upper: float
    interval: tuple[float, float] | None
    linearly_unstable: bool
    over: str
    starts: int
    scramblings: int
    outcomes: tuple[Record, ...]


class Plan(Answer):
    """What a sweep comes to, before it is run."""

    __slots__ = ()
    shape: Record
    fields: tuple[str, ...]
    cells: int
    pieces: int
    bytes: int
    memory: int
    memory_of_a_thread: int
    hash: str
    seconds: float | None
