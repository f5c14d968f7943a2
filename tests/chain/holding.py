"""Bounds that a played contour holds."""

from __future__ import annotations

from morfax.motion.contour import Distances


def hold(found: Distances, rms_mm: float, max_mm: float) -> None:
    """Both ways: what the path does wrong, and what it misses."""
    for way in (found.path_to_reference, found.reference_to_path):
        assert way.rms_mm < rms_mm and way.max_mm < max_mm, str(found)
