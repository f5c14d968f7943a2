"""Memory of an hour: as many places as the head goes in an hour pass through the server to a page that keeps
them all in sight; neither grows.

An hour is 36 m at 10 mm/s, a place every 0.1 mm, in 30 frames a second: here they come as fast as the server
takes them, in some seconds. The server has a process of its own: this one also holds what other tests left.
"""

from __future__ import annotations

import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from morfax.panel import head_path
from tests.panel.browsing import RUN_MS, WAIT_MS, launched
from tests.panel.serving import FRAMES, MB, PLACES, Serving

SERVER_MB = 16.0  # 8 bytes to a place are 3 MB, and frames on their way to the page
PAGE_MB = 8.0  # of the JavaScript heap: the path itself is in the browser's own drawing


@pytest.fixture
def serving(tmp_path: Path) -> Iterator[Serving]:
    """A server that tells what memory it holds."""
    serving = Serving(tmp_path)
    yield serving
    serving.end()


def come(page: Any, places: int) -> None:
    """Wait until the page has so many places."""
    until_s = time.monotonic() + RUN_MS / 1000
    while page.evaluate("panel.head.count") < places:
        assert time.monotonic() < until_s
        page.wait_for_timeout(200)


def test_the_memory_of_an_hour_is_flat(serving: Serving) -> None:
    with launched() as chromium:
        page = chromium.new_page()
        page.set_default_timeout(WAIT_MS)
        page.goto(serving.url)
        page.wait_for_selector("html[data-ready]")
        cdp = page.context.new_cdp_session(page)

        def heap_mb() -> float:
            cdp.send("HeapProfiler.collectGarbage")
            return float(cdp.send("Runtime.getHeapUsage")["usedSize"]) / MB

        # 1. six minutes, until everything is in use
        tenth = FRAMES // 10
        serving.stream(0, tenth)
        come(page, round(tenth * PLACES))
        server_mb, page_mb = serving.held_mb(), heap_mb()
        # 2. the rest of the hour
        serving.stream(tenth, FRAMES)
        come(page, round(FRAMES * PLACES))
        assert serving.held_mb() - server_mb < SERVER_MB
        assert heap_mb() - page_mb < PAGE_MB
        # 3. and twelve minutes more: what is kept has a bound, which they pass
        kept = serving.kept()
        serving.stream(0, FRAMES // 5)
        page.wait_for_timeout(500)
        assert page.evaluate("panel.head.count") <= head_path.MOST
        assert serving.kept() < kept <= head_path.MOST < kept + FRAMES // 5 * PLACES
        assert serving.held_mb() - server_mb < SERVER_MB
        page.close()
