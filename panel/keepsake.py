"""The keepsake: one file of HTML with the result in it, which opens without a server or a network.

Signals in: the bench's last result, and its picture. Signals out: a file in the panel's folder. The page's
own modules for sheet, machine and slider are put into it one after the other, without the lines that import
them from each other; its policy forbids it to ask any other place.
"""

from __future__ import annotations

import base64
import html
import json
import re
from importlib import resources
from typing import TYPE_CHECKING, Any

import cv2

from morfax.jobs.wrong_use import WrongUse
from morfax.motion.files import written_beside

if TYPE_CHECKING:
    from morfax.panel.bench import Bench
    from morfax.panel.tiles import Pyramid

MODULES = (
    "format.js",
    "tiles.js",
    "ruler.js",
    "ground.js",
    "sheet.js",
    "result.js",
    "tape.js",
    "replay.js",
    "keepsake.js",
)
STYLES = ("uPlot.min.css", "style.css")
MOST_PX = 3000  # a side of the picture: a sheet of A4 at 250 dpi
QUALITY = [cv2.IMWRITE_JPEG_QUALITY, 82]
POLICY = "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:"


def write(bench: Bench) -> None:
    """Write the page of the last result; raises WrongUse if there is none."""
    if (
        bench.kept.result is None
        or bench.picture is None
        or bench.drawing is None
        or bench.sheet is None
    ):
        raise WrongUse("there is no result yet; run first")
    picture = _picture(bench.picture)
    picture["mm_per_px"] = bench.sheet["width_mm"] / picture["columns"]
    data = {
        "drawing": bench.drawing.name,
        "command": " ".join(["morfax run", *(bench.kept.words or [])]),
        "result": bench.kept.result,
        "picture": picture,
    }
    with written_beside(bench.folder / f"{bench.drawing.stem}.html") as beside:
        beside.write_text(page(data), encoding="utf-8")


def page(data: dict[str, Any]) -> str:
    """The whole page with its data."""
    text = _file("keepsake.html")
    parts = {
        "POLICY": POLICY,
        "TITLE": html.escape(data["drawing"]),
        "STYLE": "\n".join(map(_file, STYLES)),
        "UPLOT": _file("uPlot.iife.min.js"),
        "DATA": json.dumps(data).replace("<", "\\u003c"),  # no end of a script in it
        "SCRIPT": "\n".join(map(_without_imports, map(_file, MODULES))),
    }
    return re.sub(r"@([A-Z]+)@", lambda found: parts[found[1]], text)


def _picture(picture: Pyramid) -> dict[str, Any]:
    """The picture at a size for a page, as a data address."""
    level = next(pixels for pixels in picture.levels if max(pixels.shape) <= MOST_PX)
    done, packed = cv2.imencode(".jpg", level, QUALITY)
    assert done
    address = "data:image/jpeg;base64," + base64.b64encode(packed.tobytes()).decode("ascii")
    return {"address": address, "rows": level.shape[0], "columns": level.shape[1]}


def _without_imports(script: str) -> str:
    """A module as a part of one script."""
    script = re.sub(r"^import .*;\n", "", script, flags=re.MULTILINE)
    return re.sub(r"^export ", "", script, flags=re.MULTILINE)


def _file(name: str) -> str:
    """A file of the page."""
    return resources.files("morfax.panel").joinpath("page", name).read_text(encoding="utf-8")
