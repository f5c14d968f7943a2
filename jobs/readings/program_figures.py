"""What is in a program that is no tape: format, length, travel."""

from __future__ import annotations

from pathlib import Path as FilePath
from typing import Any

import numpy as np

from morfax.jobs.media.files import is_gcode


def of_program(file: FilePath, machine: str | None) -> dict[str, Any]:
    """The figures of a program, of G-code as a machine reads it; raises ProgramFault and FileFault."""
    if is_gcode(file):
        return _of_blocks(file, machine)
    by_medium = {".steps": _of_steps, ".cubic": _of_cubic}
    return by_medium.get(file.suffix.lower(), _of_other)(file)


def _of_steps(file: FilePath) -> dict[str, Any]:
    """A step program: what its header says, and what its rows do."""
    from morfax.player.steps.stepping import play_steps
    from morfax.recorder.steps.file import read_program

    rows, playback = read_program(file).rows, play_steps(file)
    fmt, places = playback.format, np.cumsum(playback.pulses, axis=0)
    vector_rows = int(np.count_nonzero(~rows & 0b1_0000))
    return {
        "step_mm": fmt.step_mm,
        "oscillator_hz": fmt.oscillator_hz,
        "interval_s": fmt.interval_s,
        "rates": " ".join(map(str, fmt.rates)),
        "channels": fmt.channels,
        "vectors_in_a_row": fmt.vectors,
        "rows": len(rows),
        "vector_rows": vector_rows,
        "intervals": len(playback.pulses),
        "duration_s": playback.duration_s,
        "tool_changes": len(playback.tool_changes),
        **_places(np.vstack([np.zeros((1, 3)), places]) * fmt.step_mm + playback.start_mm),
    }


def _of_cubic(file: FilePath) -> dict[str, Any]:
    """A cubic program: what its header says, and where its samples lie."""
    from morfax.player.cubics.cubic import play_cubic

    playback = play_cubic(file)
    fmt, program = playback.format, playback.program
    checks = np.array(list(program.checks.values())) / fmt.counts_per_mm
    return {
        "interval_s": fmt.interval_s,
        "points": fmt.points,
        "steps_to_a_cubic_one": fmt.linear,
        "counts_per_mm": fmt.counts_per_mm,
        "speed_modulus": f"{fmt.modulus_per_s:g} mm/s per mm",
        "intervals": len(program.words),
        "checked_places": len(program.checks),
        "duration_s": playback.duration_s,
        "start_place_mm": checks[0],
        "end_place_mm": checks[-1],
    }


def _of_blocks(file: FilePath, machine: str | None) -> dict[str, Any]:
    """A program of lines and arcs: what it holds, its feeds, and where it goes."""
    from morfax.player.gcode.moves import DWELL, RAPID
    from morfax.player.gcode.pulses import play_pulses

    playback = play_pulses(file, machine=machine)
    moves = playback.program.moves
    feeds = [move.feed_mm_s for move in moves if move.feed_mm_s] or [0.0]
    places = np.array([playback.program.start_mm, *(move.end_mm for move in moves)])
    return {
        "rapids": sum(move.kind == RAPID for move in moves),
        "arcs": sum(move.turned_rad != 0 for move in moves),
        "lines": sum(move.kind not in (RAPID, DWELL) and not move.turned_rad for move in moves),
        "slowest_feed_mm_s": min(feeds),
        "fastest_feed_mm_s": max(feeds),
        "duration_s": playback.duration_s,
        **_places(places),
    }


def _of_other(file: FilePath) -> dict[str, Any]:
    """Any other program: what its control tells before it plays."""
    from morfax.player.controls import play

    playback = play(file)
    return {"duration_s": playback.duration_s, "start_place_mm": playback.start_mm}


def _places(places_mm: Any) -> dict[str, Any]:
    """Start and end, and the reach of each axis."""
    reach = {
        f"{axis}_axis": {"from_mm": low, "to_mm": high} for axis, low, high in _reach(places_mm)
    }
    return {"start_place_mm": places_mm[0], "end_place_mm": places_mm[-1], **reach}


def _reach(places_mm: Any) -> list[tuple[str, float, float]]:
    """Lowest and highest place of each axis, mm."""
    return list(
        zip("xyz", places_mm.min(axis=0).tolist(), places_mm.max(axis=0).tolist(), strict=True)
    )
