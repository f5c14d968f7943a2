"""A small spot: what it sees of a line of pixels, and of as many lines as it is high.

Signals: lines of pixels and the weights of the spot in; what it sees of each pixel out.

The weights are those of OpenCV's Gaussian, multiplied and added in OpenCV's order: what the spot sees is the
same to the bit.

Source: our own.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from morfax.motion.compiled import njit


def weights_of(spread_px: float) -> NDArray[np.float32]:
    """OpenCV's weights of a spot of a standard deviation."""
    size = round(8 * spread_px + 1) | 1
    return np.asarray(cv2.getGaussianKernel(size, spread_px, cv2.CV_32F)[:, 0], np.float32)


@njit(cache=True, nogil=True)
def with_mirrored(line, begin, part):  # type: ignore[no-untyped-def]
    """Copy a part of a line from `begin` on; beyond its ends it is mirrored."""
    if begin >= 0 and begin + len(part) <= len(line):
        inner = line[begin : begin + len(part)]
        for j in range(len(part)):
            part[j] = inner[j]
        return
    for j in range(len(part)):
        part[j] = line[mirrored(begin + j, len(line))]


@njit(cache=True, nogil=True, fastmath={"contract"})
def row_of_spot(line, weights, seen):  # type: ignore[no-untyped-def]
    """Weigh each pixel with those beside it; the line is longer by the reach of the spot at both ends."""
    weight = weights[0]
    for j in range(len(seen)):
        seen[j] = weight * line[j]
    for d in range(1, len(weights)):
        weight, beside = weights[d], line[d:]
        for j in range(len(seen)):
            seen[j] += weight * beside[j]


@njit(cache=True, nogil=True, fastmath={"contract"})
def column_of_spot(lines, begin, middle, weights, seen):  # type: ignore[no-untyped-def]
    """Weigh the pixels of as many lines as the spot is high, about a middle one, from `begin` on."""
    reach, end = len(weights) // 2, begin + len(seen)
    weight, line = weights[reach], lines[middle, begin:end]
    for j in range(len(seen)):
        seen[j] = weight * line[j]
    for d in range(1, reach + 1):
        weight = weights[reach + d]
        above, below = lines[middle - d, begin:end], lines[middle + d, begin:end]
        for j in range(len(seen)):
            seen[j] += weight * (above[j] + below[j])


@njit(cache=True, nogil=True)
def mirrored(k, count):  # type: ignore[no-untyped-def]
    """The place of a pixel beyond the picture that is mirrored about the middle of its last pixel."""
    if count == 1:
        return 0
    while k < 0 or k >= count:
        k = -k if k < 0 else 2 * count - 2 - k
    return k
