"""Claims 8 to 14 of patent ES 361967, the apparatus; the others are in `test_morfax_claims`."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest

from morfax.motion.arrays import Array
from morfax.motion.axis import LeadScrew
from morfax.motion.contour import distance
from morfax.motion.drive import Drive
from morfax.motion.motion import MOTION_RATE_HZ, Motion, join, thin
from morfax.player.tape.playback import play
from morfax.recorder.tape.tape import TapeFormat
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.head.settings import Settings
from morfax.tracer.operator.card import Card, Stop
from morfax.tracer.operator.operator import Operator
from morfax.tracer.operator.work import Halt, Work
from morfax.tracer.operator.zunit import (
    Counters,
    Preset,
    QuillMove,
    counts_of,
)
from morfax.tracer.program.program import Trace
from morfax.tracer.program.trace import trace
from tests.sources.drawn_tape import (
    AT_REST_CYCLES,
    COUNTED_HZ,
    COUNTED_S,
    DEPTH_MM,
    Q_MM,
    RADIUS_MM,
    RATE_HZ,
    REFERENCE,
    REFERENCE_HZ,
    SPEED_MM_S,
    UM,
    Taped,
    X,
    Y,
    Z,
    cell_share,
    counted_hz,
    phase_apart,
    round_the_contour,
    standing_s,
    taped,
)


def test_claim_8_what_is_recorded_is_the_turning_of_the_follower_s_own_motors(
    sheet: Drawing, tmp_path: Path
) -> None:
    """With slower motors X and Y follow the head's demand later, and the tape has just that motion."""
    ways = []
    for lag_s in (0.001, 0.005):
        settings = Settings(speed_mm_s=SPEED_MM_S, drive=Drive(lag_s))
        run = trace(sheet, settings=settings)
        tape = taped(join(run), tmp_path / "a.wav")
        for at_s in list(round_the_contour(tape))[::8]:
            for axis in (X, Y):
                expected = REFERENCE_HZ + tape.speed_mm_s(axis, at_s) / Q_MM
                assert tape.hz(axis, at_s) == pytest.approx(expected, abs=COUNTED_HZ)
        assert cell_share(run) > 0.85  # the motors run as the cell steers
        ways.append(thin(run))
    assert distance(ways[1], ways[0]).hausdorff_mm > 2 * UM  # the motors are in it


def test_claim_9_each_drive_turns_a_member_beside_one_of_constant_speed(tmp_path: Path) -> None:
    """The shift is the speed of the screw times the sectors of the wheel; with twice the sectors it is twice
    as much.
    """
    for sectors in (40, 80):
        screw = LeadScrew(pitch_mm=5.0, sectors=sectors)
        places = 5.0 * np.arange(12_000) / MOTION_RATE_HZ  # one turn a second
        fmt = TapeFormat(cycles_per_mm=screw.cycles_per_mm, dwell_s=0.0)
        tape = taped(
            Motion(np.column_stack([places, -places, 0 * places])), tmp_path / "a.wav", fmt
        )
        heard = [
            counted_hz(tape.track(track)[4800:91_200]) - REFERENCE_HZ for track in (X, Y, Z)
        ]
        assert heard == pytest.approx([sectors, -sectors, 0], abs=0.02)


def test_claim_10_one_steering_movement_makes_both_tracks_beside_a_constant_third(
    run: Trace, tape: Taped
) -> None:
    """In every direction the two shifts make the one tracing speed: sine and cosine of one heading."""
    assert cell_share(run) > 0.85  # the cell's, on the steered member
    for at_s in round_the_contour(tape):
        shifts = [(tape.hz(track, at_s) - REFERENCE_HZ) * Q_MM for track in (X, Y)]
        chord = math.sin(SPEED_MM_S * COUNTED_S / 2 / RADIUS_MM) / (
            SPEED_MM_S * COUNTED_S / 2 / RADIUS_MM
        )
        # mm/s: two counts, and the waver of a head on a noisy scan
        assert math.hypot(*shifts) == pytest.approx(
            SPEED_MM_S * chord, abs=2 * COUNTED_HZ * Q_MM + 0.2
        )
        assert tape.hz(REFERENCE, at_s) == pytest.approx(REFERENCE_HZ, abs=COUNTED_HZ)


