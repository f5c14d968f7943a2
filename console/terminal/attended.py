"""The operator at the terminal: asked for the decades at every stop (--ask), and for the button if the card
says so.

Questions go to stderr, answers come from stdin. An answer is a move (down 7mm 5mm/s), a dwell (dwell 2s) or
a drill cycle (drill 8mm, or drill 8mm peck 2mm); an empty one ends the stop. Without any answer the usual
moves are made, which the question names.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Sequence
from typing import TYPE_CHECKING

import click

from morfax.motion.faults import CardFault
from morfax.motion.units import format_length_mm, format_time_s

if TYPE_CHECKING:
    from morfax.tracer.operator.card import Stop
    from morfax.tracer.operator.work import Halt
    from morfax.tracer.operator.zunit import QuillMove

# of the drill above its hole: any speed serves to try whether the counters can show a move
ANY_MM_S = 50.0
ANSWERS = "down LENGTH [FEED], up LENGTH [FEED], dwell TIME, drill DEPTH [peck LENGTH]"


class Attended:
    """The Panel of a terminal."""

    def __init__(self, *, asking: bool) -> None:
        self._asking = asking

    def ask(self, halt: Halt, z_mm: float, usual: Sequence[QuillMove]) -> Stop | None:
        """Ask for the moves at a stop; None without an answer: the usual ones."""
        if not self._asking:
            return None
        click.echo(
            f"{_stop(halt)}, Z {format_length_mm(z_mm)}: {ANSWERS}; or nothing: {_told(z_mm, usual)}",
            err=True,
        )
        entry = ""
        while True:
            answer = click.prompt("  Z", default="", show_default=False, err=True).strip()
            if not answer:
                return _read(entry) if entry else None
            try:
                more = entry + _toml(answer)
                _read(more).motor_moves(z_mm, ANY_MM_S, _stop(halt))
                entry = more
            except (CardFault, ValueError) as fault:
                click.echo(
                    f"  {answer!r} cannot be set: {fault}; give {ANSWERS}, or nothing to go on",
                    err=True,
                )

    def wait(self, halt: Halt) -> float:
        """Wait for the button, while the tape runs; for how long, s."""
        began = time.perf_counter()
        click.prompt(
            f"{_stop(halt)}: press Enter to go on",
            default="",
            show_default=False,
            prompt_suffix="",
            err=True,
        )
        return time.perf_counter() - began


def panel(*, asking: bool) -> Attended | None:
    """The operator at the terminal, None without a terminal; wrong use if he is to be asked there."""
    if at_terminal():
        return Attended(asking=asking)
    if asking:
        raise click.UsageError(
            "--ask needs a terminal to ask at; write a card instead, see docs/reference/card.md"
        )
    return None


def at_terminal() -> bool:
    """Whether there is somebody to ask."""
    return sys.stdin.isatty()


def _stop(halt: Halt) -> str:
    x, y = halt.place_mm
    return f"stop {halt.number} ({halt.kind}) at {x:.2f}, {y:.2f} mm"


def _told(z_mm: float, moves: Sequence[QuillMove]) -> str:
    """Moves from a height of Z, as the operator reads them."""
    said = []
    for move in moves:
        said += [f"to Z {format_length_mm(move.to_mm)}"] if move.to_mm != z_mm else []
        said += [f"dwell {format_time_s(move.dwell_s)}"] if move.dwell_s else []
        z_mm = move.to_mm
    return ", ".join(said) or "go on"


def _toml(answer: str) -> str:
    """An answer as the lines of a card that say the same."""
    words = answer.split()
    if words[0] in ("down", "up") and len(words) in (2, 3):
        feed = f', feed = "{words[2]}"' if len(words) == 3 else ""
        return f'move {{ {words[0]} = "{words[1]}"{feed} }}\n'
    if words[0] == "dwell" and len(words) == 2:
        return f'move {{ dwell = "{words[1]}" }}\n'
    if words[0] == "drill" and len(words) in (2, 4) and words[2:3] in ([], ["peck"]):
        peck = f', peck = "{words[3]}"' if len(words) == 4 else ""
        return f'drill {{ depth = "{words[1]}"{peck} }}\n'
    raise ValueError("it is no move")


def _read(entry: str) -> Stop:
    """What the answers so far say, as the entry of a card; raises CardFault for a mistake."""
    from morfax.tracer.operator.card import Card

    lines = [line.split(" ", 1) for line in entry.splitlines()]
    moves = [said for kind, said in lines if kind == "move"]
    drills = [f"drill = {said}\n" for kind, said in lines if kind == "drill"]
    listed = f"moves = [{', '.join(moves)}]\n" if moves else ""
    return Card.parse("".join(["[[stop]]\n", listed, *drills]), "answer").stop(1)
