"""The job `age`: what a real recorder and the years do to a tape."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

from morfax.jobs.listener import SILENT, Listener
from morfax.jobs.media import files as medium
from morfax.jobs.wrong_use import settings_checked

if TYPE_CHECKING:
    from morfax.jobs.figures import Figures
    from morfax.tracer.operator.operator import Panel

# recorder.wear.settings
SETS = ("studio-15ips", "instrumentation", "reel", "cassette", "answering-machine", "mp3")
CODECS = ("mp3-64", "mp3-128", "opus-64")  # recorder.wear.codec


@dataclass(frozen=True, slots=True)
class AgeResult:
    """What the wear gave: figures, and the worn tape's name."""

    figures: Figures
    tape: FilePath


@dataclass(frozen=True, slots=True)
class AgeJob:
    """Wear a tape: all that a kind of machine does, and single parts of wear, which go before it."""

    tape: FilePath
    output: FilePath
    machine: str | None = None  # one of SETS; None: no wear but the parts
    parts: tuple[tuple[str, Any], ...] = ()  # fields of recorder.wear.transport.Wear, by name
    seed: int = 0

    def run(self, listener: Listener = SILENT, panel: Panel | None = None) -> AgeResult:
        """Wear the tape; raises WrongUse for wear that cannot be, TapeFault and FileFault."""
        from morfax.recorder.wear.settings import SETS as WEAR
        from morfax.recorder.wear.settings import Wear
        from morfax.recorder.wear.transport import age

        medium.outgoing(self.output, self.tape)
        listener.compiling("the transport", ("recorder",))
        with listener.progress(f"wearing {self.tape.name}", 1.0) as advance, settings_checked():
            wear = replace(WEAR[self.machine] if self.machine else Wear(), **dict(self.parts))
            aged = age(
                self.tape,
                self.output,
                wear,
                self.seed,
                progress=lambda done_s, total_s: advance(done_s / (total_s or 1)),
            )
        figures = {
            "tape": str(self.output),
            "duration_s": aged.duration_s,
            "dropouts": len(aged.dropouts),
            "seed": self.seed,
        }
        return AgeResult(figures, self.output)
