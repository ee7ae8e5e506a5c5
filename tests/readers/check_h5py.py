"""h5py, the plain HDF5 reader: dimension scales, attributes, fill values, filters, every cell."""

import h5py
import numpy as np

import expected as e


def text(value):
    return value.decode() if isinstance(value, bytes) else value


def check_variable(file, name):
    data = file[name]
    e.same_cells(name, data[...])
    for place, (axis, values) in enumerate(e.AXES.items()):
        e.equal(f"scales of {name} along dimension {place}", data.dims[place].keys(), [axis])
        scale = data.dims[place][0]
        e.equal(f"scale {place} of {name}", scale.name, f"/{axis}")
        assert np.array_equal(scale[...], values), f"values of the scale {axis} of {name}"
    fill = e.FILL[name]
    real = data.dtype.kind == "f"
    e.equal(f"_FillValue of {name}", "_FillValue" in data.attrs, real)
    for what, found in [("fill value", data.fillvalue), *([("_FillValue", data.attrs["_FillValue"])] if real else [])]:
        found = np.ravel(found)[0]
        assert found == fill or (np.isnan(fill) and np.isnan(found)), f"{what} of {name} is {found}"
    if real:
        e.equal(f"type of the _FillValue of {name}", np.asarray(data.attrs["_FillValue"]).dtype, data.dtype)
    assert "valid_max" not in data.attrs, f"{name} has a valid_max"
    e.equal(f"compression of {name}", data.compression, "gzip")
    e.equal(f"shuffling of {name}", data.shuffle, data.dtype.itemsize > 1)
    assert text(data.attrs["long_name"]), f"{name} has no long_name"


with h5py.File(e.MAP, "r") as file:
    for name in e.CELLS:
        check_variable(file, name)
    for axis in e.AXES:
        assert file[axis].is_scale, f"{axis} is no dimension scale"
        e.equal(f"units of {axis}", text(file[axis].attrs["units"]), e.AXIS_UNITS[axis])
        used = file[axis].attrs["REFERENCE_LIST"]
        users = {file[reference].name: int(place) for reference, place in used}
        for name in e.CELLS:
            e.equal(f"place of {axis} in {name}", users[f"/{name}"], list(e.AXES).index(axis))
    for scalar in e.SCALARS:
        e.equal(scalar["name"], float(file[scalar["name"]][()]), scalar["value"])
        e.equal(f"units of {scalar['name']}", text(file[scalar["name"]].attrs["units"]), scalar["units"])
    e.equal("flag_masks", list(file["status"].attrs["flag_masks"]), e.FLAG_MASKS)
    e.equal("type of flag_masks", file["status"].attrs["flag_masks"].dtype, np.uint8)
    e.equal("flag_meanings", text(file["status"].attrs["flag_meanings"]).split(), e.FLAG_NAMES)
    e.equal("axes", text(file.attrs["axes"]).split(), list(e.AXES))
    e.equal("sweep", text(file.attrs["sweep"]), e.SWEEP)
    e.equal("format version", int(np.ravel(file.attrs["slipmap_format_version"])[0]), 6)
    e.equal("length of the plan hash", len(text(file.attrs["plan_hash"])), 64)
    group = file["boundaries"]
    e.equal("scale of omega", group["omega"].dims[0][0].name, "/boundaries/vertex")
    e.equal("length of the scale vertex", group["vertex"].shape, group["omega"].shape)
    e.check_boundaries(lambda name: group[name][...])
