"""Uploads: a file from the page goes to the panel's folder, piece by piece, and never further than 256 MB.

Signals in: a name and a stream of bytes. Signals out: a file in the folder `drawings`, under a name made of
the harmless characters of the given one; it is there only when it is whole, and only if its picture fits
into the memory.
"""

from __future__ import annotations

import re
from collections.abc import AsyncIterator
from pathlib import Path as FilePath

from morfax.motion.faults import DrawingFault, Fault
from morfax.motion.files import written_beside

MOST_BYTES = 256_000_000
LONGEST_NAME = 60  # characters before the suffix
SUFFIXES = (
    *(".png", ".jpg", ".jpeg", ".tif", ".tiff", ".bmp", ".gif", ".webp", ".pgm"),
    *(".pdf", ".heic", ".heif", ".avif"),
)
TOO_LARGE = (
    f"the file is larger than {MOST_BYTES // 1_000_000} MB; scan it at a lower resolution, or save it as"
    " PNG"
)


def harmless(name: str) -> str:
    """A name for a file made of a name that anybody sent: no path, no markup, no hidden file."""
    last = re.split(r"[/\\]", name)[-1]
    stem, dot, suffix = last.rpartition(".")
    suffix = f".{suffix.lower()}" if dot else ""
    if suffix not in SUFFIXES:
        raise DrawingFault(
            f"{harmless_text(last)!r} is no picture by its name; give a PNG, JPEG, TIFF, HEIC or PDF"
        )
    stem = re.sub(r"[^A-Za-z0-9._-]+", "-", stem).strip(".-")[:LONGEST_NAME]
    return f"{stem or 'drawing'}{suffix}"


def harmless_text(text: str) -> str:
    """A text that is shown in a message: printable, and not endless."""
    return "".join(c if c.isprintable() else "?" for c in text)[:LONGEST_NAME]


async def take(
    folder: FilePath, name: str, stream: AsyncIterator[bytes], length: int | None
) -> FilePath:
    """Take in a file; raises DrawingFault for one that is too large, or that is no picture."""
    file = unused(folder / harmless(name))
    if length is not None and length > MOST_BYTES:
        raise DrawingFault(TOO_LARGE)
    folder.mkdir(parents=True, exist_ok=True)
    with written_beside(file) as beside:
        come = 0
        with beside.open("wb") as out:
            async for piece in stream:
                come += len(piece)
                if come > MOST_BYTES:
                    raise DrawingFault(TOO_LARGE)
                out.write(piece)
        check_picture(beside)
    return file


def taken_in(folder: FilePath) -> dict[str, FilePath]:
    """The drawings that pages have sent to a panel's folder, by name."""
    return {
        file.name: file
        for file in sorted((folder / "drawings").glob("[!.]*"))
        if file.is_file()
    }


def unused(file: FilePath) -> FilePath:
    """A name that no file has: with -2, -3 … if need be."""
    number, free = 1, file
    while free.exists():
        number += 1
        free = file.with_stem(f"{file.stem}-{number}")
    return free


def check_picture(file: FilePath) -> None:
    """Raise DrawingFault if a file is no picture, or does not fit into the memory; nothing is unpacked."""
    from PIL import Image, UnidentifiedImageError

    from morfax.tracer.drawing import memory

    if file.suffix in (".pdf", ".heic", ".heif"):
        return  # their own readers ask for memory before they unpack
    limit, Image.MAX_IMAGE_PIXELS = Image.MAX_IMAGE_PIXELS, None
    try:
        with Image.open(file) as picture:
            memory.make_sure(FilePath("the picture"), *picture.size)
    except Fault:
        raise
    except (UnidentifiedImageError, OSError, SyntaxError, ValueError):
        raise DrawingFault(
            "the file is no picture that can be read; give a PNG, JPEG, TIFF, HEIC or PDF"
        ) from None
    finally:
        Image.MAX_IMAGE_PIXELS = limit
