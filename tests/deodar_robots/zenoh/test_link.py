"""The connection: this machine alone unless another host is trusted."""

from __future__ import annotations

import socket
import subprocess
import sys

import psutil
import pytest

from deodar.errors import WorldError
from deodar_robots.zenoh import link
from deodar_robots.zenoh.served_world import free_endpoint


@pytest.mark.parametrize("text", ["tcp/127.0.0.1:7461", "tcp/localhost:1", "tcp/[::1]:7461"])
def test_endpoints_of_this_machine_are_accepted(text):
    assert link.require_endpoint(text) == text


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("tcp/192.168.1.4:7461", "beyond this machine, without encryption"),
        ("tcp/0.0.0.0:7461", "beyond this machine, without encryption"),
        ("tcp/robot.lab:7461", "trusted=True"),
        ("tcp/127.0.0.1:99999", "is not an endpoint"),
        ("127.0.0.1:7461", "Write it as tcp/127.0.0.1:7461"),
        ("quic/robot.lab:7461", "is not an endpoint"),
        ("udp/127.0.0.1:7461", "is not an endpoint"),
    ],
)
def test_other_endpoints_are_refused(text, message):
    with pytest.raises(WorldError, match=message):
        link.require_endpoint(text)


def test_zenoh_is_imported_by_the_first_connection_alone():
    code = "import sys, deodar; deodar.Zenoh; sys.exit('zenoh' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code]).returncode == 0


def test_another_host_that_is_trusted_is_accepted():
    assert link.require_endpoint("tcp/192.168.1.4:7461", trusted=True) == "tcp/192.168.1.4:7461"


def test_the_owner_listens_at_its_endpoint_alone_and_the_commander_nowhere():
    here = free_endpoint()
    before = listening()
    owner = link.listen(here)
    connection = link.connect(here, 2.0)
    try:
        assert listening() - before == {("127.0.0.1", int(here.rpartition(":")[2]))}
        with pytest.raises(WorldError, match=f"cannot listen at {here}: another program does"):
            link.listen(here)
    finally:
        connection.close()
        owner.close()
    assert listening() == before


def test_a_place_where_nobody_listens_is_named_within_the_patience():
    here = free_endpoint()
    with pytest.raises(WorldError, match=f"no robot answers at {here} within 0.3 s.*deodar serve"):
        link.connect(here, 0.3)


def listening() -> set[tuple[str, int]]:
    """Return the addresses at which this process listens."""
    return {
        tuple(c.laddr)
        for c in psutil.Process().net_connections("inet")
        if c.status == psutil.CONN_LISTEN or c.type == socket.SOCK_DGRAM
    }
