"""--card by its behaviour: what it sets is what the tool does, and a mistake on it stops the verb before
anything moves.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from morfax.motion.pathfile import read_path
from tests.console.conftest import SAMPLES, Morfax

CAM = SAMPLES / "cam.png"
CARD = """\
start = "3.5mm"
passes = ["2mm", "4.25mm"]
[speeds]
trace = "20mm/s"
feed = "10mm/s"
"""


def traced_z_mm(morfax: Morfax, *options: object) -> np.ndarray:
    """Z of the cam's path as it is traced with these options."""
    answer = morfax("trace", CAM, "--card", "part.toml", "-o", "cam.csv", "--quiet", *options)
    assert answer.exit_code == 0, answer.err
    return read_path("cam.csv").positions_mm[:, 2]


def levels_mm(z_mm: np.ndarray) -> list[float]:
    """The depths at which the tool stands for long, mm, in their order."""
    depths, counts = np.unique(np.round(z_mm, 3), return_counts=True)
    return sorted((float(depth) for depth in depths[counts > 50]), reverse=True)


def test_the_card_sets_start_passes_and_speeds(morfax: Morfax, here: Path) -> None:
    Path("part.toml").write_text(CARD)
    z_mm = traced_z_mm(morfax)
    assert z_mm[0] == z_mm[-1] == z_mm.max() == 3.5 and z_mm.min() == -4.25
    assert levels_mm(z_mm) == [-2.0, -4.25]
    path = read_path("cam.csv")
    speeds = np.hypot(*np.diff(path.xy_mm, axis=0).T) / np.diff(path.t_s)
    assert np.median(speeds[path.tool[1:]]) == pytest.approx(20, rel=0.01)
    down = np.abs(np.diff(path.positions_mm[:, 2]) / np.diff(path.t_s))
    assert down.max() == pytest.approx(10, rel=0.01)  # the feed


@pytest.mark.parametrize(
    ("depth", "levels"), [("3mm", [-2.0, -3.0]), ("5mm", [-2.0, -4.25, -5.0])]
)
def test_an_option_on_the_command_line_goes_before_the_card(
    morfax: Morfax, here: Path, depth: str, levels: list[float]
) -> None:
    Path("part.toml").write_text(CARD)
    z_mm = traced_z_mm(morfax, "--depth", depth, "--clearance", "1mm")
    assert z_mm[0] == z_mm.max() == 1.0 and levels_mm(z_mm) == levels


@pytest.mark.parametrize("verb", ["trace", "run"])
def test_a_mistake_on_the_card_is_one_line_and_nothing_is_written(
    morfax: Morfax, here: Path, verb: str
) -> None:
    Path("part.toml").write_text(CARD + 'rapid = "fast"\n')
    answer = morfax(verb, CAM, "--card", "part.toml")
    assert answer.exit_code == 9
    assert answer.fault.startswith(
        'morfax: part.toml, line 6: speeds.rapid holds "fast"; it may hold a speed of 0.01'
    )
    assert [file.name for file in here.iterdir()] == ["part.toml"]


def test_a_card_that_is_not_there_says_so(morfax: Morfax, here: Path) -> None:
    answer = morfax("trace", CAM, "--card", "part.toml")
    assert (
        answer.exit_code == 8 and "cannot read the card part.toml: No such file" in answer.fault
    )


def test_run_takes_a_card(morfax: Morfax, here: Path) -> None:
    Path("part.toml").write_text("depth = 1\n[[stop]]\ndwell = 1\n")
    answer = morfax("run", CAM, "--card", "part.toml", "-o", "cam", "--json")
    assert answer.exit_code == 0
    assert read_path(here / "cam" / "cam.traced.csv").positions_mm[:, 2].min() == -1.0


def test_passes_at_a_stop_are_the_depths_of_the_line_that_begins_there(
    morfax: Morfax, here: Path
) -> None:
    """The lead line's tick is stop 1: the plate is run at 1 mm and then at 2.5 mm, whatever the card asks for
    elsewhere.
    """
    Path("part.toml").write_text(
        'depth = "4mm"\n[[stop]]\nnumber = 1\npasses = ["1mm", "2.5mm"]\n'
    )
    answer = morfax(
        "trace", SAMPLES / "program.png", "--card", "part.toml", "-o", "part.csv", "--quiet"
    )
    assert answer.exit_code == 0, answer.err
    path = read_path("part.csv")
    assert [z_mm for z_mm in levels_mm(path.positions_mm[:, 2]) if z_mm < 0] == [-1.0, -2.5]
    first, second = (
        path.xy_mm[np.abs(path.positions_mm[:, 2] + depth_mm) < 0.001]
        for depth_mm in (1.0, 2.5)
    )
    assert first[:, 0].min() == pytest.approx(21.5, abs=0.05)  # from the tick on
    assert second[:, 0].min() > 25  # the plate alone
    assert np.ptp(second[:, 1]) == pytest.approx(np.ptp(first[:, 1]), abs=0.01)


def test_passes_at_a_stop_that_do_not_go_deeper_are_refused(morfax: Morfax, here: Path) -> None:
    Path("part.toml").write_text('[[stop]]\nnumber = 1\npasses = ["2mm", "1mm"]\n')
    answer = morfax("trace", SAMPLES / "program.png", "--card", "part.toml", "-o", "part.csv")
    assert (
        answer.exit_code == 9 and "passes[2]" in answer.fault and not Path("part.csv").exists()
    )
