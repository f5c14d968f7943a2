"""Cut corners: teeth whose sides are two pens wide have the corners that were drawn."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from morfax.motion.polyline import nearest_mm, with_places
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.head.leaders import REDRAWN
from morfax.tracer.program.against_ink import own_ink
from morfax.tracer.program.against_ink.own_ink import OwnInk
from morfax.tracer.program.against_ink.pen_on_ink import Ways
from morfax.tracer.program.laid.cut_corners import with_corners
from morfax.tracer.program.setup import Setup
from morfax.tracer.program.trace import trace
from morfax.tracer.tangles import folding_rule
from tests.tracer.inked import arc, inked, polyline
from tests.tracer.program.laid.ways import turned

TEETH = 6
PITCH_MM, HIGH_MM = (
    2.4,
    1.6,
)  # of teeth that are 1 mm broad at their tips, and as broad at their roots
# two thirds of a pixel; where the head rounds the corners of such teeth it is 0.085 mm off
OFF_MM = 0.05


def rack() -> np.ndarray:
    """A rack with teeth, (n, 2) mm."""
    rise = np.array([0.1, 0.3, 0.7, 0.9]) * PITCH_MM
    along = (np.arange(TEETH)[:, None] * PITCH_MM + rise).ravel()
    up = 4.0 + HIGH_MM * np.tile([0, 1, 1, 0], TEETH)
    return np.vstack([[0, 0], np.column_stack([along, up]), [TEETH * PITCH_MM, 0], [0, 0]])


def spanner() -> np.ndarray:
    """A spanner with a head of 22 mm and a jaw of 12 mm, whose corners lie 0.4 mm within the head's line."""
    turns = np.linspace(np.pi - np.arcsin(6 / 11), np.arcsin(4.5 / 11), 60)
    head = 11 * np.column_stack([np.cos(turns), np.sin(turns)])
    jaw = [[8.7, -6], [8.7, 6]]
    return np.vstack([head, [[34, 4.5], [34, -4.5]], head[::-1] * [1, -1], jaw, head[:1]])


RACK, SPANNER = rack(), spanner()


@pytest.mark.parametrize("turned_rad", [1.7, 2.4, 3.1])
def test_teeth_as_broad_as_two_lines_have_their_corners(turned_rad: float) -> None:
    drawn = polyline(*map(tuple, turned(RACK, turned_rad)))
    (line,) = trace(inked(drawn, seed=3)).lines
    assert line.ending == "closed"
    truth = with_places(drawn, 0.01)
    assert nearest_mm(truth, line.places_mm).max() < OFF_MM
    assert nearest_mm(line.places_mm, truth).max() < OFF_MM


@pytest.mark.parametrize("turned_rad", [0.3, 1.9, 4.0])
def test_a_corner_within_the_ink_of_another_side_is_where_its_legs_meet(
    turned_rad: float,
) -> None:
    """A spanner whose jaw comes to its own head: the ink alone shows the corner nowhere."""
    drawn = polyline(*map(tuple, turned(SPANNER, turned_rad)))
    (line,) = trace(inked(drawn, width_mm=0.7, seed=3)).lines
    assert line.ending == "closed"
    assert nearest_mm(line.places_mm, with_places(drawn, 0.01)).max() < OFF_MM


def test_a_line_on_its_ink_stays_as_the_head_ran() -> None:
    drawing = inked(arc((16, 16), 10), seed=4)
    own = OwnInk(drawing, trace(drawing).lines)
    assert with_corners(Setup(drawing.sheet), own) is own


def test_ink_that_a_way_explains_is_held_against_it_once(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """For doubt and for cut corners: what is surely on its ink for one is so for the other."""
    looked_at = list[int]()
    doubtful = own_ink._doubtful

    def counted(drawing: Drawing, ways: Ways, told: own_ink.ByTile) -> np.ndarray:
        looked_at.append(len(ways.line))
        return doubtful(drawing, ways, told)

    monkeypatch.setattr(own_ink, "_doubtful", counted)
    trace(inked(arc((16, 16), 10), seed=4))
    assert len(looked_at) == 1


def test_a_tangle_that_was_run_out_of_rightly_has_no_rule_fitted(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Teeth whose corners are laid: the ink about them leaves little, and nowhere more than elsewhere."""
    drawing = inked(polyline(*map(tuple, turned(RACK, 0.3))), width_mm=0.5, seed=4)
    lines = trace(drawing).lines
    assert any(REDRAWN in line.led.leaders for line in lines)
    monkeypatch.setattr(folding_rule, "explained", None)  # nobody asks for it
    own = OwnInk(drawing, lines)
    assert with_corners(Setup(drawing.sheet), own) is own


QUAD = polyline((4, 4), (19, 6), (16, 15), (6, 13), (4, 4))


def rounded(places: np.ndarray, at_mm: np.ndarray, within_mm: float) -> np.ndarray:
    """A way (n, 2) mm with a corner rounded from so far before it to so far after."""
    out = places.copy()
    near = np.flatnonzero(np.hypot(*(places - at_mm).T) < within_mm)
    share = np.linspace(0, 1, len(near))[:, None]
    before, after = places[near[0]], places[near[-1]]
    out[near] = (1 - share) ** 2 * before + 2 * share * (1 - share) * at_mm + share**2 * after
    return out


@pytest.mark.parametrize(("dpi", "corner_mm"), [(300, (6.0, 13.0)), (200, (16.0, 15.0))])
def test_a_rounded_corner_is_where_its_legs_meet_if_the_ink_is_that_of_a_sharp_one(
    dpi: float, corner_mm: tuple[float, float]
) -> None:
    """The head sometimes rounds a corner by less than the ink beside its way tells."""
    drawing, corner = inked(QUAD, dpi=dpi, seed=4), np.array([corner_mm])
    (line,) = trace(drawing).lines
    cut = replace(line, xy_mm=rounded(line.xy_mm, corner[0], 0.25))
    assert nearest_mm(corner, cut.places_mm)[0] > 0.065
    (mended,) = with_corners(Setup(drawing.sheet), OwnInk(drawing, [cut])).lines
    assert nearest_mm(corner, mended.places_mm)[0] < 0.01


def test_a_corner_that_was_drawn_round_stays_round() -> None:
    soft = rounded(with_places(QUAD, 0.02), np.array([16.0, 15.0]), 0.5)
    drawing = inked(soft, seed=3)
    own = OwnInk(drawing, trace(drawing).lines)
    assert with_corners(Setup(drawing.sheet), own) is own
