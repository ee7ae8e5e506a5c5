"""Stability charts of two systems of matrices by slipmap and by other means, with wrong cells counted.

    matrix_lobes.py [ROUNDS]

benches/peers/lobes.sh runs it after turning_lobes.py, at the head of which stands what it needs. There are two charts
of 200 x 200 cells:

- chain: seven unit masses with springs 1 and dampers 0.02 between them, fixed at one end; the last one is fed back on
  itself, -(g x + 0.002 x')(t - tau). One delayed signal, degree 14.
- cutting: a tool with two modes, x and y, cuts its own trace: m'' + damping + stiffness = -w A (m(t) - m(t - tau)), A
  of rank 2. Two delayed signals, and e^(-2 s tau) in its determinant.

A cell is stable where no root lies right of the axis. Truth is the winding number along the axis of a determinant that
is written out here, from no matrix, on a random sample of the cells: the same for all, of which slow methods get the
first ones. With SLIPMAP_CELLS=n no sample has more than n cells. A package that is not installed is left out. Each
runs ROUNDS times (2 unless given), and its least time counts: one thread, of the processor. That of slipmap is of the
whole program with a map of all 40,000 cells, start-up and writing included.
"""

import logging
import os
import sys
import tempfile
import warnings
from functools import partial
from importlib.util import find_spec
from pathlib import Path

import h5py
import numpy as np
from turning_lobes import NOT_COUNTED, POINTS, PROGRAM, child_times, digits, one_by_one, timed

MOST = int(os.environ.get("SLIPMAP_CELLS", 200))
MASSES = 7
DAMPER, RATE = 0.02, 0.002
MODES = ((0.02, 1.0), (0.03, 1.3))  # damping ratios and frequencies
CUT = np.array([[0.6, 0.5], [-0.3, 0.8]])
FINE = 0.2  # radians from point to point of a winding number


class Chain:
    """Seven masses: a cell is (g, tau)."""

    name, first = "chain", "g"
    ends = ((0.0, 0.01), (0.1, 20.0))
    bound = 4.0  # no root right of the axis has a greater modulus
    size = 2 * MASSES
    delays = 1

    @staticmethod
    def matrices(g):
        stiff = 2 * np.eye(MASSES) - np.eye(MASSES, k=1) - np.eye(MASSES, k=-1)
        stiff[-1, -1] = 1
        a0 = np.block([[np.zeros((MASSES, MASSES)), np.eye(MASSES)], [-stiff, -DAMPER * stiff]])
        a1 = np.zeros_like(a0)
        a1[-1, MASSES - 1], a1[-1, -1] = -g, -RATE
        return a0, a1

    @staticmethod
    def determinant(s, g, tau):
        """By the recursion over the masses."""
        spring = DAMPER * s + 1
        inner = s * s + 2 * spring
        before, last = np.ones_like(s), inner
        for _ in range(2, MASSES):
            before, last = last, inner * last - spring**2 * before
        return (s * s + spring + (g + RATE * s) * np.exp(-s * tau)) * last - spring**2 * before

    def text(self):
        a0, _ = self.matrices(0.0)
        pad = [0] * (self.size - 1)
        c = [0] * (MASSES - 1) + ['"-g"'] + [0] * (MASSES - 1) + [-RATE]
        b = [[x] for x in [*pad, 1]]
        return f"A0 = {a0.tolist()}\nfeedback = {{ B = {b}, C = [[{', '.join(map(str, c))}]] }}\n"


