"""Stubs: traced lines that go out along a tick, a burr or a drop of ink and come back.

Signals in: the lines as the head followed them. Signals out: figures, a remark, and the places that a picture
marks.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from morfax.jobs.remarks.on_lines import OnLines

if TYPE_CHECKING:
    from morfax.tracer.program.lines.stubs import Stub
    from morfax.tracer.program.program import Trace


@dataclass(frozen=True, slots=True)
class StubLines(OnLines):
    """The stubs along which lines go out and back, the longest first."""

    called, marked = "stubs", "stub"
    rows = (
        ("stub_place_mm", "place_mm"),
        ("stub_mm", "out_mm"),
    )

    of_lines: tuple[tuple[int, Stub], ...] = ()

    @classmethod
    def along(cls, trace: Trace) -> StubLines:
        """The stubs of the lines that the head followed; edges and drawn programs have none."""
        from morfax.tracer.program.lines.stubs import stubs

        if trace.ink is not None or trace.operator.reads_marks(trace.lines):
            return cls()
        lines = [line for line in trace.lines if line.roughness_mm is None and not line.on_edge]
        found = [(line.number, stub) for line in lines for stub in stubs(line)]
        return cls(tuple(sorted(found, key=lambda row: -row[1].out_mm)))

    def _of(self, line: str, worst: Stub, at: str, others: int) -> str:
        """That a line goes out along a stub, which may be no part of it."""
        more = f", and so at {others} more place{'s' if others > 1 else ''}" if others else ""
        return (
            f"{line} goes out {worst.out_mm:.1f} mm at {at} along a short stub and comes "
            f"back{more}: if that is a tick or a burr, rub it out, on the sheet or by `morfax correct "
            "--rub`; if ticks stop the machine, give --marks on"
        )
