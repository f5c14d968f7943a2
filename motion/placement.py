"""Placement: a motion mirrored, scaled and turned before it is recorded; Z and further axes stay as they are.

Signals: a stream of Motion or a Path in, the same out. With c the point that stays where it is:

    place' = c + scale · R(turn) · M (place - c) - origin      M: X or Y the other way; R: counter-clockwise

The point is the start of the motion (the reference point of the patent, where the head stands when the tape
starts) unless another is given. Times stay, so what is scaled by 2 runs twice as fast.

Source: patent ES 361967, lines 508 to 513: a mirror image "by regrouping the circuit" so that a drive turns
the other way; the tape then holds the same displacements from the same start with one sign changed, which is
M about the start. Questions: turn and scale are not in the patent. A turn is what turning the drawing on the
table gives, a scale what a changed gear 113 between screw and pick-up gives; like the mirror they are made
where the tape is.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.motion import Motion, Path

_MIRRORS = {"": (1.0, 1.0), "x": (-1.0, 1.0), "y": (1.0, -1.0)}


@dataclass(frozen=True, slots=True)
class Placement:
    """What is done to a motion: mirror ("x", "y" or none), scale and turn about a point; the new zero."""

    mirror: str = ""
    scale: float = 1.0
    turn_rad: float = 0.0
    about_mm: tuple[float, float] | None = None
    origin_mm: tuple[float, float] = (0.0, 0.0)  # the machine's zero, before anything is done

    def __post_init__(self) -> None:
        if self.mirror not in _MIRRORS:
            raise ValueError(f"{self.mirror!r} is no axis to mirror; give x or y, or nothing")
        if not (math.isfinite(self.scale) and self.scale > 0):
            raise ValueError(f"a scale of {self.scale} leaves no contour; give one above zero")

    @property
    def is_plain(self) -> bool:
        """Whether it changes nothing."""
        return bool(np.array_equal(self.matrix, np.eye(2))) and not any(self.origin_mm)

    @property
    def matrix(self) -> Array:
        """Scale · turn · mirror, (2, 2); quarter turns are exact."""
        cosine = round(math.cos(self.turn_rad), 15)
        sine = round(math.sin(self.turn_rad), 15)
        rotation = np.array([[cosine, -sine], [sine, cosine]])
        return self.scale * rotation * np.array(_MIRRORS[self.mirror])

    def about(self, start_mm: Array) -> Placement:
        """The same with its point: the one given, or where the motion starts."""
        if self.about_mm is not None:
            return self
        return replace(self, about_mm=(float(start_mm[0]), float(start_mm[1])))

    def stream(self, stream: Iterable[Motion]) -> Iterable[Motion]:
        """A stream, placed; the stream itself where nothing changes."""
        return stream if self.is_plain else self._placed(stream)

    def path(self, path: Path) -> Path:
        """A path, placed."""
        placement = self.about(path.positions_mm[0])
        return replace(path, positions_mm=placement._moved(path.positions_mm, self.matrix))

    def back(self, path: Path) -> Path:
        """A path that was placed about a known point, as it was before."""
        moved = np.array(path.positions_mm, np.float64)
        moved[:, :2] = self.places_back(moved[:, :2])
        return replace(path, positions_mm=moved)

    def places(self, places_mm: Array) -> Array:
        """Places (n, 2) mm, placed about a known point."""
        return self._moved(places_mm, self.matrix)

    def places_back(self, places_mm: Array) -> Array:
        """Places (n, 2) mm that were placed about a known point, as they were before."""
        undo = replace(self, origin_mm=(0.0, 0.0))
        inverse = np.asarray(np.linalg.inv(self.matrix), np.float64)
        return undo._moved(places_mm + np.array(self.origin_mm), inverse)

    def _placed(self, stream: Iterable[Motion]) -> Iterator[Motion]:
        """Place block by block."""
        placement = self
        for block in stream:
            if placement.about_mm is None and len(block.positions_mm):
                placement = self.about(block.positions_mm[0])
            moved = placement._moved(block.positions_mm, placement.matrix)
            yield replace(block, positions_mm=moved)

    def _moved(self, positions_mm: Array, matrix: Array) -> Array:
        """Positions with X and Y put through a matrix about the point."""
        moved, point_mm = (
            np.array(positions_mm, np.float64),
            np.array(self.about_mm, np.float64),
        )
        moved[:, :2] = (moved[:, :2] - point_mm) @ matrix.T + point_mm - self.origin_mm
        return moved
