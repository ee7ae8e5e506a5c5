#!/usr/bin/env python3
"""Prints a checksum of every dataset and attribute of maps and traces, but of when and by what they were made.

    map_sums.py MAP.h5 …

SHA-256 of the bytes of a dataset with its type and shape, of those of an attribute, and the names of the axes. Needs h5py
(scripts/requirements-readers.txt).
"""

import argparse
import hashlib
from pathlib import Path

import h5py
import numpy as np

# Those that name the program and the time, a checksum over them, and places in the file.
LEFT_OUT = {
    "history", "source", "program_version", "git_revision", "contents_sha256", "DIMENSION_LIST", "REFERENCE_LIST",
}


def checksum(value: object) -> str:
    """SHA-256 of a value with its type and shape."""
    array = np.asarray(value)
    # Texts of any length have no bytes of their own.
    data = repr(array.tolist()).encode() if array.dtype.hasobject else array.tobytes()
    return hashlib.sha256(f"{array.dtype.str} {array.shape} ".encode() + data).hexdigest()


def axes(dataset: h5py.Dataset) -> str:
    """The names of the axes of a dataset."""
    return " ".join(",".join(scale.name for scale in axis.values()) or "-" for axis in dataset.dims)


def lines(path: Path) -> list[str]:
    """A line for each dataset and each attribute."""
    found = []

    def add(name: str, node: h5py.Group | h5py.Dataset) -> None:
        if isinstance(node, h5py.Dataset):
            found.append(f"{checksum(node[()])}  {path.name} {name} [{axes(node)}]")
        found.extend(
            f"{checksum(value)}  {path.name} {name}@{key}"
            for key, value in sorted(node.attrs.items())
            if key not in LEFT_OUT
        )

    with h5py.File(path) as file:
        add("/", file)
        file.visititems(lambda name, node: add(f"/{name}", node))
    return found


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("maps", type=Path, nargs="+", metavar="MAP.h5")
    for path in parser.parse_args().maps:
        print("\n".join(lines(path)))


if __name__ == "__main__":
    main()
