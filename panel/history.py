"""The history: each step of the operator, kept on disk, undone and done again without end.

Signals: steps in (a drawing and its options); out the step that holds now. After each step the whole
history is in `state.json` of the panel's folder, written beside and renamed, so that a killed server leaves
the old file or the new one.

Questions: the number of steps is not limited; a step is some hundred bytes.
"""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass, field
from pathlib import Path as FilePath
from typing import Any

from morfax.motion.faults import FileFault
from morfax.motion.files import written_beside

VERSION = 1  # of the file


@dataclass(frozen=True, slots=True)
class HistoryStep:
    """What is set: the key of the drawing on the bench, the options as text, and its corrections."""

    drawing: str | None = None
    options: dict[str, str | bool] = field(default_factory=dict)
    corrections: str = ""  # the text of the file beside the drawing; empty: there is none


class History:
    """The steps so far, the one that holds, and a number that grows with each change."""

    def __init__(self, file: FilePath) -> None:
        self.file, self.steps, self.at, self.revision = file, [HistoryStep()], 0, 0
        self.running = False  # a run was under way when the file was written
        if file.exists():
            self._read()

    @property
    def now(self) -> HistoryStep:
        """The step that holds."""
        return self.steps[self.at]

    @property
    def can_undo(self) -> bool:
        """Whether there is a step before this one."""
        return self.at > 0

    @property
    def can_redo(self) -> bool:
        """Whether a step was undone."""
        return self.at + 1 < len(self.steps)

    def add(self, step: HistoryStep) -> None:
        """Take a step; what was undone before it is gone."""
        if step == self.now:
            return
        self.steps = [*self.steps[: self.at + 1], step]
        self._go(self.at + 1)

    def undo(self) -> None:
        """Take the last step back, if there is one."""
        if self.can_undo:
            self._go(self.at - 1)

    def redo(self) -> None:
        """Take a step again that was undone."""
        if self.can_redo:
            self._go(self.at + 1)

    def mark_running(self, running: bool) -> None:
        """Keep whether a run is under way: a server that is started again goes on with it."""
        if running != self.running:
            self.running = running
            self.write()

    def write(self) -> None:
        """Put the whole history on disk; raises FileFault if that cannot be."""
        kept: dict[str, Any] = {
            "version": VERSION,
            "revision": self.revision,
            "at": self.at,
            "running": self.running,
            "steps": [asdict(step) for step in self.steps],
        }
        with written_beside(self.file) as beside:
            beside.write_text(json.dumps(kept, indent=1) + "\n", encoding="utf-8")

    def _go(self, at: int) -> None:
        """Let another step hold."""
        self.at, self.revision = at, self.revision + 1
        self.write()

    def _read(self) -> None:
        """Take up a history from disk; raises FileFault for a file that holds none."""
        try:
            kept = json.loads(self.file.read_text(encoding="utf-8"))
            steps = [
                HistoryStep(row["drawing"], dict(row["options"]), str(row["corrections"]))
                for row in kept["steps"]
            ]
            at, revision, running = (
                int(kept["at"]),
                int(kept["revision"]),
                bool(kept["running"]),
            )
            if kept["version"] != VERSION or not 0 <= at < len(steps):
                raise ValueError("of another version")
        except (OSError, ValueError, KeyError, TypeError) as error:
            raise FileFault(
                f"{self.file} is no state of the panel ({error}); move it away, or give another "
                "folder with --folder"
            ) from None
        self.steps, self.at, self.revision, self.running = steps, at, revision, running
