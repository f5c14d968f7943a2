"""Reader of RS-274 programs: G-code in, lines and arcs in mm out.

Signals in: the text of a program. Signals out: moves in mm, mm/s and s, in the order of the program.

    G0 G1 G2 G3     rapid, line, arc clockwise, arc counter-clockwise; arcs by I and J or by R
    G4 P            dwell, s
    G17             plane X Y                    G20 G21     inches, millimetres
    G54             the one coordinate system    G90 G91     places, distances
    G94 F           feed per minute              S T         speed and tool, read and left to the machine
    G40 G49 G80     no compensation, no tool length, no cycle: as this control always is
    G61 G64 P       exact or rounded corners: this control rounds none
    M0 M3 M4 M5     stop for the operator, spindle on, off   M2 M30      end; nothing after it is read
    N               line number                  ( ) ;       comments        %   begin and end

Anything else is refused with its line and word: a word that is passed over may be the one that keeps the tool
out of the clamp. A program without an end is taken for cut short.

Source: RS-274-D; NIST RS274/NGC interpreter, version 3 (Kramer, Proctor, Messina, 2000), sections 2 and 3.
Questions: before G20 or G21 a number is in mm. Where the machine stands is not in a program: each axis stands
where the program first sends it, unless a start is given. The ends of an arc may lie on circles that differ
by 5 um, or by 0.1 % of the radius if that is more but at most 0.5 mm (Grbl's rule); its centre is then moved
to be as far from both.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from morfax.motion.faults import ProgramFault
from morfax.motion.pathtable import LONGEST_S
from morfax.motion.units import MM_PER_INCH
from morfax.player.gcode.arc_words import OURS, ArcWords, Place, WordError
from morfax.player.gcode.gcode_text import COMMENT, PROGRAM_NUMBER, WORD
from morfax.player.gcode.modal_groups import BLENDING, CODES, DISTANCE, MOTION, READ, UNITS
from morfax.player.gcode.moves import (
    CLOCKWISE,
    COUNTER_CLOCKWISE,
    DWELL,
    LINE,
    RAPID,
    Move,
    Program,
)

LONGEST_DWELL_S = LONGEST_S  # more is a mistake of the unit

_KINDS = {0.0: RAPID, 1.0: LINE, 2.0: CLOCKWISE, 3.0: COUNTER_CLOCKWISE}
_PLAIN, _MOVING, _ARC_WORDS = frozenset("GXYZIJRFPSTN"), frozenset("XYZIJR"), frozenset("IJR")


def parse_rs274(
    lines: Iterable[str],
    name: str = "program",
    start_mm: Sequence[float] | None = None,
    reader: GcodeReader | None = None,
) -> Program:
    """The program of some lines of text, by a reader of one's own; raises ProgramFault."""
    reader = reader or GcodeReader(name, start_mm)
    for number, text in enumerate(lines, 1):
        reader.number = number
        reader.read(text)
        if reader.ended:
            break
    if not reader.ended and not (reader.begun and reader.is_whole):
        what = (
            "holds no line"
            if not reader.number or reader.number == 1
            else f"breaks off after line {reader.number}"
        )
        raise ProgramFault(
            f"{name} {what}; a program ends with {reader.ending}: get the whole of it",
            line=reader.number,
        )
    x_mm, y_mm, z_mm = (0.0 if place is None else place for place in reader.start)
    notes = (reader.unended,) if reader.unended and not reader.ended else ()
    moves = reader.moves_from((x_mm, y_mm, z_mm))
    return Program((x_mm, y_mm, z_mm), moves, notes=notes, said=reader.said)


