"""The head on clean lines: where its axis goes, how fast, and that nothing but the line decides it.

The drawings are clean, so that what is left is the head's own error. A line at 300 dpi that runs along the
pixels is seen 5 um off its middle, as straight interpolation between pixels of 85 um has it; on any other
line that averages out.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
import pytest

from morfax.motion.arrays import Array
from morfax.motion.contour import distance
from morfax.motion.drive import Drive
from morfax.motion.motion import MOTION_RATE_HZ
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.following.followed import Followed
from morfax.tracer.following.follower import Follower
from morfax.tracer.following.start import put_down
from morfax.tracer.head import kernel, screws
from morfax.tracer.head.settings import Settings
from morfax.tracer.head.state import FLOATS, MORE, Home
from morfax.tracer.program.trace import Trace, trace
from tests.tracer.inked import UM, arc, inked, polyline

SPEED_MM_S = Settings().speed_mm_s
ALONG_PIXELS_MM = 6 * UM


def aslant(deg: float, length_mm: float = 16.0) -> Array:
    """A straight line about (14, 14) mm."""
    way = 0.5 * length_mm * np.array([math.cos(math.radians(deg)), math.sin(math.radians(deg))])
    return np.array([14.0, 14.0]) + np.array([-way, way])


def wave(length_mm: float = 40.0) -> Array:
    """A sine of 1 mm whose wavelength falls from 20 to 9 mm: bends to 2 mm of radius, changing throughout."""
    x = np.linspace(0, length_mm, 100 * int(length_mm))
    return np.column_stack([x + 4, 6 + np.sin(2 * np.pi * (x / 20 + x * x / 1333))])


def speeds_mm_s(positions_mm: Array) -> Array:
    """Resultant speed from sample to sample."""
    return np.asarray(np.hypot(*np.diff(positions_mm, axis=0).T) * MOTION_RATE_HZ)


def followed(drawing: Drawing, settings: Settings | None = None, **tuning: float) -> Followed:
    """Put a head down by itself and follow, with its tuning changed by hand."""
    settings = settings or Settings()
    stance, length_mm = next(iter(put_down(drawing, settings=settings)))
    follower = Follower(stance, settings, MOTION_RATE_HZ)
    follower.carriage.tuning = follower.carriage.tuning._replace(**tuning)
    return follower.follow(2 * length_mm)


def off_mm(trace: Trace, line: Array, last: float = 0.3) -> Array:
    """Distance of the path from a straight line, its ends left out, mm."""
    way = (line[1] - line[0]) / np.hypot(*(line[1] - line[0]))
    rest = trace.xy_mm - line[0]
    inner = (rest @ way > last) & (rest @ way < np.hypot(*(line[1] - line[0])) - last)
    return np.asarray((rest @ np.array([-way[1], way[0]]))[inner])


# where it goes


@pytest.mark.parametrize("deg", [0, 13, 30, 45, 77, 90, 135, 200, 300])
def test_a_straight_line_is_followed_along_its_middle(deg: float) -> None:
    line = aslant(deg)
    run = trace(inked(line))
    assert run.ending == "ended"
    assert np.abs(off_mm(run, line)).max() < (ALONG_PIXELS_MM if deg % 90 == 0 else 3 * UM)


@pytest.mark.parametrize("radius_mm", [3.0, 5.0, 10.0, 20.0])
def test_a_circle_is_followed_round_and_closes_without_an_overlap(radius_mm: float) -> None:
    middle = radius_mm + 4
    run = trace(inked(arc((middle, middle), radius_mm)))
    assert run.ending == "closed"
    assert np.hypot(*(run.xy_mm[-1] - run.xy_mm[0])) < 20 * UM  # as the issue asks
    assert run.length_mm == pytest.approx(
        math.tau * radius_mm, rel=0.002
    )  # once round, neither more nor less
    angle = np.unwrap(np.arctan2(*(run.xy_mm - middle).T[::-1]))
    assert np.ptp(angle) * radius_mm == pytest.approx(math.tau * radius_mm, abs=20 * UM)
    radial = np.hypot(*(run.xy_mm - middle).T) - radius_mm
    assert np.abs(radial).max() < ALONG_PIXELS_MM
    assert radial.std() < 1.5 * UM  # round wherever the pixels lie


def test_a_line_whose_bend_changes_is_followed_along_its_middle() -> None:
    run = trace(inked(wave()))
    apart = distance(run.xy_mm[::4], wave())
    assert (
        apart.path_to_reference.rms_mm < 4 * UM
    )  # the figure for smooth lines, with a scanner's noise
    assert apart.path_to_reference.max_mm < 12 * UM
    assert np.sort(run.xy_mm[[0, -1], 0]) == pytest.approx(
        [4, 44], abs=30 * UM
    )  # from end to end


def test_noise_of_the_paper_is_averaged_along_the_line() -> None:
    """4 % noise on each pixel of 85 um: an edge found in one row of pixels would be off by 5 um RMS."""
    middle = 14.0
    clean, noisy = (
        trace(inked(arc((middle, middle), 10), seed=seed)).xy_mm for seed in (None, 5)
    )
    added = np.interp(np.linspace(-3, 3, 2000), *_by_angle(noisy - middle)) - np.interp(
        np.linspace(-3, 3, 2000), *_by_angle(clean - middle)
    )
    assert added.std() < 2.5 * UM


def _by_angle(places: Array) -> tuple[Array, Array]:
    """Angles in rising order and the radius at each."""
    angle = np.arctan2(places[:, 1], places[:, 0])
    order = np.argsort(angle)
    return angle[order], np.hypot(*places[order].T)


# what does not decide where it goes


@pytest.mark.parametrize("radius_mm", [5.0, 10.0])
def test_the_path_does_not_depend_on_where_the_head_is_put_down(radius_mm: float) -> None:
    middle = radius_mm + 4
    drawing = inked(arc((middle, middle), radius_mm))
    paths = [
        trace(
            drawing, (middle + radius_mm * math.cos(a), middle + radius_mm * math.sin(a))
        ).xy_mm[::4]
        for a in np.arange(8) * math.pi / 4
    ]
    for path in paths[1:]:
        assert distance(path, paths[0]).path_to_reference.rms_mm < 1.5 * UM
        assert (
            distance(path, paths[0]).hausdorff_mm < 8 * UM
        )  # at the start, where less of the line has been seen


@pytest.mark.parametrize("lag_s", [0.0005, 0.002, 0.004])
@pytest.mark.parametrize("corner", [False, True])
def test_the_drives_lag_turns_no_corner(lag_s: float, corner: bool) -> None:
    """The path is the same with 1 ms as with 4 ms, by which the screws stay 40 um behind their demand."""
    line = polyline((4, 4), (16, 4), (16, 16)) if corner else wave(20.0)
    drawing = inked(line)
    as_usual, lagging = (
        trace(drawing, settings=Settings(drive=Drive(lag_s=lag))).xy_mm
        for lag in (0.001, lag_s)
    )
    assert (
        distance(lagging[::4], as_usual[::4]).hausdorff_mm < 4 * UM
    )  # a tenth of what the screws owe


def test_the_lengthwise_part_of_the_sweep_makes_no_false_offset() -> None:
    """mf_scan: it turns the carrier's phase, and nothing else."""
    line = aslant(13)
    narrow, wide = (followed(inked(line), along_mm=along).positions_mm for along in (0.0, 0.3))
    assert (
        distance(wide[::4], narrow[::4]).hausdorff_mm < 1 * UM
    )  # the head is not quite on the line's heading


