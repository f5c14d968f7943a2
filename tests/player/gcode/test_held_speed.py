"""The speed that the pulse control holds: lines within what the weights allow, and true with a true norm."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from morfax.player.gcode.held_speed import held_speed
from morfax.player.gcode.pulses import PulsePlayback, play_pulses


def line(
    folder: Path, x_mm: float, y_mm: float, override: float | None = None
) -> PulsePlayback:
    """A line of 30 mm at 10 mm/s, after a dwell."""
    file = folder / "line.ngc"
    file.write_text(f"G21 G90 G94\nG0 X0 Y0 Z0\nG4 P0.1\nG1 X{x_mm} Y{y_mm} F600\nM2\n")
    return play_pulses(file, override=override)


@pytest.mark.parametrize("degrees", [0, 20, 45, 70])
def test_along_a_line_it_holds_what_its_norm_allows(tmp_path: Path, degrees: float) -> None:
    end = 30 * np.cos(np.radians(degrees)), 30 * np.sin(np.radians(degrees))
    for true_norm, least, most in (
        (True, 0.99, 1.01),
        (False, 0.925, 1.015),
    ):  # ±0.5 %; -7.2 … +1.0 % in two axes
        held = held_speed(line(tmp_path, *end), true_norm)
        middle = (held.way_mm > 5) & (held.way_mm < 25)
        assert middle.sum() > 50
        assert (held.programmed_mm_s[middle] == 10).all()
        assert least < held.held_mm_s[middle].mean() / 10 < most
        assert held.way_mm[-1] == pytest.approx(30, abs=0.01)  # pulses


def test_the_override_is_in_the_programmed_speed(tmp_path: Path) -> None:
    held = held_speed(line(tmp_path, 30, 0, override=0.5), True)
    assert held.programmed_mm_s[5] == 5 and held.held_mm_s[100] == pytest.approx(5, rel=0.02)
