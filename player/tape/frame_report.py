"""The report of a frame of the check signal: what each track says in it, and how late it is.

Signals in: what was read of a frame of all tracks. Signals out: the report, with rows of the tape and s.

Source: our own. Questions: none.
"""

from __future__ import annotations

from typing import NamedTuple

from morfax.recorder.tape.check_frame import CheckFrame


class FrameReport(NamedTuple):
    """A frame of all tracks: its number, rows of its start, its middle, and the middle of its parts.

    `said`: what each track says, None where its check sum is wrong; `late_s` against the clock of the
    reference, `delay_s` (tracks, parts) against track 1, and that of track 1 against its own carrier; nan
    where a track says nothing. `error_s` is the standard error of each told delay of a track, and `swing_s`
    how far a delay swings within its parts, RMS; `damaged` are tracks that say nothing though their level is
    right, `weak_rows` where each is weak. `is_calm`: each track says that it is itself and this frame, is in
    time, does not swing, and has no delay above the dead zone.
    """

    number: int
    row: float
    middle_row: float
    part_rows: list[float]
    said: tuple[CheckFrame | None, ...]
    late_s: list[float]
    delay_s: list[list[float]]
    error_s: list[float]
    swing_s: list[float]
    damaged: tuple[int, ...]
    weak_rows: list[list[float]]
    is_calm: bool = False


def frame_report(
    number: int,
    rows: list[float],
    said: tuple[CheckFrame | None, ...],
    figures: list[list[float]],
    *,
    is_calm: bool = False,
    hurt: tuple[tuple[int, ...], list[list[float]]] | None = None,
) -> FrameReport:
    """The report of a frame, from its times as `count_on` tells them; `hurt`: damaged tracks, weak rows."""
    damaged, weak_rows = ((), [[]] * len(said)) if hurt is None else hurt
    return FrameReport(
        number,
        rows[0],
        rows[1],
        rows[2:],
        said,
        [told[0] for told in figures],
        [told[1:-2] for told in figures],
        [told[-2] for told in figures],
        [told[-1] for told in figures],
        damaged,
        weak_rows,
        is_calm,
    )
