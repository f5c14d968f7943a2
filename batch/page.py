"""The page of a batch: every drawing with its traced line in small, those that want a person's eye first.

Signals in: the manifest of a folder. Signals out: `report.html` in the same folder, which shows the pictures
that lie in the drawings' folders; a click on a heading sorts. It needs no network.

A drawing wants an eye, most first: no result; a line that was lost; remarks; ink that was not followed.

Source: our own. Questions: how much ink lettering has is not known, so a low share alone is no fault.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from html import escape
from pathlib import Path
from urllib.parse import quote

from morfax.batch import manifest
from morfax.batch.results import FIGURES, PICTURE
from morfax.batch.row import BatchRow
from morfax.motion.files import printable, written_beside

NAME = "report.html"
STYLE = """
:root { color-scheme: light dark; --line: #8886; --bad: #b3261e; }
@media (prefers-color-scheme: dark) { :root { --bad: #f2b8b5; } }
body { font: 14px/1.45 system-ui, sans-serif; margin: 1.5em; }
h1 { font-size: 1.3em; } table { border-collapse: collapse; width: 100%; }
th, td { text-align: left; padding: .4em .7em; border-bottom: 1px solid var(--line); vertical-align: top; }
th button { font: inherit; font-weight: 600; background: none; border: 0; padding: 0; cursor: pointer;
  color: inherit; }
th[aria-sort] button::after { content: " ↑"; } th[aria-sort=descending] button::after { content: " ↓"; }
td.figure { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
img { display: block; width: 200px; height: 150px; object-fit: contain; background: #fff; }
.fault { color: var(--bad); } td:nth-child(2), td:nth-child(4) { overflow-wrap: anywhere; }
td:nth-child(2) { min-width: 9em; } td p { margin: .4em 0 0; } .option { white-space: nowrap; }
"""
OPTION = re.compile(r"--[a-z][a-z-]*")  # which a browser breaks behind each of its hyphens
IN_ONE_PIECE = r'<span class="option">\g<0></span>'

SORT = """
document.querySelectorAll("th button").forEach((button) => button.addEventListener("click", () => {
  const head = button.parentElement, column = head.cellIndex, body = document.querySelector("tbody");
  const up = head.getAttribute("aria-sort") !== "ascending";
  document.querySelectorAll("th").forEach((th) => th.removeAttribute("aria-sort"));
  head.setAttribute("aria-sort", up ? "ascending" : "descending");
  const key = (row) => row.cells[column].dataset.key;
  const numbers = head.dataset.kind === "number";
  const order = (a, b) => numbers ? key(a) - key(b) : key(a).localeCompare(key(b));
  const rows = [...body.rows].sort((a, b) => up ? order(a, b) : order(b, a));
  body.append(...rows);
}));
"""
COLUMNS = (
    ("", ""),
    ("Drawing", "text"),
    ("For your eye", "number"),
    ("Ending, fault, remarks", "text"),
    ("Ink followed", "number"),
    ("Length", "number"),
    ("Time", "number"),
    ("Memory", "number"),
)
UNKNOWN = -1.0  # sorts before all that was measured


def write_page(folder: Path) -> tuple[Path, int]:
    """Write the page of a batch's folder; its name, and how many drawings are on it.

    Raises FileFault if the folder has no manifest.
    """
    last = {row.file: row for row in manifest.rows(folder)}
    rows = sorted(last.values(), key=lambda row: (-wants_eye(row), row.file))
    title = f"{len(rows)} drawings, {sum(not row.is_well for row in rows)} with a fault"
    with written_beside(folder / NAME) as beside, beside.open("w", encoding="utf-8") as page:
        page.write(
            f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><title>{title}</title>'
            '<meta name="viewport" content="width=device-width">'
            f"<style>{STYLE}</style></head>\n<body><h1>{title}</h1>\n"
        )
        page.write(f"<table><thead><tr>{''.join(_headings())}</tr></thead><tbody>\n")
        # a file's name may hold any bytes
        page.writelines(printable(_line(folder, row)) for row in rows)
        page.write(f"</tbody></table><script>{SORT}</script></body></html>\n")
    return folder / NAME, len(rows)


def wants_eye(row: BatchRow) -> float:
    """How much a drawing wants a person's eye: 3 without a result, 2 a lost line, 1 remarks; and up to 1
    more for ink that was not followed.
    """
    grade = 1.0 if row.remarks else 0.0
    if not row.is_well:
        grade = 2.0 if row.ending == "incomplete" else 3.0
    share = row.figures.get("ink_followed_share")
    return grade + (1 - min(float(share), 1.0) if share is not None else 0.0)


def _headings() -> Iterator[str]:
    """The headings of the table; those that sort are buttons."""
    for number, (name, kind) in enumerate(COLUMNS):
        if not name:
            yield "<th>Picture</th>"
            continue
        mark = ' aria-sort="descending"' if number == 2 else ""
        yield f'<th data-kind="{kind}"{mark}><button type="button">{name}</button></th>'


def _line(folder: Path, row: BatchRow) -> str:
    """The table's line of one drawing."""
    share = row.figures.get("ink_followed_share")
    length_mm = row.figures.get("length_mm")
    told = [*([row.fault] if row.fault else []), *row.remarks]
    cells = (
        f"<td>{_picture(folder, row)}</td>",
        f'<td data-key="{escape(row.file)}">{_linked(row)}</td>',
        _figure(wants_eye(row), f"{wants_eye(row):.2f}"),
        f'<td data-key="{escape(" ".join([row.ending, *told]))}"'
        f"{'' if row.is_well else ' class=fault'}>{escape(row.ending)}"
        f"{''.join(map(_paragraph, told))}</td>",
        _figure(share, "" if share is None else f"{100 * share:.1f} %"),
        _figure(length_mm, "" if length_mm is None else f"{length_mm:.1f} mm"),
        _figure(row.seconds, f"{row.seconds:.1f} s"),
        _figure(row.memory_mb, f"{row.memory_mb:.0f} MB"),
    )
    return f"<tr>{''.join(cells)}</tr>\n"


def _paragraph(text: str) -> str:
    """What is told of a drawing, with its options in one piece."""
    return f"<p>{OPTION.sub(IN_ONE_PIECE, escape(text))}</p>"


def _figure(value: float | None, shown: str) -> str:
    """A cell with a number."""
    return f'<td class="figure" data-key="{UNKNOWN if value is None else value}">{shown}</td>'


def _picture(folder: Path, row: BatchRow) -> str:
    """The picture of a drawing, if it has one."""
    if not row.folder or not (folder / row.folder / PICTURE).is_file():
        return ""
    source = quote(printable(f"{row.folder}/{PICTURE}"))
    name = escape(Path(row.file).name)
    return f'<a href="{source}"><img src="{source}" loading="lazy" alt="{name}, traced"></a>'


def _linked(row: BatchRow) -> str:
    """The name of a drawing, which leads to its figures."""
    name = escape(row.file)
    return (
        f'<a href="{quote(printable(f"{row.folder}/{FIGURES}"))}">{name}</a>'
        if row.folder
        else name
    )
