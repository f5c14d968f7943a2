"""Told figures: what the reference's track says of the figures that the text chunk states.

Signals in: cycles per mm, names of the axes and the place where the tape starts; out: the check frame of the
reference's track, and, of one that was read, whether a text agrees with it.

    count         (16 + log2 of cycles per mm) · 2^20        true to 3.3e-7; 0: not told
    speed, acceleration codes       CRC-32 of axes and start, modulo 126²; each 1 to 126, 0: not told

A changed digit of the text would make every length, or the place of the work, wrong, and nothing else on the
tape would show it. The reference has no motion of its own, so its frames have room for this.

Source: our own. Questions: axes and start are told by a sum only: one changed text in 15 876 agrees with it.
"""

from __future__ import annotations

import json
import math
import zlib
from typing import NamedTuple

from morfax.motion.faults import TapeFault
from morfax.recorder.tape.check_frame import (
    COUNTS_PER_CYCLE,
    LEAST_ACCELERATION,
    LEAST_SPEED,
    VERSION,
    CheckFrame,
    to_code,
    to_value,
)

STEPS_PER_OCTAVE = 1 << 20
LEAST_OCTAVE, OCTAVES = -16, 32  # 1.5e-5 to 65 536 cycles per mm; beyond nothing is told
# of a speed or an acceleration, without that of rest and that of more than can be told
CODES = 126


class StatedFigures(NamedTuple):
    """What a text chunk states: cycles per mm, names of the axes, start in mm."""

    cycles_per_mm: float
    axes: tuple[str, ...]
    start_mm: tuple[float, ...]


def frame_of(stated: StatedFigures, number: int, last: bool = False) -> CheckFrame:
    """What the reference's track says in a frame of this number."""
    tens, ones = divmod(_sum(stated), CODES)
    return CheckFrame(
        0,
        number,
        _scale(stated.cycles_per_mm) / COUNTS_PER_CYCLE[VERSION],
        to_value(tens + 1, LEAST_SPEED),
        to_value(ones + 1, LEAST_ACCELERATION),
        last,
    )


def demand_agreement(said: CheckFrame, stated: StatedFigures, used: StatedFigures) -> None:
    """Raise TapeFault where a text states other figures than were recorded; not for those given by hand."""
    told = said.counts
    if (
        told
        and used.cycles_per_mm == stated.cycles_per_mm
        and abs(told - _scale(stated.cycles_per_mm)) > 1
    ):
        cycles_per_mm = 2.0 ** (told / STEPS_PER_OCTAVE + LEAST_OCTAVE)
        raise TapeFault(
            f"the tape's text states {stated.cycles_per_mm:g} cycles per mm, and its tracks say "
            f"{cycles_per_mm:.6g}: the text was changed; play it with --cycles-per-mm {cycles_per_mm:.6g}, "
            "or with its label (--label)"
        )
    given = (used.axes, used.start_mm) != (stated.axes, stated.start_mm)
    if not given and _told_sum(said) not in (None, _sum(stated)):
        raise TapeFault(
            f"the tape's text states the axes {', '.join(stated.axes)} and the start "
            f"{','.join(f'{mm:g}' for mm in stated.start_mm)} mm, and its tracks were recorded with others: "
            "the text was changed; play it with its label (--label), or another copy of it"
        )


def agreed(
    said: CheckFrame, stated: StatedFigures | None, used: StatedFigures
) -> tuple[str, ...]:
    """Notes on figures given by hand, or lost with the text, that are not those of the recording.

    Raises TapeFault for a text that states others.
    """
    if stated is not None:
        demand_agreement(said, stated, used)
    notes = list[str]()
    if said.counts and abs(said.counts - _scale(used.cycles_per_mm)) > 1:
        recorded = 2.0 ** (said.counts / STEPS_PER_OCTAVE + LEAST_OCTAVE)
        notes.append(
            f"the tape was recorded with {recorded:.6g} cycles per mm and is played with"
            f" {used.cycles_per_mm:g}: all lengths are {recorded / used.cycles_per_mm:.4g} times as long"
        )
    told = _told_sum(said)
    if stated is None and told is not None and told != _sum(used):
        places = ",".join(f"{mm:g}" for mm in used.start_mm)
        notes.append(
            f"the tape was not recorded from {places} mm, or not with the axes {', '.join(used.axes)}: the"
            " path has its shape, and lies elsewhere; give the start (--from), or the tape's label (--label)"
        )
    return tuple(notes)


def _told_sum(said: CheckFrame) -> int | None:
    """The check sum that a tape tells; None on a tape that tells none."""
    tens, ones = (
        to_code(said.speed, LEAST_SPEED),
        to_code(said.acceleration, LEAST_ACCELERATION),
    )
    return CODES * (tens - 1) + ones - 1 if tens and ones else None


def _scale(cycles_per_mm: float) -> int:
    """Cycles per mm as a count; 0 beyond what can be told."""
    told = round((math.log2(cycles_per_mm) - LEAST_OCTAVE) * STEPS_PER_OCTAVE)
    return told if 0 < told < OCTAVES * STEPS_PER_OCTAVE else 0


def _sum(stated: StatedFigures) -> int:
    """The check sum of the axes and the start."""
    text = json.dumps([stated.axes, [float(mm) for mm in stated.start_mm]])
    return zlib.crc32(text.encode()) % CODES**2
