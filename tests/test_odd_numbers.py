"""The count of limits and tuned numbers: what counts, and what does not."""

from __future__ import annotations

from pathlib import Path

from tests.odd_numbers import odd_numbers

SOURCE = '''"""Of 7 words."""
MM_PER_INCH = 25.4
REACH_MM = 3.0
NEAR, FAR_MM = 2.0, 0.1
INK, PAPER, EDGE = 3, 4, 5
MARK = 0x4D
COLOUR = (12, 34, 56)
TWICE_MM = 2 * REACH_MM
STATES = {"up": 7}
TIP = math.radians(120)

@dataclass
class Settings:
    """Of 8."""
    gap_mm: float = 0.3
    count: int = 2

def trace(places, speed_mm_s=12.5):
    """Of 9."""
    if len(places) < 6:
        raise ValueError(f"{len(places)} of 6")
    degrees = 180 / math.pi
    return places[5] * 1e-3 / 60 + 0.7 * speed_mm_s ** 3
'''


def test_what_was_chosen_counts_and_units_tables_and_messages_do_not() -> None:
    odd = odd_numbers(Path("a.py"), SOURCE)
    constants = [one.name for one in odd if one.constant]
    assert constants == ["REACH_MM", "FAR_MM", "TIP", "gap_mm", "12.5"]
    assert [(one.line, one.name) for one in odd if not one.constant] == [(20, "6"), (23, "0.7")]
