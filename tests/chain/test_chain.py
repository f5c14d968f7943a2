"""The whole way round: a drawing is traced, the motion recorded, the tape played, and the played contour is
the drawn one.

Bounds of drawings are the issue's; where it is measured to be far better, the bound stands at about one and a
half times what was measured (in brackets, RMS/largest, um), so that a change for the worse is seen. Distances
are exact, between polylines, of `motion.contour`.
"""

from __future__ import annotations

import importlib.util
import math
from dataclasses import dataclass
from pathlib import Path as FilePath
from types import ModuleType

import numpy as np
import pytest
from PIL import Image

from morfax.motion.arrays import Array
from morfax.motion.contour import distance, length_mm
from morfax.motion.motion import Path, thin
from morfax.player.tape.playback import play
from morfax.recorder.tape.tape import TapeFormat, record
from morfax.tracer.drawing.deviation import deviation
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.program.program import Trace
from morfax.tracer.program.trace import trace
from morfax.tracer.program.trace_lines import trace_lines
from tests.chain.holding import hold
from tests.conftest import SHARED, beside
from tests.tracer.inked import UM, polyline

SAMPLES = FilePath(__file__).parents[2] / "samples"
# issue 0.5/3 um (0.07/0.8, the following error where it stops)
PLAYED_RMS_MM, PLAYED_MAX_MM = (0.15 * UM, 1.5 * UM)
CLOSED_WITHIN_MM = 20 * UM


@dataclass(frozen=True)
class Case:
    """A drawing and what its path must reach against the truth: RMS and largest distance, mm."""

    name: str
    rms_mm: float
    max_mm: float
    ending: str = "closed"
    loops: tuple[int, ...] | None = None
    size_mm: float | None = None
    dpi: float = 300.0
    scan: bool = True
    skew_deg: float = 0.0
    seed: int = 1

    def __str__(self) -> str:
        return f"{self.name}-{self.dpi:g}dpi" + (
            f"-{self.skew_deg:g}deg" if self.skew_deg else ""
        )


def taped(run: Trace, file: FilePath) -> Path:
    """Record a trace and play the tape."""
    record(run, file, TapeFormat())
    return thin(play(file))


# the samples


SHARP_AND_SMOOTH = [
    Case("cam", 4 * UM, 15 * UM),
    Case("curve", 4 * UM, 30 * UM, "ended"),  # an end is seen in the pen's round, 30 um
    Case("bracket", 4 * UM, 25 * UM),
    Case("gear", 5 * UM, 40 * UM),
]


@pytest.mark.parametrize("case", SHARP_AND_SMOOTH, ids=str)
def test_a_sample_comes_off_the_machine_as_it_was_drawn(tmp_path: FilePath, case: Case) -> None:
    drawing = Drawing.open(SAMPLES / f"{case.name}.png")
    truth = np.loadtxt(SAMPLES / f"{case.name}.csv", delimiter=",", skiprows=1)
    truth = truth[truth[:, 0] == 0, 1:]  # the outline; the bracket's slot is another line
    run = trace(drawing)
    played = taped(run, tmp_path / "tape.wav")
    assert run.ending == case.ending
    hold(distance(played, truth), case.rms_mm, case.max_mm)
    hold(distance(played, thin(run)), PLAYED_RMS_MM, PLAYED_MAX_MM)
    assert length_mm(played) == pytest.approx(
        length_mm(truth), rel=0.002
    )  # once, nothing doubled
    if case.ending == "closed":
        assert all(math.dist(way[0], way[-1]) < CLOSED_WITHIN_MM for way in played.runs())
    found = deviation(drawing, played)
    assert found.rms_mm < 5 * UM  # the other measure, of the ink and not of the truth, agrees
    assert np.ptp(played.positions_mm[:, 2]) == pytest.approx(
        7.0, abs=1 * UM
    )  # 2 above to 5 below


