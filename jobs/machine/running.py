"""A G-code program on the machine that it is for: which one that is, and how long the program runs there.

The program is read as the machine's control reads it. The time is the machine's own, by its speeds and
accelerations; what the simulated machine takes that plays the program is another.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path as FilePath
from typing import TYPE_CHECKING

from morfax.jobs.figures import Figures
from morfax.jobs.media import files as medium
from morfax.jobs.wrong_use import WrongUse, settings_checked

if TYPE_CHECKING:
    from morfax.player.gcode.check.checked import Checked
    from morfax.player.gcode.check.steps import Step
    from morfax.recorder.gcode.machine import Machine
    from morfax.recorder.gcode.program_text import Block


def on_machine(program: FilePath, name: str | None = None) -> Figures:
    """The machine that a G-code program is for, and how long it runs there; nothing of another program."""
    if not medium.is_gcode(program):
        return {}
    from morfax.player.gcode.check.checked import check_program

    machine = machine_for(program, name)
    running_s = duration_s(check_program(program, machine), machine)
    return {"machine": machine.name, "machine_duration_s": running_s}


def machine_for(program: FilePath, name: str | None) -> Machine:
    """The machine of that name or file; without, the one that the program names, or the default."""
    from morfax.player.gcode.machine_reader import machine_of
    from morfax.recorder.gcode.machine import machine

    if name is None:
        lines = program.read_bytes().decode("latin-1").splitlines()
        return machine_of(lines, str(program)) or machine()
    with settings_checked():
        made = machine(name)
    if not medium.is_gcode(FilePath(f"program{made.suffix}")):
        raise WrongUse(
            f"--machine {made.name} takes no G-code, and check reads G-code alone; give a machine that "
            "takes it, `morfax machines` lists them"
        )
    return made


def duration_s(checked: Checked, machine: Machine) -> float:
    """How long the machine runs: its speeds and accelerations, and the dwells of the program."""
    from morfax.motion.arrays import Array
    from morfax.recorder.gcode.running_time import running_time_s

    if not checked.steps:
        return 0.0
    import numpy as np

    start: Array = np.array(checked.steps[0].begin_mm)
    blocks = _blocks(checked.steps, checked.said)
    return running_time_s(start, blocks, replace(machine, begin=(), end=(), feeds=True))


def _blocks(steps: Sequence[Step], said: Sequence[tuple[int, str]]) -> list[Block]:
    """Steps as blocks, with the words for the tool between them."""
    from morfax.recorder.gcode.program_text import DWELL, WORDS, Block

    words: dict[int, list[str]] = {}
    for number, text in said:
        words.setdefault(number, []).append(text)
    blocks: list[Block] = []
    for number, step in enumerate(steps):
        if number in words:
            blocks.append(Block(WORDS, step.begin_mm, words=tuple(words[number])))
        move = step.move
        if move.dwell_s or move.kind == DWELL:
            blocks.append(Block(DWELL, step.begin_mm, dwell_s=move.dwell_s))
            continue
        centre = (0.0, 0.0)
        if move.turned_rad:
            centre = move.centre_mm[0] - step.begin_mm[0], move.centre_mm[1] - step.begin_mm[1]
        blocks.append(Block(move.kind, move.end_mm, centre, move.feed_mm_s))
    return blocks
