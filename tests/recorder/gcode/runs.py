"""Paths that are recorded as blocks, and what blocks say."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from morfax.player.gcode.moves import Move, Program

SAMPLES = Path(__file__).parents[3] / "samples"
FEWEST = {
    "gear": 16,
    "bracket": 9 + 4,
    "cam": 15,
    "curve": 25,
}  # drawn; cam and curve: circles that need not meet


def arc(
    radius: float, first: float, last: float, centre: tuple[float, float] = (0, 0)
) -> np.ndarray:
    """Points of an arc, 1 um of sagitta or less apart."""
    t = np.linspace(first, last, 2 + int(abs(last - first) * math.sqrt(radius / 0.008)))
    return np.array(centre) + radius * np.column_stack([np.cos(t), np.sin(t)])


def run_of(program: Program) -> list[np.ndarray]:
    """The (n, 2) polylines that a program runs at and below the surface, arcs drawn out."""
    place, runs = np.array(program.start_mm), []
    for move in program.moves:
        points = drawn_of(place, move)
        if move.kind != "G4" and place[2] <= 0.05 and move.end_mm[2] <= 0.05:
            runs.append(points)
        place = np.array(move.end_mm)
    return runs


def drawn_of(place: np.ndarray, move: Move) -> np.ndarray:
    if not move.turned_rad:
        return np.array([place[:2], move.end_mm[:2]])
    first = math.atan2(place[1] - move.centre_mm[1], place[0] - move.centre_mm[0])
    radius = math.dist(place[:2], move.centre_mm)
    return arc(radius, first, first + move.turned_rad, move.centre_mm)
