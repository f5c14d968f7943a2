"""Discriminator: the phases of the X, Y and Z tracks against the reference track, in cycles, at the motion
rate.

Signals in: frames of the tape (n, tracks), float32 of full scale 1 or 16-bit samples as they are stored,
track 1 the reference, at the sample rate. Signals out, one row per `decimation` frames, row i standing at
frame i·decimation: cycles (axes), levels (tracks, amplitude), surprise (axes, cycles: how far a phase lay
from the predicted one).

    y(t) = sum over n of  h(n) · exp(-j w n) · x(t + n)    translating filter: h low-pass, w the reference
    cycles = arg( y_axis · conj(y_reference) ) / 2 pi      the turn nearest to the guess of predictor.py

Both tracks are translated by the same w, so its phase and any error of the tape's speed cancel in the
product, and only the difference is left. It is a phase all the way: nothing is integrated, so nothing drifts.
The filter stands symmetrically about its frame, so the time axis is the tape's own. The rows at the two ends,
whose filter would reach past the tape, hold the nearest full one (the tape stands still there).

Source: patent ES 361967, figure 5 (amplifiers 151, triggers 152, the tape's side of comparator 153).
Questions: the patent compares edges, at best one per cycle of the carrier; here the whole wave is used, which
is what beats the tape's noise. A square-wave trigger would be a hundred times coarser.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from morfax.motion.compiled import keeps_kinds, njit
from morfax.player.tape.band_filter import branches, translating_taps
from morfax.player.tape.phases import Phases
from morfax.player.tape.predictor import count_turns, predictor_gains

SMALLEST_PRODUCT = 1e-300  # of two tracks; keeps a silent one from dividing by zero
CHUNK_ROWS = 1024  # what the kernel has in the processor's cache at a time
# of z, z² and so on from the highest: S. Moshier, Cephes, atanf
ARC_TANGENT = (8.05374449538e-2, -1.38776856032e-1, 1.99777106478e-1, -3.33329491539e-1)
GROUP = 8  # taps that the kernel has in its registers at a time
# before the first of a block: dropouts hold back 13 to 170 rows of the one before it
ROOM_ROWS = 512

Frames = NDArray[np.float32 | np.int16]
Float32s = NDArray[np.float32]


def _behind(tail: Frames, frames: Frames) -> Frames:
    """Frames behind those of a tail, which may be none; a copy."""
    return np.concatenate([tail, frames]) if len(tail) else frames.copy()


class _Fields(NamedTuple):
    taps: Float32s
    turns_re: Float32s
    turns_im: Float32s
    columns: Float32s  # (frame within the row · tracks + track, rows)
    sums: Float32s  # (2, tracks, rows)
    level: Float32s


@keeps_kinds
class FilterBench(_Fields):
    """The filter, as `branches` has it, and the arrays in which a chunk of rows goes through it."""


class Discriminator:
    """Tracks in, phases out, block by block of any length."""

    def __init__(
        self, sample_rate_hz: float, reference_hz: float, decimation: int, tracks: int
    ) -> None:
        if not 0 < reference_hz < sample_rate_hz / 2:
            raise ValueError(
                f"reference of {reference_hz:g} Hz cannot be on a tape of {sample_rate_hz:g} samples/s; "
                f"give one between 0 and {sample_rate_hz / 2:g} Hz"
            )
        if tracks < 2:
            raise ValueError(
                f"{tracks} track(s) hold no displacement; give the reference track and at least one axis"
            )
        self.decimation = decimation
        self.filter_frames = len(translating_taps(sample_rate_hz, reference_hz, decimation)[0])
        self._half = self.filter_frames // 2
        # rows that the filter reaches beyond its first
        self._reach = 2 * self._half // decimation
        taps, turns_re, turns_im = branches(sample_rate_hz, reference_hz, decimation, GROUP)
        length = CHUNK_ROWS + max(self._reach, taps.shape[2])
        self._bench = FilterBench(
            np.ascontiguousarray(taps),
            turns_re,
            turns_im,
            np.zeros((decimation * tracks, length), np.float32),
            np.empty((2, tracks, CHUNK_ROWS), np.float32),
            np.empty(CHUNK_ROWS, np.float32),
        )
        self.gains = predictor_gains(sample_rate_hz / decimation)
        self.state = np.full((tracks - 1, 3), np.nan)
        self._tail: Frames = np.zeros((0, tracks), np.float32)
        self._tail_frame = 0  # the tape's frame at which the tail begins
        self._row = 0  # the next row to come out
        self._last: Phases | None = None

    def feed(self, frames: Frames) -> Phases:
        """Take the next frames (n, tracks) of the tape; the rows complete by now, perhaps none."""
        step, held = self.decimation, len(self._tail)
        row = max(self._row, -(-self._half // step))
        # frames before the first of the row's filter
        skipped = row * step - self._half - self._tail_frame
        count = max((held + len(frames) - skipped) // step - self._reach, 0)
        if not count:
            self._tail = _behind(self._tail, frames)
            return self._held(0)
        # 1. rows whose filter begins in the tail, and those that lie in these frames alone
        early = min(max(-(-(held - skipped) // step), 0), count)
        own = skipped + early * step - held
        parts = []
        if early:
            needed = frames[: max(own + self._reach * step, 0)]
            parts.append((_behind(self._tail[skipped:], needed), early))
        if count > early:
            parts.append((frames[own:], count - early))
        phases = self._demodulated(parts, row)
        # 2. what the next rows need
        keep = skipped + count * step
        self._tail = _behind(self._tail[keep:], frames[max(keep - held, 0) :])
        self._row, self._last, self._tail_frame = row + count, phases, self._tail_frame + keep
        return phases

    def finish(self) -> Phases:
        """The rows at the end of the tape that the filter could not fill: the last one held."""
        return self._held(
            -(-(self._tail_frame + len(self._tail)) // self.decimation) - self._row
        )

    def _demodulated(self, parts: Sequence[tuple[Frames, int]], row: int) -> Phases:
        """Run the kernels on frames for so many rows each; before the tape's first full row that is held."""
        tracks, count = self._tail.shape[1], sum(many for _, many in parts)
        lead = row - self._row
        phase, axes = np.empty((tracks - 1, count)), (ROOM_ROWS + lead + count, tracks - 1)
        cycles, surprise = np.empty(axes), np.empty(axes, np.float32)
        levels = np.empty((len(cycles), tracks), np.float32)
        own, done = slice(ROOM_ROWS + lead, None), 0
        for frames, many in parts:
            whole = frames[: (many + self._reach) * self.decimation]
            rows = whole.reshape(many + self._reach, -1)
            scale = np.float32(1 / 32768 if rows.dtype == np.int16 else 1)
            _wrap(rows, scale, (done, many), self._bench, phase, levels[own])
            done += many
        count_turns(phase, self.gains, self.state, cycles[own], surprise[own])
        # before the first full row it is held
        held = slice(ROOM_ROWS, ROOM_ROWS + lead)
        cycles[held], surprise[held], levels[held] = (
            told[own.start] for told in (cycles, surprise, levels)
        )
        told = slice(ROOM_ROWS, None)
        return Phases(self._row, cycles[told], surprise[told], levels[told], ROOM_ROWS)

    def _held(self, count: int) -> Phases:
        """The last row, `count` times over."""
        tracks = self._tail.shape[1]
        if self._last is None:
            empty = np.zeros((0, tracks - 1))
            return Phases(0, empty, empty.astype(np.float32), np.zeros((0, tracks), np.float32))
        cycles = np.repeat(self._last.cycles[-1:], count, axis=0)
        surprise = np.repeat(self._last.surprise[-1:], count, axis=0)
        return Phases(
            self._row, cycles, surprise, np.repeat(self._last.levels[-1:], count, axis=0)
        )


