"""Settings of cutting in Z: passes by a step, ramps, holding tabs, pecks, and the speed above the work."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from morfax.jobs.wrong_use import WrongUse

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path as FilePath

    from morfax.tracer.operator.card import Card, Stop
    from morfax.tracer.operator.work import Tabs, Work
    from morfax.tracer.program.program import Trace


@dataclass(frozen=True, slots=True)
class DepthSettings:
    """What is asked of Z along the lines and in holes; None leaves it to the card."""

    step_down_mm: float | None = None
    ramp_rad: float | None = None
    tabs: int | None = None  # on each closed line; 0: none, whatever the card says
    tab_width_mm: float | None = None
    tab_height_mm: float | None = None
    peck_mm: float | None = None
    rapid_mm_s: float | None = None

    def on(self, card: Card) -> Card:
        """The card with what is asked for in its place; raises WrongUse for tabs of no number."""
        changes: dict[str, object] = {"tabs": self._tabs(card.tabs)}
        if self.step_down_mm is not None:
            changes["step_down_mm"] = self.step_down_mm
        if self.ramp_rad is not None:
            changes |= {"ramp_rad": self.ramp_rad, "entry_mm": None}
        if self.peck_mm is not None:
            stops = tuple(_pecked(stop, self.peck_mm) for stop in card.stops)
            changes |= {"peck_mm": self.peck_mm, "stops": stops}
        if self.rapid_mm_s is not None:
            changes["rapid_mm_s"] = self.rapid_mm_s
        return replace(card, **changes)  # type: ignore[arg-type]

    def _tabs(self, of_card: Tabs | None) -> Tabs | None:
        """The tabs that are asked for, or else the card's."""
        from morfax.tracer.operator.work import Tabs

        if self.tabs == 0:
            return None
        if self.tabs is None and of_card is None:
            if self.tab_width_mm is not None or self.tab_height_mm is not None:
                name = "--tab-width" if self.tab_width_mm is not None else "--tab-height"
                raise WrongUse(
                    f"{name} is for holding tabs; give how many with --tabs, such as 4"
                )
            return None
        tabs = of_card or Tabs(self.tabs or 0)
        return Tabs(
            tabs.count if self.tabs is None else self.tabs,
            self.tab_width_mm or tabs.width_mm,
            self.tab_height_mm or tabs.height_mm,
        )


def passes_mm(card: Card, depth_mm: float) -> tuple[float, ...]:
    """Depths of the passes before the last, mm: the card's above the depth, or equal ones by its step.

    Raises WrongUse where the card's passes are not those of the step.
    """
    of_card = tuple(pass_mm for pass_mm in card.depths_mm if pass_mm < depth_mm)
    if card.step_down_mm is None:
        return of_card
    equal = equal_passes_mm(depth_mm, card.step_down_mm)
    if len(card.depths_mm) > 1 and of_card != equal:
        listed = ", ".join(f"{pass_mm:g}" for pass_mm in card.depths_mm)
        raise WrongUse(
            f"the card has passes of {listed} mm, and --step-down {card.step_down_mm:g}mm asks for other"
            " ones; leave out one of them"
        )
    return equal


def equal_passes_mm(depth_mm: float, step_down_mm: float) -> tuple[float, ...]:
    """Equal passes to a depth, none higher than a step and each a whole count of Z; without the last, mm."""
    from morfax.tracer.operator.zunit import COUNTS_PER_MM

    depth, step = round(depth_mm * COUNTS_PER_MM), round(step_down_mm * COUNTS_PER_MM)
    passes = max(1, -(-depth // step))
    return tuple(
        (2 * depth * k + passes) // (2 * passes) / COUNTS_PER_MM for k in range(1, passes)
    )


def _pecked(stop: Stop, peck_mm: float) -> Stop:
    """A stop of the card whose hole is drilled in these pecks."""
    from morfax.tracer.operator.zunit import COUNTS_PER_MM

    if stop.drill is None:
        return stop
    peck = min(round(peck_mm * COUNTS_PER_MM), stop.drill.depth_counts)
    return replace(stop, drill=replace(stop.drill, peck_counts=peck))


def without_z(work: Work, program: FilePath | None, machine_name: str | None) -> str | None:
    """A remark on several passes where the medium has no Z; raises WrongUse for tabs or ramps there."""
    medium = _without_z(program, machine_name)
    asked = [name for name, value in (("tabs", work.tabs), ("ramps", work.ramp_rad)) if value]
    if medium is None:
        return None
    if asked:
        raise WrongUse(
            f"{' and '.join(asked)} need a Z axis, and {medium} has none; leave out"
            f" {' and '.join('--' + name.replace('ramps', 'ramp') for name in asked)}, or what the card says"
            " of them"
        )
    passes = len(work.depths_mm)
    if passes > 1:
        return f"{medium} has no Z: each line is run {passes} times at one height"
    return None


def of_tabs(trace: Trace) -> Iterator[str]:
    """A remark on lines inside others that have fewer tabs than asked for, or none."""
    asked = trace.work.tabs
    if asked is None:
        return
    fewer = [
        (line.number, len(tabs))
        for line, tabs in zip(trace.lines, trace.tabs, strict=True)
        if line.comes_round and len(tabs) < asked.count
    ]
    if fewer:
        listed = ", ".join(f"line {number} has {count or 'none'}" for number, count in fewer)
        yield (
            f"there is no room for {asked.count} tabs inside the part: {listed}; what is cut out there may"
            " come loose"
        )
    if not any(trace.tabs):
        yield "no line that is cut comes round: there is nothing to hold, and no tab"


def _without_z(program: FilePath | None, machine_name: str | None) -> str | None:
    """What a medium without Z is called; None if it has one."""
    from morfax.jobs import files
    from morfax.recorder.gcode.machine import DEFAULT, machine
    from morfax.recorder.media import DRAWINGS

    if program is None:
        return None
    if program.suffix.lower() in DRAWINGS:
        return f"a drawing ({program.suffix})"
    if files.is_gcode(program) and not machine(machine_name or DEFAULT).z:
        return f"the machine {machine_name}"
    return None
