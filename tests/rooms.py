"""The packages of the house: the folders at its top that a wheel installs."""

from __future__ import annotations

PACKAGES = (
    "motion", "tracer", "recorder", "player", "jobs", "reports", "panel", "batch", "console",
)  # fmt: skip
ROOMS = (*PACKAGES, "samples")
