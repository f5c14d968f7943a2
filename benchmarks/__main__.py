"""Run all benchmarks, or those named: `python -m benchmarks [tape …]`; `folder DIR` is the table of a folder
of drawings.
"""

from __future__ import annotations

import importlib
import pkgutil
import sys
from pathlib import Path


def main(names: list[str]) -> None:
    """Call `main()` of every module beside this one that has one, or of those named."""
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
            f"no benchmark {unknown[0]}; there are {', '.join(here)}; without a name all are run but folder, which wants a DIR"
        )
    for name in names or [name for name in here if name != "folder"]:
        run = getattr(importlib.import_module(f"benchmarks.{name}"), "main", None)
        if run is not None:
            run()


if __name__ == "__main__":
    main(sys.argv[1:])
