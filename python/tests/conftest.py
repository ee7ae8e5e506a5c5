"""What the tests share: the program, the reference tables, the shipped sweeps."""

from __future__ import annotations

import csv
import json
import os
import subprocess
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def program() -> Callable[..., Any]:
    """Runs the program, and reads the JSON that it prints."""
    path = os.environ.get("SLIPMAP_PROGRAM", str(ROOT / "target/release/slipmap"))

    def call(*args: str, as_json: bool = True, ok: bool = True) -> Any:
        said = subprocess.run([path, *args, *(["--json"] if as_json else [])], capture_output=True, text=True, check=False)
        assert (said.returncode == 0) == ok, said.stderr
        return json.loads(said.stdout) if as_json and ok else said

    return call


def reference(name: str) -> Iterator[dict[str, str]]:
    """The rows of a table that other programs computed."""
    with open(ROOT / "tests/reference" / name, newline="", encoding="utf-8") as file:
        yield from csv.DictReader(line for line in file if not line.startswith("#"))
