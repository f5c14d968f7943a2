"""Hooks of mkdocs: what the plugins of the site leave to be put right."""

from __future__ import annotations

from typing import Any

OPTIONS = "reference/options.md"


def on_page_content(html: str, page: Any, **_: Any) -> str:
    """Show a dash where an option has no default; mkdocs-click prints click's own marker there."""
    if page.file.src_uri != OPTIONS:
        return html
    return html.replace("<code>Sentinel.UNSET</code>", "–").replace(
        "<td>None</td>", "<td>–</td>"
    )
