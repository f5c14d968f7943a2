"""Patent ES 361967 (Morfax, 1969): one test for each of its 17 claims, on the running system.

`docs/background/claims-morfax.md` has the table from claim to test. The sheet is the patent's draftsman's: a
reference point, a lead line with a stop mark just before the contour, the contour, a stop mark on it.

       ┼──────┼──── contour ──┼── and back          drawn with 0.5 mm, scanned at 300 dpi with noise

What is on the tape is heard here with nothing of the project's own: a counter of zero crossings.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
import soundfile
from numpy.typing import NDArray

from morfax.jobs.remarks.who_led import WhoLed
from morfax.motion.arrays import Array
from morfax.motion.axis import LeadScrew
from morfax.motion.contour import distance
from morfax.motion.drive import Condition, Drive
from morfax.motion.faults import FollowingFault, LockFault
from morfax.motion.motion import MOTION_RATE_HZ, Motion, join, thin
from morfax.motion.ramp import positions_mm
from morfax.player.tape.playback import TapePlayback, play
from morfax.player.tape.sector_wheel import SectorWheel
from morfax.recorder.tape.pickups import PICK_UPS
from morfax.recorder.tape.tape import Tape, TapeFormat, record
from morfax.tracer.drawing.deviation import deviation
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.following.start import put_down
from morfax.tracer.head.carriage import Carriage
from morfax.tracer.head.settings import HISTORIC, Settings
from morfax.tracer.head.state import Home
from morfax.tracer.operator import zunit
from morfax.tracer.operator.card import Card, Stop
from morfax.tracer.operator.operator import Operator
from morfax.tracer.operator.work import Halt, Work
from morfax.tracer.operator.zunit import (
    Counters,
    Preset,
    QuillMove,
    coincidence,
    counts_of,
    z_moves,
)
from morfax.tracer.program.program import Trace
from morfax.tracer.program.trace import trace
from morfax.tracer.sensing.photocell import behind_aperture, sweep
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


@pytest.fixture(scope="module")
def sheet() -> Drawing:
    cross = [polyline((10.8, 30), (13.2, 30)), polyline((12, 28.8), (12, 31.2))]
    ticks = [polyline((25, 28.5), (25, 31.5)), polyline((40, 38.5), (40, 41.5))]
    return inked(
        arc(CENTRE_MM, RADIUS_MM), polyline((12, 30), (30, 30)), *cross, *ticks, seed=1969
    )


@pytest.fixture(scope="module")
def run(sheet: Drawing) -> Trace:
    """The follower's run over the whole sheet."""
    return trace(
        sheet,
        settings=Settings(speed_mm_s=SPEED_MM_S),
        operator=Operator(Work(depth_mm=DEPTH_MM)),
    )


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


@pytest.fixture(scope="module")
def tape(run: Trace, tmp_path_factory: pytest.TempPathFactory) -> Taped:
    return taped(join(run), tmp_path_factory.mktemp("morfax") / "program.wav")


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


# the methods


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


# the apparatus


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


# the machine


def tones(file: Path, *hz: float, seconds: float = 2.0) -> Path:
    """A tape of tones alone, one to a track, made without the recorder and without a format."""
    t_s = np.arange(round(seconds * RATE_HZ)) / RATE_HZ
    # from one frequency to its own within a tenth of a second, as no motor starts at once
    gently = np.where(t_s < 0.1, 5 * t_s**2, t_s - 0.05)
    tracks = [0.5 * np.sin(2 * np.pi * (hz[0] * t_s + (one - hz[0]) * gently)) for one in hz]
    soundfile.write(file, np.column_stack(tracks), RATE_HZ, subtype="PCM_16")
    return file


def test_claim_15_each_axis_moves_as_its_frequency_is_above_or_below(tmp_path: Path) -> None:
    for given, mm_s in (
        ((6000, 6200, 5900, 6040), (10, -5, 2)),
        ((6000, 6200, 5900), (10, -5, 0)),
    ):  # Z if there is one
        played = join(
            play(tones(tmp_path / "a.wav", *given), reference_hz=6000, cycles_per_mm=20)
        ).positions_mm
        assert (played[11_000] - played[5_000]).tolist() == pytest.approx(
            list(mm_s), abs=1 * UM
        )  # in one second


def test_claim_16_the_reference_from_the_tape_turns_the_wheel_of_every_axis(
    tmp_path: Path,
) -> None:
    """A tape on which everything is 2 % high means the same motion; one whose reference alone is 20 Hz off
    moves all axes.
    """
    high = tones(tmp_path / "a.wav", 6120, 6120 + 204, 6120 - 102, 6120)
    played = join(play(high, reference_hz=6000, cycles_per_mm=20)).positions_mm
    assert (played[11_000] - played[5_000]).tolist() == pytest.approx(
        [10.2, -5.1, 0], abs=1 * UM
    )
    # the feedback is a signal about the reference: 2 s of 6 kHz on Z, which stands; above it on X, below on Y
    machine = play(high, reference_hz=6000, cycles_per_mm=20)
    *_, (edges, expected) = edges_of_the_cells(machine)
    assert np.abs(edges - expected).max() <= 1.1
    assert edges[2] == pytest.approx(12_000, abs=1) and edges[0] > 12_300 and edges[1] < 11_850
    off = tones(tmp_path / "b.wav", 5980, 6000, 6000, 6000)
    alike = play(off, reference_hz=6000, cycles_per_mm=20, alike=("x", "y", "z"))
    played = join(alike).positions_mm
    assert (played[11_000] - played[5_000]).tolist() == pytest.approx([1, 1, 1], abs=1 * UM)


def test_claim_17_the_motor_turns_a_member_whose_signal_is_fed_back(tmp_path: Path) -> None:
    """A loop makes up for a motor that has lost gain and is held by friction; one that does not turn is found
    out.
    """
    way = positions_mm([0.0], [2 * math.pi * RADIUS_MM], SPEED_MM_S)[:, 0] / RADIUS_MM
    circle = RADIUS_MM * np.column_stack([np.sin(way), 1 - np.cos(way), 0 * way])
    record(Motion(circle), tmp_path / "a.wav")
    weak = play(tmp_path / "a.wav")
    weak.conditions[0] = Condition(gain_share=0.7, friction_mm_s=0.5)
    played = join(weak).positions_mm[6000 : 6000 + len(circle)]
    # an open loop would be 0.5 mm/s and 30 % of 10 mm/s behind: after six seconds some mm
    assert np.abs(played - circle).max() < 3 * UM
    # it is the cell's signal that is fed back: an arm 0.1 mm off the axis of a wheel of 30 mm radius leads
    # the screw astray, once in each of its turns of 5 mm, and without light nothing leads it
    bent = join(play(tmp_path / "a.wav", wheel=SectorWheel(eccentricity_mm=0.1))).positions_mm
    # 2.7 um; the loop leaves 0.5 um at 0.5 m/s²
    wobble = 5.0 / (2 * np.pi) * 0.1 / 30 * np.sin(2 * np.pi * circle / 5.0)
    assert np.abs(bent[6000 : 6000 + len(circle)] - (circle - wobble)).max() < 0.6 * UM
    with pytest.raises(LockFault, match="its pick-up gives no signal"):
        join(play(tmp_path / "a.wav", wheel=SectorWheel(light=0.05)))
    stuck = play(tmp_path / "a.wav")
    stuck.conditions[1] = Condition(stuck=True)
    with pytest.raises((LockFault, FollowingFault)) as caught:
        join(stuck)
    assert caught.value.axis == "y"
