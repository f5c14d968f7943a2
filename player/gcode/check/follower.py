"""The reader of the pulse control, going on after a mistake, and following what that control does not play.

Signals in: the words of a line, those that the machine's control takes. Signals out: moves, each with its
line and whether the tool was on; findings for what the reader refuses.

What the reader plays goes to it as it is. Helices, arcs in other planes and canned cycles become lines; G28,
G30 and G53 go up, to where the machine is above all places so far; G92 moves the zero; the other ways of
moving it, a cutter's compensation and curves are not followed, and that is said.

Source: NIST RS274/NGC interpreter, version 3, section 3.5. Questions: where a machine's own places are is not
in a program. A peck is run in one go: what it cuts is the same.
"""

from __future__ import annotations

import math

from morfax.motion.faults import ProgramFault
from morfax.player.gcode.arc_words import TURN, ArcLimits, ArcWords, Place, WordError
from morfax.player.gcode.check import not_followed
from morfax.player.gcode.check.cycles import MOST_REPEATS, CannedCycle
from morfax.player.gcode.check.findings import Finding, Findings
from morfax.player.gcode.check.lines import Words
from morfax.player.gcode.check.planes import LEVEL, PLANES
from morfax.player.gcode.check.words import AXES, CYCLES, MOTIONS, PROBES, called
from morfax.player.gcode.moves import COUNTER_CLOCKWISE, LINE, RAPID, Move
from morfax.player.gcode.rs274 import GcodeReader
from morfax.player.gcode.tool_state import ToolState
from morfax.recorder.gcode.machine import Machine
from morfax.recorder.gcode.takes import Code, codes

_READ = codes("G0-G4 G20 G21 G90 G91")  # words that the reader obeys
_PLAIN = codes("G0-G3")
_HOME = codes("G28 G30")
_SETTINGS = codes("G10 G28.1 G30.1 G43.1 G52")  # words whose places are no move
_OUR_LETTERS = frozenset("XYZF")


