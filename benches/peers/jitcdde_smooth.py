# /// script
# requires-python = ">=3.11"
# dependencies = [
#   "jitcdde==1.8.3",
#   "numpy",
#   "scipy",
#   "setuptools",
#   "sympy",
# ]
# ///
"""JiTCDDE on the smooth problem of slipmap's benches/motion.rs.

    jitcdde_smooth.py REFERENCE COMPILED

prints one line for every tolerance, `program problem setting us-per-unit error-of-a`. REFERENCE is the folder that
`cargo bench --bench motion -- --write-reference FOLDER` wrote; COMPILED is the file of the compiled equations, made
where it is missing. JiTCDDE does not locate events, so the hybrid problems are beyond it. Compiling is not timed.
Times are the processor's: on a busy machine a long run is set aside more often than a short one.
"""

import os
import sys
import time
import warnings
from statistics import median

import numpy as np
from jitcdde import jitcdde, t, y

MU0, V_S = 0.5, 0.5
V0, ALPHA_V, TAU = 0.35, -0.33, 4.15
START = [MU0 / (1 + V0 / V_S), V0 + 0.05]
END, EVERY = 200.0, 0.1
RUNS = 3

# a is y(0), the velocity y(1).
EQUATIONS = [
    V0 + ALPHA_V * (y(0) - y(0, t - TAU)) - y(1),
    y(0) - MU0 / (1 + y(1) / V_S),
]


def integrate(compiled, tolerance, times):
    """Seconds of the processor, and a at those of `times` that lie beyond the first kinks."""
    problem = jitcdde(EQUATIONS, max_delay=TAU, verbose=False, module_location=compiled)
    problem.constant_past(START, time=0.0)
    problem.set_integration_parameters(
        rtol=tolerance, atol=tolerance, first_step=0.01, max_step=10.0, min_step=1e-11
    )
    begin = time.thread_time()
    problem.step_on_discontinuities()
    later = [s for s in times if s > problem.t]
    values = [problem.integrate(s)[0] for s in later]
    return time.thread_time() - begin, later, values


def main(reference, compiled):
    expected = np.loadtxt(os.path.join(reference, "smooth.csv"), delimiter=",")[:, 0]
    if not os.path.exists(compiled):
        jitcdde(EQUATIONS, max_delay=TAU, verbose=False).save_compiled(compiled)
    grid = EVERY * np.arange(len(expected))
    for exponent in range(6, 12):
        tolerance = 10.0**-exponent
        _, later, values = integrate(compiled, tolerance, grid)
        error = np.abs(np.array(values) - expected[-len(later) :]).max()
        seconds = median(integrate(compiled, tolerance, [END])[0] for _ in range(RUNS))
        print(f"jitcdde smooth 1e-{exponent} {seconds * 1e6 / END:.5f} {error:.3e}")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit("usage: jitcdde_smooth.py REFERENCE COMPILED")
    warnings.filterwarnings("ignore")
    main(*sys.argv[1:])
