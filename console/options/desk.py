"""The options of the desk: how much a verb says."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any

from morfax.console.options.groups import option
from morfax.console.terminal.desk import Desk


def desk_options(verb: Callable[..., Any]) -> Callable[..., Any]:
    """Give a verb --quiet, --verbose and --json, and hand it the `desk`."""

    @option(
        "Output",
        "-q",
        "--quiet",
        is_flag=True,
        help="Print only faults, warnings, and the figures of --json: no table, notes or progress bar.",
    )
    @option("Output", "-v", "--verbose", is_flag=True, help="Say more on stderr.")
    @option(
        "Output",
        "--json",
        is_flag=True,
        help="Print the figures on stdout as one JSON object, units in the keys.",
    )
    @functools.wraps(verb)
    def with_desk(*args: Any, quiet: bool, verbose: bool, json: bool, **options: Any) -> Any:
        return verb(*args, desk=Desk(quiet, verbose, json), **options)

    return with_desk
