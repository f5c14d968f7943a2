"""Actions: what a page may ask of the bench, each a small object with what to `do`.

    {"do": "open", "drawing": "scan.png"}          {"do": "set", "option": "--cutter", "value": "3mm"}
    {"do": "undo"}, "redo", "run", "hold", "resume", "step", "stop"
    {"do": "correct", "as": "rub", "at": [[812, 1004], [820, 1010]], "width": "2mm"}
    {"do": "pace", "times": 2}                     {"do": "save", "as": ".dxf"}
    {"do": "override", "share": 0.5}               of the machine, which runs its program again

What changes the settings says which revision the page has `seen`: an older one is refused, because another
page has changed them in the meantime.

Questions: a setting that cannot be parsed is refused; one that does not go with another is taken, and said
beside the command, because the other may be set next.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from morfax.jobs.wrong_use import WrongUse
from morfax.panel import commands, keepsake
from morfax.panel.corrected import asked_words
from morfax.panel.history import HistoryStep
from morfax.panel.own_files import as_paths
from morfax.player.tape.setting import OVERRIDES

if TYPE_CHECKING:
    from collections.abc import Callable

    from morfax.panel.bench import Bench

PAGE = ".html"
PROGRAM = "program"  # in the words of the machine that is set
SAVED_AS = (".wav", ".steps", ".cubic", ".ngc", ".dxf", ".svg", ".plt", ".csv", PROGRAM, PAGE)
PACES = (0.1, 100.0)  # times the head's own speed
LONGEST_VALUE = 200  # characters of an option
OF_SETTINGS = ("open", "set", "correct", "undo", "redo")


def do(bench: Bench, action: dict[str, Any]) -> None:
    """Do what a page asks; raises WrongUse in words for what cannot be done."""
    name = action.get("do")
    known = _ACTIONS.get(name) if isinstance(name, str) else None
    if known is None:
        raise WrongUse(f"this server knows no action {str(name)[:40]!r}; load the page again")
    if name in OF_SETTINGS and action.get("seen") != bench.history.revision:
        raise WrongUse(
            "another page has changed the settings in the meantime; they are shown now: set it again"
        )
    known(bench, action)


def _open(bench: Bench, action: dict[str, Any]) -> None:
    """Lay a drawing on the bench; its options begin anew."""
    drawing = action.get("drawing")
    if not isinstance(drawing, str) or drawing not in bench.sources:
        raise WrongUse(
            f"there is no drawing {str(drawing)[:60]!r} here; choose one of the list, or drop a file"
        )
    bench.messages.clear()
    bench.step(HistoryStep(drawing, {}))


def _set(bench: Bench, action: dict[str, Any]) -> None:
    """Set an option, or several that belong together, or take them away with null."""
    changes = action.get("options") or {action.get("option"): action.get("value")}
    if not isinstance(changes, dict):
        raise WrongUse(f"the options are {str(changes)[:40]!r}; send each by its name")
    if bench.drawing is None:
        raise WrongUse("no drawing lies on the bench; open one first")
    options = dict(bench.history.now.options)
    known = {field.option: field for field in bench.command_line.fields()}
    for name, value in changes.items():
        if name not in known:
            raise WrongUse(
                f"the panel has no option {str(name)[:40]!r}; give it on the command line"
            )
        options.pop(name, None)
        if value is not None and value is not False and value != "":
            options[name] = _value(known[name], value, bench)
    given = as_paths(options, bench.own)
    words = commands.trace_words(bench.drawing, given, bench.folder / f"x{_suffix(options)}")
    bench.command_line.trace(words)
    bench.step(replace(bench.history.now, options=options))


def _value(field: commands.OptionField, value: Any, bench: Bench) -> str | bool:
    """A value as an option holds it; raises WrongUse for one of another kind."""
    if field.kind == "switch" and value is True:
        return True
    if not isinstance(value, str) or field.kind == "switch" or len(value) > LONGEST_VALUE:
        raise WrongUse(
            f"{field.option} cannot be {str(value)[:40]!r}; a switch is on or off, anything else is text of "
            f"up to {LONGEST_VALUE} letters"
        )
    own = tuple(bench.own) if field.kind == "file" else ()
    is_choice = bool(field.choices) or field.kind == "file"
    if is_choice and value not in field.choices + own:
        raise _no_choice(field.option, value, field.choices + own)
    return value.strip()


def _no_choice(option: str, value: str, choices: tuple[str, ...]) -> WrongUse:
    """The refusal of a value that is none of the choices."""
    may = f"it may be {', '.join(choices)}" if choices else "give the page a file of your own"
    return WrongUse(f"{option} cannot be {value[:40]!r}; {may}")


def _suffix(options: commands.Options) -> str:
    """A suffix of a program that takes the options as they are set."""
    return ".ngc" if "--machine" in options else ".wav"


def _run(bench: Bench, action: dict[str, Any]) -> None:
    """Begin a run."""
    _refuse_busy(bench)
    if bench.drawing is None:
        raise WrongUse("no drawing lies on the bench; open one first")
    bench.messages.clear()
    bench.run()


def _save(bench: Bench, action: dict[str, Any]) -> None:
    """Write a program, a drawing, a path, or the page of the result."""
    _refuse_busy(bench)
    wanted = action.get("as")
    if wanted not in SAVED_AS or bench.drawing is None:
        raise WrongUse(
            f"what was made cannot be saved as {str(wanted)[:40]!r}; it may be {', '.join(SAVED_AS)}"
        )
    if wanted == PAGE:
        keepsake.write(bench)
        bench.tell("saved", f"saved {bench.drawing.stem}{PAGE}")
        bench.changed()
        return
    bench.send("save", bench.command_line.trace(save_words(bench, wanted)))


def _correct(bench: Bench, action: dict[str, Any]) -> None:
    """Put right what the head got wrong, in the file beside the drawing."""
    _refuse_busy(bench)
    if bench.drawing is None:
        raise WrongUse("no drawing lies on the bench; open one first")
    words = commands.correct_words(bench.drawing, bench.options, asked_words(action))
    job = bench.command_line.correct(words)
    bench.corrected_by = words
    bench.send("correct", job)


def save_words(bench: Bench, wanted: str) -> list[str]:
    """The words of `morfax trace` that write what is saved."""
    assert bench.drawing is not None
    options, suffix = bench.options, wanted
    if wanted == PROGRAM:
        machine = bench.command_line.run(bench.words()).unit.chosen()
        suffix = machine.suffix
    return commands.trace_words(
        bench.drawing, options, bench.folder / f"{bench.drawing.stem}{suffix}"
    )


def _pace(bench: Bench, action: dict[str, Any]) -> None:
    """Another pace; null: as fast as the computer can."""
    times = action.get("times")
    least, most = PACES
    if times is not None and (
        isinstance(times, bool)
        or not isinstance(times, int | float)
        or not least <= times <= most
    ):
        raise WrongUse(
            f"the pace cannot be {str(times)[:40]}; it may be {least:g} to {most:g} times the head's own"
        )
    bench.control("pace", times)


def _override(bench: Bench, action: dict[str, Any]) -> None:
    """Have the machine run its program again at another feed override."""
    _refuse_busy(bench)
    share, (least, most) = action.get("share"), OVERRIDES
    if (
        isinstance(share, bool)
        or not isinstance(share, int | float)
        or not least <= share <= most
    ):
        raise WrongUse(
            f"the override cannot be {str(share)[:40]}; it may be {least:.0%} to {most:.0%} of the feed"
        )
    result = bench.kept.result
    if result is None or result.get("program") is None:
        raise WrongUse("the machine has no program yet; run first")
    words = override_words(bench, float(share))
    job = bench.command_line.play(words)
    bench.send("play", (job, result["placed"], float(share)))


def override_words(bench: Bench, share: float) -> list[str]:
    """The words of `morfax play` that run the result's program at an override, on the machine that it is for:
    another one may be set by now.
    """
    result = bench.kept.result
    made_by = bench.kept.words or []
    assert result is not None
    return commands.play_words(bench.folder / str(result["program"]), made_by, share)


def _control(what: str) -> Callable[[Bench, dict[str, Any]], None]:
    """Hold, resume, step or stop."""

    def control(bench: Bench, action: dict[str, Any]) -> None:
        if bench.busy is None or bench.busy["kind"] == "lines":
            raise WrongUse("no run is under way")
        bench.control(what)

    return control


def _refuse_busy(bench: Bench) -> None:
    """Raise WrongUse while a run or a saving is under way."""
    if bench.busy is not None and bench.busy["kind"] != "lines":
        raise WrongUse("a run is under way; stop it first, or wait until it is done")


_ACTIONS: dict[str, Callable[[Bench, dict[str, Any]], None]] = {
    "open": _open,
    "set": _set,
    "correct": _correct,
    "undo": lambda bench, _: bench.again("undo"),
    "redo": lambda bench, _: bench.again("redo"),
    "run": _run,
    "save": _save,
    "pace": _pace,
    "override": _override,
    **{name: _control(name) for name in ("hold", "resume", "step", "stop")},
}