def test_the_same_drawing_gives_the_same_path() -> None:
    drawing = inked(wave(20.0), seed=2)
    assert np.array_equal(trace(drawing).xy_mm, trace(drawing).xy_mm)


# how fast


@pytest.mark.parametrize("seed", [None, 1])
def test_the_resultant_speed_is_the_same_in_every_direction(seed: int | None) -> None:
    """Potentiometer 59: sine and cosine of the heading; on a bend the drives lag by 1 ms, which is 2e-6 of
    the speed.
    """
    speed = speeds_mm_s(trace(inked(arc((9, 9), 5), seed=seed)).xy_mm)
    rise = round(1.5 * SPEED_MM_S / Settings().acceleration_mm_s2 * MOTION_RATE_HZ)
    assert speed[rise:-rise] == pytest.approx(SPEED_MM_S, rel=1e-4)


@pytest.mark.parametrize("speed_mm_s", [2.0, 5.0, 20.0])
def test_the_tracing_speed_can_be_set(speed_mm_s: float) -> None:
    run = trace(inked(arc((14, 14), 10)), settings=Settings(speed_mm_s=speed_mm_s))
    assert np.median(speeds_mm_s(run.xy_mm)) == pytest.approx(speed_mm_s, rel=1e-3)
    radial = np.hypot(*(run.xy_mm - 14).T) - 10
    assert np.abs(radial).max() < ALONG_PIXELS_MM + 4 * UM


