"""A card means the same on every medium: its depths, pecks, dwells, feeds and stops, in what is played.

The drawing of each sample card is traced once, recorded in every medium, and played on its own control. What
Z does in each played motion is held against what it did in the traced one. G-code is written for three
machines with a Z axis; what those without one leave out is told (tests/console/test_machines.py).
"""

from __future__ import annotations

from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest

from morfax.jobs.listener import SILENT
from morfax.jobs.settings.drawing_file import DrawingFile
from morfax.jobs.settings.settings import ProgramSettings, TraceSettings
from morfax.jobs.tracing.tracing import Tracing
from morfax.motion.motion import Path as MotionPath
from morfax.motion.motion import thin
from morfax.motion.segments import Limits
from morfax.player.controls import play
from morfax.recorder.media import record

SAMPLES = Path(__file__).parents[2] / "samples"
CARDS = sorted(card for card in SAMPLES.glob("*.toml") if card.with_suffix(".png").exists())
COARSE = Limits(100.0, 500.0, spacing_mm=0.05, window_mm=0.2, corner_rad=0.2)
MEDIA: dict[str, tuple[str, dict[str, Any]]] = {
    "tape": ("card.wav", {}),
    "linuxcnc": ("card.ngc", {}),
    "grbl-router": ("card.nc", {"machine_name": "grbl-router"}),
    "marlin": ("card.gcode", {"machine_name": "marlin"}),
    "steps": ("card.steps", {}),
    # at the recorder's own 2 um and 5 um of spacing it takes seven times as long
    "cubic": ("card.cubic", {"tolerance_mm": 0.02, "limits": COARSE}),
}
STEP_S = 0.005  # of the times at which a motion is looked at
WINDOW_S = 0.03  # over which a speed is measured: at 5 mm/s fifteen steps of a stepping motor
SLOWEST_MM_S = 0.3  # a slower axis stands: a stepping motor's one step in the window
SHORTEST_MM = 0.3  # of a move of Z: half of the shortest on a card, its clear of 0.5 mm
SHORTEST_S = 0.3  # of a dwell; the head's own stands at a swivel are shorter
DEPTH_MM = 0.02  # two steps of the stepping motors
PLACE_MM = 0.05  # of a stop: two steps, and what a head's own way about the stop is
# the pulse control's own feed is -10.6 ... +1.9 % on three axes, within 1 % on one
FEED_SHARE = 0.05
DWELL_S = 0.1  # speeding up and braking beside it


class ZMove(NamedTuple):
    """A move of Z while X and Y stand: where, to what height, and the speed near its end."""

    x_mm: float
    y_mm: float
    to_mm: float
    feed_mm_s: float


class Dwell(NamedTuple):
    """A stand: where, how deep, how long."""

    x_mm: float
    y_mm: float
    z_mm: float
    time_s: float


class Played(NamedTuple):
    """What a card has made of a motion."""

    moves: list[ZMove]
    dwells: list[Dwell]


def of(path: MotionPath) -> Played:
    """The moves of Z and the dwells of a path; the stands at its begin and end are none.

    A control may stand between two moves of Z in one direction, where the feed of a drill begins: what counts
    is where the second leads, and how fast.
    """
    t_s = np.arange(path.t_s[0], path.t_s[-1], STEP_S)
    x, y, z = (np.interp(t_s, path.t_s, axis) for axis in path.positions_mm[:, :3].T)
    reach = round(WINDOW_S / STEP_S / 2)
    run_mm = [np.roll(axis, -reach) - np.roll(axis, reach) for axis in (x, y, z)]
    vx, vy, vz = (mm / WINDOW_S for mm in run_mm)
    climbs = np.where(np.abs(vz) > SLOWEST_MM_S, np.sign(vz), 0)
    climbs[:reach] = climbs[-reach:] = 0
    moves = list[ZMove]()
    for first, last in runs(climbs):
        after = z[first : last + 2 * reach]
        to_mm = float(after.min() if climbs[first] < 0 else after.max())
        if abs(to_mm - z[first]) < SHORTEST_MM:
            continue
        made = ZMove(x[last], y[last], to_mm, feed(t_s[first:last], z[first:last]))
        goes_on = moves and (moves[-1].feed_mm_s < 0) == (climbs[first] < 0)
        if goes_on and np.hypot(*np.subtract(moves[-1][:2], made[:2])) < PLACE_MM:
            moves.pop()
        moves.append(made)
    stands = np.where((climbs == 0) & (np.hypot(vx, vy) < SLOWEST_MM_S), 1, 0)
    stood = [
        Dwell(x[first], y[first], z[first], t_s[last] - t_s[first])
        for first, last in runs(stands)
        if first > reach and last < len(stands) - 1 - reach
    ]
    return Played(moves, [dwell for dwell in stood if dwell.time_s >= SHORTEST_S])


