"""Whole programs under the pulse control: played to the pulse, refused, compiled as plain, and watched."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from morfax.motion.drive import Condition
from morfax.motion.faults import FollowingFault, ProgramFault
from morfax.motion.motion import join
from morfax.player.gcode import feed_control, pulse_servo, residues
from morfax.player.gcode.feed_control import (
    count_feed,
    feed_number,
    override_number,
)
from morfax.player.gcode.pulse_servo import HISTORIC, PulseServo, PulseServos
from morfax.player.gcode.pulses import PulseControl, play_pulses
from morfax.player.gcode.residues import Feed, ResidueInterpolator
from tests.player.gcode.pulse_control import RECIRCULATIONS_HZ, playback

PULSE_MM = PulseServo().pulse_mm


def test_a_program_is_played_to_its_pulse() -> None:
    run = playback(
        "G0 X10 Y10 Z2",
        "G1 Z-1 F300",
        "G1 X30 F600",
        "G3 X40 Y20 J10",
        "G2 X40 Y20 I5",
        "G4 P0.1",
        "G1 X10 Y10",
        "G0 Z2",
    )
    motion = join(run)
    assert run.start_mm.tolist() == [10, 10, 2]
    assert np.abs(run.end_error_mm).max() <= PULSE_MM
    assert np.abs(motion.positions_mm[0] - run.start_mm).max() <= PULSE_MM
    assert motion.duration_s == pytest.approx(run.duration_s, rel=0.15)
    assert (run.following_error_mm > 0).all()
    circle = motion.positions_mm[motion.positions_mm[:, 0] > 40.01, :2]
    # 4 of the arc, 1 of the servo
    assert np.abs(np.hypot(*(circle - [45, 20]).T) - 5).max() < 5 * PULSE_MM
    assert circle.max(axis=0) == pytest.approx(
        [50, 25], abs=5 * PULSE_MM
    )  # a whole turn, in three arcs


def test_it_plays_again_as_before() -> None:
    run = playback("G1 X0 Y0 F600", "G2 X3 Y3 R3")
    assert (join(run).positions_mm == join(run).positions_mm).all()


def test_what_cannot_be_run_is_refused_before_anything_moves() -> None:
    with pytest.raises(
        ProgramFault, match=r"line 2: X goes to 2000.100 mm; the machine has ±2000.000 mm"
    ):
        playback("G1 X0 F600", "G1 X2000.1")
    with pytest.raises(
        ProgramFault, match=r"line 2: X goes to 900.000 mm; the registers of 16 bits hold ±832"
    ):
        playback("G1 X0 F600", "G1 X900", control=PulseControl(servo=HISTORIC))
    with pytest.raises(
        ProgramFault,
        match=r"line 1: F9000: a speed of 150000 pulses/s has no feed number; give 0.256 to",
    ):
        playback("G1 X5 F9000")
    with pytest.raises(ValueError, match="the override is 2; give"):
        playback("G1 X5 F600", control=PulseControl(override=2.0))


@pytest.mark.parametrize(
    ("start", "arc", "axis"),
    [
        ((1995, -50), "G3 X1995 Y50 R70.71", "X goes to 2015.7"),
        ((-1995, 50), "G3 X-1995 Y-50 R70.71", "X goes to -2015.7"),
        ((50, 1995), "G3 X-50 Y1995 R70.71", "Y goes to 2015.7"),
        ((-50, -1995), "G3 X50 Y-1995 R70.71", "Y goes to -2015.7"),
        ((1995, 50), "G2 X1995 Y-50 R70.71", "X goes to 2015.7"),
    ],
)
def test_an_arc_that_bulges_out_of_the_travel_is_refused(
    start: tuple[int, int], arc: str, axis: str
) -> None:
    """Both ends lie within the ± 2000 mm, the arc 15.7 mm outside; 25 mm further in all of it fits."""
    x, y = start
    lines = f"G1 X{x} Y{y} F600", arc
    with pytest.raises(ProgramFault, match=axis):
        playback(*lines)
    playback(*(line.replace("1995", "1970") for line in lines))


@pytest.mark.parametrize("sign", ["", "-"])
def test_an_arc_that_does_not_come_to_its_outermost_place_may_have_that_outside(
    sign: str,
) -> None:
    """From 60 to 120 degrees round 1960, 0 mm with 50 mm; at 0 degrees it would be at 2010 mm."""
    code = "G2" if sign else "G3"
    first, last = f"G1 X{sign}1985 Y43.3013 F600", f"{code} X{sign}1935 Y43.3013 R50"
    (x, y), *_ = [move.centre_mm for move in playback(first, last).program.moves[1:]]
    assert (abs(x), y) == pytest.approx((1960, 0), abs=0.001)


@pytest.mark.parametrize("speed", [0.0, -1.0, math.inf, math.nan, 1e9])
def test_a_speed_without_a_feed_number_is_refused(speed: float) -> None:
    with pytest.raises(ValueError, match=r"has no feed number; give"):
        feed_number(speed, RECIRCULATIONS_HZ)


def test_arcs_that_are_none_are_refused() -> None:
    with pytest.raises(ValueError, match="helix"):
        ResidueInterpolator().arc((1, 1, 1), (0, 1), 1, Feed())
    with pytest.raises(ValueError, match="not 0"):
        ResidueInterpolator().arc((1, 1, 0), (0, 1), 0, Feed())
    with pytest.raises(ValueError, match="L = 0"):
        ResidueInterpolator(servo_constant=0)


def test_a_file_is_played(tmp_path: Path) -> None:
    file = tmp_path / "part.ngc"
    file.write_text("G1 X0 F600\nG1 X1\nM2\n")
    assert play_pulses(file, start_mm=(0, 5, 0)).start_mm.tolist() == [0, 5, 0]


def test_the_compiled_kernels_are_the_plain_ones(monkeypatch: pytest.MonkeyPatch) -> None:
    feed = Feed(feed_number(12_000, RECIRCULATIONS_HZ), override_number(0.7))
    results = []
    for plain in (False, True):
        if plain:
            monkeypatch.setattr(residues, "_recirculate", residues._recirculate.py_func)
            monkeypatch.setattr(pulse_servo, "_follow", pulse_servo._follow.py_func)
            monkeypatch.setattr(residues, "AT_ONCE", 4096)
        interpolator = ResidueInterpolator()
        pulses = np.vstack(
            [
                interpolator.line((120, -30, 4), feed),
                interpolator.arc((80, 10, 4), (100, -30), 1, feed),
            ]
        )
        commands, places, done = PulseServos(np.zeros(3, np.int64), RECIRCULATIONS_HZ).follow(
            pulses
        )
        results.append((pulses, commands, places, done))
    for compiled, interpreted in zip(*results, strict=True):
        assert np.abs(np.asarray(compiled) - interpreted).max() < 1e-12
    assert count_feed.py_func(64, feed.number, feed.override) == count_feed(
        64, feed.number, feed.override
    )
    assert (
        sum(feed_control.passes.py_func(count, 0b1101, 4) for count in range(1, 17)) == 0b1101
    )


@pytest.mark.parametrize(("speed_mm_s", "limit_mm"), [(0, 0.054), (10, 0.084), (40, 0.294)])
def test_the_limit_is_the_lag_the_start_and_54_um(speed_mm_s: float, limit_mm: float) -> None:
    """v / 500 per s, v² / 2 · 5 m/s², and 50 um with four pulses of 1 um."""
    assert PulseControl().limit.limit_mm(speed_mm_s) == pytest.approx(limit_mm, abs=PULSE_MM)


@pytest.mark.parametrize("speed_mm_s", [20, 40])
def test_a_sound_drive_takes_more_than_a_third_of_its_limit(speed_mm_s: float) -> None:
    """A limit three times too wide leaves a drive alone that is three times as far behind as a sound one."""
    run = playback(f"G1 X0 Y0 F{60 * speed_mm_s}", "G1 X20 Y12")
    list(run)
    assert 0.36 < run.monitor.largest_share[0] < 0.9  # measured 0.40 and 0.68
    run.conditions[0] = Condition(gain_share=0.2)
    with pytest.raises(FollowingFault, match="X does not follow"):
        list(run)


@pytest.mark.parametrize("speed_mm_s", [5, 20, 30, 40])
def test_a_start_at_once_at_any_feed_passes_the_monitor(
    tmp_path: Path, speed_mm_s: float
) -> None:
    file = tmp_path / "fast.ngc"
    file.write_text(
        f"G21 G90 G94\nG0 X0 Y0 Z0\nG1 X20 F{60 * speed_mm_s}\nG1 X20 Y20\nG1 X0\nM2\n"
    )
    run = play_pulses(file)
    assert list(run) and run.end_error_mm == pytest.approx([0, 0, 0], abs=0.002)
    assert run.monitor.largest_share.max() < 0.9
