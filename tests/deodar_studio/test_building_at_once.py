"""Several pages that build one document at once, and connections that end in the middle of a gesture."""

from __future__ import annotations

import asyncio
import random
from collections.abc import Callable
from pathlib import Path
from typing import Any

from tests.deodar_studio.page import Page, page, studio

EDITS = 30
"""Number of edits of each page."""


def shared(p: Page) -> dict[str, Any]:
    """Return what all pages have of the document."""
    return {key: p.document[key] for key in ("elements", "connections", "groups", "layout", "axes", "undo")}


def drawn(draw: random.Random, p: Page) -> tuple[str, dict[str, Any]]:
    """Return one random edit of the document that a page has; some are refused, because the other page was
    faster.
    """
    ids = [e["id"] for e in p.document["elements"]] or ["00000000"]
    one, other = draw.choice(ids), draw.choice(ids)
    wires = p.document["connections"] or [{"source": one, "target": other}]
    wire = {k: v for k, v in draw.choice(wires).items() if k != "reads"}
    return draw.choice(
        [
            ("add_element", {"kind": "Field", "at": [draw.randint(0, 500), 0]}),
            ("add_element", {"kind": "GaussianStimulus", "target": {"element": one}}),
            ("add_element", {"kind": "Gain", "wire": wire}),
            ("connect", {"source": one, "target": other}),
            ("disconnect", wire),
            ("reconnect", {"old": wire, "new": {"source": one, "target": other}}),
            ("remove", {"elements": [one]}),
            ("rename", {"element": one, "name": f"n{draw.randint(0, 9)}"}),
            ("group", {"elements": [one, other]}),
            ("ungroup", {"group": draw.choice(p.document["groups"] or [["none"]])}),
            ("place", {"positions": {one: [draw.randint(0, 500), draw.randint(0, 500)]}}),
            ("set", {"element": one, "parameter": "amplitude", "value": draw.randint(1, 9)}),
            ("undo", {}),
        ]
    )


def amplitude(p: Page, path: str) -> Any:
    """Return the amplitude of a stimulus."""
    return next(e["values"]["amplitude"] for e in p.document["elements"] if e["path"] == path)


def between(root: Path, scene: Callable[[Page, Page], Any]) -> None:
    """Play a scene of two pages that have the same document open, which runs."""

    async def main(address: str) -> None:
        async with page(address) as a, page(address) as b:
            await a.runs()
            await b.runs()
            await a.do("speed", factor=None)
            await a.do("play")
            await scene(a, b)

    with studio(root, root / "selection.json") as address:
        asyncio.run(main(address))


def test_two_pages_build_one_document_at_once_while_it_runs(root: Path) -> None:
    async def scene(a: Page, b: Page) -> None:
        refused = 0

        async def build(p: Page, seed: int) -> None:
            nonlocal refused
            draw = random.Random(seed)
            for _ in range(EDITS):
                kind, message = drawn(draw, p)
                refused += bool((await p.ask(kind, **message))["problems"])

        await asyncio.gather(build(a, 1), build(b, 2))
        await a.do("add_element", kind="Field", name="last")
        await b.until(lambda: any(e["name"] == "last" for e in b.document["elements"]))
        assert shared(a) == shared(b)
        assert refused < EDITS, "most edits were made"
        for p in (a, b):
            before = p.clocks
            await p.until(lambda p=p, before=before: p.clocks > before)

    between(root, scene)


def test_two_pages_drag_one_element(root: Path) -> None:
    async def scene(a: Page, b: Page) -> None:
        u = a.element("u")
        for k in range(5):
            await asyncio.gather(
                a.do("place", positions={u: [k, 0]}), b.do("place", positions={u: [0, 100 + k]})
            )
        await b.do("rename", element=u, name="dropped")
        await a.until(lambda: any(e["name"] == "dropped" for e in a.document["elements"]))
        assert shared(a) == shared(b)
        assert a.document["layout"]["boxes"][u] in ({"x": 4, "y": 0}, {"x": 0, "y": 104})
        assert a.document["undo"] == 11, "each position is one step"
        await a.do("remove", elements=[u])
        await b.do("place", positions={u: [1, 1]})
        assert u not in b.document["layout"]["boxes"] and b.document["undo"] == 12
        await a.do("undo")
        assert u in [e["id"] for e in a.document["elements"]]

    between(root, scene)


def test_a_connection_that_ends_in_the_middle_of_a_gesture_leaves_its_last_value(root: Path) -> None:
    async def main(address: str) -> None:
        async with page(address) as a:
            await a.runs()
            left = a.element("left")
            async with page(address) as b:
                await b.runs()
                for value in (7, 8, 9):
                    await b.do("set", element=left, parameter="amplitude", value=value, gesture=1)
                await b.send(type="set", request=99, element=left, parameter="amplitude", value=10, gesture=1)
                b.socket.transport.abort()
            await a.until(lambda: amplitude(a, "left") in (9, 10))
            await asyncio.sleep(0.5)  # the message that was on its way has come, or never does
            assert a.document["undo"] == 1
            await a.do("set", element=left, parameter="amplitude", value=5, gesture=1)
            assert a.document["undo"] == 2, "the gesture of another page is another step"
            await a.do("undo")
            assert amplitude(a, "left") in (9, 10)
            await a.do("undo")
            assert amplitude(a, "left") == 6

    with studio(root, root / "selection.json") as address:
        asyncio.run(main(address))
