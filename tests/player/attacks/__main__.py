"""The table of attacks at length: `python -m tests.player.attacks SEEDS [FIRST] [JOBS]`.

One tape of every kind for each seed, from FIRST on, on so many processes (1). A verdict that the table does
not allow is told at once; the table of all kinds comes at the end, and after every tenth seed.
"""

from __future__ import annotations

import sys
import tempfile
import time
from collections.abc import Iterable, Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, field
from functools import cache

from tests.player.attacks.bench import Bench, Verdict, benches
from tests.player.attacks.kinds import KINDS

TABLE_EVERY = 10  # seeds


@dataclass
class Tally:
    """What came of the tapes of one kind; `refused`: seeds whose verdict the table does not allow."""

    tapes: int = 0
    faults: int = 0
    most_cycles: float = 0.0
    wrong: int = 0
    refused: list[int] = field(default_factory=list)

    def take(self, seed: int, verdict: Verdict, must: str) -> None:
        """Count one tape."""
        self.tapes, self.faults = self.tapes + 1, self.faults + (verdict.fault is not None)
        self.most_cycles = max(self.most_cycles, verdict.error_cycles)
        self.wrong += verdict.silently_wrong
        if not verdict.keeps(must):
            self.refused.append(seed)


@cache
def own_benches() -> tuple[Bench, Bench]:
    """The two tapes of this process."""
    with tempfile.TemporaryDirectory() as folder:
        return benches(folder)


def verdicts(seed: int) -> tuple[int, list[Verdict]]:
    """The verdict of each kind for a seed."""
    return seed, [own_benches()[seed % 2].tried(kind, seed) for kind in KINDS]


def tried(seeds: Iterable[int], jobs: int) -> Iterator[tuple[int, list[Verdict]]]:
    """The verdicts of all seeds, on so many processes."""
    if jobs == 1:
        yield from map(verdicts, seeds)
        return
    with ProcessPoolExecutor(jobs) as pool:
        yield from pool.map(verdicts, seeds)


def table(tallies: dict[str, Tally]) -> str:
    """A line to a kind, and the sum."""
    lines = [
        f"{name}: {one.tapes} tapes, {one.faults} faults, at most {one.most_cycles:.4f} cycle off,"
        f" {one.wrong} silently wrong, {len(one.refused)} not as asked"
        for name, one in tallies.items()
    ]
    tapes, wrong = (
        sum(getattr(one, part) for one in tallies.values()) for part in ("tapes", "wrong")
    )
    refused = sum(len(one.refused) for one in tallies.values())
    return "\n".join([*lines, f"{tapes} tapes, {wrong} silently wrong, {refused} not as asked"])


def main(words: list[str]) -> int:
    """Try all kinds; 1 if the table does not allow a verdict."""
    count, first, jobs = (int(word) for word in [*words, *("1170", "0", "1")[len(words) :]])
    tallies = {kind.name: Tally() for kind in KINDS}
    began = time.monotonic()
    for done, (seed, found) in enumerate(tried(range(first, first + count), jobs), 1):
        for kind, verdict in zip(KINDS, found, strict=True):
            tallies[kind.name].take(seed, verdict, kind.must)
            if not verdict.keeps(kind.must):
                print(
                    f"{kind.name}, seed {seed}: {verdict.error_cycles:.4f} cycle, {verdict.fault}",
                    flush=True,
                )
        if done % TABLE_EVERY == 0 or done == count:
            print(f"{table(tallies)}, {time.monotonic() - began:.0f} s", flush=True)
    return int(any(one.refused for one in tallies.values()))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
