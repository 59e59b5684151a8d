"""A node of ROS 2 over rmw_zenoh, written from its specification: no line of the implementation is used.

Keys, tokens and attachments are spelled out; messages are bytes by `struct`, in CDR: after `00 01 00 00`
each number lies at a multiple of its size, counted from the fifth byte.
"""

from __future__ import annotations

import struct
import threading
import time

import zenoh

HASHES = {
    "Image": "RIHS01_d31d41a9a4c4bc8eae9be757b0beed306564f7526c88ea6a4588fb9582527d47",
    "LaserScan": "RIHS01_64c191398013af96509d518dac71d5164f9382553fce5c1f8cca5be7924bd828",
    "Range": "RIHS01_b42b62562e93cbfe9d42b82fe5994dfa3d63d7d5c90a317981703f7388adff3a",
    "Twist": "RIHS01_9c45bf16fe0983d80e3cfe750d6835843d265a9a6c46bd2e609fcddde6fb8d2a",
    "String": "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18",
}
PACKAGES = {
    "Image": "sensor_msgs",
    "LaserScan": "sensor_msgs",
    "Range": "sensor_msgs",
    "Twist": "geometry_msgs",
    "String": "std_msgs",
}
GID = bytes(range(16, 32))


def key(topic: str, type: str, domain: int = 0) -> str:
    return f"{domain}/{topic[1:]}/{PACKAGES[type]}::msg::dds_::{type}_/{HASHES[type]}"


class Cdr:
    """Bytes of a message, in the order of its fields."""

    def __init__(self) -> None:
        self.raw = bytearray(b"\x00\x01\x00\x00")

    def number(self, code: str, *values: float) -> Cdr:
        size = struct.calcsize(code)
        for value in values:
            self.raw += bytes(-(len(self.raw) - 4) % size) + struct.pack("<" + code, value)
        return self

    def text(self, value: str) -> Cdr:
        raw = value.encode() + b"\0"
        self.number("I", len(raw)).raw.extend(raw)
        return self

    def floats(self, values) -> Cdr:
        return self.number("I", len(values)).number("f", *values)

    def header(self) -> Cdr:
        return self.number("i", 3).number("I", 4).text("laser")


def scan(ranges, low: float = 0.1, high: float = 10.0) -> bytes:
    message = Cdr().header().number("f", -1.5, 1.5, 0.1, 0.0, 0.1, low, high)
    return bytes(message.floats(ranges).floats([]).raw)


def distance(metres: float) -> bytes:
    return bytes(Cdr().header().number("B", 1).number("f", 0.2, 0.05, 4.0, metres, 0.0).raw)


class FakeRobot:
    """A router as `rmw_zenohd`, and a node with a laser that listens to /cmd_vel."""

    def __init__(self, port: int) -> None:
        self.at = f"tcp/127.0.0.1:{port}"
        self.router = zenoh.open(config("router", "listen", self.at))
        self.session = zenoh.open(config("peer", "connect", self.at))
        self.ranges = [1.0, 2.0, 3.0, 4.0]
        self.commands: list[tuple[float, ...]] = []
        self.heard: list[tuple[float, str, bytes]] = []
        self.sequence = 0
        self.kept = [
            self.session.declare_subscriber(key("/cmd_vel", "Twist"), self.take),
            self.session.liveliness().declare_token(
                f"@ros2_lv/0/{self.session.info.zid()}/0/1/MP/%/%/robot/%scan/"
                f"sensor_msgs::msg::dds_::LaserScan_/{HASHES['LaserScan']}/::,10:,:,:,,"
            ),
        ]
        self.ended = threading.Event()
        self.thread = threading.Thread(target=self.run)
        self.until("/MP/")
        self.thread.start()

    def take(self, sample) -> None:
        raw = bytes(sample.payload)
        assert raw[:4] == b"\x00\x01\x00\x00" and len(raw) == 52
        self.heard.append((time.monotonic(), str(sample.key_expr), bytes(sample.attachment)))
        self.commands.append(struct.unpack("<6d", raw[4:]))

    def run(self) -> None:
        while not self.ended.wait(0.01):
            if self.ranges is not None:
                self.send("/scan", "LaserScan", scan(self.ranges))

    def send(self, topic: str, type: str, raw: bytes, **changes) -> None:
        self.sequence += 1
        attached = struct.pack("<qqB", self.sequence, time.time_ns(), 16) + GID
        where = changes.get("key", key(topic, type))
        self.session.put(where, raw, attachment=changes.get("attachment", attached))

    def tokens(self) -> list[str]:
        return [str(r.ok.key_expr) for r in self.session.liveliness().get("@ros2_lv/**", timeout=2) if r.ok]

    def until(self, part: str) -> None:
        """Wait until the router knows a token with a part, and thereby all that was declared before it."""
        while not any(
            part in str(r.ok.key_expr)
            for r in self.router.liveliness().get("@ros2_lv/**", timeout=2)
            if r.ok and part in str(r.ok.key_expr)
        ):
            time.sleep(0.01)
        time.sleep(0.05)

    def close(self) -> None:
        self.ended.set()
        self.thread.join()
        self.session.close()
        self.router.close()


def config(mode: str, what: str, at: str) -> zenoh.Config:
    made = zenoh.Config()
    made.insert_json5("mode", f'"{mode}"')
    made.insert_json5("scouting/multicast/enabled", "false")
    made.insert_json5("open/return_conditions/connect_scouted", "false")
    made.insert_json5("listen/endpoints", f'["{at if what == "listen" else "tcp/127.0.0.1:0"}"]')
    made.insert_json5("connect/endpoints", f'["{at}"]' if what == "connect" else "[]")
    return made
