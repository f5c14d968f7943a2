"""Where the compiled kernels are kept, and who is told when some have to be compiled.

The sample loops of head, recorder and machine are compiled on their first run and kept on disk
(`motion/machine_code.py`): in `__pycache__` beside each module, or, where that folder cannot be written, in
the user's cache folder (`$XDG_CACHE_HOME/morfax`, by default `~/.cache/morfax`), or at worst in the folder
for temporary files.
"""

from __future__ import annotations

import os
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

HOUSE = Path(__file__).parents[1]  # the package morfax
AGAIN_S = 5.0  # between two lines that tell how far compiling is
PACKAGES = ("motion", "tracer", "recorder", "player")


def choose_cache() -> None:
    """Send the kernels to a folder that can be written; call this before the first kernel runs."""
    if "NUMBA_CACHE_DIR" in os.environ or all(
        _writable(HOUSE / package / "__pycache__") for package in PACKAGES
    ):
        return
    user = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "morfax"
    temporary = (
        Path(tempfile.gettempdir())
        / f"morfax-{os.getuid() if hasattr(os, 'getuid') else 'user'}"
    )
    os.environ["NUMBA_CACHE_DIR"] = str(user if _writable(user) else temporary)


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


def _writable(folder: Path) -> bool:
    """Whether files can be made in a folder, which is made if need be."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError:
        return False
    return os.access(folder, os.W_OK)