def test_the_look_ahead_slows_the_head_before_a_corner_and_lets_go_after_it() -> None:
    run = trace(inked(polyline((4, 4), (16, 4), (16, 16))), start_mm=(4.0, 4.0))
    speed, at = speeds_mm_s(run.xy_mm), run.xy_mm[1:]
    come = np.r_[0.0, np.cumsum(speed[:-1]) / MOTION_RATE_HZ]
    vertex = int(np.argmin(np.hypot(*(at - [16, 4]).T)))
    before = come[vertex] - come
    assert speed[(before > 3.5) & (before < 8)] == pytest.approx(SPEED_MM_S, rel=1e-3)
    slowed = speed[
        (before > 1.2) & (before < 1.7)
    ]  # cell 102, 1.85 mm ahead, sees the paper beyond the corner's ink
    assert slowed.min() == pytest.approx(Settings().slowed * SPEED_MM_S, rel=1e-3)
    assert speed[np.abs(before) < 0.02].min() < 0.001 * SPEED_MM_S  # it stands to swivel
    assert speed[(before < -3) & (before > -8)] == pytest.approx(SPEED_MM_S, rel=1e-3)


def test_no_drive_is_asked_for_more_than_its_acceleration() -> None:
    run = trace(inked(polyline((4, 4), (16, 4), (16, 16))))
    change = np.diff(run.xy_mm, 2, axis=0) * MOTION_RATE_HZ**2
    assert np.abs(change).max() <= Drive().acceleration_mm_s2 * 1.001


# the kernels


@pytest.fixture
def plain_head(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """All kernels of the head as plain Python."""
    for module in (kernel, screws):
        for name, function in vars(module).copy().items():
            if hasattr(function, "py_func"):
                monkeypatch.setattr(module, name, function.py_func)
    yield


def _some_steps(drawing: Drawing) -> tuple[Array, Array]:
    """A head's state and positions after following for 40 ms, running round a corner from memory and
    standing.
    """
    stance, _ = next(iter(put_down(drawing, settings=Settings(aperture_mm=0.15))))
    follower = Follower(stance, Settings(), MOTION_RATE_HZ)
    out = np.zeros((400, 2))
    cells, tuning, state = (
        follower.view.cells,
        follower.carriage.tuning,
        follower.carriage.state,
    )
    home = Home(0.0, 0.0, 0.0, from_travel_mm=1e9)
    n, why = kernel.follow(cells, state, tuning, home, out[:240])
    assert (n, why) == (240, MORE)
    begin = np.array([state.x_mm, state.y_mm])
    way = begin + np.array([[0.0, 0.0], [0.2, 0.0], [0.2, 0.2]])
    n += screws.run(state, tuning, way, np.array([10.0, 2.0, 0.0]), out[240:360])
    screws.stand(state, tuning, out[360:])
    return np.array([state[name] for name in (*FLOATS, "sweep_periods", "places")]), out


def test_compiled_and_plain_head_do_the_same(request: pytest.FixtureRequest) -> None:
    drawing = inked(arc((14, 14), 10), seed=3)
    state, positions = _some_steps(drawing)
    request.getfixturevalue("plain_head")
    plain_state, plain_positions = _some_steps(drawing)
    assert plain_positions == pytest.approx(
        positions, abs=1e-6 * UM
    )  # the order of floating-point sums
    assert plain_state == pytest.approx(state, abs=1e-6)
