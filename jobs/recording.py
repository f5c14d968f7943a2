"""The recording unit: options of the pick-ups, and of how the motion is placed before it is recorded."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

import click

from morfax.console.options.types import ANGLE, NUMBER, PLACE
from morfax.console.terminal.desk import Desk
from morfax.jobs import files as medium

if TYPE_CHECKING:
    from morfax.motion.motion import Motion
    from morfax.motion.placement import Placement
    from morfax.recorder.media import Report
    from morfax.recorder.tape.tape import TapeFormat

PICK_UPS = (
    "resolver",
    "photocell",
    "coil",
    "hall",
    "scale",
)  # recorder.pickups; the first is the default


@dataclass(frozen=True, slots=True)
class Unit:
    """What the operator sets for the recording: the pick-up (None: not given) and the placement."""

    pickup: str | None
    placement: Placement

    def at(self, origin_mm: tuple[float, float]) -> Unit:
        """The same with the machine's zero at a place."""
        return replace(self, placement=replace(self.placement, origin_mm=origin_mm))

    def check(self, program: FilePath | None) -> None:
        """Raise UsageError where the pick-up is for another medium than the program's."""
        if self.pickup is not None and (
            program is None or program.suffix.lower() not in medium.TAPES
        ):
            raise click.UsageError(
                f"--pickup is for tapes, {', '.join(medium.TAPES)}; give -o such a name, or leave it out"
            )

    def warn(self, desk: Desk) -> None:
        """Say what the placement does to the cutter and the speed."""
        scale = self.placement.scale
        if scale != 1:
            desk.note(
                f"scaled by {scale:g}: the cutter's radius that the line allows for is scaled too, so the cutter must be "
                f"{scale:g} times as thick; X and Y run {scale:g} times as fast; Z is not scaled"
            )

    def record(self, stream: Iterable[Motion], file: FilePath, desk: Desk) -> Report:
        """Record a motion, placed, in the medium that the name says; what a tape's player would refuse is
        refused.
        """
        from morfax.recorder.media import record

        placed = self.placement.stream(stream)
        if file.suffix.lower() not in medium.TAPES:
            return record(placed, file)
        fmt = self.tape_format()
        return record(rehearsed(placed, fmt, desk), file, fmt=fmt)

    def tape_format(self, cycles_per_mm: float | None = None, **entries: Any) -> TapeFormat:
        """The format of a tape with this pick-up; raises ValueError if there is none such."""
        from morfax.recorder.tape import pickups
        from morfax.recorder.tape.tape import TapeFormat

        pickup = self.pickup or pickups.DEFAULT_PICK_UP
        own = pickups.PICK_UPS[pickup].cycles_per_mm
        return TapeFormat(
            pickup=pickup,
            cycles_per_mm=own if cycles_per_mm is None else cycles_per_mm,
            **entries,
        )

    def figures(self) -> dict[str, Any]:
        """What was set, where it was."""
        placement = self.placement
        return {
            "pickup": self.pickup,
            "mirrored": placement.mirror.upper() or None,
            "scale": None if placement.scale == 1 else placement.scale,
            "turned_deg": round(math.degrees(placement.turn_rad), 9) or None,
        }


def rehearsed(stream: Iterable[Motion], fmt: TapeFormat, desk: Desk) -> Iterator[Motion]:
    """Pass a motion on to its tape; raises MotionFault where no player could read that, and notes where a
    drive could not follow.
    """
    from morfax.player.tape.rehearsal import Rehearsal

    rehearsal = Rehearsal(fmt)
    yield from rehearsal.of(stream)
    lost = rehearsal.unfollowed
    if lost is not None:
        place = ",".join(f"{mm:.2f}" for mm in lost.place_mm[:2])
        desk.note(
            f"the drive of {lost.axis.upper()} would lose its lock at {place} mm, {lost.time_s:.3f} s into the motion: play the "
            "tape slower (--feed-override 50%), or run the path slower"
        )


def unit_options(verb: Callable[..., Any]) -> Callable[..., Any]:
    """Give a verb the options of the recording unit, and hand it the `unit`."""

    @click.option(
        "--pickup",
        type=click.Choice(PICK_UPS),
        help=f"What makes the tracks of a tape: its wave and its travel per cycle, see docs/reference/tape-format.md.  "
        f"[default: {PICK_UPS[0]}]",
    )
    @click.option(
        "--mirror",
        type=click.Choice(["x", "y"]),
        default=None,
        help="Have X, or Y, run the other way.",
    )
    @click.option(
        "--scale",
        type=NUMBER,
        default=1.0,
        show_default=True,
        help="Make X and Y so many times as large; the cutter's radius goes along, Z does not.",
    )
    @click.option(
        "--turn",
        "turn_rad",
        type=ANGLE,
        default="0deg",
        show_default=True,
        help="Turn X and Y, counter-clockwise, such as 90deg.",
    )
    @click.option(
        "--about",
        "about_mm",
        type=PLACE,
        help="The place X,Y in mm that mirror, scale and turn leave where it is.  [default: the start of the program]",
    )
    @functools.wraps(verb)
    def with_unit(
        *args: Any,
        pickup: str | None,
        mirror: str | None,
        scale: float,
        turn_rad: float,
        about_mm: tuple[float, float] | None,
        **options: Any,
    ) -> Any:
        from morfax.motion.placement import Placement

        return verb(
            *args,
            unit=Unit(pickup, Placement(mirror or "", scale, turn_rad, about_mm)),
            **options,
        )

    return with_unit
