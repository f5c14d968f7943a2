"""The text of a program: blocks in the words of one machine.

Signals in: where the program starts, its blocks (places in mm, feeds in mm/s), and the Machine. Signals out:
lines of text, none longer than the machine takes.

A machine with a Z axis gets every block. Where there is none, the tool's own words stand for Z: `tool_down`
where Z goes into the work, `tool_up` before the next rapid, so that a hole drilled in pecks is one dot.

Source: RS-274-D. Questions: a letter that does not change is left out, as people and most programs do; an arc
always bears its end and its centre.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import NamedTuple

from morfax.motion.arrays import Array
from morfax.motion.motion import IN_WORK_BELOW_MM
from morfax.recorder.gcode.machine import Machine

WHOLE_FEED_MM_MIN = 10.0  # a feed from here on is written without decimals
CUTS = ("G1", "G2", "G3")


class Block(NamedTuple):
    """One block: G0 to G3 to a place (x, y, z) mm, arcs with their centre, or G4 with its time."""

    code: str
    place_mm: tuple[float, float, float]
    centre_mm: tuple[float, float] = (0.0, 0.0)
    feed_mm_s: float = 0.0
    dwell_s: float = 0.0


def program_text(
    start_mm: Array, blocks: Sequence[Block], machine: Machine, comments: Iterable[str]
) -> list[str]:
    """The lines of a program."""
    text = _Text(machine, [machine.comment(line) for line in comments])
    text.lines += machine.begin
    first_feed_mm_s = next((block.feed_mm_s for block in blocks if block.code in CUTS), 0.0)
    text.begin(start_mm, first_feed_mm_s)
    for block in blocks:
        if machine.z:
            text.block(block)
        else:
            text.block_without_z(block)
    text.tool(down=False)
    return [*text.lines, *machine.end]


class _Text:
    """The lines so far, where they lead to, and whether the tool is down (a machine without Z)."""

    def __init__(self, machine: Machine, lines: list[str]) -> None:
        self.machine, self.lines = machine, lines
        self.place_mm: list[float] = [0.0, 0.0, 0.0]
        self.feed = ""
        self.is_down = False

    def begin(self, start_mm: Array, feed_mm_s: float) -> None:
        """Write the way to the start: Z alone first where that is up, last where it is down."""
        self.place_mm = [float(mm) for mm in start_mm]
        x_y = "G0" + self._words("XY", self.place_mm[:2])
        z = self._words("Z", self.place_mm[2:])
        if not self.machine.z:
            self.lines.append(x_y)
            self.tool(down=self.place_mm[2] <= IN_WORK_BELOW_MM)
        elif self.place_mm[2] > IN_WORK_BELOW_MM:
            self.lines += ["G0" + z, x_y]
        else:
            self.lines += [x_y, "G1" + z + self._feed(feed_mm_s)]

    def block(self, block: Block) -> None:
        """Write a block for a machine with Z."""
        if block.code == "G4":
            time = block.dwell_s / self.machine.dwell_unit_s
            self.lines.append(f"G4 P{digits(time, 2)}")
            return
        arc = block.code in ("G2", "G3")
        axes = "XY" if arc else "XYZ"
        words = ""
        for axis, letter in enumerate(axes):
            if arc or block.place_mm[axis] != self.place_mm[axis]:
                words += self._words(letter, block.place_mm[axis : axis + 1])
        if arc:
            words += self._words("IJ", block.centre_mm)
        feed = "" if block.code == "G0" else self._feed(block.feed_mm_s)
        self.lines.append(block.code + words + feed)
        self.place_mm = list(block.place_mm)

    def block_without_z(self, block: Block) -> None:
        """Write a block for a machine whose tool is only up or down."""
        if block.code == "G4":
            self.block(block)
            return
        begins_mm, ends_mm = self.place_mm[2], block.place_mm[2]
        across = tuple(self.place_mm[:2]) != block.place_mm[:2]
        if not across:  # up again waits: the next peck may follow
            self.place_mm = list(block.place_mm)
            if ends_mm <= IN_WORK_BELOW_MM:
                self.tool(down=True)
            return
        in_work = min(begins_mm, ends_mm) <= IN_WORK_BELOW_MM
        self.tool(down=in_work)
        self.place_mm[2] = ends_mm
        code = block.code if in_work else "G0"
        self.block(block._replace(code="G1" if in_work and code == "G0" else code))

    def tool(self, *, down: bool) -> None:
        """Put the tool down or up, where it is not there yet."""
        if down != self.is_down and not self.machine.z:
            self.lines += self.machine.tool_down if down else self.machine.tool_up
            self.is_down = down

    def _feed(self, feed_mm_s: float) -> str:
        """The word of a feed, where it changes."""
        feed_mm_min = feed_mm_s * 60
        feed = f" F{digits(feed_mm_min, 0 if feed_mm_min >= WHOLE_FEED_MM_MIN else 3)}"
        if feed == self.feed or not self.machine.feeds:
            return ""
        self.feed = feed
        return feed

    def _words(self, letters: str, values_mm: Sequence[float]) -> str:
        """Words such as X5 Y-0.25, with a blank before each."""
        return "".join(
            f" {letter}{digits(value, self.machine.decimals)}"
            for letter, value in zip(letters, values_mm, strict=True)
        )


def digits(value: float, places: int) -> str:
    """A number without needless digits, never minus nothing."""
    text = f"{value:.{places}f}"
    if places:
        text = text.rstrip("0").rstrip(".")
    return "0" if text in ("-0", "") else text
