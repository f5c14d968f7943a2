"""Draw the picture of the README: a scan, the program that morfax makes of it, and the path that is played.

The three commands are those of the README, run on the sample `bracket`.
"""

from __future__ import annotations

import tempfile
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.axes import Axes

import morfax
from morfax.console.cli import main as command

SAMPLE = Path(__file__).parents[2] / "samples" / "bracket.png"
BLUE, GREY = "#1f5fa8", "#999999"
DPI = 110
SHOWN_LINES = 17  # of the program, as many as fit beside the drawing


def made(folder: Path) -> tuple[str, morfax.Path]:
    """Trace and play the sample by its commands; the text of the program, and the played path."""
    program, played = folder / "bracket.ngc", folder / "played.csv"
    for words in (
        ["trace", str(SAMPLE), "--lines", "contours", "-o", str(program), "--quiet"],
        ["play", str(program), "-o", str(played), "--quiet"],
    ):
        if code := command(words):
            raise SystemExit(code)
    return program.read_text(encoding="utf-8"), morfax.read_path(played)


def listing(text: str) -> str:
    """The first lines of a program."""
    lines = text.splitlines()
    return "\n".join([*lines[:SHOWN_LINES], "…"])


def draw_path(axes: Axes, path: morfax.Path) -> None:
    """The path with the tool in the work as a line, and the moves above the work dashed."""
    axes.plot(*path.xy_mm.T, "--", color=GREY, lw=1)
    for run in path.runs():
        axes.plot(*run.T, color=BLUE, lw=2)


def main(folder: Path) -> None:
    """Draw it into a folder."""
    with tempfile.TemporaryDirectory() as aside:
        text, path = made(Path(aside))
    drawing = morfax.Drawing.open(SAMPLE)
    extent = (0.0, drawing.width_mm, 0.0, drawing.height_mm)
    figure, (scan, program, played) = plt.subplots(
        1, 3, figsize=(12, 4.0), width_ratios=(1, 0.62, 1), constrained_layout=True
    )
    scan.imshow(drawing.darkness, extent=extent, cmap="Greys", vmin=0, vmax=1.2)
    scan.set_title("scan.png: a pen line on paper, 300 dpi")
    program.text(0.02, 1.0, listing(text), family="monospace", fontsize=8.5, va="top")
    program.set_title("scan.ngc: G-code")
    draw_path(played, path)
    played.set_title("the path that the program makes, mm")
    for axes in (scan, played):
        axes.set(xlim=extent[:2], ylim=extent[2:], aspect="equal")
    scan.set(xticks=[], yticks=[])
    program.axis("off")
    figure.savefig(folder / "scan-to-program.png", dpi=DPI)
    plt.close(figure)
