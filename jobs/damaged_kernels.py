"""Damaged kernels: compiled kernels on disk that cannot be loaded are compiled again, once, and it is said.

This is for kernels that numba keeps itself; `motion/machine_code.py` sees damage by a digest.

A file that is cut short, garbage, empty or may not be read ends a run of numba with any kind of exception.
Here such a kernel counts as not compiled: its index is removed, numba compiles it, and keeps it anew. Where
that cannot be kept either, the run goes on without.

numba has no door for this, so two methods of its cache are wrapped as soon as numba loads that module; it is
loaded late, as what needs no kernel does not wait for it. Questions: a flipped bit within the machine code of
a kernel is not found: nothing on disk tells it.
"""

from __future__ import annotations

import importlib.abc
import importlib.util
import sys
from collections.abc import Callable, Sequence
from contextlib import suppress
from importlib.machinery import ModuleSpec
from pathlib import Path
from types import ModuleType
from typing import Any

CACHING = "numba.core.caching"


def compile_damaged_again(note: Callable[[str], None]) -> None:
    """From now on, compile kernels again that are damaged; `note` is told once.

    Until numba is loaded the newest `note` counts: a process may run many commands and never need numba.
    """
    if CACHING not in sys.modules:
        others = (finder for finder in sys.meta_path if not isinstance(finder, _Lookout))
        sys.meta_path[:] = [_Lookout(note), *others]
    else:
        forgive(sys.modules[CACHING], note)


class _Lookout(importlib.abc.MetaPathFinder):
    """Waits for the module of numba's cache, and wraps it when it is loaded."""

    def __init__(self, note: Callable[[str], None]) -> None:
        self._note = note

    def find_spec(
        self, name: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """The usual spec of that module, whose loader wraps it; nothing for any other."""
        if name != CACHING:
            return None
        sys.meta_path.remove(self)
        spec = importlib.util.find_spec(name)
        if spec is None or spec.loader is None:
            return spec
        load = spec.loader.exec_module

        def load_and_wrap(module: ModuleType) -> None:
            load(module)
            forgive(module, self._note)

        setattr(spec.loader, "exec_module", load_and_wrap)  # noqa: B010 -- mypy: no method is assigned
        return spec


def forgive(caching: Any, note: Callable[[str], None]) -> None:
    """Wrap the loading and saving of one kernel in the module of numba's cache."""
    load, save = caching.Cache._load_overload, caching.Cache._save_overload
    told: list[bool] = []

    def tell(cache: Any) -> None:
        if not told:
            told.append(True)
            note(
                f"compiled kernels in {cache.cache_path} are damaged: they are compiled again ..."
            )

    def loaded(cache: Any, *wanted: Any) -> Any:
        try:
            return load(cache, *wanted)
        except Exception:  # whatever garbage makes of an unpickler
            tell(cache)
            with suppress(OSError):
                Path(cache._cache_file._index_path).unlink()
            return None

    def saved(cache: Any, *compiled: Any) -> None:
        try:
            save(cache, *compiled)
        except Exception:  # the index is damaged, or may not be written
            tell(cache)

    caching.Cache._load_overload, caching.Cache._save_overload = loaded, saved
