"""`python -m benchmarks folder` on a tiny folder."""

from __future__ import annotations

from pathlib import Path

import pytest
from click.testing import CliRunner

from benchmarks.__main__ import main
from benchmarks.folder import table
from tests.tracer.inked import Points, arc


def truth(file: Path, *loops: Points) -> None:
    rows = [f"{k},{x:.5f},{y:.5f}" for k, loop in enumerate(loops) for x, y in loop]
    file.write_text("\n".join(["loop,x,y", *rows, ""]))


def test_every_loop_and_width_has_its_row(tmp_path: Path) -> None:
    truth(tmp_path / "ring.csv", arc((0, 0), 5), arc((0, 0), 2.5))
    answer = CliRunner().invoke(
        table, [str(tmp_path), "--line", "0.3mm", "--line", "0.5mm", "--size", "24mm"]
    )
    assert answer.exit_code == 0, answer.output
    head, *rows = [line.split() for line in answer.stdout.splitlines()]
    assert head[0] == "drawing" and len(rows) == 4
    assert [row[:5] for row in rows] == [
        ["ring", w, k, "closed", "1"] for w in ("0.3", "0.5") for k in ("0", "1")
    ]
    for row in rows:
        rms_um, p95_um, max_um, hausdorff_um, missed = (float(word) for word in row[5:10])
        assert (
            0 < rms_um < 4
            and rms_um < p95_um < max_um + 1
            and hausdorff_um < 20
            and missed == 0
        )


def test_a_folder_without_truth_is_told(tmp_path: Path) -> None:
    answer = CliRunner().invoke(table, [str(tmp_path)])
    assert answer.exit_code == 1 and "holds no truth file" in answer.output
    assert CliRunner().invoke(table, [str(tmp_path), "--size", "big"]).exit_code == 2


def test_a_drawing_on_which_no_line_can_be_begun_is_told_in_its_row(tmp_path: Path) -> None:
    truth(tmp_path / "a.csv", arc((0, 0), 5))
    truth(tmp_path / "b.csv", arc((0, 0), 5, 0, 90), arc((3, 3), 0.5))
    answer = CliRunner().invoke(table, [str(tmp_path), "--size", "1.8mm"])
    assert answer.exit_code == 0, (answer.output, answer.exception)
    assert any(
        "can be begun" in line or "no line" in line for line in answer.stdout.splitlines()
    )


def test_a_benchmark_that_there_is_not_is_one_line_with_those_that_there_are() -> None:
    with pytest.raises(SystemExit, match=r"speed is no benchmark; give .*folder.*tracing"):
        main(["speed"])


@pytest.mark.parametrize(
    ("words", "said"), [(["--help"], "all benchmarks"), (["choice", "--help"], "-v names")]
)
def test_help_says_what_is_measured_and_runs_nothing(
    words: list[str], said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    main(words)
    assert said in capsys.readouterr().out
