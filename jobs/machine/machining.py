"""The machine that a program is for: chosen by its name or file, changed by what somebody sets, and what it
cannot hold of a card.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path as FilePath
from typing import TYPE_CHECKING

from morfax.jobs.media import files as medium
from morfax.jobs.settings.depths import refuse_without_z
from morfax.jobs.wrong_use import WrongUse
from morfax.motion.faults import CardFault

if TYPE_CHECKING:
    from morfax.jobs.listener import Listener
    from morfax.jobs.machine.recording import RecordingUnit
    from morfax.jobs.settings.settings import ToolSettings, TraceSettings
    from morfax.recorder.gcode.machine import Machine
    from morfax.tracer.operator.card import Card, Stop


def chosen(
    name: str | None,
    values: tuple[str, ...] = (),
    rapid_mm_s: float | None = None,
    program: FilePath | None = None,
) -> Machine:
    """The machine of that name or file, or the usual one for the program, with NAME=NUMBER and a rapid set.

    Raises WrongUse for a machine or a value that is not there, CardFault for a mistake in a file.
    """
    from morfax.recorder.gcode.machine import DEFAULT, HPGL, machine

    is_plot = program is not None and medium.is_plot(program)
    try:
        found = machine(name or (HPGL if is_plot else DEFAULT), _numbers(values))
    except CardFault:
        raise
    except ValueError as refused:
        raise WrongUse(f"--machine: {refused}") from None
    if program is not None and found.is_hpgl != is_plot:
        suffixes = medium.PLOTS if found.is_hpgl else medium.BLOCKS
        raise WrongUse(
            f"--machine {found.name} takes {', '.join(suffixes)}; give -o such a name, or another machine"
        )
    if rapid_mm_s is None:
        return found
    return replace(
        found, rapid_mm_s=(rapid_mm_s, rapid_mm_s, min(rapid_mm_s, found.rapid_mm_s[2]))
    )


def _numbers(values: tuple[str, ...]) -> dict[str, float]:
    """Values by their names; raises WrongUse for one without a number."""
    numbers = {}
    for value in values:
        name, _, number = value.partition("=")
        try:
            numbers[name.strip()] = float(number)
        except ValueError:
            raise WrongUse(
                f"--machine-value {value!r} is no NAME=NUMBER; give one such as speed=18000"
            ) from None
    return numbers


def doubtful_feeds(
    machine: Machine, feed_mm_s: float | None, plunge_mm_s: float | None
) -> Iterator[str]:
    """Warnings of feeds that are faster than the machine's rapids: likely mm/min without their unit."""
    limits_mm_s = min(machine.rapid_mm_s[:2]), machine.rapid_mm_s[2]
    for name, asked_mm_s, most_mm_s in zip(
        ("--feed", "--plunge"), (feed_mm_s, plunge_mm_s), limits_mm_s, strict=True
    ):
        if asked_mm_s is not None and asked_mm_s > most_mm_s:
            yield (
                f"{name} is {asked_mm_s:g} mm/s, F{60 * asked_mm_s:.0f}; {machine.name} has rapids of"
                f" {most_mm_s:g} mm/s: a bare number is in mm/s, give mm/min with its unit, such as"
                f" {asked_mm_s:g}mm/min"
            )


def tell_what_is_lost(
    settings: TraceSettings, unit: RecordingUnit, program: FilePath, listener: Listener
) -> None:
    """Warn, before anything moves, of what the card or an option asks for and the medium cannot hold.

    Raises WrongUse for tabs and ramps where there is no Z.
    """
    card, tool = settings.card(), settings.tool
    if medium.has_machine(program):
        machine = unit.chosen(program)
        if machine.z:
            return
        refuse_without_z(card, f"the machine {machine.name}")
        lost = _asked(card, tool, has_dwells=not machine.is_hpgl)
        what = (
            f"{machine.name} has no Z, so {program.name} cannot hold {', '.join(lost)}: each pass runs the "
            "line once more, and a drilled hole is one dot"
        )
    elif program.suffix.lower() in medium.DRAWN:
        refuse_without_z(card, f"a drawing ({program.suffix})")
        lost = _asked(card, tool, has_dwells=False)
        what = (
            f"{program.name} holds only what is cut, without {', '.join(lost)}: set them in the program that"
            " reads it"
        )
    else:
        return
    if lost:
        listener.warning(what)


def _asked(card: Card, tool: ToolSettings, *, has_dwells: bool) -> list[str]:
    """What Z is asked to do, by its names; dwells where the medium has none."""
    stops = card.stops
    drills = [stop.drill for stop in stops if stop.drill is not None]
    deep = tool.depth_mm or card.depths_mm or any(stop.passes_mm for stop in stops)
    asked = {
        "depth": bool(deep or drills or any(stop.moves for stop in stops)),
        "entry": card.entry_mm is not None,
        "passes": card.step_down_mm is not None,
        "pecks": card.peck_mm is not None
        or any(drill.peck_counts < drill.depth_counts for drill in drills),
        "feed of Z": card.feed_mm_s is not None,
        "dwells": not has_dwells and any(map(_dwells, stops)),
    }
    return [name for name, is_asked in asked.items() if is_asked]


def _dwells(stop: Stop) -> bool:
    """Whether the card asks for a wait at a stop."""
    waits_s = [stop.dwell_s, *(move.dwell_s for move in stop.moves)]
    return any(waits_s) or (stop.drill is not None and stop.drill.dwell_s > 0)