class Cutting:
    """Two modes of a tool: a cell is (w, tau)."""

    name, first = "cutting", "w"
    ends = ((0.0, 0.3), (1.0, 16.0))
    bound = 4.0
    size = 4
    delays = 2

    @staticmethod
    def matrices(w):
        stiff = np.diag([f * f for _, f in MODES]) + w * CUT
        damping = np.diag([2 * z * f for z, f in MODES])
        a0 = np.block([[np.zeros((2, 2)), np.eye(2)], [-stiff, -damping]])
        a1 = np.zeros_like(a0)
        a1[2:, :2] = w * CUT
        return a0, a1

    @staticmethod
    def determinant(s, w, tau):
        cut = w * (1 - np.exp(-s * tau))
        (one, other) = (s * s + 2 * z * f * s + f * f for z, f in MODES)
        return (one + cut * CUT[0, 0]) * (other + cut * CUT[1, 1]) - cut**2 * CUT[0, 1] * CUT[1, 0]

    def text(self):
        (d, (e, f)) = ([2 * z * f for z, f in MODES], [f * f for _, f in MODES])
        ((a, b), (c, g)) = CUT.tolist()
        return (
            f'A0 = [[0, 0, 1, 0], [0, 0, 0, 1], ["-{e} - {a}*w", "-{b}*w", {-d[0]}, 0], '
            f'["{-c}*w", "-{f} - {g}*w", 0, {-d[1]}]]\n'
            f'A1 = [[0, 0, 0, 0], [0, 0, 0, 0], ["{a}*w", "{b}*w", 0, 0], ["{c}*w", "{g}*w", 0, 0]]\n'
        )


def unstable_roots(system, p, tau):
    """The winding number on the axis, on a grid that is halved where the argument turns far."""
    at = np.linspace(0.0, 20 * system.bound, 4001)
    value = system.determinant(1j * at, p, tau)
    for _ in range(60):
        turns = np.angle(value[1:] / value[:-1])
        far = np.flatnonzero(np.abs(turns) > FINE)
        if not far.size:
            break
        between = 0.5 * (at[far] + at[far + 1])
        at = np.insert(at, far + 1, between)
        value = np.insert(value, far + 1, system.determinant(1j * between, p, tau))
    else:
        return None
    # On the arc D is all but its highest power.
    turned = turns.sum() - np.angle(value[-1] / (1j * at[-1]) ** system.size)
    count = system.size / 2 - turned / np.pi
    assert abs(count - round(count)) < 1e-6, (p, tau, count)
    return round(count)


def quasipolynomial(system, p):
    """Coefficients of the powers of s, a row for each power of e^(-s tau), by interpolation in that."""
    a0, a1 = system.matrices(p)
    points = np.exp(2j * np.pi * np.arange(system.delays + 1) / (system.delays + 1))
    rows = np.array([np.poly(a0 + z * a1)[::-1] for z in points])
    return np.real(np.fft.fft(rows, axis=0)) / len(points)


def qpmr(system):
    from qpmr import qpmr as peer

    def is_stable(p, tau):
        size = system.bound
        delays = tau * np.arange(system.delays + 1)
        roots, _ = peer(quasipolynomial(system, p), delays, region=(0, size, 0, size))
        return not np.any(roots.real > 0)

    return is_stable


def tdcpy(system):
    from tdcpy import RDDE, roots

    def is_stable(p, tau):
        found, _ = roots(RDDE(np.dstack(system.matrices(p)), np.array([0, tau])), r=0.0)
        return not np.any(np.real(found) > 0)

    return is_stable


def tdscontrol(system):
    from tdscontrol import roots, tds

    def is_stable(p, tau):
        found = roots(tds([np.asfortranarray(m) for m in system.matrices(p)], [0.0, tau]), 0.0)
        return not np.any(np.real(found) > 0)

    return is_stable


def collocation(n):
    """Eigenvalues at n + 1 Chebyshev points, in numpy."""
    points = np.cos(np.pi * np.arange(n + 1) / n)
    weights = np.r_[2, np.ones(n - 1), 2] * (-1.0) ** np.arange(n + 1)
    derivative = np.outer(weights, 1 / weights) / (points[:, None] - points + np.eye(n + 1))
    derivative -= np.diag(derivative.sum(axis=1))

    def of(system):
        def is_stable(p, tau):
            a0, a1 = system.matrices(p)
            whole = np.kron(derivative * (2 / tau), np.eye(system.size))
            whole[: system.size] = 0
            whole[: system.size, : system.size] = a0
            whole[: system.size, -system.size :] = a1
            return not np.any(np.linalg.eigvals(whole).real > 0)

        return is_stable

    return of


