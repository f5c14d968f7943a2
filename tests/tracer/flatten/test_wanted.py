"""What is wanted of a photograph, read from its text; places in the wrong order would mirror the drawing."""

from __future__ import annotations

import pytest

from morfax.tracer.flatten.wanted import Wanted, parsed

PLACES = "120,80 3900,95 3850,2900 150,2880"


def test_the_ways() -> None:
    assert parsed("marks") == Wanted("marks")
    assert parsed("AUTO") == Wanted("auto")
    paper = parsed("paper=letter").paper
    assert paper is not None and paper.name == "letter"
    four = parsed(f"{PLACES}=200x100mm")
    assert four.way == "corners" and four.corners_px[2] == (3850.0, 2900.0)
    assert four.paper is not None and four.paper[1:] == (200.0, 100.0)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("mark", "is not a way to flatten; give auto, marks, paper=a4"),
        ("paper", "is not a way to flatten"),
        ("paper=b9", "is no format of paper"),
        (PLACES, "is not a way to flatten"),
        ("1,2 3,4 5,6=20x30mm", "four places make a rectangle, 3 were given"),
        ("1,2 3,4 5,6 7=20x30mm", "is not a way to flatten"),
        ("1,2 3..4,4 5,6 7,8=20x30mm", "is not a way to flatten"),
        (f"{PLACES}=200", "is no format of paper"),
        (
            "120,80 150,2880 3850,2900 3900,95=200x100mm",
            "run anticlockwise, which would mirror",
        ),
        ("120,80 3850,2900 3900,95 150,2880=200x100mm", "do not go round a rectangle"),
        ("1,1 5,1 9,1 1,9=200x100mm", "do not go round a rectangle"),
    ],
)
def test_what_says_nothing_of_the_kind_is_refused(text: str, told: str) -> None:
    with pytest.raises(ValueError, match=told):
        parsed(text)
