"""`--head` and `--set`: the head that follows, and its settings by name."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from click.testing import CliRunner

from console.cli import cli

CAM = Path(__file__).parents[2] / "samples" / "cam.png"


def traced(tmp_path: Path, *options: str) -> dict[str, object]:
    """Figures of the cam traced with options."""
    answer = CliRunner().invoke(cli, ["trace", str(CAM), "-o", str(tmp_path / "cam.csv"), "--json", *options])
    assert answer.exit_code == 0, answer.output
    figures: dict[str, object] = json.loads(answer.stdout)
    return figures


def test_the_historic_head_comes_round_too_and_cuts_its_corners(tmp_path: Path) -> None:
    precise, historic = traced(tmp_path), traced(tmp_path, "--head", "historic")
    assert precise["ending"] == historic["ending"] == "closed"
    assert float(str(historic["length_mm"])) < float(str(precise["length_mm"]))  # inside every bend


def test_a_setting_is_changed_by_its_name(tmp_path: Path) -> None:
    usual, slow = traced(tmp_path), traced(tmp_path, "--set", "speed_mm_s=5")
    assert float(str(slow["duration_s"])) > 1.7 * float(str(usual["duration_s"]))  # Z moves take as long as before


@pytest.mark.parametrize(
    ("setting", "said"),
    [
        ("colour=3", "the head has no setting 'colour'"),
        ("lead_mm=x", "lead_mm is 'x'; it must be a number"),
        ("lead_mm", ""),
    ],
)
def test_a_setting_that_there_is_not_is_wrong_use(tmp_path: Path, setting: str, said: str) -> None:
    answer = CliRunner().invoke(cli, ["trace", str(CAM), "-o", str(tmp_path / "cam.csv"), "--set", setting])
    assert answer.exit_code == 2 and said in answer.output
    assert not (tmp_path / "cam.csv").exists()