class GcodeReader:
    """The modal state of a program, and the moves so far."""

    is_whole = False  # whether the end of the file may be the end of the program
    ending = (
        "M2, M30 or % (for Grbl and Marlin, with --machine grbl-router or marlin, anywhere)"
    )
    # whether a line such as O1000 may come first, the number of the program
    takes_number = True
    unended = ""  # the note on a program without an end, where its control takes that, and ends as a rule

    def __init__(self, name: str, start_mm: Sequence[float] | None) -> None:
        self.name, self.number, self.ended = name, 0, False
        self.moves: list[Move] = []
        self.said: list[tuple[int, str]] = []  # words of the tool, before which move
        self.start: list[float | None] = (
            [None, None, None] if start_mm is None else list(start_mm)
        )
        self.place = [0.0, 0.0, 0.0] if start_mm is None else list(start_mm)
        self.kind, self.scale, self.relative, self.feed_mm_s = "", 1.0, False, 0.0
        self.arc_limits = OURS
        self.begun = self.has_words = False  # whether there was a % or a word; a word
        self.unsent = [0, 0, 0]  # moves of each axis before the program first sends it

    def moves_from(self, start_mm: Place) -> list[Move]:
        """The moves of a machine that stands at the start: an axis stays there until it is first sent."""
        moves = list(self.moves)
        for k in range(max(self.unsent)):
            axes = zip(self.unsent, start_mm, moves[k].end_mm, strict=True)
            x_mm, y_mm, z_mm = (start if k < unsent else end for unsent, start, end in axes)
            moves[k] = moves[k]._replace(end_mm=(x_mm, y_mm, z_mm))
        return moves

    def read(self, text: str) -> None:
        """Read a line."""
        if "(" in text or ";" in text:
            text = COMMENT.sub("", text)
        # what stands between words, a letter, a number, and so on
        parts = WORD.split("".join(text.split()))
        if any(parts[::3]):
            parts = self._second_look("".join(parts))
        if len(parts) > 1:
            is_name = not self.has_words and bool(PROGRAM_NUMBER.fullmatch("".join(parts)))
            self.begun = self.has_words = True
            if is_name and self.takes_number:
                return
            letters, numbers = parts[1::3], parts[2::3]
            if "M" in letters:
                self.note(letters, numbers)
            self.obey(letters, numbers)

    def note(self, letters: Sequence[str], numbers: Sequence[str]) -> None:
        """Note a line that has words for the tool."""
        words = " ".join(map("".join, zip(letters, numbers, strict=True)))
        self.said.append((len(self.moves), words))

    def _second_look(self, text: str) -> list[str]:
        """A line that is not all words: a %, small letters, or refused."""
        if text == "%":  # the first begins the program, the next ends it
            self.ended, self.begun = self.begun, True
            return []
        parts = WORD.split(text.upper())
        for between in parts[::3]:
            if between:
                what = "is no word; words are a letter and a number such as X5 or Y-0.25"
                raise self._fault(repr(between[:20]), what)
        return parts

    def obey(self, letters: list[str], numbers: list[str]) -> None:
        """Carry out the words of a line, in the order of the standard."""
        values = dict(zip(letters, map(float, numbers), strict=True))
        dwell, stop = False, -1
        if (
            len(values) != len(letters)
            or not values.keys() <= _PLAIN
            or values.get("G", 0.0) not in _KINDS
        ):
            groups = self._codes(letters, numbers)
            self._set_modes(groups)
            dwell, stop = "dwell" in groups, groups.get("stop", -1)
            if BLENDING in groups:
                # how far a control may round corners; this one rounds none
                values.pop("P", None)
        elif "G" in values:  # nearly all lines come here
            self.kind = _KINDS[values["G"]]
        self._move(values, dwell)
        self.ended = stop in (2, 30)

    def _codes(self, letters: list[str], numbers: list[str]) -> dict[str, int]:
        """The G and M words of a line by their groups; raises ProgramFault for an unknown or doubled word."""
        groups: dict[str, int] = {}
        for at, (letter, text) in enumerate(zip(letters, numbers, strict=True)):
            group = CODES.get((letter, float(text))) if letter in "GM" else letter
            if group is None or (group == letter and letter not in _PLAIN):
                raise self._fault(letter + text, f"is not played; this control reads {READ}")
            if group in groups or (group == letter and letter in letters[:at]):
                raise self._fault(
                    letter + text, f"is the second word for {group} in the line; give one"
                )
            if group != letter:
                groups[group] = int(float(text))
        return groups

    def _set_modes(self, groups: dict[str, int]) -> None:
        """Units, distance mode and motion of this line and those after it."""
        if UNITS in groups:
            self.scale = MM_PER_INCH if groups[UNITS] == 20 else 1.0
        if DISTANCE in groups:
            self.relative = groups[DISTANCE] == 91
        if MOTION in groups:
            if "dwell" in groups:
                raise self._fault(
                    "G4", "stands with another motion in one line; give it a line of its own"
                )
            self.kind = _KINDS[groups[MOTION]]

    def _move(self, values: dict[str, float], dwell: bool) -> None:
        """Feed, dwell, and then the motion that the axis words ask for."""
        if "F" in values:
            if values["F"] <= 0:
                raise self._fault(
                    f"F{values['F']:g}",
                    "moves nothing; give a feed above zero, in units per minute",
                )
            self.feed_mm_s = values["F"] * self.scale / 60
        if dwell:
            self._dwell(values)
        elif "P" in values:
            raise self._fault(f"P{values['P']:g}", "belongs to a dwell; give G4 with it")
        elif not _MOVING.isdisjoint(values):
            self._go(values)

    def _dwell(self, values: dict[str, float]) -> None:
        """G4: stand still."""
        if not 0 <= values.get("P", -1.0) <= LONGEST_DWELL_S or not values.keys().isdisjoint(
            "XYZIJR"
        ):
            raise self._fault(
                "G4", "wants a time in seconds, a day at most, and no place; give G4 P0.5"
            )
        self.moves.append(
            Move(
                self.number,
                DWELL,
                (self.place[0], self.place[1], self.place[2]),
                0.0,
                (0, 0),
                0.0,
                values["P"],
            )
        )

    def _go(self, values: dict[str, float]) -> None:
        """G0 to G3: to the place that the axis words give."""
        kind, place = self.kind, self.place
        if not kind:
            raise self._fault(
                _first_word("XYZIJR", values),
                "asks for a move, but none of G0 G1 G2 G3 was given; give one first",
            )
        begin = place[0], place[1], place[2]
        self._place_axes(values)
        end = place[0], place[1], place[2]
        if kind != RAPID and self.feed_mm_s == 0:
            raise self._fault(
                kind, "has no feed; give F, in units per minute, before it or with it"
            )
        if kind in (CLOCKWISE, COUNTER_CLOCKWISE):
            self.moves.append(self._arc(values, begin, end))
            return
        if not _ARC_WORDS.isdisjoint(values):
            raise self._fault(
                _first_word("IJR", values),
                f"belongs to an arc, and {kind} is not one; leave it out",
            )
        self.moves.append(
            Move(self.number, kind, end, 0.0 if kind == RAPID else self.feed_mm_s)
        )

    def _place_axes(self, values: dict[str, float]) -> None:
        """Set the place that the axis words give; where an axis is first sent anywhere, it has started."""
        keeps = self.relative or self.kind not in (RAPID, LINE)  # starts where it stands
        for axis, letter in enumerate("XYZ"):
            if letter not in values:
                continue
            before = self.place[axis]
            self.place[axis] = values[letter] * self.scale + (before if self.relative else 0.0)
            if self.start[axis] is None:
                self.unsent[axis] = len(self.moves)
                self.start[axis] = before if keeps else self.place[axis]

    def _arc(self, values: dict[str, float], begin: Place, end: Place) -> Move:
        """G2 and G3: the arc between two places."""
        sense = 1 if self.kind == COUNTER_CLOCKWISE else -1
        try:
            centre, turned = ArcWords(
                self.kind, sense, values, self.scale, self.arc_limits
            ).arc(begin, end)
        except WordError as error:
            raise self._fault(error.word, error.what) from None
        return Move(self.number, self.kind, end, self.feed_mm_s, centre, turned)

    def _fault(self, word: str, what: str) -> ProgramFault:
        """A fault at this line."""
        return ProgramFault(f"{self.name}, line {self.number}: {word} {what}", line=self.number)


def _first_word(letters: str, values: dict[str, float]) -> str:
    """The first of some letters that a line has, with its number."""
    letter = next(letter for letter in letters if letter in values)
    return f"{letter}{values[letter]:g}"