def runs(values: np.ndarray) -> list[tuple[int, int]]:
    """First and last index of each row of like values other than 0."""
    cuts = np.r_[0, np.flatnonzero(np.diff(values)) + 1, len(values)]
    pairs = zip(cuts[:-1].tolist(), cuts[1:].tolist(), strict=True)
    return [(first, last - 1) for first, last in pairs if values[first] != 0]


def feed(t_s: np.ndarray, z_mm: np.ndarray) -> float:
    """The speed, down negative, between a half and a tenth of a move before its end, at most 4 mm of it."""
    left_mm = np.abs(z_mm - z_mm[-1])
    whole_mm = min(4.0, float(left_mm[0]))
    window = np.flatnonzero((left_mm <= whole_mm / 2) & (left_mm >= whole_mm / 10))
    first, last = window[0], window[-1]
    return float(z_mm[last] - z_mm[first]) / float(t_s[last] - t_s[first])


@pytest.fixture(scope="module", params=CARDS, ids=lambda card: card.stem)
def traced(request: pytest.FixtureRequest) -> MotionPath:
    """The path of a card's drawing."""
    settings = TraceSettings(program=ProgramSettings(card_file=request.param))
    drawing = DrawingFile(request.param.with_suffix(".png")).open()
    return Tracing.prepared(settings).trace(drawing, SILENT).path


@pytest.mark.parametrize("medium", MEDIA)
def test_a_card_is_played_as_it_was_traced(
    medium: str, traced: MotionPath, tmp_path: Path
) -> None:
    name, settings = MEDIA[medium]
    record(traced, tmp_path / name, **settings)
    wanted, found = of(traced), of(thin(play(tmp_path / name)))
    assert len(found.moves) == len(wanted.moves)
    for one, other in zip(wanted.moves, found.moves, strict=True):
        assert other[:2] == pytest.approx(one[:2], abs=PLACE_MM)
        assert other.to_mm == pytest.approx(one.to_mm, abs=DEPTH_MM)
        if one.feed_mm_s < 0:  # up again at the machine's own rapid
            assert other.feed_mm_s == pytest.approx(one.feed_mm_s, rel=FEED_SHARE)
    assert len(found.dwells) == len(wanted.dwells)
    for dwell, other_dwell in zip(wanted.dwells, found.dwells, strict=True):
        assert other_dwell[:3] == pytest.approx(dwell[:3], abs=PLACE_MM)
        assert other_dwell.time_s == pytest.approx(dwell.time_s, abs=DWELL_S)


def test_the_comparison_sees_what_a_card_asks_for(traced: MotionPath) -> None:
    seen = of(traced)
    assert seen.moves and seen.dwells
    slower = of(MotionPath(traced.t_s * 1.2, traced.positions_mm))
    assert abs(slower.moves[0].feed_mm_s) < (1 - FEED_SHARE) * abs(seen.moves[0].feed_mm_s)
    flat = traced.positions_mm * [1, 1, 0.9]
    deepest_mm = min(move.to_mm for move in of(MotionPath(traced.t_s, flat)).moves)
    assert deepest_mm > min(move.to_mm for move in seen.moves) + DEPTH_MM
