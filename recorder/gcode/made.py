"""What a program is made from, as its head says it (`program_head`).

It stands alone because every recording unit has one, whatever it records in.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Made:
    """What a program is made from: the drawing's or path's name, and the tool, as text; '' not known.

    Width and height of the part, mm, and where on the sheet the program's zero is, mm; None: not known, or
    that of the sheet.
    """

    source: str = ""
    tool: str = ""
    part_mm: tuple[float, float] | None = None
    zero_mm: tuple[float, float] | None = None