METHODS = (
    ("qpmr", "qpmr", qpmr, 8),
    ("tdcpy, right of 0", "tdcpy", tdcpy, 200),
    ("tdscontrol, right of 0", "tdscontrol", tdscontrol, 200),
    ("collocation, 16", "numpy", collocation(16), 200),
    ("collocation, 32", "numpy", collocation(32), 100),
)


def slipmap(system, folder):
    """Times of the program, and n_unstable of all cells."""
    file, sweep, output = (folder / name for name in ("system.toml", "sweep.toml", "map.h5"))
    file.write_text(f"{system.text()}[parameters]\n{system.first} = 0.1\n")
    p, tau = (f"{{ from = {a}, to = {b}, points = {POINTS} }}" for a, b in system.ends)
    sweep.write_text(
        f'system = "{file}"\nfields = ["n_unstable"]\nboundaries = false\n[axes]\n{system.first} = {p}\ntau = {tau}\n'
    )
    times = child_times([PROGRAM, "run", "--fresh", "--quiet", "--threads", "1", "-o", str(output), str(sweep)])
    with h5py.File(output) as found:
        return times, found["n_unstable"][:]


def show(system, name, said, truth, processor):
    silent = (said < 0).sum()
    wrong = ((said != truth) & (said >= 0)).sum()
    print(
        f"{system.name:<8} {name:<23} {len(said):>6} cells; {digits(1e6 * processor):>9} µs a cell; "
        f"{wrong:>4} wrong, {silent:>4} no answer",
        flush=True,
    )


def measure(system, rounds, random, folder):
    first, taus = (np.linspace(*ends, POINTS) for ends in system.ends)
    chosen = random.permutation(POINTS**2)[:MOST]
    cells = [(first[i // POINTS], taus[i % POINTS]) for i in chosen]
    walked = [unstable_roots(system, *cell) for cell in cells]
    known = [i for i, count in enumerate(walked) if count is not None]
    cells, counts = np.array(cells)[known], np.array([walked[i] for i in known])
    stable = (counts == 0).astype(int)
    told = f"{len(cells)} cells with winding numbers, {stable.sum()} stable, up to {counts.max()} unstable roots"
    print(f"\n{system.name}: {told}.")
    runs = [slipmap(system, folder) for _ in range(rounds)]
    found = runs[0][1].ravel()[chosen[known]].astype(int)
    said = np.where(found == NOT_COUNTED, -1, (found == 0).astype(int))
    show(system, "slipmap", said, stable, min(times[1] for times, _ in runs) / POINTS**2)
    differs = ((found != counts) & (found != NOT_COUNTED)).sum()
    print(f"{system.name:<8} slipmap's count of roots differs from the winding number in {differs} cells")
    for name, package, method, most in METHODS:
        if find_spec(package) is None:
            print(f"{system.name:<8} {name}: not installed")
            continue
        judge = partial(one_by_one(method(system)), cells[:most])
        tries = [timed(judge) for _ in range(rounds)]
        said = tries[0][1]
        show(system, name, said, stable[:most], min(times[1] for times, _ in tries) / len(said))


def main(rounds):
    warnings.simplefilter("ignore")
    logging.disable(logging.CRITICAL)
    np.seterr(all="ignore")
    random = np.random.default_rng(1)
    with tempfile.TemporaryDirectory() as folder:
        for system in (Chain(), Cutting()):
            measure(system, rounds, random, Path(folder))


if __name__ == "__main__":
    if len(sys.argv) > 2 or not all(a.isdigit() and int(a) for a in sys.argv[1:]):
        sys.exit("usage: matrix_lobes.py [ROUNDS]")
    main(int(sys.argv[1]) if len(sys.argv) == 2 else 2)
