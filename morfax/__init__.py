"""morfax: a drawing on paper becomes a program for a machine.

This module is the door of the library. The whole way takes a few lines:

    import morfax

    drawing = morfax.Drawing.open("cam.png")
    motion = morfax.trace(drawing)                        # a stream of Motion
    morfax.record(motion, "cam.wav")
    played = morfax.play("cam.wav")
    print(morfax.distance(motion, played))                # traced against played, mm
    print(morfax.deviation(drawing, played))              # played against the ink's own centre, mm

`import morfax` loads nothing heavy: each name imports its module when the name is first used (PEP 562).

| name | what it does |
| --- | --- |
| `Drawing` | `Drawing.open(file)` reads an image file; its lengths are mm on the sheet |
| `trace`, `trace_lines` | follow one line, or several lines as one program; both give a stream of Motion |
| `record` | writes a motion as a tape or as another program; the suffix of the file names the medium |
| `play` | plays a program on its own machine; gives a stream of Motion |
| `distance`, `deviation` | measure a motion against another motion, or against the ink of a drawing, mm |
| `thin`, `Path` | a stream thinned to the points that matter |
| `read_path`, `write_path` | a Path from and to a file (.csv) |
| `Fault` | the root of all faults of the library |
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Iterable

    from morfax.motion.contour import Contour, Distances
    from morfax.motion.faults import Fault
    from morfax.motion.motion import Motion, Path, thin
    from morfax.motion.pathfile import read_path, write_path
    from morfax.player.controls import play
    from morfax.recorder.media import record
    from morfax.tracer.drawing.deviation import Deviation
    from morfax.tracer.drawing.drawing import Drawing
    from morfax.tracer.program.trace import trace
    from morfax.tracer.program.trace_lines import trace_lines

    Measurable = Contour | Iterable[Motion]

__all__ = [
    "Drawing",
    "Fault",
    "Path",
    "deviation",
    "distance",
    "play",
    "read_path",
    "record",
    "thin",
    "trace",
    "trace_lines",
    "write_path",
]

# the module in which each name lives
_MODULES = {
    "Drawing": "morfax.tracer.drawing.drawing",
    "Fault": "morfax.motion.faults",
    "Path": "morfax.motion.motion",
    "play": "morfax.player.controls",
    "read_path": "morfax.motion.pathfile",
    "record": "morfax.recorder.media",
    "thin": "morfax.motion.motion",
    "trace": "morfax.tracer.program.trace",
    "trace_lines": "morfax.tracer.program.trace_lines",
    "write_path": "morfax.motion.pathfile",
}

if not TYPE_CHECKING:  # a type checker takes the imports above, and so knows a wrong name

    def __getattr__(name: str) -> Any:
        """Import a name of the door when it is first used."""
        if name not in _MODULES:
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        import importlib

        found = getattr(importlib.import_module(_MODULES[name]), name)
        globals()[name] = found
        return found


def __dir__() -> list[str]:
    """List the names of the door."""
    return sorted(__all__)


def distance(path: Measurable, reference: Measurable) -> Distances:
    """Measure a motion from a reference and back, mm.

    Both may be a Trace, a Playback, any other stream of Motion, a Path, or (n, 2) polylines. Only what is run
    with the tool in the work counts. A generator is used up; a Trace and a Playback can be read again.
    """
    from morfax.motion import contour

    return contour.distance(_as_contour(path), _as_contour(reference))


def deviation(drawing: Drawing, path: Measurable) -> Deviation:
    """Measure a motion against the centre of the ink of its drawing, mm; it takes what `distance` takes."""
    from morfax.motion.contour import polylines
    from morfax.motion.motion import Path
    from morfax.tracer.drawing import deviation as measure

    followed = _as_contour(path)
    return measure.deviation(
        drawing, followed if isinstance(followed, Path) else polylines(followed)
    )


def _as_contour(path: Measurable) -> Contour:
    """Thin a stream of Motion to a Path; give back anything else as it is."""
    import numpy as np

    from morfax.motion.motion import Motion, Path, thin

    if isinstance(path, Path | np.ndarray):
        return path
    if isinstance(path, Motion):
        return thin([path])
    if isinstance(path, list | tuple) and not any(isinstance(part, Motion) for part in path):
        return path
    return thin(path)  # type: ignore[arg-type]
