"""The command line `morfax`: one verb per machine, and one line on stderr for whatever goes wrong.

Signals in: the words on the command line. Signals out: figures on stdout, everything else on stderr, an exit
code. Verbs are loaded when they are called, so that `morfax --help` does not wait for the machines.
"""

from __future__ import annotations

import atexit
import errno
import gc
import importlib
import os
import signal
import sys
import threading
import traceback
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import click

from morfax.jobs import kernels
from morfax.jobs.damaged_kernels import compile_damaged_again
from morfax.motion.faults import BY_SIGNAL, MISTAKE, DrawingFault, Fault, FileFault

# objects that Python makes before it looks for rings of them that nobody holds (its own figure is 700). The
# modules of a verb make 80 000, which all stay: to look through them took a twelfth of a short `trace`
OBJECTS = 50_000
AGAIN_S = 0.1  # from an interrupt that was lost to the next: what lost it is over by then, or loses that too
VERBS = {
    "lines": "List what is on a drawing: a numbered table of its lines, dots and likely lettering.",
    "correct": "Correct what the head gets wrong on a drawing: rub out, bridge, turn, stop.",
    "trace": "Follow the lines of a drawing and write a program: a tape, G-code, DXF and others.",
    "batch": "Trace all drawings of a folder, each into a folder of its own.",
    "play": "Play a program on the simulated machine and write the path that the machine runs.",
    "compare": "Say how far two contours are apart: paths, programs, or one of them a drawing.",
    "run": "Go the whole way: trace a drawing, play the program, compare all three.",
    "inspect": "Say what is in a program: of a tape its tracks, carriers, levels, travel, format.",
    "record": "Record a path file, or another program, in the medium that the name after -o says.",
    "mend": "Record a tape anew without its dropouts.",
    "age": "Add the wear of a real recorder to a tape: noise, flutter, dropouts.",
    "check": "Say whether a machine may be started with a program, and what the program does.",
    "sheet": "Make a sheet with marks to print, draw on and photograph.",
    "devices": "List the sound devices; play a test tone, and show the levels of its tracks.",
    "machines": "List the machines that programs are written for, or print one to change.",
    "panel": "Open the operator's panel in a browser: see the sheet, choose lines, run, watch, save.",
    "demo": "Trace a sample drawing, play the tape, compare, and show what came out.",
}

EXIT_CODES = """\b
Exit codes:
  0  done
  1  compare: further apart than --tolerance; check: do not start the machine; batch: some failed
  2  wrong use of the command line
  3  the drawing cannot be used (or is too large for the memory)
  4  no line at that place, or the line was lost (what was traced is kept)
  5  not a tape that can be played
  6  a drive of the machine lost the tape, or does not follow
  7  a motion that cannot be recorded
  8  a file that cannot be read or written
  9  a mistake in the operator's card, or in a file of settings
 10  a sound device that is not there, or that left out samples
 70  a mistake in morfax itself
130  interrupted by Ctrl-C (143: asked to end, 129: the terminal was closed)

\b
Examples:
  morfax demo
  morfax trace scan.png --width 120mm --start 40,62 -o cam.wav
  morfax play cam.wav -o cam.csv -o cam.svg
  morfax compare scan.png cam.csv --tolerance 50um --picture cam-error.png
"""
CONTEXT = {"help_option_names": ["-h", "--help"], "max_content_width": 100}
NO_MEMORY = "not enough memory; scan the drawing at a lower resolution, or cut out the part to be traced"


