"""Run all benchmarks, or those named: `python -m benchmarks [tape …]`.

`folder DIR` measures drawings, `flatten [N]` simulated photographs, `linuxcnc` the times of programs,
`dropouts [N]` dropouts of each kind, `batch [N]` many drawings, `panel [DIR]` how its page pans,
`pencil [N]` lines with grain, `coarse [N]` lines of few pixels, `rough [N]` rough pens, shadows
and folds, `nets [N]` all the ink of nets, `choice [N]` the same sheet in other scans,
`large [MPX METRES]` large sheets, `holes [N …]` plates of many holes, `first [--write]` the first
run on a machine; these take a while and run only if named.
"""

from __future__ import annotations

import importlib
import pkgutil
import sys
from pathlib import Path

WITH_WORDS = (
    "folder",
    "flatten",
    "linuxcnc",
    "dropouts",
    "batch",
    "panel",
    "pencil",
    "coarse",
    "rough",
    "nets",
    "choice",
    "large",
    "holes",
    "first",
)  # that take words of their own


def main(names: list[str]) -> None:
    """Call `main()` of every benchmark in this folder, or of those named; with --help say what they do."""
    if "--help" in names:
        asked = [f"benchmarks.{name}" for name in names if name in WITH_WORDS]
        print(importlib.import_module(asked[0]).__doc__ if asked else __doc__)
        return
    if names and names[0] in WITH_WORDS:
        importlib.import_module(f"benchmarks.{names[0]}").main(names[1:])
        return
    here = [
        module.name
        for module in pkgutil.iter_modules([str(Path(__file__).parent)])
        if module.name[0] != "_"
    ]
    if unknown := [name for name in names if name not in here]:
        sys.exit(
            f"{unknown[0]} is no benchmark; give {', '.join(here)},"
            f" or no name for all but {' and '.join(WITH_WORDS)}"
        )
    for name in names or [name for name in here if name not in WITH_WORDS]:
        run = getattr(importlib.import_module(f"benchmarks.{name}"), "main", None)
        if run is not None:
            run()


if __name__ == "__main__":
    main(sys.argv[1:])
