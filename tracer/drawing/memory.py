"""Memory for the sheet: how much a drawing takes, and whether this computer has it free.

It is asked before the picture is unpacked.

    pixels · (darkness 4 bytes + the same behind the aperture 4 bytes + the picture itself) + strips

Of a sheet that is read by rows only the tiles with ink are kept, and asked about when they are known:

    pixels of those tiles · (darkness 1 byte + runs of ink, and strips on the way) + strips

Source: our own. Questions: a system that does not say how much memory is free is taken to have enough; the
fault then comes from the system.
"""

from __future__ import annotations

import ctypes
import os
from pathlib import Path

from morfax.motion.faults import DrawingFault

GB = 1e9
# bytes: darkness, cells behind the aperture, ink and paper on the way; measured on a sheet of 900 Mpx
PER_PIXEL = 9.0
# bytes: of a pixel in a tile with ink; measured on 81 Mpx of hatching and of specks: 4.6 and 4.8
PER_INKED_PIXEL = 5.0
FIXED_BYTES = 0.3 * GB  # strips in work, libraries
SMALL_PX = 16e6  # a sheet below this is tried in any case
# glibc's M_MMAP_THRESHOLD: larger pieces of memory are the system's own, each alone
ALONE_FROM = -3
SHEET_BYTES = 8_000_000  # of a sheet that is worth that, 2 Mpx as floats; its pages are made anew each time


def give_back() -> None:
    """Have the C library give memory that is free back to the system, where it can (glibc), and from now on
    what a sheet was in as soon as that is free.

    It keeps what sheets as floats were in on the way, which most of a trace does not need again, and puts
    small things between them, which last.
    """
    library = ctypes.CDLL(None) if os.name == "posix" else None
    if library is not None and hasattr(library, "malloc_trim"):
        library.mallopt(ALONE_FROM, SHEET_BYTES)
        library.malloc_trim(0)


def make_sure(
    file: Path, columns: int, rows: int, coarser: str = "scan it at a lower resolution"
) -> None:
    """Raise DrawingFault if a sheet of so many pixels does not fit into the memory that is free.

    `coarser` says how to have fewer pixels.
    """
    what = f"{file} has {columns} x {rows} pixels ({columns * rows / 1e6:.0f} million)"
    _make_sure(what, columns * rows, PER_PIXEL, coarser)


def make_sure_of_ink(inked_px: int, all_px: int) -> None:
    """Raise DrawingFault if the tiles with ink of a sheet that is read by rows do not fit into the free
    memory.
    """
    share = f"{100 * inked_px / all_px:.0f} % of {all_px / 1e6:.0f} million pixels"
    coarser = "scan it at a lower resolution"
    _make_sure(f"the drawing has ink on or beside {share}", inked_px, PER_INKED_PIXEL, coarser)


def _make_sure(what: str, pixels: int, per_pixel: float, coarser: str) -> None:
    """Raise DrawingFault if so many pixels do not fit, at so many bytes each."""
    free, needed = free_bytes(), per_pixel * pixels + FIXED_BYTES
    if free is None or pixels < SMALL_PX or needed <= free:
        return
    raise DrawingFault(
        f"{what} and needs {needed / GB:.1f} GB of memory, {free / GB:.1f} GB are free; {coarser}, cut out"
        " the part to be traced, or close other programs"
    )


def free_bytes() -> int | None:
    """Memory free without swapping, within a container's limit, bytes; None if the system does not say."""
    known = [free for free in (_of_the_system(), _of_the_container()) if free is not None]
    return min(known, default=None)


def _of_the_system() -> int | None:
    """What Linux calls available; elsewhere all memory, where the system says how much that is."""
    available = _figures(Path("/proc/meminfo")).get("MemAvailable:")
    if available is not None:
        return available * 1024
    try:
        return os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    except (AttributeError, OSError, ValueError):  # no sysconf, or not these
        return None


def _of_the_container(folder: Path = Path("/sys/fs/cgroup")) -> int | None:
    """What the limit of a container (cgroup, version 2) leaves; its cache of files does not count."""
    try:
        limit = int((folder / "memory.max").read_text())
    except (OSError, ValueError):  # none, or "max"
        return None
    return max(0, limit - _figures(folder / "memory.stat").get("anon", 0))


def _figures(file: Path) -> dict[str, int]:
    """Names and whole numbers, one pair to a line; empty if the file does not exist."""
    try:
        words = [line.split() for line in file.read_text().splitlines()]
    except OSError:
        return {}
    return {word[0]: int(word[1]) for word in words if len(word) > 1 and word[1].isdigit()}
