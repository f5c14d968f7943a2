"""`--ink` by its behaviour."""

from __future__ import annotations

from pathlib import Path

from tests.console.conftest import SAMPLES, Morfax
from tests.tracer.drawing.test_inks import ORANGE, drawn


def test_one_ink_is_followed_and_compared(morfax: Morfax, here: Path) -> None:
    sheet = drawn(here / "sheet.png", ORANGE)
    assert (
        morfax(
            "trace", sheet, "--ink", "navy", "--start", "26,16", "-o", "c.csv", "--quiet"
        ).exit_code
        == 0
    )
    compared = morfax("compare", sheet, "c.csv", "--ink", "navy", "--json")
    assert compared.figures["path_to_ink"]["rms_mm"] < 0.005


def test_a_colour_that_is_none_is_wrong_use_and_one_that_is_nowhere_a_fault(
    morfax: Morfax, here: Path
) -> None:
    answer = morfax("trace", SAMPLES / "cam.png", "--ink", "blau")
    assert (
        answer.exit_code == 2
        and "'blau' is no colour; give a name such as blue" in answer.fault
    )
    answer = morfax("trace", SAMPLES / "cam.png", "--ink", "red")
    assert (
        answer.exit_code == 3
        and "there is no ink of the colour #ff0000 on paper of #" in answer.fault
    )
    assert not list(here.iterdir())
