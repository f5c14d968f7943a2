"""The fit: a projection from edges that were found in the photograph and whose place on the sheet is known.

Signals in: places in the photograph (px), each on an edge whose line on the sheet is known; out: the
projection, and how far each edge is then from its line, mm on the sheet.

    residual = normal · to_sheet(place) - offset - gain

An edge tells one coordinate only, across it: so marks and the sheet's own edges are fitted alike. The gain is
how much ink spreads marks on all sides, mm; it stands in their fit only, since of a sheet's own edges it
would be another size.

Source: bundle adjustment of one view; scipy's least squares. Questions: paper that is not flat is not in the
model; what it does stays in the residual, which is reported.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import cv2
import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.tracer.flatten.projection import Projection, Rectangle

# what phones' lenses have, standard deviations: k1 of 0.05 by the focal length is 0.035 here
K1_SPREAD, K2_SPREAD = 0.035, 0.02
PAPER_MM = 0.1  # how flat paper lies, standard deviation: chosen, a sheet of glass does better


@dataclass(frozen=True)
class Sightings:
    """Places in the photograph (n, 2), and the line on the sheet that each is on: normal and offset, mm.

    A sighting belongs to a `place` (n,): a mark, or a stretch of the sheet's edge.
    """

    places_px: Array
    normals: Array
    offsets_mm: Array
    place: NDArray[np.intp]
    softness_px: Array

    @classmethod
    def joined(cls, parts: list[Sightings]) -> Sightings:
        """Several in one; their places are counted on."""
        first = np.cumsum([0, *(int(part.place.max()) + 1 for part in parts)])
        return cls(
            np.vstack([part.places_px for part in parts]),
            np.vstack([part.normals for part in parts]),
            np.concatenate([part.offsets_mm for part in parts]),
            np.concatenate([part.place + k for part, k in zip(parts, first, strict=False)]),
            np.concatenate([part.softness_px for part in parts]),
        )


@dataclass(frozen=True)
class Fit:
    """A projection fitted to sightings, and what is left of them: `residual_mm` (n,), beyond `gain_mm`."""

    projection: Projection
    sightings: Sightings
    residual_mm: Array
    gain_mm: float = 0.0

    @cached_property
    def displaced(self) -> tuple[Array, Array]:
        """Each place's middle in the photograph (m, 2), px, and how far off on the sheet it lies, mm."""
        seen, middles, ways = self.sightings, [], []
        for place in np.unique(seen.place):
            here = seen.place == place
            middles.append(seen.places_px[here].mean(axis=0))
            ways.append(
                np.linalg.lstsq(seen.normals[here], self.residual_mm[here], rcond=1e-3)[0]
            )
        return np.array(middles), np.array(ways)

    @property
    def rms_mm(self) -> float:
        """How far marks, or stretches of edges, lie off, root mean square, mm."""
        return float(np.sqrt(np.mean((self.displaced[1] ** 2).sum(axis=1))))

    @property
    def max_mm(self) -> float:
        """How far the worst mark, or stretch of an edge, lies off, mm."""
        return float(np.hypot(*self.displaced[1].T).max())

    @property
    def size_share(self) -> float:
        """The worst error in size between two places that are more than half the shorter side apart."""
        middles_px, ways = self.displaced
        at = self.projection.to_sheet(middles_px)
        apart = at[:, None] - at[None]
        lengths = np.hypot(apart[..., 0], apart[..., 1])
        far = lengths > 0.5 * min(self.projection.sheet.width, self.projection.sheet.height)
        if not far.any():
            return 0.0
        along = np.abs((apart * (ways[:, None] - ways[None])).sum(axis=2))
        return float((along[far] / lengths[far] ** 2).max())

    @property
    def softness_px(self) -> float:
        """Softness of the edges, standard deviation, px."""
        return float(np.median(self.sightings.softness_px))


def fitted(
    sightings: Sightings, sheet: Rectangle, photo: Rectangle, first: Array, *, inked: bool
) -> Fit:
    """Fit a projection, from a homography that is nearly right; `inked` edges may have spread."""
    from scipy.optimize import least_squares

    # edges bend with the paper: all sightings of a mark or a stretch weigh as one
    each = 1 / PAPER_MM / np.sqrt(np.bincount(sightings.place)[sightings.place])
    usual = 1 / np.array([K1_SPREAD, K2_SPREAD])

    def residual(numbers: Array) -> Array:
        """What is left of the sightings, and of what lenses usually are, standard deviations."""
        off = _off_mm(sightings, _projection(numbers, sheet, photo))
        gain = numbers[10] if inked else 0.0
        return np.concatenate([each * (off - gain), usual * numbers[8:10]])

    start = np.concatenate([(first / first[2, 2]).ravel()[:8], np.zeros(3 if inked else 2)])
    found = least_squares(residual, start, method="lm", x_scale=1.0).x
    projection = _projection(found, sheet, photo)
    gain = float(found[10]) if inked else 0.0
    return Fit(projection, sightings, _off_mm(sightings, projection) - gain, gain)


def _off_mm(sightings: Sightings, projection: Projection) -> Array:
    """How far sightings are from their lines, outwards, mm."""
    on_sheet = projection.to_sheet(sightings.places_px)
    return np.asarray((on_sheet * sightings.normals).sum(axis=1) - sightings.offsets_mm, float)


def homography_of(
    places_mm: Array, places_px: Array, sheet: Rectangle, photo: Rectangle
) -> Array:
    """The homography between places on the sheet and in the photograph, both from their middles."""
    found, _ = cv2.findHomography(sheet.from_middle(places_mm), photo.from_middle(places_px))
    return np.asarray(found, float)


def _projection(numbers: Array, sheet: Rectangle, photo: Rectangle) -> Projection:
    """The projection of its numbers: eight of the homography, k1, k2."""
    homography = np.append(numbers[:8], 1.0).reshape(3, 3)
    return Projection(sheet, photo, homography, float(numbers[8]), float(numbers[9]))
