"""Lines of a program as a control takes them in: length, characters, comments, %; and the words left.

Signals in: lines of text. Signals out: the words of each line by letter and number, and findings.

Source: Grbl 1.1, protocol.c (protocol_main_loop: blanks, comments and / are dropped before the line is
counted; % is no word), serial.c (characters that are obeyed wherever they stand); LinuxCNC 2.9,
interp_read.cc (read_text, close_and_downcase); Marlin 2, queue.cpp. Questions: a line that an operator can
switch off (/) is read as if it was on.
"""

from __future__ import annotations

import re
from typing import NamedTuple

from morfax.motion.faults import SHOWN
from morfax.player.gcode.check.findings import Findings
from morfax.player.gcode.gcode_text import PROGRAM_NUMBER, WORD
from morfax.recorder.gcode.machine import Machine

_COMMENT = re.compile(r"\(([^)]*)(\)|$)|;.*")
_NUMBER = re.compile(r"^N[\d.]+")  # of a line
_O_WORD = re.compile(r"O[\d<\[]")
_SPINDLE = re.compile(r"\$-?[\d.]+")
_CHECKSUM = re.compile(r"\*\d+$")
_MESSAGE = re.compile(r"\s*(N\d+\s*)?M11[78]\b")  # Marlin: the rest of the line is text
# a letter, and a parameter or an expression for its value: X#1, X-[#1+2], XSIN[30]
_COMPUTED = re.compile(
    r"([A-Z@^])[-+]?(?:ABS|ACOS|ASIN|ATAN|COS|EXP|FIX|FUP|LN|ROUND|SIN|SQRT|TAN|EXISTS)?[#\[]"
)
_POLAR = re.compile(r"[@^][-+\d.]+")
LONGEST_READ = 1 << 16  # characters of a line: 256 times what any control here reads
_MOVES = frozenset("XYZIJKRABCUVW")


class Words(NamedTuple):
    """The words of a line; `computed` are letters whose value is a parameter or an expression."""

    letters: list[str]
    numbers: list[str]
    computed: frozenset[str] = frozenset()


