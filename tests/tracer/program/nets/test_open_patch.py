"""An open patch: whether no line of it comes round, as it is told where the head was lost on its ink."""

from __future__ import annotations

import pytest

from morfax.motion.arrays import Array
from morfax.tracer.drawing.strokes import Sheet
from morfax.tracer.head.settings import Settings
from morfax.tracer.program.lines import selection
from morfax.tracer.program.nets.open_ink import _ends_of_open, is_open
from morfax.tracer.program.setup import Setup
from tests.tracer.inked import WIDTH_MM, arc, inked, polyline

TRUNK = polyline((8, 10), (30, 10))
BRANCH = polyline((20, 10), (20, 30))
RING = arc((16, 18), 8)


def longest(*lines: Array, gap_mm: float = 0.5) -> bool:
    """Whether the sheet's longest patch is open to a head that crosses gaps so wide."""
    setup = Setup(Sheet.of(inked(*lines, seed=2)), Settings(gap_mm=gap_mm))
    contours, _ = selection.plan(setup.sheet, "contours")
    return is_open(setup, max(contours, key=lambda one: one.stroke.length_mm).stroke)


@pytest.mark.parametrize(
    ("lines", "is_so"), [((TRUNK,), True), ((TRUNK, BRANCH), True), ((RING, BRANCH), False)]
)
def test_a_patch_that_goes_round_an_area_is_not_open(
    lines: tuple[Array, ...], is_so: bool
) -> None:
    assert longest(*lines) is is_so


@pytest.mark.parametrize(("crosses_mm", "is_so"), [(1.0, False), (0.5, True)])
def test_a_patch_whose_end_faces_another_across_a_gap_is_not_open(
    crosses_mm: float, is_so: bool
) -> None:
    """The gap is 0.7 mm: a head that crosses it may come round by the other patch."""
    begin = 30 + 0.7 + WIDTH_MM
    other = polyline((begin, 10), (begin + 12, 10))
    assert longest(TRUNK, other, gap_mm=crosses_mm) is is_so


@pytest.mark.parametrize(
    ("lines", "ends"),
    [((TRUNK,), 2), ((TRUNK, BRANCH), 3), ((RING,), None), ((RING, BRANCH), None)],
)
def test_only_of_open_ink_the_ends_are_counted(
    lines: tuple[Array, ...], ends: int | None
) -> None:
    setup = Setup(Sheet.of(inked(*lines, seed=2)))
    assert _ends_of_open(setup, setup.sheet.stroke(0)) == ends
