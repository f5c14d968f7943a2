"""Run all benchmarks, or those named: `python -m benchmarks [tape …]`; `folder DIR` measures drawings."""

from __future__ import annotations

import importlib
import pkgutil
import sys
from pathlib import Path


def main(names: list[str]) -> None:
    """Call `main()` of every benchmark in this folder, or of those named."""
    if names[:1] == ["folder"]:
        importlib.import_module("benchmarks.folder").main(names[1:])
        return
    here = [
        module.name
        for module in pkgutil.iter_modules([str(Path(__file__).parent)])
        if module.name[0] != "_"
    ]
    if unknown := [name for name in names if name not in here]:
        sys.exit(
            f"{unknown[0]} is no benchmark; give {', '.join(here)}, or no name for all but `folder DIR`"
        )
    for name in names or [name for name in here if name != "folder"]:
        run = getattr(importlib.import_module(f"benchmarks.{name}"), "main", None)
        if run is not None:
            run()


if __name__ == "__main__":
    main(sys.argv[1:])
