"""The pictures of the head's page can be drawn: they listen to functions of the tracer, by name."""

from __future__ import annotations

from pathlib import Path

from docs.figures import head


def test_every_figure_of_the_head_is_drawn(tmp_path: Path) -> None:
    head.main(tmp_path)
    drawn = {file.stem.removeprefix("head-") for file in tmp_path.glob("*.png")}
    assert drawn == set(head.FIGURES)
