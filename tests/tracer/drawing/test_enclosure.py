"""Enclosure: areas of paper and nesting, against OpenCV's hierarchy of contours."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from numpy.typing import NDArray

from morfax.tracer.drawing.components import Patches, runs_of
from morfax.tracer.drawing.enclosure import NONE, Enclosure


def enclosed(picture: NDArray[np.uint8]) -> tuple[Patches, Enclosure]:
    """Patches of a picture, and what they enclose."""
    patches = Patches.of([runs_of(picture, 0)])
    return patches, Enclosure.of(patches, len(picture))


def test_a_ring_in_a_frame_lies_inside_it_and_a_bar_makes_two_areas() -> None:
    """Patches are numbered from the top: frame, bar beside the ring, ring."""
    picture = np.zeros((60, 90), np.uint8)
    cv2.rectangle(picture, (3, 3), (80, 50), 1, 2)
    cv2.circle(picture, (30, 25), 10, 1, 2)
    cv2.line(picture, (20, 25), (40, 25), 1, 2)
    cv2.line(picture, (60, 10), (70, 40), 1, 2)
    _, found = enclosed(picture)
    assert found.inside.tolist() == [NONE, 0, 0]
    assert found.loops(np.ones(3)).tolist() == [1, 0, 2]
    assert found.loops(np.full(3, 300.0)).tolist() == [1, 0, 0]


def test_paper_that_touches_at_a_corner_is_apart_and_ink_is_not() -> None:
    """Two areas of a pixel each, corner to corner, in one patch."""
    picture = np.array([[0, 1, 1, 0], [1, 0, 1, 1], [1, 1, 0, 1], [0, 1, 1, 0]], np.uint8)
    patches, found = enclosed(picture)
    assert patches.count == 1 and found.areas_px.tolist() == [1, 1]


def test_a_patch_at_the_edge_of_the_sheet_encloses_nothing() -> None:
    picture = np.zeros((30, 30), np.uint8)
    picture[:, 10:12] = picture[10:12, :] = 1
    assert enclosed(picture)[1].round_area.tolist() == []


@pytest.mark.parametrize("seed", range(8))
def test_areas_and_nesting_are_those_of_opencv(seed: int) -> None:
    """Random circles and lines: as many areas, as deep in one another, as in OpenCV's tree."""
    rng = np.random.default_rng(seed)
    picture = np.zeros((200, 260), np.uint8)
    for _ in range(40):
        x, y, radius = (int(v) for v in rng.integers((5, 5, 2), (255, 195, 50)))
        cv2.circle(picture, (x, y), radius, 1, int(rng.integers(1, 4)))
    patches, found = enclosed(picture)
    padded = np.pad(picture, 1)
    contours, tree = cv2.findContours(padded, cv2.RETR_CCOMP, cv2.CHAIN_APPROX_NONE)
    holes = sum(row[3] != -1 for row in tree[0])
    assert (len(contours) - holes, holes) == (patches.count, len(found.areas_px))
    _, deep = cv2.findContours(padded, cv2.RETR_TREE, cv2.CHAIN_APPROX_NONE)
    depths = [_depth(deep[0][:, 3], k) for k in range(len(contours))]
    ink = sorted(depth // 2 for depth in depths if depth % 2 == 0)
    assert sorted(_depth(found.inside, k) for k in range(patches.count)) == ink


def _depth(parents: NDArray[np.int64], k: int) -> int:
    """How many stand above an entry of a tree."""
    depth = 0
    while parents[k] != NONE:
        k, depth = int(parents[k]), depth + 1
    return depth
