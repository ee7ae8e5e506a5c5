"""Maps in memory and from files: equal, whatever makes them."""

from __future__ import annotations

import os
import threading
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
import pytest
import xarray as xr

import slipmap
from conftest import ROOT

matplotlib.use("agg")

SWEEPS = ROOT / "sweeps"
# Those of a few seconds.
SHIPPED = [
    "decay_load",
    "decay_velocity",
    "fig2a",
    "fig2b",
    "fig4",
    "latency_velocity",
    "load_memory",
    "rate_state_load",
    "rate_state_velocity",
    "turning_lobes",
    "velocity_damped",
    "velocity_limit",
    "velocity_memory",
    "velocity_smooth",
]
# What a file has and memory has not: the history, and hashes of what is stored.
OF_FILES = {"history", "chunks_sha256", "contents_sha256"}

OTHERS = {
    "best": """
fields = ["abscissa", "frequency"]
best = true
[axes]
mu_prime = [-0.3, 0.2]
alpha_v = { from = -1, to = 1, points = 9 }
tau = { from = 0, to = 6, points = 8 }
""",
    "best_of_one_plane": """
best = true
[axes]
alpha_v = { from = -1, to = 0, points = 9 }
tau = { from = 0, to = 9, points = 19 }
[fixed]
mu_prime = -0.3
""",
    "motions": """
fields = ["outcome", "n_min", "n_unstable"]
[axes]
v0 = [0.1, 0.6]
tau = [0.5, 1.0]
[fixed]
alpha_n = -1.0
[friction]
law = "coulomb"
mu0 = 0.5
""",
    "critical": """
fields = ["vc", "vc_lower", "windows"]
[axes]
alpha_n = [-1.0, 0.0, 1.0]
tau = [0.5, 1.0]
[friction]
law = "coulomb"
mu0 = 0.5
""",
    "outside": """
fields = ["n_unstable", "abscissa", "delay_margin"]
[axes]
sigma = [-1.0, 0.2]
tau = [0.5, 1.0]
[fixed]
v0 = 0.5
[friction]
law = "formula"
mu_k = "0.3 + sigma*v"
""",
    "system": 'system = "turning"\nfields = ["n_unstable", "abscissa"]\n[axes]\n'
    "width = [0.1, 0.3]\ntau = [1.0, 2.0]\n",
}


