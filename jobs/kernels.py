"""Where the compiled kernels are kept, and who is told when some have to be compiled.

The sample loops of head, recorder and machine are compiled on their first run and kept in the user's folder
of kernels (`motion/machine_code.py`, `motion/kernel_folder.py`). Where numba runs them with a cache of its
own, that is `__pycache__` beside each module, or the same folder of the user's where it cannot be written.
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from pathlib import Path

from morfax.motion.kernel_folder import kernel_folder, writable

HOUSE = Path(__file__).parents[1]  # the package morfax
AGAIN_S = 5.0  # between two lines that tell how far compiling is
PACKAGES = ("motion", "tracer", "recorder", "player")


def choose_cache() -> None:
    """Send numba's own cache to a folder that can be written; call this before the first kernel runs."""
    if "NUMBA_CACHE_DIR" in os.environ or all(
        writable(HOUSE / package / "__pycache__") for package in PACKAGES
    ):
        return
    folder = kernel_folder()
    if folder is not None:
        os.environ["NUMBA_CACHE_DIR"] = str(folder)


def announce(what: str, note: Callable[[str], None]) -> None:
    """Have a line noted when the first kernel has to be compiled, and how far that is every few seconds."""
    from morfax.motion import compiled

    next_s, before = 0.0, None  # kernels compiled before anybody listened are not counted

    def hear(count: int) -> None:
        nonlocal next_s, before
        before = count if before is None else before
        if time.monotonic() < next_s:
            return
        how_far = f"{count - before} so far" if count > before else "first run only"
        note(f"compiling {what} ({how_far}) ...")
        next_s = time.monotonic() + AGAIN_S

    compiled.hear(hear)
