"""What a scale does to a program beside the size of its lines, in words.

Signals in: the scale, and what was asked of the tool. Signals out: one text, None without a scale.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from morfax.jobs.settings.settings import TraceSettings


def said(scale: float, settings: TraceSettings | None, *, has_feed: bool) -> str | None:
    """What else is scaled; of a path, for which nothing was asked here, what may be.

    A feed that is asked for is not scaled.
    """
    if scale == 1:
        return None
    parts = list[str]()
    if settings is None:
        parts.append("a cutter's radius that the path allows for is scaled too")
    elif settings.tool.cutter_mm is not None:
        parts.append(f"the program is for a cutter of {scale * settings.tool.cutter_mm:g} mm")
    longer = [] if settings is None else _lengths(settings)
    if longer:
        parts.append(f"{' and '.join(longer)} are {scale:g} times as long")
    if not has_feed:
        parts.append(f"X and Y run {scale:g} times as fast")
    return f"scaled by {scale:g}: {', '.join([*parts, 'Z is not scaled'])}"


def _lengths(settings: TraceSettings) -> list[str]:
    """The lengths along the work that were asked for."""
    contour = settings.contour
    asked = {
        "leads": contour.lead_in is not None or contour.lead_out is not None,
        "tabs": settings.card().tabs is not None,
    }
    return [what for what, is_asked in asked.items() if is_asked]
