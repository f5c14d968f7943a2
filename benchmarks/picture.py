"""A picture of 100 000 points with its error in colour, three enlargements and a scale; 0.3 s are asked.

Beside it, in the same run: `LineCollection`, as one would first draw such a line, on axes without anything.
Processor time, the best of three; matplotlib, which the second needs, is imported before.
"""

from __future__ import annotations

import tempfile
import time
from pathlib import Path as FilePath

import numpy as np

from benchmarks.rows import Row, best_s, tell
from morfax.motion.arrays import Array
from morfax.motion.motion import Path
from morfax.reports.canvas import new_figure
from morfax.reports.overlay import Picture, draw
from morfax.tracer.drawing.drawing import Drawing

POINTS = 100_000
CAM = FilePath(__file__).parents[1] / "samples" / "cam.png"


def contour() -> tuple[Array, Array]:
    """Places along a lobed contour, mm, and an error that swings along it, mm."""
    t = np.linspace(0, 2 * np.pi, POINTS)
    radius = 30 + 4 * np.cos(5 * t)
    return 40 + radius * [np.cos(t), np.sin(t)], 0.003 * np.sin(31 * t)


def plainly(places: Array, error: Array, file: FilePath) -> None:
    """The same points as pieces of which each has a colour."""
    from matplotlib.collections import LineCollection

    figure = new_figure(layout="none")
    lines = LineCollection(list(np.stack([places[:-1], places[1:]], axis=1)))
    lines.set_array(np.abs(error[1:]))
    axes = figure.add_subplot()
    axes.add_collection(lines)
    axes.autoscale()
    figure.savefig(file)


def rows() -> list[Row]:
    """All figures of this benchmark."""
    columns, error = contour()
    places, drawing = columns.T.copy(), Drawing.open(CAM)
    path = Path(np.arange(POINTS) / 6000, np.column_stack([places, np.full(POINTS, -1.0)]))
    picture = Picture("a lobed contour", path, drawing, None, places, error)
    with tempfile.TemporaryDirectory() as name:
        file = FilePath(name) / "a.png"
        draw(picture, file)
        took = best_s(
            {
                "picture": lambda: draw(picture, file),
                "pieces": lambda: plainly(places, error, file),
            },
            time.process_time,
        )
    ratio = took["picture"] / took["pieces"]
    return [
        Row(
            "picture of 100 000 points", took["picture"], "s (0.3 asked)", ratio, "pieces alone"
        ),
        Row("the pieces alone, each in its colour", took["pieces"], "s"),
    ]


def main() -> None:
    """Print the figures as a table."""
    tell("picture", rows())


if __name__ == "__main__":
    main()
