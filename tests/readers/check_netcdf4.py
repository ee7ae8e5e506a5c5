"""netCDF4: dimensions, groups, and a map that can be appended to without harm."""

import shutil

import netCDF4
import numpy as np

import expected as e

COPY = "appended.h5"


def check(path):
    with netCDF4.Dataset(path) as ds:
        ds.set_auto_maskandscale(False)
        e.equal("kind of file", ds.data_model, "NETCDF4")
        sizes = {name: len(dimension) for name, dimension in ds.dimensions.items() if name in e.AXES}
        e.equal("dimensions", sizes, dict(zip(e.DIMS, e.SHAPE)))
        for name in e.CELLS:
            e.equal(f"dimensions of {name}", ds[name].dimensions, e.DIMS)
            e.same_cells(name, ds[name][...])
        for name, values in e.AXES.items():
            assert np.array_equal(ds[name][...], values), f"values of {name}"
            e.equal(f"units of {name}", ds[name].units, e.AXIS_UNITS[name])
        listed = ds["n_unstable"].coordinates.split()
        e.equal("coordinates", listed, [s["name"] for s in e.SCALARS if s["name"] in listed])
        for scalar in e.SCALARS:
            assert scalar["name"] in listed, f"{scalar['name']} is no coordinate of n_unstable"
            e.equal(scalar["name"], float(ds[scalar["name"]][...]), scalar["value"])
        group = ds["boundaries"]
        e.equal("dimensions of omega", group["omega"].dimensions, ("vertex",))
        e.equal("length of vertex", len(group.dimensions["vertex"]), len(group["omega"]))
        e.equal("length of curve", len(group.dimensions["curve"]), len(group["vertex_count"]))
        e.equal("length of corner", len(group.dimensions["corner"]), len(group["corner_tau"]))
        e.check_boundaries(lambda name: group[name][...])


check(e.MAP)
shutil.copyfile(e.MAP, COPY)
with netCDF4.Dataset(COPY, "a") as ds:
    ds.setncattr("note", "looked at")
    ds["n_unstable"].setncattr("comment", "exact")
    stable = ds.createVariable("stable", "i1", ds["n_unstable"].dimensions, zlib=True)
    stable[...] = e.CELLS["n_unstable"] == 0
check(COPY)
with netCDF4.Dataset(COPY) as ds:
    e.equal("appended attribute", ds.note, "looked at")
    e.equal("appended attribute of a variable", ds["n_unstable"].comment, "exact")
    assert np.array_equal(ds["stable"][...], e.CELLS["n_unstable"] == 0), "appended variable"
