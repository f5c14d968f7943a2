"""Make the pictures of all the ink in `several-lines.md`: a net, by --lines contours and by --lines all."""

from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np
from PIL import Image

from benchmarks.net_drawings import cells
from benchmarks.nets import drawn
from morfax.console.cli import main as morfax

SEED = 12
COLOURS, WIDEST = 48, Image.Quantize.MAXCOVERAGE  # so that thin lines keep their colours


def main(folder: Path) -> None:
    """Make both pictures in a folder."""
    with tempfile.TemporaryDirectory() as aside:
        net = Path(aside) / "net.png"
        drawn(cells(np.random.default_rng(SEED)), net, SEED)
        for lines in ("contours", "all"):
            picture = str(folder / f"net-{lines}.png")
            path = str(Path(aside) / f"{lines}.csv")
            words = ["trace", str(net), "--lines", lines, "-o", path, "--picture", picture]
            if code := morfax([*words, "--quiet"]):
                raise SystemExit(code)
            # the paper's noise would take ten times the space
            Image.open(picture).convert("RGB").quantize(COLOURS, WIDEST).save(
                picture, optimize=True
            )
