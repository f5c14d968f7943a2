"""Rules for the ways of a program: rapids, the tool, the machine's travel, the stock.

Signals in: the steps of a program, the machine, the stock if one is given. Signals out: findings, each at the
line where it begins.

    surface  ────────┐   rapid down here only where the tool has been as deep before (pecks)
                     │
    below    ════════╧════   a rapid across: refused; a line with the tool off: refused

Source: none; these are what breaks tools and spoils work. Questions: how high the tool stands before the
first Z is not in a program. A tool's radius is not known here: the stock is held against the tool's middle.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

from morfax.motion.usual import INCREMENT_MM
from morfax.player.gcode.check.findings import Finding, Findings
from morfax.player.gcode.check.steps import Step, bounds_mm
from morfax.player.gcode.check.words import called
from morfax.recorder.gcode.machine import Machine

_SAME = 3  # decimals of a mm within which a hole is the same hole


@dataclass(frozen=True, slots=True)
class Stock:
    """The material: its size, mm (None: not known), the place of its lower left corner, the Z of its upper
    face, and how far below its lower face the tool may go.
    """

    width_mm: float | None = None
    height_mm: float | None = None
    thickness_mm: float | None = None
    corner_mm: tuple[float, float] = (0.0, 0.0)
    surface_mm: float = 0.0
    through_mm: float = 0.0


class MotionRule(NamedTuple):
    """What a finding says: its kind, what was found, what is allowed, what to do."""

    kind: str
    what: str
    allowed: str
    do: str
    stops: bool = True

    def at(self, step: Step) -> Finding:
        """The finding at a step."""
        texts = self.kind, self.what, self.allowed, self.do
        return Finding(step.move.line, *texts, self.stops, step.move.end_mm)


def check_rapids(steps: Sequence[Step], surface_mm: float, findings: Findings) -> None:
    """Find rapids through the work: below its surface, or with a tool that is in the work without a Z."""
    deepest: dict[tuple[float, float], float] = {}  # Z that the tool has been at, by place
    for step in steps:
        end = step.move.end_mm
        hole = round(end[0], _SAME), round(end[1], _SAME)
        if not step.in_work:
            continue
        if not step.is_rapid:
            deepest[hole] = min(deepest.get(hole, surface_mm), end[2])
        elif step.across:
            findings.add(_THROUGH.at(step), _THROUGH.what)
        elif end[2] < min(step.begin_mm[2], deepest.get(hole, surface_mm) - INCREMENT_MM):
            findings.add(_PLUNGES.at(step), _PLUNGES.what)


_THROUGH = MotionRule(
    "rapid",
    "a rapid (G0) goes through the work, or along its surface",
    "rapids above the work, with the tool up or off",
    "go up first, or make it G1 with a feed",
)
_PLUNGES = MotionRule(
    "rapid",
    "a rapid (G0) plunges into the work",
    "rapids down to above the work, or where the tool has been as deep",
    "stop above the work, and go down with G1 and a feed",
)


def check_tool(steps: Sequence[Step], machine: Machine, findings: Findings) -> None:
    """Find lines with the tool off: below the surface, or, without a Z, wherever lines are no travel."""
    on, off = (
        " or ".join(map(called, sorted(each))) for each in (machine.tool.on, machine.tool.off)
    )
    rule = MotionRule(
        "tool",
        "cuts with the tool off" if machine.z else "a line at feed runs with the tool off",
        f"lines after {on} and before {off}",
        f"put {on} before it, or make it a rapid (G0)",
        machine.z or not machine.tool.travels_at_feed,
    )
    for step in steps:
        if step.moves and not step.is_rapid and not step.on and (step.in_work or not machine.z):
            findings.add(rule.at(step), rule.what)


def check_start(
    steps: Sequence[Step], machine: Machine, before_z: int, findings: Findings
) -> None:
    """Remark on ways across in the first steps, before Z has been sent anywhere, and on nothing cut."""
    across = next((step for step in steps[:before_z] if step.across), None)
    if machine.z and across is not None:
        what = "goes across before Z has been sent up"
        do = "have the tool stand above work and clamps when you start"
        findings.add(MotionRule("start", what, "", do, False).at(across))
    if steps and not any(step.in_work and not step.is_rapid for step in steps):
        what = "nothing is cut: the tool is never in the work"
        do = "check the zero of Z (--surface), and that this is the program's machine"
        findings.add(MotionRule("start", what, "", do, False).at(steps[-1]))


def check_end(steps: Sequence[Step], machine: Machine, findings: Findings) -> None:
    """Find a tool that the end of the program leaves running, or in the work."""
    if not steps:
        return
    last = steps[-1]
    if machine.z and last.in_work and not (last.move.end_mm[2] > last.begin_mm[2]):
        what, do = "the program ends with the tool in the work", "send Z up before the end"
        findings.add(MotionRule("end", what, "", do, False).at(last))


def check_travel(steps: Sequence[Step], machine: Machine, findings: Findings) -> None:
    """Find the line at which the program gets wider than the machine's travel."""
    whole = bounds_mm(steps)
    if machine.travel_mm is None or whole is None:
        return
    for axis, (name, most) in enumerate(zip("XYZ", machine.travel_mm, strict=True)):
        span = whole[1][axis] - whole[0][axis]
        if span <= most + INCREMENT_MM:
            continue
        low = steps[0].begin_mm[axis]
        high = steps[0].begin_mm[axis]
        for step in steps:
            lower, upper = step.bounds_mm()
            low = min(low, lower[axis])
            high = max(high, upper[axis])
            if high - low > most + INCREMENT_MM:
                what = f"the program needs {span:.1f} mm of {name}"
                allowed = f"the machine travels {most:g} mm (travel_mm)"
                do = "make the part smaller, or turn it"
                findings.add(MotionRule("travel", what, allowed, do).at(step))
                break


def check_stock(steps: Sequence[Step], stock: Stock, findings: Findings) -> None:
    """Find work beside the stock, and deeper than it."""
    if stock.width_mm is None or stock.height_mm is None:
        return
    left, bottom = stock.corner_mm
    right, top = left + stock.width_mm, bottom + stock.height_mm
    lowest_mm = stock.surface_mm - (stock.thickness_mm or 0.0) - stock.through_mm
    beside = MotionRule(
        "stock",
        "cuts outside the stock",
        f"X {left:g} to {right:g}, Y {bottom:g} to {top:g} mm",
        "move the zero (--stock-at says where the stock lies), or take a larger piece",
    )
    below = MotionRule(
        "depth",
        "cuts below the stock",
        f"down to Z{lowest_mm:g}",
        "make the depth less, or say how far it may go through (--through)",
    )
    for step in steps:
        if not step.in_work or step.is_rapid:
            continue
        low, high = step.bounds_mm()
        beside_mm = left - low[0], bottom - low[1], high[0] - right, high[1] - top
        if max(beside_mm) > INCREMENT_MM:
            findings.add(beside.at(step), beside.kind)
        if stock.thickness_mm is not None and step.lowest_mm < lowest_mm - INCREMENT_MM:
            findings.add(below.at(step), below.kind)
