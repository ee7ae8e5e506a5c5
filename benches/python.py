"""Speeds of the Python module, each beside what it is compared with, in one process and on one thread: medians of 11.

    python benches/python.py [PROGRAM]

PROGRAM is the slipmap program, whose computing time of the same sweeps is told as well.
"""

from __future__ import annotations

import re
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

import slipmap

LETTER = {"mu_prime": -0.3, "alpha_v": -0.33}


def median(of: Callable[[], object], calls: int = 1) -> float:
    """The median of 11 runs, milliseconds a call."""
    times = []
    for _ in range(11):
        begun = time.perf_counter()
        for _ in range(calls):
            of()
        times.append((time.perf_counter() - begun) / calls)
    return 1e3 * statistics.median(times)


def tell(what: str, milliseconds: float, beside: str = "") -> None:
    print(f"{what:<62} {milliseconds:10.4f} ms  {beside}")


def of_program(program: str, sweep: dict) -> str:
    """The computing time that the program tells of a sweep, on one thread."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "sweep.toml"
        path.write_text(slipmap.plan(sweep).toml)
        said = subprocess.run([program, "run", str(path), "-o", f"{folder}/map.h5", "--threads", "1"],
                              capture_output=True, text=True, check=True).stdout
    found = re.search(r"in ([0-9.]+ m?s)", said)
    return f"slipmap run: {found.group(1) if found else said!r}, with the file"


def main() -> None:
    program = sys.argv[1] if len(sys.argv) > 1 else None
    delays = np.random.default_rng(1).uniform(0, 30, 10**6)
    tell("n_unstable, one number", median(lambda: slipmap.n_unstable(**LETTER, tau=4.15), 1000))
    tell("point, 16 roots and margins", median(lambda: slipmap.point(**LETTER, tau=4.15), 20))
    coulomb = slipmap.Friction("coulomb", mu0=0.5)
    found = slipmap.vc(friction=coulomb, alpha_n=-1.0, tau=0.5)
    assert found.method == "graze-slip"
    tell("vc of graze-slip", median(lambda: slipmap.vc(friction=coulomb, alpha_n=-1.0, tau=0.5), 20))
    tell("n_unstable, 10^6 delays in any order", median(lambda: slipmap.n_unstable(**LETTER, tau=delays, threads=1)))
    increasing = np.sort(delays)
    tell("the same in order", median(lambda: slipmap.n_unstable(**LETTER, tau=increasing, threads=1)))
    gains, line = np.linspace(-1, 0.2, 1000), np.linspace(0, 20, 1000)
    grid = {"axes": {"alpha_v": gains, "tau": line}, "fixed": {"mu_prime": -0.3}, "boundaries": False}
    run = median(lambda: slipmap.run(grid, threads=1, progress=False))
    for name, shape in (("inner", np.s_[:, None]), ("outer", np.s_[None, :])):
        tau = line[None, :] if name == "inner" else line[:, None]
        took = median(lambda s=shape, t=tau: slipmap.n_unstable(mu_prime=-0.3, alpha_v=gains[s], tau=t, threads=1))
        tell(f"n_unstable, 1000 x 1000 in order, delays {name}", took, f"run: {run:.2f} ms, {took / run:.2f} times")
    roots = {"fields": ["abscissa"], "boundaries": False, "fixed": {"mu_prime": -0.3},
             "axes": {"alpha_v": {"from": -1, "to": 0.2, "points": 602}, "tau": {"from": 0.01, "to": 20, "points": 801}}}
    counts = {"boundaries": False, "fixed": {"mu_prime": -0.3},
              "axes": {"alpha_v": {"from": -1, "to": 0.2, "points": 4000}, "tau": {"from": 0, "to": 20, "points": 5000}}}
    for what, sweep in (("run, 482 202 abscissae", roots), ("run, 2 10^7 counts", counts)):
        beside = of_program(program, sweep) if program else ""
        tell(what, median(lambda s=sweep: slipmap.run(s, threads=1, progress=False)), beside)


if __name__ == "__main__":
    main()
