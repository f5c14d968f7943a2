"""A job done in full: sent to another process and back, with a listener that takes down what it hears."""

from __future__ import annotations

import pickle
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any

from morfax.jobs.settings.drawing_file import DrawingFile
from tests.console.conftest import SAMPLES

UM = 1e-3
CURVE = DrawingFile(SAMPLES / "curve.png")
PROGRAM = DrawingFile(SAMPLES / "program.png")
BRACKET = DrawingFile(SAMPLES / "bracket.png")


@dataclass
class Recording:
    """A listener that takes down all that it hears."""

    said: list[tuple[str, str]] = field(default_factory=list)
    done: dict[str, list[float]] = field(default_factory=dict)

    @contextmanager
    def progress(self, what: str, total: float) -> Iterator[Callable[[float], None]]:
        self.done[what] = []
        yield lambda done: self.done[what].append(done / (total or 1))

    def note(self, text: str) -> None:
        self.said.append(("note", text))

    def detail(self, text: str) -> None:
        self.said.append(("detail", text))

    def warning(self, text: str) -> None:
        self.said.append(("warning", text))

    def compiling(self, what: str, packages: tuple[str, ...]) -> None:
        self.said.append(("compiling", what))


def worked(job: Any, panel: Any = None) -> tuple[Any, Recording]:
    """The result of a job that has been to another process and back, and what it told."""
    sent = pickle.loads(pickle.dumps(job))
    assert sent == job and hash(sent) == hash(job)
    listener = Recording()
    result = sent.run(listener, panel)
    pickle.dumps(result)  # and the result comes back
    shares = [share for done in listener.done.values() for share in done]
    assert all(0 <= share < 1.01 for share in shares)  # the last block may have a sample more
    return result, listener
