"""Which lines there are on a drawing, and where the head may be put down: plans only, never the path.

Signals: a Drawing in; strokes out, each a connected patch of ink with its length, width and places near its middle (sheet mm).

Ink is what is darker than half. A patch's width follows from the mean distance of its pixels to the paper, its length from its area over its width, so
that a patch needs no skeleton. An end is where a disc about a middle place holds much less ink than elsewhere on the line.

Source: patent ES 361967 leaves the choice of the line to the operator, who brings the head over it.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from motion.faults import DrawingFault, LineFault
from tracer.drawing import Drawing

Array = NDArray[np.float64]

INK = 0.5
LEAST_LENGTH_MM = 2.0
LEAST_LENGTH_PX = 12


@dataclass(frozen=True, slots=True)
class Stroke:
    """A connected patch of ink: places near the middle of its line (n, 2) mm, and how much ink there is about each."""

    length_mm: float
    width_mm: float
    middles_mm: Array
    filled: Array

    def ends_mm(self) -> Array:
        """Places that may be ends of the line, most likely first; (n, 2) mm, none closer together than two widths."""
        usual = np.median(self.filled)
        order = np.argsort(self.filled)
        order = order[self.filled[order] < 0.75 * usual]
        kept: list[Array] = []
        for place in self.middles_mm[order]:
            if all(np.hypot(*(place - k)) > 2 * self.width_mm for k in kept):
                kept.append(place)
            if len(kept) == 32:
                break
        return np.array(kept).reshape(-1, 2)


@dataclass(frozen=True, slots=True)
class Sheet:
    """The patches of ink on a drawing."""

    drawing: Drawing
    labels: NDArray[np.int32]
    depth_px: NDArray[np.float32]
    lengths_mm: Array
    widths_mm: Array

    @classmethod
    def of(cls, drawing: Drawing) -> Sheet:
        """Find the patches; raises DrawingFault if none is long enough to be a line."""
        ink = (cv2.GaussianBlur(drawing.darkness, (0, 0), 0.7) > INK).astype(np.uint8)
        count, labels, stats, _ = cv2.connectedComponentsWithStats(ink)
        depth = cv2.distanceTransform(ink, cv2.DIST_L2, cv2.DIST_MASK_PRECISE)
        areas = stats[:, cv2.CC_STAT_AREA].astype(float)
        inked = labels > 0
        depths = np.bincount(labels[inked], weights=depth[inked], minlength=count) / np.maximum(areas, 1)
        widths = np.maximum(4 * depths - 2, 1.0)  # a line of w pixels has depths 1, 2 … w/2 … 2, 1
        lengths = areas / widths * drawing.pitch_mm
        lengths[0] = 0.0
        if lengths.max(initial=0.0) < max(LEAST_LENGTH_MM, LEAST_LENGTH_PX * drawing.pitch_mm):
            raise DrawingFault("no line on the drawing: nothing on it is long enough; check the file and its scale")
        return cls(
            drawing, np.asarray(labels, np.int32), np.asarray(depth, np.float32), lengths, widths * drawing.pitch_mm
        )

    def longest(self) -> Stroke:
        """The longest line."""
        return self._stroke(int(np.argmax(self.lengths_mm)))

    def nearest(self, place_mm: tuple[float, float], within_mm: float) -> Stroke:
        """The line nearest to a place; raises LineFault if none is within reach, and says how far the nearest is."""
        long = self.lengths_mm >= max(LEAST_LENGTH_MM, LEAST_LENGTH_PX * self.drawing.pitch_mm)
        rows, columns = np.nonzero(long[self.labels])
        x, y = self._mm(rows, columns).T
        distances = np.hypot(x - place_mm[0], y - place_mm[1])
        best = int(np.argmin(distances))
        if distances[best] > within_mm:
            raise LineFault(
                f"no line within {within_mm:g} mm of {place_mm[0]:g},{place_mm[1]:g} mm: the nearest is {distances[best]:.1f} mm away,"
                f" at {x[best]:.1f},{y[best]:.1f}; start there, or leave --start out for the longest line",
                x_mm=place_mm[0],
                y_mm=place_mm[1],
            )
        return self._stroke(int(self.labels[rows[best], columns[best]]))

    def _mm(self, rows: NDArray[np.intp], columns: NDArray[np.intp]) -> Array:
        pitch = self.drawing.pitch_mm
        return np.column_stack([(columns + 0.5) * pitch, (self.labels.shape[0] - rows - 0.5) * pitch])

    def _stroke(self, label: int) -> Stroke:
        """The patch of a label with its middle places: pixels no neighbour of which is deeper in the ink."""
        rows, columns = np.nonzero(self.labels == label)
        top, left = rows.min(), columns.min()
        patch = (slice(top, rows.max() + 1), slice(left, columns.max() + 1))
        own = (self.labels[patch] == label).astype(np.float32)
        depth = self.depth_px[patch] * own
        middle = (depth > 0) & (depth >= cv2.dilate(depth, np.ones((3, 3), np.uint8)) - 0.3)
        disc_px = max(4, round(1.5 * self.widths_mm[label] / self.drawing.pitch_mm))
        size = 2 * disc_px + 1
        disc = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (size, size)).astype(np.float32)
        filled = cv2.filter2D(own, cv2.CV_32F, disc, borderType=cv2.BORDER_CONSTANT)
        i, j = np.nonzero(middle)
        return Stroke(
            float(self.lengths_mm[label]),
            float(self.widths_mm[label]),
            self._mm(i + top, j + left),
            filled[i, j].astype(float),
        )
