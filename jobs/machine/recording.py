"""The recording unit: how the motion is placed, and how the medium is written: pick-ups, machine, feeds."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

from morfax.jobs.machine import machining
from morfax.jobs.media import files as medium
from morfax.jobs.settings import scaled
from morfax.jobs.wrong_use import WrongUse, settings_checked

if TYPE_CHECKING:
    from morfax.jobs.listener import Listener
    from morfax.jobs.settings.settings import TraceSettings
    from morfax.motion.motion import Motion
    from morfax.motion.placement import Placement
    from morfax.recorder.gcode.machine import Machine, UsualLines
    from morfax.recorder.gcode.made import Made
    from morfax.recorder.media import Report
    from morfax.recorder.tape.tape import TapeFormat
    from morfax.tracer.cutter.contouring import Milling

# recorder.tape.pickups; the first is the default
PICK_UPS = ("resolver", "photocell", "coil", "hall", "scale")


@dataclass(frozen=True, slots=True)
class RecordingUnit:
    """What somebody sets for the recording: how the motion is placed, and how the medium is written.

    None is not set: the medium's own pick-up or machine, the motion's own feeds.
    """

    pickup: str | None = None
    plain: bool = False  # a tape of bare tracks, without a check signal
    machine: str | None = None  # name of a built-in one, or a .toml file
    feed_mm_s: float | None = None  # of the cut
    plunge_mm_s: float | None = None  # of Z into the work
    rapid_mm_s: float | None = None  # above the work; None: the machine's
    machine_values: tuple[str, ...] = ()  # NAME=NUMBER, in the place of the machine's own
    # how far a program may be from the path; None: the medium's own
    fit_tolerance_mm: float | None = None
    lines_only: bool = False  # no arcs
    mirror: str = ""  # the axis that runs the other way, x or y
    scale: float = 1.0
    turn_rad: float = 0.0
    about_mm: tuple[float, float] | None = None  # None: the start of the motion
    origin_mm: tuple[float, float] = (0.0, 0.0)
    made: Made | None = None  # what the head of a program says of its origin

    @property
    def placement(self) -> Placement:
        """How the motion is placed."""
        from morfax.motion.placement import Placement

        return Placement(self.mirror, self.scale, self.turn_rad, self.about_mm, self.origin_mm)

    def at(self, origin_mm: tuple[float, float]) -> RecordingUnit:
        """The same with the machine's zero at a place."""
        return replace(self, origin_mm=origin_mm)

    def check(self, program: FilePath | None) -> None:
        """Raise WrongUse where something is set that this medium does not have."""
        if program is None or not medium.is_tape(program):
            of_tapes = {"--pickup": self.pickup, "--plain": self.plain or None}
            _refuse_set(of_tapes, "tapes", medium.TAPES)
        self._check_fit(program)
        if program is not None and medium.has_machine(program):
            self.chosen(program)
            return
        of_machines = {
            "--machine": self.machine,
            "--machine-value": self.machine_values or None,
            "--feed": self.feed_mm_s,
            "--plunge": self.plunge_mm_s,
            "--rapid": self.rapid_mm_s,
        }
        _refuse_set(of_machines, "G-code", medium.BLOCKS)

    def chosen(self, program: FilePath | None = None) -> Machine:
        """The machine for a program of G-code or a plotter's; raises WrongUse, CardFault."""
        values = self.machine_values
        if self.feed_mm_s is not None and program is not None and medium.is_plot(program):
            values = (f"speed={self.feed_mm_s / 10:.3g}", *values)  # HP-GL's VS, cm/s
        return machining.chosen(self.machine, values, self.rapid_mm_s, program)

    def _check_fit(self, program: FilePath | None) -> None:
        """Raise WrongUse for a tolerance or lines only where nothing is fitted."""
        is_exact = program is None or medium.is_tape(program)
        if self.fit_tolerance_mm is not None and is_exact:
            what = "path files" if program is None else "tapes"
            raise WrongUse(
                f"--fit-tolerance is not for {what}: they hold the motion itself; leave it out"
            )
        if self.lines_only and (
            program is None or program.suffix.lower() not in medium.WITH_ARCS
        ):
            raise WrongUse(
                f"--lines-only is for files with arcs, {', '.join(medium.WITH_ARCS)}; give -o such a name, "
                "or leave it out"
            )

    def program_settings(self, program: FilePath) -> dict[str, Any]:
        """What the recorder of this medium is told; tapes apart."""
        fit_mm = self.fit_tolerance_mm
        fit: dict[str, Any] = {} if fit_mm is None else {"tolerance_mm": fit_mm}
        if self.lines_only:
            fit["arcs"] = False
        if not medium.has_machine(program):
            return fit
        from morfax.recorder.gcode.plan import Feeds

        feeds = Feeds(self.feed_mm_s, self.plunge_mm_s)
        return {**fit, "machine_name": self.chosen(program), "feeds": feeds, "made": self.made}

    def milling(self, program: FilePath | None) -> Milling | None:
        """The way round in which the machine cuts closed lines, if it asks for one."""
        if program is None or not medium.is_gcode(program):
            return None
        return self.chosen(program).milling

    def usual_lines(self, program: FilePath | None) -> UsualLines | None:
        """Which lines the machine is for, if it says so; None where no machine is named."""
        if program is None or self.machine is None or not medium.has_machine(program):
            return None
        return self.chosen(program).lines

    def warn(
        self,
        program: FilePath | None,
        listener: Listener,
        settings: TraceSettings | None = None,
    ) -> None:
        """Say what a scale does to the cutter and the speed, and name a feed that no machine cuts with."""
        if program is not None and medium.has_machine(program):
            for text in machining.doubtful_feeds(
                self.chosen(program), self.feed_mm_s, self.plunge_mm_s
            ):
                listener.warning(text)
        of_scale = scaled.said(self.scale, settings, has_feed=self.feed_mm_s is not None)
        if of_scale is not None:
            listener.warning(of_scale)

    def record(self, stream: Iterable[Motion], file: FilePath, listener: Listener) -> Report:
        """Record a motion, placed, in the medium that the name says; raises MotionFault if it cannot be."""
        from morfax.recorder.media import record

        placed = self.placement.stream(stream)
        if not medium.is_tape(file):
            with settings_checked():  # such as a tolerance finer than the last decimal
                return record(placed, file, **self.program_settings(file))
        fmt = self.tape_format()
        return record(rehearsed(placed, fmt, listener), file, fmt=fmt)

    def tape_format(self, cycles_per_mm: float | None = None, **entries: Any) -> TapeFormat:
        """The format of a tape with this pick-up; raises ValueError for one that cannot be."""
        from morfax.recorder.tape import pickups
        from morfax.recorder.tape.tape import TapeFormat

        pickup = self.pickup or pickups.DEFAULT_PICK_UP
        own = pickups.PICK_UPS[pickup].cycles_per_mm
        density = own if cycles_per_mm is None else cycles_per_mm
        bare = TapeFormat(pickup=pickup, cycles_per_mm=density, **entries)
        return bare if self.plain or not bare.can_be_checked else replace(bare, checked=True)

    def figures(self) -> dict[str, Any]:
        """What was set."""
        return {
            "pickup": self.pickup,
            "mirrored": self.mirror.upper() or None,
            "scale": None if self.scale == 1 else self.scale,
            "turned_deg": round(math.degrees(self.turn_rad), 9) or None,
        }


def rehearsed(
    stream: Iterable[Motion], fmt: TapeFormat, listener: Listener
) -> Iterator[Motion]:
    """Pass a motion on to its tape; a fault if no player could read it, a warning if a drive loses it."""
    from morfax.player.tape.rehearsal import Rehearsal

    rehearsal = Rehearsal(fmt)
    yield from rehearsal.of(stream)
    lost = rehearsal.unfollowed
    if lost is not None:
        place = ",".join(f"{mm:.2f}" for mm in lost.place_mm[:2])
        listener.warning(
            f"the drive of {lost.axis.upper()} would lose its lock at {place} mm, {lost.time_s:.3f} s into "
            "the motion: play the tape slower (--feed-override 50%), or run the path slower"
        )


def _refuse_set(options: Mapping[str, object], what: str, suffixes: tuple[str, ...]) -> None:
    """Raise WrongUse for the first option that is set, where the result is none of the media that have it."""
    for name, value in options.items():
        if value is not None:
            raise WrongUse(
                f"{name} is for {what}, {', '.join(suffixes)}; name such a program, as by -o "
                f"part{suffixes[0]}, or leave {name} out"
            )
