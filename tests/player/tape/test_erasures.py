"""Erasures: frames with weak symbols, read by their check sum, or given up."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.player.tape.erasures import Erasures
from morfax.player.tape.symbols import GATES, PARTS, Gates
from morfax.recorder.tape.check_frame import SYMBOLS, SYNC_SYMBOLS, CheckFrame, to_bits

TRACKS = 3
SOUND = [
    CheckFrame(track, 5, 10.0 * track, middle_cycles=0.0 if track else None)
    for track in range(TRACKS)
]


def gates_of(
    weak: dict[int, list[int]],
    wrong: dict[int, list[int]] | None = None,
    *,
    strength: float = 1.0,
    weak_share: float = 0.4,
    small: dict[int, list[int]] | None = None,
) -> Gates:
    """A frame of all tracks, with weak symbols at places, some of them read wrong, some small."""
    bits = np.stack([to_bits(said) for said in SOUND])
    strengths = np.full((TRACKS, SYMBOLS), strength)
    sizes = strengths.copy()
    shares = np.full((TRACKS, GATES, SYMBOLS), strength)
    for track, places in weak.items():
        strengths[track, places] *= weak_share
        shares[track][:, places] *= weak_share
    for track, places in (small or {}).items():
        sizes[track, places] *= weak_share
    for track, places in (wrong or {}).items():
        bits[track, places] *= -1
    nothing = np.zeros((TRACKS, PARTS))
    return Gates(
        bits, strengths, sizes, shares, np.zeros(TRACKS), nothing, nothing[:, 0], nothing[:, 0]
    )


def known() -> Erasures:
    """A reader that has read a sound frame."""
    reader = Erasures(TRACKS)
    assert reader.read(gates_of({}), 5) == SOUND
    return reader


@pytest.mark.parametrize("count", [1, 5, 8])
def test_up_to_eight_weak_symbols_are_read_whichever_they_are(count: int) -> None:
    weak = list(range(SYNC_SYMBOLS + 3, SYNC_SYMBOLS + 3 + count))
    reader = known()
    assert reader.read(gates_of({1: weak}, {1: weak[::2]}), 5) == SOUND
    assert reader.damaged == []
    assert reader.weak[0].size == reader.weak[2].size == 0 and reader.weak[1].size > 0


def test_of_more_than_eight_nothing_is_taken_even_if_they_are_right() -> None:
    reader = known()
    said = reader.read(gates_of({1: list(range(40, 49))}), 5)
    assert said == [SOUND[0], None, SOUND[2]] and reader.damaged == []


@pytest.mark.parametrize(("share", "is_weak"), [(0.49, True), (0.51, False)])
def test_a_symbol_below_half_of_the_usual_strength_is_weak(share: float, is_weak: bool) -> None:
    """The usual strength is that of the frame before; one that is weak and right is read as it is."""
    reader, weak = known(), [50, 60]
    said = reader.read(gates_of({1: weak}, {1: weak}, weak_share=share), 5)
    assert said[1] == (SOUND[1] if is_weak else None)
    assert reader.damaged == ([] if is_weak else [1])


def test_a_wrong_symbol_that_is_strong_leaves_its_track_unread_and_told() -> None:
    reader = known()
    assert reader.read(gates_of({}, {2: [70]}), 5) == [*SOUND[:2], None]
    assert reader.damaged == [2]


@pytest.mark.parametrize(("number", "is_read"), [(5, True), (5 + (1 << 16), True), (6, False)])
def test_a_recovered_frame_must_say_its_own_number(number: int, is_read: bool) -> None:
    said = known().read(gates_of({1: [50]}, {1: [50]}), number)
    assert (said[1] is not None) == is_read


def test_a_recovered_frame_must_be_of_its_own_track() -> None:
    reader, gates = known(), gates_of({1: [50]}, {1: [50]})
    gates.bits[1] = gates.bits[2]
    gates.bits[1, 50] *= -1
    assert reader.read(gates, 5)[1] is None


def test_the_sync_word_says_nothing_and_may_be_wrong() -> None:
    places = [3, 23, 24, 50, 119]  # the first and the last symbols that say something
    assert known().read(gates_of({1: places}, {1: places}), 5) == SOUND


def test_where_a_track_is_weak_is_told_in_quarters_of_a_symbol() -> None:
    """A gate is a quarter early, on its symbol, or a quarter late."""
    reader, gates = known(), gates_of({})
    gates.shares[2][:, 80] = [0.3, 1.0, 0.3]
    reader.read(gates, 5)
    assert reader.weak[2].tolist() == [79.75, 80.25]


def test_of_a_frame_whose_reference_is_gone_the_small_symbols_tell_what_is_weak() -> None:
    """More than eight small symbols on track 1: no phase is held against its sync word."""
    small = list(range(30, 42))
    reader = known()
    reader.read(gates_of({}, small={0: small, 1: [33, 34]}), 5)
    assert reader.weak[0].tolist() == small and reader.weak[1].tolist() == [33, 34]
    assert reader.weak[2].size == 0


def test_the_usual_strength_is_the_median_of_the_last_frame_that_was_read() -> None:
    """A tape may get quieter by a fifth with each frame; a lost frame tells nothing."""
    reader = known()
    for strength in (0.8, 0.64, 0.51):
        assert reader.read(gates_of({}, strength=strength), 5) == SOUND
    assert reader.usual == pytest.approx([0.51] * TRACKS)
    reader.read(gates_of({}, {1: [70]}, strength=0.45), 5)
    assert reader.usual == pytest.approx([0.45, 0.51, 0.45])
    assert reader.size == pytest.approx([0.45, 0.51, 0.45])
