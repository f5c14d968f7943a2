"""Make the pictures of `drawn-program.md` with the commands that the page shows."""

from __future__ import annotations

import tempfile
from pathlib import Path

from morfax.console.cli import main as morfax

SAMPLES = Path(__file__).parents[2] / "samples"
PROGRAM = ("trace", str(SAMPLES / "program.png"), "--card", str(SAMPLES / "program.toml"))
PICTURES = {
    "marks.png": PROGRAM,
    "marks-cutter.png": (*PROGRAM, "--cutter", "6mm", "--side", "outside"),
}


def main(folder: Path) -> None:
    """Make all pictures in a folder."""
    with tempfile.TemporaryDirectory() as aside:
        for name, words in PICTURES.items():
            tape = str(Path(aside) / "program.wav")
            code = morfax([*words, "-o", tape, "--picture", str(folder / name), "--quiet"])
            if code:
                raise SystemExit(code)
