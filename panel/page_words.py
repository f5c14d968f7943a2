"""The words of the page: what jobs say in the words of the command line, with the page's own names.

Signals in: a message of a job, or an option. Signals out: the same, where an option that the page has for a
control has the control's name, as it stands on the page.

Source: our own. Questions: an option that the page has not stays as it is: who wants it needs a terminal.
"""

from __future__ import annotations

import re

from morfax.panel.commands import OFFERED

_OPTION = re.compile(r"('?)(--[a-z][a-z-]*[a-z])\1")
_OFFERED = {option for group in OFFERED.values() for option in group}


def in_page_words(text: str) -> str:
    """A message with the names of the page's controls in place of their options."""
    return _OPTION.sub(lambda found: _named(found[2]) or found[0], text)


def _named(option: str) -> str:
    """The control of an option, quoted; nothing where the page has none."""
    name = option.removeprefix("--").replace("-", " ").capitalize()
    return f"“{name}”" if option in _OFFERED else ""
