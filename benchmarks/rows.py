"""What all benchmarks share: the rows of a table, the best time of several rounds in turn, and the table."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

ROUNDS = 3


@dataclass(frozen=True, slots=True)
class Row:
    """A row of the table: what was measured, its value and unit, and its ratio to something else."""

    what: str
    value: float
    unit: str
    ratio: float | None = None
    to_what: str = ""


def best_s(
    tasks: dict[str, Callable[[], object]], clock: Callable[[], float] = time.perf_counter
) -> dict[str, float]:
    """Shortest time of each task, s; tasks take turns, so that other load hits all alike."""
    times: dict[str, list[float]] = {name: [] for name in tasks}
    for _ in range(ROUNDS):
        for name, task in tasks.items():
            begun = clock()
            task()
            times[name].append(clock() - begun)
    return {name: min(taken) for name, taken in times.items()}


def tell(title: str, rows: list[Row]) -> None:
    """Print a table."""
    print(title)
    for row in rows:
        ratio = "" if row.ratio is None else f"{row.ratio:8.2f} x {row.to_what}"
        digits = 1 if abs(row.value) >= 10 else 2
        value = f"{row.value:10.{digits}f}"
        print(f"  {row.what:46s}{value} {row.unit:18s}{ratio}".rstrip())
