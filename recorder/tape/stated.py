"""The format of a tape as its file states it, or as the operator gives it by hand.

Signals: a source of sound (a file, a pipe, a device) with the text that came with it, in; its format out.
Figures given by hand override the text. A tape that states nothing needs reference and cycles per mm by hand;
its axes are then X, Y, Z … in the order of the tracks, and start at zero.

Questions: a file that a sound program has resampled keeps its text; its own sample rate counts.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path as FilePath
from typing import Any, TypedDict

from morfax.motion.faults import FileFault, TapeFault
from morfax.motion.motion import MOTION_RATE_HZ
from morfax.recorder.sound.source import FileSource, Source
from morfax.recorder.tape.format import LARGEST_TEXT_BYTES, TapeFormat, is_format_text

_UNNAMED_AXES = ("x", "y", "z", "a", "b", "c", "u", "v", "w")
_EXAMPLES = {
    "reference_hz": "--reference-frequency 6kHz",
    "cycles_per_mm": "--cycles-per-mm 20",
}


class TapeEntries(TypedDict, total=False):
    """What an operator gives by hand of a tape; it overrides the tape's text, None leaves it.

    `start_mm`: X, Y … at the start; X and Y alone leave Z as it is. `order`: the tracks of the source, from
    1, on which reference, X, Y … are, where it is not this order. `still`, `alike`: axes that may stand from
    start to end, and that may run alike.
    """

    reference_hz: float | None
    cycles_per_mm: float | None
    start_mm: Sequence[float] | None
    order: Sequence[int] | None
    still: Sequence[str] | None
    alike: Sequence[str] | None


def format_of(source: Source, by_hand: TapeEntries) -> TapeFormat:
    """The tape's format, from its text or by hand; raises TapeFault."""
    entries = {name: by_hand.get(name) for name in _EXAMPLES}
    given: dict[str, Any] = {
        name: value for name, value in entries.items() if value is not None
    }
    stated = _stated(source)
    if stated is None and len(given) < len(_EXAMPLES):
        lacks = " ".join(example for name, example in _EXAMPLES.items() if name not in given)
        raise TapeFault(
            f"{source.name} does not say its format (no text chunk); give its label with --label, or {lacks},"
            " or whatever the tape has"
        )
    try:
        if stated is None:
            return unnamed(source.rate_hz, source.tracks, given)
        if given.get("cycles_per_mm", stated.cycles_per_mm) != stated.cycles_per_mm:
            # another travel for the same phase ends elsewhere
            stated = replace(stated, end_mm=None)
        return replace(stated, sample_rate_hz=source.rate_hz, **given)
    except ValueError as error:
        raise TapeFault(f"{source.name} cannot be played so: {error}") from None


def _stated(source: Source) -> TapeFormat | None:
    """The format in the text; None without one."""
    if not is_format_text(source.text):
        return None
    try:
        fmt = TapeFormat.from_json(source.text)
    except TapeFault as fault:
        raise TapeFault(f"{source.name}: {fault}") from None
    if fmt.tracks != source.tracks:
        raise TapeFault(
            f"{source.name} has {source.tracks} tracks, but its text chunk speaks of {fmt.tracks}: "
            f"reference, {', '.join(fmt.axes)}; take it as it was recorded"
        )
    return fmt


def label_of(file: FilePath) -> str:
    """The text of a label: a file of JSON, or a tape that has a text chunk; raises TapeFault, FileFault."""
    try:
        with file.open("rb") as opened:
            text = opened.read(LARGEST_TEXT_BYTES + 1).decode("utf-8", "replace")
    except OSError as error:
        raise FileFault(f"cannot read {file}: {error.strerror}; check the name") from error
    if not is_format_text(text):
        source = FileSource(file)
        text = source.text
        source.close()
    if not is_format_text(text):
        raise TapeFault(f"{file} is no label: it does not say a tape's format; give another")
    try:
        TapeFormat.from_json(text)
    except TapeFault as fault:
        raise TapeFault(f"{file}: {fault}") from None
    return text


def stated_hz(text: str) -> float:
    """The reference frequency that a text states; the usual one where it states none."""
    is_stated = is_format_text(text)
    return TapeFormat.from_json(text).reference_hz if is_stated else TapeFormat().reference_hz


def unnamed(sample_rate_hz: int, tracks: int, given: dict[str, Any]) -> TapeFormat:
    """The format of a tape that states none: axes by the order of the tracks, from zero on all of them."""
    return TapeFormat(
        sample_rate_hz=sample_rate_hz,
        axes=_UNNAMED_AXES[: tracks - 1],
        dwell_s=0.0,
        samples_per_motion=max(2, round(sample_rate_hz / MOTION_RATE_HZ)),
        **given,
    )


def allowed(
    fmt: TapeFormat, still: Sequence[str] | None, alike: Sequence[str] | None
) -> TapeFormat:
    """The format with axes that may stand, or run alike, by hand; raises TapeFault for no axes of it."""
    if still is None and alike is None:
        return fmt
    try:
        return replace(
            fmt, still=(*fmt.still, *(still or ())), alike=(*fmt.alike, *(alike or ()))
        )
    except ValueError as error:
        raise TapeFault(f"the tape cannot be played so: {error}") from None


def started(fmt: TapeFormat, start_mm: Sequence[float] | None) -> TapeFormat:
    """The format with a start given by hand, for the axes given; the end moves by the same distance."""
    if start_mm is None:
        return fmt
    if len(start_mm) > len(fmt.axes):
        raise TapeFault(
            f"the start was given {len(start_mm)} places; the tape has {len(fmt.axes)} axes"
        )
    start = tuple(float(mm) for mm in start_mm) + fmt.start_mm[len(start_mm) :]
    shifts = [new - old for new, old in zip(start, fmt.start_mm, strict=True)]
    end = (
        None
        if fmt.end_mm is None
        else tuple(mm + by for mm, by in zip(fmt.end_mm, shifts, strict=True))
    )
    return replace(fmt, start_mm=start, end_mm=end)
