"""Exact stability maps of delayed-feedback control of dry friction.

The words are those of sweep files, flags and maps: ``slipmap.catalogue("parameters")`` lists them.
"""

from . import _accessor
from ._answers import Basin, Best, CriticalVelocity, Margins, Plan, Point
from ._catalogue import catalogue
from ._core import __version__
from ._error import InputError
from ._nouns import Friction, System
from ._numbers import abscissa, evaluate, n_unstable
from ._settings import basin, best, margins, point, stable_delays, vc
from ._sweeps import open_map, plan, run, simulate

__all__ = [
    "Basin",
    "Best",
    "CriticalVelocity",
    "Friction",
    "InputError",
    "Margins",
    "Plan",
    "Point",
    "System",
    "abscissa",
    "basin",
    "best",
    "catalogue",
    "evaluate",
    "margins",
    "n_unstable",
    "open_map",
    "plan",
    "point",
    "run",
    "simulate",
    "stable_delays",
    "vc",
]
__version__ = __version__

_accessor.register()