class Verbs(click.Group):
    """A group that imports the module of a verb only when the verb is called."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Name the verbs, in the order of the work."""
        return list(VERBS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Import a verb; None if there is no such verb."""
        if cmd_name not in VERBS:
            return None
        command = importlib.import_module(f"morfax.console.verbs.{cmd_name}").command
        assert isinstance(command, click.Command)
        return command

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the verbs and what they do, without importing them."""
        with formatter.section("Verbs"):
            formatter.write_dl(list(VERBS.items()))


@click.group(cls=Verbs, epilog=EXIT_CODES, context_settings=CONTEXT, no_args_is_help=True)
@click.version_option(package_name="morfax", prog_name="morfax")
def cli() -> None:
    """Follow a drawing, record the motion on a tape, play the tape on a machine, and compare.

    Lengths, speeds and frequencies are given with their unit: 10mm, 0.4in, 50um, 1200mm/min, 6kHz. A bare
    number is in mm, mm/s or Hz. Places are X,Y in mm from the lower-left corner of the sheet.
    """


def main(words: Sequence[str] | None = None) -> int:
    """Run the command line; the exit code. Whatever goes wrong ends as one line on stderr."""
    _open_closed_streams()
    kernels.choose_cache()
    compile_damaged_again(lambda line: click.echo(line, err=True))
    with _rings_sought_seldom(), _stopped_by_signals():
        return _ended(words)


def _open_closed_streams() -> None:
    """Let what was closed by whoever started the program, as with `2>&-`, take words and give none."""
    for name, mode in (("stdin", "r"), ("stdout", "w"), ("stderr", "w")):
        if getattr(sys, name) is None:
            # the lowest number that is free is the stream's own: no file of ours comes to have it
            setattr(sys, name, Path(os.devnull).open(mode, encoding="utf-8"))  # noqa: SIM115


def _ended(words: Sequence[str] | None) -> int:
    """Run the verb, and tell how it ended."""
    try:
        outcome = cli.main(
            args=None if words is None else list(words),
            prog_name="morfax",
            standalone_mode=False,
        )
        sys.stdout.flush()
        return outcome if isinstance(outcome, int) else 0
    except click.exceptions.NoArgsIsHelpError as nothing_asked:
        nothing_asked.show()
        return nothing_asked.exit_code
    except click.ClickException as wrong_use:
        return _say(_told(wrong_use), wrong_use.exit_code)
    except (click.Abort, KeyboardInterrupt) as stop:
        return _interrupted(stop)
    except SystemExit:  # what click makes of a broken pipe
        return _broken_pipe()
    except Exception as error:
        # a kernel that was interrupted as it returned raises a SystemError for that reason
        is_interrupt = isinstance(error.__cause__, KeyboardInterrupt)
        return _interrupted(error) if is_interrupt else _failed(error)


def _interrupted(stop: BaseException) -> int:
    """Say that the work was interrupted; the exit code that the signal asks for."""
    said = "interrupted; no unfinished file was left under its final name"
    return _say(said, BY_SIGNAL + _signal_of(stop))


def _failed(error: Exception) -> int:
    """Say what ended a verb: a fault, the operating system, a lack of memory, or a mistake of ours."""
    if isinstance(error, Fault):
        return _say(str(error), error.exit_code)
    if isinstance(error, OSError):
        if error.errno == errno.EPIPE:
            return _broken_pipe()
        return _say(_cause(error), FileFault.exit_code)
    if _is_out_of_memory(error):
        return _say(NO_MEMORY, DrawingFault.exit_code)
    if os.environ.get("MORFAX_TRACEBACK"):
        traceback.print_exc()
    mistake = f"a mistake in morfax: {type(error).__name__}: {' '.join(str(error).split())}"
    return _say(f"{mistake} (MORFAX_TRACEBACK=1 shows where)", MISTAKE)


@contextmanager
def _rings_sought_seldom() -> Iterator[None]:
    """Have Python look for rings of objects less often than it does as a rule."""
    atexit.register(gc.freeze)  # at the end, too: the process gives all of its memory back
    before = gc.get_threshold()
    gc.set_threshold(OBJECTS, *before[1:])
    try:
        yield
    finally:
        gc.set_threshold(*before)


@contextmanager
def _stopped_by_signals() -> Iterator[None]:
    """Have signals that ask a program to end stop the work as Ctrl-C does: unfinished files are removed."""

    def stop(number: int, frame: object) -> None:
        raise KeyboardInterrupt(number)

    before = {}
    if threading.current_thread() is threading.main_thread():  # no other one may
        for name in ("SIGTERM", "SIGHUP"):
            number = getattr(
                signal, name, None
            )  # SIGHUP: not on every system; ignored under nohup
            if number is not None and signal.getsignal(number) is not signal.SIG_IGN:
                before[number] = signal.signal(number, stop)
    hook, sys.unraisablehook = sys.unraisablehook, _comes_again(sys.unraisablehook)
    try:
        yield
    finally:
        sys.unraisablehook = hook
        for number, handler in before.items():
            signal.signal(number, handler)


def _comes_again(hook: Callable[[Any], object]) -> Callable[[Any], object]:
    """A hook for exceptions that no one can catch, which sends an interrupt that was lost so once more.

    While LLVM compiles a kernel it calls Python back, and what is raised there ends in a printed traceback.
    """

    def lost(unraisable: Any) -> None:
        if not issubclass(unraisable.exc_type, KeyboardInterrupt):
            hook(unraisable)
            return
        number = _signal_of(unraisable.exc_value or KeyboardInterrupt())
        again = threading.Timer(AGAIN_S, os.kill, (os.getpid(), number))
        again.daemon = True
        again.start()

    return lost


def _signal_of(stop: BaseException) -> int:
    """The number of the signal that interrupted: what click or a kernel makes of it has it as its cause."""
    cause = stop.__cause__ or stop
    return (
        int(cause.args[0])
        if cause.args and isinstance(cause.args[0], int)
        else int(signal.SIGINT)
    )


def _say(message: str, exit_code: int) -> int:
    """Write one line on stderr; the exit code."""
    click.echo(f"morfax: {' '.join(message.split())}", err=True)
    return exit_code


def _told(wrong_use: click.ClickException) -> str:
    """What was wrong with the command line, and where to read how it is used."""
    ctx = getattr(wrong_use, "ctx", None)
    where = ctx.command_path if ctx is not None else "morfax"
    return f"{wrong_use.format_message().rstrip('.')}; see {where} --help"


def _cause(error: OSError) -> str:
    """What the operating system says, with the file if it names one."""
    said = error.strerror or str(error)
    return f"{error.filename}: {said}" if error.filename else said


def _is_out_of_memory(error: Exception) -> bool:
    """Whether Python, numpy or OpenCV (whose own error has the code StsNoMem) found no memory."""
    return isinstance(error, MemoryError) or getattr(error, "code", None) == -4


def _broken_pipe() -> int:
    """End quietly when the reader of our output has gone (`morfax inspect … | head -1`)."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    return 0
