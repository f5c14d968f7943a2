"""Lead screw and sector wheel: the geometry that recorder and player must share.

A screw of pitch p carries the lamp and cell round a wheel of N sectors, so one cycle of phase is q = p/N of
travel, and

    phase of the track = phase of the reference + displacement / q          (cycles)
    frequency of the track = reference + speed / q                          (Hz)

Source: patent ES 361967, figures 2 and 4 (sector wheel 115, arm 118, cell 141, lead screw 111). Questions:
the patent gives no numbers. Chosen for the tape: pitch 5 mm, 100 sectors, q = 50 um; historic: pitch 5 mm, 40
sectors, q = 125 um.
"""

from __future__ import annotations

from dataclasses import dataclass

TRAVEL_MM = 2000.0  # of the simulated machine's axes, either way from zero: our own figure


@dataclass(frozen=True, slots=True)
class LeadScrew:
    """A lead screw with its sector wheel."""

    pitch_mm: float = 5.0
    sectors: int = 100

    @property
    def mm_per_cycle(self) -> float:
        """Travel in one cycle of phase, q."""
        return self.pitch_mm / self.sectors

    @property
    def cycles_per_mm(self) -> float:
        """Cycles of phase per mm of travel, 1/q."""
        return self.sectors / self.pitch_mm

    def track_hz(self, reference_hz: float, speed_mm_s: float) -> float:
        """Frequency of the track while the screw moves at a speed, Hz."""
        return reference_hz + speed_mm_s * self.cycles_per_mm
