"""`--head` and `--set`: the head that follows, and its settings by name."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from click.testing import CliRunner

from morfax.console.cli import cli
from tests.console.conftest import Morfax

CAM = Path(__file__).parents[2] / "samples" / "cam.png"


def traced(tmp_path: Path, *options: str) -> dict[str, object]:
    """Figures of the cam traced with options."""
    answer = CliRunner().invoke(
        cli, ["trace", str(CAM), "-o", str(tmp_path / "cam.csv"), "--json", *options]
    )
    assert answer.exit_code == 0, answer.output
    figures: dict[str, object] = json.loads(answer.stdout)
    return figures


def test_the_historic_head_comes_round_too_and_cuts_its_corners(tmp_path: Path) -> None:
    precise, historic = traced(tmp_path), traced(tmp_path, "--head", "historic")
    assert precise["ending"] == historic["ending"] == "closed"
    assert float(str(historic["length_mm"])) < float(
        str(precise["length_mm"])
    )  # inside every bend


def test_a_setting_is_changed_by_its_name(tmp_path: Path) -> None:
    usual, slow = traced(tmp_path), traced(tmp_path, "--set", "speed_mm_s=5")
    assert float(str(slow["duration_s"])) > 1.7 * float(
        str(usual["duration_s"])
    )  # Z moves take as long as before


@pytest.mark.parametrize(
    ("setting", "said"),
    [
        ("colour=3", "the head has no setting 'colour'"),
        ("lead_mm=x", "lead_mm is 'x'; it must be a number"),
        ("lead_mm", ""),
    ],
)
def test_a_setting_that_there_is_not_is_wrong_use(
    tmp_path: Path, setting: str, said: str
) -> None:
    answer = CliRunner().invoke(
        cli, ["trace", str(CAM), "-o", str(tmp_path / "cam.csv"), "--set", setting]
    )
    assert answer.exit_code == 2 and said in answer.output
    assert not (tmp_path / "cam.csv").exists()


def test_settings_come_from_a_file_and_options_go_before_it(morfax: Morfax, here: Path) -> None:
    Path("head.toml").write_text("speed_mm_s = 4\nlead_mm = 1.5\n")
    printed = morfax(
        "trace", CAM, "--settings", "head.toml", "--set", "lead_mm=1.75", "--print-settings"
    )
    assert printed.exit_code == 0 and list(here.iterdir()) == [
        here / "head.toml"
    ]  # nothing was traced
    assert "speed_mm_s = 4.0 " in printed.out and "lead_mm = 1.75 " in printed.out
    printed = morfax(
        "trace", CAM, "--settings", "head.toml", "--speed", "6mm/s", "--print-settings"
    )
    assert "speed_mm_s = 6.0 " in printed.out and "lead_mm = 1.5 " in printed.out


def test_the_settings_printed_make_the_same_head(morfax: Morfax, here: Path) -> None:
    printed = morfax("trace", CAM, "--head", "historic", "--speed", "5mm/s", "--print-settings")
    Path("historic.toml").write_text(printed.out)
    again = morfax("trace", CAM, "--settings", "historic.toml", "--print-settings")
    assert again.out == printed.out
    for name, options in (
        ("a.csv", ("--head", "historic", "--speed", "5mm/s")),
        ("b.csv", ("--settings", "historic.toml")),
    ):
        assert morfax("trace", CAM, "-o", name, *options).exit_code == 0
    assert Path("a.csv").read_bytes() == Path("b.csv").read_bytes()


def test_a_mistake_in_the_file_is_one_line_and_nothing_is_written(
    morfax: Morfax, here: Path
) -> None:
    Path("head.toml").write_text("\nsweep_hz = 0\n")
    answer = morfax("trace", CAM, "--settings", "head.toml")
    assert answer.exit_code == 9 and list(here.iterdir()) == [here / "head.toml"]
    assert answer.fault.startswith(
        "morfax: head.toml, line 2: sweep_hz holds 0; it may hold a number from 1 to 750"
    )
