"""The draftsman's sheet of patent ES 361967, its trace and its tape, and ears of their own to listen to it.

       ┼──────┼──── contour ──┼── and back          drawn with 0.5 mm, scanned at 300 dpi with noise

A reference point, a lead line with a stop mark just before the contour, the contour, a stop mark on it.
What is on the tape is heard with nothing of the project's own: a counter of zero crossings.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
import soundfile

from morfax.jobs.remarks.who_led import WhoLed
from morfax.motion.arrays import Array
from morfax.motion.motion import MOTION_RATE_HZ, Motion, join
from morfax.player.tape.playback import TapePlayback
from morfax.recorder.tape.tape import TapeFormat, record
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.head.settings import Settings
from morfax.tracer.operator.operator import Operator
from morfax.tracer.operator.work import Work
from morfax.tracer.program.program import Trace
from morfax.tracer.program.trace import trace
from tests.tracer.inked import arc, inked, polyline

UM = 1e-3
RATE_HZ = 48_000
REFERENCE_HZ, Q_MM = 6000.0, 0.05
REFERENCE, X, Y, Z = range(4)
CENTRE_MM, RADIUS_MM, SPEED_MM_S, DEPTH_MM = (40.0, 30.0), 10.0, 10.0, 5.0
COUNTED_S = 0.05
# a crossing is placed to 0.015 of a cycle where eight samples make one: two of them over 0.05 s
COUNTED_HZ = 0.6
# 16 bit: a step is 3e-5 of full scale, and a carrier's zero is passed at pi of it per cycle
AT_REST_CYCLES = 2e-5


@pytest.fixture(scope="session")
def sheet() -> Drawing:
    cross = [polyline((10.8, 30), (13.2, 30)), polyline((12, 28.8), (12, 31.2))]
    ticks = [polyline((25, 28.5), (25, 31.5)), polyline((40, 38.5), (40, 41.5))]
    return inked(
        arc(CENTRE_MM, RADIUS_MM), polyline((12, 30), (30, 30)), *cross, *ticks, seed=1969
    )


@pytest.fixture(scope="session")
def run(sheet: Drawing) -> Trace:
    """The follower's run over the whole sheet."""
    return trace(
        sheet,
        settings=Settings(speed_mm_s=SPEED_MM_S),
        operator=Operator(Work(depth_mm=DEPTH_MM)),
    )


@pytest.fixture(scope="session")
def tape(run: Trace, tmp_path_factory: pytest.TempPathFactory) -> Taped:
    return taped(join(run), tmp_path_factory.mktemp("morfax") / "program.wav")


@dataclass(frozen=True)
class Taped:
    """A motion and the tape of it."""

    file: Path
    motion: Motion

    def track(self, number: int) -> Array:
        """The samples of a track, as any sound program reads them."""
        frames = np.asarray(soundfile.read(self.file)[0])
        return np.asarray(frames[:, number])

    def hz(self, number: int, at_s: float) -> float:
        """Frequency of a track about a time of the motion, by counting."""
        first = round((at_s + 1.0 - COUNTED_S / 2) * RATE_HZ)  # after a second of standstill
        return counted_hz(self.track(number)[first : first + round(COUNTED_S * RATE_HZ)])

    def speed_mm_s(self, axis: int, at_s: float) -> float:
        """Mean speed of an axis of the motion over the same time."""
        places = self.motion.positions_mm[:, axis - 1]
        half = round(COUNTED_S / 2 * MOTION_RATE_HZ)
        at = round(at_s * MOTION_RATE_HZ)
        return float((places[at + half] - places[at - half]) / (2 * half) * MOTION_RATE_HZ)


def counted_hz(samples: Array) -> float:
    """Frequency of a carrier: whole cycles between its first and last upward crossing of zero."""
    up = np.flatnonzero((samples[:-1] < 0) & (samples[1:] >= 0))
    at = up + samples[up] / (samples[up] - samples[up + 1])
    return float((len(at) - 1) / (at[-1] - at[0]) * RATE_HZ)


def phase_apart(
    tape: Taped, number: int, from_s: float, to_s: float, window_s: float = 0.01
) -> float:
    """How far the phase of a track goes against the reference's within a time of the motion, cycles; of means
    over a window.
    """
    span = slice(round((from_s + 1) * RATE_HZ), round((to_s + 1) * RATE_HZ))
    turning = np.exp(-2j * np.pi * REFERENCE_HZ * np.arange(span.start, span.stop) / RATE_HZ)
    window = round(window_s * RATE_HZ)  # whole cycles: the mirror image falls out
    beats = [
        (tape.track(track)[span] * turning)[: len(turning) // window * window]
        for track in (number, REFERENCE)
    ]
    means = [beat.reshape(-1, window).mean(axis=1) for beat in beats]
    return float(np.ptp(np.unwrap(np.angle(means[0] * means[1].conj()))) / (2 * np.pi))


def taped(motion: Motion, file: Path, fmt: TapeFormat | None = None) -> Taped:
    record(motion, file, fmt or TapeFormat())  # the bare tracks of the patent
    return Taped(file, motion)


def round_the_contour(tape: Taped) -> Iterator[float]:
    """Times at which the head is under way, by the motion itself."""
    speed = np.hypot(
        *np.gradient(tape.motion.positions_mm[:, :2], 1 / MOTION_RATE_HZ, axis=0).T
    )
    steady = np.convolve(np.abs(speed - SPEED_MM_S) < 0.5, np.ones(601), "same") == 601
    moments = np.flatnonzero(steady)
    return iter((moments[:: len(moments) // 40] / MOTION_RATE_HZ).tolist())


def edges_of_the_cells(playback: TapePlayback) -> Iterator[tuple[Array, Array]]:
    """While a tape plays, block by block: the edges that the cells on the machine's screws have given, and
    those that the reference's cycles and the screws' places make, (axes).
    """
    reference_cycles = playback.format.reference_hz / playback.format.motion_rate_hz
    rows = 0
    for motion in playback:
        rows += len(motion.positions_mm)
        moved_mm = motion.positions_mm[-1] - playback.start_mm
        yield playback.cell_edges, rows * reference_cycles + moved_mm / Q_MM


def cell_share(run: Trace) -> float:
    """The share of the head's way outside of corners and junctions that its swinging cell led."""
    led = WhoLed.along(run)
    assert led is not None
    return led.cell_on_lines_share


def standing_s(run: Trace, number: int) -> tuple[float, float]:
    """From when to when X and Y stand at a stop, s of the motion."""
    place = next(
        action.halt.place_mm for action in run.actions[0] if action.halt.number == number
    )
    positions = join(run).positions_mm
    still = np.r_[False, (np.diff(positions[:, :2], axis=0) == 0).all(axis=1)]
    there = np.flatnonzero(still & (np.hypot(*(positions[:, :2] - place).T) < 0.01))
    return float(there[0] / run.rate_hz), float(there[-1] / run.rate_hz)
