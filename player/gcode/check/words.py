"""Rules for the words of a line: taken or not, one of each group, each with the word that it belongs to.

Signals in: the words of a line, and the motion that holds from the lines before. Signals out: findings.

Source: LinuxCNC 2.9, interp_array.cc (modal groups), interp_check.cc (check_other_codes: which words a
letter belongs to); Grbl 1.1, gcode.c, gc_execute_line, steps 2 and 3 (groups, repeated and unused words,
values below zero). Questions: the groups are LinuxCNC's; what Grbl alone refuses beside a motion is `alone`
in its data.
"""

from __future__ import annotations

import math

from morfax.player.gcode.check.findings import Findings
from morfax.player.gcode.check.lines import Words
from morfax.recorder.gcode.machine import Machine
from morfax.recorder.gcode.takes import Code, codes

AXES = frozenset("XYZABCUVW")
MOTIONS = codes("G0-G3 G5 G5.1 G5.2 G33 G33.1 G38.2 G38.3 G38.4 G38.5 G70-G74 G76 G81-G89")
GROUPS: dict[str, frozenset[Code]] = {
    "motion": MOTIONS,
    "plane": codes("G17-G19 G17.1 G18.1 G19.1"),
    "distance mode": codes("G90 G91"),
    "arc distance mode": codes("G90.1 G91.1"),
    "feed mode": codes("G93-G95"),
    "units": codes("G20 G21"),
    "cutter compensation": codes("G40-G42 G41.1 G42.1"),
    "tool length": codes("G43 G43.1 G43.2 G49"),
    "return mode": codes("G98 G99"),
    "coordinate system": codes("G54-G59 G59.1 G59.2 G59.3"),
    "path control": codes("G61 G61.1 G64"),
    "spindle mode": codes("G96 G97"),
    "words for one line": codes("G4 G10 G28 G28.1 G30 G30.1 G52 G53 G92"),
    "stop": codes("M0-M2 M30 M60 M99"),
    "tool change": codes("M6 M61"),
    "spindle": codes("M3-M5 M19"),
    "coolant": codes("M7-M9"),
    "overrides": codes("M48-M53"),
}
GROUP_OF = {code: name for name, members in GROUPS.items() for code in members}
ARCS, PROBES = codes("G2 G3"), codes("G38.2 G38.3 G38.4 G38.5")
CYCLES = codes("G73 G76 G81-G89")
USERS = codes("M100-M199")  # commands of the user's own
# the words that a letter belongs to: one of them must be in the line, or hold from before
BELONGS: dict[str, frozenset[Code]] = {
    "I": ARCS | codes("G5 G5.1 G10 G33.1 G70-G72 G76 G87"),
    "J": ARCS | codes("G5 G5.1 G10 G76 G87"),
    "K": ARCS | codes("G33 G33.1 G76 G87"),
    "R": ARCS | CYCLES | codes("G10 G70-G72"),
    "P": USERS
    | codes("G4 G5 G5.2 G10 G64 G70 G74 G76 G82 G84 G86 G88 G89 M19 M50-M53 M62-M66 M98"),
    "Q": USERS | codes("G5 G10 G64 G70-G73 G76 G83 M19 M61 M66-M68"),
    "L": CYCLES | codes("G5.2 G10 G41 G42 M66 M98"),
    "D": codes("G41 G42 G41.1 G42.1 G70-G73 G83 G96"),
    "H": codes("G43 G43.2 G76"),
    "E": codes("G33 G33.1 G70 G76 M66-M68"),
}
_NEVER_BELOW_ZERO = "FNPST"


