"""Root maps in xarray (both engines) and h5py: coordinates, NaN and infinities, units, certificate flags, every cell."""

import json
from pathlib import Path

import h5py
import numpy as np
import xarray as xr

MAP = "map.h5"
FACTS = json.loads(Path("expected.json").read_text(encoding="utf-8"))
AXES = {name: np.array(values) for name, values in FACTS["axes"].items()}
SHAPE = tuple(len(values) for values in AXES.values())


def same(name, found):
    """Fails unless `found` holds the cells of the field `name`, infinities and missing values included."""
    expected = np.fromfile(f"{name}.f64", "<f8").reshape(SHAPE)
    assert found.shape == SHAPE and found.dtype == np.float64, f"{name}: {found.shape} {found.dtype}"
    wrong = ~np.isclose(found, expected, rtol=1e-11, atol=1e-11, equal_nan=True)
    assert not wrong.any(), f"{name}: {found[wrong]} instead of {expected[wrong]}"


def check_xarray(engine):
    with xr.open_dataset(MAP, engine=engine) as ds:
        for name, unit in FACTS["units"].items():
            cells = ds[name]
            assert cells.dims == tuple(AXES), f"dimensions of {name}: {cells.dims}"
            same(name, cells.values)
            assert cells.attrs["units"] == unit, f"units of {name}: {cells.attrs['units']}"
            assert cells.attrs["long_name"], f"{name} has no long_name"
            assert cells.attrs["ancillary_variables"] == "status"
            assert np.isnan(cells.encoding["_FillValue"]), f"_FillValue of {name}"
        for name, values in AXES.items():
            assert np.array_equal(ds[name].values, values), f"values of {name}"
        assert "certificate_margin" in ds.abscissa.attrs["comment"]
        masks = np.atleast_1d(ds.status.attrs["flag_masks"])
        flags = dict(zip(ds.status.attrs["flag_meanings"].split(), masks))
        certified = ds.status.values.astype(np.uint8) & flags["certified"] != 0
        assert certified.all(), f"{(~certified).sum()} cells are not certified"
        assert not (ds.status.values.astype(np.uint8) & (flags["disagree"] | flags["not_converged"])).any()
        assert (ds.certificate_margin.values >= 0).all()
        stable = ds.abscissa.sel(alpha_n=FACTS["stable"]["alpha_n"], tau=FACTS["stable"]["tau"], method="nearest")
        assert float(stable) < 0, f"abscissa {float(stable)} where sliding is stable"


for engine in ["netcdf4", "h5netcdf"]:
    check_xarray(engine)
with h5py.File(MAP, "r") as file:
    for name in FACTS["units"]:
        same(name, file[name][...])
        assert file[name].compression == "gzip" and file[name].shuffle, f"filters of {name}"
        assert [dim[0].name for dim in file[name].dims] == [f"/{axis}" for axis in AXES]
