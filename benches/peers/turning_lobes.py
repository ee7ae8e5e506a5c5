# /// script
# requires-python = ">=3.11"
# dependencies = [
#   "cxroots==3.2.0",
#   "h5py",
#   "numpy",
#   "qpmr==0.1.0",
#   "scipy",
#   "tdcpy==0.0.1",
#   "tdscontrol==0.0.2",
# ]
# ///
"""Stability lobes of turning by slipmap and by other means, on the same cells, with wrong cells counted.

    turning_lobes.py [ROUNDS]

benches/peers/lobes.sh sets up what it needs and runs it, with one thread for numpy.

The system is that of sweeps/systems/turning.toml, D = s^2 + 2 zeta s + 1 + w - w exp(-s tau) with zeta = 0.04. There
are two charts of 200 x 200 cells: the lobes, and a strip of long delays. A cell is stable where no root of D lies right
of the axis. Every method says so for each cell, and truth is compared with it.

Truth is the closed form of the crossings of the axis, for this system alone. It is checked against winding numbers on
300 random cells of each chart, and no cell may lie so near to a crossing that rounding decides. Its time is shown too.

- slipmap: the program $SLIPMAP, else target/release/slipmap, with a sweep of n_unstable. One thread.
- qpmr, cxroots: roots, or their count, in a rectangle that is sure to hold all unstable ones. qpmr also with the region
  that it chooses by itself, which takes far longer.
- tdcpy, tdscontrol: roots right of the axis, and roots right of a line left of it, which misses fewer at long delays.
- collocation at N + 1 Chebyshev points, and semi-discretization of first order with k steps for the delay: written out
  here in numpy, for whole batches of cells. A cell is judged by its eigenvalues.

Slow methods get a random sample of the cells, whose size the table shows. Each runs ROUNDS times (2 unless given), in
turn, and its least time counts. Start-up is what an import of the package takes. For slipmap it is a map of four cells,
with its picture, and computing is what 50 more such charts take in a map of many, writing included. That is so little
that only the processor's time of it means something. The ratios are of processor times, as the machine may be busy: of
computing alone, and of one whole chart with start-up. With SLIPMAP_CELLS=n no sample has more than n cells.
"""

import cmath
import logging
import math
import os
import subprocess
import sys
import tempfile
import time
import warnings
from functools import partial
from importlib import import_module, metadata
from pathlib import Path

import h5py
import numpy as np
from scipy.linalg import expm

ZETA = 0.04
POINTS = 200
CHARTS = {  # from and to, of the width and of the delay
    "lobes": ((0.0, 0.6), (1.0, 16.0)),
    "long": ((0.08, 0.13), (16.0, 200.0)),
}
CHECKED = 300
MAPS = 8
MORE = 50  # charts
NOT_COUNTED = 65535  # in n_unstable
ROOT = Path(__file__).resolve().parents[2]
PROGRAM = os.environ.get("SLIPMAP", str(ROOT / "target/release/slipmap"))
MOST = int(os.environ.get("SLIPMAP_CELLS", POINTS**2))


# Truth


def crossings(w):
    """omega, the first delay, and 1 where pairs of roots go right as the delay grows, -1 where they go left.

    |P(i omega)|^2 = w^2 is x^2 - 2 b x + 1 + 2 w = 0 in x = omega^2.
    """
    b = 1 + w - 2 * ZETA**2
    inside = b * b - (1 + 2 * w)
    if inside <= 0:
        return []
    assert inside > 1e-6, "a width too near to where the lobes begin"
    right = b + math.sqrt(inside)
    found = []
    for x, way in ((right, 1), ((1 + 2 * w) / right, -1)):
        omega = math.sqrt(x)
        angle = -cmath.phase(complex(1 + w - x, 2 * ZETA * omega)) % (2 * math.pi)
        found.append((omega, angle / omega, way))
    return found


def unstable_roots(w, taus):
    """How many roots lie right of the axis at each delay, and how near a delay comes to a crossing, relatively."""
    count, nearest = np.zeros(len(taus), int), math.inf
    for omega, first, way in crossings(w):
        turns = (taus - first) * omega / (2 * math.pi)
        count += 2 * way * np.maximum(np.floor(turns).astype(int) + 1, 0)
        away = np.abs(turns - np.maximum(np.round(turns), 0)) * 2 * math.pi / omega / taus
        nearest = min(nearest, away.min())
    return count, nearest


