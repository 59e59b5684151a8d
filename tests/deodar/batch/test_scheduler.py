"""The ports of `local:N` serve no client that lacks the certificate of the processes."""

from __future__ import annotations

import contextlib
import http.client
import socket
from collections.abc import Generator
from typing import Any

import distributed
import psutil
import pytest

from deodar.batch.scheduler import connected
from deodar.cluster import Cluster


def own_process() -> int:
    return psutil.Process().pid


@pytest.fixture(scope="module")
def client() -> Generator[Any]:
    """Yield a client of `local:1` whose process has started."""
    with contextlib.ExitStack() as stack:
        client = connected(Cluster("local:1"), stack, None)
        assert client.submit(own_process).result(60) != own_process()
        yield client


def ports() -> list[int]:
    """Return the ports that this process and its children open."""
    processes = [psutil.Process(), *psutil.Process().children(recursive=True)]
    return [c.laddr.port for p in processes for c in p.net_connections("tcp") if c.status == "LISTEN"]


def heard(port: int, security: Any) -> bytes:
    """Return what a port says over TLS to a client with this certificate; nothing if it hangs up."""
    try:
        with (
            socket.create_connection(("127.0.0.1", port), timeout=3) as plain,
            security.get_connection_args("client")["ssl_context"].wrap_socket(plain) as link,
        ):
            return link.recv(1)
    except OSError:
        return b""


def test_only_who_has_the_certificate_hears_from_a_port(client: Any) -> None:
    # scheduler, nanny and worker, and what would be their pages
    assert len(ports()) >= 4
    stranger = distributed.Security.temporary()
    assert [port for port in ports() if heard(port, stranger)] == []
    assert len([port for port in ports() if heard(port, client.security)]) >= 3


def test_a_plain_link_hears_nothing(client: Any) -> None:
    for port in ports():
        with socket.create_connection(("127.0.0.1", port), timeout=3) as link, contextlib.suppress(OSError):
            link.sendall(bytes(64) + b"\r\n\r\n")
            # a port of TLS answers with an alert, one for pages with an error of HTTP
            assert link.recv(64)[:2] in (b"", b"\x15\x03", b"HT")


def test_no_port_serves_a_page(client: Any) -> None:
    answers: dict[tuple[int, str], int] = {}
    for port in ports():
        for page in ("/", "/health", "/info/main/workers.html", "/json/counts.json", "/metrics", "/status"):
            link = http.client.HTTPConnection("127.0.0.1", port, timeout=5)
            # a port of TLS hangs up
            with contextlib.closing(link), contextlib.suppress(OSError, http.client.HTTPException):
                link.request("GET", page)
                answers[port, page] = link.getresponse().status
    assert answers and {at: status for at, status in answers.items() if status != 404} == {}
