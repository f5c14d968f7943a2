"""Remarks on what is on a drawing beside its table: which numbers are uncertain, what --lines contours leaves
out, and what it takes though that may not be meant.

Signals in: a survey. Signals out: texts, each with what to do.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from morfax.motion.by_number import listed, numbered

if TYPE_CHECKING:
    from morfax.tracer.program.survey import Survey


def remarks_on_lines(seen: Survey) -> Iterator[str]:
    """Remarks on a survey, the most important first."""
    if not seen.entries:
        yield (
            "no piece of ink is long enough to be a line (4 mm or six line widths, or 12 mm across): "
            "check the scale, or give --start X,Y to trace"
        )
        return
    yield from _of_several(seen)
    yield from _of_left_out(seen)
    yield from _of_lettering(seen)
    yield from _of_solids(seen)


def _of_several(seen: Survey) -> Iterator[str]:
    """Patches of several lines, whose other lines have no numbers yet."""
    several = [entry.number for entry in seen.entries if entry.kind == "several"]
    if several and not seen.lines:
        last = seen.entries[-1].number
        yield (
            f"{numbered('line', several)} made of several that cross or touch: the number takes one of them; "
            f"--follow follows them all (slower) and numbers the others from {last + 1} on"
        )


def _of_left_out(seen: Survey) -> Iterator[str]:
    """What --lines contours leaves out."""
    left = []
    if seen.left_out:
        left.append(
            f"{_pieces(len(seen.left_out))} of ink too short to be a line ({seen.left_out_mm:.0f} mm in all)"
        )
    kinds = {
        "taken for letters": [e.number for e in seen.entries if e.is_letter],
        "rims of filled shapes": [e.number for e in seen.entries if e.is_solid],
        "reference points": [e.number for e in seen.entries if e.is_reference],
        "pieces of another line": [e.number for e in seen.entries if e.piece_of is not None],
    }
    left += [
        f"{listed('line', numbers)} ({what})" for what, numbers in kinds.items() if numbers
    ]
    if seen.not_followed_mm and seen.not_followed_mm >= 1.0:
        left.append(f"{seen.not_followed_mm:.0f} mm of ink that only connects lines")
    if left:
        yield f"--lines contours leaves out {'; '.join(left)}: --lines all follows all ink"


def _of_lettering(seen: Survey) -> Iterator[str]:
    """Likely letters that --lines contours traces."""
    yield from of_letters(
        [e.number for e in seen.entries if e.is_lettering and e.is_in_contours]
    )


def of_letters(letters: list[int]) -> Iterator[str]:
    """Contours that are likely letters, and what leaves them out."""
    if letters:
        yield (
            f"{numbered('line', letters)} likely lettering, and --lines contours traces them; "
            "--lettering none leaves them out"
        )


def _of_solids(seen: Survey) -> Iterator[str]:
    """Rims of filled shapes."""
    solid = [entry.number for entry in seen.entries if entry.is_solid]
    if solid:
        yield (
            f"{numbered('line', solid)} the rim of a dark area broader than a line: if that is a filled "
            "shape, --edge follows its outline, and --lines all --edge the lines beside it too"
        )


def _pieces(count: int) -> str:
    """So many pieces."""
    return "1 piece" if count == 1 else f"{count} pieces"