def winding_number(w, tau):
    """The same count from the argument of D on the axis, in steps in which D cannot turn by more than half a radian."""

    def value(omega):
        return complex(1 + w - omega**2, 2 * ZETA * omega) - w * cmath.exp(-1j * omega * tau)

    # From here on the square is more than twice all the rest.
    end = 2 * (1 + 2 * w + 2 * ZETA)
    slope = 3 * end + 2 * ZETA + w * tau
    omega, here, angle = 0.0, value(0.0), 0.0
    while omega < end:
        omega += 0.45 * abs(here) / slope
        there = value(omega)
        angle += cmath.phase(there / here)
        here = there
    angle += cmath.phase(-1 / here)
    count = 1 - angle / math.pi
    assert abs(count - round(count)) < 1e-9
    return round(count)


# Ways to judge many cells. Each gives 1 for stable, 0 for unstable, -1 for no answer.


def one_by_one(is_stable):
    def judge(cells):
        said = np.full(len(cells), -1)
        for i, (w, tau) in enumerate(cells):
            try:
                said[i] = is_stable(float(w), float(tau))
            except Exception as error:
                logging.info("no answer: %s", error)
        return said

    return judge


def corner(w):
    """No root right of the axis has a greater modulus: there |s|^2 <= 2 zeta |s| + 1 + 2 w."""
    return 1.05 * (ZETA + math.sqrt(ZETA**2 + 1 + 2 * w))


def quasipolynomial(w, tau):
    return np.array([[1 + w, 2 * ZETA, 1], [-w, 0, 0]]), np.array([0, tau])


def matrices(w):
    return np.array([[0, 1], [-1 - w, -2 * ZETA]]), np.array([[0, 0], [w, 0.0]])


def qpmr(w, tau):
    from qpmr import qpmr

    size = corner(w)
    roots, _ = qpmr(*quasipolynomial(w, tau), region=(0, size, 0, size))
    return not np.any(roots.real > 0)


def qpmr_region(w, tau):
    from qpmr import qpmr

    roots, _ = qpmr(*quasipolynomial(w, tau))
    if not roots.size:
        raise ValueError("no roots at all")
    return not np.any(roots.real > 0)


def tdcpy(line):
    from tdcpy import RDDE, roots

    def is_stable(w, tau):
        found, _ = roots(RDDE(np.dstack(matrices(w)), np.array([0, tau])), r=line)
        return not np.any(np.real(found) > 0)

    return is_stable


def tdscontrol(line):
    from tdscontrol import roots, tds

    def is_stable(w, tau):
        found = roots(tds([np.asfortranarray(m) for m in matrices(w)], [0.0, tau]), line)
        return not np.any(np.real(found) > 0)

    return is_stable


def cxroots(w, tau):
    from cxroots import Rectangle

    size = corner(w)
    contour = Rectangle((0, size), (-size, size))
    return not contour.count_roots(
        lambda s: s * s + 2 * ZETA * s + 1 + w - w * np.exp(-s * tau),
        lambda s: 2 * s + 2 * ZETA + w * tau * np.exp(-s * tau),
    )


