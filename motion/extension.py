"""A single extension module of a library, loaded without the library's packages, which load much more.

Source: our own; a module written in C knows nothing of the package that it lies in.
"""

from __future__ import annotations

import importlib.machinery
import importlib.util
import sys
from pathlib import Path
from types import ModuleType


def extension(package: str, name: str) -> ModuleType:
    """An extension module by its name within a package, loaded once; ImportError if it is not there."""
    full = f"{package}.{name}"
    if full not in sys.modules:
        *within, stem = name.split(".")
        folder = folder_of(package).joinpath(*within)
        files = (
            folder / f"{stem}{ending}" for ending in importlib.machinery.EXTENSION_SUFFIXES
        )
        file = next((file for file in files if file.exists()), None)
        spec = None if file is None else importlib.util.spec_from_file_location(full, file)
        if spec is None or spec.loader is None:
            raise ImportError(full)
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        sys.modules[full] = module
    return sys.modules[full]


def folder_of(package: str) -> Path:
    """Where a package is installed; raises ImportError if it is not."""
    spec = importlib.machinery.PathFinder.find_spec(package)
    if spec is None or spec.origin is None:
        raise ImportError(package)
    return Path(spec.origin).parent
