"""Reading ahead: a tape is read in threads of their own while the drives follow what was read before.

    tape ─► check signal ─► two blocks wait ─► phases, vouching ─► two blocks wait ─► drives, monitor
            a thread of its own                a thread of its own                    the thread that plays

Signals in: what makes blocks, one after the other. Signals out: the same blocks, in the same order, and
behind the last one the fault that it ended with. A bare tape has no check signal, and one thread less.

The reader may ask where the machine stands. It is told when the machine has used all that was read before, as
if both took turns; so no fault says another place than it would without the thread. Kernels leave Python's
lock to the other threads. Phases and drives take about as long, the check signal about half of that.

Source: our own. Questions: a tape that comes through a pipe or from a device is not read ahead: a thread that
waits for its next frames could not be stopped.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Generator, Iterator
from queue import SimpleQueue
from typing import Generic, TypeVar

Block = TypeVar("Block")
# of a megabyte each: one is made while another waits, as no block takes just as long as the next
BLOCKS_AHEAD = 2
NAME = "reading ahead"  # of the thread
# for the tape to be closed when nobody asks any more; a block takes some ms
LONGEST_END_S = 1.0


class _GivenUp(Exception):
    """Nobody asks for blocks any more."""


class _Ended:
    """Behind the last block: how it ended."""

    def __init__(self, fault: BaseException | None) -> None:
        self.fault = fault


class ReadAhead(Generic[Block]):
    """Makes blocks ahead of who asks for them, once."""

    def __init__(self) -> None:
        self._changed = threading.Condition()
        self._asked = 0  # blocks that were asked for: all before the last of them are used
        self._made = 0
        self._is_given_up = False
        self._waiting: SimpleQueue[Block | _Ended] = SimpleQueue()

    def blocks(self, make: Callable[[], Iterator[Block]]) -> Generator[Block, None, None]:
        """The blocks that `make` gives; raises what it raises."""
        thread = threading.Thread(target=self._run, args=(make,), name=NAME, daemon=True)
        thread.start()
        try:
            while True:
                with self._changed:
                    self._asked += 1
                    self._changed.notify()
                block = self._waiting.get()
                if not isinstance(block, _Ended):
                    yield block
                elif block.fault is None:
                    return
                else:
                    raise block.fault
        finally:
            with self._changed:
                self._is_given_up = True
                self._changed.notify()
            # blocks that are dropped half way may be freed within any thread, also within this one
            if thread is not threading.current_thread():
                thread.join(LONGEST_END_S)

    def wait_for_use(self) -> None:
        """Wait until all blocks that were made before the one in hand are used; for who makes it."""
        self._wait_for(self._made + 1)

    def _run(self, make: Callable[[], Iterator[Block]]) -> None:
        """Make the blocks, each as soon as it may be."""
        fault: BaseException | None = None
        blocks = make()
        try:
            for block in blocks:
                self._waiting.put(block)
                self._made += 1
                self._wait_for(self._made + 1 - BLOCKS_AHEAD)
        except BaseException as error:
            fault = error
        finally:
            del blocks  # closes the tape, in the thread that opened it
        self._waiting.put(_Ended(fault))

    def _wait_for(self, asked: int) -> None:
        """Wait until so many blocks were asked for; raises _GivenUp where no more will be."""
        with self._changed:
            self._changed.wait_for(lambda: self._is_given_up or self._asked >= asked)
            if self._is_given_up:
                raise _GivenUp
