"""Patent ES 361967 (Morfax, 1969): one test for each of its 17 claims, on the running system.

Here are the methods, 1 to 7; `test_morfax_apparatus` has the apparatus, 8 to 14, `test_morfax_machine` the
machine.

`docs/background/claims-morfax.md` has the table from claim to test; `drawn_tape` the sheet and its tape.
"""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
import soundfile
from numpy.typing import NDArray

from morfax.motion.axis import LeadScrew
from morfax.motion.contour import distance
from morfax.motion.motion import MOTION_RATE_HZ, Motion, join, thin
from morfax.player.tape.playback import play
from morfax.recorder.tape.pickups import PICK_UPS
from morfax.recorder.tape.tape import Tape, TapeFormat
from morfax.tracer.drawing.deviation import deviation
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.following.start import put_down
from morfax.tracer.head.carriage import Carriage
from morfax.tracer.head.settings import HISTORIC
from morfax.tracer.head.state import Home
from morfax.tracer.operator import zunit
from morfax.tracer.operator.zunit import (
    Counters,
    Preset,
    coincidence,
    counts_of,
    z_moves,
)
from morfax.tracer.program.program import Trace
from morfax.tracer.sensing.photocell import behind_aperture, sweep
from tests.sources.drawn_tape import (
    CENTRE_MM,
    COUNTED_HZ,
    DEPTH_MM,
    Q_MM,
    RADIUS_MM,
    RATE_HZ,
    REFERENCE,
    REFERENCE_HZ,
    UM,
    Taped,
    X,
    Y,
    Z,
    cell_share,
    counted_hz,
    edges_of_the_cells,
    round_the_contour,
    standing_s,
    taped,
)
from tests.tracer.inked import arc, polyline


def test_claim_1_the_follower_goes_round_the_drawing_and_its_signal_tells_direction_and_speed(
    sheet: Drawing, run: Trace, tape: Taped
) -> None:
    assert cell_share(run) > 0.85  # by its own eye
    loop = run.lines[0].xy_mm[run.lines[0].loop_from :]
    turned = np.unwrap(np.arctan2(*(loop - CENTRE_MM).T[::-1]))
    assert abs(turned[-1] - turned[0]) == pytest.approx(
        2 * math.pi, abs=0.01
    )  # progressively round, once
    # on the line of 0.5 mm
    assert np.abs(np.hypot(*(loop - CENTRE_MM).T) - RADIUS_MM).max() < 0.02
    hz = [(tape.hz(X, at_s), tape.speed_mm_s(X, at_s)) for at_s in round_the_contour(tape)]
    assert max(speed for _, speed in hz) > 9 and min(speed for _, speed in hz) < -9
    for found, speed in hz:
        assert found == pytest.approx(REFERENCE_HZ + speed / Q_MM, abs=COUNTED_HZ)


def test_claim_2_an_oscillating_cell_steers_and_the_tracks_lie_about_a_recorded_reference(
    sheet: Drawing, tape: Taped
) -> None:
    cells = behind_aperture(sheet, HISTORIC.aperture_mm)
    sides = [
        sweep(
            cells,
            np.array([20.0, 30.0]),
            0.0,
            (aside_mm, HISTORIC.amplitude_mm),
            400,
        )[0]
        for aside_mm in (-0.3, -0.1, 0.1, 0.3)
    ]
    # the fundamental of its swing tells the side
    assert sides[0] > sides[1] > 0.02 and sides[3] < sides[2] < -0.02
    for aside_mm in (-0.2, 0.2):  # and turns the head back upon the line
        stance, _ = next(put_down(sheet, (15.0, 30.0), HISTORIC))
        carriage = Carriage(stance, HISTORIC, MOTION_RATE_HZ)
        carriage.state.y_mm += aside_mm
        while carriage.travel_mm < 4:
            carriage.follow(stance.view, Home(0.0, 0.0, 0.0, from_travel_mm=1e9))
        assert (
            abs(carriage.positions_mm[1, 1] - 30) > 0.15
            and abs(carriage.positions_mm[-1, 1] - 30) < 0.05
        )
    for number in (X, Y):
        heard = [tape.hz(number, at_s) for at_s in round_the_contour(tape)]
        # 10 mm/s is 200 Hz
        assert min(heard) < REFERENCE_HZ - 180 and max(heard) > REFERENCE_HZ + 180
    assert {round(tape.hz(REFERENCE, at_s)) for at_s in round_the_contour(tape)} == {6000}


