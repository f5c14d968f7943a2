"""Whole pieces of work without a terminal: one job per verb, from plain values to results.

A job is a frozen dataclass that can be pickled; `job.run(listener, panel)` works, tells the Listener what it
does, asks the Panel, and returns a result or raises a fault. The faces (console, later a page and batches)
ask this room; it asks the machines below: tracer, recorder, player, motion. A face draws the pictures of a
result with `morfax.reports`.
"""

from __future__ import annotations

import importlib
from typing import Any

_DOORS = {
    "LinesJob": "lines",
    "TraceJob": "trace",
    "CorrectJob": "correct",
    "RunJob": "run",
    "RecordJob": "record",
    "PlayJob": "play",
    "CompareJob": "compare",
    "SystemsJob": "systems",
    "InspectJob": "inspect",
    "MendJob": "mend",
    "AgeJob": "age",
    "DevicesJob": "devices",
    "Listener": "listener",
}


def __getattr__(name: str) -> Any:
    """Import a job when it is first asked for."""
    if name not in _DOORS:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(importlib.import_module(f"{__name__}.{_DOORS[name]}"), name)
