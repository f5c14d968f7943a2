"""Settings of contouring: which way round closed lines are cut, where a cut begins, and its leads."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from morfax.jobs.wrong_use import WrongUse

if TYPE_CHECKING:
    from morfax.tracer.cutter.contouring import Contouring, Milling, StartAt

Leading = tuple[float, str]  # the size in mm, and "arc" or "line"


@dataclass(frozen=True, slots=True)
class ContourSettings:
    """What is asked of closed lines; None leaves them as the head followed them."""

    milling: Milling | None = None
    lead_in: Leading | None = None
    lead_out: Leading | None = None
    start_at: StartAt | None = None
    by_machine: bool = False  # the direction is the machine's: nobody asked for it
    mirrored: bool = False  # the program is mirrored when it is recorded

    def check(self, direction: str | None) -> None:
        """Raise WrongUse for two directions at once."""
        if self.milling is not None and direction is not None:
            raise WrongUse(
                f"--direction {direction} and --{self.milling} both say which way round; give one of them"
            )

    def on_machine(
        self, milling: Milling | None, direction: str | None, mirrored: bool
    ) -> ContourSettings:
        """The same with the direction that a machine asks for, where nobody asked for another one."""
        settings = replace(self, mirrored=mirrored)
        if self.milling is not None or direction is not None or milling is None:
            return settings
        return replace(settings, milling=milling, by_machine=True)

    def contouring(self) -> Contouring:
        """What the tracer is asked for."""
        from morfax.tracer.cutter.contouring import Contouring, Lead

        def lead(asked: Leading | None) -> Lead | None:
            if asked is None:
                return None
            size_mm, kind = asked
            return Lead(size_mm, "line" if kind == "line" else "arc")

        leads = lead(self.lead_in), lead(self.lead_out)
        asked = self.milling, *leads, self.start_at
        return Contouring(*asked, self.by_machine, self.mirrored)
