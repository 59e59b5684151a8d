"""Access control of the studio: hosts, origins, and a token on every request and socket."""

from __future__ import annotations

import hmac
import ipaddress
import socket
from collections.abc import Iterable
from http.cookies import CookieError, SimpleCookie
from urllib.parse import parse_qs, urlsplit

from starlette.responses import HTMLResponse, PlainTextResponse, RedirectResponse, Response
from starlette.types import ASGIApp, Message, Receive, Scope, Send

HEADERS = {
    "content-security-policy": (
        "default-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; font-src 'self'"
        " data:; connect-src 'self'; frame-ancestors 'none'; base-uri 'none'; form-action 'none'"
    ),
    "referrer-policy": "no-referrer",
    "x-content-type-options": "nosniff",
    "x-frame-options": "DENY",
    "cross-origin-opener-policy": "same-origin",
}
ASK = """<!doctype html>
<html lang="en">
<title>deodar studio</title>
<meta name="viewport" content="width=device-width">
<style>
:root { color-scheme: light dark }
body { font: 1rem/1.5 system-ui, sans-serif; max-width: 34rem; margin: 15vh auto }
</style>
<h1>deodar studio</h1>
<p>This studio needs its token. Open the address that <code>deodar studio</code> printed in the terminal, or
enter the token of that address:</p>
<form action="./" method="get">
<label>Token <input name="token" type="password" autocomplete="off" autofocus></label> <button>Open</button>
</form>
</html>
"""
ON = """<!doctype html>
<html lang="en">
<title>deodar studio</title>
<meta http-equiv="refresh" content="0; url=./">
<p><a href="./">Open the studio</a></p>
</html>
"""


def is_local(host: str) -> bool:
    """Return whether a host name or address is reachable from this machine only."""
    if host == "localhost":
        return True
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False


class Guard:
    """ASGI middleware that refuses requests from other sites and from users without the token.

    The host of a request must be the one that the server listens on (or this machine's name or address),
    which prevents DNS rebinding; its origin, if the browser states one, must be the same; and every request
    needs the token, in the address or as a cookie. Other users of this machine can reach the server too, so
    the token is needed on localhost as well. The name of the cookie contains the port: browsers store cookies
    by host alone, and two studios would overwrite each other's.

    Args:
        app: application that receives the accepted requests.
        host, port: address that the server listens at.
        token: the token; empty: none is needed.
    """

    def __init__(self, app: ASGIApp, host: str, port: int, token: str) -> None:
        self._app, self._host, self._port, self._token = app, host, port, token
        self.cookie = f"deodar_token_{port}"

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass a request to the application, or refuse it."""
        if scope["type"] == "lifespan":
            return await self._app(scope, receive, send)
        headers = {key.decode("latin-1"): value.decode("latin-1") for key, value in scope["headers"]}
        status, wrong = self._wrong(headers)
        if wrong:
            return await self._refuse(scope, receive, send, status, wrong)
        if self._token:
            asked = parse_qs(scope.get("query_string", b"").decode("latin-1")).get("token", [""])[0]
            if not any(
                _same(self._token, given)
                for given in (asked, _cookie(headers.get("cookie", ""), self.cookie))
            ):
                return await self._ask(scope, receive, send, headers)
            if asked and scope["type"] == "http" and scope["path"] == "/":
                return await self._enter(scope, receive, send, headers)
        return await self._app(scope, receive, self._with_headers(send))

    def _wrong(self, headers: dict[str, str]) -> tuple[int, str]:
        host, port = _split(headers.get("host", ""))
        if not self._is_ours(host) or port not in (self._port, None):
            return 403, f"this studio is not called {headers.get('host', '')!r}"
        origin = headers.get("origin")
        if origin is not None:
            try:
                there = urlsplit(origin)
            except ValueError:
                return 400, "the origin of the request is not an address"
            if there.scheme not in ("http", "https") or there.netloc != headers.get("host"):
                return 403, f"a page of {origin} may not use this studio"
        return 0, ""

    def _is_ours(self, host: str) -> bool:
        if is_local(host) or host == self._host:
            return True
        if is_local(self._host):
            return False
        try:
            ipaddress.ip_address(host)
            return True  # a numeric address needs no DNS, so DNS rebinding is not possible
        except ValueError:
            return host in (socket.gethostname(), socket.getfqdn())

    async def _enter(self, scope: Scope, receive: Receive, send: Send, headers: dict[str, str]) -> None:
        """Move the token from the address to a cookie, and redirect to the page.

        After a link from another site the browser does not send a strict cookie with the redirect, but it
        does after a page of this server.
        """
        if headers.get("sec-fetch-site") == "cross-site":
            answer: Response = HTMLResponse(ON, headers=HEADERS)
        else:
            answer = RedirectResponse("./", 303, headers=HEADERS)
        answer.headers["cache-control"] = "no-store"
        answer.set_cookie(self.cookie, self._token, httponly=True, samesite="strict")
        await answer(scope, receive, send)

    async def _ask(self, scope: Scope, receive: Receive, send: Send, headers: dict[str, str]) -> None:
        """Refuse a request without the token; a browser that asks for the page gets a form for the token."""
        if scope["type"] != "http" or scope["path"] != "/" or "text/html" not in headers.get("accept", ""):
            why = "this studio needs the token that was printed when it was started: open that address"
            return await self._refuse(scope, receive, send, 401, why)
        policy = HEADERS["content-security-policy"].replace("form-action 'none'", "form-action 'self'")
        answer = HTMLResponse(
            ASK, 401, headers={**HEADERS, "content-security-policy": policy, "cache-control": "no-store"}
        )
        return await answer(scope, receive, send)

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
    """Split a host header into name and port."""
    try:
        found = urlsplit(f"//{host}")
        return found.hostname or "", found.port
    except ValueError:
        return "", None


def _cookie(header: str, name: str) -> str:
    try:
        found = SimpleCookie(header).get(name)
    except CookieError:
        return ""
    return found.value if found is not None else ""


def _same(token: str, given: str) -> bool:
    return hmac.compare_digest(token.encode(), given.encode("utf-8", "replace"))