def told(of: dict[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in of.items() if name not in OF_FILES}


def same(one: Any, other: Any) -> bool:
    a, b = np.asarray(one), np.asarray(other)
    return a.dtype == b.dtype and a.shape == b.shape and a.tobytes() == b.tobytes()


def check_equal(memory: xr.DataTree, file: xr.DataTree) -> int:
    """Checks groups, variables, types, values to the last bit and attributes; returns how many numbers."""
    assert [node.path for node in memory.subtree] == [node.path for node in file.subtree]
    count = 0
    for one, other in zip(memory.subtree, file.subtree, strict=True):
        assert told(one.attrs).keys() == told(other.attrs).keys(), one.path
        for name, value in told(one.attrs).items():
            assert same(value, other.attrs[name]), (one.path, name)
        a, b = one.to_dataset(inherit=False), other.to_dataset(inherit=False)
        assert list(a.variables) == list(b.variables), one.path
        assert set(a.coords) == set(b.coords), one.path
        for name in a.variables:
            mine, theirs = a.variables[name], b.variables[name]
            assert mine.dims == theirs.dims, (one.path, name)
            assert same(mine.values, theirs.values), (one.path, name)
            assert told(mine.attrs).keys() == told(theirs.attrs).keys(), (one.path, name)
            for key, value in told(mine.attrs).items():
                assert same(value, theirs.attrs[key]), (one.path, name, key)
            count += mine.size
    return count


def written(program: Any, sweep: Path, folder: Path) -> xr.DataTree:
    out = folder / f"{sweep.stem}.h5"
    program("run", str(sweep), "-o", str(out), "--quiet", as_json=False)
    return slipmap.open_map(out)


@pytest.mark.parametrize("name", SHIPPED)
def test_a_shipped_sweep_is_the_map_of_the_program(name: str, program: Any, tmp_path: Path) -> None:
    path = SWEEPS / f"{name}.toml"
    assert check_equal(slipmap.run(path, progress=False), written(program, path, tmp_path)) > 1000


@pytest.mark.parametrize("name", OTHERS)
def test_every_kind_of_field_is_that_of_the_program(name: str, program: Any, tmp_path: Path) -> None:
    path = tmp_path / f"{name}.toml"
    path.write_text(OTHERS[name])
    assert check_equal(slipmap.run(OTHERS[name]), written(program, path, tmp_path)) > 0


def test_a_table_beside_a_sweep_is_inside_its_text(program: Any, tmp_path: Path) -> None:
    (tmp_path / "curve.csv").write_text("v;mu\n0;0,5\n0,25;0,4\n1;0,3\n", encoding="cp1252")
    sweep = tmp_path / "measured.toml"
    sweep.write_text('[axes]\nv0 = [0.1, 0.3]\ntau = [1, 2]\n[friction]\nlaw = "table"\ntable = "curve.csv"\n')
    check_equal(slipmap.run(sweep), written(program, sweep, tmp_path))


def test_a_dict_is_its_text_and_threads_do_not_matter() -> None:
    sweep = {
        "fields": ["abscissa"],
        "axes": {"alpha_v": np.linspace(-1, 0, 40), "tau": {"from": 0.0, "to": 9.0, "points": 60}},
        "fixed": {"mu_prime": -0.3, "mass": "1 kg"},
        "units": "SI",
    }
    one = slipmap.run(sweep, threads=1)
    assert check_equal(one, slipmap.run(sweep, threads=4, memory="1GB")) > 2400
    assert one["abscissa"].attrs["units"] == "s-1"


def test_a_motion_is_the_trace_of_the_program(program: Any, tmp_path: Path) -> None:
    case = SWEEPS / "fig3a.toml"
    out = tmp_path / "fig3a.h5"
    program("simulate", str(case), "-o", str(out), "--picture", str(tmp_path / "p.png"), as_json=False)
    found = slipmap.simulate(case)
    assert check_equal(found, slipmap.open_map(out)) > 1000
    assert found.attrs["outcome"] == "sliding" and found["event"]["kind"].size > 0
    law = slipmap.Friction("weakening", mu0=0.5, v_s=0.5)
    by_names = slipmap.simulate(friction=law, v0=0.35, alpha_v=-0.33, tau=4.15, x_dot0=0.0, until=20.0)
    assert by_names["t"].values[-1] == 20.0


def test_integers_stay_integers_and_real_fill_is_nan(tmp_path: Path) -> None:
    tree = slipmap.run(OTHERS["outside"])
    cells = tree.dataset
    assert cells["n_unstable"].dtype == np.uint16 and cells["status"].dtype == np.uint8
    assert not tree.slipmap.known("n_unstable").sel(sigma=-1.0).any()
    assert not tree.slipmap.known("abscissa").sel(sigma=-1.0).any()
    assert tree.slipmap.flag("outside_model").sel(sigma=-1.0).all()
    assert tree.slipmap.known("n_unstable").sel(sigma=0.2).all()
    tree.to_netcdf(tmp_path / "again.nc", engine="h5netcdf")
    again = xr.open_dataset(tmp_path / "again.nc", engine="h5netcdf", mask_and_scale=False)
    assert again["n_unstable"].dtype == np.uint16


def test_a_map_tells_what_is_stable_and_a_point_of_it() -> None:
    tree = slipmap.run(SWEEPS / "decay_velocity.toml", progress=False)
    stable = tree.slipmap.stable
    assert 0 < int(stable.sum()) < stable.size
    where = {name: float(tree.dataset[name][tree.dataset[name].size // 3]) for name in tree.slipmap.axes}
    point = tree.slipmap.point(**where)
    assert point.stable == bool(stable.sel(where))
    assert point.abscissa == pytest.approx(float(tree.dataset["abscissa"].sel(where)), abs=1e-9)
    assert (tree.dataset["abscissa"].where(stable) < 0).sum() == stable.sum()
    curves = tree.slipmap.boundaries()
    assert curves and all(len(curve.x) == len(curve.y) > 1 for curve in curves)
    bounding = next(curve for curve in curves if curve.stable_side != 0 and curve.degree_of_stability == 0)
    at = dict(zip(bounding.names, (float(bounding.x[1]), float(bounding.y[1])), strict=True), **bounding.at)
    assert abs(slipmap.abscissa(**at)) < 1e-9


def test_a_picture_has_the_boundary_and_units(tmp_path: Path) -> None:
    tree = slipmap.run(SWEEPS / "decay_velocity.toml", progress=False)
    ax = tree.slipmap.plot("abscissa", mu_prime=-0.3) if len(tree.slipmap.axes) > 2 else tree.slipmap.plot("abscissa")
    assert ax.lines and ax.collections
    ax.figure.savefig(tmp_path / "map.png")
    assert (tmp_path / "map.png").stat().st_size > 10_000
    line = slipmap.run("[axes]\ntau = [1, 2, 3]\n[fixed]\nmu_prime = -0.3\n").slipmap.plot()
    assert len(line.lines) == 1
    assert tree.dataset.slipmap.plot("abscissa") is not None


def test_progress_is_told_and_an_exception_ends_the_run() -> None:
    sweep = {"axes": {"alpha_v": {"from": -1, "to": 0, "points": 300}, "tau": {"from": 0, "to": 9, "points": 300}},
             "fixed": {"mu_prime": -0.3}, "fields": ["abscissa"], "boundaries": False}
    told: list[tuple[int, int]] = []
    slipmap.run(sweep, progress=lambda done, of: told.append((done, of)))
    assert told[-1] == (90_000, 90_000) and told == sorted(told)

    def stop(done: int, of: int) -> None:
        raise LookupError("enough")

    slow = {**sweep, "axes": {"alpha_v": {"from": -1, "to": 0, "points": 2000}, "tau": {"from": 0, "to": 9, "points": 900}}}
    with pytest.raises(LookupError, match="enough"):
        slipmap.run(slow, progress=stop)


def test_eight_threads_at_once_get_the_same() -> None:
    sweep = {"axes": {"alpha_v": {"from": -1, "to": 0, "points": 60}, "tau": {"from": 0, "to": 9, "points": 80}},
             "fixed": {"mu_prime": -0.3}, "fields": ["abscissa"]}
    expected = slipmap.run(sweep)["abscissa"].values.tobytes()
    found: list[bytes] = []

    def work() -> None:
        found.append(slipmap.run(sweep, threads=2)["abscissa"].values.tobytes())

    threads = [threading.Thread(target=work) for _ in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert found == [expected] * 8


@pytest.mark.skipif(not hasattr(os, "fork"), reason="there is no fork")
def test_a_fork_computes_as_well() -> None:
    expected = slipmap.n_unstable(mu_prime=-0.3, alpha_v=-0.33, tau=np.linspace(0, 9, 10_000)).sum()
    child = os.fork()
    if child == 0:
        found = slipmap.n_unstable(mu_prime=-0.3, alpha_v=-0.33, tau=np.linspace(0, 9, 10_000)).sum()
        os._exit(0 if found == expected else 1)
    assert os.waitpid(child, 0)[1] == 0


def test_plans_tell_what_a_run_takes(program: Any) -> None:
    path = SWEEPS / "fig2a.toml"
    plan, theirs = slipmap.plan(path, timed=True), program("plan", str(path))
    assert (plan.cells, plan.bytes) == (theirs["cells"], theirs["bytes"])
    assert plan.hash == slipmap.run(path, progress=False).attrs["plan_hash"]
    assert plan.seconds is not None and plan.seconds > 0
    assert slipmap.plan(path).seconds is None
