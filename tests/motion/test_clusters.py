"""Clusters of points: those of all pairs within the reach, however crowded the points are."""

import time

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from morfax.motion import clusters as module
from morfax.motion.clusters import _join, clusters
from morfax.motion.neighbours import pairs_within
from morfax.tracer.drawing.components import grouped

LONGEST_S = 5.0  # pairs that crowded fill no memory and take minutes; measured: 0.2 s


@settings(max_examples=30, deadline=None)
@given(st.integers(0, 10_000), st.integers(0, 60), st.booleans())
def test_clusters_are_those_of_all_pairs(seed: int, count: int, on_a_grid: bool) -> None:
    points = np.random.default_rng(seed).uniform(0, 25, (count, 2))
    points = np.round(points) if on_a_grid else points
    assert clusters(points, 2.0).tolist() == grouped(pairs_within(points, 2.0), count).tolist()


def test_the_kernel_does_what_its_source_says(monkeypatch: pytest.MonkeyPatch) -> None:
    points = np.random.default_rng(3).uniform(0, 25, (60, 2))
    compiled = clusters(points, 2.0).tolist()
    monkeypatch.setattr(module, "_join", _join.py_func)
    assert clusters(points, 2.0).tolist() == compiled


def test_crowded_points_take_no_longer() -> None:
    points = np.random.default_rng(1).uniform(0, 1, (60_000, 2)) * (2000.0, 60.0)
    clusters(points[:2], 3.0)
    begun = time.process_time()
    assert clusters(points, 3.0).max() == 0
    assert time.process_time() - begun < LONGEST_S