def discriminate(blocks: Iterable[Frames], discriminator: Discriminator) -> Iterator[Phases]:
    """Phases of a whole tape, from its blocks of frames; empty blocks are left out."""
    for frames in blocks:
        phases = discriminator.feed(frames)
        if len(phases):
            yield phases
    rest = discriminator.finish()
    if len(rest):
        yield rest


@njit(cache=True, nogil=True)
def _wrap(rows, scale, part, bench, phase, levels):  # type: ignore[no-untyped-def]
    """Fill `phase` (axes, n), -0.5 to 0.5 cycle, and `levels` from a row on, so many rows (`part`), by chunks
    that fit the processor's cache.

    `rows` of the tape (n, frame within the row · tracks + track), `scale` of a sample.
    """
    tracks = levels.shape[1]
    begin, count = part
    reach = len(rows) - count  # rows that a filter reaches beyond its first
    columns, re, im, level = bench.columns, bench.sums[0], bench.sums[1], bench.level
    filled = bench.taps.shape[2]
    for first in range(0, count, CHUNK_ROWS):
        last = min(first + CHUNK_ROWS, count)
        out = slice(begin + first, begin + last)
        _unlace(rows[first : last + reach], scale, columns)
        # what taps of zero meet must be a number
        columns[:, last - first + reach : last - first + filled] = 0
        for track in range(tracks):
            track_re, track_im = re[track, : last - first], im[track, : last - first]
            turns = bench.turns_re, bench.turns_im
            _translate(columns, track, bench.taps, turns, track_re, track_im)
            _amplitude(track_re, track_im, level)
            levels[out, track] = level[: last - first]
        for axis in range(tracks - 1):
            turn(re[axis + 1], im[axis + 1], re[0], im[0], phase[axis, out])


