"""The server's routes: the page and its files, tiles, actions, uploads, results, and the stream of news.

    GET  /                    the page                GET  /tile/ID/sheet|lines/LEVEL/COLUMN/ROW
    GET  /page/NAME           its files               GET  /result            curves of the last run, JSON
    GET  /state               the state               GET  /file/NAME         a result to keep
    POST /do                  an action               POST /upload/NAME       a drawing
                                                      POST /own/OPTION/NAME   a card, settings, a machine
    WS   /watch               news, at most 30 a second

Whatever is refused is answered in one line of words. A tile or a result that is gone by the time it is asked
for is no fault: it is answered by 204, without content.
"""

from __future__ import annotations

import asyncio
import contextlib
import json
from collections.abc import AsyncIterator
from http import HTTPStatus
from importlib import resources
from typing import TYPE_CHECKING, Any

from starlette.applications import Starlette
from starlette.exceptions import HTTPException
from starlette.responses import FileResponse, JSONResponse, Response
from starlette.routing import Route, WebSocketRoute
from starlette.websockets import WebSocketDisconnect

from morfax.jobs.wrong_use import WrongUse
from morfax.motion.faults import Fault
from morfax.panel import actions, own_files, state, uploads
from morfax.panel.head_path import FRAME_S
from morfax.panel.page_words import in_page_words

if TYPE_CHECKING:
    from starlette.requests import Request
    from starlette.websockets import WebSocket

    from morfax.panel.bench import Bench

LARGEST_ACTION = 100_000  # bytes
TYPES = {
    ".html": "text/html; charset=utf-8",
    ".js": "text/javascript; charset=utf-8",
    ".css": "text/css; charset=utf-8",
    ".svg": "image/svg+xml",
    ".txt": "text/plain; charset=utf-8",
}


def routes(bench: Bench) -> Starlette:
    """The server round a bench; `guard` stands before it."""
    pages = _Pages(bench)

    @contextlib.asynccontextmanager
    async def lifespan(app: Starlette) -> AsyncIterator[None]:
        await bench.begin()
        yield
        await bench.close()

    return Starlette(
        routes=[
            Route("/", pages.page),
            Route("/page/{name}", pages.page),
            Route("/state", pages.state),
            Route("/do", pages.do, methods=["POST"]),
            Route("/upload/{name}", pages.upload, methods=["POST"]),
            Route("/own/{option}/{name}", pages.own, methods=["POST"]),
            Route("/tile/{picture:int}/{kind}/{level:int}/{column:int}/{row:int}", pages.tile),
            Route("/result", pages.result),
            Route("/file/{name}", pages.file),
            WebSocketRoute("/watch", pages.watch),
        ],
        lifespan=lifespan,
    )


