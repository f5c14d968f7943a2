"""Options of verbs that write only under names that somebody gives."""

from __future__ import annotations

from morfax.console.options.groups import option

# it changes nothing, but the same words then go with every verb that writes
FORCE = option(
    "Output",
    "--force",
    is_flag=True,
    expose_value=False,
    help="As in trace and record. A name that you give here is written over with it and without it.",
)
