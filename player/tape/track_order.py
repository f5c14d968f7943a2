"""The order of the tracks: whether the reference is on another track, before anything moves.

Signals in: the tape's first seconds, until something moves; where the reference then turns out to be on
another track, its phases to the end. Out: the order of the tracks, where it is certain; a fault, where the
reference is elsewhere and the rest is not certain; nothing, where track 1 may be the reference.

With a check signal each track says which it is. On a bare tape, the reference is the track that stands when
the others move (watch.py). Which of the others is X, Y or Z is not to be seen on them: only if the tape
states an end that differs from its start on some axes, and just one order of the tracks ends there on all, is
it known.

Source: patent ES 361967, figure 5; the patent's tracks lie in the order in which the tape is wired.
Questions: X and Y in each other's places make a mirror image, so an order that is only likely is not taken.
"""

from __future__ import annotations

from itertools import permutations

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.faults import TapeFault
from morfax.player.tape.check_reader import CheckReader, read_ahead, read_check
from morfax.player.tape.discriminator import Discriminator, discriminate
from morfax.player.tape.standstill import strongest_hz, take_bearings
from morfax.player.tape.steadiest import Steadiest
from morfax.recorder.tape.format import SURE_CYCLES
from morfax.recorder.tape.tape import Tape, full_scale

# of a tape that stands for so long nothing is known beforehand; the watch goes on
SEARCHED_S = 20.0
MOST_AXES = 6  # whose orders are gone through


def found_order(tape: Tape) -> tuple[tuple[int, ...] | None, CheckReader | None]:
    """The tracks with reference, X, Y … if in another order than these, and the reader of the check signal.

    Raises TapeFault if the order is unknown.
    """
    fmt = tape.format
    check = read_check(read_ahead(tape.stored_blocks(), fmt), fmt)
    if check is not None:
        return _told_order(check.tracks), check
    return _by_the_watch(tape), None


def _by_the_watch(tape: Tape) -> tuple[int, ...] | None:
    """The order of the tracks of a bare tape, if the reference is not the first."""
    fmt = tape.format
    watch: Steadiest | None = None
    time_s = 0.0
    for block in tape.stored_blocks():
        if watch is None:
            still_hz = strongest_hz(full_scale(block[:, 0]), fmt.sample_rate_hz)
            watch = Steadiest(fmt, still_hz)
        time_s += len(block) / fmt.sample_rate_hz
        fault = watch.wrong(block, time_s)
        if fault is not None:
            _demand_tape(tape)
            return _by_the_end(tape, watch.track, fault)
        if watch.is_reference or time_s > SEARCHED_S:
            return None
    return None


def _told_order(says: list[int | None]) -> tuple[int, ...] | None:
    """The order that the tracks say; None if it is the usual one, or two say the same: later a fault."""
    usual = list(range(len(says)))
    if says == usual or any(track not in says for track in usual):
        return None
    return tuple(says.index(track) + 1 for track in usual)


def _demand_tape(tape: Tape) -> None:
    """Raise TapeFault unless every track carries a tape signal; music has a steadiest track too."""
    fmt = tape.format
    frames = full_scale(next(tape.stored_blocks()))
    rows = Discriminator(
        fmt.sample_rate_hz, fmt.reference_hz, fmt.samples_per_motion, fmt.tracks
    ).feed(frames)
    take_bearings(frames, rows, fmt)


def _by_the_end(tape: Tape, reference: int, fault: TapeFault) -> tuple[int, ...]:
    """The one order of the other tracks that ends at the stated place; else the given fault is raised."""
    fmt = tape.format
    others = [track for track in range(fmt.tracks) if track != reference]
    if fmt.end_mm is None or len(others) > MOST_AXES:
        raise fault
    ended = _travelled(tape, reference, others)
    wanted = (np.array(fmt.end_mm) - np.array(fmt.start_mm)) * fmt.cycles_per_mm
    # a cycle lost is four times as much, and a drive at rest stands a hundred times nearer
    fitting = [
        order
        for order in permutations(range(len(others)))
        if (np.abs(ended[list(order)] - wanted) < SURE_CYCLES).all()
    ]
    if len(fitting) != 1:
        raise fault
    return reference + 1, *(others[place] + 1 for place in fitting[0])


def _travelled(tape: Tape, reference: int, others: list[int]) -> Array:
    """Travel of each other track against the reference from start to end of the tape, cycles."""
    fmt = tape.format
    organ = Discriminator(
        fmt.sample_rate_hz, fmt.reference_hz, fmt.samples_per_motion, fmt.tracks
    )
    first = last = np.zeros(len(others))
    for phases in discriminate(
        (block[:, [reference, *others]] for block in tape.stored_blocks()), organ
    ):
        first = phases.cycles[0] if not phases.first_row else first
        last = phases.cycles[-1]
    return np.asarray(last - first)
