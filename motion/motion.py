"""Motion: positions of the axes at a uniform rate, in blocks; and Path: the same motion thinned.

Signals: positions in mm, a column for each axis (X, Y, Z, and further ones where a machine has them), at the
motion rate (the tape's sample rate over 8, 6 kHz by default). A long program is a stream of blocks, so that
nothing has to hold a whole tape in memory. A Path keeps only the samples between which straight interpolation
in time gives every sample back within a tolerance on each axis (a swinging-door compression: J. Bristol,
"Swinging door trending", ISA 1990).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.compiled import njit
from morfax.motion.usual import AT_ONCE
from morfax.motion.usual import MOTION_RATE_HZ as MOTION_RATE_HZ

AXES: tuple[str, ...] = ("x", "y", "z")
# what a fourth and later axis may be called; all in mm of their own screws
FURTHER_AXES = tuple("abcuvw")
# the tool is in the work at and below the surface; the margin is for a servo's rest error
IN_WORK_BELOW_MM = 0.05
THINNING_TOLERANCE_MM = 2e-4
BLOCK_SAMPLES = AT_ONCE


@dataclass(frozen=True, slots=True)
class Motion:
    """A block of axis positions: (n, axes) mm, sample i at `start_s + i / rate_hz`."""

    positions_mm: Array
    rate_hz: float = MOTION_RATE_HZ
    start_s: float = 0.0
    axes: tuple[str, ...] = AXES

    @property
    def times_s(self) -> Array:
        """Times of the samples, s."""
        return self.start_s + np.arange(len(self.positions_mm)) / self.rate_hz

    @property
    def duration_s(self) -> float:
        """Length of the block, s."""
        return len(self.positions_mm) / self.rate_hz


@dataclass(frozen=True, slots=True)
class Path:
    """A thinned motion: times (n,) s and positions (n, axes) mm, straight in between."""

    t_s: Array
    positions_mm: Array
    axes: tuple[str, ...] = AXES

    @property
    def xy_mm(self) -> Array:
        """(n, 2) positions in the plane of the drawing, mm."""
        return self.positions_mm[:, :2]

    @property
    def tool(self) -> NDArray[np.bool_]:
        """Whether the tool is in the work at each point."""
        return self.positions_mm[:, 2] <= IN_WORK_BELOW_MM

    def runs(self) -> list[Array]:
        """The (n, 2) polylines in mm that are run with the tool in the work."""
        edges = np.flatnonzero(np.diff(np.r_[False, self.tool, False].astype(np.int8)))
        return [self.xy_mm[a:b] for a, b in edges.reshape(-1, 2)]

    def motion(
        self, rate_hz: float = MOTION_RATE_HZ, block_samples: int = BLOCK_SAMPLES
    ) -> Iterator[Motion]:
        """Stream the path as blocks at a rate, from its first time to its last."""
        start_s = float(self.t_s[0])
        end_s = float(self.t_s[-1])
        samples = int(np.floor((end_s - start_s) * rate_hz + 0.5)) + 1
        for first in range(0, samples, block_samples):
            t_s = start_s + np.arange(first, min(first + block_samples, samples)) / rate_hz
            columns = [np.interp(t_s, self.t_s, column) for column in self.positions_mm.T]
            yield Motion(np.column_stack(columns), rate_hz, float(t_s[0]), self.axes)


def join(stream: Iterable[Motion]) -> Motion:
    """All blocks of a stream as one; raises ValueError if it is empty."""
    blocks = list(stream)
    if not blocks:
        raise ValueError("the stream of motion is empty; it must hold at least one block")
    return Motion(
        np.vstack([b.positions_mm for b in blocks]),
        blocks[0].rate_hz,
        blocks[0].start_s,
        blocks[0].axes,
    )


def thin(stream: Iterable[Motion], tolerance_mm: float = THINNING_TOLERANCE_MM) -> Path:
    """Thin a stream to the samples that give all others back within `tolerance_mm` per axis."""
    pieces = list(thinned(stream, tolerance_mm))
    if not pieces:
        raise ValueError("the stream of motion is empty; it must hold at least one block")
    return Path(
        np.concatenate([piece.t_s for piece in pieces]),
        np.vstack([piece.positions_mm for piece in pieces]),
        pieces[0].axes,
    )


def thinned(
    stream: Iterable[Motion], tolerance_mm: float = THINNING_TOLERANCE_MM
) -> Iterator[Path]:
    """The pieces of a thinned path as the blocks of a stream come; none of an empty stream."""
    state: Array | None = None
    samples, start_s, rate_hz, axes = 0, 0.0, MOTION_RATE_HZ, AXES
    for block in stream:
        positions = np.ascontiguousarray(block.positions_mm)
        if not len(positions):
            continue
        first = state is None
        if state is None:
            start_s, rate_hz, axes = block.start_s, block.rate_hz, block.axes
            state = _closed_door(positions[0])
        kept = _swing(positions, samples, state, tolerance_mm)
        rows = np.vstack([np.r_[0.0, positions[0]], kept]) if first else kept
        samples += len(positions)
        if len(rows):
            yield Path(start_s + rows[:, 0] / rate_hz, np.ascontiguousarray(rows[:, 1:]), axes)
    if state is not None and samples > 1:
        yield Path(start_s + state[1:2, 0] / rate_hz, state[1:2, 1:].copy(), axes)


def _closed_door(first_mm: Array) -> Array:
    """State of the door: rows anchor, newest sample (index, position…), lowest and highest slope per axis."""
    state = np.zeros((4, len(first_mm) + 1))
    state[0, 1:] = state[1, 1:] = first_mm
    state[2], state[3] = -np.inf, np.inf
    return state


@njit(cache=True, nogil=True)
def _swing(positions_mm, first_index, state, tolerance_mm):  # type: ignore[no-untyped-def]
    """Pass a block through the door; the rows (index, position…) that must be kept."""
    n, axes = positions_mm.shape
    kept = np.empty((n, axes + 1))
    count = 0
    for i in range(n):
        steps = first_index + i - state[0, 0]
        if steps == 0:
            continue
        inside = True
        for j in range(axes):
            slope = (positions_mm[i, j] - state[0, j + 1]) / steps
            inside = inside and state[2, j + 1] <= slope <= state[3, j + 1]
        if not inside:  # the newest sample becomes the anchor, and the door swings open again
            kept[count] = state[1]
            count += 1
            state[0] = state[1]
            state[2, :], state[3, :] = -np.inf, np.inf
            steps = first_index + i - state[0, 0]
        for j in range(axes):
            low = (positions_mm[i, j] - tolerance_mm - state[0, j + 1]) / steps
            high = (positions_mm[i, j] + tolerance_mm - state[0, j + 1]) / steps
            state[2, j + 1] = max(state[2, j + 1], low)
            state[3, j + 1] = min(state[3, j + 1], high)
            state[1, j + 1] = positions_mm[i, j]
        state[1, 0] = first_index + i
    return kept[:count].copy()
