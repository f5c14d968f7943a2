"""Where the machine code of kernels is kept: one folder for each user, whatever morfax is installed in.

So an upgrade, a second environment or a checkout beside it compiles only what has changed, and an
installation that the user may not write to keeps its kernels all the same.

A wheel brings kernels along (`wheel_kernels`); what it lacks, or what its machine cannot run, goes into the
user's folder.

Signals in: `NUMBA_CACHE_DIR`, if it is set; else `$XDG_CACHE_HOME/morfax` (`~/.cache/morfax`); where that
cannot be written, a folder of the user's own among the temporary files. Signals out: the folder, made.

Questions: a folder among the temporary files that belongs to somebody else is not taken, since what is in
it would be run.
"""

from __future__ import annotations

import os
import tempfile
from pathlib import Path


def wheel_folder() -> Path:
    """The folder of the kernels that the wheel brought along; a checkout has none until `make wheel`."""
    return Path(__file__).with_name("kernels")


def kernel_folder() -> Path | None:
    """The folder of this user's kernels; None where none can be made."""
    if given := os.environ.get("NUMBA_CACHE_DIR"):
        return Path(given) if writable(Path(given)) else None
    for place in _of_user():
        if writable(place):
            return place
    temporary = _temporary()
    return temporary if writable(temporary) and _is_ours(temporary) else None


def writable(folder: Path) -> bool:
    """Whether files can be made in a folder, which is made if need be."""
    try:
        folder.mkdir(parents=True, exist_ok=True, mode=0o700)
    except OSError:
        return False
    return os.access(folder, os.W_OK)


def _of_user() -> list[Path]:
    """The user's own cache folder; none for a user without a home."""
    try:
        return [Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "morfax"]
    except RuntimeError:
        return []


def _temporary() -> Path:
    """A folder of this user among the temporary files."""
    user = os.getuid() if hasattr(os, "getuid") else "user"
    return Path(tempfile.gettempdir()) / f"morfax-{user}"


def _is_ours(folder: Path) -> bool:
    """Whether nobody else can put machine code into a folder: this user owns it, and alone may write."""
    if not hasattr(os, "getuid"):
        return True
    status = folder.stat()
    return status.st_uid == os.getuid() and not status.st_mode & 0o022
