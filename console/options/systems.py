"""The systems that `compare --systems` sets side by side, as a value on the command line."""

from __future__ import annotations

from typing import Any

import click

from morfax.jobs.results import NAMES


class Systems(click.ParamType):
    """Systems: all, or some by the suffixes of their programs."""

    name = "systems"

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> Any:
        """Read "all" or a list such as "wav,steps"."""
        if not isinstance(value, str):
            return value
        words = [word.strip(" .").lower() for word in value.split(",")]
        asked = list(NAMES) if words == ["all"] else words
        unknown = [word for word in asked if word not in NAMES]
        if unknown:
            every = ",".join(NAMES)
            self.fail(
                f"there is no system {unknown[0]!r}; give all, or some of {every}", param, ctx
            )
        return tuple(dict.fromkeys(asked))
