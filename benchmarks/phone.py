"""A phone that photographs a sheet: a simulated camera, whose truth is known.

Signals in: a sheet as pixels, its size in mm, and how it is held; out the photograph (rows, columns, 3), and
where every place on the sheet comes out in it.

The camera is a pinhole with the lens of Brown (k1, k2 in units of the focal length, as OpenCV counts them).
Light from the sheet falls off to one side (a shadow), is blurred, gets noise, and is written by the curve of
sRGB; a JPEG loses what JPEGs lose. It shares nothing with `tracer.flatten`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

Picture = NDArray[np.uint8]
Array = NDArray[np.float64]

FOCAL_35MM = 26.0  # as on film of 35 mm, whose diagonal is 43.27 mm
FILM_MM = math.hypot(36.0, 24.0)
TABLE = (70, 58, 48)  # a table's colour


@dataclass(frozen=True)
class Phone:
    """How a sheet is photographed; lengths in mm, angles in rad, blur in px."""

    columns: int = 3024
    rows: int = 4032
    tilt_rad: float = 0.0
    about_rad: float = 0.0  # in which direction it is tilted
    turn_rad: float = 0.0  # about the axis of the lens
    k1: float = 0.0
    k2: float = 0.0
    fills: float = 0.92  # of the photograph, by the sheet
    blur_px: float = 1.2
    shadow: float = 0.35  # of the light, lost at one corner
    noise: float = 0.004  # standard deviation, of white
    quality: int = 85  # of the JPEG
    seed: int = 1

    @property
    def focal_px(self) -> float:
        """Focal length, px."""
        return FOCAL_35MM / FILM_MM * math.hypot(self.columns, self.rows)

    def to_photo(self, places_mm: Array, size_mm: tuple[float, float]) -> Array:
        """Where places (n, 2) on a sheet (Y up, from the lower left) come out, px."""
        return self._seen(np.asarray(places_mm, float), size_mm, self._aimed_mm(size_mm))

    def _seen(self, places_mm: Array, size_mm: tuple[float, float], middle_mm: Array) -> Array:
        """Where places come out, px, if the sheet's middle is so far right, down and away."""
        rays = self._turned(places_mm, size_mm) + middle_mm
        u = rays[:, :2] / rays[:, 2:]
        r2 = (u**2).sum(axis=1, keepdims=True)
        u = u * (1 + self.k1 * r2 + self.k2 * r2**2)
        return u * self.focal_px + np.array([self.columns / 2, self.rows / 2])

    def _turned(self, places_mm: Array, size_mm: tuple[float, float]) -> Array:
        """Places (n, 3) before the lens: X right, Y down, Z away, about the sheet's middle."""
        about, turn, tilt = self.about_rad, self.turn_rad, self.tilt_rad
        way = np.array([math.cos(about), math.sin(about), 0.0])
        rotated, _ = cv2.Rodrigues(way * tilt)
        in_plane, _ = cv2.Rodrigues(np.array([0.0, 0.0, turn]))
        flat = np.column_stack([places_mm - np.array(size_mm) / 2, np.zeros(len(places_mm))])
        return np.asarray((flat * (1, -1, 1)) @ in_plane.T @ rotated.T, float)

    def _aimed_mm(self, size_mm: tuple[float, float]) -> Array:
        """Where the sheet's middle is before the lens (right, down, away): it fills the photograph."""
        w, h = size_mm
        half = np.array([(0, 0), (w, 0), (w / 2, 0), (w, h / 2)], float)
        around = np.vstack([half, (w, h) - half])
        frame = np.array([self.columns, self.rows], float)
        middle_mm = np.array([0.0, 0.0, 2.0 * max(size_mm)])
        for _ in range(30):
            seen = self._seen(around, size_mm, middle_mm)
            low, high = seen.min(axis=0), seen.max(axis=0)
            middle_mm[2] *= float(((high - low) / frame).max()) / self.fills
            middle_mm[:2] -= ((low + high) / 2 - frame / 2) * middle_mm[2] / self.focal_px
        return middle_mm

    def photograph(self, sheet: Picture, size_mm: tuple[float, float]) -> Picture:
        """The photograph of a sheet (rows from the top, columns, 3) that covers a size."""
        at = self._on_sheet(size_mm)
        px_per_mm = sheet.shape[1] / size_mm[0]
        x = (at[..., 0] * px_per_mm - 0.5).astype(np.float32)
        y = ((size_mm[1] - at[..., 1]) * px_per_mm - 0.5).astype(np.float32)
        seen = cv2.remap(
            sheet, x, y, cv2.INTER_LINEAR, borderMode=cv2.BORDER_CONSTANT, borderValue=TABLE
        )
        light = _LIGHT[seen]
        light *= self._light()[..., None]
        light = cv2.GaussianBlur(light, (0, 0), self.blur_px)
        random = np.random.default_rng(self.seed)
        light += random.standard_normal(light.shape[:2], np.float32)[..., None] * self.noise
        levels = _LEVELS[np.clip(light * _FINE + 0.5, 0, _FINE).astype(np.uint16)]
        good, packed = cv2.imencode(
            ".jpg", levels[..., ::-1], [cv2.IMWRITE_JPEG_QUALITY, self.quality]
        )
        assert good
        opened = cv2.imdecode(packed, cv2.IMREAD_COLOR)
        assert opened is not None
        return np.ascontiguousarray(opened[..., ::-1], np.uint8)

    def write(self, sheet: Picture, size_mm: tuple[float, float], file: Path) -> None:
        """Write the photograph as a JPEG that says that a camera made it."""
        from PIL import Image

        clear = replace(self, quality=100).photograph(sheet, size_mm)
        image = Image.fromarray(clear)
        exif = image.getexif()
        exif[0x010F] = "simulated"
        exif.get_ifd(0x8769).update({0x829A: 0.01, 0x920A: 4.3, 0xA405: round(FOCAL_35MM)})
        image.save(file, quality=self.quality, exif=exif)

    def _on_sheet(self, size_mm: tuple[float, float]) -> NDArray[np.float32]:
        """Which place on the sheet's plane each pixel sees (rows, columns, 2), mm."""
        columns, rows = np.arange(self.columns) + 0.5, np.arange(self.rows) + 0.5
        u = np.stack(np.meshgrid(columns, rows), axis=-1).astype(np.float32)
        u -= np.array([self.columns / 2, self.rows / 2], np.float32)
        u /= np.float32(self.focal_px)
        drawn = np.sqrt((u**2).sum(axis=2))
        r = drawn.copy()
        for _ in range(6):  # fixed points, to 1e-4 px for |k1| up to 0.05
            r = drawn / (1 + self.k1 * r**2 + self.k2 * r**4)
        u *= (r / np.maximum(drawn, 1e-9))[..., None]
        # the plane before the lens: w (u, v, 1) = corner + x · along + y · up
        corner, along, up = self._turned(
            np.array([(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)]), size_mm
        )
        plane = np.column_stack([along - corner, up - corner, corner + self._aimed_mm(size_mm)])
        back = np.linalg.inv(plane).astype(np.float32)
        along_rays, up_rays = u[..., 0, None] * back[:, 0], u[..., 1, None] * back[:, 1]
        rays = along_rays + up_rays + back[:, 2]
        return np.asarray(rays[..., :2] / rays[..., 2:], np.float32)

    def _light(self) -> NDArray[np.float32]:
        """How much of the light falls on each pixel: less towards one corner, with a soft edge across."""
        x = np.linspace(0, 1, self.columns, dtype=np.float32)
        y = np.linspace(0, 1, self.rows, dtype=np.float32)[:, None]
        shadow = 1 / (1 + np.exp((x + y - 0.9) / 0.12))
        return np.asarray(0.85 - self.shadow * shadow, np.float32)


def _light_of(level: Array) -> Array:
    """Light 0..1 of levels 0..1, by the curve of sRGB."""
    return np.where(level <= 0.04045, level / 12.92, ((level + 0.055) / 1.055) ** 2.4)


def _level_of(light: Array) -> Array:
    """Levels 0..1 of light 0..1."""
    return np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)


_FINE = 65535  # steps of light
_LIGHT = _light_of(np.arange(256) / 255).astype(np.float32)
_LEVELS = np.round(_level_of(np.arange(_FINE + 1) / _FINE) * 255).astype(np.uint8)
