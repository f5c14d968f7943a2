"""The server: where it listens, by which names it is called, and the address with its token.

Signals in: host, port, token, a bench. Signals out: the address of the page; the server then runs until
Ctrl-C.
"""

from __future__ import annotations

import secrets
import socket
import threading
import webbrowser
from collections.abc import Callable
from dataclasses import dataclass, field

import uvicorn

from morfax.jobs.wrong_use import WrongUse
from morfax.motion.faults import FileFault
from morfax.panel.app import routes
from morfax.panel.bench import Bench
from morfax.panel.guard import Guard

LOCAL = ("127.0.0.1", "localhost")
TOKEN_BYTES = 24
LEAST_TOKEN = 16  # characters of a token that somebody chose


@dataclass(frozen=True, slots=True)
class Address:
    """Where the server listens, and the token of its address."""

    host: str = LOCAL[0]
    port: int = 0  # 0: a free one
    token: str = field(default_factory=lambda: secrets.token_urlsafe(TOKEN_BYTES))

    @property
    def url(self) -> str:
        """The address to open."""
        return f"http://{self.host}:{self.port}/?token={self.token}"

    @property
    def hosts(self) -> tuple[str, ...]:
        """The names by which browsers may call the server, with the port."""
        names = LOCAL if self.host in LOCAL else (self.host,)
        return tuple(f"{name}:{self.port}" for name in names)


def checked(host: str, token: str | None) -> Address:
    """An address; raises WrongUse for one that others can reach without a token that somebody chose."""
    if token is None:
        if host not in LOCAL:
            raise WrongUse(
                f"--host {host} lets other computers open this panel: read the drawings, run the head, write"
                f" files into its folder; give a --token of {LEAST_TOKEN} characters or more as well"
            )
        return Address(host)
    if (
        len(token) < LEAST_TOKEN
        or not token.isascii()
        or not token.replace("-", "").replace("_", "").isalnum()
    ):
        raise WrongUse(
            f"--token is {token[:20]!r}; it takes {LEAST_TOKEN} or more letters, digits, - and _"
        )
    return Address(host, token=token)


def serve(
    bench: Bench, address: Address, said: Callable[[Address], None], browser: bool
) -> None:
    """Serve until Ctrl-C; `said` hears the address when the server listens.

    Raises FileFault for a taken port.
    """
    with _listening(address) as listening:
        address = Address(address.host, listening.getsockname()[1], address.token)
        app = Guard(routes(bench), address.token, address.hosts, f"morfax_panel_{address.port}")
        config = uvicorn.Config(
            app,
            log_level="warning",
            access_log=False,
            server_header=False,
            ws="websockets-sansio",
            timeout_graceful_shutdown=1,
        )
        said(address)
        if browser:
            threading.Thread(target=webbrowser.open, args=(address.url,), daemon=True).start()
        uvicorn.Server(config).run(sockets=[listening])


def _listening(address: Address) -> socket.socket:
    """A socket that listens; raises FileFault if the port is taken."""
    listening = socket.socket()
    listening.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        listening.bind((address.host, address.port))
        listening.listen()  # a browser that is quicker than the server waits
    except OSError as error:
        listening.close()
        raise FileFault(
            f"cannot listen at {address.host}:{address.port}: {error.strerror}; give another --port or --host"
        ) from error
    return listening
