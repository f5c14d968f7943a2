"""The pictures of the panel: the page while the head runs, and after the run."""

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
SIZE = {"width": 1280, "height": 800}  # a small desk; CSS pixels
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
            page = browser.new_page(viewport=SIZE)
            page.goto(address)
            return [
                _running(page, folder / "panel-running.png"),
                _run(page, folder / "panel.png"),
            ]
        finally:
            browser.close()
            server.terminate()
            server.wait(20)
            server.stdout.close()


def _running(page: Any, file: Path) -> Path:
    """The head at work."""
    page.wait_for_selector("#lines li", timeout=RUN_MS)
    page.click("#which >> text=Contours")
    page.select_option("#field--machine", "grbl-router")
    page.select_option("#pace", "1")
    page.click("#run-button")
    page.wait_for_selector("#inset:not([hidden])", timeout=RUN_MS)
    page.wait_for_timeout(2500)
    page.click("#hold")
    page.wait_for_timeout(1200)
    page.screenshot(path=file)
    return file


def _run(page: Any, file: Path) -> Path:
    """The result, with the machine somewhere on its way."""
    page.select_option("#pace", "")
    page.click("#hold")
    page.wait_for_selector("#result-card:not([hidden])", timeout=RUN_MS)
    page.locator("#machine .bar > input[type=range]").evaluate(
        "s => { s.value = 0.4 * s.max; s.dispatchEvent(new Event('input')); }"
    )
    page.wait_for_timeout(900)
    page.screenshot(path=file)
    return file


if __name__ == "__main__":
    print(*make(Path(sys.argv[1]) if len(sys.argv) > 1 else PICTURES), sep="\n")
