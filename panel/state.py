"""The state of the bench as a page gets it: plain values that JSON holds, with units in their names."""

from __future__ import annotations

from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from morfax.jobs.wrong_use import WrongUse
from morfax.motion.faults import Fault
from morfax.panel import actions, commands
from morfax.panel.tiles import TILE

if TYPE_CHECKING:
    from morfax.panel.bench import Bench


def hello(bench: Bench) -> dict[str, Any]:
    """What does not change while the server runs."""
    return {"fields": [asdict(field) for field in bench.command_line.fields()], "tile": TILE}


def state(bench: Bench) -> dict[str, Any]:
    """All that a page shows, but for the head's path and the result's curves."""
    history, now = bench.history, bench.history.now
    return {
        "revision": history.revision,
        "drawing": now.drawing if now.drawing in bench.sources else None,
        "sources": sorted(bench.sources),
        "options": now.options,
        "usual_lines": _usual_lines(bench),
        "can_undo": history.can_undo,
        "can_redo": history.can_redo,
        "picture": _picture(bench),
        "sheet": bench.sheet,
        "refused": bench.refused,
        "busy": bench.busy,
        "messages": list(bench.messages),
        "commands": _commands(bench),
        "files": bench.kept.files(),
        "own": sorted(bench.own),
        "result": _result(bench),
    }


def _picture(bench: Bench) -> dict[str, Any] | None:
    """The picture's size in pixels, its levels, and the number by which its tiles are asked for."""
    picture = bench.picture
    if picture is None:
        return None
    lines = (
        None if bench.line_map is None else bench.sheet and bench.sheet["figures"]["drawing"]
    )
    return {
        "id": bench.picture_id,
        "rows": picture.rows,
        "columns": picture.columns,
        "levels": len(picture.levels),
        "has_lines": lines is not None and bench.line_map is not None,
    }


def _usual_lines(bench: Bench) -> str | None:
    """The lines that are followed where none are chosen: those of the cutter or machine; None: one line."""
    if bench.drawing is None:
        return None
    chosen = {"--lines", "--order"}
    options = {name: value for name, value in bench.options.items() if name not in chosen}
    try:
        words = commands.run_words(bench.drawing, options, bench.folder)
        return bench.command_line.run(words).usual_lines()
    except (WrongUse, Fault):
        return None


def _commands(bench: Bench) -> dict[str, str]:
    """The commands that do what the page does."""
    drawing = bench.drawing
    if drawing is None:
        return {}
    typed = {
        "lines": commands.as_typed("lines", commands.lines_words(drawing, bench.options)),
        "run": commands.as_typed("run", bench.words()),
    }
    if bench.corrected_by is not None:
        typed["correct"] = commands.as_typed("correct", bench.corrected_by)
    result = bench.kept.result
    if result is not None and result.get("program") is not None:
        share = float(result.get("override", 1.0))
        typed["play"] = commands.as_typed("play", actions.override_words(bench, share))
    for suffix in actions.SAVED_AS:
        if suffix == actions.PAGE or (
            suffix == actions.PROGRAM and "--machine" not in bench.history.now.options
        ):
            continue
        try:
            typed[suffix] = commands.as_typed("trace", actions.save_words(bench, suffix))
        except (WrongUse, Fault):
            continue
    return typed


def _result(bench: Bench) -> dict[str, Any] | None:
    """Whether there is a result, and whether it is one of what is set now."""
    if bench.kept.result is None:
        return None
    is_of_now = bench.drawing is not None and bench.kept.words == bench.words()
    override = bench.kept.result.get("override", 1.0)
    return {"of": bench.kept.words, "is_of_now": is_of_now, "override": override}
