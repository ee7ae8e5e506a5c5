"""pandas: tables as text, against what xarray and h5py read of the files that they are from."""

import h5py
import numpy as np
import pandas as pd
import xarray as xr


def read(name):
    return pd.read_csv(f"{name}.csv", comment="#")


def same(what, found, expected):
    np.testing.assert_array_equal(np.asarray(found), np.asarray(expected), err_msg=what)


def words(variable):
    names = np.array(variable.flag_meanings.split())
    return names[variable.values.astype(int).ravel() - int(variable.flag_values[0])]


def check_cells():
    table = read("cells")
    ds = xr.open_dataset("map.h5")
    axes = ["tau", "alpha_n"]
    same("names", table.columns[:2], axes)
    cells = table.set_index(axes).to_xarray()
    for axis in axes:
        same(axis, ds[axis], table[axis].unique())
    for field in ["n_unstable", "delay_margin", "settle_time", "status"]:
        same(field, cells[field].sel(tau=ds.tau, alpha_n=ds.alpha_n), ds[field].transpose(*axes))
    same("outcome", table.outcome, words(ds.outcome))
    assert np.isinf(table.delay_margin).any() and table.settle_time.isna().any()
    assert table.status.dtype.kind == "i" and table.n_unstable.dtype.kind == "i"


def check_boundaries():
    table = read("boundaries")
    with h5py.File("map.h5") as file:
        group = file["boundaries"]
        for name in ["alpha_n", "tau", "omega"]:
            same(name, table[name], group[name][:])
        same("vertices", table.groupby("curve").size(), group["vertex_count"][:])
        same("branch", table.groupby("curve").branch.first(), group["branch"][:])


def check_trace():
    samples = read("samples")
    ds = xr.open_dataset("trace.h5")
    for name in ["t", "x", "x_dot", "a", "v", "N", "pulling_force", "friction_force"]:
        same(name, samples[name], ds[name])
    same("mode", samples["mode"], words(ds["mode"]))
    events = read("events")
    ds = xr.open_dataset("trace.h5", group="event")
    for name in ["t", "a"]:
        same(name, events[name], ds[name])
    same("kind", events.kind, words(ds.kind))


if __name__ == "__main__":
    check_cells()
    check_boundaries()
    check_trace()
