"""Holes: paper within a patch of ink, counted by Pick's theorem and pixel by pixel."""

from __future__ import annotations

import cv2
import numpy as np
import pytest

import morfax.tracer.drawing.holes
from morfax.tracer.drawing.components import Mask, Patches, runs_of
from morfax.tracer.drawing.holes import Hole, holes, holes_in


def patch_of(rows: str) -> Mask:
    """A mask drawn in text: # is ink."""
    return np.array([[pixel == "#" for pixel in row] for row in rows.split()], np.uint8)


@pytest.mark.parametrize(
    ("rows", "found"),
    [
        ("### ### ###", []),
        ("### #.. ###", []),  # open to the right
        ("### #.# ###", [Hole(0, 0, 3, 3, 1)]),
        (".##. #..# .##.", [Hole(0, 0, 4, 3, 2)]),  # its ink meets at corners only
        ("##### #.### ##.## #####", [Hole(1, 1, 3, 3, 1), Hole(0, 0, 3, 3, 1)]),
        ("##### #..## #.#.# #####", [Hole(2, 1, 3, 3, 1), Hole(0, 0, 4, 4, 3)]),
        ("##### #.#.# #...# #####", [Hole(0, 0, 5, 4, 5)]),  # ink stands out into it
    ],
)
def test_paper_runs_through_no_corner_and_ink_does(rows: str, found: list[Hole]) -> None:
    assert sorted(holes(patch_of(rows))) == sorted(found)


def test_the_paper_in_a_hole_is_as_much_as_its_pixels() -> None:
    chance = np.random.default_rng(0)
    for share in np.linspace(0.3, 0.9, 50):
        spots = np.asarray(chance.random((20, 20)) < share, np.uint8)
        _, numbers, stats, _ = cv2.connectedComponentsWithStats(spots, connectivity=8)
        ink = np.asarray(numbers == 1 + stats[1:, cv2.CC_STAT_AREA].argmax(), np.uint8)
        paper = np.pad(1 - ink, 1, constant_values=1)
        count, pieces = cv2.connectedComponents(paper, connectivity=4)
        around = pieces[0, 0]
        within = [int((pieces == k).sum()) for k in range(1, count) if k != around]
        assert sorted(hole.paper_px for hole in holes(ink)) == sorted(within)


def test_the_holes_of_a_patch_are_looked_for_once(monkeypatch: pytest.MonkeyPatch) -> None:
    mask = np.pad(patch_of("#### #..# ####"), 3)
    patches, found = Patches.of([runs_of(mask, 0)]), holes(mask[3:6, 3:7])
    assert holes_in(patches, 0) == found == [Hole(0, 0, 4, 3, 2)]
    monkeypatch.setattr(morfax.tracer.drawing.holes, "holes", None)
    assert holes_in(patches, 0) == found
