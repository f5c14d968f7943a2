"""The way from a drawing to G-code as docs/how-to/panel.md has it click by click, and how long it takes."""

from __future__ import annotations

import os
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.panel.browsing import ROOT, RUN_MS, WAIT_MS, Server, api, launched, looked_at, ran

MINUTE_S = 60.0
CLICKS = 5  # as the page of the documentation counts them


@pytest.fixture
def page(tmp_path: Path) -> Iterator[Any]:
    """The page with the sample on it, whose kernels are compiled."""
    server = Server(tmp_path / "page", ROOT / "samples" / "program.png")
    try:
        with launched() as chromium, looked_at(chromium, server) as page:
            page.click("#run-button")  # of a tape: the first run of all compiles
            ran(page)
            page.reload()
            page.wait_for_selector("#lines li", timeout=RUN_MS)
            yield page
    finally:
        server.end()


def test_from_the_drawing_to_g_code_in_under_a_minute(page: Any, tmp_path: Path) -> None:
    began_s, clicks = time.monotonic(), 0

    def click(selector: str) -> None:
        nonlocal clicks
        clicks += 1
        page.click(selector)

    # 1. the drawing lies there, to scale; 2. the lines
    click("#which >> text=Contours")
    # 3. the machine: the list is opened, and one is chosen
    click("#field--machine")
    clicks += 1
    page.select_option("#field--machine", "grbl-router")
    page.keyboard.press("Escape")
    api.expect(page.locator("#command")).to_contain_text(
        "--machine grbl-router", timeout=WAIT_MS
    )
    # 4. run, 5. save
    click("#run-button")
    page.wait_for_selector("#stop:not([disabled])")
    ran(page)
    click("[data-save=program]")
    page.wait_for_selector("#messages >> text=saved program.nc", timeout=RUN_MS)
    seconds = time.monotonic() - began_s
    assert clicks == CLICKS
    program = next((tmp_path / "page" / "program.panel").glob("program.nc"))
    text = program.read_text(encoding="ascii")
    assert "G1" in text and "M3" in text
    # measured 30 s on two cores with ten times their work; with still more the time says nothing
    if os.getloadavg()[0] < 10 * (os.cpu_count() or 1):
        assert seconds < MINUTE_S
