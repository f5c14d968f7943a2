"""The workshop: the worker process as the server has it, started, spoken to, and started again.

Signals in: jobs and the operator's hold, resume, step, stop. Signals out: the worker's messages, one after
the other, to `heard`; a worker that ended by itself is told as {"say": "ended"}.
"""

from __future__ import annotations

import asyncio
import pickle
import sys
from collections.abc import Callable
from typing import Any

from morfax.motion.faults import BY_SIGNAL, SIGKILL
from morfax.panel import pipe

Heard = Callable[[dict[str, Any]], None]


def why_ended(code: int) -> str:
    """Why a worker ended that nobody stopped, by its exit code."""
    # by the system, itself or behind a shell
    is_killed = code in (-SIGKILL, BY_SIGNAL + SIGKILL)
    return "too little memory, maybe" if is_killed else f"code {code}"


class Workshop:
    """The worker process."""

    def __init__(self, heard: Heard) -> None:
        self._heard = heard
        self._process: asyncio.subprocess.Process | None = None
        self._reading: asyncio.Task[None] | None = None
        self._closing = False

    async def start(self) -> None:
        """Start the worker, if it does not run."""
        if self._process is not None and self._process.returncode is None:
            return
        self._process = await asyncio.create_subprocess_exec(
            *(sys.executable, "-m", "morfax.panel.worker"),
            stdin=asyncio.subprocess.PIPE,
            stdout=asyncio.subprocess.PIPE,
        )
        self._reading = asyncio.create_task(self._listen(self._process))

    async def send(self, *message: Any) -> None:
        """Send a message to the worker, which is started if it is not there."""
        await self.start()
        assert self._process is not None and self._process.stdin is not None
        self._process.stdin.write(pipe.packed(message))
        await self._process.stdin.drain()

    async def kill(self) -> None:
        """End the worker at once, in the middle of whatever it does; the next message starts a new one."""
        if self._process is not None and self._process.returncode is None:
            self._process.kill()
            await self._process.wait()

    async def close(self) -> None:
        """End the worker with the server."""
        self._closing = True
        await self.kill()
        if self._reading is not None:
            await self._reading

    async def _listen(self, process: asyncio.subprocess.Process) -> None:
        """Hear the worker until it ends."""
        assert process.stdout is not None
        try:
            while True:
                head = await process.stdout.readexactly(pipe.LENGTH.size)
                body = await process.stdout.readexactly(*pipe.LENGTH.unpack(head))
                self._heard(pickle.loads(body))
        except asyncio.IncompleteReadError:
            code = await process.wait()
            if not self._closing:
                self._heard({"say": "ended", "code": code})
