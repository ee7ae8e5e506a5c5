"""Parameters and tables as the text of a file, which one reader reads."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from . import _core
from ._error import InputError

Sweep = str | os.PathLike[str] | Mapping[str, Any]


def quoted(text: str) -> str:
    """A string of TOML."""
    marks = {"\\": "\\\\", '"': '\\"', "\n": "\\n", "\r": "\\r", "\t": "\\t"}
    escape = lambda c: marks.get(c) or (f"\\u{ord(c):04x}" if ord(c) < 32 or ord(c) == 127 else c)  # noqa: E731
    return '"' + "".join(map(escape, text)) + '"'


def key(name: object) -> str:
    """A key of TOML."""
    text = str(name)
    plain = text and all(c.isascii() and (c.isalnum() or c in "_-") for c in text)
    return text if plain else quoted(text)


def value(of: Any) -> str:
    """A value of TOML."""
    if isinstance(of, (bool, np.bool_)):
        return "true" if of else "false"
    if isinstance(of, (int, np.integer)):
        return str(int(of))
    if isinstance(of, (float, np.floating)):
        return repr(float(of))
    if isinstance(of, str):
        return quoted(of)
    if isinstance(of, os.PathLike):
        return quoted(os.fsdecode(of))
    if isinstance(of, Mapping):
        return "{ " + ", ".join(f"{key(name)} = {value(part)}" for name, part in of.items()) + " }"
    if hasattr(of, "tolist"):
        return value(of.tolist())
    if isinstance(of, Sequence):
        return "[" + ", ".join(map(value, of)) + "]"
    raise TypeError(f"{type(of).__name__} has no place in a sweep, a case or a setting")


def table(name: str, rows: Mapping[str, Any]) -> str:
    """A table with its head."""
    return f"[{name}]\n" + "".join(f"{key(of)} = {value(part)}\n" for of, part in rows.items())


def units_of(units: Any) -> str:
    """The line of the units; empty without any."""
    if units is None:
        return ""
    if isinstance(units, (list, tuple)) and len(units) == 3:
        units = dict(zip(("force", "length", "time"), units, strict=True))
    return f"units = {value(units)}\n"


def document(of: Mapping[str, Any]) -> str:
    """A whole file: keys first, then tables."""
    plain = {name: part for name, part in of.items() if not isinstance(part, Mapping)}
    tables = {name: part for name, part in of.items() if isinstance(part, Mapping)}
    head = "".join(f"{key(name)} = {value(part)}\n" for name, part in plain.items())
    return head + "".join(table(key(name), part) for name, part in tables.items())


def is_text(of: object) -> bool:
    """Whether a string is the text of a file, not its path."""
    return isinstance(of, str) and ("\n" in of or ("=" in of and not of.endswith(".toml")))


def read(sweep: Sweep) -> str:
    """The text of a path, a text or a dict, with the tables and systems that it names inside it."""
    folder = Path()
    if isinstance(sweep, Mapping):
        text = document(sweep)
    elif is_text(sweep):
        text = str(sweep)
    else:
        path = Path(sweep)
        folder = path.parent
        try:
            text = path.read_bytes().decode()
        except UnicodeDecodeError as error:
            raise InputError(f"{path} is not UTF-8 text") from error
    inlined, _ = _core.inlined(text, lambda name: (folder / name).read_bytes())
    return inlined
