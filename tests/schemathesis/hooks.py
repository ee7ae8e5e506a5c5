"""Bodies in TOML for schemathesis: what it draws, and at times a sweep that can be computed."""

import random
from pathlib import Path

import schemathesis

SWEEP = (Path(__file__).parent / "sweep.toml").read_text()


@schemathesis.serializer("application/toml")
def toml(_, value):
    if random.random() < 0.4:
        value = SWEEP.replace("points = 41", f"points = {random.randint(2, 60)}")
    return str(value).encode("utf-8", "surrogatepass")
