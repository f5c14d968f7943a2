"""The head's path as the pages see it: it grows while the head runs, and each page asks for what it has not
seen.

Signals in: the worker's frames of the head. Signals out: the places from a page's own position on, at most
`AT_ONCE` at a time. A page that was away asks from 0 and has all of it.

Questions: an hour at 10 mm/s is 36 m, or 360 000 places of 0.1 mm. Beyond `MOST` places every second one is
left out, also for the pages, which then begin anew: so the memory of a run has a bound.
"""

from __future__ import annotations

from array import array
from typing import Any

from morfax.motion.polyline import UM

FRAME_S = 1 / 30  # between two frames to a page
AT_ONCE = 5_000  # places to a frame: 60 kB of text
MOST = 400_000
PER_MM = round(1 / UM)  # a place is kept in whole um, 4 bytes each way: an hour takes 3 MB
DOWN = -(2**31)  # in place of X: the head was put down anew


class ShownPath:
    """Places of the head, "down" where it was put down anew, and what it does now."""

    def __init__(self) -> None:
        self.life = 0  # another number where pages must begin anew
        self.clear()

    def clear(self) -> None:
        """Begin a run."""
        self.life += 1
        self._x, self._y = array("i"), array("i")
        self.now: dict[str, Any] = {}

    def __len__(self) -> int:
        return len(self._x)

    def add(self, frame: dict[str, Any]) -> None:
        """Take in a frame of the worker."""
        for place in frame["fresh"]:
            x, y = (DOWN, 0) if place == "down" else (round(PER_MM * v) for v in place)
            self._x.append(x)
            self._y.append(y)
        self.now = {"head": frame["head"], "words": frame["words"], "run": frame["run"]}
        if len(self) > MOST:
            kept = [i for i, x in enumerate(self._x) if i % 2 == 0 or x == DOWN]
            self._x = array("i", (self._x[i] for i in kept))
            self._y = array("i", (self._y[i] for i in kept))
            self.life += 1

    def since(self, life: int, at: int) -> dict[str, Any]:
        """What a page has not seen yet."""
        at = at if life == self.life else 0
        some = slice(at, at + AT_ONCE)
        fresh = [
            "down" if x == DOWN else [x / PER_MM, y / PER_MM]
            for x, y in zip(self._x[some], self._y[some], strict=True)
        ]
        return {
            "life": self.life,
            "from": at,
            "fresh": fresh,
            "more": at + len(fresh) < len(self),
            **self.now,
        }
