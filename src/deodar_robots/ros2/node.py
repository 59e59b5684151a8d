"""A node of ROS 2: a session of Zenoh with the keys, tokens and attachments of rmw_zenoh."""

from __future__ import annotations

import secrets
import time
from collections.abc import Callable
from typing import Any

from deodar_robots.ros2.message_types import hash_of
from deodar_robots.ros2.wire import GID, Attachment, published, token, tokens_of, topic_key
from deodar_robots.zenoh import link

Take = Callable[[str, bytes, bytes | None], None]
"""Receives the key of a message, the message and its attachment, in a thread of Zenoh; it must not wait."""


class RosNode:
    """A node that subscribes to topics and publishes on others, through a router.

    Args:
        at: endpoint of the router.
        patience: time after which a router that does not answer is given up, s.
        domain: domain of ROS 2.
        name: name of the node.
    """

    def __init__(self, at: str, patience: float, domain: int, name: str) -> None:
        self._session = link.connect(at, patience, router=True)
        self._domain, self._name = domain, name
        self._identity = str(self._session.info.zid())
        self._count = 0
        self._kept: list[Any] = [self._declare("NN", None)]
        self._publishers: dict[str, tuple[Any, bytes]] = {}
        self._sequences: dict[str, int] = {}

    def _declare(self, role: Any, about: tuple[str, str, str] | None) -> Any:
        key = token(self._domain, self._identity, self._count, role, self._name, about)
        self._count += 1
        return self._session.liveliness().declare_token(key)

    def subscribe(self, topic: str, type: str, take: Take) -> None:
        """Call `take` with each message of a topic, of whichever type; the stated type is shown to others."""

        def received(sample: Any) -> None:
            attached = sample.attachment
            raw = None if attached is None else bytes(attached)
            take(str(sample.key_expr), bytes(sample.payload), raw)

        key = topic_key(self._domain, topic)
        self._kept.append(self._session.declare_subscriber(key, link.callback(received)))
        self._kept.append(self._declare("MS", (topic, type, hash_of(type))))

    def advertise(self, topic: str, type: str) -> None:
        """Declare that this node publishes on a topic."""
        hash, control = hash_of(type), link.library().CongestionControl
        key = topic_key(self._domain, topic, type, hash)
        publisher = self._session.declare_publisher(key, congestion_control=control.DROP)
        self._publishers[topic] = publisher, secrets.token_bytes(GID)
        self._sequences[topic] = 0
        self._kept.append(self._declare("MP", (topic, type, hash)))

    def publish(self, topic: str, raw: bytes, waits: bool = False) -> None:
        """Send a message; with `waits` it is not dropped when the network is busy."""
        publisher, number = self._publishers[topic]
        self._sequences[topic] += 1
        attachment = Attachment(self._sequences[topic], time.time_ns(), number).to_bytes()
        if not waits:
            publisher.put(raw, attachment=attachment)
            return
        control = link.library().CongestionControl
        self._session.put(
            publisher.key_expr, raw, attachment=attachment, congestion_control=control.BLOCK, express=True
        )

    def topics(self, patience: float) -> dict[str, str]:
        """Return the types of the topics on which others publish, by topic; wait at most some seconds."""
        replies = self._session.liveliness().get(tokens_of(self._domain), timeout=patience)
        tokens = [str(reply.ok.key_expr) for reply in replies if reply.ok is not None]
        return published(token for token in tokens if token.split("/")[2] != self._identity)

    def close(self) -> None:
        """Leave the network."""
        self._session.close()
