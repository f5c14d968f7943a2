"""The parts of the wear in closed form: tones, bands, dropouts, and the presets as the page states them."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from morfax.recorder.wear import signal, timebase
from morfax.recorder.wear.settings import SETS, Wear, check
from morfax.recorder.wear.timebase import Head, Tones
from morfax.recorder.wear.transport import Deck

PAGE = Path(__file__).parents[3] / "docs" / "background" / "transport.md"
RATE_HZ = 48_000
UNITS = {"%": 0.01, "us": 1e-6, "ms": 1e-3, "dB": 1.0, "kHz": 1e3, "": 1.0}
NAMES = {
    "speed error": ("speed",), "wow, 0.5–4 Hz": ("wow",), "flutter, 4–100 Hz": ("flutter",),
    "scrape, 100–2000 Hz": ("scrape",), "static skew": ("skew_s",), "weave": ("weave_s",),
    "noise": ("noise_db",), "level": ("uneven_db",), "crosstalk": ("crosstalk_db",),
    "print-through": ("print_db",), "hum, DC": ("hum_db",), "distortion": ("third",),
    "bandwidth": ("bandwidth_hz",), "dropouts": ("dropouts_per_min", "dropout_s", "dropout_db"),
}  # fmt: skip


def stated(cell: str, names: tuple[str, ...]) -> dict[str, float | None]:
    """The figures of a cell, in the units of the settings; a dash is none."""
    words = cell.split(", ") if cell != "–" else []
    found = [re.fullmatch(r"([\d.]+) ?(\S*)", word) for word in words]
    numbers = [float(one[1]) * UNITS[one[2]] for one in found if one]
    return dict(zip(names, numbers or [getattr(Wear(), n) for n in names], strict=True))


@pytest.mark.parametrize("column", [3, 4, 5])
def test_the_presets_are_those_of_the_page(column: int) -> None:
    table = PAGE.read_text("utf-8").split("\n\n")[2].splitlines()
    rows = [[cell.strip() for cell in row.strip("|").split("|")] for row in table]
    preset = SETS[rows[0][column]]
    told = [(row[column], NAMES[row[0]]) for row in rows if row[0] in NAMES]
    assert len(told) == len(NAMES)
    for cell, names in told:
        for name, value in stated(cell, names).items():
            assert getattr(preset, name) == pytest.approx(value), name


def test_the_reel_is_the_revox_of_the_page() -> None:
    reel = SETS["reel"]
    together = np.sqrt(reel.wow**2 + reel.flutter**2 + reel.scrape**2)
    assert together == pytest.approx(9e-4, rel=0.05)  # "0.09 % together"
    assert reel.skew_s == pytest.approx(600e-6 * 1.7 / 190.5, rel=0.02)  # 600 urad over 1.7 mm
    # 56 urad of weave over the same pitch
    assert reel.weave_s == pytest.approx(56e-6 * 1.7 / 190.5, rel=0.02)
    said = (reel.speed, reel.noise_db, reel.crosstalk_db, reel.third, reel.bandwidth_hz)
    assert said == (0.002, 52, 45, 0.02, 20_000)


def test_a_studio_machine_is_as_good_as_a_reel_in_every_part_and_a_cassette_worse() -> None:
    studio, reel, cassette = (SETS[name] for name in ("studio-15ips", "reel", "cassette"))
    for name in ("speed", "wow", "flutter", "scrape", "skew_s", "weave_s", "third", "uneven_db",
                 "dropouts_per_min", "dropout_s", "dropout_db"):  # fmt: skip
        good, usual, bad = (getattr(each, name) for each in (studio, reel, cassette))
        assert good <= usual < bad, name
    for name in ("noise_db", "crosstalk_db", "print_db", "bandwidth_hz"):
        good, usual, bad = (getattr(each, name) for each in (studio, reel, cassette))
        assert good >= usual > bad, name


def test_the_answering_machine_has_the_band_of_a_telephone() -> None:
    machine = SETS["answering-machine"]
    assert machine.band_hz == (300, 3_400)  # ITU-T G.712
    assert np.hypot(machine.wow, machine.flutter) == pytest.approx(0.003, rel=0.1)
    assert (machine.speed, machine.noise_db) == (0.03, 35)


def test_tones_lie_in_their_band_with_the_rms_that_was_asked_for() -> None:
    t_s = np.arange(20_000_000, step=997) / RATE_HZ  # 417 s: 200 periods of the slowest tone
    for seed in range(5):
        tones = Tones.drawn(0.01, timebase.WOW_HZ, np.random.default_rng(seed))
        low, high = timebase.WOW_HZ
        assert 0.95 * low <= tones.hz.min() and tones.hz.max() <= 1.05 * high
        assert np.std(tones.value(t_s)) == pytest.approx(0.01, rel=0.02)
        # no tone has more than three times the amplitude of another: 0.5 to 1.5 of the mean
        assert tones.amplitude.max() <= 3 * tones.amplitude.min()


def test_the_bands_are_those_of_the_page() -> None:
    bands = [timebase.WOW_HZ, timebase.FLUTTER_HZ, timebase.SCRAPE_HZ, timebase.WEAVE_HZ]
    assert bands == [(0.5, 4.0), (4.0, 100.0), (100.0, 2000.0), (0.3, 20.0)]


def test_a_tape_read_at_its_own_frames_is_itself() -> None:
    frames = np.random.default_rng(1).normal(size=(400, 2)).astype(np.float32)
    head = Head(2)
    head.take(frames)
    at = np.repeat(np.arange(100.0, 300.0)[:, None], 2, axis=1)
    assert np.abs(head.read(at) - frames[100:300]).max() < 1e-5  # rounding to float32
    # half way between two frames a slow tone is half way, to -80 dB
    tone = np.sin(2 * np.pi * 0.05 * np.arange(400))[:, None].astype(np.float32)
    head = Head(1)
    head.take(tone)
    between = np.arange(100.5, 300.5)[:, None]
    expected = np.sin(2 * np.pi * 0.05 * between)
    assert np.abs(head.read(between) - expected).max() < 1e-4


def seen(band: signal.BandLimit, hz: float) -> float:
    """By how much a tone is turned down, dB."""
    t_s = np.arange(RATE_HZ) / RATE_HZ
    out = band.feed(np.sin(2 * np.pi * hz * t_s)[:, None].astype(np.float32))
    return float(20 * np.log10(np.sqrt(2) * np.std(out[RATE_HZ // 2 :])))


def test_a_telephone_s_band_is_3_db_down_at_its_ends_and_39_at_6_khz() -> None:
    def band() -> signal.BandLimit:
        return signal.BandLimit.telephone((300.0, 3400.0), RATE_HZ, 1)

    assert seen(band(), 1000.0) == pytest.approx(0.0, abs=0.01)
    assert seen(band(), 300.0) == pytest.approx(-3.0, abs=0.1)
    assert seen(band(), 3400.0) == pytest.approx(-3.0, abs=0.1)
    assert seen(band(), 6000.0) < -39.0
    # a band that ends beyond half the rate ends just below it
    wide = signal.BandLimit.telephone((300.0, 40_000.0), RATE_HZ, 1)
    assert seen(wide, 20_000.0) == pytest.approx(0.0, abs=0.1)


def test_dropouts_come_as_often_and_are_as_long_as_they_say() -> None:
    made = signal.Dropouts(60.0, 0.01, 0.1, False, (1, 2))
    for second in range(2000):
        made.gains(float(second), RATE_HZ // 1000, 48.0, 4)
    starts_s = np.array([hole.start_s for hole in made.met])
    # 2 000 of them, one a second: Poisson, 2 % (and each begins behind the end of the one before)
    assert len(starts_s) == pytest.approx(2000, rel=0.07)
    assert (np.diff(starts_s) > [hole.length_s for hole in made.met[:-1]]).all()
    lengths_s = [hole.length_s for hole in made.met]
    assert np.median(lengths_s) == pytest.approx(0.01, rel=0.05)
    assert np.std(np.log(lengths_s)) == pytest.approx(0.5, rel=0.1)


def test_a_dropout_turns_its_track_down_to_what_it_leaves_and_never_about() -> None:
    made = signal.Dropouts(60.0, 0.01, 0.1, False, (1, 2))
    made.gains(0.0, 5 * RATE_HZ, RATE_HZ, 4)
    hole = made.met[0]
    first_s = hole.start_s - 0.01
    gains = made.gains(first_s, round(0.03 * RATE_HZ), RATE_HZ, 4)
    assert gains is not None
    its, others = gains[:, hole.track % 4], np.delete(gains, hole.track % 4, axis=1)
    assert its.min() == pytest.approx(0.1) and its.max() == 1.0
    middle = round((hole.start_s + 0.5 * hole.length_s - first_s) * RATE_HZ)
    assert its[middle] == pytest.approx(0.1)
    # half of it is lost where it begins
    begins = round((hole.start_s - first_s) * RATE_HZ)
    assert its[begins] == pytest.approx(0.55, abs=0.03)
    assert (others == 1.0).all()


def test_the_level_rises_and_falls_slowly_by_as_many_db() -> None:
    uneven = signal.Unevenness(1.0, 2, (1, 2))
    gains = [uneven.gains(k * 4801, 1, RATE_HZ) for k in range(4000)]  # 400 s
    db = 20 * np.log10(np.concatenate(gains))
    assert db.std(axis=0) == pytest.approx([1.0, 1.0], rel=0.1)
    assert signal.UNEVEN_HZ == (0.2, 8.0)  # slow against the words of the check signal


def test_the_level_is_that_of_the_unevenness() -> None:
    deck = Deck(Wear(uneven_db=1.0), RATE_HZ, 2, 1)
    out = np.concatenate(list(deck.frames(iter([np.full((RATE_HZ, 2), 0.5, np.float32)]))))
    gains = deck._uneven.gains(0, len(out), RATE_HZ)
    assert np.abs(out - 0.5 * gains)[100:-100].max() < 1e-3  # -54 dB; the level moves by 10 %
    assert np.ptp(gains) > 0.05


def test_places_are_true_to_what_eight_frames_bend() -> None:
    scrape = Tones.drawn(1e-3, timebase.SCRAPE_HZ, np.random.default_rng(3))
    weave = Tones.drawn(0.0, timebase.WEAVE_HZ, np.random.default_rng(4))
    base = timebase.Timebase(0.0, (scrape,), 0.0, weave)
    places = base.places(0, RATE_HZ, RATE_HZ, 1)[:, 0]
    true = base.programme_s(np.arange(RATE_HZ) / RATE_HZ) * RATE_HZ
    # a chord of length h is off by h² / 8 of the second derivative: of all tones together, in frames
    steepest = float((scrape.amplitude * 2 * np.pi * scrape.hz).sum())
    off = (8 / RATE_HZ) ** 2 / 8 * steepest * RATE_HZ
    assert 0.25 * off < np.abs(places - true).max() < off


def test_noise_is_told_of_the_carrier_behind_blank_tape() -> None:
    t_s = np.arange(2 * RATE_HZ) / RATE_HZ
    tone = np.where(t_s < 1, 0.0, 0.25 * np.sin(2 * np.pi * 6000 * t_s)).astype(np.float32)
    blocks = iter(np.split(np.tile(tone[:, None], (1, 2)), 8))
    noisy = np.concatenate(list(Deck(Wear(noise_db=40), RATE_HZ, 2, 1).frames(blocks)))
    blocks = iter(np.split(np.tile(tone[:, None], (1, 2)), 8))
    clean = np.concatenate(list(Deck(Wear(), RATE_HZ, 2, 1).frames(blocks)))
    noise = (noisy - clean)[int(1.5 * RATE_HZ) : -100]
    assert 20 * np.log10(0.25 / np.sqrt(2) / noise.std()) == pytest.approx(40, abs=0.1)


def test_a_header_holds_a_rate_of_31_bits() -> None:
    check(Wear(stamped_hz=2**31 - 1), 4)
    with pytest.raises(ValueError, match="2147483647"):
        check(Wear(stamped_hz=2**31), 4)


def test_hum_is_of_the_mains_with_a_third_harmonic_at_a_third_of_it() -> None:
    """A second of 50 Hz, from any frame on: lines at 50 and 150 Hz, a peak as it is set."""
    told = signal.hum(0, RATE_HZ, RATE_HZ, 50.0, 0.2)
    lines = 2 * np.abs(np.fft.rfft(told)) / RATE_HZ
    assert lines[[50, 150]] == pytest.approx([0.15, 0.05], abs=1e-6)
    assert np.delete(lines, [50, 150]).max() < 1e-9
    assert signal.hum(700, 100, RATE_HZ, 50.0, 0.2) == pytest.approx(told[700:800], abs=1e-12)


@pytest.mark.parametrize(("scrape", "is_refused"), [(0.009, False), (0.011, True)])
def test_wow_flutter_and_scrape_are_a_twentieth_together_at_the_most(
    scrape: float, is_refused: bool
) -> None:
    wear = Wear(wow=0.03, flutter=0.011, scrape=scrape)
    if is_refused:
        with pytest.raises(ValueError, match=r"more than 0\.05 together"):
            check(wear, 4)
    else:
        check(wear, 4)
