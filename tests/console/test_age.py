"""age by its behaviour."""

from __future__ import annotations

from pathlib import Path

import pytest
import soundfile

from tests.console.conftest import Morfax


def test_a_worn_tape_is_written_and_the_same_seed_gives_the_same(morfax: Morfax, here: Path, tape_file: Path) -> None:
    for name in ("one.wav", "two.wav"):
        answer = morfax("age", tape_file, "-o", name, "--as", "cassette", "--speed", "-1%", "--seed", 7, "--json")
        assert answer.exit_code == 0
        assert answer.figures["duration_s"] == pytest.approx(soundfile.info(tape_file).duration / 0.99, rel=1e-3)
    assert (here / "one.wav").read_bytes() == (here / "two.wav").read_bytes()


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--speed", "fast"], "no share"),
        (["--noise", "loud"], "no level"),
        (["--order", "1,2"], "each of the tracks"),
        (["--order", "x"], "names no tracks"),
        (["--as", "gramophone"], "gramophone"),
    ],
)
def test_wrong_use_is_one_line(morfax: Morfax, here: Path, tape_file: Path, words: list[str], said: str) -> None:
    answer = morfax("age", tape_file, "-o", "w.wav", *words)
    assert answer.exit_code == 2 and said in answer.fault
    assert list(here.iterdir()) == []
