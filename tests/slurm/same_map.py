"""Compares two maps: every group, dataset, stored chunk and attribute, byte for byte; only `history` may differ.

python same_map.py A.h5 B.h5
"""

import sys

import h5py
import numpy as np


def contents(path):
    """What a map consists of: names → things that can be compared."""
    found = {}

    def visit(name, item):
        for key in item.attrs:
            found[f"{name}@{key}"] = attribute(item, key)
        if isinstance(item, h5py.Dataset):
            found[name] = (item.shape, str(item.dtype), item.chunks, item[...].tobytes())
            if item.chunks:
                dataset = item.id
                places = [dataset.get_chunk_info(i).chunk_offset for i in range(dataset.get_num_chunks())]
                found[f"{name} as stored"] = {place: dataset.read_direct_chunk(place) for place in places}
        else:
            found[name] = "group"

    with h5py.File(path) as file:
        visit("/", file)
        file.visititems(visit)
    del found["/@history"]
    return found


def attribute(item, key):
    value = np.asarray(item.attrs[key])
    # References are places in a file; the datasets they lead to are compared by name.
    if value.dtype.hasobject:
        return (value.shape, str(h5py.h5t.check_ref_dtype(value.dtype)), str(value.dtype.names))
    return (value.shape, str(value.dtype), value.tobytes())


def main():
    first, second = (contents(path) for path in sys.argv[1:])
    different = [name for name in sorted(first.keys() | second.keys()) if first.get(name) != second.get(name)]
    if different:
        sys.exit(f"{' and '.join(sys.argv[1:])} differ in {', '.join(different)}")
    datasets = [name for name in first if f"{name} as stored" in first]
    print(f"{len(first)} parts are the same, {len(datasets)} datasets with their stored chunks among them")


main()
