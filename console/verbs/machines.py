"""The verb `machines`: which machines programs are written for, and one of them as a file to change."""

from __future__ import annotations

import click

from morfax.console.options.desk import desk_options
from morfax.console.options.files import machine_names
from morfax.console.options.groups import Verb
from morfax.console.terminal.desk import Desk

EXAMPLES = """\b
Examples:
  morfax machines
  morfax machines grbl-router
"""


@click.command("machines", cls=Verb, epilog=EXAMPLES)
@click.argument("name", required=False, shell_complete=machine_names)
@desk_options
def command(name: str | None, desk: Desk) -> None:
    """List the machines that programs are written for, or print one to change.

    With a NAME the machine is printed as a file. Send it to my.toml (`morfax machines
    grbl-router > my.toml`), change it, and give it to trace, record or run with --machine my.toml.
    """
    from morfax.recorder.gcode.machine import as_toml, machine, names

    if name is None:
        Desk(json=desk.json).figures({each: machine(each).what for each in names()})
        return
    try:
        click.echo(as_toml(name), nl=False)
    except ValueError as refused:
        raise click.BadParameter(str(refused), param_hint="NAME") from None
