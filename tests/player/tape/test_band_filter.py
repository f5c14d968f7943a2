"""The filter of the discriminator: what it lets pass, and its branches against one sum of all taps."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.player.tape.band_filter import branches, translating_taps

RATE_HZ, REFERENCE_HZ, DECIMATION = 48_000.0, 6000.0, 8


def response_db(beside_hz: float, reference_hz: float = REFERENCE_HZ) -> float:
    """How much of a tone so far beside the reference is left, dB."""
    real, imaginary = (
        taps.astype(float) for taps in translating_taps(RATE_HZ, reference_hz, DECIMATION)
    )
    n = np.arange(len(real)) - len(real) // 2
    # the filter runs over the tone as it comes: its taps meet exp(-jwn)
    tone = np.exp(2j * np.pi * (reference_hz + beside_hz) / RATE_HZ * n)
    return float(20 * np.log10(max(abs(((real + 1j * imaginary) * tone).sum()), 1e-12)))


@pytest.mark.parametrize("reference_hz", [6000.0, 6001.0])
def test_the_low_pass_is_that_of_its_description(reference_hz: float) -> None:
    """0.6 dB down at 2 kHz, 6 dB at 3 kHz, 80 dB from 5 kHz on: mirror, offset and second harmonic."""
    assert response_db(0.0, reference_hz) == pytest.approx(0.0, abs=0.001)
    assert response_db(2000.0, reference_hz) == pytest.approx(-0.6, abs=0.1)
    assert response_db(-3000.0, reference_hz) == pytest.approx(-6.0, abs=0.1)
    assert max(response_db(hz, reference_hz) for hz in np.arange(5000.0, 20_000.0, 50.0)) < -80
    assert response_db(-2 * reference_hz, reference_hz) < -80


def test_with_a_lower_reference_it_is_as_much_narrower() -> None:
    """So the offset of a tape at 3 kHz, 3 kHz beside, is kept out as well."""
    assert response_db(-1500.0, 3000.0) == pytest.approx(-6.0, abs=0.1)
    assert response_db(-3000.0, 3000.0) < -80


@pytest.mark.parametrize(("reference_hz", "count"), [(6000.0, 1), (12_000.0, 1), (6001.0, 2)])
def test_the_branches_are_the_same_filter_column_by_column(
    reference_hz: float, count: int
) -> None:
    """One row of the tape after the other; with whole cycles to a row one real branch is enough."""
    rows, real, imaginary = branches(RATE_HZ, reference_hz, DECIMATION, 4)
    assert rows.shape[:2] == (count, DECIMATION) and rows.shape[2] % 4 == 0
    heard = np.random.default_rng(1).normal(0, 1, rows.shape[2] * DECIMATION)
    by_column = heard.reshape(-1, DECIMATION).T
    turns = real + 1j * imaginary
    found = (rows * by_column).sum(axis=2)
    both = (found * turns).sum()
    taps = [one.astype(float) for one in translating_taps(RATE_HZ, reference_hz, DECIMATION)]
    kept = min(len(taps[0]), len(heard))
    expected = (heard[:kept] * (taps[0] + 1j * taps[1])[:kept]).sum()
    if count == 1:  # the turn of the first tap is left out: all columns turn from there
        begin = np.exp(-2j * np.pi * reference_hz / RATE_HZ * -(len(taps[0]) // 2))
        assert abs(both) == pytest.approx(abs(expected / begin), rel=1e-4)
    else:
        assert both == pytest.approx(expected, rel=1e-4)
