"""Shapes, kinds and texts at the edges of what is taken."""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import slipmap

LAW = slipmap.Friction("weakening", mu0=0.5, v_s=0.5)


def test_empty_arrays_have_empty_answers() -> None:
    for shape in ((0,), (2, 0), (0, 3)):
        empty = np.zeros(shape)
        assert slipmap.n_unstable(mu_prime=empty, tau=empty).shape == shape
        assert slipmap.n_unstable(mu_prime=-0.3, tau=empty).shape == shape
        assert slipmap.evaluate(["abscissa"], mu_prime=empty, tau=1.0)["abscissa"].shape == shape


def test_what_is_masked_is_not_known() -> None:
    tau = np.ma.array([1.0, 4.15], mask=[True, False])
    assert slipmap.n_unstable(mu_prime=-0.3, alpha_v=-0.33, tau=tau).tolist() == [-1, 0]
    assert np.isnan(LAW(np.ma.array([0.1, 0.2], mask=[False, True]))).tolist() == [False, True]


def test_any_kind_of_numbers_is_taken() -> None:
    for kind in (np.float32, ">f8", np.int64, np.uint8, bool):
        tau = np.array([1, 1, 0]).astype(kind)
        expected = slipmap.n_unstable(mu_prime=-0.3, alpha_v=-0.33, tau=[1.0, 1.0, 0.0])
        assert np.array_equal(slipmap.n_unstable(mu_prime=-0.3, alpha_v=-0.33, tau=tau), expected)
    assert slipmap.n_unstable(mu_prime=-0.3, tau=[1.0]).shape == (1,)
    assert slipmap.point(mu_prime=np.float32(-0.5), tau=np.int64(1)).n_unstable == 2


def test_the_order_of_an_array_does_not_matter() -> None:
    coulomb = slipmap.Friction("coulomb", mu0=0.5)
    at = {"friction": coulomb, "v0": 0.1, "tau": 1.0}
    assert slipmap.n_unstable(mu_s=[0.6, 0.4], **at).tolist() == [0, -1]
    assert slipmap.n_unstable(mu_s=[0.4, 0.6], **at).tolist() == [-1, 0]
    law = slipmap.Friction.formula("a - b*v", a=0.5)
    one = slipmap.n_unstable(friction=law, v0=1.0, tau=1.0, b=[0.1, 0.6])
    assert one.tolist() == slipmap.n_unstable(friction=law, v0=1.0, tau=1.0, b=[0.6, 0.1]).tolist()[::-1]
    assert one.tolist() == [2, -1]


def test_numbers_of_laws_may_be_given_with_the_others() -> None:
    part = slipmap.Friction("weakening", mu0=0.5)
    at = {"v0": 0.35, "alpha_v": -0.33, "tau": 4.15}
    assert slipmap.point(friction=part, v_s=0.5, **at).abscissa == slipmap.point(friction=LAW, **at).abscissa
    assert slipmap.n_unstable(friction=part, v_s=[0.5, 0.4], **at).shape == (2,)
    del at["v0"]
    assert slipmap.vc(friction=part, v_s=0.5, **at).vc == slipmap.vc(friction=LAW, **at).vc
    formula = slipmap.Friction.formula("mu0/(1 + v/scale)", mu0=0.5)
    assert slipmap.point(friction=formula, v0=0.35, scale=0.5, tau=1.0).n_unstable == 2
    with pytest.raises(slipmap.InputError, match="at most mu_s"):
        slipmap.n_unstable(
            friction=slipmap.Friction("weakening", v_s=0.5), mu0=2.0, v0=0.1, tau=1.0)
    with pytest.raises(slipmap.InputError, match="tau = -1 is outside"):
        slipmap.n_unstable(friction=LAW, v0="5 mm/s", tau=-1.0, units="SI")


def test_critical_velocities_are_fields_without_v0() -> None:
    found = slipmap.evaluate("vc", friction=LAW, alpha_v=-0.33, tau=[1.0, 4.15])
    assert found["vc"][1] == pytest.approx(slipmap.vc(friction=LAW, alpha_v=-0.33, tau=4.15).vc, rel=1e-9)


