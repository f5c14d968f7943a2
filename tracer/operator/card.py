"""The operator's card: what the operator would set on the panel during a run, written down before it.

Signals in: a text in TOML (`docs/reference/card.md` has the whole format). Signals out: a Card: start
position and depths in mm, speeds in mm/s, and for each stop the presets of the Z unit. What a card leaves out
is None, and stays as it is without a card.

    start = "2mm"                # where the tool stands above the work
    passes = ["2mm", "4mm"]      # or depth = "4mm"
    [speeds]
    feed = "300mm/min"
    [[stop]]
    drill = { depth = "8mm", peck = "2mm" }

A card is read whole before anything moves. A card with a mistake is refused with the line, the field, what it
holds and what it may hold (see `toml_fields`).

Source: patent ES 361967, figure 3 (switches 126: start position, each move, its feed; the start button) and
the section on use; speed control WC, override button and stop marks of figure 1. The patent's operator sets
the decades anew at each stop; a card sets them for all stops beforehand. Questions: the patent names neither
drill cycle nor passes. Chosen: a drill goes down peck by peck, comes up to where it began after each, and
goes down again to one clear distance above the bottom of the hole.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path as FilePath
from typing import Literal, cast

from morfax.motion.faults import CardFault
from morfax.motion.toml_fields import Field, opened, parsed, read
from morfax.tracer.operator.counts_field import counts_in
from morfax.tracer.operator.depth_fields import length_mm, passes_mm, ramp_rad, start_mm, tabs
from morfax.tracer.operator.work import Tabs
from morfax.tracer.operator.zunit import (
    COUNTS_PER_MM,
    Counters,
    Preset,
    QuillMove,
    counts_of,
    moves,
)

Restart = Literal["automatic", "manual"]
Turn = Literal["straight", "left", "right"]
Override = Literal["none", "all"] | tuple[int, ...]
FEED_MM_S = 5.0  # of a move without a feed, on a card without a feed: our own figure
CLEAR_COUNTS = 50  # 0.5 mm above the bottom of the hole the drill slows down: our own figure
_KEYS = (
    *("start", "depth", "passes", "entry", "restart", "turns", "override", "speeds", "stop"),
    *("step_down", "ramp", "tabs", "peck"),
)
_STOP_KEYS = ("number", "moves", "drill", "passes", "dwell", "restart")
_MOVE_KEYS = ("down", "up", "feed", "dwell")
_DRILL_KEYS = ("depth", "peck", "clear", "feed", "dwell")


@dataclass(frozen=True, slots=True)
class Drill:
    """A hole: its depth and how it is drilled, in counts of 0.01 mm, with a dwell at the bottom."""

    depth_counts: int
    peck_counts: int
    clear_counts: int = CLEAR_COUNTS
    feed_mm_s: float = FEED_MM_S
    dwell_s: float = 0.0

    def presets(self, at: Counters, rapid_mm_s: float) -> tuple[Preset, ...]:
        """Settings of the panel from a place down to depth and back; none if the place is as deep already."""
        made = list[Preset]()
        bottom = max(0, -at.count)
        while bottom < self.depth_counts:
            near = min(self.clear_counts - bottom, at.count)  # from here on at the drill's feed
            bottom = min(bottom + self.peck_counts, self.depth_counts)
            dwell_s = self.dwell_s if bottom == self.depth_counts else 0.0
            made.append(Preset(at.count - near, "down", rapid_mm_s))
            made.append(Preset(near + bottom, "down", self.feed_mm_s, dwell_s))
            made.append(Preset(at.count + bottom, "up", rapid_mm_s))
        return tuple(made)


@dataclass(frozen=True, slots=True)
class Stop:
    """What to do at a stop: moves of Z, a hole, or the passes of the line that begins there; then a dwell."""

    number: int | None = None  # None: every stop that has no entry of its own
    moves: tuple[Preset, ...] = ()
    drill: Drill | None = None
    passes_mm: tuple[float, ...] = ()
    dwell_s: float = 0.0
    restart: Restart | None = None
    # the field of a card that holds the moves, or the hole
    written: Field | None = field(default=None, compare=False, repr=False)

    def presets(self, at: Counters, rapid_mm_s: float) -> tuple[Preset, ...]:
        """Settings of the panel from a place, the dwell last; passes belong to the line, not to the stop."""
        made = self.moves if self.drill is None else self.drill.presets(at, rapid_mm_s)
        return (*made, Preset(0, dwell_s=self.dwell_s)) if self.dwell_s > 0 else made

    def motor_moves(self, z_mm: float, rapid_mm_s: float, where: str) -> list[QuillMove]:
        """What the motor does from a height; raises CardFault for a move that cannot be set."""
        made = list[QuillMove]()
        try:
            at = Counters(counts_of(z_mm))
            for preset in self.presets(at, rapid_mm_s):
                made += moves(at, [preset])
                at = at.after(preset)
        except ValueError as error:
            if self.written is None:
                raise CardFault(f"{where}: {error}") from None
            at_fault = self.written.elements("moves")[len(made)] if self.moves else self.written
            at_fault.refuse(f"{where}: {error}")
        return made


@dataclass(frozen=True, slots=True)
class Card:
    """The operator's card; what it leaves out is None or empty."""

    start_mm: float | None = None
    depths_mm: tuple[float, ...] = ()  # of the passes along each line, the last the deepest
    trace_mm_s: float | None = None
    feed_mm_s: float | None = None
    rapid_mm_s: float | None = None
    # the tool goes down to its depth along this length of the line
    entry_mm: float | None = None
    restart: Restart = "automatic"
    turns: tuple[
        Turn, ...
    ] = ()  # at the junctions, in the order in which the head comes to them
    override: Override = "none"  # stop marks that do not stop the head
    stops: tuple[Stop, ...] = ()
    step_down_mm: float | None = None  # deepest cut of one pass; passes are then equal
    ramp_rad: float | None = None  # the tool goes in along the line at this angle
    tabs: Tabs | None = None
    peck_mm: float | None = None  # how deep a drill goes at a time

    @classmethod
    def open(cls, file: FilePath) -> Card:
        """Read a card; raises CardFault for a mistake, FileFault if the file cannot be read."""
        return _card(opened(file))

    @classmethod
    def parse(cls, text: str, name: str = "card") -> Card:
        """Read a card from a text; raises CardFault for a mistake."""
        return _card(parsed(text, name))

    @property
    def is_about_stops(self) -> bool:
        """Whether it says something of stops, holes or junctions: such a card belongs to a drawn program."""
        named = self.stops or self.turns or self.override != "none" or self.restart == "manual"
        return bool(named) or self.peck_mm is not None

    def stop(self, number: int) -> Stop:
        """What to do at a stop, counted from 1."""
        own = [stop for stop in self.stops if stop.number == number]
        others = [stop for stop in self.stops if stop.number is None]
        return (own or others or [Stop(number)])[0]


