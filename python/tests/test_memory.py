"""Memory after many calls and many errors; as many as asked for by scripts/soak.sh."""

from __future__ import annotations

import gc
import os
import sys

import numpy as np
import pytest

import slipmap

CALLS = int(os.environ.get("SLIPMAP_CALLS", "3000"))
# What the allocator and the interpreter keep, whatever the number of calls.
KEPT = 2 << 20


def resident() -> int:
    """Bytes of memory of this process."""
    gc.collect()
    with open("/proc/self/statm", encoding="ascii") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def calls(count: int) -> None:
    line = np.linspace(0, 9, 50)
    for number in range(count):
        slipmap.n_unstable(mu_prime=-0.3, alpha_v=-0.33, tau=4.15 + 1e-6 * number)
        if number % 10 == 0:
            slipmap.abscissa(mu_prime=-0.3, alpha_v=-0.33, tau=line)
        if number % 100 == 0:
            slipmap.point(mu_prime=-0.3, alpha_v=-0.33, tau=1.0, roots=2)


def errors(count: int) -> None:
    for _ in range(count):
        with pytest.raises(slipmap.InputError):
            slipmap.n_unstable(mu_prim=-0.3, tau=1.0)


@pytest.mark.skipif(sys.platform != "linux", reason="memory is told by Linux")
def test_nothing_is_kept() -> None:
    calls(500)
    errors(200)
    before = resident()
    calls(CALLS)
    errors(CALLS // 3)
    assert resident() - before < KEPT
