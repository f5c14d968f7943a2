"""The graph of ink: two stretches that are alone at a node become one."""

from __future__ import annotations

import numpy as np

from morfax.tracer.ink.graph import RING, Graph, Stretch

OWN = 1000  # the first pixel that is no node


def graph_of(*nodes: tuple[int, int]) -> Graph:
    """A graph with a stretch of three pixels between each two nodes."""
    stretches = [
        Stretch(ends, np.array([ends[0], OWN + n, ends[1]])) for n, ends in enumerate(nodes)
    ]
    return Graph(np.zeros(0), np.zeros(0), np.zeros(0), stretches)


def joined(graph: Graph) -> list[tuple[tuple[int, int], list[int]]]:
    """What its stretches are once pairs are joined: their nodes and pixels."""
    graph._join_pairs()
    return [(each.nodes, each.pixels.tolist()) for each in graph.stretches]


def test_stretches_in_a_row_become_one_and_those_at_a_fork_stay() -> None:
    # a fork of three at 4; 1 and 2 have two each
    found = joined(graph_of((0, 1), (4, 5), (2, 1), (4, 2), (4, 6)))
    assert found == [
        ((4, 5), [4, OWN + 1, 5]),
        ((4, 6), [4, OWN + 4, 6]),
        ((4, 0), [4, OWN + 3, 2, OWN + 2, 1, OWN, 0]),
    ]


def test_a_row_that_comes_back_to_its_beginning_is_a_ring() -> None:
    ((nodes, pixels),) = joined(graph_of((1, 2), (2, 3), (3, 1)))
    assert nodes == (RING, RING)
    assert sorted(set(pixels)) == [1, 2, 3, OWN, OWN + 1, OWN + 2]


def test_a_long_row_becomes_one_whatever_the_order_of_its_stretches() -> None:
    count = 300
    order = np.random.default_rng(1).permutation(count).tolist()
    ((nodes, pixels),) = joined(graph_of(*((n, n + 1) for n in order)))
    assert sorted(nodes) == [0, count] and len(pixels) == 2 * count + 1
    inner = [pixel for pixel in pixels if pixel < OWN]
    assert inner in (list(range(count + 1)), list(range(count, -1, -1)))
