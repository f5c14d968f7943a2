"""What a page gets to draw: tiles, numbers of pixels, rows of a result, levels of a tape."""

from __future__ import annotations

import time
from pathlib import Path

import cv2
import numpy as np
import pytest

from morfax.jobs.lines import LinesJob
from morfax.jobs.settings.drawing_file import DrawingFile
from morfax.panel import result_data, sheet_data
from morfax.panel.lookout import STEP_MM, Lookout
from morfax.panel.tape_levels import levels
from morfax.panel.tiles import TILE, LineMap, Pyramid

SAMPLES = Path(__file__).parents[2] / "samples"


def unpacked(png: bytes) -> np.ndarray:
    """A PNG as pixels."""
    return cv2.imdecode(np.frombuffer(png, np.uint8), cv2.IMREAD_UNCHANGED)


def test_tiles_of_the_first_level_are_the_picture_itself() -> None:
    pixels = np.random.default_rng(1).integers(0, 256, (700, 1300), dtype=np.uint8)
    picture = Pyramid(pixels)
    assert len(picture.levels) == 3 and max(picture.levels[-1].shape) <= TILE
    assert (unpacked(picture.tile(0, 1, 0)) == pixels[:TILE, TILE : 2 * TILE]).all()
    assert unpacked(picture.tile(0, 2, 1)).shape == (700 - TILE, 1300 - 2 * TILE)
    for place in ((3, 0, 0), (0, 3, 0), (0, 0, 2), (0, -1, 0), (-1, 0, 0)):
        with pytest.raises(IndexError):
            picture.tile(*place)


def test_a_line_of_one_pixel_is_on_every_level_with_its_number() -> None:
    numbers = np.zeros((4000, 4100), np.uint16)
    numbers[1234], numbers[:, 2345] = 300, 7
    for level, half in enumerate(LineMap(numbers).levels):
        assert set(np.unique(half)) == {0, 7, 300}
        assert (half[1234 >> level] > 0).all() and (half[:, 2345 >> level] > 0).all()
    tile = unpacked(LineMap(numbers).tile(0, 0, 2))  # blue, green, red, alpha
    assert tile[1234 - 2 * TILE, 5].tolist() == [0, 300 >> 8, 300 & 255, 255]
    assert not tile[0, 0, 3]


def test_each_pixel_of_a_line_has_the_number_that_lines_prints() -> None:
    result = LinesJob(DrawingFile(SAMPLES / "bracket.png")).run()
    seen = sheet_data.of_lines(result)
    rows, pitch_mm = seen["rows"], seen["pitch_mm"]
    for line in result.figures["lines"]:  # type: ignore[union-attr]
        x, y = line["place_mm"]
        assert seen["numbers"][round(rows - y / pitch_mm), round(x / pitch_mm)] == line["line"]
    ink = result.drawing.darkness > 0.5
    assert (seen["numbers"][ink] > 0).mean() > 0.99  # specks apart
    assert seen["picture"] is None  # the scan itself


def test_the_lookout_keeps_the_way_at_even_steps() -> None:
    class Still:
        rate_hz, enlarged = 6000.0, 2.0

    turn = np.linspace(0, 2 * np.pi, 60_001)
    circle = (
        2.0 * 5.0 * np.column_stack([np.cos(turn), np.sin(turn)])
    )  # 5 mm, seen twice as large
    lookout = Lookout()
    for k in range(0, len(circle), 6000):
        lookout.moved(Still(), circle[k : k + 6000])  # type: ignore[arg-type]
    news = lookout.news(0)
    assert news is not None
    places = np.array(news["fresh"])
    steps_mm = np.hypot(*np.diff(places, axis=0).T)
    assert len(places) == pytest.approx(2 * np.pi * 5.0 / STEP_MM, abs=2)
    # a step is as long as stated but for one position (6 um here), and the millionths of a rounded place
    assert np.abs(steps_mm - STEP_MM).max() < 0.01
    assert np.abs(np.hypot(*places.T) - 5.0).max() < 0.001


def test_the_lookout_shows_the_way_of_a_head_that_is_taken_up() -> None:
    class TakenUp:
        rate_hz, enlarged = 6000.0, 1.0
        positions_mm = np.column_stack([np.linspace(0, 10, 6001), np.zeros(6001)])

    lookout = Lookout()
    lookout.set_pace(0.01)  # at which these positions would be waited for
    began = time.monotonic()
    lookout.taken_up(TakenUp())  # type: ignore[arg-type]
    assert time.monotonic() - began < 30.0  # s; at this pace the way would take 100
    assert lookout._fresh[0] == "down"  # another line than the one before
    assert len(lookout._fresh) == pytest.approx(1 + 10 / STEP_MM, abs=2)


def test_the_worst_places_are_apart() -> None:
    x = np.arange(0, 100, 0.5)
    error = np.where(x % 10 == 0, 0.1, 0.01)
    error[3] = np.nan
    worst = result_data.worst_places(np.column_stack([x, 0 * x]), error)
    assert len(worst) == result_data.WORST
    assert all(place["error_mm"] == 0.1 and place["x_mm"] % 10 == 0 for place in worst)


def test_a_dropout_is_a_dip_of_its_track(tmp_path: Path) -> None:
    import soundfile

    tone = 0.5 * np.sin(np.arange(96_000) / 3)[:, None] * np.ones(4)
    tone[48_000:52_000, 2] = 0.0
    soundfile.write(tmp_path / "a.wav", tone, 48_000)
    seen = levels(tmp_path / "a.wav")
    assert seen is not None and seen["tracks"] == ["reference", "X", "Y", "Z"]
    level, t_s = np.array(seen["level"]), np.array(seen["t_s"])
    # 0.5 / sqrt(2) but for the part of a wave at each end of a stretch
    assert np.abs(level[[0, 1, 3]] - 0.3536).max() < 0.03
    dip = t_s[level[2] < 0.1]
    assert dip.min() == pytest.approx(1.0, abs=0.01) and dip.max() == pytest.approx(
        1.083, abs=0.01
    )
    assert levels(tmp_path / "a.ngc") is None
    # the damage is where it is, on its track alone; without a format there is no deviation
    (damage,) = seen["damage"]
    assert damage["track"] == "Y" and damage["share"] < 0.1
    assert damage["from_s"] == pytest.approx(1.0, abs=0.003)
    assert damage["to_s"] == pytest.approx(1.0833, abs=0.003)
    assert seen["deviation_hz"] is None and seen["lock"] is None


def test_the_deviation_of_a_track_is_its_axis_speed_times_the_cycles(tmp_path: Path) -> None:
    """20 cycles to a mm: at 10 mm/s the carrier of X is 200 Hz off the reference."""
    from morfax.motion.motion import Path as MotionPath
    from morfax.recorder.media import record

    t_s = np.array([0.0, 1.0, 5.0, 6.0])
    places = np.zeros((4, 3))
    places[2:, 0] = 40.0
    record(MotionPath(t_s, places).motion(), tmp_path / "a.wav")
    seen = levels(tmp_path / "a.wav")
    assert seen is not None
    deviation_hz = np.array(seen["deviation_hz"])
    under_way = np.abs(deviation_hz[0]) > 150
    assert np.abs(deviation_hz[0][under_way]).mean() == pytest.approx(200.0, rel=0.02)
    assert 0.3 < under_way.mean() < 0.7 and np.abs(deviation_hz[1:]).max() < 2.0
    # it starts at once, which the predictor does not expect; the page says "in doubt" from here on
    assert np.max(seen["lock"]) < 0.25 and not seen["damage"]
