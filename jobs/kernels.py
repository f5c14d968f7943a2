"""Where the compiled kernels are kept, and whether they are there already.

The sample loops of head, recorder and machine are compiled by numba on their first run and kept on disk: in
`__pycache__` beside each module, or, where that folder cannot be written, in the user's cache folder
(`$XDG_CACHE_HOME/morfax`, by default `~/.cache/morfax`), or at the worst in the folder for temporary files.
"""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

HOUSE = Path(__file__).parents[1]  # the package morfax
PACKAGES = ("motion", "tracer", "recorder", "player")


def choose_cache() -> None:
    """Send the kernels to a folder that can be written; only takes effect before numba is imported."""
    if "NUMBA_CACHE_DIR" in os.environ or all(
        _writable(folder / "__pycache__") for package in PACKAGES for folder in _rooms(package)
    ):
        return
    user = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "morfax"
    temporary = (
        Path(tempfile.gettempdir())
        / f"morfax-{os.getuid() if hasattr(os, 'getuid') else 'user'}"
    )
    os.environ["NUMBA_CACHE_DIR"] = str(user if _writable(user) else temporary)


def are_cold(packages: tuple[str, ...] = PACKAGES) -> bool:
    """Whether a kernel of these packages was never compiled, or not since its source was changed."""
    return any(_is_cold(package) for package in packages)


def told(packages: tuple[str, ...] = PACKAGES) -> bool:
    """Whether a face has said already that kernels of the present sources will be compiled; marks it as said.

    A kernel that a job never runs stays older than its source: without the mark every run would say it.
    """
    newest_s = max(file.stat().st_mtime for package in packages for file in _sources(package))
    given = os.environ.get("NUMBA_CACHE_DIR")
    notes = [
        (Path(given) if given else HOUSE / package / "__pycache__") / f"{package}.told"
        for package in packages
    ]
    before = all(note.exists() and note.stat().st_mtime >= newest_s for note in notes)
    for note in notes:
        if _writable(note.parent):
            note.touch()
    return before


def _sources(package: str) -> list[Path]:
    """The modules of a package that have kernels; all of them if none has."""
    every = sorted((HOUSE / package).rglob("*.py"))
    return [file for file in every if "@njit(cache=True" in file.read_text("utf-8")] or every


def _is_cold(package: str) -> bool:
    """Whether a package that has kernels has none compiled, or older ones than its sources."""
    sources = [
        file
        for file in (HOUSE / package).rglob("*.py")
        if "@njit(cache=True" in file.read_text("utf-8")
    ]
    compiled = {file: _compiled_s(file) for file in sources}
    newest = max(compiled.values(), default=None)
    if newest is None:
        return False
    # a kernel that is only ever part of others has no file of its own: 0 beside modules that have one
    return newest == 0 or any(
        0 < when < file.stat().st_mtime for file, when in compiled.items()
    )


def _rooms(package: str) -> list[Path]:
    """The folders of a package that hold modules with kernels."""
    return sorted({file.parent for file in _sources(package)})


def _compiled_s(module: Path) -> float:
    """When a module's kernels were last compiled, s since the epoch; 0 if never."""
    given = os.environ.get("NUMBA_CACHE_DIR")
    folders = (
        Path(given).glob(f"{module.parent.name}_*")
        if given
        else [module.parent / "__pycache__"]
    )
    found = [
        file.stat().st_mtime
        for folder in folders
        for file in folder.glob(f"{module.stem}.*.nbi")
    ]
    return max(found, default=0.0)


def _writable(folder: Path) -> bool:
    """Whether files can be made in a folder, which is made if need be."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError:
        return False
    return os.access(folder, os.W_OK)