def test_a_drawn_program_comes_off_the_machine_in_order(tmp_path: FilePath) -> None:
    """Lead-in, contour, tick: one ordered path, stopped within 50 um of the tick's centre (issue), as the
    tape is played.
    """
    truth = np.loadtxt(SAMPLES / "program.csv", delimiter=",", skiprows=1)
    lead, plate = (truth[truth[:, 0] == k, 1:] for k in (0, 1))
    run = trace(Drawing.open(SAMPLES / "program.png"))
    played = taped(run, tmp_path / "tape.wav")
    hold(distance(played, thin(run)), PLAYED_RMS_MM, PLAYED_MAX_MM)
    way = np.vstack([lead, plate, lead[::-1]])
    assert length_mm(played.xy_mm) == pytest.approx(
        2 * length_mm(lead) + length_mm(plate), rel=0.005
    )  # once
    hold(distance(played.xy_mm, way), 15 * UM, 60 * UM)  # largest at the join, in its ink
    steps_mm, steps_s = np.hypot(*np.diff(played.xy_mm, axis=0).T), np.diff(played.t_s)
    slow = steps_mm / steps_s < 0.05  # mm/s
    for centre in ((21.5, 23.0), (70.5, 21.0)):
        near = np.hypot(*(played.xy_mm[1:] - centre).T) < 50 * UM
        assert steps_s[slow & near].sum() > 0.4  # half a second, or the time that Z takes
    assert played.xy_mm[-1] == pytest.approx(lead[0], abs=50 * UM)


# real parts, drawn and scanned


PARTS = [
    Case("v04_star.ngc", 3.5 * UM, 16 * UM),  # issue 4/25 um (2.3/10)
    Case("v16_spiral_open.dxf", 4 * UM, 25 * UM, "ended"),  # issue 4/25 um (3.0/22: its ends)
    Case("v01_scroll_fixed.ngc", 4 * UM, 40 * UM),  # issue 4/40 um (3.1/16)
    Case("v07_wrench_plasma.ngc", 4 * UM, 40 * UM, "", (0,)),  # issue 25/250 um (2.3/22)
    Case("v13_fork_part.dxf", 4 * UM, 25 * UM, loops=(0,)),  # issue 25/250 um (2.2/12)
    Case(
        "v21_voron_deck.dxf", 4 * UM, 40 * UM, size_mm=100.0
    ),  # issue 25/250 um at 200 mm (2.1/11)
    Case("v06_dolphin.ngc", 5 * UM, 70 * UM),  # issue 60/700 um, sharp tips (2.8/22)
    Case("v11_stretching_cat.dxf", 7 * UM, 150 * UM),  # issue 60/700 um, sharp tips (3.7/93)
    Case("v04_star.ngc", 1.6 * UM, 10 * UM, dpi=600.0, scan=False),  # issue 2.5 um RMS (1.0/6)
    Case(
        "v16_spiral_open.dxf", 2.5 * UM, 15 * UM, "ended", dpi=600.0, scan=False
    ),  # issue 2.5 um RMS (2.1/6)
    Case(
        "v01_scroll_fixed.ngc", 2.5 * UM, 15 * UM, dpi=600.0, scan=False
    ),  # issue 2.5 um RMS (2.3/10)
    Case(
        "v04_star.ngc", 4 * UM, 25 * UM, skew_deg=7.0, seed=2
    ),  # turned on the sheet, other noise: issue 4/25 um
]


@pytest.fixture(scope="module")
def render() -> ModuleType:
    """The script that draws the parts."""
    file = beside(SHARED / "drawings" / "render.py")
    spec = importlib.util.spec_from_file_location("render", file)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def drawn(
    case: Case, render: ModuleType, folder: FilePath, line_mm: float = 0.5
) -> tuple[Drawing, list[Array]]:
    """A part as an image file, opened, and its truth on the sheet."""
    truth = FilePath(render.__file__ or "").parent / "truth" / f"{case.name}.csv"
    loops = render.read_truth(truth, None if case.loops is None else set(case.loops))
    loops, sheet_mm = render.place(loops, 8.0, case.size_mm, case.skew_deg)
    ink = render.ink(loops, sheet_mm, case.dpi, line_mm)
    image = render.photograph(ink, case.dpi, case.scan, np.random.default_rng(case.seed))
    file = folder / "part.png"
    Image.fromarray(image).save(file, dpi=(case.dpi, case.dpi), compress_level=1)
    return Drawing.open(file), list(loops.values())


