"""One ink of several: how much of a pixel the ink of one colour covers, whatever other inks are on the sheet.

Signals: a colour picture and the colour asked for in; out grey levels, 255 where no such ink is and 0 where
it covers the pixel. A printed grid is another ink.

A pixel on an edge is a mixture of paper and ink, so its colour lies on the straight way from the one to the
other, and how far along it is the share that is covered. The inks are found by the direction in which their
colours lie from the paper's; then w is chosen so that

    share = w · (pixel - paper)     w · (ink - paper) = 1      Σ (w · (other - paper))² + noise² · |w|²  least

over the pixels of other colours. It is linear in the pixel's colour, so that edges stay where they are, to a
part of a pixel.

Source: the matched filter of linear unmixing; our own. Questions: an ink printed over another lets it shine
through or not; both are mixtures here, right to within the other ink's own darkness.
"""

from __future__ import annotations

import math
from typing import Any, Literal, get_args

import cv2
import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.faults import DrawingFault
from morfax.tracer.drawing.components import strips
from morfax.tracer.drawing.paper import Paper
from morfax.tracer.drawing.polarity import Polarity
from morfax.tracer.effort import FEW_PX

Picture = NDArray[np.uint8]  # rows from the top, columns, channels
Colour = tuple[int, int, int]
Tone = Literal["dark", "light"]  # of strokes of any colour
Ink = Colour | Tone

LEAST = 40.0  # levels from the paper's colour: less is paper
NEAR = math.radians(18)  # inks whose colours lie in directions as near as this are one
LIKE = math.radians(35)  # the ink asked for is the nearest within this
FULL = 70.0  # percentile of an ink's pixels, by their distance from paper: these are on no edge
# from grey's direction: further a colour has a hue, nearer it is black or pencil
HUE, NO_HUE = math.radians(10), math.radians(4)
LEAST_SHARE = 0.01  # of all the ink on the sheet
FRINGE_PX = 8  # about a line JPEG makes other colours
EVEN = 6.0  # levels: paper that differs by less is left as it is
# levels: on paper darker than GREY the colours of inks cannot be told; such paper is made as light as WHITE
GREY, WHITE = 200.0, 235.0
NOISE = 5.0  # levels: a scan's, and what JPEG makes of edges


def parsed(text: str) -> Ink:
    """A colour by its name, or as #rgb or #rrggbb, or a tone; raises ValueError for another text."""
    from PIL import ImageColor

    for tone in get_args(Tone):
        if text.strip().lower() == tone:
            return tone
    try:
        return ImageColor.getrgb(text.strip())[:3]
    except ValueError:
        raise ValueError(
            f"{text!r} is no colour; give a name such as blue, or #rrggbb such as #0000c0; or dark or light"
        ) from None


def is_colour(text: str | None) -> bool:
    """Whether an ink that is asked for is to be told by its colour, and no tone."""
    return text is not None and not isinstance(parsed(text), str)


def grey_of(pixels: NDArray[Any], ink: Ink | None, pitch_mm: float | None) -> NDArray[Any]:
    """Grey levels of an ink: covered pixels are dark. Lines of a tone stay as they are.

    Without a pitch shapes are read, which are the dark ones: light ones are made that.
    """
    if isinstance(ink, tuple):
        return covered(np.asarray(pixels, np.uint8), ink, pitch_mm)
    return 255 - np.asarray(pixels) if ink == "light" and pitch_mm is None else pixels


def polarity_of(ink: Ink | None) -> Polarity | None:
    """Whether the grey levels of an ink are darker than paper; None if no ink is asked for."""
    return None if ink is None else Polarity(ink != "light")


def covered(
    picture: Picture, wanted: Colour, pitch_mm: float | None = None
) -> NDArray[np.float32]:
    """Grey levels of the ink that is nearest to a colour; raises DrawingFault if no ink is like it.

    With a pitch uneven paper is levelled first, in place. Without one it is not: broad areas of ink would
    look like dark paper.
    """
    if pitch_mm is not None:
        _level(picture, pitch_mm)
    paper, inks = _found(picture)
    way = paper - np.array(wanted, float)
    angles = [_unlike(way, paper - ink) for ink in inks] if np.hypot.reduce(way) > LEAST else []
    if not angles or min(angles) > LIKE:
        found = ", ".join(_named(ink) for ink in inks) or "none"
        raise DrawingFault(
            f"there is no ink of the colour {_named(np.array(wanted))} on paper of {_named(paper)};"
            f" the colours found are {found}; give one of them with --ink"
        )
    own = int(np.argmin(angles))
    apart = [_angle(paper - ink, paper - inks[own]) for k, ink in enumerate(inks) if k != own]
    near = min([NEAR, *(angle / 2 for angle in apart)])
    weights = _weights(picture, paper, inks[own] - paper, near)
    grey = np.empty(picture.shape[:2], np.float32)
    for top, bottom, _ in strips(grey.shape):
        share = picture[top:bottom].astype(np.float32) @ weights - paper @ weights
        grey[top:bottom] = 255 - 255 * share
    return grey


