"""Chart recorder: what a pen on each servo would draw over a run, demand, actual position and limit.

Signals in: the rows that a monitor has watched, in mm at any rate. Signals out: for each stretch of `every_s`
and each axis the row that came nearest to its limit; with 0 every row.

    error │      ╭──╮ limit                 rows     · · · ● · · · · ● · ·      one is kept of each stretch,
          │ ╭────╯  ╰───╮                   stretch  └──────┘└──────┘           the nearest to its limit
          └─┴───────────┴──► t

Source: patent ES 414458, figure 2 (error and limit over the speed), here over the run.
Questions: none; a chart holds 10 ms of a run in 24 bytes for each axis, so an hour takes 26 MB.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from morfax.motion.arrays import NOT_ZERO, Array

DEMAND, ACTUAL, LIMIT = 0, 1, 2


class Chart:
    """The rows of a run that came nearest to their limits."""

    def __init__(self, every_s: float = 0.01) -> None:
        self.every_s = every_s
        self.axes: tuple[str, ...] = ()
        self._times_s: list[Array] = []
        self._rows: list[Array] = []  # (n, axes, 3)

    def begin(self, axes: Sequence[str]) -> None:
        """Begin a new sheet, for these axes."""
        self.axes, self._times_s, self._rows = tuple(axes), [], []

    def note(
        self,
        first_row: int,
        rate_hz: float,
        demand_mm: Array,
        actual_mm: Array,
        limit_mm: Array,
    ) -> None:
        """Take a block (n, axes) that begins with a row of the run."""
        step = max(1, round(self.every_s * rate_hz))
        starts = np.arange(0, len(demand_mm), step)
        if not len(starts):
            return
        spent = np.full((len(starts) * step, len(self.axes)), -1.0)
        spent[: len(demand_mm)] = np.abs(demand_mm - actual_mm) / np.maximum(limit_mm, NOT_ZERO)
        worst = starts[:, None] + spent.reshape(len(starts), step, -1).argmax(axis=1)
        rows = np.stack([demand_mm, actual_mm, limit_mm], axis=-1)
        self._rows.append(np.take_along_axis(rows, worst[:, :, None], axis=0))
        self._times_s.append((first_row + starts) / rate_hz)

    @property
    def t_s(self) -> Array:
        """Beginning of each stretch, s."""
        return np.concatenate(self._times_s) if self._times_s else np.zeros(0)

    @property
    def demand_mm(self) -> Array:
        """Demands (n, axes), mm."""
        return self._column(DEMAND)

    @property
    def actual_mm(self) -> Array:
        """Actual positions (n, axes), mm."""
        return self._column(ACTUAL)

    @property
    def error_mm(self) -> Array:
        """Following errors (n, axes), mm."""
        return self.demand_mm - self.actual_mm

    @property
    def limit_mm(self) -> Array:
        """Limits (n, axes), mm."""
        return self._column(LIMIT)

    def _column(self, which: int) -> Array:
        """One of the three."""
        return (
            np.concatenate(self._rows)[:, :, which]
            if self._rows
            else np.zeros((0, len(self.axes)))
        )