@pytest.mark.parametrize("case", PARTS, ids=str)
def test_a_part_is_one_path_nothing_missed_nothing_doubled(
    tmp_path: FilePath, render: ModuleType, case: Case
) -> None:
    drawing, truth = drawn(case, render, tmp_path)
    run = trace(drawing)
    assert run.fault is None and run.ending == (case.ending or run.ending)
    hold(distance(run.xy_mm[::6], truth), case.rms_mm, case.max_mm)
    assert run.length_mm == pytest.approx(
        length_mm(truth), rel=0.01
    )  # the cat has spikes narrower than the pen
    if run.ending == "closed":
        assert np.hypot(*(run.xy_mm[-1] - run.xy_mm[0])) < CLOSED_WITHIN_MM


@pytest.mark.parametrize("case", [PARTS[0], PARTS[3], PARTS[6]], ids=str)
def test_a_part_is_played_as_it_was_traced(
    tmp_path: FilePath, render: ModuleType, case: Case
) -> None:
    drawing, truth = drawn(case, render, tmp_path)
    run = trace(drawing)
    playback_file = tmp_path / "part.wav"
    played = taped(run, playback_file)
    hold(distance(played, thin(run)), PLAYED_RMS_MM, PLAYED_MAX_MM)
    hold(distance(played, truth), case.rms_mm, case.max_mm)


# several lines


def test_the_bracket_comes_off_the_machine_with_its_slot_cut_first(tmp_path: FilePath) -> None:
    truth = np.loadtxt(SAMPLES / "bracket.csv", delimiter=",", skiprows=1)
    run = trace_lines(Drawing.open(SAMPLES / "bracket.png"))
    runs = taped(run, tmp_path / "tape.wav").runs()
    assert [line.number for line in run.lines] == [2, 1] and len(runs) == 2
    for played, loop in zip(runs, (1, 0), strict=True):
        hold(distance(played, truth[truth[:, 0] == loop, 1:]), 4 * UM, 25 * UM)


@pytest.mark.parametrize("line_mm", [0.3, 0.8])
def test_all_fifteen_lines_of_a_panel_are_one_program(
    tmp_path: FilePath, render: ModuleType, line_mm: float
) -> None:
    """Issue 15/200 um (4.0/26 at 0.3 mm, 3.9/22 at 0.8), with holes of 3.2 and 4 mm."""
    drawing, truth = drawn(
        Case("v18_front_panel.dxf", 6 * UM, 40 * UM), render, tmp_path, line_mm
    )
    run = trace_lines(drawing)
    assert (
        run.fault is None
        and [line.ending for line in run.lines] == ["closed"] * 15
        and run.lines[-1].number == 1
    )
    hold(distance(thin(run), truth), 6 * UM, 40 * UM)
    assert run.length_mm == pytest.approx(sum(length_mm(loop) for loop in truth), rel=0.002)


def test_a_path_beside_the_truth_is_not_let_through() -> None:
    """The measure itself: 20 um aside, half the line, the line run twice as far."""
    line = polyline((0, 0), (10, 0), (10, 10))
    aside, half = line + np.array([0.02, -0.02]), line[:2]
    with pytest.raises(AssertionError):
        hold(distance(aside, line), 5 * UM, 40 * UM)
    with pytest.raises(AssertionError):
        hold(distance(half, line), 5 * UM, 40 * UM)
    assert length_mm(np.vstack([line, line[::-1]])) == pytest.approx(2 * length_mm(line))
