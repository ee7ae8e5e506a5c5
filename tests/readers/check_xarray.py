"""xarray, with both of its netCDF-4 engines: named coordinates, nearest cells, flags, boundaries, classic netCDF."""

import tempfile

import numpy as np
import xarray as xr

import expected as e


def check_cells(engine):
    with xr.open_dataset(e.MAP, engine=engine, mask_and_scale=False) as ds:
        for name in e.CELLS:
            e.equal(f"dimensions of {name}", ds[name].dims, e.DIMS)
            e.same_cells(name, ds[name].values)
        for name, values in e.AXES.items():
            assert name in ds.indexes, f"{name} is no indexed coordinate"
            assert np.array_equal(ds[name].values, values), f"values of the axis {name}"
            e.equal(f"units of {name}", ds[name].attrs["units"], e.AXIS_UNITS[name])
            assert ds[name].attrs["long_name"], f"{name} has no long_name"
        for pick in e.PICKS:
            found = int(ds.n_unstable.sel(pick["near"], method="nearest"))
            e.equal(f"n_unstable near {pick['near']}", found, pick["n_unstable"])
        for scalar in e.SCALARS:
            coordinate = ds.n_unstable.coords[scalar["name"]]
            e.equal(f"dimensions of {scalar['name']}", coordinate.dims, ())
            e.equal(scalar["name"], float(coordinate), scalar["value"])
            e.equal(f"units of {scalar['name']}", coordinate.attrs["units"], scalar["units"])
        for name in ["n_unstable", "delay_margin"]:
            e.equal(f"units of {name}", ds[name].attrs["units"], e.UNITS[name])
            e.equal(f"ancillary variables of {name}", ds[name].attrs["ancillary_variables"], "status")
        e.equal("flag_masks", list(ds.status.attrs["flag_masks"]), e.FLAG_MASKS)
        e.equal("flag_meanings", ds.status.attrs["flag_meanings"].split(), e.FLAG_NAMES)
        e.equal("title", ds.attrs["title"], e.TITLE)
        e.equal("sweep", ds.attrs["sweep"], e.SWEEP)
        e.equal("Conventions", ds.attrs["Conventions"], "CF-1.11")


def check_as_opened_by_default(engine):
    """Fill values become NaN: there is none in a complete map."""
    with xr.open_dataset(e.MAP, engine=engine) as ds:
        e.equal("type of counts", str(ds.n_unstable.dtype), "uint16")
        e.equal("type of the status", str(ds.status.dtype), "uint8")
        e.equal("cells with the first flag", int((ds.status & 1).sum()), int((e.CELLS["status"] & 1).sum()))
        assert not ds.delay_margin.isnull().any(), "cells without a delay margin"
        assert np.array_equal(ds.n_unstable.values, e.CELLS["n_unstable"])
        along_tau = ds.n_unstable.isel({name: 0 for name in e.DIMS if name != "tau"})
        e.equal("dimensions of a line", along_tau.dims, ("tau",))


def check_classic(engine):
    """As classic netCDF, whose integers are signed: the types change, the numbers do not."""
    with tempfile.TemporaryDirectory() as folder:
        path = f"{folder}/classic.nc"
        with xr.open_dataset(e.MAP, engine=engine) as ds:
            ds.drop_encoding().to_netcdf(path, engine="netcdf4", format="NETCDF3_CLASSIC")
        with xr.open_dataset(path, engine="netcdf4", mask_and_scale=False) as ds:
            for name, cells in e.CELLS.items():
                assert np.array_equal(ds[name].values, cells), f"cells of {name} in classic netCDF"
            e.equal("flag_masks", list(ds.status.attrs["flag_masks"]), e.FLAG_MASKS)
            e.equal("type of counts", str(ds.n_unstable.dtype), "int16")


def check_boundaries(engine):
    with xr.open_dataset(e.MAP, engine=engine, group="boundaries", mask_and_scale=False) as ds:
        e.equal("dimensions of omega", ds.omega.dims, ("vertex",))
        e.equal("dimensions of vertex_count", ds.vertex_count.dims, ("curve",))
        e.equal("sample_dimension", ds.vertex_count.attrs["sample_dimension"], "vertex")
        e.equal("sum of vertex_count", int(ds.vertex_count.sum()), ds.sizes["vertex"])
        e.equal("units of omega", ds.omega.attrs["units"], e.UNITS["omega"])
        e.equal("units of tau", ds.tau.attrs["units"], e.AXIS_UNITS["tau"])
        e.equal("plane", ds.attrs["plane"], f"{e.PLANE} tau")
        e.equal("corners", ds["corner_tau"].dims, ("corner",))
        e.check_boundaries(lambda name: ds[name].values)


for engine in ["netcdf4", "h5netcdf"]:
    try:
        check_cells(engine)
        check_as_opened_by_default(engine)
        check_classic(engine)
        check_boundaries(engine)
    except AssertionError as error:
        raise AssertionError(f"with the engine {engine}: {error}") from error
