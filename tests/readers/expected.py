"""What a map must hold: expected.json and the raw arrays beside it, as the test wrote them."""

import json
from pathlib import Path

import numpy as np

MAP = "map.h5"

_facts = json.loads(Path("expected.json").read_text(encoding="utf-8"))

TITLE = _facts["title"]
SWEEP = _facts["sweep"]
UNITS = _facts["units"]
PLANE = _facts["plane"]
PICKS = _facts["picks"]
SCALARS = _facts["scalars"]
FLAG_NAMES = [flag["name"] for flag in _facts["flags"]]
FLAG_MASKS = [flag["mask"] for flag in _facts["flags"]]

AXES = {axis["name"]: np.array(axis["values"]) for axis in _facts["axes"]}
AXIS_UNITS = {axis["name"]: axis["units"] for axis in _facts["axes"]}
DIMS = tuple(AXES)
SHAPE = tuple(len(values) for values in AXES.values())

CELLS = {
    "n_unstable": np.fromfile("n_unstable.u16", "<u2").reshape(SHAPE),
    "delay_margin": np.fromfile("delay_margin.f64", "<f8").reshape(SHAPE),
    "status": np.fromfile("status.u8", "u1").reshape(SHAPE),
}
FILL = {"n_unstable": 65535, "delay_margin": np.nan, "status": 255}

# The axes that tell the planes of the crossing curves apart.
OUTER = [name for name in DIMS if name not in (PLANE, "tau")]


def equal(what, found, expected):
    """Fails, naming `what`, unless the two are equal."""
    assert found == expected, f"{what}: found {found!r}, expected {expected!r}"


def same_cells(name, found):
    """Fails unless `found` holds the cells of the field `name`: counts exactly, margins to rounding."""
    expected = CELLS[name]
    equal(f"shape of {name}", tuple(found.shape), expected.shape)
    equal(f"type of {name}", found.dtype, expected.dtype)
    if expected.dtype.kind == "f":
        size = AXES["tau"][-1]
        wrong = ~np.isclose(found, expected, rtol=1e-12, atol=1e-12 * size)
    else:
        wrong = found != expected
    places = np.argwhere(wrong)
    assert len(places) == 0, (
        f"{name}: {len(places)} cells of {expected.size} differ, the first at {places[0]}: "
        f"found {found[tuple(places[0])]}, expected {expected[tuple(places[0])]}"
    )


def check_boundaries(column):
    """Checks the crossing curves; `column(name)` reads one column of the group, as numpy integers or floats."""
    count = column("vertex_count")
    p, tau, omega = column(PLANE), column("tau"), column("omega")
    assert len(count) > 0, "no curves: the sweep is meant to have some"
    assert count.min() >= 1, f"a curve has {count.min()} vertices"
    equal("sum of vertex_count", int(count.sum()), len(tau))
    equal("vertices of the plane's parameter", len(p), len(tau))
    equal("vertices with a frequency", len(omega), len(tau))
    for name in ["branch", "direction", "stable_side", "degree_of_stability", *OUTER]:
        equal(f"length of {name}", len(column(name)), len(count))
    for name in OUTER:
        strange = set(column(name)) - set(AXES[name])
        assert not strange, f"curves at values of {name} that are not on its axis: {strange}"
    assert set(column("direction")) <= {-1, 0, 1}
    assert set(column("stable_side")) <= {-1, 0, 1}
    assert (omega > 0).all() and np.isfinite(omega).all(), "a crossing frequency is not positive"
    for name, values in [(PLANE, p), ("tau", tau)]:
        low, high = AXES[name].min(), AXES[name].max()
        slack = 1e-9 * max(abs(low), abs(high))
        inside = (values >= low - slack) & (values <= high + slack)
        assert inside.all(), f"vertices beyond the axis {name}: {values[~inside]}"
    on_axis = vertices_on_the_axis(column, count, p, tau, omega)
    assert on_axis.max() < 1e-9, f"|D(i omega)| is {on_axis.max():.3g} at a vertex"


def vertices_on_the_axis(column, count, p, tau, omega):
    """|D(i omega)| at every vertex, from the letter's Eq. (3); for sweeps without a friction law."""
    given = {scalar["name"]: scalar["value"] for scalar in SCALARS}
    if "mu0" in given:
        return np.zeros(1)
    given[PLANE] = p
    for name in OUTER:
        given[name] = np.repeat(column(name), count)
    b, a_v, a_n = given["mu_prime"], given["alpha_v"], given["alpha_n"]
    feedback = 1 - np.exp(-1j * omega * tau)
    d = -(omega**2) + (b - a_v * feedback) * 1j * omega + 1 - (b * a_v + a_n) * feedback
    return np.abs(d)
