"""compare --systems: one drawing on every system, the table, the picture, the report, and a system that
refuses.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from morfax.jobs import systems
from morfax.jobs.results import NAMES
from morfax.motion.faults import MotionFault
from morfax.motion.motion import Path as MotionPath
from morfax.recorder import media
from tests.console.conftest import SAMPLES, Morfax

UM = 1e-3
# furthest from the traced path: 0.5 um asked of the tape; one step and a half; 2 um and the servo; 10 um of
# fit and 4
FURTHEST_MM = {"wav": 3 * UM, "steps": 15 * UM, "cubic": 4 * UM, "ngc": 14 * UM}


def test_all_systems_side_by_side(morfax: Morfax, here: Path) -> None:
    answer = morfax(
        "compare", SAMPLES / "curve.png", "--systems", "all", "-o", "report.html", "--json"
    )
    assert answer.exit_code == 0
    figures = answer.figures
    for suffix, furthest_mm in FURTHEST_MM.items():
        row = figures[suffix]
        assert 0 < row["from_traced_rms_mm"] < row["from_traced_max_mm"] < furthest_mm
        assert row["from_ink_rms_mm"] < figures["traced"]["from_ink_rms_mm"] + furthest_mm
        assert (
            row["duration_s"] > figures["length_mm"] / 12 and 0 <= row["speed_held_share"] <= 1
        )
        assert 5 < row["mean_speed_mm_s"] < 10.5
        assert NAMES[suffix] in answer.err  # progress
    sizes = [figures[suffix]["bytes_per_mm"] for suffix in ("wav", "cubic", "steps", "ngc")]
    assert sizes == sorted(sizes, reverse=True)
    assert (
        figures["steps"]["bits_per_mm"] < 8 * figures["steps"]["bytes_per_mm"]
    )  # the punched ones
    assert figures["steps"]["following_error_mm"] == 0 < figures["wav"]["following_error_mm"]
    report = (here / "report.html").read_text()
    assert (
        report.count('<img src="data:image/png;base64,') == report.count("<img") == 6
    )  # contours, errors, four runs
    text = re.sub(r'base64,[^"]*', "", report)  # letters of a picture may spell anything
    assert text.count("<tr>") == 6 and "@media print" in text and "http" not in text
    assert [file.name for file in here.iterdir()] == ["report.html"]


def test_some_systems_and_the_picture_alone(morfax: Morfax, here: Path) -> None:
    words = (
        "compare",
        SAMPLES / "curve.png",
        "--systems",
        "wav,.ngc",
        "--picture",
        "all.png",
        "--tolerance",
    )
    answer = morfax(*words, "40um")
    assert answer.exit_code == 0
    assert "Morfax 1969 (.wav)" in answer.out and "Pratt & Whitney 1967 (.ngc)" in answer.out
    assert "SEA" not in answer.out and "within tolerance  yes" in answer.out
    assert (here / "all.png").read_bytes().startswith(b"\x89PNG")
    assert morfax(*words, "1um").exit_code == 1


def test_a_system_that_refuses_says_why_and_the_others_go_on(
    morfax: Morfax, here: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    record = media.record

    def refusing(stream: Any, file: Path, **settings: Any) -> media.Report:
        if file.suffix == ".steps":
            raise MotionFault("the motor has come loose")
        return record(stream, file, **settings)

    monkeypatch.setattr(media, "record", refusing)
    answer = morfax(
        "compare",
        SAMPLES / "curve.png",
        "--systems",
        "steps,wav",
        "-o",
        "report.html",
        "--json",
    )
    assert (
        answer.exit_code == MotionFault.exit_code and "the motor has come loose" in answer.fault
    )
    assert answer.figures["steps"] == {"fault": "the motor has come loose"}
    assert answer.figures["wav"]["from_traced_max_mm"] < 3 * UM
    report = (here / "report.html").read_text()
    assert (
        "Superior Electric 1975 (.steps): the motor has come loose" in report
        and report.count("<img") == 3
    )


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (
            ("cam.png", "--systems", "tape"),
            "there is no system 'tape'; give all, or some of wav",
        ),
        (("cam.png", "cam.csv", "--systems", "all"), "leave B out"),
        (("cam.png",), "nothing to compare with"),
        (("cam.csv", "--systems", "all"), "no drawing"),
        (("cam.csv", "cam.csv", "--speed", "5mm/s"), "are for --systems; without it"),
        (("cam.png", "--systems", "all", "--cutter", "6mm"), "with --systems leave them out"),
        (
            ("cam.png", "--systems", "all", "--reference-frequency", "6kHz"),
            "with --systems leave them out",
        ),
        (
            ("cam.csv", "cam.csv", "--cutter", "6mm"),
            "--cutter is for a path beside a drawing's line",
        ),
        (("cam.png", "--systems", "all", "-o", "a.csv"), "must end in .html"),
        (("cam.csv", "cam.csv", "-o", "a.html"), "are for --systems"),
        (("cam.csv", "cam.csv", "-o", "a.png"), "'a.png' is a picture; give it with --picture"),
    ],
)
def test_what_does_not_go_together_is_wrong_use(
    morfax: Morfax, here: Path, words: tuple[str, ...], told: str
) -> None:
    answer = morfax(
        "compare", *(SAMPLES / word if word.startswith("cam") else word for word in words)
    )
    assert answer.exit_code == 2 and told in answer.fault and not list(here.iterdir())


def path(points: list[tuple[float, float]], speeds_mm_s: list[float]) -> MotionPath:
    """Straight from point to point in the work, each at its speed."""
    xy = np.array(points)
    t_s = np.r_[0.0, np.cumsum(np.hypot(*np.diff(xy, axis=0).T) / speeds_mm_s)]
    return MotionPath(t_s, np.column_stack([xy, np.full(len(xy), -1.0)]))


def test_corners_are_found_and_a_path_that_cuts_one_is_as_far_off_as_it_cuts() -> None:
    square = path([(0, 0), (10, 0), (10, 10), (0, 10)], [10.0] * 3)
    assert systems.corner_places(square).tolist() == [[10, 0], [10, 10]]
    cut = path([(0, 0), (9.9, 0), (10, 0.1), (10, 10), (0, 10)], [10.0] * 4)
    assert systems.corner_error_mm(systems.corner_places(square), cut) == pytest.approx(
        0.1 / np.sqrt(2)
    )
    straight = path([(0, 0), (5, 0), (10, 0.5)], [10.0] * 2)
    assert systems.corner_error_mm(systems.corner_places(straight), straight) is None


def test_the_speed_held_is_the_share_of_the_way_within_five_percent() -> None:
    run = path([(0, 0), (60, 0), (100, 0)], [10.0, 8.0])
    figures = systems.held(run, 10.0)
    assert figures["speed_held_share"] == pytest.approx(0.6, abs=0.05)  # half a second of 11
    assert figures["mean_speed_mm_s"] == pytest.approx(100 / 11, rel=0.02)
