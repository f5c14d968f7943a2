"""The registers of the compiled pulse interpolator, read after every recirculation.

The interpolator hands its state out once in `AT_ONCE` recirculations. Here that is 1, so that a test reads
what the kernel itself holds, and works nothing out again: residues, loop Q, counter 81 and places.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any
from unittest import mock

import numpy as np
from numpy.typing import NDArray

from morfax.motion.motion import MOTION_RATE_HZ
from morfax.player.gcode import residues
from morfax.player.gcode.pulses import HISTORIC_CONTROL, PulseControl, PulsePlayback
from morfax.player.gcode.residues import LINE, Feed, ResidueInterpolator
from morfax.player.gcode.rs274 import parse_rs274

Counts = NDArray[np.int64]
RECIRCULATIONS_HZ = 8 * MOTION_RATE_HZ
ALWAYS = Feed(gate_period=1)


@dataclass(frozen=True)
class Block:
    """One line or arc as it was run: n recirculations, n + 1 readings, the first as it was loaded.

    `residue` (n + 1, 3) and `place` (n + 1, 3) in pulses, `ratio` (n + 1) is loop Q, `counter` (n + 1)
    counter 81 in eighths, `pulses` (n, 3).
    """

    end: Counts
    centre: Counts
    sense: int
    constant: int
    residue: Counts
    ratio: Counts
    place: Counts
    counter: NDArray[np.float64]
    pulses: Counts

    @property
    def error(self) -> Counts:
        """Errors E (n, 3) with which each recirculation began."""
        return np.asarray(self.end - self.place[:-1])

    @property
    def total(self) -> Counts:
        """L + E_m of each recirculation."""
        return np.asarray(self.constant + np.abs(self.error).max(axis=1))

    @property
    def against(self) -> Counts:
        """The sum against the residue's sign (n, 3), as the patent has it."""
        return np.asarray(np.where(self.residue[:-1] < 0, 1, -1) * self.total[:, None])

    @property
    def entered(self) -> Counts:
        """What else came into each residue (n, 3): the errors, where the gate was open."""
        return np.asarray(np.diff(self.residue, axis=0) - self.against)

    @property
    def was_open(self) -> NDArray[np.bool_]:
        """Whether the error gates were open, told by what came in: on a line, to the largest error."""
        if self.sense:
            return np.asarray((self.entered[:, :2] != 0).any(axis=1))
        largest = np.abs(self.error).argmax(axis=1)
        return np.asarray(self.entered[np.arange(len(largest)), largest] != 0)


def read(
    interpolator: ResidueInterpolator,
    end: Any,
    feed: Feed,
    residue: int | None = None,
    most: int = 60_000,
) -> Block:
    """Run a line, or its first recirculations, and read the registers after each."""
    parts = interpolator.recirculate(end, (0, 0), LINE, feed, residue)
    return _read(interpolator, parts, (end, (0, 0), LINE), residue, most)


def _read(
    interpolator: ResidueInterpolator,
    parts: Iterator[NDArray[np.int8]],
    block: tuple[Any, Any, int],
    residue: int | None = None,
    most: int = 60_000,
) -> Block:
    """Read the registers after each recirculation of a block: its end, centre and sense."""
    end, centre, sense = np.array(block[0], np.int64), np.array(block[1], np.int64), block[2]
    start, full = interpolator.position, interpolator.counter
    if residue is None:
        residue = (interpolator.servo_constant + int(np.abs(end - start).max())) // 2
    held, places, counters, pulses = [np.array([residue] * 3 + [0])], [start], [full], []
    with mock.patch.object(residues, "AT_ONCE", 1):
        for part in parts:
            if not len(part):
                break
            pulses.append(part[0].astype(np.int64))
            held.append(interpolator.residues)
            places.append(interpolator.position)
            counters.append(interpolator.counter)
            if len(pulses) == most:
                break
    registers = np.array(held)
    return Block(
        end,
        centre,
        sense,
        interpolator.servo_constant,
        registers[:, :3],
        registers[:, 3],
        np.array(places),
        8 * np.array(counters),
        np.array(pulses).reshape(-1, 3),
    )


class Reader(ResidueInterpolator):
    """An interpolator that a playback runs, and whose registers are read on the way: `blocks`."""

    blocks: list[Block]

    def recirculate(self, end, centre, sense, feed, residue=None):  # type: ignore[no-untyped-def]
        """Run a block, and keep its readings."""
        parts = super().recirculate(end, centre, sense, feed, residue)
        block = _read(self, parts, (end, centre, sense), residue)
        self.blocks.append(block)
        yield block.pulses.astype(np.int8)


def played(control: PulseControl, *lines: str) -> list[Block]:
    """The blocks of a program that the control plays, as `morfax play` does."""
    made: list[Reader] = []

    def reader(*given: Any, **named: Any) -> Reader:
        made.append(Reader(*given, **named))
        made[-1].blocks = []
        return made[-1]

    playback = PulsePlayback(parse_rs274([*lines, "M2"]), control)
    with mock.patch("morfax.player.gcode.pulses.ResidueInterpolator", reader):
        for _ in playback:
            pass
    return made[0].blocks


def ways(pulses: np.ndarray, start: tuple[int, ...] = (0, 0, 0)) -> np.ndarray:
    """Places after each recirculation, the start first."""
    return (
        np.vstack([np.zeros((1, 3), np.int64), np.cumsum(pulses, axis=0, dtype=np.int64)])
        + start
    )


def step(residue: int, error: int, total: int, gate_open: bool) -> tuple[int, int]:
    """One recirculation of the compiled loop: the new residue, and the pulse (0 for none)."""
    size = max(1, abs(error))
    loop = ResidueInterpolator(servo_constant=total - size, guard=False)
    end = (int(math.copysign(size, error)), 0, 0)
    block = read(loop, end, Feed(gate_period=1 if gate_open else 2), residue, most=1)
    return int(block.residue[1, 0]), int(block.pulses[0, 0])


def oblique() -> list[Block]:
    """Lines in three axes as the historic control plays them, at a feed below its fastest."""
    lines = "G1 X0 Y0 Z0 F1800", "G1 X9 Y-4 Z2", "G1 X1 Y4 Z2", "G1 X-9 Y1 Z0"
    return played(HISTORIC_CONTROL, *lines)[-3:]


def quarters() -> list[Block]:
    """Quarter circles of 12 mm, either way round, as the historic control plays them."""
    there, back = "G3 X0 Y12 I-12 J0", "G2 X12 Y0 I0 J-12"
    return played(HISTORIC_CONTROL, "G1 X12 Y0 F1200", there, back)[-2:]
