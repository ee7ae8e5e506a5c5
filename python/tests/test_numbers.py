"""Numbers that broadcast: equal to those of points, tables and maps."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr
from hypothesis import given, settings
from hypothesis import strategies as st

import slipmap
from conftest import reference

FINITE = st.floats(-3, 3, allow_nan=False).map(lambda v: round(v, 3))
DELAYS = st.floats(0, 20, allow_nan=False).map(lambda v: round(v, 3))


@given(st.lists(st.tuples(FINITE, DELAYS), min_size=1, max_size=20), FINITE)
@settings(max_examples=60, deadline=None)
def test_any_points_are_those_of_single_calls(points: list[tuple[float, float]], slope: float) -> None:
    alpha, tau = np.array(points).T
    found = slipmap.n_unstable(mu_prime=slope, alpha_v=alpha, tau=tau)
    single = [slipmap.n_unstable(mu_prime=slope, alpha_v=a, tau=t) for a, t in points]
    assert found.dtype == np.int64 and found.tolist() == single
    outer = slipmap.n_unstable(mu_prime=slope, alpha_v=alpha[:, None], tau=tau[None, :])
    assert np.diag(outer).tolist() == single
    assert np.array_equal(outer.T, slipmap.n_unstable(mu_prime=slope, alpha_v=alpha[None, :], tau=tau[:, None]))


@given(st.lists(DELAYS, min_size=1, max_size=30), FINITE, FINITE)
@settings(max_examples=60, deadline=None)
def test_evaluate_agrees_with_counts_and_abscissae(delays: list[float], gain: float, slope: float) -> None:
    at = {"mu_prime": slope, "alpha_v": gain, "tau": np.array(delays)}
    found = slipmap.evaluate(["n_unstable", "abscissa", "delay_margin"], **at)
    assert np.array_equal(found["n_unstable"], slipmap.n_unstable(**at))
    known = np.isfinite(found["abscissa"]) & ((found["status"] & 1) != 0)
    assert ((found["abscissa"] > 1e-9) <= (found["n_unstable"] > 0))[known].all()
    assert ((found["abscissa"] < -1e-9) <= (found["n_unstable"] == 0))[known].all()


def test_shapes_are_numpys() -> None:
    at = {"mu_prime": -0.3, "alpha_v": np.zeros((2, 1, 3)), "tau": np.ones((4, 1))}
    assert slipmap.n_unstable(**at).shape == (2, 4, 3)
    assert slipmap.n_unstable(mu_prime=-0.3, tau=[]).shape == (0,)
    assert isinstance(slipmap.n_unstable(mu_prime=-0.3, tau=np.float64(1.0)), int)
    assert isinstance(slipmap.abscissa(mu_prime=-0.3, tau=1), float)
    with pytest.raises(ValueError, match="broadcast"):
        slipmap.n_unstable(mu_prime=np.zeros(2), tau=np.zeros(3))
    order = np.asfortranarray(np.random.default_rng(1).uniform(0, 9, (5, 7)))
    assert np.array_equal(slipmap.n_unstable(mu_prime=-0.3, alpha_v=-0.3, tau=order),
                          slipmap.n_unstable(mu_prime=-0.3, alpha_v=-0.3, tau=order.copy()))
    back = order[::-1, ::2]
    # Roots are followed from delay to delay.
    assert np.allclose(slipmap.abscissa(mu_prime=-0.3, alpha_v=-0.3, tau=back),
                       slipmap.abscissa(mu_prime=-0.3, alpha_v=-0.3, tau=order)[::-1, ::2], rtol=1e-9, atol=1e-12)


def test_nan_in_an_array_has_no_answer_there() -> None:
    tau = np.array([1.0, np.nan, 4.15])
    assert slipmap.n_unstable(mu_prime=-0.3, alpha_v=-0.33, tau=tau).tolist() == [2, -1, 0]
    found = slipmap.evaluate(["abscissa", "n_unstable"], mu_prime=-0.3, alpha_v=-0.33, tau=tau)
    assert np.isnan(found["abscissa"]).tolist() == [False, True, False]
    assert found["n_unstable"].tolist() == [2, 65535, 0] and found["status"][1] == 255
    slopes = np.array([-0.3, np.nan])
    assert slipmap.n_unstable(mu_prime=slopes[:, None], alpha_v=-0.33, tau=tau).tolist() == [[2, -1, 0], [-1, -1, -1]]
    assert slipmap.n_unstable(mu_prime=np.full(3, np.nan), tau=1.0).tolist() == [-1, -1, -1]
    assert np.isnan(slipmap.abscissa(mu_prime=slopes, tau=1.0)).tolist() == [False, True]


def test_labelled_arrays_stay_labelled() -> None:
    tau = xr.DataArray([1.0, 4.15], dims="tau", coords={"tau": [1.0, 4.15]})
    gain = xr.DataArray([0.0, -0.33], dims="gain")
    found = slipmap.abscissa(mu_prime=-0.3, alpha_v=gain, tau=tau, units="SI")
    assert set(found.dims) == {"gain", "tau"} and found.attrs["units"] == "s-1"
    assert float(found.isel(gain=1).sel(tau=4.15)) == slipmap.abscissa(mu_prime=-0.3, alpha_v=-0.33, tau=4.15)


def test_counts_are_those_of_tables_of_other_programs() -> None:
    rows = list(reference("linear_points.csv"))
    names = ("mu_prime", "alpha_v", "alpha_n", "tau")
    at = {name: np.array([float(row[name]) for row in rows]) for name in names}
    assert np.array_equal(slipmap.n_unstable(**at), [int(row["n_unstable"]) for row in rows])


def test_systems_and_laws_take_their_own_parameters() -> None:
    lathe = slipmap.System(P=[1, 0.04, 1.2], Q=[-0.2])
    counts = slipmap.n_unstable(system=lathe, tau=np.array([0.5, 3.0, 40.0]))
    lam = np.roots([1, 0.04, 1.0])
    assert slipmap.n_unstable(system=lathe, tau=0.0) == int((lam.real > 0).sum())
    assert counts.shape == (3,) and (counts >= 0).all()
    law = slipmap.Friction.formula("mu0 + drop*exp(-v/v_s)", mu0=0.3, drop=0.2, v_s=0.05)
    by_slope = slipmap.n_unstable(mu_prime=float(law.slope(0.1)), mu_k=float(law(0.1)), alpha_v=-0.3, tau=[1.0, 4.0])
    assert np.array_equal(slipmap.n_unstable(friction=law, v0=0.1, alpha_v=-0.3, tau=[1.0, 4.0]), by_slope)
    varied = slipmap.n_unstable(friction=law, v0=np.array([0.05, 0.1]), alpha_v=-0.3, tau=4.0)
    assert varied[1] == slipmap.n_unstable(friction=law, v0=0.1, alpha_v=-0.3, tau=4.0)


def test_numbers_with_units_are_those_without() -> None:
    with_units = slipmap.abscissa(mu_prime="-0.3 s/m", mass="2000 g", stiffness="2 N/m", tau="1000 ms")
    assert with_units == slipmap.abscissa(mu_prime=-0.3, mass=2.0, stiffness=2.0, tau=1.0)