def test_claim_3_the_panel_s_switches_put_the_tool_s_movements_on_a_z_track(
    run: Trace, tape: Taped, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The switches are counted down by the disc on the running motor, and coincidence stops it."""
    down = run.actions[0][0]
    assert (down.halt.number, [move.to_mm for move in down.moves]) == (1, [-DEPTH_MM])
    from_s, to_s = standing_s(run, 1)
    middle_s = (from_s + to_s) / 2
    # 5 mm/s down are 100 Hz below; where Z stands the track is at the reference
    assert tape.hz(Z, middle_s) == pytest.approx(
        REFERENCE_HZ - down.moves[0].feed_mm_s / Q_MM, abs=COUNTED_HZ
    )
    assert tape.hz(Z, from_s - 0.2) == pytest.approx(REFERENCE_HZ, abs=COUNTED_HZ)
    panel, after = Counters(counts_of(2.0)), Counters(counts_of(2.0)).after(Preset(700, "down"))
    assert Preset(700, "down").digits == "00700"  # five decades
    assert after.z_mm - panel.z_mm == pytest.approx(-DEPTH_MM - run.work.clearance_mm)
    # the running unit: 700 pulses of the disc and 700 on the switches, and the motor is off
    met: list[tuple[int, int]] = []

    def counting(shown: NDArray[np.int64], counts: int) -> int | None:
        met.append((abs(int(shown[-1])), counts))
        return coincidence(shown, counts)

    monkeypatch.setattr(zunit, "_one", zunit._one.__wrapped__)  # counted anew each time
    with monkeypatch.context() as watched:
        watched.setattr(zunit, "coincidence", counting)
        z_mm = join(run).positions_mm[:, 2]
    assert (700, 700) in met and all(shown == counts for shown, counts in met)
    assert z_mm.min() == -DEPTH_MM and np.array_equal(z_mm, tape.motion.positions_mm[:, 2])
    # a disc with twice the holes stops the tool half-way down: 2 mm less 3.5, and no plan says that
    disc = zunit.counted
    with monkeypatch.context() as finer:
        finer.setattr(zunit, "counted", lambda come_mm, pulse_mm: disc(come_mm, pulse_mm / 2))
        stopped = z_moves(run.work.clearance_mm, down.moves[:1])
    assert stopped[-1] == pytest.approx(-1.5, abs=zunit.COUNT_MM)


@pytest.mark.parametrize("pickup", PICK_UPS)
def test_claim_4_a_member_on_the_screw_and_one_on_the_reference_motor_make_the_signal(
    pickup: str, tmp_path: Path
) -> None:
    """Photoelectric or inductive: a turn of the screw shifts the phase by as many cycles as the wheel has
    sectors.
    """
    screw, turns_per_s = LeadScrew(pitch_mm=5.0, sectors=100), 2.0
    fmt = TapeFormat(cycles_per_mm=screw.cycles_per_mm, pickup=pickup, dwell_s=0.0)
    for sense in (1, -1):
        places = sense * turns_per_s * screw.pitch_mm * np.arange(6000) / MOTION_RATE_HZ
        tape = taped(
            Motion(np.column_stack([places, 0 * places, 0 * places])), tmp_path / "a.wav", fmt
        )
        middle = slice(4800, 43_200)
        heard = counted_hz(tape.track(X)[middle])
        assert heard == pytest.approx(
            REFERENCE_HZ + sense * turns_per_s * screw.sectors, abs=0.05
        )
        assert counted_hz(tape.track(Y)[middle]) == pytest.approx(REFERENCE_HZ, abs=0.05)


# playing


def test_claim_5_recorded_signals_are_compared_with_the_reference_and_move_the_machine(
    tape: Taped,
) -> None:
    played = thin(play(tape.file))
    assert distance(played, thin([tape.motion])).hausdorff_mm < 3 * UM
    assert np.abs(played.positions_mm[:, 2].min() + DEPTH_MM) < 3 * UM


def test_claim_6_the_reference_on_the_tape_drives_the_wheel_that_each_drive_is_fed_back_from(
    tape: Taped, tmp_path: Path
) -> None:
    frames, _ = soundfile.read(tape.file)
    with Tape.open(tape.file) as opened:
        told = opened.format
    with soundfile.SoundFile(tmp_path / "slow.wav", "w", 46_000, 4, "PCM_16") as slow:
        slow.comment = told.to_json()
        slow.write(frames)
    as_recorded, slower = thin(play(tape.file)), thin(play(tmp_path / "slow.wav"))
    # carriers and reference are both 4 % lower
    assert distance(slower, as_recorded).hausdorff_mm < 1 * UM
    assert slower.t_s[-1] == pytest.approx(as_recorded.t_s[-1] * 48 / 46, rel=1e-4)
    # each cell sees its wheel come by at the reference, and its own screw's turning on top of it: whole edges
    for edges, expected in edges_of_the_cells(play(tape.file)):
        assert np.abs(edges - expected).max() <= 1.1
    # the reference alone runs 0.1 % fast for two seconds: a wheel that turns so turns the screws
    warped = frames.copy()
    t_s = np.arange(len(frames)) / RATE_HZ
    ahead = 0.001 * REFERENCE_HZ * np.clip(t_s - 2, 0, 2)
    warped[:, 0] = 0.5 * np.sin(2 * np.pi * (REFERENCE_HZ * t_s + ahead))
    with soundfile.SoundFile(tmp_path / "warped.wav", "w", RATE_HZ, 4, "PCM_16") as out:
        out.write(warped)
    bare = play(tmp_path / "warped.wav", reference_hz=REFERENCE_HZ, cycles_per_mm=1 / Q_MM)
    moved = join(bare).positions_mm[4 * 6000 + 600] - (
        tape.motion.positions_mm[3 * 6000 + 600] - tape.motion.positions_mm[0]
    )
    assert moved == pytest.approx(-12 * Q_MM, abs=3 * UM)  # 12 cycles on every axis


def test_claim_7_the_contour_that_was_drawn_is_the_contour_that_is_cut(
    sheet: Drawing, run: Trace, tape: Taped
) -> None:
    assert cell_share(run) > 0.85
    found = deviation(sheet, thin(play(tape.file)))
    assert found.rms_mm < 4 * UM
    (cut,) = thin(play(tape.file)).runs()
    contour = cut[np.hypot(*(cut - [30, 30]).T) > 1.0]  # but where the lead line joins
    contour = contour[contour[:, 0] > 30]
    aside = np.hypot(*(contour - CENTRE_MM).T) - RADIUS_MM
    assert np.sqrt(np.mean(aside**2)) < 4 * UM and np.abs(aside).max() < 15 * UM
    assert (
        distance(
            cut, np.vstack([polyline((25, 30), (30, 30)), arc(CENTRE_MM, RADIUS_MM, 180, 540)])
        ).hausdorff_mm
        < 0.25
    )