def _card(whole: Field) -> Card:
    """The card as a whole."""
    fields = whole.table(*_KEYS)
    speeds = read(fields, "speeds", _speeds, dict[str, Field]())
    feed_mm_s = read(speeds, "feed", Field.speed_mm_s, None)
    if "depth" in fields and "passes" in fields:
        fields["depth"].refuse("give passes or depth, not both: the last pass is the depth")
    for one, other in (("passes", "step_down"), ("entry", "ramp")):
        if one in fields and other in fields:
            fields[other].refuse(f"give {one} or {other}, not both")
    peck = read(fields, "peck", counts_in, None)
    depth = read(fields, "depth", lambda field: (length_mm(field),), ())
    return Card(
        start_mm=read(fields, "start", start_mm, None),
        depths_mm=read(fields, "passes", passes_mm, depth),
        entry_mm=read(fields, "entry", length_mm, None),
        step_down_mm=read(fields, "step_down", length_mm, None),
        ramp_rad=read(fields, "ramp", ramp_rad, None),
        tabs=read(fields, "tabs", tabs, None),
        peck_mm=None if peck is None else peck / COUNTS_PER_MM,
        trace_mm_s=read(speeds, "trace", Field.speed_mm_s, None),
        feed_mm_s=feed_mm_s,
        rapid_mm_s=read(speeds, "rapid", Field.speed_mm_s, None),
        restart=read(fields, "restart", _restart, "automatic"),
        turns=read(fields, "turns", _turns, ()),
        override=read(fields, "override", _override, "none"),
        stops=read(
            fields, "stop", lambda field: _stops(field, feed_mm_s or FEED_MM_S, peck), ()
        ),
    )


