"""Memory of an hour: as many places as the head goes in an hour pass through the server to a page that keeps
them all in sight; neither grows.

An hour is 36 m at 10 mm/s, a place every 0.1 mm, in 30 frames a second: here they come as fast as the server
takes them, in some seconds.
"""

from __future__ import annotations

import asyncio
import gc
import threading
import time
import tracemalloc
from collections.abc import Iterator
from typing import Any

import pytest
import uvicorn

from morfax.panel import head_path
from morfax.panel.app import routes
from morfax.panel.bench import Bench
from morfax.panel.guard import Guard
from morfax.panel.server import Address, _listening
from tests.panel.browsing import WAIT_MS, launched

FRAMES = 3600 * 30
PLACES = 360_000 / FRAMES  # to a frame
MB = 1_000_000
SERVER_MB = 16.0  # 8 bytes to a place are 3 MB, and frames on their way to the page
PAGE_MB = 8.0  # of the JavaScript heap: the path itself is in the browser's own drawing


class Serving:
    """A server in a thread, with a bench whose worker says what the test has it say."""

    def __init__(self, bench: Bench) -> None:
        self.bench = bench
        self.listening = _listening(Address())
        address = Address(port=self.listening.getsockname()[1])
        app = Guard(routes(bench), address.token, address.hosts, "morfax_panel_test")
        self.url = address.url
        config = uvicorn.Config(
            app, log_level="warning", ws="websockets-sansio", timeout_graceful_shutdown=1
        )
        self.server = uvicorn.Server(config)
        self.thread = threading.Thread(target=self._run, daemon=True)
        self.thread.start()

    def _run(self) -> None:
        async def serve() -> None:
            self.loop = asyncio.get_running_loop()
            await self.server.serve(sockets=[self.listening])

        asyncio.run(serve())

    def stream(self, first: int, last: int) -> None:
        """Have the head go from frame to frame, as fast as the server takes them."""

        async def send() -> None:
            for k in range(first, last):
                begin, end = round(k * PLACES), round((k + 1) * PLACES)
                fresh = [[10 + (i % 900) / 12, 10 + (i // 900) / 8] for i in range(begin, end)]
                head = {"x_mm": 20.0, "y_mm": 20.0, "heading_rad": 0.0, "drum_mm": []}
                self.bench.heard(
                    {"say": "head", "fresh": fresh, "head": head, "words": "", "run": 1}
                )
                if k % 400 == 0:
                    await asyncio.sleep(0.002)

        asyncio.run_coroutine_threadsafe(send(), self.loop).result(WAIT_MS / 1000)

    def end(self) -> None:
        """End the server."""
        self.server.should_exit = True
        self.thread.join(10)


@pytest.fixture
def serving(bench: Bench) -> Iterator[Serving]:
    """A server with a page's bench, whose memory is traced."""
    tracemalloc.start()
    serving = Serving(bench)
    yield serving
    serving.end()
    tracemalloc.stop()


def held_mb() -> float:
    """Memory that Python holds since tracing began, MB; the resident size of a worker that ran other tests
    moves by more than an hour may take.
    """
    gc.collect()
    return tracemalloc.get_traced_memory()[0] / MB


def come(page: Any, places: int) -> None:
    """Wait until the page has so many places."""
    until_s = time.monotonic() + WAIT_MS / 1000
    while page.evaluate("panel.head.count") < places:
        assert time.monotonic() < until_s
        page.wait_for_timeout(50)


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
        server_mb, page_mb = held_mb(), heap_mb()
        # 2. the rest of the hour
        serving.stream(tenth, FRAMES)
        come(page, round(FRAMES * PLACES))
        assert held_mb() - server_mb < SERVER_MB
        assert heap_mb() - page_mb < PAGE_MB
        # 3. and a second one: what is kept has a bound
        kept = len(serving.bench.path)
        serving.stream(0, FRAMES)
        page.wait_for_timeout(500)
        assert page.evaluate("panel.head.count") <= head_path.MOST
        assert kept <= head_path.MOST and len(serving.bench.path) <= head_path.MOST
        assert held_mb() - server_mb < SERVER_MB
        page.close()
