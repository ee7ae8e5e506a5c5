"""What the pure Python half calls."""

from collections.abc import Callable
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

__all__ = [
    "Subject",
    "__version__",
    "answer",
    "catalogue",
    "cell",
    "evaluate",
    "fit",
    "inlined",
    "law",
    "n_unstable",
    "plan",
    "read_curve",
    "run",
    "simulate",
]
__version__: str

@final
class Subject:
    def __new__(cls, text: str) -> Subject: ...
    def parameters(self) -> list[str]: ...
    def of_law(self) -> list[str]: ...

def answer(kind: str, text: str, options: dict[str, Any]) -> dict[str, Any]: ...
def catalogue(kind: str) -> list[dict[str, Any]]: ...
def cell(text: str, at: list[tuple[str, float]]) -> str: ...
def evaluate(
    subject: Subject, fields: list[str], at: dict[str, Any], threads: int
) -> dict[str, tuple[NDArray[Any], str, str]]: ...
def fit(
    speeds: NDArray[np.float64], mu_k: NDArray[np.float64], v0: float, law: str | None, mu_s: float | None
) -> dict[str, Any]: ...
def inlined(text: str, read: Callable[[str], bytes]) -> tuple[str, list[str]]: ...
def law(subject: Subject, speeds: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]: ...
def n_unstable(subject: Subject, at: dict[str, Any], threads: int) -> NDArray[np.int64] | int: ...
def plan(text: str, timed: bool) -> dict[str, Any]: ...
def read_curve(
    bytes: bytes, columns: str | None, normal_load: float | None, speed_unit: str | None, units: str | None
) -> tuple[tuple[NDArray[np.float64], NDArray[np.float64]], list[str]]: ...
def run(
    text: str,
    threads: int,
    memory: int | None,
    history: str,
    progress: Callable[[int, int], object] | None,
) -> list[Any]: ...
def simulate(text: str, end: str, history: str) -> list[Any]: ...