class ControlInput:
    """Lines as the machine's control takes them in."""

    def __init__(self, machine: Machine, findings: Findings) -> None:
        self.machine, self.takes, self.findings = machine, machine.takes, findings
        self.begun = self.between_percents = self.ended = self.has_words = False

    def words(self, raw: str) -> Words | None:
        """The words of a line; None for a line without any, or one that cannot be read."""
        self._characters(raw)
        if self.takes.one_code and _MESSAGE.match(raw):
            return None
        text = self._without_comments(raw)
        compact = "".join(text.split()).lstrip("/")
        self._length(raw, compact)
        if compact == "%":
            self._percent()
            return None
        if not compact:
            return None
        self.begun = True
        if len(compact) > max(LONGEST_READ, self.machine.longest_line):
            return None  # found as too long
        if text.lstrip().startswith("/"):
            self.findings.remark(
                "switch",
                "the line begins with /, and runs or not as a switch of the control stands",
                "check the switch; here the line is read as if it runs",
                cause="/",
            )
        return self._split(self._capitals(compact))

    def _characters(self, raw: str) -> None:
        """Find characters that the control obeys at once, comments included."""
        if not self.takes.not_sent:
            return
        obeyed = [c for c in raw if c in self.takes.not_sent or c > "\x7f"]
        if obeyed:
            self.findings.here(
                "character",
                f"holds {obeyed[0]!r}, which the control obeys at once, even in a comment",
                f"plain letters, digits and signs without {' '.join(self.takes.not_sent)}",
                "take it out",
                cause=obeyed[0],
            )

    def _without_comments(self, raw: str) -> str:
        """The line without its comments."""
        if "(" not in raw and ";" not in raw:
            return raw
        for found in _COMMENT.finditer(raw):
            inside, closed = found[1], found[2]
            if inside is None:
                continue
            if not self.takes.parentheses:
                allowed, do = "a comment after a semicolon", "write it so"
                self.findings.here("comment", "has a comment in ( )", allowed, do, cause="( )")
            elif not closed:
                allowed = "a comment ends with ) in its own line"
                self.findings.here("comment", "has a ( without its )", allowed, "close it")
            elif "(" in inside and not self.takes.nested:
                allowed = "no ( may stand in a comment"
                self.findings.here("comment", "has a ( in a comment", allowed, "take it out")
        return _COMMENT.sub("", raw)

    def _length(self, raw: str, compact: str) -> None:
        """Find a line that the control's buffer does not hold."""
        only_words = self.takes.length_of == "words"
        length = len(compact if only_words else raw)
        if length > self.machine.longest_line:
            of = ", blanks and comments not counted" if only_words else ""
            self.findings.here(
                "length",
                f"has {length} characters{of}",
                f"the control reads {self.machine.longest_line}",
                "make two lines of it",
                cause="length",
            )

    def _percent(self) -> None:
        """% begins a program, and ends one that it began."""
        if not self.takes.percent:
            self.findings.here(
                "word",
                "% is no line of this control",
                "lines are words such as G1 X5, or comments",
                "take it out (many senders do)",
                cause="%",
            )
        elif not self.begun:
            self.between_percents = True
        elif self.between_percents:
            self.ended = True
        else:
            self.findings.here(
                "word",
                "% ends a program that no % began",
                "both, or none",
                "put % before the first line, or end with M2",
            )
        self.begun = True

    def _capitals(self, compact: str) -> str:
        """The line in capitals."""
        capitals = compact.upper()
        if capitals != compact and not self.takes.small_letters:
            self.findings.here(
                "word",
                "has words in small letters",
                "this control takes capitals",
                "write them in capitals",
                cause="small",
            )
        return _CHECKSUM.sub("", capitals) if self.takes.one_code else capitals

    def _split(self, compact: str) -> Words | None:
        """The words of a line without blanks, in capitals."""
        computed: frozenset[str] = frozenset()
        if self.takes.expressions:
            rest = _NUMBER.sub("", compact)
            if rest[:1] == "#":  # a value is set; nothing moves
                return None
            if not self.has_words and PROGRAM_NUMBER.fullmatch(compact):
                return None
            if _O_WORD.match(rest):
                self._not_computed("is a subroutine, a loop or a condition (O)")
                return None
            compact, computed = without_computed(compact)
        if "$" in self.takes.letters:
            compact = _SPINDLE.sub("", compact)
        if "@" in self.takes.letters and (_POLAR.search(compact) or computed & {"@", "^"}):
            compact, computed = _POLAR.sub("", compact), computed | {"X", "Y"}
        parts = WORD.split(compact)
        for between in filter(None, parts[::3]):
            self.findings.here(
                "word",
                f"{between[:SHOWN]!r} is no word",
                "words are a letter and a number such as X5 or Y-0.25",
                "take it out",
            )
        if computed & _MOVES:
            self._not_computed(f"has a computed {' and '.join(sorted(computed & _MOVES))}")
        self.has_words = True
        return Words(parts[1::3], parts[2::3], computed)

    def _not_computed(self, what: str) -> None:
        """Say that a line is not read, as its values are not known."""
        self.findings.here(
            "not read",
            f"{what}, and nothing is computed here",
            "places are read as plain numbers",
            "have the program written out in numbers, or check it on the control itself",
            cause="computed",
        )


def without_computed(compact: str) -> tuple[str, frozenset[str]]:
    """A line without the words whose value is a parameter or an expression, and the letters of these."""
    left, letters, at = "", set(), 0
    while found := _COMPUTED.search(compact, at):
        left += compact[at : found.start()]
        letters.add(found[1])
        at = _end_of_value(compact, found.end() - 1)
    return left + compact[at:], frozenset(letters)


def _end_of_value(compact: str, at: int) -> int:
    """Where a parameter or an expression that begins here ends."""
    while at < len(compact) and compact[at] in "#+-":
        at += 1
    closing = {"[": "]", "<": ">"}.get(compact[at : at + 1])
    if closing is None:
        while at < len(compact) and compact[at].isdigit():
            at += 1
        return at
    depth, opening = 0, compact[at]
    for place in range(at, len(compact)):
        depth += (compact[place] == opening) - (compact[place] == closing)
        if depth == 0:
            is_atan = compact[place + 1 : place + 3] == "/["  # ATAN[..]/[..]
            return _end_of_value(compact, place + 2) if is_atan else place + 1
    return len(compact)