class WordRules:
    """The rules for words of one machine."""

    def __init__(self, machine: Machine, findings: Findings) -> None:
        self.machine, self.takes, self.findings = machine, machine.takes, findings
        self.places = frozenset("XYZIJKR") & set(self.takes.letters)  # may have any value
        self.belongs = dict(BELONGS)
        if self.takes.turns:
            self.belongs["P"] = BELONGS["P"] | ARCS

    def check(self, words: Words, motion: Code | None) -> list[Code]:
        """Find what is wrong with the words of a line; the G and M words that the control takes."""
        named, others = self._sorted(words)
        is_users = not USERS.isdisjoint(named)
        for letter, number in others:
            if letter not in self.places or len(number) > self.takes.digits:
                self._letter(letter, number, is_users)
        is_repeated = len(dict(others)) < len(others)
        if len(named) > 1 or self.takes.one_code or is_repeated:
            self._groups(words, named)
        if named:
            self._beside_a_motion(words, named)
        if not self.takes.one_code:
            self._belongs(words, {*named, *([motion] if motion else [])})
        return named

    def _sorted(self, words: Words) -> tuple[list[Code], list[tuple[str, str]]]:
        """The G and M words that the control takes, and the other letters; what it does not take is found."""
        named: list[Code] = []
        others: list[tuple[str, str]] = []
        for letter, number in zip(words.letters, words.numbers, strict=True):
            if letter not in "GM":
                others.append((letter, number))
            elif (code := (letter, abs(float(number)))) in self.takes.codes:
                named.append(code)
            else:
                self._not_taken(called(code), listed(self.takes.codes, letter))
        return named, others

    def _letter(self, letter: str, number: str, is_users: bool) -> None:
        """Find a letter that the control does not take, or a value that it may not have."""
        if letter not in self.takes.letters:
            allowed = f"letters: G M {' '.join(self.takes.letters)}"
            self._not_taken(letter + number, allowed, letter)
        elif letter in _NEVER_BELOW_ZERO and float(number) < 0 and not is_users:
            self.findings.here(
                "word", f"{letter}{number} is below zero", "from 0", "give another value"
            )
        elif float(number) > (most := self._largest(letter)):
            what, allowed = f"{letter}{number} is too large", f"up to {letter}{most:.0f}"
            self.findings.here("word", what, allowed, "leave it out", cause=letter + "large")
        digits = sum(map(str.isdigit, number.lstrip("-+0.")))
        if digits > self.takes.digits:
            what = (
                f"{letter}{number} has {digits} digits; the control keeps {self.takes.digits}"
            )
            self.findings.remark("word", what, "write fewer decimals", cause="digits")

    def _largest(self, letter: str) -> float:
        """The largest number of a line or a tool."""
        most = {"N": self.takes.largest_line_number, "T": self.takes.largest_tool}
        return most.get(letter, math.inf)

    def _not_taken(self, word: str, allowed: str, cause: str = "") -> None:
        """Say that the control does not take a word; those of one letter, or of one code, are one finding."""
        what = f"{self.machine.name} does not take {word}"
        do = "leave it out, or write the program for this machine"
        self.findings.here("word", what, allowed, do, cause=cause or word)

    def _groups(self, words: Words, named: list[Code]) -> None:
        """Find two words of one group, or one letter twice."""
        seen: set[str] = set()
        groups = [GROUP_OF.get(code, "") for code in named]
        for name in groups + [letter for letter in words.letters if letter not in "GM"]:
            if name and name in seen:
                what = f"has two words for {name}"
                self.findings.here("group", what, "one in a line", "make two lines of it")
            seen.add(name)
        if self.takes.one_code and len(named) > 1:
            what = f"has {len(named)} commands, {' '.join(map(called, named))}"
            self.findings.here("group", what, "one in a line", "give each a line", cause="one")
        if self.takes.one_code and not named and set(words.letters) & set("XYZIJF"):
            what = "begins with no G or M, and the control keeps none from the line before"
            self.findings.here("group", what, "G1 X5, not X5", "begin it with G", cause="no G")

    def _beside_a_motion(self, words: Words, named: list[Code]) -> None:
        """Find what may not stand beside a motion, or not without places."""
        motions = [code for code in named if code in MOTIONS]
        lonely = [code for code in named if code in self.takes.alone]
        if lonely and motions:
            what = f"{called(lonely[0])} stands beside {called(motions[0])}"
            self.findings.here("group", what, "one of them in a line", "give each a line")
        if ("G", 53.0) in named and motions and motions[0][1] > 1:
            what = f"G53 stands beside {called(motions[0])}"
            self.findings.here("group", what, "G0 or G1", "go there by G0 or G1")
        self._without_places(words, named)

    def _without_places(self, words: Words, named: list[Code]) -> None:
        """Find what may not stand without places."""
        letters = set(words.letters) | words.computed
        needing = codes("G52 G92") | PROBES
        if not self.takes.lone_motion:
            needing |= ARCS | codes("G10")
        for code in needing.intersection(named) if not letters & AXES else ():
            what = f"{called(code)} stands without a place"
            self.findings.here("word", what, "X, Y or Z", "write the place, even if it stays")
        if ("G", 10.0) in named and not letters >= {"L", "P"} and not self.takes.one_code:
            self.findings.here(
                "word", "G10 stands without L or P", "both", "write G10 L2 P1 X0"
            )

    def _belongs(self, words: Words, present: set[Code]) -> None:
        """Find words that no word of the line uses."""
        for letter in self.belongs.keys() & set(words.letters) & set(self.takes.letters):
            users = self.belongs[letter]
            if users.isdisjoint(present):
                self.findings.here(
                    "word",
                    f"{letter} belongs to no word of the line",
                    f"it belongs to {listed(users & self.takes.codes)}",
                    "take it out",
                    cause=letter,
                )


def called(code: Code) -> str:
    """A word as it is written: G38.2."""
    return f"{code[0]}{code[1]:g}"


def listed(many: frozenset[Code], letters: str = "GM") -> str:
    """Words with some letters in their order, runs of them from to: "G0 to G4 G10"."""
    runs: list[list[Code]] = []
    for code in sorted(code for code in many if code[0] in letters):
        if runs and runs[-1][-1] == (code[0], code[1] - 1):
            runs[-1].append(code)
        else:
            runs.append([code])
    return " ".join(
        f"{called(run[0])} to {called(run[-1])}" if len(run) > 2 else " ".join(map(called, run))
        for run in runs
    )
