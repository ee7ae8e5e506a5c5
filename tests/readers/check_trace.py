"""xarray and netCDF4: a trace with its events, against what the program said of the same motion."""

import json
import sys

import netCDF4
import numpy as np
import xarray as xr

QUANTITIES = ("x", "x_dot", "a", "v", "N", "pulling_force", "friction_force")


def equal(what, found, expected):
    assert found == expected, f"{what}: {found!r}, expected {expected!r}"


def check(name):
    with open(f"{name}.json") as file:
        said = json.load(file)
    trace = xr.open_dataset(f"{name}.h5")
    equal("outcome", trace.attrs["outcome"], said["outcome"])
    equal("last release", trace.attrs["last_release"], said["last_release"])
    with open_events(name) as events:
        names = np.array(events.kind.flag_meanings.split())
        equal("kinds", list(names[events.kind.values.astype(int)]), [e["kind"] for e in said["events"]])
        equal("times", list(events.t.values), [e["t"] for e in said["events"]])
        equal("elongations", list(events.a.values), [e["a"] for e in said["events"]])
        for t, a in zip(events.t.values, events.a.values):
            assert abs(float(trace.a.sel(t=t)) - a) < 1e-12, f"sample of the event at {t}"
    for quantity in QUANTITIES:
        equal(f"dimensions of {quantity}", trace[quantity].dims, ("t",))
        assert np.isfinite(trace[quantity].values).all(), quantity
        assert trace[quantity].attrs["long_name"] and trace[quantity].attrs["units"]
    # Between samples, x_dot is the slope of x.
    slope = np.diff(trace.x.values) / np.diff(trace.t.values)
    middle = 0.5 * (trace.x_dot.values[1:] + trace.x_dot.values[:-1])
    wide = np.diff(trace.t.values) > 1e-6
    assert np.abs(slope - middle)[wide].max() < 1e-2, "x_dot is the slope of x"


def open_events(name):
    return xr.open_dataset(f"{name}.h5", group="event")


def check_netcdf4(name):
    with netCDF4.Dataset(f"{name}.h5") as ds:
        equal("kind of file", ds.data_model, "NETCDF4")
        equal("variables over time", {v for v in ds.variables if ds[v].dimensions == ("t",)}, {"t", "mode", *QUANTITIES})
        equal("dimensions of the events", ds["event/kind"].dimensions, ("event",))


if __name__ == "__main__":
    check(sys.argv[1])
    check_netcdf4(sys.argv[1])
