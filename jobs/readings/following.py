"""Following errors of a run: the chart that takes them down, their figures, and the speeds held."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from morfax.player.controls import Playback
    from morfax.player.gcode.held_speed import HeldSpeed
    from morfax.player.monitor.chart import Chart

Speeds = dict[str, "HeldSpeed"]


def new_chart(raw: bool) -> Chart:
    """A chart that takes down every sample, or of each 10 ms the one nearest to its limit."""
    from morfax.player.monitor.chart import Chart

    return Chart(0.0) if raw else Chart()


def speeds_held(playback: Playback) -> Speeds | None:
    """The speed that a program of lines and arcs holds, by the patent's weights and by a true norm."""
    from morfax.player.gcode.held_speed import held_speed
    from morfax.player.gcode.pulses import PulsePlayback

    if not isinstance(playback, PulsePlayback):
        return None
    return {"weights": held_speed(playback, False), "--norm true": held_speed(playback, True)}


def figures(playback: Playback) -> dict[str, Any]:
    """The largest following error of each axis, and the share of its limit."""
    watch = playback.monitor
    errors_mm, shares = watch.largest_error_mm.tolist(), watch.largest_share.tolist()
    return {
        f"{axis}_axis": {"following_error_mm": error_mm, "limit_share": share}
        for axis, error_mm, share in zip(watch.axes, errors_mm, shares, strict=True)
    }