class CheckingReader(GcodeReader):
    """The modal state of a program as the machine's control has it, and the moves so far."""

    def __init__(self, name: str, machine: Machine, findings: Findings) -> None:
        super().__init__(name, None)
        takes = machine.takes
        limits = takes.arc_mm, takes.arc_share, takes.arc_most_mm, takes.reach_mm
        self.machine, self.findings, self.arc_limits = (
            machine,
            findings,
            ArcLimits(*limits, True),
        )
        self.tool = ToolState(machine.tool)
        self.on: list[bool] = []  # for each move, whether the tool runs
        self.working: list[bool] = []  # and is in the work, where there is no Z
        self.motion: Code | None = None
        self.plane, self.turns = LEVEL, 1
        self.inverse_time = self.absolute_centres = False
        self.offset = [0.0, 0.0, 0.0]  # of G92
        self.lost, self.lost_at_begin = set[str](), set[str]()
        self.k, self.cycle = 0.0, CannedCycle()

    def follow(self, words: Words, named: list[Code]) -> None:
        """Obey the words of a line that the control takes."""
        self.number = self.findings.line
        values = dict(zip(words.letters[::-1], map(float, words.numbers[::-1]), strict=True))
        present, first = set(named), len(self.moves)
        self._lose_places(words, values)
        self._modes(present, values, words)
        self.tool.obey(values | dict.fromkeys(words.computed & {"S"}, math.inf), present)
        if any(letter == "M" for letter, _ in named):
            self.note(words.letters, words.numbers)
        try:
            self._obey_places(present, values)
        except ProgramFault as fault:
            self._refused(fault)
        if self.inverse_time and "F" in values:
            self._in_inverse_time(first, values["F"])
        count = len(self.moves) - first
        self.on += [self.tool.runs or bool(present & PROBES)] * count
        self.working += [self.tool.in_work] * count
        self.ended = bool(present & codes("M2 M30 M99"))
        self.tool.end(present)

    def _lose_places(self, words: Words, values: dict[str, float]) -> None:
        """Remember which axes stand at a place that was not read, until they are sent to one that is."""
        self.lost_at_begin = set(self.lost)
        self.lost |= AXES & words.computed
        if not self.relative:
            self.lost -= values.keys()

    def _modes(self, present: set[Code], values: dict[str, float], words: Words) -> None:
        """Set the modes that the reader does not have, and those that it must lose."""
        motion = next((code for code in present if code in MOTIONS), None)
        self.motion = motion or self.motion
        if present & codes("G93-G95"):
            self.inverse_time = ("G", 93.0) in present
        self._feed_that_is_not_read(words, values)
        if present <= _PLAIN:  # nearly all lines
            return
        if ("G", 80.0) in present and not motion:
            self.motion, self.kind = None, ""
        if "P" in words.computed and ("G", 4.0) in present:
            values["P"] = 0.0  # a time that is not known
        self._lasting_modes(present)
        if not_followed.found(present, self.findings):
            self.lost |= AXES

    def _feed_that_is_not_read(self, words: Words, values: dict[str, float]) -> None:
        """Have the machine's own feed where the program's is computed, or is a time."""
        if "F" in words.computed or ("F" in values and self.inverse_time):
            self.feed_mm_s = self.machine.panel_feed_mm_s

    def _lasting_modes(self, present: set[Code]) -> None:
        """Set the plane, what an arc's centre counts from, and where a canned cycle returns to."""
        for _, number in present:
            if number in PLANES:
                self.plane = number
        if present & codes("G90.1 G91.1"):
            self.absolute_centres = ("G", 90.1) in present
        if present & codes("G98 G99"):
            self.cycle.returns_to_start = ("G", 98.0) in present

    def _obey_places(self, present: set[Code], values: dict[str, float]) -> None:
        """Go where the places of a line lead, by the word that takes them."""
        if ("G", 92.0) in present:
            self._set_zero(values)
        elif present & codes("G92.1 G92.2"):
            self.offset = [0.0, 0.0, 0.0]
        elif present & _SETTINGS:
            self._obey(present, _only("F", values))
        elif present & _HOME or ("G", 53.0) in present:
            self._go_home(present, values)
        elif self.motion in CYCLES:
            self._obey(present - CYCLES, _only("F", values))
            if AXES & values.keys():
                self.cycle.run(self, values)
        elif ("G", 4.0) in present and AXES & values.keys():  # first the dwell, then the way
            self._obey({("G", 4.0)}, _only("P", values))
            self._obey(present - codes("G4"), values)
        else:
            self._obey(present, values)

    def _obey(self, present: set[Code], values: dict[str, float]) -> None:
        """Have the reader obey its own words and letters."""
        mine = {code for code in present if code in _READ}
        if self.motion not in _PLAIN and self.motion is not None and self.motion in present:
            mine.add(("G", 1.0))  # a probe, or a curve: straight to its end
        passed = self._letters_of_the_reader(values)
        if ("G", 4.0) in present:
            passed |= self._dwell_words(values)
        if self.inverse_time or values.get("F", 0.0) < 0:
            passed.pop("F", None)
        asks = next((called(code) for code in mine if code in codes("G1-G3")), "")
        if asks and not AXES & values.keys() and "F" not in passed:
            self._see_a_feed(asks)
        gs = [f"{number:g}" for _, number in sorted(mine)]
        self.obey(["G"] * len(gs) + list(passed), gs + list(passed.values()))

    def _letters_of_the_reader(self, values: dict[str, float]) -> dict[str, str]:
        """The letters that the reader knows, each with its number as text; an arc's turns are kept."""
        letters = set(_OUR_LETTERS)
        if self.motion in codes("G2 G3"):
            letters |= set("IJR")
            turns = values.get("P", 1.0) if self.machine.takes.turns else 1.0
            self.turns = round(min(max(turns, 1.0), MOST_REPEATS))
            if "K" in values and not {"I", "J", "R"} & values.keys():
                values = {**values, "I": 0.0}
        self.k = values.get("K", 0.0)
        return {
            letter: f"{value:.17g}" for letter, value in values.items() if letter in letters
        }

    def _dwell_words(self, values: dict[str, float]) -> dict[str, str]:
        """The time of a dwell, s."""
        if "P" in values:
            return {"P": f"{values['P'] * self.machine.dwell_unit_s:.9f}"}
        seconds = self.machine.takes.one_code and "S" in values  # Marlin: G4 S in s
        return {"P": f"{values['S']:.9f}"} if seconds else {}

    def _see_a_feed(self, kind: str) -> None:
        """Find a motion without a feed; the time goes on with the machine's own."""
        if self.feed_mm_s != 0:
            return
        allowed = "F before it or with it, in units per minute"
        self.findings.here("feed", f"{kind} has no feed", allowed, "give F")
        self.feed_mm_s = self.machine.panel_feed_mm_s

    def _refused(self, fault: ProgramFault) -> None:
        """Find what the reader refuses."""
        what, _, do = str(fault).split(": ", 1)[-1].partition("; ")
        self.findings.here("reading", what, "", do or "mend the line", cause=what)

    def _go(self, values: dict[str, float]) -> None:
        """Go to the place that the words give, from the zero that holds; a missing feed is found once."""
        if self.kind not in ("", RAPID):
            self._see_a_feed(self.kind)
        if any(self.offset) and not self.relative:
            for axis, letter in enumerate("XYZ"):
                if letter in values:
                    values[letter] += self.offset[axis] / self.scale
        super()._go(values)

    def _arc(self, values: dict[str, float], begin: Place, end: Place) -> Move:
        """An arc in any plane; one that is not level becomes lines, of which the last is given back."""
        plane = PLANES[self.plane]
        words = plane.centre_words({**values, "K": self.k})
        if self.absolute_centres and "R" not in values:
            i, j = (mm / self.scale for mm in plane.turned_to(begin)[:2])
            words = {"I": words["I"] - i, "J": words["J"] - j}
        if AXES & values.keys() and not plane.names & values.keys():
            self._lacks_a_place(plane.names)
        sense = 1 if self.kind == COUNTER_CLOCKWISE else -1
        arc = ArcWords(self.kind, sense, words, self.scale, self.arc_limits)
        try:
            centre, turned = arc.arc(plane.turned_to(begin), plane.turned_to(end))
        except WordError as error:
            if not self.lost_at_begin & plane.names:
                self._off_the_arc(error, end)
            return Move(self.number, LINE, end, self.feed_mm_s)
        turned += math.copysign((self.turns - 1) * TURN, turned)
        if self.plane == LEVEL and begin[2] == end[2]:
            return Move(self.number, self.kind, end, self.feed_mm_s, centre, turned)
        *places, _ = plane.chords(begin, end, centre, turned)
        self.moves += [Move(self.number, LINE, place, self.feed_mm_s) for place in places]
        return Move(self.number, LINE, end, self.feed_mm_s)

    def _lacks_a_place(self, names: frozenset[str]) -> None:
        """Find an arc that says no place in its plane, where the control wants one."""
        if not self.machine.takes.lone_motion:
            what, do = f"{self.kind} says no place in its plane", "write it, even if it stays"
            self.findings.here("word", what, " or ".join(sorted(names)), do)

    def _off_the_arc(self, error: WordError, end: Place) -> None:
        """Find an arc whose ends do not lie on it."""
        (what, _, do), allowed, limits = str(error).partition("; "), "", self.arc_limits
        if "may differ" in do:
            share = f"{limits.share:.1%} of the radius up to {limits.most_mm:g} mm"
            allowed = f"{do}: {limits.least_mm:g} mm, or {share}"
            do = "write more decimals, or have the program made anew"
        self.findings.add(
            Finding(self.number, "arc", what, allowed, do or "mend the line", place_mm=end)
        )

    def _in_inverse_time(self, first: int, f: float) -> None:
        """G93: F is one over the minutes of the line."""
        begin = self.moves[first - 1].end_mm if first else (0.0, 0.0, 0.0)
        length_mm = 0.0
        for move in self.moves[first:]:
            length_mm += math.dist(begin, move.end_mm)
            begin = move.end_mm
        for k in range(first, len(self.moves)):
            if self.moves[k].kind != RAPID and length_mm > 0:
                self.moves[k] = self.moves[k]._replace(feed_mm_s=length_mm * f / 60)

    def _set_zero(self, values: dict[str, float]) -> None:
        """G92: the places where the axes stand get other numbers."""
        for axis, letter in enumerate("XYZ"):
            if letter not in values:
                continue
            mm = values[letter] * self.scale
            if self.start[axis] is None:
                self.place[axis] = self.start[axis] = mm
                self.unsent[axis] = len(self.moves)
            else:
                self.offset[axis] = self.place[axis] - mm

    def _go_home(self, present: set[Code], values: dict[str, float]) -> None:
        """G28, G30: by way of the place that is given; then, as G53, to a place of the machine's own."""
        self.findings.remark(
            "not followed",
            "goes to a place of the machine's own, which is not in the program",
            "see that the way there is free; here Z goes up and X and Y stay",
            cause="home",
        )
        given = AXES & values.keys()
        if present & _HOME and given:
            self._obey({("G", 0.0)} | (present & codes("G90 G91")), dict(values))
        else:
            self._obey(present & codes("G0 G1 G90 G91"), {})
        if ("Z" in given or not given) and self.start[2] is not None:
            top = max((move.end_mm[2] for move in self.moves), default=self.place[2])
            self.run(RAPID, {"Z": max(top, self.place[2])})

    def run(self, kind: str, places_mm: dict[str, float]) -> None:
        """Go to places in mm, whatever holds for the program's own."""
        kept = self.kind, self.relative, self.offset
        self.kind, self.relative, self.offset = kind, False, [0.0, 0.0, 0.0]
        self._go({letter: mm / self.scale for letter, mm in places_mm.items()})
        self.kind, self.relative, self.offset = kept


def _only(letter: str, values: dict[str, float]) -> dict[str, float]:
    """One letter of a line with its value; empty if the line does not have it."""
    return {letter: values[letter]} if letter in values else {}
