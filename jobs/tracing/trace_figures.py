"""Figures of a traced drawing: its lines, stops and junctions, and what the cutter leaves."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from morfax.tracer.cutter.cutter import Cutter, Left
    from morfax.tracer.ink.hatching import Hatching
    from morfax.tracer.ink.left_out import Area
    from morfax.tracer.program.against_ink.unexplained import Kind
    from morfax.tracer.program.lines.small_rings import SmallPatch
    from morfax.tracer.program.program import Trace


UNEXPLAINED: dict[Kind, str] = {
    "ink": "ink beside the way",
    "tip": "tip cut short",
    "aside": "way beside the edge",
    "bare": "way without ink",
    "beside": "way beside its ink",
    "crossed": "way that crosses itself",
    "broad": "way within ink as broad as two lines or more",
    "off": "strokes off their ink",
    "pale": "pixels too large to tell",
}


def lines(
    trace: Trace, cell_shares: Mapping[int, float], *, on_edges: bool = False
) -> dict[str, Any]:
    """What the head found of each line, in the order in which the lines are cut; an edge has no width.

    `cell_shares` are the swinging cell's shares of the lines, by their numbers.
    """
    rows: list[dict[str, Any]] = [
        {
            "line": line.number,
            "ending": line.ending,
            "length_mm": line.length_mm,
            **({} if on_edges or line.on_edge else {"line_width_mm": line.width_mm}),
            **({"outline": True} if line.on_edge else {}),
            "edge_roughness_mm": line.roughness_mm,
            "start_place_mm": line.start_mm,
            "cell_share": cell_shares.get(line.number),
        }
        for line in trace.lines
    ]
    return {
        "idle_mm": trace.idle_mm,
        "patches_left_out": trace.left_out,
        "ink_left_out_mm": trace.left_out_mm,
        **({"lettering_left_out": list(trace.letters_out)} if trace.letters_out else {}),
        **_small_patches("small_closed_lines_left_out", trace.small_rings),
        **_small_patches("unclear_lines_left_out", trace.unclear),
        **ink(trace),
        "lines": rows,
    }


def solid_areas(areas: Sequence[Area]) -> dict[str, Any]:
    """Where solid areas among lines are, and how large."""
    rows = [{"solid_place_mm": area.place_mm, "solid_mm2": area.area_mm2} for area in areas]
    return {"solid_areas": rows or None}


def ink(trace: Trace) -> dict[str, Any]:
    """How much of the ink was followed, and what was left out, where all of it was asked for."""
    if trace.ink is None:
        return {}
    balance = trace.ink
    return {
        "ink_followed_share": balance.followed_share,
        "ink_followed_mm": balance.followed_mm,
        "specks_left_out_mm": balance.specks_mm,
        "pale_lines_left_out_mm": balance.pale_mm,
        "doubled_ink_run_once_mm": balance.single_mm,
        "filled_shapes_left_out_mm": balance.solid_mm,
        "lettering_followed_mm": balance.lettering_mm,
        "lettering_left_out_mm": balance.letters_mm,
        **solid_areas(balance.solids),
        "outlined_areas": [
            {"outlined_place_mm": area.place_mm, "outlined_mm2": area.area_mm2}
            for area in balance.areas
            if area.what == "outlined area"
        ]
        or None,
        "hatching": [_hatched(family) for family in balance.hatching] or None,
        "places_left_out": _along("left_out", balance.lost) or None,
        "places_run_once": _along("doubled", balance.single) or None,
    }


def _hatched(family: Hatching) -> dict[str, Any]:
    """A family of hatching strokes."""
    return {
        "hatching_place_mm": family.place_mm,
        "strokes": len(family.strokes),
        "hatching_mm": family.length_mm,
        "apart_mm": family.apart_mm,
        "heading_deg": math.degrees(family.heading_rad),
    }


def _along(what: str, stretches: Sequence[tuple[float, float, float]]) -> list[dict[str, Any]]:
    """Where some stretches are and how long, by what they are."""
    return [
        {f"{what}_place_mm": (x, y), f"{what}_mm": length_mm} for x, y, length_mm in stretches
    ]


def _small_patches(name: str, patches: Sequence[SmallPatch]) -> dict[str, Any]:
    """The places and sizes of patches of ink that were left out, under a name; nothing if there are none."""
    rows = [{"left_out_place_mm": p.place_mm, "across_mm": p.across_mm} for p in patches]
    return {name: rows} if rows else {}


def unexplained(trace: Trace) -> list[dict[str, Any]]:
    """Places at which closed lines are not what is drawn."""
    return [
        {
            "unexplained_place_mm": place.place_mm,
            "unexplained_mm": place.length_mm,
            "what": UNEXPLAINED[place.kind],
        }
        for place in trace.unexplained
    ]


def lost_outlines(trace: Trace) -> list[dict[str, Any]]:
    """Outlines that were left out: where the head was lost, and how long they are."""
    return [
        {"lost_outline_place_mm": lost.place_mm, "lost_outline_mm": lost.length_mm}
        for lost in trace.lost_outlines
    ]


def leads(trace: Trace) -> list[dict[str, Any]]:
    """The leads that closed lines were given: where the tool comes onto the line, and their sizes."""
    return [
        {
            "of_line": line.number,
            "cut_begins_place_mm": line.place(line.first),
            "lead_in_mm": line.leads.in_mm or None,
            "lead_out_mm": line.leads.out_mm or None,
        }
        for line in trace.lines
        if line.leads is not None
    ]


def stops(trace: Trace) -> list[dict[str, Any]]:
    """The stops, by number: what kind of mark, where, and where Z goes."""
    return [
        {
            "stop": action.halt.number,
            "mark": action.halt.kind,
            "stop_place_mm": action.halt.place_mm,
            "z_mm": [move.to_mm for move in action.moves],
        }
        for actions in trace.actions
        for action in actions
        if action.halt.number is not None
    ]


def tabs(trace: Trace) -> list[dict[str, Any]]:
    """The holding tabs, numbered along the program: of which line, and where."""
    places = [
        (line.number, tab.place_mm)
        for line, tabs in zip(trace.lines, trace.tabs, strict=True)
        for tab in tabs
    ]
    return [
        {"tab": k, "of_line": number, "tab_place_mm": place_mm}
        for k, (number, place_mm) in enumerate(places, 1)
    ]


def junctions(trace: Trace, *, numbered: bool) -> list[dict[str, Any]]:
    """The junctions on each line, in the order that the card's `turns` count; lines may be numbered."""
    return [
        {
            "junction": k,
            **({"of_line": line.number} if numbered else {}),
            "junction_place_mm": place_mm,
        }
        for line in trace.lines
        for k, place_mm in enumerate(line.junctions_mm, 1)
    ]


def of_cutter(cutter: Cutter, left: Left) -> dict[str, Any]:
    """The cutter, the lines that it leaves out, and the stretches that it cannot reach."""
    left_out = [
        {
            "line_left_out": out.line,
            "length_mm": out.length_mm,
            "middle_place_mm": out.room.place_mm if out.room else None,
            "room_mm": out.room.wide_mm if out.room else None,
            "cutter_up_to_mm": out.room.passes_mm if out.room else None,
            "stops_left_out": list(out.stops) or None,
        }
        for out in left.lines
    ]
    unreached = [
        {
            "unreached": k,
            "of_line": stretch.line,
            "place_mm": stretch.place_mm,
            "left_mm": stretch.left_mm,
            "stretch_mm": stretch.length_mm,
        }
        for k, stretch in enumerate(left.stretches, 1)
    ]
    return {
        "cutter_diameter_mm": cutter.diameter_mm,
        "side": cutter.side,
        "lines_left_out": left_out or None,
        "unreached": unreached or None,
    }