def _level(picture: Picture, pitch_mm: float) -> None:
    """Make light paper as light all over as it usually is, and white if it is grey, channel by channel."""
    for channel in np.moveaxis(picture, 2, 0):
        paper = Paper.of(channel, pitch_mm)
        usual = float(np.median(paper.reduced))
        is_even = np.abs(np.percentile(paper.reduced, [2, 98]) - usual).max() < EVEN
        if not paper.is_light or (is_even and usual > GREY):
            continue
        for top, bottom, _ in strips(channel.shape):
            gain = max(usual, WHITE) / np.maximum(paper.rows(top, bottom), 1.0)
            channel[top:bottom] = np.clip(np.round(channel[top:bottom] * gain), 0, 255)


def _weights(picture: Picture, paper: Array, own: Array, near: float) -> Array:
    """The weights that give 1 for an ink's colour and as little as possible for other inks.

    Other inks are sought away from that ink: its fringes have any colour.
    """
    spread, count = np.zeros((3, 3)), 1
    about = np.ones((2 * FRINGE_PX + 1,) * 2, np.uint8)
    for top, bottom, rows in strips(picture.shape[:2], halo=FRINGE_PX):
        part = picture[rows].astype(np.float32) - paper.astype(np.float32)
        far = np.sqrt(np.einsum("ijk,ijk->ij", part, part))
        least = math.cos(near) * np.hypot.reduce(own) * far
        like = (far > LEAST) & (part @ own.astype(np.float32) > least)
        other = (far > LEAST) & (cv2.dilate(like.view(np.uint8), about) == 0)
        inner = slice(top - rows.start, bottom - rows.start)
        seen = part[inner][other[inner]].astype(float)
        spread += seen.T @ seen
        count += int(np.count_nonzero(like[inner]))
    weights = np.linalg.solve(spread / count + NOISE**2 * np.eye(3), own)
    return np.asarray(weights / (own @ weights))


def _sample(picture: Picture) -> Array:
    """Some of the pixels, (n, 3)."""
    pixels = picture.reshape(-1, 3)
    return pixels[:: max(1, len(pixels) // FEW_PX)].astype(float)


def _found(picture: Picture) -> tuple[Array, list[Array]]:
    """The paper's colour, which is the most frequent one, and those of the inks, the most frequent first."""
    # 1. the paper
    pixels = _sample(picture)
    bins = np.floor(pixels / 16).astype(int) @ [256, 16, 1]
    paper = np.median(pixels[bins == np.bincount(bins).argmax()], axis=0)
    ways = paper - pixels
    far = np.hypot.reduce(ways, axis=1)
    ways, far, pixels = ways[far > LEAST], far[far > LEAST], pixels[far > LEAST]
    # 2. the inks, by the directions of their colours from the paper's
    units, left, inks = ways / far[:, None], np.ones(len(far), bool), list[Array]()
    total = far.sum()
    while left.any():
        own = left & (units @ _densest(units[left], far[left]) > math.cos(NEAR))
        if far[own].sum() < LEAST_SHARE * total:
            break
        full = own & (far >= np.percentile(far[own], FULL))
        inks.append(np.median(pixels[full], axis=0))
        left &= ~own
    return paper, inks


def _densest(units: Array, weights: Array) -> Array:
    """The direction in which most colours lie."""
    bins = np.round(units * 6).astype(int) @ [400, 20, 1]
    numbers, inverse = np.unique(bins, return_inverse=True)
    own = inverse == np.bincount(inverse, weights, len(numbers)).argmax()
    mean = np.average(units[own], axis=0, weights=weights[own])
    return np.asarray(mean / np.hypot.reduce(mean))


def _angle(a: Array, b: Array) -> float:
    """Angle between two directions, rad."""
    lengths = float(np.hypot.reduce(a) * np.hypot.reduce(b))
    return math.acos(min(1.0, float(a @ b) / lengths))


def _unlike(wanted: Array, found: Array) -> float:
    """Angle between the directions of the colour that is asked for and of an ink, rad.

    A right angle if the one has a hue and the other is black or pencil.
    """
    grey = np.ones(3)
    has_hue, is_grey = _angle(wanted, grey) > HUE, _angle(found, grey) < NO_HUE
    return math.pi / 2 if has_hue and is_grey else _angle(wanted, found)


def _named(colour: Array) -> str:
    """A colour as the operator would give it: #rrggbb."""
    return "#" + "".join(f"{round(float(level)):02x}" for level in colour)
