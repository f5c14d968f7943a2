"""Options under headings: a verb lists its options in groups, in the order of the work."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import click

from morfax.jobs.wrong_use import WrongUse

ORDER = (
    "Correction",
    "Drawing",
    "Line",
    "Head",
    "Tool",
    "Cutting",
    "Program",
    "Systems",
    "Machine",
    "Tape",
    "Wear",
    "Output",
    "Batch",
    "Server",
)  # of the headings; options without a group come last
REST = "Other options"


class GroupedOption(click.Option):
    """An option that stands under a heading of its verb's help."""

    def __init__(self, *names: Any, group: str, **entries: Any) -> None:
        super().__init__(*names, **entries)
        self.group = group


class Verb(click.Command):
    """A command that lists its options under headings, and takes a job's wrong use for its own."""

    def get_help_option_names(self, ctx: click.Context) -> list[str]:
        """-h and --help, also where no group stands above the verb: click keeps the first answer."""
        return ["-h", "--help"]

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Refuse a second -o where there is one result: click would take the last without a word."""
        takes_many = any("-o" in param.opts and param.multiple for param in self.params)
        if not takes_many and args.count("-o") > 1:
            raise click.UsageError(
                "-o is given twice, and there is one result; give it once", ctx
            )
        return super().parse_args(ctx, args)

    def format_options(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the options, a section for each group."""
        sections: dict[str, list[tuple[str, str]]] = {name: [] for name in (*ORDER, REST)}
        for param in self.get_params(ctx):
            record = param.get_help_record(ctx)
            if record is not None and isinstance(param, click.Option):
                sections[getattr(param, "group", REST)].append(record)
        for name, records in sections.items():
            if records:
                with formatter.section(name):
                    formatter.write_dl(records)

    def invoke(self, ctx: click.Context) -> Any:
        """Run the verb; what a job refuses is wrong use of the command line."""
        try:
            return super().invoke(ctx)
        except WrongUse as refused:
            raise click.UsageError(str(refused), ctx) from None


Decorator = Callable[[Callable[..., Any]], Callable[..., Any]]


def option(group: str, *names: str, **entries: Any) -> Decorator:
    """An option of a group."""
    return click.option(*names, cls=GroupedOption, group=group, **entries)


def given_all(options: tuple[Decorator, ...], verb: Callable[..., Any]) -> Callable[..., Any]:
    """A verb with options, in their order."""
    for one in reversed(options):
        verb = one(verb)
    return verb


def renamed(old: str, new: str) -> Decorator:
    """Refuse an old spelling of an option, and name the new one."""

    def refuse(ctx: click.Context, param: click.Parameter, value: str | None) -> None:
        if value is not None:
            raise click.UsageError(f"{old} is called {new} now; give {new}", ctx)

    return click.option(
        old,
        f"old_{old.strip('-')}",  # a name of its own: several spellings may stand for one parameter
        hidden=True,
        expose_value=False,
        is_eager=True,
        is_flag=False,
        flag_value="",
        callback=refuse,
    )


def given(option: str) -> bool:
    """Whether an option was given on the command line."""
    from click.core import ParameterSource

    source = click.get_current_context().get_parameter_source(option)
    return source is ParameterSource.COMMANDLINE
