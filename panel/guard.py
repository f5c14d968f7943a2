"""The guard: who may ask the server, and what the browser may do with the answers.

Signals in: requests as ASGI has them. Signals out: the same, passed on, or refused in words.

1. Host must be a name that this server is called by: another site's name that points here is refused.
2. Origin, where a request has one, must be this server; what changes something must have one.
3. The token of the address, once; after that a cookie that only this server gets, from its own pages.
4. Each answer has a Content-Security-Policy: scripts, styles and pictures of this server only, none inline.

Source: OWASP cheat sheets on cross-site request forgery and on DNS rebinding.
"""

from __future__ import annotations

import hmac
from collections.abc import Iterable
from http import HTTPStatus
from typing import TYPE_CHECKING
from urllib.parse import parse_qs

from starlette.datastructures import Headers, MutableHeaders
from starlette.requests import cookie_parser
from starlette.responses import PlainTextResponse, RedirectResponse

if TYPE_CHECKING:
    from starlette.types import ASGIApp, Message, Receive, Scope, Send

POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; "
    "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)
HEADERS = {
    "content-security-policy": POLICY,
    "x-content-type-options": "nosniff",
    "referrer-policy": "no-referrer",
    "cross-origin-opener-policy": "same-origin",
    "cross-origin-resource-policy": "same-origin",
    "cache-control": "no-store",
}
REFUSED = 4403  # close code of a WebSocket: "forbidden", in the private range


class Guard:
    """A wrapper round the server's routes."""

    def __init__(self, app: ASGIApp, token: str, hosts: Iterable[str], cookie: str) -> None:
        self._app, self._token, self._cookie = app, token, cookie
        self._hosts = frozenset(hosts)  # with their ports

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass a request on, or refuse it."""
        if scope["type"] not in ("http", "websocket"):
            await self._app(scope, receive, send)
            return
        headers = Headers(scope=scope)
        why = self._refusal(scope, headers)
        if why is not None:
            await _refuse(why, scope, receive, send)
            return
        if self._brings_token(scope):
            response = RedirectResponse("/", HTTPStatus.SEE_OTHER)
            response.set_cookie(
                self._cookie, self._token, httponly=True, samesite="strict", path="/"
            )
            await response(scope, receive, _with_headers(send))
            return
        await self._app(scope, receive, _with_headers(send))

    def _refusal(self, scope: Scope, headers: Headers) -> str | None:
        """Why a request is refused; None if it may pass."""
        host, origin = headers.get("host", ""), headers.get("origin")
        if host not in self._hosts:
            return "this server is not called by that name; open the address that morfax panel printed"
        changes = scope["type"] == "websocket" or scope["method"] not in ("GET", "HEAD")
        if (changes and origin is None) or (origin is not None and origin != f"http://{host}"):
            return "the request comes from another page; open the address that morfax panel printed"
        if self._brings_token(scope):
            return None
        shown = cookie_parser(headers.get("cookie", "")).get(self._cookie, "")
        if not hmac.compare_digest(shown.encode(), self._token.encode()):
            return (
                "no token: open the whole address that morfax panel printed, with its ?token="
            )
        return None

    def _brings_token(self, scope: Scope) -> bool:
        """Whether a request opens the page with the token in its address."""
        if scope["type"] != "http" or scope["path"] != "/":
            return False
        given = parse_qs(scope["query_string"].decode("latin-1")).get("token", [""])[0]
        return hmac.compare_digest(given.encode(), self._token.encode())


def _with_headers(send: Send) -> Send:
    """Have each answer carry the headers."""

    async def sending(message: Message) -> None:
        if message["type"] == "http.response.start":
            MutableHeaders(scope=message).update(HEADERS)
        await send(message)

    return sending


async def _refuse(why: str, scope: Scope, receive: Receive, send: Send) -> None:
    """Refuse a request in words."""
    if scope["type"] == "websocket":
        await send({"type": "websocket.close", "code": REFUSED, "reason": why})
        return
    await PlainTextResponse(f"{why}\n", HTTPStatus.FORBIDDEN)(
        scope, receive, _with_headers(send)
    )
