"""The names that slipmap knows."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

from . import _core


def catalogue(kind: str) -> list[dict[str, Any]]:
    """All names of a kind, with their units, ranges and meanings.

    Parameters
    ----------
    kind : {"parameters", "fields", "laws", "systems"}

    Examples
    --------
    >>> [row["name"] for row in catalogue("laws")][:3]
    ['coulomb', 'weakening', 'stribeck']
    """
    return list(_core.catalogue(kind))


@lru_cache(maxsize=1)
def fields() -> dict[str, dict[str, Any]]:
    """The rows of all fields by their names."""
    return {row["name"]: row for row in _core.catalogue("fields")}