def batches(matrix, rows):
    """By eigenvalues: `matrix(w, tau)` gives matrices and tells which eigenvalues are unstable."""

    def judge(cells):
        said = np.full(len(cells), -1)
        size = max(1, 2_000_000 // rows**2)
        for i in range(0, len(cells), size):
            found, unstable = matrix(*cells[i : i + size].T)
            said[i : i + size] = ~unstable(np.linalg.eigvals(found)).any(axis=1)
        return said

    return judge


def collocation(n):
    """Rows: the position now, its velocity, and the position at the other Chebyshev points, down to one delay ago."""
    points = np.cos(np.pi * np.arange(n + 1) / n)
    weights = np.r_[2, np.ones(n - 1), 2] * (-1.0) ** np.arange(n + 1)
    derivative = np.outer(weights, 1 / weights) / (points[:, None] - points + np.eye(n + 1))
    derivative -= np.diag(derivative.sum(axis=1))

    def matrix(w, tau):
        a = np.zeros((len(w), n + 2, n + 2))
        a[:, 0, 1] = 1
        a[:, 1, 0], a[:, 1, 1], a[:, 1, -1] = -1 - w, -2 * ZETA, w
        past = derivative[1:] * (2 / tau)[:, None, None]
        a[:, 2:, 0], a[:, 2:, 2:] = past[:, :, 0], past[:, :, 1:]
        return a, lambda values: values.real > 0

    return batches(matrix, n + 2)


def semi_discretization(k):
    """Rows: position and velocity now, and k past positions. Between two of them the delayed one is a straight line."""

    def matrix(w, tau):
        h = tau / k
        # The state, the delayed position, and its slope times h.
        flow = np.zeros((len(w), 4, 4))
        flow[:, 0, 1] = h
        flow[:, 1, 0], flow[:, 1, 1], flow[:, 1, 2] = -(1 + w) * h, -2 * ZETA * h, w * h
        flow[:, 2, 3] = 1
        flow = expm(flow)
        a = np.zeros((len(w), k + 2, k + 2))
        a[:, :2, :2] = flow[:, :2, :2]
        a[:, :2, -1] = flow[:, :2, 2] - flow[:, :2, 3]
        a[:, :2, -2] += flow[:, :2, 3]
        a[:, 2, 0] = 1
        below = np.arange(3, k + 2)
        a[:, below, below - 1] = 1
        return a, lambda values: np.abs(values) > 1

    return batches(matrix, k + 2)


def methods(chart):
    """Name, package, the most cells, judge."""
    long = chart == "long"
    yield "qpmr", "qpmr", 40 if long else 400, one_by_one(qpmr)
    yield "qpmr, its own region", "qpmr", 8, one_by_one(qpmr_region)
    yield "tdcpy, right of 0", "tdcpy", 200 if long else 400, one_by_one(tdcpy(0.0))
    yield "tdcpy, right of -0.05", "tdcpy", 20 if long else 400, one_by_one(tdcpy(-0.05))
    yield "tdscontrol, right of 0", "tdscontrol", 4000, one_by_one(tdscontrol(0.0))
    yield "tdscontrol, right of -0.1", "tdscontrol", 400 if long else 4000, one_by_one(tdscontrol(-0.1))
    yield "cxroots", "cxroots", 400, one_by_one(cxroots)
    nodes = ((8, 40000), (12, 40000), (16, 40000), (32, 10000), (64, 2000), (96, 1000), (128, 1000))
    for n, most in nodes[: 7 if long else 5]:
        yield f"collocation, {n}", "numpy", most, collocation(n)
    for k, most in ((20, 10000), (40, 4000), (80, 1000), (160, 200), (320, 60))[: 5 if long else 4]:
        yield f"semi-discretization, {k}", "scipy.linalg", most, semi_discretization(k)


# Times: of the clock and of the processor, in seconds


def child_times(command):
    begin = time.perf_counter()
    child = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, status, used = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode:
        sys.exit(f"{' '.join(command)} ended with {child.returncode}")
    return np.array([time.perf_counter() - begin, used.ru_utime + used.ru_stime])


def timed(work):
    """Times, and what it gives."""
    begin = time.perf_counter(), time.process_time()
    found = work()
    return np.array([time.perf_counter() - begin[0], time.process_time() - begin[1]]), found


def slipmap(chart, folder, points=POINTS, copies=1):
    """Times of a map of so many charts, and n_unstable of the first. Damping ratios of copies are all but the same."""
    sweep, output = folder / "lobes.toml", folder / "lobes.h5"
    zeta = f"{{ from = {ZETA}, to = {ZETA * 1.00001}, points = {copies} }}" if copies > 1 else f"[{ZETA}]"
    width, tau = (f"{{ from = {a}, to = {b}, points = {points} }}" for a, b in CHARTS[chart])
    sweep.write_text(f"""system = "{ROOT / "sweeps/systems/turning.toml"}"
fields = ["n_unstable"]
boundaries = false
[axes]
zeta = {zeta}
width = {width}
tau = {tau}
""")
    command = [PROGRAM, "run", "--fresh", "--quiet", "--threads", "1", "-o", str(output), str(sweep)]
    times = child_times(command)
    with h5py.File(output) as file:
        return times, file["n_unstable"][0]


def digits(number):
    """Three of them."""
    return f"{float(f'{number:.3g}'):,.12g}"


def row(chart, name, cells, start, each, wrong, silent, ratio, whole):
    clock, processor = (digits(1e6 * time) for time in each)
    print(
        f"{chart:<5} {name:<25} {cells:>6} cells; start {start[0]:.2f} s ({start[1]:.2f}); "
        f"{clock:>9} µs a cell ({processor:>9}); {wrong:>5} wrong, {silent:>4} no answer; "
        f"{digits(ratio):>11} times slipmap's, {digits(whole):>9} with start-up",
        flush=True,
    )


def measure(chart, rounds, random, starts, folder):
    widths, taus = (np.linspace(*ends, POINTS) for ends in CHARTS[chart])
    exact = np.full(2, np.inf)
    for _ in range(5):
        times, lines = timed(lambda: [unstable_roots(w, taus) for w in widths])
        exact = np.minimum(exact, times / POINTS**2)
    counts = np.array([count for count, _ in lines])
    nearest = min(away for _, away in lines)
    assert nearest > 1e-10
    cells = np.array([(w, tau) for w in widths for tau in taus])
    stable = (counts == 0).astype(int).ravel()
    checked = random.choice(len(cells), CHECKED, replace=False)
    differ = sum(winding_number(*cells[i]) != counts.ravel()[i] for i in checked)
    print(
        f"\n{chart}: w from {widths[0]:g} to {widths[-1]:g}, tau from {taus[0]:g} to {taus[-1]:g}; "
        f"{len(cells)} cells, {stable.sum()} stable, up to {counts.max()} unstable roots.\n"
        f"Of {CHECKED} winding numbers {differ} differs from truth. "
        f"The nearest crossing is {nearest:.1e} of the delay away."
    )

    chosen = list(methods(chart))
    samples = [random.permutation(len(cells))[: min(most, MOST)] for _, _, most, _ in chosen]
    kinds = {"few": {"points": 2}, "one": {}, "some": {"copies": MORE + 1}, "many": {"copies": 2 * MORE + 1}}
    maps, best, said = {kind: [] for kind in kinds}, {}, {}
    for _ in range(rounds):
        for _ in range(MAPS):
            for kind, options in kinds.items():
                times, found = slipmap(chart, folder, **options)
                maps[kind].append(times)
        for (name, _, _, judge), sample in zip(chosen, samples, strict=True):
            times, said[name] = timed(partial(judge, cells[sample]))
            best[name] = np.minimum(best.get(name, np.inf), times / len(sample))
    least = {kind: np.min(times, axis=0) for kind, times in maps.items()}
    own = (least["many"] - least["some"]) / MORE / len(cells)
    _, found = slipmap(chart, folder)

    def show(name, answer, truth, start, each, whole):
        silent = (answer < 0).sum()
        wrong = (answer != truth).sum() - silent
        row(chart, name, len(answer), start, each, wrong, silent, each[1] / own[1], whole[1] / least["one"][1])

    def show_peer(name, package, answer, truth, each):
        show(name, answer, truth, starts[package], each, starts[package] + each * len(cells))

    answer = np.where(found == NOT_COUNTED, -1, found == 0).ravel()
    show("slipmap", answer, stable, least["few"], own, least["one"])
    print(f"{chart:<5} slipmap's count of roots differs from truth in {(found != counts).sum()} cells")
    show_peer("truth, in numpy", "numpy", stable, stable, exact)
    for (name, package, _, _), sample in zip(chosen, samples, strict=True):
        show_peer(name, package, said[name], stable[sample], best[name])


def main(rounds):
    warnings.simplefilter("ignore")
    logging.disable(logging.CRITICAL)
    np.seterr(all="ignore")
    names = ("numpy", "scipy", "qpmr", "tdcpy", "tdscontrol", "cxroots")
    print("slipmap beside " + ", ".join(f"{name} {metadata.version(name)}" for name in names))
    print("Times of the clock, in parentheses of the processor; one thread; the best of the rounds.")
    starts = {}
    for package in ("numpy", "scipy.linalg", "qpmr", "tdcpy", "tdscontrol", "cxroots"):
        import_module(package)
        command = [sys.executable, "-c", f"import {package}"]
        starts[package] = np.min([child_times(command) for _ in range(5)], axis=0)
    random = np.random.default_rng(1)
    with tempfile.TemporaryDirectory() as folder:
        for chart in CHARTS:
            measure(chart, rounds, random, starts, Path(folder))


if __name__ == "__main__":
    if len(sys.argv) > 2 or not all(a.isdigit() and int(a) for a in sys.argv[1:]):
        sys.exit("usage: turning_lobes.py [ROUNDS]")
    main(int(sys.argv[1]) if len(sys.argv) == 2 else 2)
