"""The pictures of the panel: the page after a run, light and dark, on a desk and on a telephone."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[2]
PICTURES = ROOT / "docs" / "pictures"
SIZES = {1280: 800, 390: 844}  # a small desk, a telephone; CSS pixels
RUN_MS = 200_000


def make(folder: Path = PICTURES) -> list[Path]:
    """Take the pictures; needs Chromium and playwright."""
    from playwright.sync_api import sync_playwright

    with tempfile.TemporaryDirectory() as work, sync_playwright() as playwright:
        shutil.copy(ROOT / "samples" / "bracket.png", work)
        words = [sys.executable, "-m", "morfax", "panel", "bracket.png", "--no-browser"]
        environment = {**os.environ, "PYTHONPATH": str(ROOT)}
        server = subprocess.Popen(
            words, cwd=work, env=environment, stdout=subprocess.PIPE, text=True
        )
        assert server.stdout is not None
        address = server.stdout.readline().strip()
        browser = playwright.chromium.launch(
            executable_path=shutil.which("chromium"), args=["--no-sandbox"]
        )
        try:
            page = browser.new_page(viewport={"width": 1280, "height": SIZES[1280]})
            page.goto(address)
            _run(page, folder)
            return [
                _taken(page, folder, theme, width)
                for theme in ("light", "dark")
                for width in SIZES
            ]
        finally:
            browser.close()
            server.terminate()
            server.wait(20)
            server.stdout.close()


def _run(page: Any, folder: Path) -> None:
    """The way to a result, with a picture of the head at work."""
    page.wait_for_selector("#lines li", timeout=RUN_MS)
    page.click("#which >> text=Contours")
    page.select_option("#field--machine", "grbl-router")
    page.select_option("#pace", "1")
    page.click("#run-button")
    page.wait_for_selector("#inset:not([hidden])", timeout=RUN_MS)
    page.wait_for_timeout(2500)
    page.click("#hold")
    page.wait_for_timeout(1200)
    page.screenshot(path=folder / "panel-running.png")
    page.select_option("#pace", "")
    page.click("#hold")
    page.wait_for_selector("#result-card:not([hidden])", timeout=RUN_MS)
    page.locator("#machine .bar > input[type=range]").evaluate(
        "s => { s.value = 0.4 * s.max; s.dispatchEvent(new Event('input')); }"
    )


def _taken(page: Any, folder: Path, theme: str, width: int) -> Path:
    """One picture."""
    page.set_viewport_size({"width": width, "height": SIZES[width]})
    if page.get_attribute("html", "data-theme") != theme:
        page.click("#theme")
    page.evaluate("scrollTo(0, 0)")
    page.wait_for_timeout(900)
    file = folder / f"panel-{theme}-{width}.png"
    page.screenshot(path=file)
    return file


if __name__ == "__main__":
    print(*make(Path(sys.argv[1]) if len(sys.argv) > 1 else PICTURES), sep="\n")
