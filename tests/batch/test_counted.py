"""What is told at the terminal of the drawings of a batch, as they end."""

from __future__ import annotations

import pytest

from morfax.batch.row import BatchRow
from morfax.batch.tally import Tally
from morfax.console.terminal.counted import count_all
from morfax.console.terminal.desk import Desk


def test_at_a_terminal_a_drawing_that_failed_has_a_line_of_its_own(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("sys.stderr.isatty", lambda: True)
    rows = (
        row for row in [BatchRow("a.png", "done"), BatchRow("b.png", "fault", fault="no line")]
    )
    count_all(rows, Tally(2), Desk())
    said = capsys.readouterr().err
    lines = [
        line.split("\r\x1b[K")[-1] for line in said.split("\n")
    ]  # what stays on the screen
    assert lines == ["morfax: b.png: fault: no line", ""]


def test_a_fault_that_many_drawings_have_is_told_once(
    capsys: pytest.CaptureFixture[str],
) -> None:
    """A folder of scans without a resolution filled the screen with one sentence."""
    names, why = [f"{k}.png" for k in range(3)], "{} states no resolution; give --dpi 300"
    rows = (BatchRow(name, "fault", fault=why.format(name)) for name in names)
    count_all(rows, Tally(3), Desk())
    assert capsys.readouterr().err.splitlines() == [
        "morfax: 0.png: fault: states no resolution; give --dpi 300",
        "morfax: 1.png: fault, as 0.png",
        "morfax: 2.png: fault, as 0.png",
    ]
