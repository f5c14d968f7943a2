"""The passage of a machine: when and where a path began and ended, and its length in the work."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from morfax.motion.arrays import Array
    from morfax.motion.motion import Path


@dataclass(slots=True)
class Passage:
    """What a path was, taken down piece by piece; times in s, places and length in mm."""

    start_s: float = 0.0
    end_s: float = 0.0
    start_mm: Array | None = None
    end_mm: Array | None = None
    length_mm: float = 0.0
    worked: bool = False  # the tool has been in the work
    _last_in_work_mm: Array | None = None

    @classmethod
    def of(cls, path: Path) -> Passage:
        """The passage of a whole path."""
        passage = cls()
        passage.add(path)
        return passage

    @property
    def is_empty(self) -> bool:
        """Whether nothing has been taken down."""
        return self.start_mm is None

    def add(self, piece: Path) -> None:
        """Take down the next piece."""
        if self.start_mm is None:
            self.start_s = float(piece.t_s[0])
            self.start_mm = piece.positions_mm[0]
        self.end_s = float(piece.t_s[-1])
        self.end_mm = piece.positions_mm[-1]
        runs = list(piece.runs())
        if self._last_in_work_mm is not None and piece.tool[0]:
            runs.append(np.array([self._last_in_work_mm, piece.xy_mm[0]]))
        for run in runs:
            self.length_mm += float(np.hypot(*np.diff(run, axis=0).T).sum())
        self.worked = self.worked or bool(piece.tool.any())
        self._last_in_work_mm = piece.xy_mm[-1] if piece.tool[-1] else None
