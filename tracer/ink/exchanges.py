"""Exchanges: other ways for the lines of a crossing to go on, each a step from one that is known.

    ─a╲ ╱c─        two lines exchange their partners, or one takes one that has none, or two without are
       ╳           one: of many legs there are too many ways to pair all of them, but a few from any to
    ─d╱ ╲b─        those beside it

Signals: pairs of legs, by their numbers, in; pairs out, in which no more legs are alone.

Source: our own.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations, product

import numpy as np
from numpy.typing import NDArray

from morfax.tracer.ink.partners import Pair, without_partner

Pairs = tuple[Pair, ...]


def exchanges(pairs: Pairs, are_lines: NDArray[np.bool_], about: set[int]) -> list[Pairs]:
    """The ways to pair legs that are a step from some pairs, in which lines of some legs have other partners.

    `are_lines` (n, n) says which legs may be one line; two without partners may be one over a side between
    them, whatever their directions.
    """
    alone = [(leg,) for leg in without_partner(pairs, len(are_lines))]
    found = dict[Pairs, None]()
    for one, other in combinations([*pairs, *alone], 2):
        are_ends = len(one) == len(other) == 1
        if not are_ends and not (about.intersection(one) and about.intersection(other)):
            continue
        kept = [pair for pair in pairs if pair not in (one, other)]
        for new in _joined(one, other):
            if are_ends or all(are_lines[pair] for pair in new):
                found[tuple(sorted((*kept, *new)))] = None
    return list(found)


def _joined(one: tuple[int, ...], other: tuple[int, ...]) -> Iterator[list[Pair]]:
    """The ways to join a leg of one line, or end, with one of another; what is left of both is joined too."""
    for a, b in product(one, other):
        left = [leg for leg in (*one, *other) if leg not in (a, b)]
        new = [(a, b), *([(left[0], left[1])] if len(left) == 2 else [])]
        yield [(min(pair), max(pair)) for pair in new]