@njit(cache=True, nogil=True)
def _unlace(rows, scale, columns):  # type: ignore[no-untyped-def]
    """Turn rows into columns, so that a tap meets its samples side by side."""
    for row in range(len(rows)):
        for column in range(len(columns)):
            columns[column, row] = rows[row, column] * scale


# The order of the sum is free (reassoc, contract), so that it runs in vectors; nan and inf keep their
# meaning. Eight taps at a time: with one, most of the time went into taking the sums out of memory and
# putting them back.
@njit(cache=True, nogil=True, fastmath={"reassoc", "contract", "nsz"})
def _translate(columns, track, taps, turns, re, im):  # type: ignore[no-untyped-def]
    """Filter one track's columns, one output per row."""
    re[:] = 0
    im[:] = 0
    tracks = len(columns) // taps.shape[1]
    for branch in range(len(taps)):
        for column in range(taps.shape[1]):
            turn_re, turn_im = turns[0][branch, column], turns[1][branch, column]
            for row in range(0, taps.shape[2], GROUP):
                h0, h1, h2, h3, h4, h5, h6, h7 = _group(taps[branch, column], row)
                x = columns[column * tracks + track, row:]
                for k in range(len(re)):
                    total = h0 * x[k] + h1 * x[k + 1] + h2 * x[k + 2] + h3 * x[k + 3]
                    total += h4 * x[k + 4] + h5 * x[k + 5] + h6 * x[k + 6] + h7 * x[k + 7]
                    re[k] += turn_re * total
                    im[k] += turn_im * total


@njit(cache=True, nogil=True, inline="always")
def _group(taps, i):  # type: ignore[no-untyped-def]
    """Eight taps as numbers."""
    return (
        taps[i],
        taps[i + 1],
        taps[i + 2],
        taps[i + 3],
        taps[i + 4],
        taps[i + 5],
        taps[i + 6],
        taps[i + 7],
    )


@njit(cache=True, nogil=True, fastmath={"reassoc", "contract", "nsz"})
def _amplitude(re, im, level):  # type: ignore[no-untyped-def]
    """Peak of a carrier: twice the amplitude that the filter leaves."""
    for k in range(len(re)):
        level[k] = np.float32(2) * np.sqrt(re[k] * re[k] + im[k] * im[k])


@njit(cache=True, nogil=True, fastmath={"reassoc", "contract", "nsz"}, error_model="numpy")
def turn(re, im, ref_re, ref_im, phase):  # type: ignore[no-untyped-def]
    """Phase of a track against the reference, -0.5 to 0.5 cycle: a vectorised arc tangent, true to 1e-8."""
    p, q, r, s = ARC_TANGENT
    for k in range(len(phase)):
        along = float(re[k]) * float(ref_re[k]) + float(im[k]) * float(ref_im[k])
        across = float(im[k]) * float(ref_re[k]) - float(re[k]) * float(ref_im[k])
        small, large = min(abs(along), abs(across)), max(abs(along), abs(across))
        oblique = small > 0.41421356237309503 * large  # tangent of an eighth of half a turn
        t = (small - large if oblique else small) / max(
            small + large if oblique else large, SMALLEST_PRODUCT
        )
        z = t * t
        angle = (((p * z + q) * z + r) * z + s) * z * t + t
        angle = angle + math.pi / 4 if oblique else angle
        angle = math.pi / 2 - angle if abs(across) > abs(along) else angle
        angle = math.pi - angle if along < 0 else angle
        phase[k] = (-angle if across < 0 else angle) / (2 * math.pi)
