"""The job `mend`: a tape that tells what its dropouts lost is recorded anew."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path as FilePath
from typing import TYPE_CHECKING

from morfax.jobs.listener import SILENT, Listener
from morfax.jobs.machine.playing import ByHand
from morfax.jobs.media import files as medium

if TYPE_CHECKING:
    from morfax.jobs.figures import Figures
    from morfax.player.tape.mend import Mend
    from morfax.tracer.operator.operator import Panel


@dataclass(frozen=True, slots=True)
class MendResult:
    """What a mending gave: figures, the new tape's name, and what was put back at each doubtful dropout."""

    figures: Figures
    tape: FilePath
    mends: tuple[Mend, ...]


@dataclass(frozen=True, slots=True)
class MendJob:
    """Put back the whole cycles that a tape's dropouts lost."""

    tape: FilePath
    output: FilePath
    acceleration_mm_s2: float | None = None  # the most that the program asks of an axis
    by_hand: ByHand = field(default_factory=ByHand)

    def run(self, listener: Listener = SILENT, panel: Panel | None = None) -> MendResult:
        """Mend; raises TapeFault where cycles could have been lost in more than one way."""
        from morfax.player.tape.mend import mend

        medium.outgoing(self.output, self.tape)
        self.by_hand.refuse_label("mend")
        listener.compiling("the controls", ("motion", "player", "recorder"))
        with listener.progress(f"mending {self.tape.name}", 1.0) as advance:
            mended = mend(
                self.tape,
                self.output,
                **self.by_hand.given(),
                acceleration_mm_s2=self.acceleration_mm_s2,
                progress=lambda done_s, total_s: advance(done_s / (total_s or 1)),
            )
        for note in mended.notes:
            listener.note(note)
        rows = [
            {
                "dropout": number,
                "axis": one.axis,
                "time_s": one.time_s,
                "length_s": one.length_s,
                "cycles": one.cycles,
                "unknown_mm": one.unknown_mm,
                "likely_mm": one.likely_mm,
            }
            for number, one in enumerate(mended.mends, 1)
        ]
        figures = {
            "tape": str(self.output),
            "duration_s": mended.recording.duration_s,
            "dropouts": mended.dropouts,
            "cycles_put_back": sum(abs(one.cycles) for one in mended.mends),
            "mends": rows or None,
        }
        return MendResult(figures, self.output, mended.mends)
