"""The result of one system beside the others, and the systems by name."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from morfax.jobs.figures import Figures
    from morfax.jobs.readings.comparison import Comparison
    from morfax.jobs.readings.following import Speeds
    from morfax.motion.faults import Fault
    from morfax.motion.motion import Path
    from morfax.player.monitor.chart import Chart

NAMES = {
    "wav": "Morfax 1969",
    "steps": "Superior Electric 1975",
    "cubic": "SEA 1957",
    "ngc": "Pratt & Whitney 1967",
}


@dataclass(frozen=True, slots=True)
class SystemResult:
    """One system: its figures, and its path with comparisons or the fault that kept it from running."""

    suffix: str
    figures: Figures
    path: Path | None = None
    from_ink: Comparison | None = None
    from_traced: Comparison | None = None
    chart: Chart | None = None
    speeds: Speeds | None = None
    fault: Fault | None = None

    @property
    def name(self) -> str:
        """Whose system it is, and the suffix of its programs."""
        return f"{NAMES[self.suffix]} (.{self.suffix})"
