"""The web application: the built page, the pictures of the gallery, the plots of packages, and one socket."""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import AsyncGenerator, Callable
from pathlib import Path

from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import FileResponse, PlainTextResponse, Response
from starlette.routing import Mount, Route, WebSocketRoute
from starlette.staticfiles import StaticFiles
from starlette.types import ASGIApp
from starlette.websockets import WebSocket

from deodar.errors import DeodarError
from deodar_studio.access.guard import Guard
from deodar_studio.catalogue import gallery, plots
from deodar_studio.pages.hub import Hub
from deodar_studio.web.connection import PageConnection
from deodar_studio.web.service import Service

STATIC = Path(__file__).parents[1] / "static"
NOT_BUILT = """The page of the studio has not been built.

In a copy of the repository, with the environment switched on, type

    python studio/build.py build

or install deodar again, which builds it too:

    python -m pip install -e .          (with uv:  uv sync --reinstall-package deodar)
"""
FOR_EVER = {"cache-control": "public, max-age=31536000, immutable"}


class Studio:
    """ASGI application of the studio, behind a `Guard`.

    Args:
        service: settings of the studio.
        port: port that the server listens at.
        secret: token that requests need; empty: none (see `Guard`).
        ready: called when the application has started.
        ended: called when the application has closed.
    """

    def __init__(
        self,
        service: Service,
        port: int,
        secret: str,
        ready: Callable[[], None],
        ended: Callable[[], None] = lambda: None,
    ) -> None:
        self._service, self._ready, self._ended = service, ready, ended
        self._hub: Hub | None = None
        self._opening: asyncio.Task[None] | None = None
        self._ends = False
        routes = [
            Route("/", self._page),
            Route("/examples/{name}", self._picture),
            Route("/plots/{name}", self._plot),
            WebSocketRoute("/ws", self._socket),
            Mount("/assets", _Assets(directory=STATIC / "assets", check_dir=False)),
            Route("/{name}", self._file_of_page),
        ]
        star = Starlette(routes=routes, lifespan=self._life)
        star.router.redirect_slashes = False  # a path such as //host would be redirected to another host
        self.app: ASGIApp = Guard(star, service.host, port, secret)

    @contextlib.asynccontextmanager
    async def _life(self, app: Starlette) -> AsyncGenerator[None]:
        service = self._service
        self._hub = Hub(service.root, service.trust, service.world, service.private, service.unattended)
        self._opening = asyncio.create_task(_open(self._hub, service.file))
        if self._ends:
            self._opening.cancel()
        try:
            await asyncio.wait([self._opening])
            if not self._opening.cancelled():
                self._opening.result()
                self._ready()
            yield
            await self._hub.close()
        finally:
            self._ended()

    def end(self) -> None:
        """Leave the first document, if it is being opened; the server closes its application only after that.
        Signal handlers may call it.
        """
        self._ends = True
        if self._opening is not None and not self._opening.done():
            self._opening.get_loop().call_soon_threadsafe(self._opening.cancel)

    def working(self) -> bool:
        """Return whether a thread still works after the application has closed."""
        return self._hub is not None and self._hub.working()

    async def _page(self, request: Request) -> Response:
        index = STATIC / "index.html"
        if not index.is_file():
            return PlainTextResponse(NOT_BUILT, 503)
        return FileResponse(index, headers={"cache-control": "no-cache"})

    async def _file_of_page(self, request: Request) -> Response:
        """Serve a file from the folder of the page, such as its icon."""
        path = STATIC / request.path_params["name"]
        try:
            there = path.parent == STATIC and path.is_file()
        except (OSError, ValueError):  # a name that is too long, or that contains a null
            there = False
        return FileResponse(path) if there else PlainTextResponse("not found", 404)

    async def _picture(self, request: Request) -> Response:
        try:
            path = gallery.picture_file(request.path_params["name"].removesuffix(".png"))
        except DeodarError:
            path = None
        return FileResponse(path) if path is not None else PlainTextResponse("not found", 404)

    async def _plot(self, request: Request) -> Response:
        """Serve the ES module of a plot from a package; no other file of the package."""
        name, dot, suffix = request.path_params["name"].rpartition(".")
        path = plots.file(name) if dot and suffix == "js" else None
        if path is None:
            return PlainTextResponse("not found", 404)
        # a browser runs a module of this media type only; a package that is edited may change at any time
        return FileResponse(path, media_type="text/javascript", headers={"cache-control": "no-cache"})

    async def _socket(self, socket: WebSocket) -> None:
        assert self._hub is not None
        await PageConnection(socket, self._hub).run()


async def _open(hub: Hub, file: Path | None) -> None:
    """Open the first document; one that cannot be opened is shown with its problems."""
    if file is None:
        return
    try:
        await hub.project.queue.run(lambda: hub.open(file.resolve(), True, True))
    except DeodarError as error:
        hub.project.file.refuse(file.name, error.problems)


class _Assets(StaticFiles):
    """Files with a hash of the content in their names, which browsers may cache without limit."""

    def file_response(self, *args: object, **values: object) -> Response:
        response = super().file_response(*args, **values)  # type: ignore[arg-type]
        response.headers.update(FOR_EVER)
        return response
