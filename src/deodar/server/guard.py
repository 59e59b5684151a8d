"""Who may talk to the studio: hosts, origins, and a token as soon as it listens beyond this machine."""

from __future__ import annotations

import hmac
import ipaddress
import socket
from collections.abc import Iterable
from http.cookies import CookieError, SimpleCookie
from urllib.parse import parse_qs, urlsplit

from starlette.responses import PlainTextResponse, RedirectResponse
from starlette.types import ASGIApp, Message, Receive, Scope, Send

COOKIE = "deodar_token"
HEADERS = {
    "content-security-policy": "default-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; font-src 'self' data:;"
    " connect-src 'self'; frame-ancestors 'none'; base-uri 'none'; form-action 'none'",
    "referrer-policy": "no-referrer",
    "x-content-type-options": "nosniff",
    "x-frame-options": "DENY",
    "cross-origin-opener-policy": "same-origin",
}


def is_local(host: str) -> bool:
    """Whether a host names this machine alone."""
    if host == "localhost":
        return True
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False


class Guard:
    """Refuses what does not come from a page of this server, opened by the person who started it.

    The host of a request must be the one it listens on (or this machine's name or address), so that no foreign name can be made to point here;
    its origin, where a browser states one, must be the same; and where there is a token, every request needs it, in the address or as a cookie.
    """

    def __init__(self, app: ASGIApp, host: str, port: int, token: str) -> None:
        self._app, self._host, self._port, self._token = app, host, port, token

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Let a request pass, or refuse it."""
        if scope["type"] == "lifespan":
            return await self._app(scope, receive, send)
        headers = {key.decode("latin-1"): value.decode("latin-1") for key, value in scope["headers"]}
        wrong = self._wrong(headers)
        if wrong:
            return await self._refuse(scope, receive, send, 403, wrong)
        asked = parse_qs(scope.get("query_string", b"").decode("latin-1")).get("token", [""])[0]
        if self._token and not any(_same(self._token, given) for given in (asked, _cookie(headers.get("cookie", "")))):
            return await self._refuse(
                scope, receive, send, 401, "this studio needs the token that was printed when it was started: open that address"
            )
        if self._token and asked and scope["type"] == "http":
            return await self._with_cookie(scope, receive, send)
        return await self._app(scope, receive, self._with_headers(send))

    def _wrong(self, headers: dict[str, str]) -> str:
        host, port = _split(headers.get("host", ""))
        if not self._is_ours(host) or port not in (self._port, None):
            return f"this studio is not called {headers.get('host', '')!r}"
        origin = headers.get("origin")
        if origin is not None:
            there = urlsplit(origin)
            if there.scheme not in ("http", "https") or there.netloc != headers.get("host"):
                return f"a page of {origin} may not use this studio"
        return ""

    def _is_ours(self, host: str) -> bool:
        if is_local(host) or host == self._host:
            return True
        if is_local(self._host):
            return False
        try:
            ipaddress.ip_address(host)
            return True  # an address cannot be made to point elsewhere
        except ValueError:
            return host in (socket.gethostname(), socket.getfqdn())

    async def _with_cookie(self, scope: Scope, receive: Receive, send: Send) -> None:
        """The token leaves the address bar at once; from then on the cookie carries it."""
        answer = RedirectResponse(scope["path"] or "/", 303, headers=HEADERS)
        answer.set_cookie(COOKIE, self._token, httponly=True, samesite="strict")
        await answer(scope, receive, send)

    async def _refuse(self, scope: Scope, receive: Receive, send: Send, status: int, why: str) -> None:
        if scope["type"] == "websocket":
            await send({"type": "websocket.close", "code": 1008, "reason": why[:120]})
        else:
            await PlainTextResponse(f"deodar studio: {why}.\n", status, headers=HEADERS)(scope, receive, send)

    def _with_headers(self, send: Send) -> Send:
        async def sent(message: Message) -> None:
            if message["type"] == "http.response.start":
                message["headers"] = [*message.get("headers", []), *_raw(HEADERS.items())]
            await send(message)

        return sent


def _raw(pairs: Iterable[tuple[str, str]]) -> list[tuple[bytes, bytes]]:
    return [(key.encode(), value.encode()) for key, value in pairs]


def _split(host: str) -> tuple[str, int | None]:
    """Name and port of a host header."""
    try:
        found = urlsplit(f"//{host}")
        return found.hostname or "", found.port
    except ValueError:
        return "", None


def _cookie(header: str) -> str:
    try:
        found = SimpleCookie(header).get(COOKIE)
    except CookieError:
        return ""
    return found.value if found is not None else ""


def _same(token: str, given: str) -> bool:
    return hmac.compare_digest(token.encode(), given.encode("utf-8", "replace"))
