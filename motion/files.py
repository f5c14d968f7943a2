"""Files that appear under their name only when they are whole.

A file is written beside its final name, in the same folder and so on the same disk, and renamed when it is
complete. A broken run, a full disk or Ctrl-C leaves what stood there before, and no half file.

    .morfax-MACHINE-PROCESS-RANDOM.wav      a hidden file; that of a run that was killed stays, and is removed
                                            by the next run into the folder, when its process is gone

A folder of results is written in the same way: in a hidden folder of its own, which is renamed.
"""

from __future__ import annotations

import errno
import os
import platform
import shutil
import stat
import zlib
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import cache
from pathlib import Path

from morfax.motion.faults import FileFault

HEAD_BYTES = (
    1024  # of a file, in which its kind shows: the mark of a PDF, a zero of a binary file
)
_HIDDEN = ".morfax-"
_DISK_FULL = {
    errno.ENOSPC: "the disk is full",
    errno.EDQUOT: "the quota is used up",
    errno.EFBIG: "files may not be so large here",
}


_KINDS = {
    stat.S_IFIFO: "a pipe",
    stat.S_IFCHR: "a device",
    stat.S_IFBLK: "a device",
    stat.S_IFSOCK: "a socket",
}


def check_name(file: str | os.PathLike[str]) -> None:
    """Raise FileFault for a name that no system has."""
    if "\0" in str(file):
        name = printable(str(file)).replace("\0", "\\0")
        raise FileFault(f"{name} is no name of a file: it holds a byte of 0; give another")


def check_regular(file: str | os.PathLike[str]) -> None:
    """Raise FileFault for what cannot be opened and read again, such as a pipe; a folder is the caller's."""
    check_name(file)
    try:
        kind = stat.S_IFMT(Path(file).stat().st_mode)
    except OSError:
        return  # whoever opens it says why it cannot be read
    if kind in _KINDS:
        raise FileFault(f"cannot read {file}: it is {_KINDS[kind]}; write it to a file first")


def for_soundfile(file: str | os.PathLike[str]) -> str | bytes:
    """The name of a file as libsndfile takes it: its own bytes, which need be no UTF-8."""
    return os.fsencode(file) if os.name == "posix" else os.fspath(file)


def printable(text: str) -> str:
    """A text with the bytes of a name that are no UTF-8 written out: \\udcff."""
    return text.encode("utf-8", "backslashreplace").decode("utf-8")


@contextmanager
def written_beside(
    file: str | os.PathLike[str], named: Callable[[], Path] | None = None
) -> Iterator[Path]:
    """Give a new, hidden file of the same suffix beside `file`; rename it on success, remove it on failure.

    `named` gives another name for the whole file, in the same folder.

    Raises FileFault if the folder is missing or not writable, if `file` is no regular file, or if the disk is
    full.
    """
    final = Path(file)
    check_name(final)
    beside = _create_beside(final)
    try:
        yield beside
        _flush_to_disk(beside)
        final = named() if named is not None else final
        beside.replace(final.resolve())  # through a symbolic link, as writing in place would go
    except BaseException as error:
        beside.unlink(missing_ok=True)
        if isinstance(error, OSError) and error.errno in _DISK_FULL:
            raise disk_full_fault(final, error.errno) from error
        raise


@contextmanager
def folder_written_beside(folder: Path, aside: Path) -> Iterator[Path]:
    """Give a new folder in the folder `aside`, of the same disk; on success it becomes `folder`, in the place
    of what stood there, on failure it is removed.
    """
    name = f"{_HIDDEN}{_here()}-{os.getpid()}-{os.urandom(6).hex()}"
    beside, before = aside / name, aside / f"{name}-before"
    try:
        beside.mkdir(parents=True)
    except OSError as error:
        raise _folder_fault(folder, aside, error) from error
    try:
        yield beside
        if folder.exists():
            folder.replace(before)
        beside.replace(folder)
    except OSError as error:
        if error.errno in _DISK_FULL:
            raise disk_full_fault(folder, error.errno) from error
        raise
    finally:
        for left in (beside, before):
            shutil.rmtree(left, ignore_errors=True)


def disk_full_fault(file: str | os.PathLike[str], code: int = errno.ENOSPC) -> FileFault:
    """The fault of a file that the disk would not take whole."""
    reason = _DISK_FULL.get(code, os.strerror(code))
    return FileFault(
        f"cannot write {file}: {reason}; no half file is left; make room or write elsewhere"
    )


def _create_beside(final: Path) -> Path:
    """Create the hidden file, empty, with the rights that a new file has here."""
    if final.exists() and not final.is_file():
        what = "is a folder" if final.is_dir() else "is not a regular file"
        raise FileFault(f"cannot write {final}: it {what}; give the name of a file")
    folder = final.resolve().parent
    clear_leftovers(folder)
    name = f"{_HIDDEN}{_here()}-{os.getpid()}-{os.urandom(6).hex()}{final.suffix}"
    beside = folder / name
    try:
        os.close(os.open(beside, os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o666))
    except OSError as error:
        raise _folder_fault(final, folder, error) from error
    return beside


def clear_leftovers(folder: Path) -> None:
    """Remove what runs on this machine that were killed left hidden; that of others is left alone."""
    if os.name != "posix":
        return  # there a signal of 0 would end the process
    for left in folder.glob(f"{_HIDDEN}{_here()}-*"):
        number = left.name.removeprefix(f"{_HIDDEN}{_here()}-").split("-")[0]
        if not number.isdecimal() or _is_alive(int(number)):
            continue
        if left.is_dir():
            shutil.rmtree(left, ignore_errors=True)
        with suppress(OSError):
            left.unlink()


def _is_alive(process: int) -> bool:
    """Whether there is a process of this number."""
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except (OSError, OverflowError):
        return True  # somebody else's, or not to be told
    return True


@cache
def _here() -> str:
    """What the processes that this one can see have in common: machine, its start, and their numbering."""
    parts = [platform.node()]
    with suppress(OSError):
        parts.append(Path("/proc/sys/kernel/random/boot_id").read_text("ascii"))
    with suppress(OSError):
        parts.append(str(Path("/proc/self/ns/pid").readlink()))
    return f"{zlib.crc32(' '.join(parts).encode('utf-8', 'replace')):08x}"


def _folder_fault(final: Path, folder: Path, error: OSError) -> FileFault:
    """The fault of a folder in which no file can be made."""
    if error.errno in _DISK_FULL:
        return disk_full_fault(final, error.errno)
    if not folder.exists():
        return FileFault(
            f"cannot write {final}: the folder {folder} does not exist; make it first or write elsewhere"
        )
    if not folder.is_dir():
        return FileFault(f"cannot write {final}: {folder} is not a folder; write elsewhere")
    return FileFault(
        f"cannot write {final}: the folder {folder} takes no new file ({error.strerror}); write elsewhere"
    )


def _flush_to_disk(file: Path) -> None:
    """Have the system put the file's contents on the disk before its name does."""
    descriptor = os.open(file, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
