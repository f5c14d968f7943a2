"""The projection: where a place on the sheet comes out in the photograph, and back.

Signals: places on the sheet (mm, X right, Y up, from the lower-left corner) and in the photograph (px, from
the upper-left corner, the centre of the first pixel at 0.5, 0.5), each as an array (n, 2).

    w · (u, v, 1) = H · (x, y, 1)            x, y: from the sheet's middle, in its half diagonals
    r² = u² + v²                             u, v: from the photograph's middle, in its half diagonals
    place in the photograph = (u, v) · (1 + k1 · r² + k2 · r⁴)

H is a homography, k1 and k2 are the lens's radial distortion. How far the focal length reaches, in half
diagonals, H tells only where the sheet is tilted; so it is chosen as the likeliest with which H is a sheet
that stands rigidly before the lens.

Source: Brown 1966 for the distortion; Zhang 2000 for the focal length of a homography. Questions: the middle
of the photograph is taken for the axis of the lens; of a photograph that was cropped it is not, and the
residual tells.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from morfax.motion.arrays import NOT_ZERO, Array

# of the film that focal lengths are compared with, mm
HALF_DIAGONAL_35MM = math.hypot(36.0, 24.0) / 2
# of phones' main cameras, 23 to 28 mm on film of 35 mm: the middle, and the spread of its logarithm
USUAL_FOCAL_MM, USUAL_SPREAD = 26.0, 0.15
STATED_SPREAD = 0.03  # of a focal length that the file states: it is rounded to whole mm
RIGID = 0.005  # standard deviation of the rules of a rigid sheet: a fit to edges gives a few thousandths
NEWTON_STEPS = 8  # to undo the distortion to 1e-12 for |k1| up to 0.2


class Focal(NamedTuple):
    """Focal length in half diagonals of the photograph, and the standard deviation of its logarithm."""

    length: float = USUAL_FOCAL_MM / HALF_DIAGONAL_35MM
    spread: float = USUAL_SPREAD

    @classmethod
    def stated(cls, film_mm: float) -> Focal:
        """The focal length that a file states, as on film of 35 mm."""
        return cls(film_mm / HALF_DIAGONAL_35MM, STATED_SPREAD)


@dataclass(frozen=True, slots=True)
class Rectangle:
    """A rectangle about whose middle places are taken, in its half diagonals."""

    width: float
    height: float

    @property
    def half_diagonal(self) -> float:
        """Half the diagonal."""
        return math.hypot(self.width, self.height) / 2

    def from_middle(self, places: Array) -> Array:
        """Places from the middle, in half diagonals."""
        middle = np.array([self.width / 2, self.height / 2])
        return np.asarray((places - middle) / self.half_diagonal, float)

    def from_corner(self, places: Array) -> Array:
        """Places from the corner, of those in half diagonals from the middle."""
        middle = np.array([self.width / 2, self.height / 2])
        return np.asarray(places * self.half_diagonal + middle, float)


@dataclass(frozen=True, slots=True)
class Projection:
    """How a sheet (mm) comes out in a photograph (px): homography (3, 3) and radial distortion."""

    sheet: Rectangle
    photo: Rectangle
    homography: Array
    k1: float = 0.0
    k2: float = 0.0

    def to_photo(self, places_mm: Array) -> Array:
        """Where places on the sheet are in the photograph, px."""
        ideal = projected(self.homography, self.sheet.from_middle(places_mm))
        r2 = (ideal**2).sum(axis=-1, keepdims=True)
        return self.photo.from_corner(ideal * (1 + self.k1 * r2 + self.k2 * r2**2))

    def to_sheet(self, places_px: Array) -> Array:
        """Which places on the sheet are seen at places in the photograph, mm."""
        ideal = undistorted(self.photo.from_middle(places_px), self.k1, self.k2)
        return self.sheet.from_corner(
            projected(np.asarray(np.linalg.inv(self.homography), float), ideal)
        )

    def corners_px(self) -> Array:
        """The sheet's corners in the photograph, px, clockwise from the upper left."""
        w, h = self.sheet.width, self.sheet.height
        return self.to_photo(np.array([(0, h), (w, h), (w, 0), (0, 0)], float))

    def mm_per_px(self, places: int = 15) -> tuple[float, float]:
        """Finest and coarsest scale anywhere on the sheet and in any direction, mm per pixel."""
        step_mm = 0.01
        x, y = np.meshgrid(
            np.linspace(0, self.sheet.width, places), np.linspace(0, self.sheet.height, places)
        )
        at = np.column_stack([x.ravel(), y.ravel()])
        here = self.to_photo(at)
        ways = [(self.to_photo(at + step) - here) / step_mm for step in step_mm * np.eye(2)]
        stretches = np.linalg.svd(np.stack(ways, axis=2), compute_uv=False)
        return 1 / float(stretches.max()), 1 / float(stretches.min())

    def tilt_rad(self, focal: Focal) -> float:
        """Angle between the axis of the lens and the normal of the sheet, rad."""
        pose = Pose.of(self.homography, focal)
        return pose.tilt_rad


class Pose(NamedTuple):
    """How a rigid sheet stands before the lens: its tilt (rad), and how much too long its X seems.

    `off` is in standard deviations of what a rigid sheet allows.
    """

    tilt_rad: float
    stretch: float
    off: float

    @classmethod
    def of(cls, homography: Array, focal: Focal) -> Pose:
        """The likeliest pose of a sheet with a homography from places about its middle."""
        from scipy.optimize import minimize_scalar

        def off(log_length: float) -> float:
            aside, stretch, _ = _rules(homography, focal.length * math.exp(log_length))
            return (
                (aside / RIGID) ** 2
                + (math.log(stretch) / RIGID) ** 2
                + (log_length / focal.spread) ** 2
            )

        best = minimize_scalar(
            off, bounds=(-4 * focal.spread, 4 * focal.spread), method="bounded"
        )
        _, stretch, tilt = _rules(homography, focal.length * math.exp(best.x))
        return cls(tilt, stretch, math.sqrt(best.fun))


def projected(homography: Array, places: Array) -> Array:
    """Places (n, 2) through a homography."""
    lifted = places @ homography[:, :2].T + homography[:, 2]
    return np.asarray(lifted[..., :2] / lifted[..., 2:], float)


def undistorted(places: Array, k1: float, k2: float) -> Array:
    """Places as a lens without distortion would have them, of those that a lens drew."""
    drawn = np.hypot(*places.T)
    r = drawn.copy()
    for _ in range(NEWTON_STEPS):
        r2 = r * r
        slope = 1 + 3 * k1 * r2 + 5 * k2 * r2**2
        r -= (r * (1 + k1 * r2 + k2 * r2**2) - drawn) / np.where(
            np.abs(slope) > 0.1, slope, 0.1
        )
    return places * (r / np.maximum(drawn, NOT_ZERO))[:, None]


def _rules(homography: Array, focal: float) -> tuple[float, float, float]:
    """How far X and Y are from square (cosine), how many times X is longer than Y, and the tilt, rad."""
    along = homography[:, :2] / np.array([[focal], [focal], [1.0]])
    x, y = along.T
    x_long = np.linalg.norm(x)
    y_long = np.linalg.norm(y)
    normal = np.cross(x, y)
    tilt = math.acos(min(1.0, abs(float(normal[2])) / float(np.linalg.norm(normal))))
    return float(x @ y) / float(x_long * y_long), float(x_long / y_long), tilt