def _speeds(field: Field) -> dict[str, Field]:
    """The speeds of the card."""
    return field.table("trace", "feed", "rapid")


def _restart(field: Field) -> Restart:
    """Whether the head goes on by itself after a stop."""
    return cast(Restart, field.choice("automatic", "manual"))


def _turns(field: Field) -> tuple[Turn, ...]:
    """Turns at the junctions."""
    allowed = 'a list of "straight", "left" and "right", one for each junction'
    return tuple(
        cast(Turn, turn.choice("straight", "left", "right")) for turn in field.elements(allowed)
    )


def _override(field: Field) -> Override:
    """Which stop marks do not stop the head."""
    if field.value in ("none", "all"):
        return cast(Literal["none", "all"], field.value)
    allowed = '"none", "all" or a list of stops, such as [1, 3]'
    return tuple(number.number() for number in field.elements(allowed))


def _stops(field: Field, feed_mm_s: float, peck: int | None) -> tuple[Stop, ...]:
    """All entries for stops, each of another number."""
    stops: list[Stop] = []
    for element in field.elements("entries [[stop]]"):
        stop = _stop(element, feed_mm_s, peck)
        if any(stop.number == other.number for other in stops):
            which = "a number" if stop.number is None else "another number"
            element.refuse(f"an entry before it is for the same stops; it may hold {which}")
        stops.append(stop)
    return tuple(stops)


def _stop(entry: Field, feed_mm_s: float, peck: int | None) -> Stop:
    """One entry for a stop, or for all others."""
    fields = entry.table(*_STOP_KEYS)
    both = [key for key in ("moves", "drill", "passes") if key in fields]
    if len(both) > 1:
        fields[both[1]].refuse(f"give {both[0]} or {both[1]}, not both")
    return Stop(
        number=read(fields, "number", Field.number, None),
        moves=read(fields, "moves", lambda field: _moves(field, feed_mm_s), ()),
        drill=read(fields, "drill", lambda drill: _drill(drill, feed_mm_s, peck), None),
        passes_mm=read(fields, "passes", passes_mm, ()),
        dwell_s=read(fields, "dwell", Field.time_s, 0.0),
        restart=read(fields, "restart", _restart, None),
        written=next((fields[key] for key in both if key != "passes"), None),
    )


def _moves(field: Field, feed_mm_s: float) -> tuple[Preset, ...]:
    """Moves of Z, one after the other."""
    allowed = 'moves such as [{ down = "7mm", feed = "5mm/s" }, { up = "7mm" }]'
    return tuple(_move(element, feed_mm_s) for element in field.elements(allowed))


def _move(field: Field, feed_mm_s: float) -> Preset:
    """One setting of the panel."""
    fields = field.table(*_MOVE_KEYS)
    dwell_s = read(fields, "dwell", Field.time_s, 0.0)
    feed_mm_s = read(fields, "feed", Field.speed_mm_s, feed_mm_s)
    is_dwell = len(fields) == 1 and "dwell" in fields
    if ("down" in fields) == ("up" in fields) and not is_dwell:
        field.refuse("it may hold either down or up, with feed and dwell; or a dwell alone")
    if "up" in fields:
        return Preset(counts_in(fields["up"]), "up", feed_mm_s, dwell_s)
    return Preset(read(fields, "down", counts_in, 0), "down", feed_mm_s, dwell_s)


def _drill(field: Field, feed_mm_s: float, peck_of_all: int | None) -> Drill:
    """A drill cycle."""
    fields = field.table(*_DRILL_KEYS)
    if "depth" not in fields:
        field.refuse('it must hold a depth, such as { depth = "8mm" }')
    depth = counts_in(fields["depth"])
    peck = read(fields, "peck", counts_in, min(peck_of_all or depth, depth))
    if peck > depth:
        fields["peck"].refuse(f"it may hold the depth at most, {depth / COUNTS_PER_MM:g} mm")
    return Drill(
        depth_counts=depth,
        peck_counts=peck,
        clear_counts=read(fields, "clear", counts_in, CLEAR_COUNTS),
        feed_mm_s=read(fields, "feed", Field.speed_mm_s, feed_mm_s),
        dwell_s=read(fields, "dwell", Field.time_s, 0.0),
    )
