"""The notebooks run from beginning to end."""

from __future__ import annotations

import nbformat
import pytest
from nbclient import NotebookClient

from conftest import ROOT

NOTEBOOKS = sorted((ROOT / "python/notebooks").glob("*.ipynb"))


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_runs(path: object, tmp_path: object) -> None:
    book = nbformat.read(str(path), as_version=4)
    assert not any(cell.get("outputs") for cell in book.cells), "it is kept without outputs"
    NotebookClient(book, timeout=120, resources={"metadata": {"path": str(tmp_path)}}).execute()
    assert any("image/png" in out.get("data", {}) for cell in book.cells for out in cell.get("outputs", []))


def test_there_are_two() -> None:
    assert [path.stem for path in NOTEBOOKS] == ["letter", "rig"]
