"""The head's path as the pages see it: it grows while the head runs, and each page asks for what it has not
seen.

Signals in: the worker's frames of the head. Signals out: the places from a page's own position on, at most
`AT_ONCE` at a time. A page that was away asks from 0 and has all of it.

Questions: an hour at 10 mm/s is 36 m, or 360 000 places of 0.1 mm. Beyond `MOST` places every second one is
left out, also for the pages, which then begin anew: so the memory of a run has a bound.
"""

from __future__ import annotations

from typing import Any

AT_ONCE = 5_000  # places to a frame: 60 kB of text
MOST = 400_000


class HeadPath:
    """Places of the head, "down" where it was put down anew, and what it does now."""

    def __init__(self) -> None:
        self.life = 0  # another number where pages must begin anew
        self.clear()

    def clear(self) -> None:
        """Begin a run."""
        self.life += 1
        self.places = list[Any]()
        self.now: dict[str, Any] = {}

    def add(self, frame: dict[str, Any]) -> None:
        """Take in a frame of the worker."""
        self.places += frame["fresh"]
        self.now = {"head": frame["head"], "words": frame["words"], "run": frame["run"]}
        if len(self.places) > MOST:
            self.places = [p for i, p in enumerate(self.places) if i % 2 == 0 or p == "down"]
            self.life += 1

    def since(self, life: int, at: int) -> dict[str, Any]:
        """What a page has not seen yet."""
        at = at if life == self.life else 0
        fresh = self.places[at : at + AT_ONCE]
        return {
            "life": self.life,
            "from": at,
            "fresh": fresh,
            "more": at + len(fresh) < len(self.places),
            **self.now,
        }
