"""The text of a program: blocks in the words of one machine.

Signals in: where the program starts, its blocks (places in mm, feeds in mm/s), and the Machine. Signals out:
lines of text, none longer than the machine takes.

A machine with a Z axis gets every block. Where there is none, `recorder.gcode.tooling` has put the tool's own
words in the place of Z.

Source: RS-274-D. Questions: a letter that does not change is left out, as people and most programs do; an arc
always bears its end and its centre. Marlin runs a rapid at the feed before it, so that its rapids bear one.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import NamedTuple

from morfax.motion.arrays import Array
from morfax.motion.motion import IN_WORK_BELOW_MM
from morfax.recorder.gcode.machine import Machine

WHOLE_FEED_MM_MIN = 10.0  # a feed from here on is written without decimals
RAPID, DWELL, WORDS = "G0", "G4", "words"
ARCS = ("G2", "G3")
CUTS = ("G1", *ARCS)
END = "end of the program"  # a comment, where the control has no word for it
UP_MM = 2.0  # where a motion that never leaves the work ends; as the clearance without a card
PERCENT = "%"
ENDING = ("M2", "M30", PERCENT)
LARGEST_NUMBER = 99999  # of a line: LinuxCNC takes five digits


class Block(NamedTuple):
    """One block: G0 to G3 to a place (x, y, z) mm, arcs with their centre; G4 with its time; or words."""

    code: str
    place_mm: tuple[float, float, float]
    centre_mm: tuple[float, float] = (0.0, 0.0)
    feed_mm_s: float = 0.0
    dwell_s: float = 0.0
    words: tuple[str, ...] = ()  # lines of the machine's own, written as they are


def program_text(
    start_mm: Array, blocks: Sequence[Block], machine: Machine, comments: Iterable[str]
) -> list[str]:
    """The lines of a program; the blocks are as the machine runs them."""
    opening = machine.begin[: machine.begin[:1] == (PERCENT,)]  # stands before any comment
    text = _Text(machine, [*opening, *(machine.comment(line) for line in comments)])
    text.lines += machine.begin[len(opening) :]
    first_feed_mm_s = next((block.feed_mm_s for block in blocks if block.code in CUTS), 0.0)
    text.begin(start_mm, first_feed_mm_s)
    for block in blocks:
        text.block(block)
    if machine.z and text.place_mm[2] <= IN_WORK_BELOW_MM:
        highest_mm = max((block.place_mm[2] for block in blocks), default=0.0)
        x, y, _ = text.place_mm
        text.block(Block(RAPID, (x, y, highest_mm if highest_mm > IN_WORK_BELOW_MM else UP_MM)))
    text.lines += machine.end
    if not any(line in ENDING for line in machine.end):
        text.lines.append(machine.comment(END))
    return _numbered(text.lines, machine.line_numbers) if machine.line_numbers else text.lines


def _numbered(lines: Sequence[str], step: int) -> list[str]:
    """The lines with their numbers, but for comments and %; after the largest number they begin anew."""
    numbered, number = list[str](), 0
    for line in lines:
        if line.startswith(("(", ";", PERCENT)):
            numbered.append(line)
            continue
        number = number + step if number + step <= LARGEST_NUMBER else step
        numbered.append(f"N{number} {line}")
    return numbered


class _Text:
    """The lines so far, and where they lead to."""

    def __init__(self, machine: Machine, lines: list[str]) -> None:
        self.machine, self.lines = machine, lines
        self.place_mm: list[float] = [0.0, 0.0, 0.0]
        self.feed = ""

    def begin(self, start_mm: Array, feed_mm_s: float) -> None:
        """Write the way to the start: Z alone first where that is up, last where it is down."""
        self.place_mm = [float(mm) for mm in start_mm]
        across_mm_s = min(self.machine.rapid_mm_s[:2])
        up_mm_s = self.machine.rapid_mm_s[2]
        x_y = "G0" + self._words("XY", self.place_mm[:2])
        z = self._words("Z", self.place_mm[2:])
        if not self.machine.z:
            self.lines.append(x_y + self._rapid_feed(across_mm_s))
            self.place_mm[2] = 0.0
        elif self.place_mm[2] > IN_WORK_BELOW_MM:
            self.lines.append("G0" + z + self._rapid_feed(up_mm_s))
            self.lines.append(x_y + self._rapid_feed(across_mm_s))
        else:
            self.lines.append(x_y + self._rapid_feed(across_mm_s))
            self.lines.append("G1" + z + self._feed(feed_mm_s))

    def block(self, block: Block) -> None:
        """Write a block; one without a code says only a place."""
        if block.code == WORDS:
            self.lines += block.words
            if any("F" in word for word in block.words):
                self.feed = ""
        elif block.code == DWELL:
            time = block.dwell_s / self.machine.dwell_unit_s
            self.lines.append(f"G4 P{digits(time, 2)}")
        elif block.code:
            self._move(block)

    def _move(self, block: Block) -> None:
        """Write a rapid, a line or an arc."""
        across_mm_s = min(self.machine.rapid_mm_s[:2])
        up_mm_s = self.machine.rapid_mm_s[2]
        arc = block.code in ARCS
        axes = "XY" if arc else "XYZ"
        words = ""
        for axis, letter in enumerate(axes):
            if arc or block.place_mm[axis] != self.place_mm[axis]:
                words += self._words(letter, block.place_mm[axis : axis + 1])
        if arc:
            words += self._words("IJ", block.centre_mm)
        if block.code == RAPID:
            is_up = block.place_mm[2] != self.place_mm[2]
            feed = self._rapid_feed(up_mm_s if is_up else across_mm_s)
        else:
            feed = self._feed(block.feed_mm_s)
        self.lines.append(block.code + words + feed)
        self.place_mm = list(block.place_mm)

    def _rapid_feed(self, feed_mm_s: float) -> str:
        """The word of a rapid's feed, where the control wants one."""
        return self._feed(feed_mm_s) if self.machine.rapids_have_feed else ""

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
