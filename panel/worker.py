"""The worker: runs jobs in a process of its own, so that the page is answered while the head works.

Signals in, on stdin: ("job", number, kind, job) to do one after the other, and ("hold" | "resume" | "step"
| "stop" | "pace", …) for the one that is under way. Signals out, on stdout: dictionaries that `say` what
happened: progress, notes, the head's path, and at last `done` with the result or `failed` with one line of
words.

What was traced last is kept: a program that is saved from an equal tracing is only written, not traced
again.
"""

from __future__ import annotations

import os
import queue
import signal
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO

from morfax.jobs import kernels
from morfax.jobs.damaged_kernels import compile_damaged_again
from morfax.jobs.listener import Advance
from morfax.panel import pipe
from morfax.panel.head_path import FRAME_S
from morfax.panel.kept_knots import KeptKnots
from morfax.panel.lookout import Lookout
from morfax.panel.page_words import in_page_words

if TYPE_CHECKING:
    from morfax.jobs.play import PlayJob
    from morfax.jobs.run import RunJob
    from morfax.jobs.settings.drawing_file import DrawingFile
    from morfax.jobs.trace import TraceJob
    from morfax.jobs.tracing.traced import Traced
    from morfax.jobs.tracing.tracing import Tracing
    from morfax.tracer.drawing.drawing import Drawing
    from morfax.tracer.following.knots import Memory

KNOTS = ".knots"  # the folder of the knots on disk, in the panel's
NO_MEMORY = "not enough memory; scan the drawing at a lower resolution, or cut out the part to be traced"


class Teller:
    """The Listener of a job in the worker, and the way out to the server."""

    def __init__(self, out: BinaryIO, lookout: Lookout) -> None:
        self._out, self._lock, self._lookout = out, threading.Lock(), lookout

    def say(self, event: str, /, **more: Any) -> None:
        """Send a message, in the page's words; a server that is gone ends the worker."""
        if "text" in more:
            more["text"] = in_page_words(more["text"])
        with self._lock:
            try:
                self._out.write(pipe.packed({"say": event, **more}))
                self._out.flush()
            except BrokenPipeError:
                os._exit(0)

    def note(self, text: str) -> None:
        """Pass a note on."""
        self.say("note", text=text)

    def detail(self, text: str) -> None:
        """Pass over a detail: the page has no place for it."""

    def warning(self, text: str) -> None:
        """Pass a warning on."""
        self.say("warning", text=text)

    def compiling(self, what: str, packages: tuple[str, ...]) -> None:
        """Say that the first run takes longer, if it will."""
        kernels.announce(what, self.note)

    @contextmanager
    def progress(self, what: str, total: float) -> Iterator[Advance]:
        """Tell how far a piece of work is, a hundred times at most; stop it where the operator says so."""
        told = -1

        def advance(done: float) -> None:
            nonlocal told
            self._lookout.check()
            hundredths = int(100 * min(max(done / total, 0.0), 1.0)) if total > 0 else 0
            if hundredths != told:
                told = hundredths
                self.say("progress", what=what, share=hundredths / 100)

        self.say("progress", what=what, share=0.0)
        yield advance


