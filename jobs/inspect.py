"""The job `inspect`: what is on a tape: tracks, carriers, levels, travel, format; or in another program.

The carriers say what they are even where nothing else is known of the tape (see `carriers`). The travel of
each axis comes from the phases, and so needs the format: from the text chunk, or by hand.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

import numpy as np

from morfax.jobs.figures import Figures
from morfax.jobs.listener import SILENT, Listener
from morfax.jobs.machine.playing import ByHand
from morfax.jobs.machine.running import on_machine
from morfax.jobs.media import files as medium
from morfax.jobs.readings import program_figures
from morfax.jobs.readings.carriers import CarrierReading, listen
from morfax.jobs.wrong_use import WrongUse
from morfax.motion.faults import TapeFault
from morfax.motion.usual import AT_ONCE

if TYPE_CHECKING:
    from morfax.motion.arrays import Array
    from morfax.motion.faults import Fault
    from morfax.recorder.tape.tape import Tape
    from morfax.tracer.operator.operator import Panel


@dataclass(frozen=True, slots=True)
class InspectResult:
    """What is on a tape, or in a program: figures, and the fault of a tape that cannot be played.

    A face draws the picture of a punched tape.
    """

    figures: Figures
    fault: Fault | None = None


@dataclass(frozen=True, slots=True)
class InspectJob:
    """Tell what is on a tape, or in a program of another medium."""

    tape: FilePath
    by_hand: ByHand = field(default_factory=ByHand)
    picture: FilePath | None = None  # of the punched tape of a .steps program

    def run(self, listener: Listener = SILENT, panel: Panel | None = None) -> InspectResult:
        """Inspect; raises WrongUse, and the fault of a file that cannot be measured at all."""
        is_program = medium.kind_of(self.tape) == "program"
        if self.picture is not None:
            if not is_program or self.tape.suffix.lower() != ".steps":
                raise WrongUse(
                    f"{self.tape} has no punched tape to draw; --picture is for .steps: leave it out, or see "
                    "the path with `morfax play --picture`"
                )
            medium.outgoing(self.picture, self.tape)
        if not is_program:
            return self._of_tape(listener)
        self.by_hand.for_file(self.tape)
        listener.compiling("the controls", ("motion", "player"))
        machine = self.by_hand.machine
        figures = program_figures.of_program(self.tape, machine)
        on_it = on_machine(self.tape, machine)
        return InspectResult({"program": str(self.tape), **on_it, **figures})

    def _of_tape(self, listener: Listener) -> InspectResult:
        """What a tape says of itself, and what its tracks hold, as far as that can be known."""
        stated: dict[str, Any] = {}
        travels: dict[str, Figures] = {}
        fault: TapeFault | None = None
        try:
            with self.by_hand.open_tape(self.tape) as opened:
                stated, travels = _stated(opened), _travels(opened, listener)
        except TapeFault as met:
            fault = met
        file, carriers = listen(self.tape, fault)
        tracks = _tracks(carriers, travels)
        return InspectResult({"tape": str(self.tape), **file, **stated, **tracks}, fault)


def _tracks(carriers: list[CarrierReading], travels: dict[str, Figures]) -> dict[str, Figures]:
    """Figures of each track: its carrier, and the travel of its axis where that is known."""
    known = ("reference", *travels)[: len(carriers)]
    names = [*known, *("" for _ in carriers[1 + len(travels) :])]
    return {
        f"track_{number}_{name}".rstrip("_"): {**carrier.figures(), **travels.get(name, {})}
        for number, (name, carrier) in enumerate(zip(names, carriers, strict=True), 1)
    }


def _stated(tape: Tape) -> dict[str, Any]:
    """What the format says, from the text chunk or by hand."""
    fmt = tape.format
    return {
        "reference_hz": fmt.reference_hz,
        "cycles_per_mm": fmt.cycles_per_mm,
        "largest_speed_mm_s": fmt.largest_speed_mm_s,
        "start_place_mm": fmt.start_mm,
        "end_place_mm": fmt.end_mm,
        "text": tape.text or "none",
    }


def _travels(tape: Tape, listener: Listener) -> dict[str, Figures]:
    """How far each axis goes from its start, mm, by the phases of its track."""
    from morfax.player.tape.discriminator import Discriminator, discriminate

    fmt = tape.format
    listener.compiling("the discriminator", ("player",))
    discriminator = Discriminator(
        fmt.sample_rate_hz, fmt.reference_hz, fmt.samples_per_motion, fmt.tracks
    )
    low = np.full(len(fmt.axes), np.inf)
    high = np.full(len(fmt.axes), -np.inf)
    zero: Array | None = None
    for phases in discriminate(tape.stored_blocks(AT_ONCE), discriminator):
        zero = phases.cycles[0] if zero is None else zero
        low, high = (
            np.fmin(low, phases.cycles.min(axis=0)),
            np.fmax(high, phases.cycles.max(axis=0)),
        )
    if zero is None:
        return {name: {} for name in fmt.axes}
    lowest = (low - zero) / fmt.cycles_per_mm
    highest = (high - zero) / fmt.cycles_per_mm
    return {
        name: {"lowest_travel_mm": float(lowest[i]), "highest_travel_mm": float(highest[i])}
        for i, name in enumerate(fmt.axes)
    }
