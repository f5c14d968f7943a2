"""Step-down, ramps, tabs and pecks by their behaviour: every medium gets the same Z, the card says them as
well, and what cannot be is one line.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from morfax.motion.pathfile import read_path
from tests.console.conftest import SAMPLES, Morfax

CAM = SAMPLES / "cam.png"
DEEP = ["--depth", "3mm", "--step-down", "1.2mm", "--ramp", "4deg", "--tabs", "3"]
CARD = """\
depth = "3mm"
step_down = "1.2mm"
ramp = "4deg"
tabs = { count = 3 }
"""


def heights_mm(file: str) -> dict[float, float]:
    """How far X and Y are run at each whole mm/100 of Z at which they are run for more than 1 mm, mm."""
    positions_mm = read_path(file).positions_mm
    steps = np.diff(positions_mm, axis=0)
    level = np.abs(steps[:, 2]) < 1e-3
    across = np.hypot(*steps[level, :2].T)
    depths = np.round(positions_mm[1:][level, 2], 2)
    run = {float(depth): float(across[depths == depth].sum()) for depth in np.unique(depths)}
    return {depth: mm for depth, mm in run.items() if mm > 1}


@pytest.fixture
def traced(morfax: Morfax, here: Path) -> dict[float, float]:
    """What the cam's path is run at, and the path itself under the name cam.csv."""
    answer = morfax("trace", CAM, "-o", "cam.csv", *DEEP, "--json")
    assert answer.exit_code == 0, answer.err
    assert answer.figures["passes_mm"] == [1, 2, 3]
    assert [row["tab"] for row in answer.figures["tabs"]] == [1, 2, 3]
    return heights_mm("cam.csv")


def test_every_medium_gets_the_same_z_and_a_card_says_the_same(
    morfax: Morfax, here: Path, traced: dict[float, float]
) -> None:
    """Passes of 1, 2 and 3 mm, each after a ramp of 14.3 mm; tabs of 3 mm at 2 mm in the last one alone."""
    round_mm = 238.6  # the cam
    assert set(traced) == {
        -3.0,
        -2.0,
        -1.0,
        2.0,
    }  # and over the work, home from the end of the ramp
    assert traced[-1.0] == pytest.approx(round_mm - 14.3, abs=0.3)
    assert traced[-2.0] == pytest.approx(round_mm - 14.3 + 3 * 3.0, abs=0.3)
    assert traced[-3.0] == pytest.approx(round_mm - 3 * 3.0, abs=0.3)
    for program in ("cam.wav", "cam.ngc", "cam.steps", "cam.cubic"):
        assert morfax("record", "cam.csv", "-o", program, "--quiet").exit_code == 0
        assert morfax("play", program, "-o", "played.csv", "--quiet").exit_code == 0
        z_mm = read_path("played.csv").positions_mm[:, 2]
        assert z_mm.min() == pytest.approx(-3.0, abs=0.02)
        answer = morfax("compare", "played.csv", "cam.csv", "--tolerance", "40um")
        assert answer.exit_code == 0, answer.err
    text = Path("cam.ngc").read_text()
    assert (
        text.count("\nG1 Z-2 F300") == text.count("\nG1 Z-3 F300") == 3
    )  # up on each tab, and down
    assert "\nG0 Z-" not in text
    Path("part.toml").write_text(CARD)
    answer = morfax("trace", CAM, "--card", "part.toml", "-o", "by-card.csv", "--quiet")
    assert answer.exit_code == 0
    assert Path("by-card.csv").read_text() == Path("cam.csv").read_text()


@pytest.mark.parametrize(
    ("words", "code", "says"),
    [
        (
            ["--tab-width", "3mm"],
            2,
            "--tab-width is for holding tabs; give how many with --tabs",
        ),
        (["--ramp", "1deg"], 2, "'1deg' is no angle here; it may be 1.5deg to 45deg"),
        (["--step-down", "0mm"], 2, "give 0.01 to 999.99 mm in steps of 0.01 mm"),
        (["--peck", "2.005mm"], 2, "'2.005mm' cannot be set"),
        (
            ["--tabs", "3", "-o", "a.nc", "--machine", "grbl-laser"],
            2,
            "tabs need a Z axis, and the",
        ),
        (["--ramp", "3deg", "-o", "a.dxf"], 2, "a ramp needs a Z axis, and a drawing (.dxf)"),
        (
            ["--card", "two.toml", "--step-down", "1.5mm"],
            2,
            "the card has passes of 1, 4 mm, and",
        ),
        (["--card", "both.toml"], 9, "give passes or step_down, not both"),
        (["--card", "flat.toml"], 9, 'ramp holds "1deg"; it may hold 1.5 to 45 degrees'),
        (["--card", "many.toml"], 9, "it must hold a count, such as { count = 4 }"),
    ],
)
def test_what_cannot_be_is_one_line_before_anything_moves(
    morfax: Morfax, here: Path, words: list[str], code: int, says: str
) -> None:
    Path("two.toml").write_text('passes = ["1mm", "4mm"]\n')
    Path("both.toml").write_text('passes = ["1mm", "4mm"]\nstep_down = "2mm"\n')
    Path("flat.toml").write_text('ramp = "1deg"\n')
    Path("many.toml").write_text('tabs = { width = "3mm" }\n')
    answer = morfax("trace", CAM, *words)
    assert answer.exit_code == code and says in answer.fault
    assert all(file.suffix == ".toml" for file in here.iterdir())


def test_a_scale_leaves_the_ramp_its_angle_and_names_what_it_does_change(
    morfax: Morfax, here: Path
) -> None:
    """Half as large a cam: the ramps of its program go down at the 4 degrees that were asked for."""
    words = (
        "trace",
        CAM,
        "--depth",
        "2mm",
        "--ramp",
        "4deg",
        "--scale",
        "0.5",
        "-o",
        "half.csv",
    )
    answer = morfax(*words)
    assert answer.err.splitlines()[-1] == (
        "scaled by 0.5: X and Y run 0.5 times as fast, Z is not scaled"
    )
    steps_mm = np.diff(read_path("half.csv").positions_mm, axis=0)
    down = (steps_mm[:, 2] < -1e-3) & (np.hypot(*steps_mm[:, :2].T) > 1e-3)
    slopes = -steps_mm[down, 2] / np.hypot(*steps_mm[down, :2].T)
    assert np.degrees(np.arctan(np.median(slopes))) == pytest.approx(4.0, abs=0.1)
    cut = ("--cutter", "4mm", "--tabs", "2", "--feed", "600mm/min")
    told = morfax("trace", CAM, *cut, "--scale", "2", "-o", "twice.ngc").err.splitlines()[-1]
    assert told == (
        "scaled by 2: the program is for a cutter of 8 mm, tabs are 2 times as long, Z is not scaled"
    )
