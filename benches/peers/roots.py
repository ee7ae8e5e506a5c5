# /// script
# requires-python = ">=3.11"
# dependencies = ["numpy", "qpmr==0.1.0", "tdcpy==0.0.1"]
# ///
"""Rightmost roots at the same points by the Python module and by other people's, in one process and on one thread.

    python roots.py [POINTS]

needs the module `slipmap` beside the packages above. Prints a row for each: milliseconds a point, the largest error of the
spectral abscissa, and at how many points it is wrong by more than 1e-6 or none is found. What is right is found by collocation
with four times as many nodes, refined by Newton's method on the equation itself.
"""

import logging
import os
import sys
import time
import warnings

for name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ.setdefault(name, "1")

import numpy as np
import qpmr
import slipmap
import tdcpy

SLOPE = -0.3
NODES = 20


def points(count):
    """Gains of velocity and of load control, one of them 0, and delays."""
    rng = np.random.default_rng(1997)
    velocity = np.where(np.arange(count) % 2 == 0, rng.uniform(-1.5, 1.0, count), 0.0)
    load = np.where(np.arange(count) % 2 == 1, rng.uniform(-3.0, 1.0, count), 0.0)
    return np.column_stack([velocity, load, rng.uniform(0.05, 12.0, count)])


def matrices(velocity, load):
    """x' = A0 x + A1 x(t - tau) of the elongation and the velocity of the block."""
    now = np.array([[velocity, -1.0], [1.0 - load, -SLOPE]])
    then = np.array([[-velocity, 0.0], [load, 0.0]])
    return now, then


def equation(root, velocity, load, tau):
    """The characteristic function and its derivative."""
    late = np.exp(-root * tau)
    gain = SLOPE * velocity + load
    value = root * root + (SLOPE - velocity * (1 - late)) * root + 1 - gain * (1 - late)
    slope = 2 * root + SLOPE - velocity * (1 - late) - (velocity * root + gain) * tau * late
    return value, slope


def collocated(velocity, load, tau, nodes=NODES):
    """The rightmost root by collocation of the generator at Chebyshev nodes, with Newton's method."""
    at = np.cos(np.pi * np.arange(nodes + 1) / nodes)
    weight = np.r_[2.0, np.ones(nodes - 1), 2.0] * (-1.0) ** np.arange(nodes + 1)
    apart = at[:, None] - at[None, :] + np.eye(nodes + 1)
    derivative = np.outer(weight, 1 / weight) / apart
    derivative -= np.diag(derivative.sum(axis=1))
    generator = np.kron(derivative * 2 / tau, np.eye(2))
    now, then = matrices(velocity, load)
    generator[:2] = 0.0
    generator[:2, :2], generator[:2, -2:] = now, then
    roots = np.linalg.eigvals(generator)
    roots = roots[np.argsort(-roots.real)[:6]]
    for _ in range(3):
        value, slope = equation(roots, velocity, load, tau)
        step = value / slope
        roots = np.where(np.abs(step) < 0.1, roots - step, roots)
    return roots.real.max()


def by_qpmr(velocity, load, tau):
    gain = SLOPE * velocity + load
    coefficients = np.array([[1 - gain, SLOPE - velocity, 1.0], [gain, velocity, 0.0]])
    roots, _ = qpmr.qpmr(coefficients, np.array([0.0, tau]))
    return roots.real.max() if roots.size else np.nan


def by_tdcpy(velocity, load, tau):
    system = tdcpy.RDDE(np.dstack(matrices(velocity, load)), np.array([0.0, tau]))
    return tdcpy.spectral_abscissa(system, r=-1.0)


def by_slipmap(velocity, load, tau):
    return slipmap.abscissa(mu_prime=SLOPE, alpha_v=velocity, alpha_n=load, tau=tau)


def main(count):
    cells = points(count)
    right = np.array([collocated(*cell, nodes=4 * NODES) for cell in cells])
    print(f"{'':<44} {'ms a point':>10} {'error':>9} {'wrong':>6} of {count}")
    whole = slipmap.abscissa
    for what, call in (
        ("slipmap, one array of points", None),
        ("slipmap, a call for each", by_slipmap),
        (f"NumPy, collocation at {NODES} nodes and Newton", collocated),
        ("tdcpy 0.0.1, r = -1", by_tdcpy),
        ("qpmr 0.1.0", by_qpmr),
    ):
        begun = time.perf_counter()
        if call is None:
            found = whole(mu_prime=SLOPE, alpha_v=cells[:, 0], alpha_n=cells[:, 1], tau=cells[:, 2], threads=1)
        else:
            found = []
            for cell in cells:
                try:
                    found.append(float(np.real(call(*cell))))
                except Exception:
                    found.append(np.nan)
        took = 1e3 * (time.perf_counter() - begun) / count
        error = np.abs(np.asarray(found) - right)
        wrong = int((~(error <= 1e-6)).sum())
        print(f"{what:<44} {took:10.4f} {np.nanmax(error):9.1e} {wrong:6}")


if __name__ == "__main__":
    warnings.filterwarnings("ignore")
    logging.disable(logging.CRITICAL)
    np.seterr(all="ignore")
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 200)