def test_labels_are_kept_and_must_agree() -> None:
    tau = xr.DataArray([1.0, 4.15], dims="tau", coords={"tau": [1.0, 4.15]}, attrs={"comment": "of mine"})
    found = slipmap.n_unstable(mu_prime=-0.3, alpha_v=-0.33, tau=tau)
    assert found.attrs == {"long_name": found.attrs["long_name"], "units": "1"}
    other = xr.DataArray([0.0, -0.33], dims="tau", coords={"tau": [1.0, 5.0]})
    with pytest.raises(ValueError, match="tau"):
        slipmap.n_unstable(mu_prime=-0.3, alpha_v=other, tau=tau)
    with pytest.raises(slipmap.InputError, match="labels"):
        slipmap.n_unstable(mu_prime=-0.3, alpha_v=np.zeros(2), tau=tau)
    assert slipmap.point(mu_prime=-0.3, tau=tau[0]).n_unstable == 2


def test_texts_are_data_and_never_more(tmp_path: Path) -> None:
    with pytest.raises(slipmap.InputError):
        slipmap.vc(friction=LAW, tau=1.0, protocol='switch-on"\nphase = "worst')
    named = slipmap.System('title = "x [friction] y"\nP = "s^2 + 1"\nQ = "0.1"\n')
    assert slipmap.n_unstable(system=named, tau=1.0) in (0, 2)
    path = tmp_path / "crlf.toml"
    path.write_bytes(b"[axes]\r\ntau = [1, 2]\r\n[fixed]\r\nmu_prime = -0.3\r\n")
    assert slipmap.run(path).attrs["sweep"] == path.read_bytes().decode()
    path.write_bytes(b"title = \"\xff\"\n")
    with pytest.raises(slipmap.InputError, match="UTF-8"):
        slipmap.run(path)
    with pytest.raises(slipmap.InputError) as raised:
        slipmap.run("# a\u2028b\n[axes]\ntau = [1, 2]\n[fixed]\nmu_prim = -0.3\n")
    assert str(raised.value).splitlines()[1].endswith("mu_prim = -0.3")


def test_ends_of_ranges_are_told() -> None:
    for call in (
        lambda: slipmap.point(mu_prime=-0.3, tau=1.0, roots=300),
        lambda: slipmap.basin(friction=LAW, v0=0.3, tau=1.0, starts=-64),
        lambda: slipmap.stable_delays(mu_prime=-0.3, most=-1),
        lambda: slipmap.n_unstable(mu_prime=-0.3, tau=[1.0, 2.0], threads=5000),
        lambda: slipmap.run("[axes]\ntau = [1, 2]\n[fixed]\nmu_prime = -0.3\n", memory="-5MB"),
        lambda: slipmap.best(mu_prime=-0.3, tau=1.0),
        lambda: slipmap.vc(system=slipmap.System("turning"), tau=1.0),
    ):
        with pytest.raises(slipmap.InputError):
            call()
    case = '[friction]\nlaw = "weakening"\nmu0 = 0.5\nv_s = 0.5\n[fixed]\nv0 = 0.35\n'
    assert slipmap.simulate(f"# no [trace]\n{case}", until=3.0)["t"].values[-1] == 3.0
    with pytest.raises(slipmap.InputError, match="until"):
        slipmap.simulate(f"trace = {{ interval = 0.5 }}\n{case}", until=3.0)


def test_names_of_axes_are_checked() -> None:
    tree = slipmap.run("[axes]\nalpha_v = [-0.5, -0.2]\ntau = [1, 2, 3]\n[fixed]\nmu_prime = -0.3\n")
    for call in (tree.slipmap.boundaries, tree.slipmap.point, tree.slipmap.plot):
        with pytest.raises(slipmap.InputError, match="no axis"):
            call(bogus=1.0)
    with pytest.raises(slipmap.InputError, match="nothing is left"):
        tree.slipmap.plot(alpha_v=-0.5, tau=1.0)


def test_best_says_a_command_that_gives_the_same(program) -> None:  # type: ignore[no-untyped-def]
    found = slipmap.best(mu_prime=-0.3, ranges={"alpha_v": (-0.1, 0.0), "tau": (0.0, 2.0)}, robust=0.05)
    assert found.command is not None
    theirs = program(*found.command.split()[1:])
    assert theirs["best"]["alpha"] == found.best.alpha and theirs["best"]["tau"] == found.best.tau


def test_scattered_points_leave_other_threads_their_turn() -> None:
    import threading

    rng = np.random.default_rng(1)
    ticks = 0
    ended = threading.Event()

    def tick() -> None:
        nonlocal ticks
        while not ended.is_set():
            ticks += 1
            time.sleep(0.001)

    other = threading.Thread(target=tick)
    other.start()
    count = 200_000
    found = slipmap.n_unstable(mu_prime=rng.uniform(-0.9, 0.1, count), alpha_v=rng.uniform(-1, 0, count),
                               tau=rng.uniform(0, 9, count))
    ended.set()
    other.join()
    assert found.shape == (count,) and ticks > 3
