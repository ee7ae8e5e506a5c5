#!/usr/bin/env python3
"""Runs two programs on sweeps and compares their maps, dataset by dataset, byte by byte.

    compare_maps.py [--points N] OLD NEW [SWEEP.toml …]

OLD and NEW are slipmap programs; without sweeps and cases all of sweeps/ are run, with --points at most so many points along
each axis. Needs h5py (scripts/requirements-readers.txt).
Prints for every sweep which datasets differ, in how many values and by how much; the exit code is 1 where one does.
"""

import argparse
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import h5py
import numpy as np

SWEEPS = Path(__file__).resolve().parent.parent / "sweeps"


def is_sweep(path: Path) -> bool:
    """A case file has a motion's start and trace, and no axes."""
    return "[axes]" in path.read_text(encoding="utf-8")


def shrunk(text: str, points: int | None) -> str:
    """A sweep with at most so many points along each axis."""
    if points is None:
        return text
    return re.sub(r"\bpoints = (\d+)", lambda found: f"points = {min(int(found[1]), points)}", text)


def run(program: Path, sweep: Path, folder: Path, points: int | None) -> Path:
    """The map of a sweep or the trace of a case, in a folder of its own."""
    folder.mkdir()
    copy = folder / sweep.name
    copy.write_text(shrunk(sweep.read_text(encoding="utf-8"), points), encoding="utf-8")
    verb = "run" if is_sweep(sweep) else "simulate"
    command = [program.resolve(), verb, copy.name]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{program} {verb} {sweep}: {done.stderr}")
    return next(folder.glob("*.h5"))


def datasets(path: Path) -> dict[str, np.ndarray]:
    """All datasets of a map by their names."""
    found = {}
    with h5py.File(path) as file:
        file.visititems(
            lambda name, node: found.update({name: node[()]}) if isinstance(node, h5py.Dataset) else None
        )
    return found


def difference(old: np.ndarray, new: np.ndarray) -> str | None:
    """What differs between two datasets, in words; None where nothing does."""
    if old.shape != new.shape or old.dtype != new.dtype:
        return f"{old.dtype} {old.shape} became {new.dtype} {new.shape}"
    if old.tobytes() == new.tobytes():
        return None
    if old.dtype.kind not in "iuf":
        return "other contents"
    same = (old == new) | ((old != old) & (new != new))
    text = f"{np.count_nonzero(~same)} of {same.size} differ"
    if old.dtype.kind == "f":
        with np.errstate(all="ignore"):
            off = np.abs(new / old - 1.0)[~same]
        off = off[np.isfinite(off)]
        if off.size:
            text += f", those with values by {np.median(off):.1e} in the median, {off.max():.1e} at most, relative"
            text += f", {np.count_nonzero(off > 1e-4)} by more than 1e-4"
    return text


def compare(old: Path, new: Path) -> list[str]:
    """What differs between two maps, a line for each dataset."""
    before, after = datasets(old), datasets(new)
    lines = [f"{name} is only in one" for name in sorted(before.keys() ^ after.keys())]
    for name in sorted(before.keys() & after.keys()):
        found = difference(before[name], after[name])
        if found:
            lines.append(f"{name}: {found}")
    return lines


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--points", type=int)
    parser.add_argument("old", type=Path)
    parser.add_argument("new", type=Path)
    parser.add_argument("sweeps", type=Path, nargs="*")
    given = parser.parse_args()
    sweeps = given.sweeps or sorted(SWEEPS.glob("*.toml"))
    if not sweeps:
        parser.error(f"there is no sweep in {SWEEPS}")
    changed = 0
    for sweep in sweeps:
        with tempfile.TemporaryDirectory() as folder:
            maps = [run(p, sweep, Path(folder) / n, given.points) for p, n in ((given.old, "old"), (given.new, "new"))]
            lines = compare(*maps)
        changed += bool(lines)
        print(f"{sweep.name}: {'same' if not lines else ''}", flush=True)
        for line in lines:
            print(f"  {line}", flush=True)
    return 1 if changed else 0


if __name__ == "__main__":
    sys.exit(main())
