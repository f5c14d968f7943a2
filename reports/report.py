"""The report of a comparison: one file of HTML, pictures inside, that prints on A4.

Signals in: rows of figures (see `table`), and pictures of matplotlib with a caption each. Out: a file
that needs no other.
"""

from __future__ import annotations

import base64
import io
from collections.abc import Mapping, Sequence
from html import escape
from pathlib import Path as FilePath
from typing import TYPE_CHECKING

from morfax.motion.files import printable, written_beside
from morfax.reports.table import as_cells

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from morfax.jobs.figures import Figures

STYLE = """
body { font: 14px/1.45 Georgia, serif; max-width: 1080px; margin: 2em auto; padding: 0 1em; color: #111; }
h1 { font-size: 1.5em; } figure { margin: 1.5em 0; } figcaption { font-style: italic; }
img { max-width: 100%; } table { border-collapse: collapse; font-size: 0.86em; margin: 1em 0; }
th, td { text-align: right; padding: 0.25em 0.6em; border-bottom: 1px solid #bbb; vertical-align: bottom; }
th:first-child, td:first-child { text-align: left; } p.fault { color: #a00; }
@media print { body { margin: 0; max-width: none; font-size: 10px; } figure { break-inside: avoid; } }
@page { size: A4; margin: 14mm; }
"""


def write(
    file: FilePath,
    title: str,
    told: Sequence[str],
    rows: Mapping[str, Figures],
    pictures: Sequence[tuple[str, Figure]],
) -> None:
    """Write the report: an introduction, a table with a row for each system, faults in full, the pictures."""
    faults = [f"{name}: {row['fault']}" for name, row in rows.items() if row.get("fault")]
    plain = [
        (name.replace("_", " "), {k: value for k, value in row.items() if k != "fault"})
        for name, row in rows.items()
    ]
    body = [
        f"<h1>{escape(title)}</h1>",
        *(f"<p>{escape(line)}</p>" for line in told),
        _table(as_cells(plain)),
        *(f'<p class="fault">{escape(fault)}</p>' for fault in faults),
        *(_figure(figure, said) for said, figure in pictures),
    ]
    head = f'<meta charset="utf-8"><title>{escape(title)}</title><style>{STYLE}</style>'
    html = (
        f'<!DOCTYPE html>\n<html lang="en"><head>{head}</head>\n<body>\n'
        + "\n".join(body)
        + "\n</body></html>\n"
    )
    with written_beside(file) as beside:
        beside.write_text(printable(html), encoding="utf-8")


def _table(cells: list[list[str]]) -> str:
    """A table whose first line is its head."""
    lines = []
    for number, line in enumerate(cells):
        tag = "td" if number else "th"
        lines.append(
            "<tr>" + "".join(f"<{tag}>{escape(cell)}</{tag}>" for cell in line) + "</tr>"
        )
    return "<table>" + "\n".join(lines) + "</table>"


def _figure(figure: Figure, said: str) -> str:
    """A picture with its caption."""
    caption = escape(said)
    image = f'<img src="{_embedded(figure)}" alt="{caption}">'
    return f"<figure>{image}<figcaption>{caption}</figcaption></figure>"


def _embedded(figure: Figure) -> str:
    """A picture as part of the page."""
    made = io.BytesIO()
    figure.savefig(made, format="png")
    return "data:image/png;base64," + base64.b64encode(made.getvalue()).decode("ascii")
