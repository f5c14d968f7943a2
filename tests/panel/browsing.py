"""A server of the panel in a process of its own, and Chromium that looks at its page.

Chromium is Debian's (or the one that MORFAX_CHROMIUM names); without it these tests are left out.
"""

from __future__ import annotations

import os
import shlex
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

api = pytest.importorskip("playwright.sync_api", reason="playwright is not installed")
CHROMIUM = os.environ.get("MORFAX_CHROMIUM") or shutil.which("chromium")
if CHROMIUM is None:
    pytest.skip(
        "no chromium: install Debian's, or name one with MORFAX_CHROMIUM",
        allow_module_level=True,
    )

ROOT = Path(__file__).parents[2]
RUN_MS = 300_000  # a run, where the kernels are compiled first, beside other work
SETTLED_MS = 1000  # a result that was there is shown within
WAIT_MS = 120_000  # all else; what comes is awaited, so that only a failure takes as long


class Server:
    """`morfax panel` in a folder of its own."""

    def __init__(self, folder: Path, drawing: Path = ROOT / "samples" / "bracket.png") -> None:
        self.folder, self.drawing = folder, drawing.name
        folder.mkdir(exist_ok=True)
        shutil.copy(drawing, folder)
        self.start()

    def start(self) -> None:
        """Start the server, and take its address."""
        words = [sys.executable, "-m", "morfax", "panel", self.drawing, "--no-browser"]
        environment = {**os.environ, "PYTHONPATH": str(ROOT)}
        self.process = subprocess.Popen(
            words, cwd=self.folder, env=environment, stdout=subprocess.PIPE, text=True
        )
        assert self.process.stdout is not None
        self.url = self.process.stdout.readline().strip()

    def end(self, how: int = signal.SIGINT) -> None:
        """End the server."""
        self.process.send_signal(how)
        self.process.wait(WAIT_MS / 1000)
        assert self.process.stdout is not None
        self.process.stdout.close()


@contextmanager
def launched() -> Iterator[Any]:
    """A browser."""
    with api.sync_playwright() as playwright:
        sandbox = ["--no-sandbox"] if hasattr(os, "getuid") and os.getuid() == 0 else []
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=sandbox)
        yield browser
        browser.close()


@contextmanager
def looked_at(chromium: Any, server: Server) -> Iterator[Any]:
    """The page, opened by its address; what it complains of is a failure."""
    page = chromium.new_page(viewport={"width": 1280, "height": 800})
    page.set_default_timeout(WAIT_MS)
    complaints = list[str]()
    page.on("pageerror", lambda error: complaints.append(str(error)))
    page.on(
        "console",
        lambda said: (
            complaints.append(f"{said.text} {said.location['url']}")
            if said.type == "error"
            else None
        ),
    )
    opened(page, server)
    yield page
    page.close()
    told = [
        text
        for text in complaints
        if "ERR_CONNECTION_REFUSED" not in text and "409" not in text
    ]
    assert not told, f"the page complained: {told}"


def opened(page: Any, server: Server) -> None:
    """Open the page, and wait until the lines are there."""
    page.goto(server.url)
    page.wait_for_selector("#lines li", timeout=RUN_MS)


def morfax(folder: Path, typed: str) -> None:
    """Run a command as the page shows it."""
    words = shlex.split(typed)
    assert words.pop(0) == "morfax"
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    subprocess.run(
        [sys.executable, "-m", "morfax", *words, "-q"],
        cwd=folder,
        env=environment,
        check=True,
        stdout=subprocess.DEVNULL,
    )


def soon(holds: Callable[[], bool]) -> None:
    """Wait until something holds."""
    late_s = time.monotonic() + WAIT_MS / 1000
    while not holds():
        assert time.monotonic() < late_s
        time.sleep(0.05)


def settled(page: Any, selector: str) -> dict[str, float]:
    """The box of an element once it has stayed where it is: what is shown later moves what is above it."""
    boxes = [page.locator(selector).bounding_box()]

    def stays() -> bool:
        page.wait_for_timeout(SETTLED_MS)
        boxes.append(page.locator(selector).bounding_box())
        return bool(boxes[-1] == boxes[-2])

    soon(stays)
    return dict(boxes[-1])


def ran(page: Any) -> None:
    """Wait until a run is done; one without a result fails with the words of the page."""
    page.wait_for_selector("#run-button:not([disabled])", timeout=RUN_MS)
    try:
        page.wait_for_selector("#result-card:not([hidden])")
    except api.TimeoutError:
        told = page.inner_text("#messages")
        pytest.fail(f"the run has no result; the page says {told!r}")


def on_screen(page: Any, x_px: float, y_px: float) -> tuple[float, float]:
    """Where a pixel of the picture is in the window."""
    box = page.locator("#sheet").bounding_box()
    x, y = page.evaluate("at => panel.sheet.toScreen(at)", [x_px, y_px])
    return box["x"] + x, box["y"] + y


def run_through(page: Any) -> None:
    """Run, and wait for the end."""
    page.wait_for_selector("#run-button:not([disabled])", timeout=RUN_MS)
    page.click("#run-button")
    page.wait_for_selector("#stop:not([disabled])")
    ran(page)


def command(page: Any, kind: str = "run") -> str:
    """A command as the page shows it."""
    page.select_option("#command-kind", kind)
    return str(page.inner_text("#command"))