class Worker:
    """The jobs one after the other, and what was traced last."""

    def __init__(self, out: BinaryIO) -> None:
        self.lookout = Lookout()
        self.teller = Teller(out, self.lookout)
        self._traced: tuple[Any, Tracing, Drawing, Traced] | None = None
        # of the head's runs, so that the head goes on where something was put right
        self._memory: Memory | None = None

    def do(self, number: int, kind: str, job: Any) -> None:
        """Do a job, and say how it ended."""
        self.lookout.begin()
        self.teller.say("begun", number=number, kind=kind)
        try:
            result = getattr(self, f"_{kind}")(job)
        except KeyboardInterrupt:
            self.teller.say("stopped", number=number, kind=kind)
        except Exception as error:
            self.teller.say("failed", number=number, kind=kind, **_told(error))
        else:
            self.teller.say("done", number=number, kind=kind, result=result)

    def send_head(self) -> None:
        """Send what is new of the head, for as long as the worker lives."""
        while True:
            news = self.lookout.news(timeout_s=3600.0)
            if news is not None:
                self.teller.say("head", **news)
            threading.Event().wait(FRAME_S)

    def _lines(self, job: Any) -> dict[str, Any]:
        """Look at the drawing: its lines by number, and which pixel belongs to which."""
        from morfax.panel.sheet_data import of_lines

        return of_lines(job.run(self.teller))

    def _run(self, job: RunJob) -> dict[str, Any]:
        """Go the whole way, and keep what the page shows of it."""
        from morfax.panel.result_data import of_run
        from morfax.reports.pictures import draw_run, write_figures

        _, tracing = job.prepared()
        stamp = _stamp(job.drawing)
        with self._head(job.file(KNOTS), repr((stamp, tracing))):
            result = job.run(self.teller)
        self._traced = stamp, tracing, result.drawing, result.traced
        self.teller.say("progress", what="drawing the picture", share=0.0)
        draw_run(result)
        write_figures(result)
        return of_run(result)

    @contextmanager
    def _head(self, folder: Path | None = None, stamp: str = "") -> Iterator[None]:
        """Have the heads from here on watched, and taken up where an earlier run was the same: one in the
        memory, or one that was cut off and whose knots are in the folder.
        """
        from morfax.tracer.following.knots import Memory, remembering
        from morfax.tracer.head.watched import watching

        self._memory = self._memory or Memory()
        knots = None if folder is None else KeptKnots(folder)
        if knots is not None:
            come_mm = knots.take_up(stamp, self._memory)
            if come_mm:
                self.teller.note(f"the head goes on where it was, {come_mm:.0f} mm on its way")
            else:
                knots.begin(stamp)
        self._memory.kept = None if knots is None else knots.keep
        try:
            with watching(self.lookout), remembering(self._memory):
                yield
        finally:  # not where the worker is killed
            self._memory.kept = None
            if knots is not None:
                knots.end()

    def _correct(self, job: Any) -> dict[str, Any]:
        """Write a correction into the file beside the drawing."""
        return dict(job.run(self.teller).figures)

    def _play(self, job: tuple[PlayJob, list[list[float]], float]) -> dict[str, Any]:
        """Have the machine run a program again, at another feed override."""
        from morfax.jobs.machine.playing import Playing
        from morfax.jobs.readings.following import new_chart
        from morfax.jobs.wrong_use import settings_checked
        from morfax.panel.result_data import of_play

        play, placed, share = job
        chart = new_chart(raw=False)
        settings = play.control.for_file(play.tape, play.by_hand)
        with settings_checked():
            playing = Playing(play.tape, play.by_hand, chart=chart, settings=settings)
            played = playing.whole(self.teller)
        faults = [] if played.fault is None else [str(played.fault)]
        return {**of_play(played.path, chart, placed), "override": share, "faults": faults}

    def _save(self, job: TraceJob) -> dict[str, Any]:
        """Write a program of what was traced, or trace it first where it was not."""
        outputs, tracing = job.prepared()
        if self._traced is not None and self._traced[:2] == (_stamp(job.drawing), tracing):
            from morfax.jobs.machine.machining import tell_what_is_lost

            if outputs.program is not None:
                tell_what_is_lost(job.settings, job.unit, outputs.program, self.teller)
            result = job.written(outputs, *self._traced[2:], self.teller)
        else:
            with self._head():
                result = job.run(self.teller)
        written = outputs.program or outputs.path
        assert written is not None
        fault = None if result.fault is None else str(result.fault)
        return {"file": str(result.traced.name(written)), "fault": fault}


def _stamp(drawing: DrawingFile) -> tuple[Any, ...]:
    """What a drawing hangs on: how it is read, and the newest state of its file and of its corrections."""

    def newest(file: Path) -> tuple[int, int] | None:
        return (file.stat().st_mtime_ns, file.stat().st_size) if file.exists() else None

    corrections = drawing.corrections.file_of(drawing.file)
    return drawing, newest(drawing.file), newest(corrections)


def _told(error: Exception) -> dict[str, Any]:
    """What went wrong in one line, and where on the sheet if the fault says so."""
    from morfax.jobs.wrong_use import WrongUse
    from morfax.motion.faults import Fault

    place_mm = None
    if isinstance(error, Fault):
        x, y = getattr(error, "x_mm", None), getattr(error, "y_mm", None)
        place_mm = None if x is None or y is None else (x, y)
        text = str(error)
    elif isinstance(error, WrongUse | OSError):
        text = str(error)
    elif (
        isinstance(error, MemoryError) or getattr(error, "code", None) == -4
    ):  # OpenCV's StsNoMem
        text = NO_MEMORY
    else:
        text = f"a mistake in morfax: {type(error).__name__}: {error}"
    return {"text": " ".join(text.split()), "place_mm": place_mm}


def main() -> None:
    """Work until stdin ends."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is the server's
    out = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # what a library prints is not for the pipe
    kernels.choose_cache()
    worker = Worker(out)
    jobs = queue.Queue[tuple[Any, ...]]()
    compile_damaged_again(worker.teller.note)
    threading.Thread(target=worker.send_head, daemon=True).start()
    threading.Thread(target=_obey, args=(worker.lookout, jobs), daemon=True).start()
    while True:
        worker.do(*jobs.get())


def _obey(lookout: Lookout, jobs: queue.Queue[tuple[Any, ...]]) -> None:
    """Take in what the server sends, and do at once what is for the job under way; end with the server."""
    at_once: dict[str, Callable[..., None]] = {
        "hold": lookout.hold,
        "resume": lookout.resume,
        "step": lookout.step,
        "stop": lookout.stop,
        "pace": lookout.set_pace,
    }
    try:
        while True:
            what, *more = pipe.read_from(sys.stdin.buffer)
            if what == "job":
                jobs.put(tuple(more))
            else:
                at_once[what](*more)
    except EOFError:
        os._exit(0)


if __name__ == "__main__":
    main()
