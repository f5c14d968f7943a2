"""The last result on disk: it comes back after a new start, with the words that made it; and the files of the
folder.

Signals in: the result of a run as plain values, and its words. Signals out: `result.json` in the panel's
folder.
"""

from __future__ import annotations

import json
from pathlib import Path as FilePath
from typing import Any

from morfax.motion.files import written_beside

STATE, RESULT = "state.json", "result.json"  # files of the folder that are no results


class KeptResult:
    """The last result of a folder, and the words that made it; None before the first."""

    def __init__(self, folder: FilePath) -> None:
        self.folder, self.result, self.words = folder, None, None
        self._read()

    result: dict[str, Any] | None
    words: list[str] | None

    def begin(self, words: list[str]) -> None:
        """A run begins: there is no result until it is done."""
        self.result, self.words = None, words

    def keep(self, result: dict[str, Any]) -> None:
        """Put a result on disk."""
        self.result = result
        with written_beside(self.folder / RESULT) as beside:
            beside.write_text(
                json.dumps({"words": self.words, "result": result}), encoding="utf-8"
            )

    def play_again(self, played: dict[str, Any]) -> None:
        """Take the machine's run of the same program at another override into the result."""
        if self.result is not None:
            self.keep({**self.result, **{k: v for k, v in played.items() if k != "faults"}})

    def files(self) -> list[str]:
        """The names of the results in the folder."""
        if not self.folder.is_dir():
            return []
        every = (f for f in self.folder.iterdir() if f.is_file() and not f.name.startswith("."))
        return sorted(file.name for file in every if file.name not in (STATE, RESULT))

    def _read(self) -> None:
        """Take up the last result, if it can be read."""
        try:
            kept = json.loads((self.folder / RESULT).read_text(encoding="utf-8"))
            self.result, self.words = kept["result"], kept["words"]
        except (OSError, ValueError, KeyError, TypeError):
            self.result = self.words = None
