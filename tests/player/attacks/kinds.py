"""The table of attacks: name, what is done to a checked tape, what must come, and whether moments stay.

    right             played to its end, right within 0.05 cycle
    right or fault    the same, or a fault; right as far as it was played
    fault             a fault; right as far as it was played

Where the moments do not stay (a tape that runs faster, a reference that is late), the distance off the path
counts.
"""

from __future__ import annotations

import numpy as np

from tests.player.attacks import chain, drawn
from tests.player.attacks import changes as do
from tests.player.attacks.bench import EITHER, FAULT, RIGHT, Kind
from tests.player.attacks.changes import ALL, REFERENCE, X, Y
from tests.player.attacks.drawn import AXES, US

# ruff: noqa: E501 -- a line to a kind
SINGLE: tuple[Kind, ...] = (
    Kind("nothing", lambda t, r: t.frames, RIGHT),
    # delays
    Kind("an axis late by up to 195 us", lambda t, r: do.late(t, {drawn.axis(r): r.uniform(0, 195) * US}), RIGHT),
    Kind("an axis early by up to 195 us", lambda t, r: do.late(t, {drawn.axis(r): -r.uniform(0, 195) * US}), RIGHT),
    Kind("X by -95, Y by +95 us", lambda t, r: do.late(t, {X: -r.uniform(0, 95) * US, Y: r.uniform(0, 95) * US}), RIGHT),
    Kind("the reference late or early by up to 195 us", lambda t, r: do.late(t, {REFERENCE: drawn.signed(r, 0, 195) * US}), RIGHT, False),
    Kind("the head tilted, up to 60 us a track", drawn.azimuth, RIGHT, False),
    Kind("an axis' delay drifts, up to 45 us/s", lambda t, r: drawn.drifting(t, r, drawn.axis(r)), RIGHT),
    Kind("the reference's delay drifts, up to 45 us/s", lambda t, r: drawn.drifting(t, r, REFERENCE), RIGHT, False),
    Kind("a delay swings, 0.05 to 0.5 Hz", lambda t, r: drawn.swinging(t, r, 0.05, 0.5), EITHER),
    Kind("a delay swings, 0.5 to 60 Hz", lambda t, r: drawn.swinging(t, r, 0.5, 60), EITHER),
    Kind("a delay of 205 to 450 us", lambda t, r: do.late(t, {do.track(r): drawn.signed(r, 205, 450) * US}), FAULT, False),
    Kind("a delay of 0.45 to 10 ms", lambda t, r: do.late(t, {do.track(r): do.log_uniform(r, 450, 10000) * US}), FAULT, False),
    Kind("a delay steps by 17 to 150 us", drawn.stepping, FAULT, False),
    # samples
    Kind("one sample lost on one track", lambda t, r: drawn.lost(t, r, (1, 1), [do.track(r)]), FAULT, False),
    Kind("one sample twice on one track", lambda t, r: drawn.again(t, r, (1, 1), [do.track(r)]), FAULT, False),
    Kind("2 to 8 samples lost on one track", lambda t, r: drawn.lost(t, r, (2, 8), [do.track(r)]), FAULT, False),
    Kind("2 to 8 samples twice on one track", lambda t, r: drawn.again(t, r, (2, 8), [do.track(r)]), FAULT, False),
    Kind("8 to 4800 samples lost on one track", lambda t, r: drawn.lost(t, r, (8, 4800), [do.track(r)]), FAULT, False),
    Kind("8 to 4800 samples twice on one track", lambda t, r: drawn.again(t, r, (8, 4800), [do.track(r)]), FAULT, False),
    Kind("samples lost on two or three tracks", lambda t, r: drawn.lost(t, r, (1, 960), [REFERENCE, *r.permutation(AXES)[: r.integers(1, 3)].tolist()]), FAULT, False),
    Kind("one to three samples lost on all tracks", lambda t, r: drawn.lost(t, r, (1, 3), list(ALL)), EITHER, False),
    Kind("buffers of 8 to 4800 lost on all tracks", lambda t, r: drawn.lost(t, r, (8, 4800), list(ALL)), EITHER, False),
    Kind("buffers of 8 to 4800 twice on all tracks", lambda t, r: drawn.again(t, r, (8, 4800), list(ALL)), EITHER, False),
    Kind("0.1 to 1 s lost on all tracks", lambda t, r: drawn.lost(t, r, (4800, 48000), list(ALL)), FAULT, False),
    Kind("0.1 to 1 s twice on all tracks", lambda t, r: drawn.again(t, r, (4800, 48000), list(ALL)), FAULT, False),
    Kind("two buffers exchanged", drawn.exchanged, EITHER, False),
    Kind("a buffer of all tracks from elsewhere", lambda t, r: drawn.pasted(t, r, list(ALL)), EITHER, False),
    Kind("a buffer of one track from elsewhere", lambda t, r: drawn.pasted(t, r, [do.track(r)]), EITHER, False),
    # tracks
    Kind("tracks in another order", drawn.order, EITHER),
    Kind("two axes change places under way", drawn.order_from, FAULT),
    Kind("a track is a copy of another", drawn.copied, FAULT),
    Kind("all tracks are one", lambda t, r: np.repeat(t.frames[:, [do.track(r)]], 4, axis=1), FAULT),
    Kind("a silent track", drawn.silent, FAULT),
    Kind("a track is missing", lambda t, r: np.delete(t.frames, do.track(r), axis=1), FAULT),
    # time
    Kind("played backwards", lambda t, r: t.frames[::-1].copy(), FAULT),
    Kind("a stretch of it backwards", drawn.part_backwards, EITHER, False),
    Kind("fast or slow by up to 5 %", lambda t, r: do.at_speed(t, np.full(len(t.frames), 1 + drawn.signed(r, 0, 0.05))), RIGHT, False),
    Kind("fast or slow by 12 to 60 %", lambda t, r: do.at_speed(t, np.full(len(t.frames), 1 + drawn.signed(r, 0.12, 0.6))), FAULT, False),
    Kind("wow, up to 0.2 % at 0.5 to 4 Hz", lambda t, r: drawn.wavering(t, r, (0.5, 4), 2e-3), RIGHT, False),
    Kind("flutter, up to 0.2 % at 4 to 30 Hz", lambda t, r: drawn.wavering(t, r, (4, 30), 2e-3), RIGHT, False),
    Kind("flutter, up to 2 % at 4 to 100 Hz", lambda t, r: drawn.wavering(t, r, (4, 100), 2e-2), EITHER, False),
    Kind("the speed changes under way", drawn.changed_speed, EITHER, False),
    # polarity and level
    Kind("tracks inverted", lambda t, r: t.frames * np.where(np.isin(np.arange(4), do.some(r)), -1, 1).astype(np.float32), RIGHT),
    Kind("one track inverted under way", lambda t, r: drawn.inverted_from(t, r, [do.track(r)]), FAULT),
    Kind("all tracks inverted under way", lambda t, r: drawn.inverted_from(t, r, list(ALL)), EITHER),
    Kind("level 3 dB more to 25 dB less", lambda t, r: t.frames * np.float32(10 ** (r.uniform(-25, 3) / 20)), RIGHT),
    Kind("level 25 to 80 dB less", lambda t, r: t.frames * np.float32(10 ** (r.uniform(-80, -25) / 20)), EITHER),
    Kind("uneven by up to 1 dB", drawn.uneven, EITHER),
    # dropouts
    Kind("a dropout of 0.3 to 3 ms on one track", lambda t, r: drawn.hole(t, r, (0.0003, 0.003), [do.track(r)]), EITHER),
    Kind("a dropout of 3 to 12 ms on one track", lambda t, r: drawn.hole(t, r, (0.003, 0.012), [do.track(r)]), EITHER),
    Kind("a dropout of 12 to 100 ms on one track", lambda t, r: drawn.hole(t, r, (0.012, 0.1), [do.track(r)]), EITHER),
    Kind("a dropout of 0.1 to 1 s on one track", lambda t, r: drawn.hole(t, r, (0.1, 1.0), [do.track(r)]), EITHER),
    Kind("a dropout of 0.3 to 12 ms on all tracks", lambda t, r: drawn.hole(t, r, (0.0003, 0.012), list(ALL)), EITHER),
    Kind("a dropout of 12 ms to 1 s on all tracks", lambda t, r: drawn.hole(t, r, (0.012, 1.0), list(ALL)), EITHER),
    Kind("dropouts of some tracks", lambda t, r: drawn.hole(t, r, (0.001, 0.2), do.some(r)), EITHER),
    Kind("3 to 30 dropouts", drawn.holes, EITHER),
    Kind("a dropout in the first 50 ms", drawn.early_hole, EITHER),
    Kind("a dropout full of noise", drawn.noisy_hole, EITHER),
    Kind("a dropout full of a tone", drawn.toned_hole, EITHER),
    Kind("a short tone nearly in phase with its track", drawn.tone_in_phase, EITHER),
    Kind("a dropout that hides lost samples", drawn.hole_and_slip, EITHER, False),
    Kind("a dropout while the speed changes", drawn.hole_at_speed, EITHER, False),
    # noise and what else a recorder adds
    Kind("noise of 60 to 40 dB", lambda t, r: do.with_noise(t, r, r.uniform(40, 60)), RIGHT),
    Kind("noise of 40 to 27 dB", lambda t, r: do.with_noise(t, r, r.uniform(27, 40)), EITHER),
    Kind("noise of 27 to 5 dB", lambda t, r: do.with_noise(t, r, r.uniform(5, 27)), EITHER),
    Kind("bursts of noise", drawn.bursts, EITHER),
    Kind("clicks", drawn.clicks, EITHER),
    Kind("hum of 50 to 150 Hz", lambda t, r: do.with_tone(t, r, r.choice([50, 60, 100, 150]), r.uniform(0, 0.5), ALL), EITHER),
    Kind("a tone about the check signal", lambda t, r: do.with_tone(t, r, r.uniform(800, 1200), do.log_uniform(r, 0.001, 0.5), do.some(r)), EITHER),
    Kind("a tone about the carriers", lambda t, r: do.with_tone(t, r, r.uniform(4500, 7500), do.log_uniform(r, 0.001, 0.5), do.some(r)), EITHER),
    Kind("a constant on the tracks", lambda t, r: t.frames + np.float32(drawn.signed(r, 0, 0.35)), EITHER),
    Kind("crosstalk", drawn.crossed, EITHER),
    Kind("print-through", drawn.printed, EITHER),
    Kind("third harmonic", drawn.distorted, EITHER),
    Kind("clipping", drawn.clipped, EITHER),
    Kind("few bits", drawn.coarse, EITHER),
    Kind("low-pass of 5 to 15 kHz", lambda t, r: do.filtered(t, "lowpass", r.uniform(5000, 15000)), EITHER),
    Kind("high-pass of 0.1 to 4 kHz", lambda t, r: do.filtered(t, "highpass", do.log_uniform(r, 100, 4000)), EITHER),
    Kind("the check signal of another place", drawn.other_check, FAULT),
    # cuts and splices
    Kind("the start is cut within the standstill", lambda t, r: t.frames[r.integers(1, 40000) :], RIGHT, False),
    Kind("the start is cut, less than 0.1 s before an axis moves", lambda t, r: t.frames[do.begins(t) - r.integers(1, 4800) :], EITHER, False),
    Kind("the start is cut under way", lambda t, r: t.frames[do.under_way(t, r) :], FAULT, False),
    Kind("the end is cut", lambda t, r: t.frames[: -r.integers(60000, len(t.frames) - 60000)], FAULT),
    Kind("the end is cut within the standstill", lambda t, r: t.frames[: -r.integers(1, 40000)], EITHER),
    Kind("a piece is cut out", drawn.spliced, EITHER, False),
    Kind("the tape twice, one behind the other", lambda t, r: np.concatenate([t.frames, t.frames]), FAULT, False),
    Kind("a phase turns on by one to nine cycles", lambda t, r: drawn.slipped(t, r, float(r.integers(1, 10) * r.choice([-1, 1]))), EITHER),
    Kind("a phase turns on by a part of a cycle", lambda t, r: drawn.slipped(t, r, drawn.signed(r, 0.26, 0.74)), FAULT),
    # what stands between two machines
    Kind("a track's delay begins to drift under way, up to 45 us/s", lambda t, r: chain.drifts_from(t, r, r.uniform(5, 45)), RIGHT, False),
    Kind("a track's delay begins to drift under way, by 10 us/s to 30 ms/s", lambda t, r: chain.drifts_from(t, r, do.log_uniform(r, 10, 30000)), EITHER, False),
    Kind("an older recording beneath, 3 to 45 dB down", chain.older, EITHER, False),
    Kind("an echo", chain.echoed, EITHER, False),
    Kind("a filter comes and goes", lambda t, r: chain.treble_swings(t, r, delays=True), EITHER, False),
    Kind("all-pass filters", chain.all_pass, EITHER, False),
    Kind("an automatic level control", chain.level_control, EITHER),
    Kind("a noise reduction that does not fit", chain.treble_by_level, EITHER, False),
    Kind("treble that comes and goes", lambda t, r: chain.treble_swings(t, r, delays=False), EITHER),
    Kind("the level swings", chain.level_swings, EITHER),
    Kind("the level steps down", chain.level_steps, EITHER),
    Kind("the level fades away", chain.faded, EITHER),
    Kind("mains with many harmonics", chain.buzz, EITHER),
    Kind("a thump", chain.thump, EITHER),
    Kind("second harmonic", chain.second_harmonic, EITHER),
    Kind("samples at jittering moments", chain.jittered, EITHER, False),
    Kind("another take from a moment on", chain.another_take, EITHER, False),
    Kind("another track's signal for a while", chain.other_track, EITHER, False),
    Kind("a buffer is played again and again", chain.stuck, EITHER, False),
    Kind("a track's phase swings", chain.phase_swings, EITHER, False),
)  # fmt: skip
KINDS = (
    *SINGLE,
    Kind("two or three at once", lambda t, r: chain.several(t, r, SINGLE), EITHER, False),
)
