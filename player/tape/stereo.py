"""A tape in two stereo files: their tracks joined on one clock, by the check signal that is on all of them.

    file with the reference   ┃ reference, X ┃ ───────────────────────────────┐
                                                                              ├─► reference, X, Y, Z
    the other file            ┃ Y, Z         ┃ ─► read at the places that ────┘
                                                  belong to the first one's frames

Signals: two sources of sound in; frames of all tracks out, at the rate of the file with the reference, from
where both have begun to where one ends, without the silence around the programme.

Two recorders begin at different moments, and their clocks differ. Every frame of the check signal says its
number, so frames of one number are one moment in both files. A straight line through those within 15 s gives
the place in the other file, true to some 20 us; what is left the player takes out as it does any delay
(vouching.py). It has to be below 200 us and drift by less than 50 us/s: two crystals do, two tape transports
do not, as each flutters by itself.

Source: our own. Questions: only a tape with a check signal can be joined; two bare files say nothing of when
they are.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.faults import TapeFault
from morfax.motion.usual import REFERENCE_HZ
from morfax.player.tape.check_reader import CheckReader
from morfax.player.tape.standstill import REFERENCE_BAND, strongest_hz
from morfax.recorder.sound.programme import programme_within
from morfax.recorder.sound.source import BLOCK_FRAMES, Source, Stored, full_scale
from morfax.recorder.tape.check_frame import NUMBERS
from morfax.recorder.tape.check_signal import CYCLES_PER_FRAME, CYCLES_PER_SUBCARRIER
from morfax.recorder.tape.format import TapeFormat
from morfax.recorder.wear.timebase import HALF_TAPS, Head

WINDOW_CHECK_FRAMES = 2.3  # of the check signal, in which one is whole at least
EVERY_S = 2.5  # from one window to the next
TONE_S = 0.1  # at the start, in which the speed of the tape is told
KNOTS_S = 5.0  # between places that are told by a straight line
WITHIN_S = 15.0  # to either side, through which the line is laid
LARGEST_OFF_S = (
    0.5 * CYCLES_PER_SUBCARRIER / REFERENCE_HZ
)  # of a frame from the line: half its cycle
FEWEST_FRAMES = 2


@dataclass(frozen=True, slots=True)
class Half:
    """One file: its source, where its programme is, which track is which, and where frames of it begin."""

    source: Source
    first: int
    end: int
    roles: tuple[int, ...]
    places: dict[int, float]  # by the number of the frame of the check signal


class StereoSource:
    """Two files of one tape as one source; raises TapeFault where they cannot be joined."""

    container = "two files"

    def __init__(self, one: Source, other: Source, reference_hz: float = REFERENCE_HZ) -> None:
        self._one, self._other = one, other
        try:
            halves = [_half(source, reference_hz) for source in (one, other)]
            halves.sort(key=lambda half: min(half.roles))
            self._main, self._beside = halves
            roles = [*self._main.roles, *self._beside.roles]
            _check_roles(roles, self._main, self._beside)
            self._columns = [roles.index(track) for track in range(len(roles))]
            self._knots, self._places = _joined(self._main, self._beside)
        except BaseException:
            self.close()
            raise
        self.name = f"{one.name} with {other.name}"
        self.tracks, self.rate_hz = len(roles), self._main.source.rate_hz
        self.text = self._main.source.text or self._beside.source.text
        self.sample = self._main.source.sample
        self._first, self._end = self._common()

    @property
    def frames(self) -> int:
        """Frames that both files have."""
        return self._end - self._first

    def close(self) -> None:
        """Close both files."""
        self._one.close()
        self._other.close()

    def stored_blocks(self, frames: int = BLOCK_FRAMES, first: int = 0) -> Iterator[Stored]:
        """The frames of all tracks in blocks, from frame `first` of those that both have."""
        at = self._first + first
        begin = max(int(self._place(np.array([at]))[0]) - 2 * HALF_TAPS, 0)
        others = self._beside.source.stored_blocks(frames, begin)
        head = Head(self._beside.source.tracks)
        for block in self._main.source.stored_blocks(frames, at):
            main = full_scale(block)[: self._end - at]
            if not len(main):
                return
            places = self._place(np.arange(at, at + len(main))) - begin
            while head.reach <= places[-1] + 1:
                more = next(others, None)
                blank = np.zeros((4 * HALF_TAPS, self._beside.source.tracks), np.float32)
                head.take(blank if more is None else full_scale(more))
            beside = head.read(np.repeat(places[:, None], self._beside.source.tracks, axis=1))
            at += len(main)
            yield np.column_stack([main, beside])[:, self._columns]

    def _place(self, frames: Array | NDArray[np.int64]) -> Array:
        """Places in the other file that belong to frames of the one with the reference."""
        knots, places = self._knots, self._places
        inside = np.interp(frames, knots, places)
        before = (places[1] - places[0]) / (knots[1] - knots[0])
        after = (places[-1] - places[-2]) / (knots[-1] - knots[-2])
        return np.asarray(
            inside
            + np.minimum(frames - knots[0], 0) * before
            + np.maximum(frames - knots[-1], 0) * after
        )

    def _common(self) -> tuple[int, int]:
        """The first frame of the main file that the other one has too, and the end of both."""
        grid = np.arange(self._main.first, self._main.end)
        place = self._place(grid)
        both = grid[(place >= self._beside.first) & (place < self._beside.end)]
        if not len(both):
            raise TapeFault(
                f"{self.name} have no moment in common; give the two files of one recording"
            )
        return int(both[0]), int(both[-1]) + 1


def _half(source: Source, reference_hz: float) -> Half:
    """Read what a file says of itself; raises TapeFault for a file without a check signal."""
    span = programme_within(source.stored_blocks(), source.rate_hz)
    if span is None:
        raise TapeFault(f"{source.name} holds no carriers; give the two files of one recording")
    first, end = span
    tone = next(source.stored_blocks(round(TONE_S * source.rate_hz), first))
    found_hz = strongest_hz(full_scale(tone)[:, 0], source.rate_hz)
    if not abs(found_hz / reference_hz - 1) <= REFERENCE_BAND:
        raise TapeFault(
            f"{source.name} begins with {found_hz:.0f} Hz, and the reference is {reference_hz:g} Hz; give "
            "the tape's own with --reference-frequency, or a recording that begins before anything moves"
        )
    places: dict[int, float] = {}
    roles: dict[int, int] = {}
    length = round(WINDOW_CHECK_FRAMES * CYCLES_PER_FRAME / found_hz * source.rate_hz)
    every = max(round(EVERY_S * source.rate_hz), length)
    for at in [*range(first, max(end - length, first + 1), every), max(end - length, first)]:
        window = next(source.stored_blocks(min(length, end - at), at))
        for track, number, place in _frames_in(full_scale(window), source.rate_hz, found_hz):
            roles.setdefault(track[0], track[1])
            if track[0] == 0:
                places[number] = at + place
    if len(roles) < source.tracks or len(places) < FEWEST_FRAMES:
        raise TapeFault(
            f"{source.name} has no check signal that can be read on all of its tracks: only a tape with one "
            "can be put together of two files (record it without --plain), and only if no transport made it "
            "flutter by itself"
        )
    return Half(source, first, end, tuple(roles[k] for k in range(source.tracks)), places)


def _frames_in(
    window: NDArray[np.float32], rate_hz: int, reference_hz: float
) -> Iterator[tuple[tuple[int, int], int, float]]:
    """Frames of the check signal: (column, track that it says to be), number, place where it begins.

    The file's own samples are the clock: a tone made here stands for the reference.
    """
    turns = np.arange(len(window)) * (reference_hz / rate_hz)
    clock = (0.5 * np.sin(2 * np.pi * turns)).astype(np.float32)
    axes = ("x", "y", "z", "a", "b", "c", "u", "v", "w")[: window.shape[1]]
    fmt = TapeFormat(sample_rate_hz=rate_hz, reference_hz=reference_hz, axes=axes)
    reader = CheckReader(fmt, np.column_stack([clock, window]), reference_hz)
    for column, found in enumerate(reader.found[1:]):
        for frame in found:
            place = frame.theta / reference_hz * rate_hz
            yield (column, frame.said.track), frame.said.number, place


def _check_roles(roles: list[int], main: Half, beside: Half) -> None:
    """Raise TapeFault unless each track is there once."""
    if sorted(roles) == list(range(len(roles))):
        return
    said = "; ".join(
        f"{half.source.name} has {', '.join(str(role + 1) for role in half.roles)}"
        for half in (main, beside)
    )
    raise TapeFault(
        f"the two files are no two halves of a tape: of its tracks {said}; give the file with 1, 2 and the "
        "one with 3, 4"
    )


def _joined(main: Half, beside: Half) -> tuple[Array, Array]:
    """Frames of the main file, and the places in the other one that belong to them; raises TapeFault."""
    both = sorted(main.places.keys() & beside.places.keys())
    if len(both) < FEWEST_FRAMES or both[-1] - both[0] > NUMBERS // 2:
        raise TapeFault(
            f"{main.source.name} and {beside.source.name} have no frames of the check signal in common; give "
            "the two files of one recording"
        )
    here = np.array([main.places[number] for number in both])
    there = np.array([beside.places[number] for number in both])
    rate_hz = main.source.rate_hz
    stretches = round((here[-1] - here[0]) / (KNOTS_S * rate_hz))
    knots = np.linspace(here[0], here[-1], max(stretches, 1) + 1)
    places = np.empty_like(knots)
    for k, knot in enumerate(knots):
        near = np.abs(here - knot) <= max(WITHIN_S * rate_hz, here[1] - here[0])
        near = near if near.sum() >= FEWEST_FRAMES else np.ones(len(here), bool)
        slope, place = np.polyfit(here[near] - knot, there[near], 1)
        places[k] = place
        off_s = np.abs(there[near] - place - slope * (here[near] - knot)) / rate_hz
        if off_s.max() > LARGEST_OFF_S:
            raise TapeFault(
                f"the clocks of {main.source.name} and {beside.source.name} wander by "
                f"{1e3 * off_s.max():.1f} ms against each other at {knot / rate_hz:.1f} s: they were played "
                "on two transports, each with its own flutter; record all tracks on one, or as sound files"
            )
    return knots, places
