"""Findings: what is wrong with a program, each with its line, what is allowed, and what to do.

Signals in: what the rules find, line by line. Signals out: findings in the order of the lines; those of one
cause are one finding, with the number of lines and the last of them.
"""

from __future__ import annotations

from collections.abc import Hashable
from dataclasses import dataclass, field, replace

Place = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class Finding:
    """One thing found: `stops` if the program may not be started with it; a place if it has one."""

    line: int
    rule: str  # a word for its kind, such as "arc" or "travel"
    what: str
    allowed: str
    do: str
    stops: bool = True
    place_mm: Place | None = None
    lines: int = 1  # with the same cause
    last_line: int = 0

    @property
    def text(self) -> str:
        """The finding in one line."""
        more = self.lines - 1
        also = f" (and {more} more, to line {self.last_line})" if more else ""
        allowed = f"; allowed: {self.allowed}" if self.allowed else ""
        return f"line {self.line}{also}: {self.what}{allowed}; {self.do}"


@dataclass(slots=True)
class Findings:
    """The findings so far, and the line that is read."""

    line: int = 0
    _found: dict[Hashable, Finding] = field(default_factory=dict)
    _again: dict[Hashable, tuple[int, int]] = field(default_factory=dict)  # lines, the last

    def add(self, finding: Finding, cause: Hashable = None) -> None:
        """Add a finding; another one of the same rule and cause is counted with the first."""
        key = (finding.rule, len(self._found) if cause is None else cause, cause is None)
        first = self._found.setdefault(key, finding)
        lines, last_line = self._again.get(key, (1, first.line))
        if last_line < finding.line:
            lines, last_line = lines + 1, finding.line
        self._again[key] = lines, last_line

    def here(
        self, rule: str, what: str, allowed: str, do: str, *, cause: Hashable = None
    ) -> None:
        """Add a finding at the line that is read, with which the program may not be started."""
        self.add(Finding(self.line, rule, what, allowed, do), cause)

    def remark(self, rule: str, what: str, do: str, *, cause: Hashable = None) -> None:
        """Add a finding at the line that is read which keeps nobody from starting the program."""
        self.add(Finding(self.line, rule, what, "", do, stops=False), cause)

    def in_order(self) -> list[Finding]:
        """All findings, by their lines."""
        found = []
        for key, finding in self._found.items():
            lines, last_line = self._again[key]
            found.append(replace(finding, lines=lines, last_line=last_line))
        return sorted(found, key=lambda each: (each.line, not each.stops))
