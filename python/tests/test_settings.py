"""Answers about one setting: those of the program, and errors that say what to type."""

from __future__ import annotations

import math
import pickle
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import slipmap

LAW = slipmap.Friction("weakening", mu0=0.5, v_s=0.5)


def same(mine: Any, theirs: Any) -> bool:
    """Whether an answer is that of the program's JSON, which has null for what is not finite."""
    if theirs is None:
        return mine is None or (isinstance(mine, float) and not math.isfinite(mine))
    if isinstance(theirs, dict):
        return all(same(mine[name], part) for name, part in theirs.items())
    if isinstance(theirs, list):
        mine = list(mine)
        if mine and isinstance(mine[0], complex):
            mine = [[root.real, root.imag] for root in mine]
        return len(mine) == len(theirs) and all(map(same, mine, theirs))
    return bool(mine == theirs)


def check(mine: slipmap.Point | Any, theirs: dict[str, Any]) -> None:
    for name, part in theirs.items():
        if name not in ("schema_version", "inputs"):
            assert same(mine[name], part), (name, mine[name], part)


GAIN = st.floats(-2, 1).map(lambda v: round(v, 4))


@given(slope=GAIN, velocity=GAIN, load=GAIN, tau=st.floats(0, 9).map(lambda v: round(v, 4)))
@settings(max_examples=12, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_points_and_margins_are_those_of_the_program(
    program: Any, slope: float, velocity: float, load: float, tau: float
) -> None:
    at = {"mu_prime": slope, "alpha_v": velocity, "alpha_n": load, "tau": tau}
    flags = [f"--{name.replace('_', '-')}={value!r}" for name, value in at.items()]
    check(slipmap.point(**at, roots=5), program("point", *flags, "--roots=5"))
    check(slipmap.margins(**at, decay=0.01), program("margins", *flags, "--decay=0.01"))


def test_margins_of_systems_are_those_of_the_program(program: Any) -> None:
    gains = {"k_p": 1.5, "k_d": 1.0, "k_a": 0.2, "damping": 0.0, "stiffness": -1.0}
    sets = [f"--set={name}={value}" for name, value in gains.items()]
    at: dict[str, Any] = {**gains, "system": slipmap.System("pd")}
    found = slipmap.margins(**at, tau=0.2)
    check(found, program("margins", "--system=pd", *sets, "--tau=0.2"))
    assert found.gain_margin.lower == pytest.approx(1 / 1.5)
    with pytest.raises(slipmap.InputError, match="of stability alone"):
        slipmap.margins(**at, tau=0.2, decay=0.1)


@given(gain=GAIN, tau=st.floats(0.1, 6).map(lambda v: round(v, 4)))
@settings(max_examples=6, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_critical_velocities_are_those_of_the_program(program: Any, gain: float, tau: float) -> None:
    flags = ["--friction=coulomb", "--mu0=0.5", f"--alpha-n={gain!r}", f"--tau={tau!r}"]
    law = slipmap.Friction("coulomb", mu0=0.5)
    check(slipmap.vc(friction=law, alpha_n=gain, tau=tau), program("vc", *flags))
    switched = slipmap.vc(friction=law, alpha_n=gain, tau=tau, protocol="switch-on", phase=0.25)
    check(switched, program("vc", *flags, "--protocol=switch-on", "--phase=0.25"))


def test_best_settings_and_basins_are_those_of_the_program(program: Any) -> None:
    found = slipmap.best(mu_prime=-0.3, robust=0.05, ranges={"alpha_v": (-1, 0), "tau": (0, 8)})
    ranges = ["--alpha-from=-1", "--alpha-to=0", "--tau-from=0", "--tau-to=8"]
    check(found, program("best", "--mu-prime=-0.3", "--robust=0.05", *ranges))
    load = slipmap.best(friction=LAW, v0=0.2, search="alpha_n")
    check(load, program("best", "--friction=weakening", "--mu0=0.5", "--v-s=0.5", "--v0=0.2", "--control=load"))
    flags = ["--friction=weakening", "--mu0=0.5", "--v-s=0.5", "--v0=0.35", "--alpha-v=-0.33", "--tau=4.15"]
    share = slipmap.basin(friction=LAW, v0=0.35, alpha_v=-0.33, tau=4.15, starts=128)
    check(share, program("basin", *flags, "--starts=128"))


def test_commands_and_texts_say_the_same_again(program: Any, tmp_path: Path) -> None:
    found = slipmap.point(mu_prime=-0.3, alpha_v=-0.33, tau=4.15, roots=3)
    assert found.command is not None
    check(found, program(*found.command.split()[1:]))
    best = slipmap.best(mu_prime=-0.3, search="alpha_n")
    (tmp_path / "best.toml").write_text(best.toml)
    # The best setting is a triple root, which moves by the third root of rounding.
    again = program("point", "--setting", str(tmp_path / "best.toml"))
    assert again["abscissa"] == pytest.approx(best.best.abscissa, rel=1e-4)


def test_answers_are_frozen_and_show_themselves() -> None:
    found = slipmap.point(mu_prime=-0.3, alpha_v=-0.33, tau=4.15)
    with pytest.raises(AttributeError, match="frozen"):
        found.n_unstable = 1
    with pytest.raises(AttributeError, match="has no delay"):
        _ = found.delay
    assert found == pickle.loads(pickle.dumps(found)) and hash(found) == hash(pickle.loads(pickle.dumps(found)))
    assert "<table>" in found._repr_html_() and "n_unstable=0" in repr(found)
    assert found.roots.dtype == np.complex128 and found.roots[0].real <= found.certified_line
    assert found.essential_abscissa == -math.inf


def test_stable_delays_are_where_nothing_is_unstable() -> None:
    found = slipmap.stable_delays(mu_prime=-0.7, alpha_v=-0.31)
    middle = found.mean(axis=1)
    assert found.shape[1] == 2
    assert (slipmap.n_unstable(mu_prime=-0.7, alpha_v=-0.31, tau=middle) == 0).all()
    free = slipmap.stable_delays(mu_prime=0.3)
    assert free.tolist() == [[0.0, math.inf]]
    assert slipmap.stable_delays(mu_prime=0.3, alpha_v=0.9, most=1).shape == (1, 2)


def test_an_error_names_the_place_and_the_range() -> None:
    cases: list[tuple[dict[str, Any], str]] = [
        ({"mu_prim": -0.3, "tau": 1.0}, "did you mean `mu_prime`"),
        ({"mu_prime": -0.3, "tau": -1.0}, "tau = -1 is outside its range"),
        ({"mu_prime": -0.3, "tau": math.nan}, "tau"),
        ({"mu_prime": -0.3}, "tau is not given"),
        ({"friction": LAW, "v0": 0.1, "tau": 1.0, "mu_prime": -0.3}, "mu_prime"),
        ({"friction": LAW, "v0": 0.1, "tau": 1.0, "exponent": 2.0}, "exponent"),
        ({"friction": LAW, "system": slipmap.System("turning"), "tau": 1.0}, "both given"),
        ({"system": slipmap.System("turning"), "tau": 1.0, "mass": 1.0}, "no parameter"),
        ({"mu_prime": "-0.3 kg", "tau": 1.0}, "kg"),
    ]
    for at, says in cases:
        for function in (slipmap.point, slipmap.n_unstable, slipmap.abscissa):
            with pytest.raises(slipmap.InputError) as raised:
                function(**at)
            assert says in str(raised.value), str(raised.value)
            assert isinstance(raised.value, ValueError)
    with pytest.raises(slipmap.InputError) as raised:
        slipmap.point(mu_prime=-0.3, tau=-1.0)
    error = raised.value
    assert error.line == 3 and error.column == 7 and "^^" in str(error)
    assert error.text.splitlines()[error.line - 1][error.column - 1 :] == "-1.0"


def test_bad_arrays_and_bad_kinds_are_refused() -> None:
    with pytest.raises(slipmap.InputError, match="tau = -2 is outside its range"):
        slipmap.n_unstable(mu_prime=-0.3, tau=np.array([1.0, -2.0]))
    with pytest.raises(TypeError, match="tau"):
        slipmap.n_unstable(mu_prime=-0.3, tau=np.array(["a", "b"]))
    with pytest.raises(TypeError):
        slipmap.point(mu_prime=-0.3, tau=[1.0, 2.0])
    with pytest.raises(TypeError, match="Friction"):
        slipmap.point(friction="weakening", v0=0.1, tau=1.0)
    with pytest.raises(slipmap.InputError, match="did you mean"):
        slipmap.Friction("weakning", mu0=0.5, v_s=0.5)
    with pytest.raises(slipmap.InputError, match="threads = 0"):
        slipmap.run({"axes": {"tau": [1, 2]}, "fixed": {"mu_prime": -0.3}}, threads=0)
    with pytest.raises(slipmap.InputError, match="unknown field"):
        slipmap.evaluate("absciss", mu_prime=-0.3, tau=1.0)
    with pytest.raises(slipmap.InputError, match="no catalogue"):
        slipmap.catalogue("colours")
    with pytest.raises(slipmap.InputError, match="neither"):
        slipmap.basin(friction=LAW, v0=0.3, tau=1.0, over="moon")


def test_files_that_are_none_or_others_are_refused(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError):
        slipmap.run(tmp_path / "none.toml")
    with pytest.raises(FileNotFoundError):
        slipmap.open_map(tmp_path / "none.h5")
    with pytest.raises(FileNotFoundError):
        slipmap.run('[axes]\nv0 = [1]\ntau = [1]\n[friction]\nlaw = "table"\ntable = "none.csv"\n')
    (tmp_path / "text.h5").write_text("no map")
    with pytest.raises(OSError, match="HDF5"):
        slipmap.open_map(tmp_path / "text.h5")
    import xarray as xr

    xr.Dataset({"a": ("x", [1.0])}).to_netcdf(tmp_path / "other.h5", engine="h5netcdf")
    with pytest.raises(slipmap.InputError, match="no map"):
        slipmap.open_map(tmp_path / "other.h5")


def test_what_is_too_large_is_no_memory() -> None:
    large = {"fields": ["abscissa"], "fixed": {"mu_prime": -0.3},
             "axes": {"alpha_v": {"from": -1, "to": 0, "points": 1_000_000}, "tau": {"from": 0, "to": 9, "points": 1_000_000}}}
    with pytest.raises((MemoryError, slipmap.InputError)):
        slipmap.run(large)
    with pytest.raises(MemoryError):
        slipmap.run({"axes": {"tau": [1, 2]}, "fixed": {"mu_prime": -0.3}}, memory="1MB")
    long = slipmap.plan({"axes": {"tau": {"from": 0, "to": 9, "points": 10_000_000}}, "fixed": {"mu_prime": -0.3}})
    assert long.cells == 10_000_000


def test_measured_curves_are_read_and_fitted(tmp_path: Path) -> None:
    rng = np.random.default_rng(3)
    v = np.geomspace(0.01, 0.5, 60)
    mu = (0.3 + 0.2 * np.exp(-v / 0.05)) * (1 + 0.01 * rng.standard_normal(60))
    path = tmp_path / "belt.csv"
    rows = "".join(f"{a:.6f};{b:.6f}\n".replace(".", ",") for a, b in zip(v, mu, strict=True))
    path.write_text("v [m/s];mu\n" + rows, encoding="cp1252")
    raw = slipmap.Friction.from_csv(path)
    assert np.allclose(raw.v, v, atol=1e-6) and np.allclose(raw.mu, mu, atol=1e-6)
    fit = slipmap.Friction.fit(raw.v, raw.mu, v0=0.1)
    assert abs(fit.fitted["mu_prime"] + 0.541) < 4 * fit.fitted["mu_prime_error"]
    assert float(fit.slope(0.1)) == pytest.approx(fit.fitted["mu_prime"], rel=1e-6)
    robust = slipmap.best(friction=fit, v0=0.1, search="alpha_n", robust="fit")
    assert robust.robust is not None and robust.robust.worst_abscissa < 0
    assert slipmap.margins(friction=fit, v0=0.1, alpha_n=robust.robust.alpha, tau=robust.robust.tau).fit.share > 0.99
    with pytest.warns(UserWarning):
        slipmap.point(friction=raw, v0=0.6, tau=0.0)
    with pytest.raises(slipmap.InputError):
        slipmap.Friction.fit([0.1, 0.1], [0.3, 0.3], v0=0.1)


def test_catalogues_have_the_names_that_are_taken() -> None:
    parameters = {row["name"]: row for row in slipmap.catalogue("parameters")}
    assert parameters["tau"]["range"][0] == 0 and parameters["mass"]["default"] == 1.0
    assert {"n_unstable", "vc", "basin_share"} <= {row["name"] for row in slipmap.catalogue("fields")}
    for row in slipmap.catalogue("systems"):
        assert "tau" in slipmap.System(row["name"]).parameters


def test_an_interrupt_ends_long_work() -> None:
    import _thread
    import threading

    slow = {"fields": ["vc"], "friction": {"law": "weakening", "mu0": 0.5, "v_s": 0.5},
            "axes": {"alpha_v": {"from": -0.6, "to": -0.1, "points": 60}, "tau": {"from": 1, "to": 6, "points": 60}}}
    begun: list[float] = []

    def interrupt() -> None:
        begun.append(time.monotonic())
        _thread.interrupt_main()

    threading.Timer(0.5, interrupt).start()
    with pytest.raises(KeyboardInterrupt):
        slipmap.run(slow, progress=False)
    ended = time.monotonic() - begun[0]
    assert ended < 5.0, ended
    time.sleep(1.3)
    before = time.process_time()
    time.sleep(0.3)
    assert time.process_time() - before < 0.1
