"""Settings of cutting in Z: passes by a step, ramps, holding tabs and pecks."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from morfax.jobs.wrong_use import WrongUse

if TYPE_CHECKING:
    from collections.abc import Iterator

    from morfax.tracer.operator.card import Card, Stop
    from morfax.tracer.operator.work import Tabs
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
        return replace(card, **changes)  # type: ignore[arg-type]

    def _tabs(self, of_card: Tabs | None) -> Tabs | None:
        """The tabs that are asked for, or else the card's."""
        from morfax.tracer.operator.work import Tabs

        if self.tabs == 0:
            return None
        if self.tabs is None and of_card is None:
            self._refuse_sizes_of_tabs()
            return None
        tabs = of_card or Tabs(self.tabs or 0)
        return Tabs(
            tabs.count if self.tabs is None else self.tabs,
            self.tab_width_mm or tabs.width_mm,
            self.tab_height_mm or tabs.height_mm,
        )

    def _refuse_sizes_of_tabs(self) -> None:
        """Raise WrongUse for a size of tabs, where there are none."""
        sizes = {"--tab-width": self.tab_width_mm, "--tab-height": self.tab_height_mm}
        for name, size_mm in sizes.items():
            if size_mm is not None:
                raise WrongUse(
                    f"{name} is for holding tabs; give how many with --tabs, such as 4"
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

    depth = round(depth_mm * COUNTS_PER_MM)
    step = round(step_down_mm * COUNTS_PER_MM)
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


def refuse_without_z(card: Card, medium: str) -> None:
    """Raise WrongUse for tabs or a ramp on a medium that has no Z, by its name."""
    asked = [("tabs", card.tabs), ("a ramp", card.ramp_rad)]
    names = [name for name, value in asked if value]
    if names:
        need = "needs" if names == ["a ramp"] else "need"
        raise WrongUse(
            f"{' and '.join(names)} {need} a Z axis, and {medium} has none; leave out --tabs and --ramp,"
            " or their entries on the card"
        )


def of_tabs(trace: Trace) -> Iterator[str]:
    """A remark on lines inside others that have fewer tabs than asked for, or none."""
    from morfax.motion.plane import CORNER_RAD
    from morfax.tracer.program.passes.tabs import FELT_MM, is_milled_away

    asked = trace.work.tabs
    if asked is None:
        return
    fewer = [
        (line.number, len(tabs))
        for line, tabs in zip(trace.lines, trace.tabs, strict=True)
        if line.comes_round and len(tabs) < asked.count
        if not is_milled_away(line, trace.work.cutter_mm)
    ]
    if fewer:
        listed = ", ".join(f"line {number} has {count or 'none'}" for number, count in fewer)
        yield (
            f"there is no room for {asked.count} tabs inside the part: {listed}; what is cut out there may"
            " come loose: hold it down in another way (tabs stand where a line bends by a radius of"
            f" {2 * FELT_MM / CORNER_RAD:.0f} mm or more)"
        )
    if not any(trace.tabs):
        yield (
            "no line that is cut is closed: there are no tabs; close the part's outline on the drawing, or "
            "leave --tabs out"
        )
