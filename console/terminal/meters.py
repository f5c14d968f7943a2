"""Meters on a terminal: a bar for the level of each track, told four times a second.

    1 ████████████████████──────  -6.0 dB   2 ██████████████████────────  -8.1 dB

Signals in: levels in dB of full scale. Out: one line on the terminal, which is written over; nothing where
there is no terminal.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, TextIO

from morfax.motion.ending import Ending

if TYPE_CHECKING:
    from morfax.jobs.devices import Levels

BAR = 12  # characters
LOWEST_DB = -48.0  # 4 dB to a character


class Meters(Ending):
    """The meters; a context manager that ends their line."""

    def __init__(self, out: TextIO, *, is_shown: bool = True) -> None:
        self._out, self._is_shown = out, is_shown and out.isatty()
        self._wrote = False

    def end(self, error: BaseException | None) -> None:
        """Leave the line that was written over and over."""
        if self._wrote:
            self._out.write("\n")

    def show(self, levels: Levels) -> None:
        """Write the levels over those before."""
        if not self._is_shown:
            return
        self._wrote = True
        self._out.write("\r" + bars(levels))
        self._out.flush()


def bars(levels: Levels) -> str:
    """A line with a bar for each track; `!` where its peaks reach full scale."""
    each = []
    for track, (level_db, peak_db) in enumerate(
        zip(levels.level_db, levels.peak_db, strict=True), 1
    ):
        full = min(max(round(BAR * (1 - level_db / LOWEST_DB)), 0), BAR)
        mark = "!" if peak_db > -0.1 else " "
        each.append(f"{track} {'█' * full}{'─' * (BAR - full)} {level_db:6.1f} dB{mark}")
    return "  ".join(each)
