"""The page of all commands and options, from the command line's own help (a hook of mkdocs).

mkdocs-click knows no headings of options, and prints click's marker of a missing default as a default.
"""

from __future__ import annotations

import textwrap
from collections.abc import Iterator
from typing import Any

import click

from morfax.console.cli import cli
from morfax.console.options.groups import ORDER, REST

PAGE = "reference/options.md"


def on_page_markdown(markdown: str, page: Any, **_: Any) -> str:
    """Fill the page of all options."""
    return "\n".join([markdown, *all_verbs()]) if page.file.src_uri == PAGE else markdown


def all_verbs() -> Iterator[str]:
    """The sections of all verbs, in the order of the work."""
    with click.Context(cli, info_name="morfax", **cli.context_settings) as above:
        for name in cli.list_commands(above):
            verb = cli.get_command(above, name)
            assert verb is not None
            with click.Context(verb, info_name=name, parent=above) as context:
                yield from section(verb, context)


def section(verb: click.Command, context: click.Context) -> Iterator[str]:
    """One verb: what it does, how it is called, its options under their headings, examples."""
    yield from (f"## morfax {verb.name}", "", paragraphs(verb.help or ""), "")
    yield from (f"    morfax {verb.name} {' '.join(verb.collect_usage_pieces(context))}", "")
    headings: dict[str, list[str]] = {name: [] for name in (*ORDER, REST)}
    for option in verb.get_params(context):
        record = option.get_help_record(context)
        if record is not None and isinstance(option, click.Option):
            headings[getattr(option, "group", REST)].append(row(*record))
    for name, rows in headings.items():
        if rows:
            yield from (f"| {name} | |", "| --- | --- |", *rows, "")
    yield from (examples(verb.epilog or ""), "")


def paragraphs(text: str) -> str:
    """A help text as Markdown: paragraphs stay, lines are joined."""
    parts = textwrap.dedent(text).strip().split("\n\n")
    return escaped("\n\n".join(" ".join(part.split()) for part in parts))


def row(names: str, text: str) -> str:
    """An option as a row of a table."""
    return f"| `{names.replace('|', '&#124;')}` | {escaped(text)} |".replace("&#124;", "\\|")


def examples(epilog: str) -> str:
    """The examples of a verb as code."""
    lines = [line for line in epilog.splitlines() if line.strip().startswith("morfax")]
    return (
        "\n".join(["Examples:", "", *(f"    {line.strip()}" for line in lines)])
        if lines
        else ""
    )


def escaped(text: str) -> str:
    """A text that Markdown shows as it is."""
    return text.replace("|", "\\|").replace("<", "&lt;").replace("*", "\\*")
