"""The set-up: what is the same for every line of one job.

Signals: the sheet, the head's settings, the operator and a listener in; out the set-up that the program's
functions take as one.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from morfax.tracer.drawing.strokes import Sheet
from morfax.tracer.following.branches import Branches
from morfax.tracer.head.settings import Settings
from morfax.tracer.operator.operator import Operator

if TYPE_CHECKING:
    from morfax.tracer.ink.chains import Junctions
    from morfax.tracer.tangles.folding_rule import Rule

HeadProgress = Callable[[float, float], None]  # how far the head has come, of what length, mm


@dataclass(frozen=True, slots=True)
class Setup:
    """The sheet on the table, the head's settings, the operator, and who hears how far the head has come."""

    sheet: Sheet
    settings: Settings = field(default_factory=Settings)
    operator: Operator = field(default_factory=Operator)
    progress: HeadProgress | None = None
    # the junctions of the patch of ink that was solved last, by its number (see `net_outline`)
    newest: dict[int, Junctions] = field(default_factory=dict, repr=False, compare=False)
    # the rules that explain the ink of narrow bays, by that ink (see `narrow_bays`)
    rules: dict[bytes, Rule | None] = field(default_factory=dict, repr=False, compare=False)
    # the head's runs with just this set-up
    runs: Branches = field(default_factory=Branches, init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        if self.operator.marks == "off":
            object.__setattr__(self, "sheet", replace(self.sheet, has_references=False))
        elif self.operator.means_program and not self.sheet.bare_rings:
            object.__setattr__(self, "sheet", replace(self.sheet, bare_rings=True))

    def after(self, before_mm: float, total_mm: float) -> Setup:
        """The set-up for one of several lines: its progress counts on from those before, of their total."""
        progress = self.progress
        if progress is None:
            return self

        def counted_on(come_mm: float, _: float) -> None:
            progress(min(before_mm + come_mm, total_mm), total_mm)

        return replace(self, progress=counted_on)

    def part(self, first: float, last: float) -> Setup:
        """The set-up for a part of the work: its progress goes from the first to the last share of that."""
        progress = self.progress
        if progress is None:
            return self

        def of_whole(come: float, of: float) -> None:
            progress(first + (last - first) * come / of, 1.0)

        return replace(self, progress=of_whole)

    def come(self, done: int, of: int) -> None:
        """Say how many of some lines have been looked at."""
        if self.progress is not None and of:
            self.progress(done, of)

    def without_turns(self) -> Setup:
        """The set-up with a card that asks for no turns at junctions."""
        if not self.operator.card.turns:
            return self
        card = replace(self.operator.card, turns=())
        return replace(self, operator=replace(self.operator, card=card))

    def told(self, length_mm: float) -> Callable[[float], None] | None:
        """Who hears how far the head has come along a line of a length; None if nobody listens."""
        progress = self.progress
        if progress is None:
            return None
        return lambda come_mm: progress(min(come_mm, length_mm), length_mm)
