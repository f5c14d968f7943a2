"""The pieces of a chain of lines: its clean runs in the order in which the head runs them.

Signals: a chain and the junctions that it goes through in; pieces out, each with what was felt before it.

Source: our own.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from morfax.motion.arrays import Array
from morfax.tracer.ink.chains import Chain, Junctions, Side
from morfax.tracer.ink.run import Run
from morfax.tracer.ink.shared_ink import SharedInk

NOTHING = np.empty((0, 2))  # was felt between


class Piece(NamedTuple):
    """A clean run of a chain, and what was felt between it and the one before, (n, 2) mm.

    None if other lines meet there; then what was felt along the stretches within their junction.
    """

    run: Run
    between: Array | None
    ink: SharedInk | None = None


def pieces_of(chain: Chain, junctions: Junctions) -> list[Piece]:
    """The clean runs of a chain in the order and the sense in which they are run."""
    pieces = list[Piece]()
    for link in chain.links:
        line = junctions.net.lines[link.line]
        there = junctions.at(Side(link.line, link.back))
        alone = len(there.sides) == 2
        runs = [run.turned_round() for run in line.runs[::-1]] if link.back else line.runs
        parted = [places[::-1] for places in line.parted[::-1]] if link.back else line.parted
        pieces.append(Piece(runs[0], NOTHING if alone else None, there.crossing.ink))
        pieces += [Piece(run, places) for run, places in zip(runs[1:], parted, strict=True)]
    return pieces


def cut_open(pieces: list[Piece]) -> list[Piece]:
    """The pieces of a closed chain from the middle of its longest run round to there."""
    k = max(range(len(pieces)), key=lambda n: len(pieces[n].run))
    run, between, ink = pieces[k]
    middle = len(run) // 2
    later, sooner = run.part(middle, len(run)), run.part(0, middle + 1)
    return [Piece(later, NOTHING), *pieces[k + 1 :], *pieces[:k], Piece(sooner, between, ink)]
