"""Run the mutants of a room, or so many of them by chance, and list those that no test has found."""

from __future__ import annotations

import argparse
import random
import sys
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from tests.mutants.changes import Mutant, mutants_of
from tests.mutants.tree import ROOT, Copy


def tests_of(room: str) -> list[str]:
    """The files of tests of a room, and those of the sources that import it."""
    name = "morfax." + room.replace("/", ".")
    sources = (ROOT / "tests" / "sources").glob("test_*.py")
    own = sorted((ROOT / "tests" / room).rglob("test_*.py"))
    asking = [s for s in sources if name in s.read_text("utf-8")]
    return [str(file.relative_to(ROOT)) for file in (*own, *asking)]


class Chosen(NamedTuple):
    """Mutants of a room, out of how many, and the files as they are now; they may change meanwhile."""

    mutants: Sequence[Mutant]
    of: int
    sources: Mapping[Path, str]

    def told(self, mutant: Mutant) -> str:
        """One of them as the list has it."""
        return mutant.told(self.sources[mutant.file])


def chosen_of(place: Path, sample: int, seed: int) -> Chosen:
    """Mutants of a room or a file, so many by chance (0: all)."""
    inside = [ROOT / place] if place.suffix else sorted((ROOT / place).glob("*.py"))
    sources = {file.relative_to(ROOT): file.read_text("utf-8") for file in inside}
    every = [mutant for file, source in sources.items() for mutant in mutants_of(file, source)]
    count = min(sample or len(every), len(every))
    return Chosen(random.Random(seed).sample(every, count), len(every), sources)


def main() -> None:
    """Run mutants in turn; each survivor is printed, with how many tests came by it."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("room", help="a folder, such as player/gcode, or one file of it")
    parser.add_argument(
        "--sample", type=int, default=0, help="so many by chance; 0: all of them"
    )
    parser.add_argument("--seed", type=int, default=1, help="of the choice")
    parser.add_argument("--tests", nargs="*", help="instead of the room's own and the sources'")
    asked = parser.parse_args()
    place = Path(asked.room)
    chosen = chosen_of(place, asked.sample, asked.seed)
    files = asked.tests or tests_of(str(place.parent if place.suffix else place))
    with tempfile.TemporaryDirectory() as folder:
        copy = Copy(Path(folder))
        tests = copy.watched(files)
        if tests is None:
            sys.exit(f"the tests fail without a mutant; mend them first:\n\n{copy.said}")
        count = len(chosen.mutants)
        print(f"{count} of {chosen.of} mutants; {len(tests)} tests", flush=True)
        left = 0
        for mutant in chosen.mutants:
            if not copy.finds(mutant, tests):
                left += 1
                many = len(copy.tests_for(mutant, tests))
                print(f"{chosen.told(mutant)}   ({many} tests)", flush=True)
    print(f"found {count - left} of {count}, {1 - left / max(1, count):.0%}")


if __name__ == "__main__":
    main()
