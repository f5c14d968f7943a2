"""A G-code program on the machine that it is for: which one that is, and how long the program runs there.

The program is read as the machine's control reads it, unless the control that played it has read it. The
time is the machine's own, by its speeds and accelerations; what the simulated machine takes is another.
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
    from morfax.player.gcode.arc_words import Place
    from morfax.player.gcode.check.checked import Checked
    from morfax.player.gcode.moves import Move, Program
    from morfax.recorder.gcode.machine import Machine
    from morfax.recorder.gcode.program_text import Block

    Said = Sequence[tuple[int, str]]


def on_machine(program: FilePath, name: str | None = None) -> Figures:
    """The machine that a G-code program is for, and how long it runs there; nothing of another program."""
    if not medium.is_gcode(program):
        return {}
    from morfax.player.gcode.check.checked import check_program

    machine = machine_for(program, name)
    return _on(machine, duration_s(check_program(program, machine), machine))


def on_machine_as_read(program: Program, name: str | None = None) -> Figures:
    """The same of a program that its control has read already."""
    from morfax.recorder.gcode.machine import machine as of_name

    machine = of_name(name or program.machine) if name or program.machine else of_name()
    start, moves = program.start_mm, program.moves
    if not machine.z:  # the control has moves of Z there, in place of the words for the tool
        start = (*start[:2], 0.0)
        moves = [move._replace(end_mm=(*move.end_mm[:2], 0.0)) for move in moves]
    return _on(machine, _duration_s(start, moves, program.said, machine))


def _on(machine: Machine, running_s: float) -> Figures:
    """A machine and the time there, as figures."""
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
    steps = checked.steps
    start = steps[0].begin_mm if steps else (0.0, 0.0, 0.0)
    return _duration_s(start, [step.move for step in steps], checked.said, machine)


def _duration_s(start: Place, moves: Sequence[Move], said: Said, machine: Machine) -> float:
    """The same of moves from a start, and of the words for the tool before them."""
    from morfax.motion.arrays import Array
    from morfax.recorder.gcode.running_time import running_time_s

    if not moves:
        return 0.0
    import numpy as np

    place: Array = np.array(start)
    blocks = _blocks(start, moves, said)
    return running_time_s(place, blocks, replace(machine, begin=(), end=(), feeds=True))


def _blocks(begin: Place, moves: Sequence[Move], said: Said) -> list[Block]:
    """Moves as blocks, with the words for the tool between them."""
    from morfax.recorder.gcode.program_text import DWELL, WORDS, Block

    words: dict[int, list[str]] = {}
    for number, text in said:
        words.setdefault(number, []).append(text)
    blocks: list[Block] = []
    for number, move in enumerate(moves):
        if number in words:
            blocks.append(Block(WORDS, begin, words=tuple(words[number])))
        if move.dwell_s or move.kind == DWELL:
            blocks.append(Block(DWELL, begin, dwell_s=move.dwell_s))
        else:
            centre = (0.0, 0.0)
            if move.turned_rad:
                centre = move.centre_mm[0] - begin[0], move.centre_mm[1] - begin[1]
            blocks.append(Block(move.kind, move.end_mm, centre, move.feed_mm_s))
        begin = move.end_mm
    return blocks
