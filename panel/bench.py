"""The bench: one drawing, what is set for it, the run that is under way, and its result.

Signals in: the operator's actions (see `actions`), and what the worker says. Signals out: all of it as plain
values, to as many pages as look on; each asks for what is new when it is ready: a slow one holds nothing up.

Questions: one drawing lies on the bench at a time; another server on another port has a bench of its own.
"""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path as FilePath
from typing import Any

from morfax.panel import commands, sheet_picture
from morfax.panel.commands import CommandLine, Options
from morfax.panel.corrected import corrections_text, lay_corrections
from morfax.panel.head_path import ShownPath
from morfax.panel.history import History, HistoryStep
from morfax.panel.kept_result import STATE, KeptResult
from morfax.panel.own_files import as_paths, own_files
from morfax.panel.tiles import LineMap, Pyramid
from morfax.panel.uploads import taken_in
from morfax.panel.workshop import Heard, Workshop, why_ended

MESSAGES = 40  # lines of notes and warnings that are kept
HIDDEN = ("numbers", "picture")  # of what the worker says of a drawing: arrays, for the tiles


class Bench:
    """What lies on the bench."""

    def __init__(
        self,
        folder: FilePath,
        sources: Mapping[str, FilePath],
        command_line: CommandLine,
        workshop: Callable[[Heard], Workshop] = Workshop,
    ) -> None:
        self.folder, self.command_line = folder, command_line
        self.sources = {**sources, **taken_in(folder)}  # by the names that pages know them by
        self.own = own_files(folder)  # cards, settings and machines, by name
        self.history = History(folder / STATE)
        self.workshop = workshop(self.heard)
        self.path = ShownPath()
        self.picture: Pyramid | None = None
        self.line_map: LineMap | None = None
        self.sheet: dict[str, Any] | None = None
        self.refused: str | None = None  # why the drawing cannot be looked at
        self.busy: dict[str, Any] | None = None
        self.messages = deque[dict[str, Any]](maxlen=MESSAGES)
        self.kept = KeptResult(folder)
        self.corrected_by: list[str] | None = None  # the words of the last correction
        self.version = 0  # grows with each change of the state
        self._waiting = set[asyncio.Event]()
        self._job, self._picture_of, self._looked_at = 0, "", list[str]()
        self.picture_id = 0
        self._tasks = set[asyncio.Task[Any]]()

    @property
    def drawing(self) -> FilePath | None:
        """The drawing's file; None if none lies there."""
        return self.sources.get(self.history.now.drawing or "")

    def words(self) -> list[str]:
        """The words of the run as it is set now."""
        assert self.drawing is not None
        return commands.run_words(self.drawing, self.options, self.folder)

    @property
    def options(self) -> Options:
        """The options as they are set now, with paths for the operator's own files."""
        return as_paths(self.history.now.options, self.own)

    async def begin(self) -> None:
        """Take up the work where it was, also a run that was cut off (see `kept_knots`)."""
        await self.workshop.start()
        was_running = self.history.running
        self.look()
        if was_running and self.drawing is not None:
            self.tell("note", "the server was ended in the middle of this run; it goes on")
            self.run()

    async def close(self) -> None:
        """End the worker; what is on disk stays."""
        await self.workshop.close()

    # pages
    def look_on(self) -> asyncio.Event:
        """A new page looks on: the event is set whenever there is something new."""
        event = asyncio.Event()
        event.set()
        self._waiting.add(event)
        return event

    def look_away(self, event: asyncio.Event) -> None:
        """A page looks on no more."""
        self._waiting.discard(event)

    def changed(self, *, state: bool = True) -> None:
        """Tell all pages that there is something new: the state, or the head's path alone."""
        self.version += state
        for event in self._waiting:
            event.set()

    # what the operator does
    def step(self, step: HistoryStep) -> None:
        """Take a step, and look at the drawing again if that changed what is seen on it."""
        drawing = self.sources.get(step.drawing or "")
        self.history.add(replace(step, corrections=corrections_text(drawing)))
        self.look()

    def again(self, what: str) -> None:
        """Undo or redo a step, and lay its corrections beside the drawing; an edit by hand is a step too."""
        if (
            self.drawing is not None
            and corrections_text(self.drawing) != self.history.now.corrections
        ):
            self.step(self.history.now)
        getattr(self.history, what)()
        if self.drawing is not None:
            lay_corrections(self.drawing, self.history.now.corrections)
        self.look()

    def look(self) -> None:
        """Show the drawing that lies there, and have its lines looked at if they were not."""
        self.changed()
        if self.drawing is None:
            self._clear()
            return
        shown = sheet_picture.key(self.drawing, self.options)
        words = commands.lines_words(self.drawing, self.options)
        looked_at = [*words, corrections_text(self.drawing)]
        if shown != self._picture_of:
            self._picture_of, self.line_map, self.sheet = shown, None, None
            self._in_background(self._show())
        if looked_at != self._looked_at:
            self._looked_at, self.refused = looked_at, None
            self.send("lines", self.command_line.lines(words))

    def _clear(self) -> None:
        """Show no drawing: undo has taken the first one off the bench."""
        self.picture, self.line_map, self.sheet, self.refused = None, None, None, None
        self._picture_of, self._looked_at = "", []

    def run(self) -> None:
        """Begin a run as it is set; raises WrongUse for settings that do not go together."""
        job = self.command_line.run(self.words())
        self.path.clear()
        self.kept.begin(self.words())
        self.history.mark_running(True)
        self.send("run", job)

    def send(self, kind: str, job: Any) -> None:
        """Give the worker a job."""
        self._job += 1
        if kind != "lines" or self.busy is None:
            self.busy = {
                "number": self._job,
                "kind": kind,
                "what": "waiting",
                "share": 0.0,
                "held": False,
            }
        self.changed()
        self._in_background(self.workshop.send("job", self._job, kind, job))

    def control(self, what: str, *more: Any) -> None:
        """Hold, resume, step, stop, or another pace for what is under way."""
        if self.busy is not None and what in ("hold", "resume", "step", "stop"):
            self.busy["held"] = what == "hold"
        self.changed()
        self._in_background(self.workshop.send(what, *more))

    # what the worker says
    def heard(self, message: dict[str, Any]) -> None:
        """Take in a message of the worker."""
        what = message.pop("say")
        if what == "head":
            self.path.add(message)
            self.changed(state=False)
            return
        {
            "begun": self._begun,
            "progress": self._progress,
            "note": lambda m: self.tell("note", m["text"]),
            "warning": lambda m: self.tell("warning", m["text"]),
            "done": self._done,
            "failed": self._failed,
            "stopped": lambda m: self._end(
                m, "stopped at the panel; nothing unfinished was written"
            ),
            "ended": self._ended,
        }[what](message)
        self.changed()

    def tell(self, kind: str, text: str, place_mm: Any = None) -> None:
        """Put a line among the messages, once."""
        line = {"kind": kind, "text": text, "place_mm": place_mm}
        if line not in self.messages:
            self.messages.append(line)

    def _begun(self, message: dict[str, Any]) -> None:
        """A job has begun."""
        self.busy = {**message, "what": "", "share": 0.0, "held": False}

    def _progress(self, message: dict[str, Any]) -> None:
        """A job has come further."""
        if self.busy is not None:
            self.busy |= message

    def _done(self, message: dict[str, Any]) -> None:
        """A job is done."""
        kind, result = message["kind"], message["result"]
        if kind == "correct":
            self.busy = None
            self.step(self.history.now)
            return
        if kind == "lines":
            is_newest = message["number"] == self._job
            if is_newest or self.busy is None or self.busy["kind"] == "lines":
                self._seen(result)
        else:
            {"run": self.kept.keep, "play": self.kept.play_again}.get(kind, self._saved)(result)
            for text in result.get("faults", ()):
                self.tell("fault", text, result.get("fault_place_mm"))
        self._free(kind)

    def _saved(self, result: dict[str, Any]) -> None:
        """A result was written."""
        self.tell("saved", f"saved {FilePath(result['file']).name}")
        if result["fault"]:
            self.tell("fault", result["fault"])

    def _seen(self, seen: dict[str, Any]) -> None:
        """The drawing was looked at; it may have been taken off the bench meanwhile."""
        if self.drawing is None:
            return
        self.line_map = LineMap(seen["numbers"])
        if seen["picture"] is not None:
            self.picture = Pyramid(seen["picture"])
            self.picture_id += 1
        self.sheet = {name: value for name, value in seen.items() if name not in HIDDEN}
        self.refused = None

    def _failed(self, message: dict[str, Any]) -> None:
        """A job went wrong."""
        if message["kind"] == "lines":
            self.refused, self.sheet, self.line_map = message["text"], None, None
        else:
            self.tell("fault", message["text"], message["place_mm"])
        self._free(message["kind"])

    def _end(self, message: dict[str, Any], text: str) -> None:
        """A job was stopped."""
        self.tell("note", text)
        self._free(message["kind"])

    def _ended(self, message: dict[str, Any]) -> None:
        """The worker ended by itself, or was ended by the operator."""
        if self.busy is not None:
            why = why_ended(message["code"])
            self.tell(
                "fault",
                f"the worker ended before the work was done ({why}); what is set is kept: run again",
            )
        self._looked_at = []
        self._free("run")

    def _free(self, kind: str) -> None:
        """Nothing is under way any more."""
        self.busy = None
        if kind == "run":
            self.history.mark_running(False)

    # work beside the answers
    async def _show(self) -> None:
        """Read the picture that is shown, beside the worker, so that it is there at once."""
        shown, drawing = self._picture_of, self.drawing
        assert drawing is not None
        try:
            picture = await asyncio.to_thread(sheet_picture.read, drawing, self.options)
        except Exception as error:
            self.picture, self.refused = None, " ".join(str(error).split())
        else:
            if shown == self._picture_of:
                self.picture = picture
        self.picture_id += 1
        self.changed()

    def _in_background(self, work: Any) -> None:
        """Do work beside the answers."""
        task = asyncio.get_running_loop().create_task(work)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)
