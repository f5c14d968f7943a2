"""A bench with a worker that does nothing, and a server round it in a process of its own, which holds nothing
else: its memory is the server's.
"""

from __future__ import annotations

import asyncio
import gc
import multiprocessing
import shutil
import threading
import tracemalloc
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

import uvicorn

from morfax.console.verbs.panel import _command_line
from morfax.panel.app import routes
from morfax.panel.bench import Bench
from morfax.panel.guard import Guard
from morfax.panel.history import HistoryStep
from morfax.panel.server import Address, _listening

SAMPLES = Path(__file__).parents[2] / "samples"
FRAMES = 3600 * 30  # of an hour
PLACES = 360_000 / FRAMES  # to a frame
AT_ONCE = 400  # frames; then the server sends
MB = 1_000_000
ENDED_S = 30  # for a process that is asked to end


class Idle:
    """A worker that takes down what is sent to it."""

    def __init__(self, heard):
        self.heard, self.sent = heard, []

    async def start(self):
        """Start nothing."""

    async def send(self, *message):
        """Take a message down."""
        self.sent.append(message)

    async def close(self):
        """End nothing."""


def bench_in(folder: Path) -> Bench:
    """A bench in a folder, with the cam on it."""
    shutil.copy(SAMPLES / "cam.png", folder)
    (folder / "work").mkdir()
    bench = Bench(folder / "work", {"cam.png": folder / "cam.png"}, _command_line(), Idle)
    bench.history.add(HistoryStep("cam.png", {}))
    return bench


class Serving:
    """A server in a process of its own, whose worker says what the test has it say."""

    def __init__(self, folder: Path) -> None:
        spawn = multiprocessing.get_context("spawn")
        self._pipe, far_end = spawn.Pipe()
        self._process = spawn.Process(target=_serve, args=(far_end, folder), daemon=True)
        self._process.start()
        self.url: str = self._pipe.recv()

    def stream(self, first: int, last: int) -> None:
        """Have the head go from frame to frame, as fast as the server takes them."""
        self._ask("stream", first, last)

    def held_mb(self) -> float:
        """Memory that the server's Python holds, MB."""
        return float(self._ask("held"))

    def kept(self) -> int:
        """Places of the path that the server keeps."""
        return int(self._ask("kept"))

    def end(self) -> None:
        """End the server."""
        self._ask("end")
        self._process.join(ENDED_S)

    def _ask(self, *words: Any) -> Any:
        self._pipe.send(words)
        return self._pipe.recv()


def _serve(pipe: Connection, folder: Path) -> None:
    """Serve, and do what is asked over the pipe, until it asks for the end."""
    tracemalloc.start()
    bench = bench_in(folder)
    listening = _listening(Address())
    address = Address(port=listening.getsockname()[1])
    app = Guard(routes(bench), address.token, address.hosts, "morfax_panel_test")
    config = uvicorn.Config(
        app, log_level="warning", ws="websockets-sansio", timeout_graceful_shutdown=1
    )
    server = uvicorn.Server(config)
    loop = asyncio.new_event_loop()
    serving = threading.Thread(
        target=lambda: loop.run_until_complete(server.serve(sockets=[listening])), daemon=True
    )
    serving.start()
    pipe.send(address.url)
    while True:
        match pipe.recv():
            case ("stream", first, last):
                told = asyncio.run_coroutine_threadsafe(_stream(bench, first, last), loop)
                pipe.send(told.result())
            case ("held",):
                gc.collect()
                pipe.send(tracemalloc.get_traced_memory()[0] / MB)
            case ("kept",):
                pipe.send(len(bench.path))
            case _:
                server.should_exit = True
                serving.join(ENDED_S)
                pipe.send(None)
                return


async def _stream(bench: Bench, first: int, last: int) -> None:
    """Say what a worker says from frame to frame of an hour."""
    for k in range(first, last):
        begin, end = round(k * PLACES), round((k + 1) * PLACES)
        fresh = [[10 + (i % 900) / 12, 10 + (i // 900) / 8] for i in range(begin, end)]
        head = {"x_mm": 20.0, "y_mm": 20.0, "heading_rad": 0.0, "drum_mm": []}
        bench.heard({"say": "head", "fresh": fresh, "head": head, "words": "", "run": 1})
        if k % AT_ONCE == 0:
            await asyncio.sleep(0.002)
