"""Where messages of ROS 2 are on Zenoh, as rmw_zenoh places them: keys, tokens and attachments."""

from __future__ import annotations

import re
import struct
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal

from deodar.errors import WorldError, did_you_mean
from deodar_robots.ros2.message_types import Unreadable

GID = 16
"""Length of the number of a publisher, bytes."""

ATTACHMENT = struct.Struct(f"<qqB{GID}s")
"""Sequence number, time of sending (ns since 1970), length of the number of the publisher, and the number."""

QUALITY = "::,10:,:,:,,"
"""Quality of service in a token: all as by default (reliable, volatile, keep last), with a depth of 10."""

_TOPIC = re.compile(r"/?(?:[A-Za-z_]\w*/)*[A-Za-z_]\w*", re.ASCII)

TokenRole = Literal["NN", "MP", "MS"]
"""What a token stands for: a node, a publisher, or a subscription."""


@dataclass(frozen=True)
class Attachment:
    """What accompanies a message.

    Attributes:
        sequence: number of the message; it grows by one from message to message of a publisher.
        time: when it was sent, ns since 1970.
        publisher: number of the publisher, 16 bytes.
    """

    sequence: int
    time: int
    publisher: bytes

    def to_bytes(self) -> bytes:
        """Return the attachment as bytes."""
        return ATTACHMENT.pack(self.sequence, self.time, GID, self.publisher)

    @classmethod
    def from_bytes(cls, raw: bytes | None) -> Attachment:
        """Read an attachment.

        Raises:
            Unreadable: the message has none, or it has another form.
        """
        if raw is None:
            raise Unreadable("it has no attachment, so that it does not come from rmw_zenoh")
        if len(raw) != ATTACHMENT.size or raw[16] != GID:
            raise Unreadable(
                f"its attachment has {len(raw)} bytes, not {ATTACHMENT.size}", "Update rmw_zenoh of the robot"
            )
        sequence, time, _, publisher = ATTACHMENT.unpack(raw)
        return cls(sequence, time, publisher)


def require_topic(text: str, where: str) -> str:
    """Return the name of a topic with its slash in front, or raise WorldError."""
    if not _TOPIC.fullmatch(text):
        raise WorldError(f"{text!r} is not the name of a topic", where, "Write it as /scan or /robot/scan")
    return "/" + text.lstrip("/")


def type_on_wire(name: str) -> str:
    """Return the name of a type in a key: `std_msgs/msg/String` is `std_msgs::msg::dds_::String_`."""
    package, _, short = name.split("/")
    return f"{package}::msg::dds_::{short}_"


def type_of_wire(text: str) -> str:
    """Return the name of a type from that in a key."""
    return text.replace("::dds_::", "::").removesuffix("_").replace("::", "/")


def topic_key(domain: int, topic: str, type: str = "*", hash: str = "*") -> str:
    """Return the key of a topic; a name of a type and its hash may be `*`."""
    return f"{domain}/{topic.strip('/')}/{type if type == '*' else type_on_wire(type)}/{hash}"


def token(
    domain: int,
    session: str,
    number: int,
    role: TokenRole,
    node: str,
    about: tuple[str, str, str] | None = None,
) -> str:
    """Return the key of the liveliness token of a node, or of a publisher or subscription of it.

    Args:
        domain: domain of ROS 2.
        session: identity of the session of Zenoh, hexadecimal.
        number: number of what the token stands for, in the session; 0 is the node.
        role: what it stands for.
        node: name of the node, without a namespace.
        about: topic, type and hash of a publisher or subscription.
    """
    parts = ["@ros2_lv", str(domain), session, "0", str(number), role, "%", "%", node]
    if about is not None:
        topic, type, hash = about
        parts += [topic.replace("/", "%"), type_on_wire(type), hash, QUALITY]
    return "/".join(parts)


def tokens_of(domain: int) -> str:
    """Return the key of all tokens of a domain."""
    return f"@ros2_lv/{domain}/**"


def published(tokens: Iterable[str]) -> dict[str, str]:
    """Return the types of the topics that have a publisher, by topic, from tokens."""
    found: dict[str, str] = {}
    for each in tokens:
        parts = each.split("/")
        if len(parts) >= 12 and parts[5] == "MP":
            found[parts[9].replace("%", "/")] = type_of_wire(parts[10])
    return dict(sorted(found.items()))


def nearest_topic(topic: str, types: dict[str, str]) -> str:
    """Return what to type where a topic has no publisher, from the topics that have one."""
    if not types:
        return "No node publishes there. Type: ros2 topic list"
    near = did_you_mean(topic, types)
    listed = ", ".join(list(types)[:20])
    return near if near.startswith("Did you mean") else f"Topics with a publisher: {listed}"
