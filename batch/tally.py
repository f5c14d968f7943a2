"""The tally of a batch: how many drawings are done, how many failed, how fast it goes, how long it will take.

Signals in: rows. Signals out: counts, drawings a minute, seconds that are left, and the share of the cores'
time in which drawings were followed.

Source: our own. Questions: drawings that were there already go by so fast that they do not count for the
speed.
"""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from morfax.batch.row import BatchRow


@dataclass
class Tally:
    """Counts of a batch of `total` drawings (None: not counted) on so many workers."""

    total: int | None = None
    workers: int = 1
    well: int = 0
    failed: int = 0
    kept: int = 0
    endings: dict[str, int] = field(default_factory=dict)
    busy_s: float = 0.0
    began_s: float = field(default_factory=time.monotonic)

    def count(self, row: BatchRow) -> None:
        """Take down how a drawing ended."""
        self.endings[row.ending] = self.endings.get(row.ending, 0) + 1
        if row.is_well:
            self.well += 1
        else:
            self.failed += 1
        if row.kept:
            self.kept += 1
        else:
            self.busy_s += row.seconds

    @property
    def ended(self) -> int:
        """How many drawings have ended."""
        return self.well + self.failed

    @property
    def passed_s(self) -> float:
        """How long the batch takes by now, s."""
        return time.monotonic() - self.began_s

    @property
    def per_minute(self) -> float:
        """Drawings a minute, of those that were not there already."""
        return 60 * (self.ended - self.kept) / max(self.passed_s, 1e-3)

    @property
    def left_s(self) -> float | None:
        """How long the rest will take, s; None if nobody can tell."""
        if self.total is None or not self.per_minute:
            return None
        return 60 * max(0, self.total - self.ended) / self.per_minute

    def figures(self) -> Mapping[str, Any]:
        """The tally as figures."""
        return {
            "drawings": self.ended,
            "done": self.well,
            "failed": self.failed,
            "there_already": self.kept or None,
            "endings": dict(self.endings) if self.failed else None,
            "duration_s": round(self.passed_s, 3),
            "drawings_per_minute": round(self.per_minute, 1),
            "busy_share": round(self.busy_s / max(self.passed_s * self.workers, 1e-3), 3),
        }