def test_claim_11_a_member_that_stands_gives_the_reference_frequency(
    run: Trace, tape: Taped
) -> None:
    for number in (1, 2):
        from_s, to_s = standing_s(run, number)
        assert to_s - from_s > 0.4  # the tape runs on
        for track in (X, Y):
            assert phase_apart(tape, track, from_s + 0.02, to_s - 0.02) < AT_REST_CYCLES
    from_s, to_s = standing_s(run, 1)
    travel = phase_apart(tape, Z, from_s - 0.1, to_s + 0.1, 0.001)
    assert travel == pytest.approx(
        (DEPTH_MM + run.work.clearance_mm) / Q_MM, abs=1e-3
    )  # 7 mm are 140 cycles


def test_claim_12_a_sector_wheel_passes_a_lamp_and_a_photocell(
    run: Trace, tape: Taped, tmp_path: Path
) -> None:
    lit = taped(join(run), tmp_path / "a.wav", TapeFormat(pickup="photocell"))
    still = lit.track(X)[: RATE_HZ // 2]
    lines = 2 * np.abs(np.fft.rfft(still)) / len(still)
    assert lines[9000] / lines[3000] == pytest.approx(
        1 / 3, abs=1e-4
    )  # light and dark: a square, up to 18 kHz
    for at_s in list(round_the_contour(lit))[::8]:
        assert lit.hz(X, at_s) == pytest.approx(
            REFERENCE_HZ + lit.speed_mm_s(X, at_s) / Q_MM, abs=3 * COUNTED_HZ
        )
    assert distance(thin(play(lit.file)), thin(play(tape.file))).hausdorff_mm < 1 * UM


def test_claim_13_the_operator_sets_the_tool_s_movement_by_hand(
    sheet: Drawing, tmp_path: Path
) -> None:
    asked: list[int | None] = []

    class AtThePanel:
        def ask(self, halt: Halt, z_mm: float, usual: Sequence[QuillMove]) -> Stop | None:
            asked.append(halt.number)
            return (
                Stop(moves=(Preset(counts_of(z_mm) + 325, "down", 4.0),))
                if halt.number == 1
                else None
            )

        def wait(self, halt: Halt) -> float:
            return 0.0

    tape = taped(join(trace(sheet, operator=Operator(panel=AtThePanel()))), tmp_path / "a.wav")
    assert sorted(set(asked)) == [1, 2]
    assert join(play(tape.file)).positions_mm[:, 2].min() == pytest.approx(-3.25, abs=1 * UM)


CARD = """
start = "2mm"
[[stop]]
number = 1
moves = [
  { down = "4mm", feed = "4mm/s" }, { dwell = "300ms" },
  { up = "1.5mm", feed = "2mm/s" }, { down = "3.25mm", feed = "3mm/s" },
]
"""


def test_claim_14_switches_a_motor_of_variable_speed_and_counters_make_a_sequence(
    sheet: Drawing, tmp_path: Path
) -> None:
    card = Card.parse(CARD)
    run = trace(sheet, operator=Operator(Work(clearance_mm=2.0), card))
    tape = taped(join(run), tmp_path / "a.wav")
    from_s, to_s = standing_s(run, 1)
    z = tape.motion.positions_mm[round(from_s * 6000) : round(to_s * 6000), 2]
    lowest = int(np.argmax(z == -2.0))
    assert [z[0], z[lowest], z[lowest:].max(), z[-1]] == pytest.approx(
        [2.0, -2.0, -0.5, -3.75], abs=1e-9
    )  # to the count
    assert np.count_nonzero(z[lowest:] == -2.0) / MOTION_RATE_HZ == pytest.approx(
        0.3, abs=0.001
    )  # the dwell
    shown = Counters(counts_of(2.0))
    for preset in card.stop(1).moves:
        shown = shown.after(preset)
    assert shown.digits == "-00375"
    speeds = [tape.hz(Z, from_s + after_s) - REFERENCE_HZ for after_s in _middles(z)]
    assert speeds == pytest.approx(
        [-4 / Q_MM, 2 / Q_MM, -3 / Q_MM], abs=COUNTED_HZ
    )  # the feeds, one after the other


def _middles(z_mm: Array) -> list[float]:
    """The middle of each move of Z, s from the first row."""
    moving = np.r_[False, np.diff(z_mm) != 0, False]
    edges = np.flatnonzero(np.diff(moving.astype(int)))
    runs = [(a, b) for a, b in edges.reshape(-1, 2) if b - a > 600]
    turns = [
        (a, a + int(np.argmax(z_mm[a:b])), b) for a, b in runs
    ]  # the last two moves have no dwell between them
    parts = [
        (a, b)
        for a, top, b in turns
        for a, b in ([(a, top), (top, b)] if a + 600 < top < b - 600 else [(a, b)])
    ]
    return [float((a + b) / 2 / MOTION_RATE_HZ) for a, b in parts]
