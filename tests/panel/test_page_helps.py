"""The head put right on the page: it goes wrong by itself, one correction there, and the program is right.

The gap and the blot are in `test_browser`; here are the grain, the wrong turn and the tick.
"""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from morfax.motion.pathfile import read_path
from tests.console.test_helped_head import CASES, Case, off_mm
from tests.panel.browsing import (
    RUN_MS,
    WAIT_MS,
    Server,
    api,
    command,
    looked_at,
    morfax,
    on_screen,
    run_through,
)
from tests.tracer.inked import DPI, UM

ON_PAGE = [case for case in CASES if case.name not in ("a gap of 6 mm", "a blot")]


def saved(case: Case, folder: Path) -> Path:
    """The drawing of a case as a scan."""
    levels = np.clip(255 - 235 * case.drawing.darkness, 0, 255).astype(np.uint8)
    Image.fromarray(levels).save(folder / "scan.png", dpi=(DPI, DPI))
    return folder / "scan.png"


def place(page: Any, case: Case, text: str) -> tuple[float, float]:
    """Where "X,Y" in mm is in the window."""
    x, y = (float(v) / case.drawing.pitch_mm for v in text.split(","))
    return on_screen(page, x, len(case.drawing.darkness) - y)


def put_right(page: Any, case: Case) -> None:
    """Do on the sheet what the words of the case say."""
    page.click("#help-open")
    option, *more = case.words
    if option == "--bridge":
        places = [place(page, case, text) for text in more[0].split()]
        page.click("[data-tool=bridge]")
        page.mouse.move(*places[0])
        page.mouse.down()
        page.mouse.move(*places[1], steps=3)
        page.mouse.up()
    else:
        way, at = more
        page.click(f"[data-tool={way}]")
        page.mouse.click(*place(page, case, at))
    page.wait_for_selector("#corrections li", timeout=RUN_MS)
    page.wait_for_selector("#lines li", timeout=RUN_MS)


@pytest.mark.parametrize("case", ON_PAGE, ids=lambda case: case.name)
def test_one_correction_on_the_page_leads_the_head_right(
    chromium: Any, tmp_path: Path, case: Case
) -> None:
    server = Server(tmp_path / "page", saved(case, tmp_path))
    try:
        with looked_at(chromium, server) as page:
            # 1. the head put down, and gone wrong
            page.click("[data-tool=start]")
            page.mouse.click(*place(page, case, case.start))
            page.select_option("#command-kind", "run")
            api.expect(page.locator("#command")).to_contain_text("--start", timeout=WAIT_MS)
            page.click("#run-button")
            page.wait_for_selector("#stop:not([disabled])")
            page.wait_for_selector("#run-button:not([disabled])", timeout=RUN_MS)
            wrong = server.folder / "scan.panel" / "scan.traced.csv"
            if wrong.exists():
                assert off_mm(np.vstack(read_path(wrong).runs())[:, :2], case.meant) > 1.0
            # 2. put right, and run again
            put_right(page, case)
            run_through(page)
            assert page.inner_text("#figures dd >> nth=2") == "closed"
            typed = [command(page, "correct"), command(page, "run")]
    finally:
        server.end()
    path = server.folder / "scan.panel" / "scan.traced.csv"
    right = np.vstack(read_path(path).runs())[:, :2]
    assert off_mm(right, case.meant) < case.off_um * UM
    # 3. the same commands, typed beside a copy
    (tmp_path / "typed").mkdir()
    shutil.copy(tmp_path / "scan.png", tmp_path / "typed")
    for text in typed:
        morfax(tmp_path / "typed", text)
    for name in ("scan.morfax.toml", "scan.panel/scan.traced.csv", "scan.panel/scan.wav"):
        made = (server.folder / name).read_bytes()
        assert made == (tmp_path / "typed" / name).read_bytes(), name
