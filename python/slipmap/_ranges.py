"""Whole numbers in their ranges."""

from __future__ import annotations

import os

from ._error import InputError

MOST_THREADS = 4096


def whole(name: str, of: int, least: int, most: int) -> int:
    """A whole number, or what is wrong with it."""
    if not least <= of <= most:
        raise InputError(f"{name} = {of} is outside its range: {least} to {most}")
    return int(of)


def all_threads() -> int:
    """As many threads as the machine offers."""
    return os.cpu_count() or 1


def threads(asked: int | None) -> int:
    """How many threads to compute on: all unless a number is asked for."""
    return whole("threads", all_threads() if asked is None else asked, 1, MOST_THREADS)
