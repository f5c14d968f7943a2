"""Edges in a photograph, to a part of a pixel: where light falls through half between both sides of an edge.

Signals: a picture (rows from the top, columns, 3 colours of 8 bits) and places near an edge with the way
across it, px; out the places on the edge, and how soft it is.

Blur spreads light, and light is not what a picture's levels count: half the light is level 188 of 255. So
levels are turned into light first, by the curve of sRGB. By the levels themselves a blurred sheet is seen too
large, by 0.8 standard deviations of the blur on every side.

Source: IEC 61966-2-1 for the curve. Questions: phones bend the curve of bright and dark parts by their own
recipes; what is left moves all edges of a sheet outwards alike.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import NOT_ZERO, Array
from morfax.tracer.effort import FINE_PX

Picture = NDArray[np.uint8]  # rows from the top, columns, red green blue

# of the usual difference in light: where an edge has less, something lies on it
LEAST_SHARE = 0.3
LEAST_LIGHT = 0.015  # of white: between both sides of an edge that can be placed
NEAR_PX = 2.0  # from the steepest place to half the light; further is a second edge

_LEVELS = np.arange(256) / 255
LIGHT = np.where(_LEVELS <= 0.04045, _LEVELS / 12.92, ((_LEVELS + 0.055) / 1.055) ** 2.4)


class Crossings(NamedTuple):
    """Places on an edge (n, 2), px; which of those asked for they are; softness, standard deviation, px."""

    places_px: Array
    of: NDArray[np.intp]
    softness_px: Array


def crossings(
    picture: Picture, places_px: Array, outward: Array, reach_px: float, averaged: int = 1
) -> Crossings:
    """Find an edge near places (n, 2), looking `reach_px` to both sides along unit vectors (n, 2).

    Each profile is averaged with its neighbours, so that a rough edge or a noisy picture has one edge.
    """
    count = max(8, math.ceil(reach_px / FINE_PX))
    across = np.arange(-count, count + 1) * (reach_px / count)
    at = places_px[:, None, :] + across[None, :, None] * outward[:, None, :]
    seen = light_at(picture, at)
    # 1. the mixture of colours in which both sides differ most
    part = len(across) // 4
    inner = seen[:, :part].mean(axis=1)
    outer = seen[:, -part:].mean(axis=1)
    step = np.median(inner - outer, axis=0)
    if not np.linalg.norm(step) > LEAST_LIGHT:
        return Crossings(np.empty((0, 2)), np.empty(0, np.intp), np.empty(0))
    profiles = _averaged(seen @ (step / np.linalg.norm(step)), averaged)
    # 2. half between both sides, nearest to the steepest place
    high = profiles[:, :part].mean(axis=1)
    low = profiles[:, -part:].mean(axis=1)
    half = (high + low) / 2
    fall = -np.gradient(profiles, across, axis=1)
    steepest = np.argmax(fall, axis=1)
    is_light = profiles >= half[:, None]
    is_dark = profiles < half[:, None]
    falls = is_light[:, :-1] & is_dark[:, 1:]
    index = np.arange(len(across) - 1)
    away = np.where(falls, np.abs(index - steepest[:, None]), len(across))
    k = np.argmin(away, axis=1)
    rows = np.arange(len(profiles))
    contrast = high - low
    good = contrast > max(LEAST_LIGHT, LEAST_SHARE * float(np.median(contrast)))
    good &= away[rows, k] * (across[1] - across[0]) <= NEAR_PX
    before = profiles[rows, k]
    after = profiles[rows, k + 1]
    share = (before - half) / np.maximum(before - after, NOT_ZERO)
    found = across[k] + share * (across[k + 1] - across[k])
    softness = contrast / (math.sqrt(2 * math.pi) * np.maximum(fall[rows, steepest], NOT_ZERO))
    places = places_px + found[:, None] * outward
    return Crossings(places[good], np.flatnonzero(good), softness[good])


def light_at(picture: Picture, places_px: Array) -> Array:
    """Light (…, 3), white 1, at places (…, 2) in a picture, in straight proportion between its pixels."""
    rows, columns = picture.shape[:2]
    x = np.clip(places_px[..., 0] - 0.5, 0, columns - 1.001)
    y = np.clip(places_px[..., 1] - 0.5, 0, rows - 1.001)
    left, top = x.astype(int), y.astype(int)
    x = (x - left)[..., None]
    y = (y - top)[..., None]
    right, bottom = left + 1, top + 1
    upper_left, upper_right = LIGHT[picture[top, left]], LIGHT[picture[top, right]]
    lower_left, lower_right = LIGHT[picture[bottom, left]], LIGHT[picture[bottom, right]]
    upper = (1 - x) * upper_left + x * upper_right
    lower = (1 - x) * lower_left + x * lower_right
    return np.asarray((1 - y) * upper + y * lower, float)


def _averaged(profiles: Array, over: int) -> Array:
    """Profiles (n, m), each the mean of its neighbours."""
    if over <= 1 or len(profiles) <= over:
        return profiles
    from scipy.ndimage import uniform_filter1d

    return np.asarray(uniform_filter1d(profiles, over, axis=0, mode="nearest"), float)