class _Pages:
    """The answers."""

    def __init__(self, bench: Bench) -> None:
        self._bench = bench
        folder = resources.files("morfax.panel").joinpath("page")
        self._files = {
            file.name: file.read_bytes() for file in folder.iterdir() if file.is_file()
        }

    async def page(self, request: Request) -> Response:
        """The page, or one of its files."""
        name = request.path_params.get("name", "index.html")
        if name not in self._files:
            raise HTTPException(404, "there is no such file")
        suffix = name[name.rfind(".") :]
        return Response(
            self._files[name], media_type=TYPES.get(suffix, "application/octet-stream")
        )

    async def state(self, request: Request) -> Response:
        """What a page needs at first."""
        return JSONResponse({**state.hello(self._bench), "state": state.state(self._bench)})

    async def do(self, request: Request) -> Response:
        """Do an action; 409 with words if it cannot be done."""
        body = b""
        async for piece in request.stream():
            body += piece
            if len(body) > LARGEST_ACTION:
                return _refused("the action is too long", HTTPStatus.REQUEST_ENTITY_TOO_LARGE)
        try:
            action = json.loads(body)
            if not isinstance(action, dict):
                raise ValueError
        except (ValueError, RecursionError):
            return _refused("that is no action", HTTPStatus.BAD_REQUEST)
        try:
            actions.do(self._bench, action)
        except (WrongUse, Fault) as refused:
            return _refused(
                " ".join(str(refused).split()),
                HTTPStatus.CONFLICT,
                self._bench.history.revision,
            )
        return JSONResponse({"revision": self._bench.history.revision})

    async def upload(self, request: Request) -> Response:
        """Take in a drawing; 409 with words if it is none, or too large."""
        length = request.headers.get("content-length", "")
        size = int(length) if length.isdecimal() else None
        folder = self._bench.folder / "drawings"
        try:
            file = await uploads.take(
                folder, request.path_params["name"], request.stream(), size
            )
        except Fault as refused:
            return _refused(str(refused), HTTPStatus.CONFLICT)
        self._bench.sources[file.name] = file
        self._bench.changed()
        return JSONResponse({"drawing": file.name})

    async def own(self, request: Request) -> Response:
        """Take in a card, settings or a machine; 409 with words if the command line would refuse it."""
        bench, at = self._bench, request.path_params
        option = "any" if at["option"] == "any" else f"--{at['option']}"
        content = b""
        async for piece in request.stream():
            content += piece
            if len(content) > own_files.MOST_BYTES:
                break
        try:
            if option != "any" and option not in own_files.CALLED:
                raise WrongUse(
                    f"{option} takes no file here; this server takes cards, settings and machines"
                )
            option, file = own_files.take(
                bench.folder, at["name"], content, option, bench.command_line
            )
        except (WrongUse, Fault) as refused:
            return _refused(" ".join(str(refused).split()), HTTPStatus.CONFLICT)
        bench.own[file.name] = file
        bench.changed()
        return JSONResponse({"option": option, "name": file.name})

    async def tile(self, request: Request) -> Response:
        """A square of the sheet, or of its lines; nothing where the picture has changed since."""
        bench, at = self._bench, request.path_params
        sources: dict[str, Any] = {"sheet": bench.picture, "lines": bench.line_map}
        if at["kind"] not in sources:
            raise HTTPException(404, "there is no such picture")
        source = sources[at["kind"]]
        if source is None or at["picture"] != bench.picture_id:
            return Response(status_code=HTTPStatus.NO_CONTENT)
        try:
            tile = await asyncio.to_thread(source.tile, at["level"], at["column"], at["row"])
        except IndexError:
            raise HTTPException(404, "there is no such tile") from None
        return Response(tile, media_type="image/png")

    async def result(self, request: Request) -> Response:
        """The curves of the last run; nothing where another run has begun since they were asked for."""
        if self._bench.kept.result is None:
            return Response(status_code=HTTPStatus.NO_CONTENT)
        return JSONResponse(self._bench.kept.result)

    async def file(self, request: Request) -> Response:
        """A result to keep."""
        name = request.path_params["name"]
        if name not in self._bench.kept.files():
            raise HTTPException(404, "there is no such result")
        return FileResponse(
            self._bench.folder / name, filename=name, media_type="application/octet-stream"
        )

    async def watch(self, socket: WebSocket) -> None:
        """Tell a page what is new, when it is ready for it."""
        await socket.accept()
        event = self._bench.look_on()
        telling = asyncio.create_task(self._tell(socket, event))
        try:
            while True:  # what a page sends here is not read; it ends the stream by closing it
                await socket.receive_bytes()
        except (WebSocketDisconnect, KeyError, RuntimeError):
            pass
        finally:
            self._bench.look_away(event)
            telling.cancel()

    async def _tell(self, socket: WebSocket, event: asyncio.Event) -> None:
        """Send one frame after the other, each made when the last one has gone."""
        version, life, at = -1, -1, 0
        while True:
            await event.wait()
            event.clear()
            frame: dict[str, Any] = {}
            if self._bench.version != version:
                version = self._bench.version
                frame["state"] = state.state(self._bench)
            head = self._bench.path.since(life, at)
            life = head["life"]
            at = head["from"] + len(head["fresh"])
            frame["head"] = head
            await socket.send_text(json.dumps(frame))
            if head["more"]:
                event.set()
            await asyncio.sleep(FRAME_S)


def _refused(text: str, status: int, revision: int | None = None) -> Response:
    """A refusal in words."""
    return JSONResponse({"refused": in_page_words(text), "revision": revision}, status)
