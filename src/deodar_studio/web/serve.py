"""Start the studio: bind a socket, run the server, open a browser."""

from __future__ import annotations

import contextlib
import logging
import os
import signal
import socket
import sys
import webbrowser
from collections.abc import Callable, Generator
from types import FrameType
from urllib.parse import urlsplit

import uvicorn

from deodar import private_file
from deodar.errors import OutputError
from deodar.session.interrupt import interrupted_at_end
from deodar_studio.access import token as tokens
from deodar_studio.access.guard import is_local
from deodar_studio.access.redirect_file import RedirectFile
from deodar_studio.files.state_store import state_folder
from deodar_studio.web.app import Studio
from deodar_studio.web.service import Service

PORT = 8430
"""First port that is tried; if it is in use, the next free one is taken."""

TRIED = 20
TURN = 5e-4
"""s after which a thread of the interpreter lets another one run (the interpreter's own is 5e-3; a guess that
shortens the way of an edit, which changes threads several times while a program is traced).
"""

MOST_MESSAGE = 64 * 2**20
"""Longest message from a page, in bytes: a dropped document, or a picture as base64."""


class StudioServer(uvicorn.Server):
    """A server of a studio."""

    def __init__(self, config: uvicorn.Config, studio: Studio) -> None:
        super().__init__(config)
        self.working, self._end = studio.working, studio.end

    def handle_exit(self, sig: int, frame: FrameType | None) -> None:
        """End after a signal; a second one must not skip the rest of motors and the storing of edits."""
        super().handle_exit(sig, frame)
        self.force_exit = False
        self._end()


def serve(service: Service, browser: bool, say: Callable[[str], None]) -> int:
    """Serve until Ctrl-C, SIGTERM or SIGHUP, and open the page in a browser if `browser` is true.

    `say` is called with the address when the server is ready. An address with a token is passed to the
    browser in a file of this user, which is removed when the studio ends. If a thread still compiles then,
    this process ends at once: a compilation cannot be interrupted, and Python would wait for it.

    Returns:
        the status of the command: 0 after Ctrl-C, after another signal what a shell reports of a process
        that it has ended.
    """
    redirects: list[RedirectFile] = []

    def ready(address: str) -> None:
        say(address)
        if not browser:
            return
        if not urlsplit(address).query:
            webbrowser.open(address)
            return
        try:
            redirects.append(RedirectFile(address))
        except OSError as error:
            logging.getLogger("deodar.studio").warning(
                f"the browser is not opened: a temporary file cannot be written ({error.strerror})"
            )
            return
        webbrowser.open(redirects[-1].address)

    def ended() -> None:
        for redirect in redirects:
            redirect.remove()

    server, bound = prepare(service, ready, ended)
    # the server passes a signal on after it has closed; Ctrl-C is the normal end
    with interrupted_at_end() as received, contextlib.suppress(KeyboardInterrupt), short_turns():
        server.run(sockets=[bound])
    status = 128 + received[0] if received else 0
    with contextlib.suppress(OSError):  # the terminal may be gone
        if received:
            sys.stderr.write(f"deodar studio: {signal.Signals(received[0]).name} has ended the studio\n")
        sys.stdout.flush()
        sys.stderr.flush()
    if server.working():
        os._exit(status)
    return status


@contextlib.contextmanager
def short_turns() -> Generator[None]:
    """Make the threads of this process take turns at intervals of `TURN`, and restore the interval after it.

    An edit passes several times between the server's thread and the engine's; each time it waits for a turn
    while a third thread traces the new program.
    """
    before = sys.getswitchinterval()
    sys.setswitchinterval(TURN)
    try:
        yield
    finally:
        sys.setswitchinterval(before)


def prepare(
    service: Service,
    ready: Callable[[str], None],
    ended: Callable[[], None] = lambda: None,
) -> tuple[StudioServer, socket.socket]:
    """Return a server that is not started yet, and the socket for it.

    `ready` is called with the address when the server is ready. `ended` is called when the server stops,
    before a signal such as SIGTERM ends the process.
    """
    secret = tokens.stated() if service.token else ""
    host, bound = service.host, bind(service.host, service.port)
    number = bound.getsockname()[1]
    if service.token and not secret:
        secret = tokens.kept(state_folder(), number) if is_local(host) else private_file.new()
    shown = host if host not in ("0.0.0.0", "::") else socket.gethostname()
    address = (
        f"http://{f'[{shown}]' if ':' in shown else shown}:{number}/{f'?token={secret}' if secret else ''}"
    )
    studio = Studio(service, number, secret, lambda: ready(address), ended)
    config = uvicorn.Config(
        studio.app,
        log_level="warning",
        access_log=False,
        ws="websockets-sansio",
        ws_per_message_deflate=False,
        ws_max_size=MOST_MESSAGE,
        lifespan="on",
        timeout_graceful_shutdown=1,
        server_header=False,
    )
    return StudioServer(config, studio), bound


def bind(host: str, port: int | None) -> socket.socket:
    """Bind a socket to a port, or with None to the first free port from `PORT` on."""
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    wanted = [port] if port is not None else [*range(PORT, PORT + TRIED), 0]
    for number in wanted:
        # TCP is stated, so that the event loop sets TCP_NODELAY; without it Nagle's algorithm delays each
        # frame by 40 ms
        bound = socket.socket(family, socket.SOCK_STREAM, socket.IPPROTO_TCP)
        if os.name == "posix":  # allows a port that was just released; on other systems also one in use
            bound.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            bound.bind((host, number))
            bound.listen(100)  # a page may connect as soon as the address is known
            return bound
        except (OSError, OverflowError) as error:
            bound.close()
            if port is not None:
                why = getattr(error, "strerror", None) or str(error)
                raise OutputError(
                    f"cannot listen at {host} on port {number}: {why}",
                    fix="Use another one: --port 0 finds a free one",
                ) from None
    raise OutputError(f"no free port at {host}", fix="Name one: --port N")
