"""Worn tapes for the tests of trust: programs, wear at five strengths, and whether a playing was right."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from morfax.motion.faults import Fault, LockFault, TapeFault
from morfax.motion.motion import Motion, join
from morfax.player.tape.playback import play
from morfax.recorder.tape.tape import record
from morfax.recorder.wear.settings import Wear
from morfax.recorder.wear.transport import age
from tests.player.carriers import MOTION_RATE_HZ, circle, square

RIGHT_CYCLES = 0.05
RATE_HZ = 48000
ENDS = 60  # rows that the filter of the transport's own ends reaches into

HOLES = ((0.0003, 6), (0.001, 12), (0.002, 30), (0.005, 40), (0.02, 40))
STRENGTHS: dict[str, list[dict[str, Any]]] = {
    "speed": [{"speed": x} for x in (0.002, -0.005, 0.015, -0.05, 0.08)],
    "wow": [{"wow": x, "flutter": x} for x in (5e-4, 1e-3, 2e-3, 5e-3, 1e-2)],
    "scrape": [{"scrape": x} for x in (5e-4, 1e-3, 2e-3, 5e-3, 1e-2)],
    "skew": [{"skew_s": x} for x in (1e-6, 3e-6, 6e-6, 1.2e-5, 2.4e-5)],
    "weave": [{"weave_s": x} for x in (1e-7, 3e-7, 1e-6, 3e-6, 1e-5)],
    "noise": [{"noise_db": x} for x in (60, 46, 36, 26, 16)],
    "level": [{"level_db": x} for x in (6, -6, -20, -35, -50)],
    "uneven": [{"uneven_db": x} for x in (0.2, 0.5, 1, 2, 4)],
    "crosstalk": [{"crosstalk_db": x} for x in (60, 40, 30, 20, 10)],
    "print": [{"print_db": x, "print_s": 0.4} for x in (60, 50, 40, 30, 15)],
    "dropouts": [{"dropouts_per_min": 60, "dropout_s": x, "dropout_db": y} for x, y in HOLES],
    "dropouts of all": [
        {"dropouts_per_min": 60, "dropout_s": x, "dropout_db": y, "dropout_all": True}
        for x, y in HOLES
    ],
    "hum": [{"hum_db": x} for x in (60, 40, 30, 20, 6)],
    "dc": [{"dc": x} for x in (0.01, 0.03, 0.1, 0.2, 0.4)],
    "distortion": [{"third": x} for x in (0.005, 0.01, 0.03, 0.1, 0.2)],
    "bandwidth": [{"bandwidth_hz": x} for x in (20000, 12500, 9000, 7000, 5000)],
    "clipping": [{"clip": x} for x in (0.49, 0.45, 0.4, 0.3, 0.1)],
    "sample rate": [{"stamped_hz": x} for x in (47000, 44100, 50000, 96000, 22050)],
    "order": [
        {"order": x}
        for x in ((2, 1, 3, 4), (3, 2, 1, 4), (4, 2, 3, 1), (2, 3, 4, 1), (4, 3, 2, 1))
    ],
    "polarity": [{"inverted": x} for x in ((1,), (2,), (2, 3), (1, 2, 3, 4), (4,))],
    "start": [{"cut_start_s": x} for x in (0.1, 0.5, 0.9, 1.5, 3)],
    "end": [{"cut_end_s": x} for x in (0.1, 0.5, 0.9, 1.5, 3)],
}


def program(radius_mm: float = 10.0, speed_mm_s: float = 10.0) -> np.ndarray:
    """Once round a circle, Z going down by the way; positions in mm."""
    seconds = 2 * np.pi * radius_mm / speed_mm_s + 0.8
    positions = circle(radius_mm, speed_mm_s)(
        np.arange(round(seconds * MOTION_RATE_HZ)) / MOTION_RATE_HZ
    )
    positions[:, 2] = -positions[:, 1] / radius_mm
    return positions


def corners(side_mm: float = 10.0, speed_mm_s: float = 40.0) -> np.ndarray:
    """Once round a square, stopping at each corner."""
    seconds = 4 * (side_mm / speed_mm_s + speed_mm_s / 500) + 0.8
    return square(side_mm, speed_mm_s)(
        np.arange(round(seconds * MOTION_RATE_HZ)) / MOTION_RATE_HZ
    )


class Bench:
    """A tape, its clean playing, and trials of it worn."""

    def __init__(self, folder: Path, positions_mm: np.ndarray) -> None:
        self.tape, self._worn = folder / "bench.wav", folder / "worn.wav"
        record(Motion(positions_mm), self.tape)
        self.clean = join(play(self.tape)).positions_mm
        self.dropouts_s: list[float] = []  # lengths, of the last trial

    def trial(self, seed: int, **parts: Any) -> tuple[float, Fault | None]:
        """The largest error in cycles of what was played, and the fault that ended it.

        A delay that all axes have alike (0.1 ms: that of a low-pass) changes nothing but the time.
        """
        aged = age(self.tape, self._worn, replace(Wear(), **parts), seed=seed)
        self.dropouts_s = [
            hole.length_s for hole in aged.dropouts if hole.start_s < aged.duration_s
        ]
        blocks, fault = [], None
        try:
            for block in play(self._worn):
                blocks.append(block)
        except (TapeFault, LockFault) as met:
            fault = met
        went = join(blocks).positions_mm if blocks else np.zeros((0, 3))
        if len(went) < 2 * ENDS:
            return 0.0, fault
        rows = (
            aged.timebase.programme_s(np.arange(len(went)) / 6000)
            + parts.get("cut_start_s", 0.0)
        ) * 6000
        wanted = np.column_stack(
            [np.interp(rows, np.arange(len(self.clean)), column) for column in self.clean.T]
        )
        ends = slice(ENDS, len(went) - ENDS + 1)
        error, speed = (
            (went - wanted)[ends],
            np.gradient(wanted, axis=0)[ends],
        )  # mm, and mm per row
        # of all axes: the tape's clock
        late = np.clip((error * speed).sum() / max((speed**2).sum(), 1e-12), -0.6, 0.6)
        return float(np.abs(error - late * speed).max() * 20), fault
