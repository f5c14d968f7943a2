"""A row of the manifest: how one drawing ended.

    ending          what it means                                          tried again by the next call
    done            traced and written
    incomplete      the line was lost; the files hold what was traced      no, it would end the same way
    fault           the drawing cannot be used, or no line was found       no, unless a file could not be read
    over limit      it took longer than the limit                          yes
    no memory       it needed more than the limit                          yes
    killed          two workers died over it                               no
    mistake         a mistake in morfax                                    yes

Exit codes stand beside faults: those of `morfax trace`, 124 over the limit (as of timeout(1)), 137 killed.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, fields
from typing import Any, Literal

from morfax.motion.faults import BY_SIGNAL, DRAWING, SIGKILL

Ending = Literal["done", "incomplete", "fault", "over limit", "no memory", "killed", "mistake"]
SPOILT: tuple[Ending, ...] = ("no memory", "mistake")  # the worker's memory may be in pieces
OVER_LIMIT = 124  # the exit code of timeout(1)
NO_MEMORY, KILLED = DRAWING, BY_SIGNAL + SIGKILL


@dataclass(frozen=True, slots=True)
class BatchRow:
    """How one drawing ended: `seconds` by the clock, `memory_mb` at most, `folder` beside the manifest."""

    file: str
    ending: Ending
    hash: str = ""
    folder: str = ""
    code: int = 0
    fault: str = ""
    seconds: float = 0.0
    memory_mb: float = 0.0
    figures: Mapping[str, Any] = field(default_factory=dict)
    remarks: tuple[str, ...] = ()
    kept: bool = False  # it was there already

    @property
    def is_well(self) -> bool:
        """Whether all of it was traced."""
        return self.ending == "done"

    def as_plain(self) -> dict[str, Any]:
        """The row for JSON, without what is empty."""
        return {name: value for name, value in asdict(self).items() if value or name == "code"}

    @classmethod
    def of(cls, plain: Mapping[str, Any]) -> BatchRow:
        """The row of what JSON held; raises TypeError if it is none."""
        known = {entry.name for entry in fields(cls)}
        row = {name: value for name, value in plain.items() if name in known}
        return cls(**{**row, "remarks": tuple(row.get("remarks", ()))})
