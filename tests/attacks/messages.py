"""Hostile messages: each is answered, or ends its own connection; the studio continues for other pages."""

from __future__ import annotations

import asyncio
import dataclasses as dc
import os
import random
from pathlib import Path
from typing import Any

import websockets

import deodar as dd
from deodar_studio.requests.request import MESSAGES, Drawn
from deodar_studio.web.connection import MOST_MALFORMED
from tests.attacks.edits import small
from tests.deodar_studio.page import Page, page, studio

STRANGE: tuple[Any, ...] = (
    None,
    True,
    0,
    -1,
    1,
    7,
    0.5,
    1e308,
    -1e308,
    2**31,
    2**53,
    2**63,
    10**40,
    "",
    "u",
    "a" * 4097,
    "a" * 64,
    "../x",
    "/etc/passwd",
    "x\0y",
    "gone.json",
    "pipe.json",
    "loop.json",
    "m.json",
    "tau",
    "kernel",
    "kernel.0.sigma",
    "resting_level",
    "output",
    "__class__",
    "é\ud83d",
    [],
    {},
    [0, 1e300],
    {"a": 1},
    {"kind": "Gaussian"},
    [{"kind": "Gaussian", "sigma": -1}],
    "Picture",
    "Arena",
    "gain",
    {"panels": None},
    [[[[[]]]]],
)
RAW = (
    "",
    "{",
    "[]",
    "null",
    "7",
    '"text"',
    "[" * 20000,
    '{"type": "set"}',
    '{"type": null}',
    '{"type": "undo", "extra": 1}',
    "\0",
    "x" * 100_000,
)


@dc.dataclass
class Outcome:
    """Numbers of hostile messages by outcome."""

    sent: int = 0
    refused: int = 0
    connections: int = 0
    errors: list[str] = dc.field(default_factory=list[str])


def kinds() -> dict[str, tuple[str, ...]]:
    """Return the fields of every request that a page may send, by tag."""
    types = [kind for kind in MESSAGES.values() if kind is not Drawn]  # it has no answer
    return {str(kind.__struct_config__.tag): kind.__struct_fields__ for kind in types}


def drawn(random: random.Random, known: dict[str, tuple[str, ...]], ids: list[str]) -> dict[str, Any]:
    """Return a random message of a known kind, with values of any type."""
    tag = random.choice(list(known))
    values: dict[str, Any] = {"type": tag}
    for field in known[tag]:
        if field in ("type", "request", "session") or random.random() < 0.1:
            continue
        if field == "element" and random.random() < 0.7:
            values[field] = random.choice(ids)
        elif field in ("parameter", "port", "name", "path") and random.random() < 0.7:
            values[field] = random.choice([v for v in STRANGE if isinstance(v, str)])
        else:
            values[field] = random.choice(STRANGE)
    return values


async def attack(address: str, count: int, seed: int) -> Outcome:
    """Send hostile messages, and reconnect after one that ends the connection; a second page stays
    connected and edits between them.
    """
    random_, outcome, known = random.Random(seed), Outcome(), kinds()
    async with page(address) as other:
        await other.until(lambda: other.document)
        ids = [e["id"] for e in other.document["elements"]]
        while outcome.sent < count:
            outcome.connections += 1
            async with page(address) as visitor:
                await _one_connection(visitor, random_, outcome, known, ids, count)
            await other.do("pause")
        await other.open("open_file", path="m.json", discard=True)
        await other.do("set", element=ids[0], parameter="tau", value=33)
        await other.do("undo")
    return outcome


async def _one_connection(
    one: Page,
    random: random.Random,
    outcome: Outcome,
    known: dict[str, tuple[str, ...]],
    ids: list[str],
    count: int,
) -> None:
    malformed = 0
    while outcome.sent < count and malformed < MOST_MALFORMED - 1:
        outcome.sent += 1
        if random.random() < 0.02:
            malformed += 1
            await one.socket.send(random.choice(RAW))
            continue
        message = drawn(random, known, ids)
        try:
            answer = await one.ask(**message)
        except (websockets.ConnectionClosed, TimeoutError) as error:
            outcome.errors.append(f"{type(error).__name__} after {str(message)[:300]}")
            return
        what = [p["what"] for p in answer["problems"]]
        outcome.refused += bool(what or answer["ask"])
        malformed += any("not understood" in w for w in what)
        if any("error of deodar itself" in w for w in what):
            outcome.errors.append(f"{what[0][:300]} after {str(message)[:300]}")


def run(folder: Path, count: int, seed: int = 0) -> Outcome:
    """Start a studio in a folder that also contains hostile files, and attack it."""
    dd.save(small(), folder / "m.json", force=True)
    (folder / "loop.json").symlink_to(folder / "loop.json")
    os.mkfifo(folder / "pipe.json")
    with studio(folder, folder / "m.json") as address:
        return asyncio.run(attack(address, count, seed))
