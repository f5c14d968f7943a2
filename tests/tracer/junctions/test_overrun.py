"""A lead line drawn a little beyond the contour that it leads to: its end there is no way on."""

from __future__ import annotations

import pytest

from morfax.tracer.junctions.choice import Asked, WayIn, survey
from morfax.tracer.sensing.leg import goes_straight
from tests.tracer.inked import inked, polyline
from tests.tracer.junctions.test_choice import X_MM, come_along

CONTOUR = polyline((X_MM, 2), (X_MM, 18))


@pytest.mark.parametrize(("beyond_mm", "leads", "straight"), [
    (1.3, True, False), (3.2, True, True), (1.3, False, True)
])  # fmt: skip
def test_a_lead_line_s_end_beyond_the_contour_is_left_out_where_it_is_short(
    beyond_mm: float, leads: bool, straight: bool
) -> None:
    """Up to 1.5 mm of ink from where it is clean; and only of the line by which the head comes first."""
    view, incoming, trail = come_along(
        inked(polyline((4, 10), (X_MM + beyond_mm, 10)), CONTOUR)
    )
    leg, _, choices = survey(WayIn(view, incoming, trail), Asked(leads=leads))
    assert leg is not None and goes_straight(incoming, leg) is straight
    assert choices == 2 + straight
