"""What is not followed: words that the control takes, and whose effect the check does not work out.

Signals in: the words of a line. Signals out: findings; whether the place after the line is known.

Source: NIST RS274/NGC interpreter, version 3, section 3.5. Questions: a zero that is moved by G10, G52 or G55
leaves the places as the program writes them, so that travel and stock are held to those.
"""

from __future__ import annotations

from morfax.player.gcode.check.findings import Findings
from morfax.player.gcode.check.words import CYCLES, MOTIONS, PROBES, called
from morfax.recorder.gcode.takes import Code, codes

# zeros that are moved, a cutter's compensation, speeds by the turn, commands of the user's own
_NOT_FOLLOWED = codes(
    "G10 G52 G55-G59 G59.1 G59.2 G59.3 G41 G42 G41.1 G42.1 G95 G96 M100-M105 M108-M199"
)
_NOT_READ = (MOTIONS - codes("G0-G3") - CYCLES - PROBES) | codes("M98 M99")


def found(present: set[Code], findings: Findings) -> bool:
    """Find words whose effect is not in the moves; whether one of them goes to a place that is not known."""
    for code in present & (_NOT_FOLLOWED | PROBES):
        findings.remark(
            "not followed",
            f"{called(code)} is taken, but its effect is not followed here",
            "places and time are as if it were not there",
            cause=code,
        )
    for code in present & _NOT_READ:
        findings.here(
            "not read",
            f"{called(code)} is a curve, a thread or a subroutine, which are not followed here",
            "lines, arcs and canned cycles are",
            "have it written as lines, or check it on the control itself",
            cause=code,
        )
    return not present.isdisjoint(_NOT_READ)
