"""The job `devices`: what it lists, how loud its tone comes back, and what it says of a level."""

from __future__ import annotations

import pytest

from morfax.jobs.devices import READING_S, DevicesJob, Levels, _remark
from tests.jobs.worked import Recording
from tests.recorder.sound.stand_in import Cable, plugged_in

DB = 0.05  # of a level: a reading ends anywhere in a period of the carrier


@pytest.fixture(autouse=True)
def cable(monkeypatch: pytest.MonkeyPatch) -> Cable:
    """A cable from its outputs to its inputs, faster than the recorder."""
    return plugged_in(monkeypatch)


def test_a_listed_device_has_its_numbers() -> None:
    (first, second) = DevicesJob().run().figures["devices"]
    assert first == {
        "number": 0,
        "name": "Cable one",
        "interface": "Loop",
        "inputs": 4,
        "outputs": 4,
        "rate_hz": 48000,
    }
    assert second["number"] == 1


def test_readings_come_four_times_a_second_and_show_the_tone() -> None:
    """The carrier has half of full scale, -6.02 dB, and the check signal a fifth of it: +0.17 dB of power,
    and 0.6 of full scale where both are highest.
    """
    shown = list[Levels]()
    listener = Recording()
    job = DevicesJob(tone="0", meters="0", lasts_s=1.0, show=shown.append)
    figures = job.run(listener).figures
    # blocks of 0.1 s: three of them are a reading
    assert READING_S == 0.25 and len(shown) == int(figures["duration_s"] / 0.3)
    for reading in shown:
        assert reading.level_db == pytest.approx([-5.85] * 4, abs=DB)
        assert reading.peak_db == pytest.approx([-4.44] * 4, abs=DB)
    assert figures["duration_s"] == pytest.approx(1, abs=0.15)
    assert figures["sample_rate_hz"] == 48000
    assert figures["track_1"]["peak_db"] == pytest.approx(-4.44, abs=DB)
    assert not [text for kind, text in listener.said if kind == "warning"]


@pytest.mark.parametrize(
    ("level_db", "peak", "said"),
    [
        (-3.0, 1.0, "track 3 clips: turn it down by 6 dB"),
        (-3.0, 0.998, None),  # the largest of 16 bit is 0.99997
        (-0.8, 0.95, "track 3 is at -0.8 dB: turn it down to about -6 dB"),
        (-1.2, 0.95, None),
        (-29.0, 0.05, None),
        (-31.0, 0.05, "track 3 is at -31.0 dB: turn it up to about -6 dB"),
    ],
)
def test_a_level_is_worth_a_word_where_it_clips_or_noise_counts(
    level_db: float, peak: float, said: str | None
) -> None:
    """Within 1 dB of full scale a tape clips; 30 dB below it noise of the sound device counts."""
    listener = Recording()
    _remark(listener, 3, level_db, peak)
    assert listener.said == ([] if said is None else [("warning", said)])
