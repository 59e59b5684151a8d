"""Pages that edit one document at once: the result must equal the accepted edits, one after the other.

Each page draws random edits and sends several of them without waiting. Every answer names the version of the
document that holds the edit; the accepted edits in the order of their versions are made again on a `History`
of this process, without the server and its lock.
"""

from __future__ import annotations

import asyncio
import contextlib
import dataclasses as dc
import json
import random
from collections.abc import Callable
from pathlib import Path
from typing import Any

import msgspec
import pytest

import deodar as dd
from deodar.elements.stimuli import Boost
from deodar.errors import DeodarError
from deodar.importers import presets
from deodar.leaves import get
from deodar.model import document_files, edit, plain_values
from deodar.model.document import Document
from deodar_studio.views import view
from tests.deodar_studio.page import Page, page, studio

PARAMETERS = ("gain", "tempo", "level")
LEAVES = (
    ("u", "tau"),
    ("u", "resting_level"),
    ("v", "tau"),
    ("v", "resting_level"),
    ("g", "factor"),
    ("s", "amplitude"),
)
WEIGHTS = {
    "set": 40,
    "set_document_parameter": 10,
    "add_document_parameter": 5,
    "link": 5,
    "unlink": 4,
    "remove_document_parameter": 3,
    "describe": 4,
    "arrange": 8,
    "preset": 2,
    "shape": 2,
    "undo": 12,
    "redo": 7,
}
AT_ONCE = 4
"""Requests that a page sends before it reads the first answer."""


@dc.dataclass
class Outcome:
    """Numbers of edits of all pages by outcome."""

    accepted: int
    refused: int
    versions: int
    errors: list[str]
    differ: list[str]


class Editor(Page):
    """A page that knows the version of its document and of the problems in it."""

    version = -1
    checked = -1

    async def _take(self, m: dict[str, Any]) -> None:
        await super()._take(m)
        if m["type"] == "opened":
            self.version = self.checked = m["version"]
        elif m["type"] == "edited":
            self.version = m["version"]
        elif m["type"] == "checked":
            self.checked = m["version"]
            self.document["problems"] = m["problems"]


def small() -> dd.Model:
    """Return a model whose programs compile fast."""
    model = dd.Model("edits")
    u = model.add(dd.Field("u", [], tau=20, resting_level=-5))
    v = model.add(dd.Field("v", [], tau=20, resting_level=-5))
    u >> model.add(dd.Gain(1, name="g")) >> v
    model.add(Boost("s", amplitude=1)) >> u
    return model


def drawn(random: random.Random, ids: dict[str, str], preset: str) -> dict[str, Any]:
    """Return one random edit."""
    path, leaf = random.choice(LEAVES)
    place = {"element": ids[path], "parameter": leaf}
    number = round(random.uniform(5, 90), 3)
    match random.choices(tuple(WEIGHTS), tuple(WEIGHTS.values()))[0]:
        case "set":
            return {"type": "set", **place, "value": number, "gesture": random.choice((0, 0, 1, 2))}
        case "set_document_parameter":
            return {"type": "set", "element": "", "parameter": random.choice(PARAMETERS), "value": number}
        case "add_document_parameter":
            return {"type": "add_document_parameter", "name": random.choice(PARAMETERS), **place}
        case "link":
            return {"type": "link", "name": random.choice(PARAMETERS), **place}
        case "unlink":
            return {"type": "unlink", **place}
        case "remove_document_parameter":
            return {"type": "remove_document_parameter", "name": random.choice(PARAMETERS)}
        case "describe":
            return {"type": "describe", random.choice(("name", "notes")): f"text {number}"}
        case "arrange":
            return {
                "type": "arrange",
                "layout": {random.choice("abc"): random.choice((number, None))},
                "undoable": random.random() < 0.5,
            }
        case "shape":  # another structure: compiled beside the run
            kind = random.choice(("Logistic", "Absolute", "Linear"))
            return {"type": "set", "element": ids["u"], "parameter": "sigmoid", "value": {"kind": kind}}
        case "preset":
            return {"type": "apply_preset_text", "name": "preset.json", "text": preset}
        case other:
            return {"type": other}


@dc.dataclass(frozen=True)
class State:
    """A document with its history, as plain data: chains of documents before it and after it."""

    document: Document
    past: Any = None
    future: Any = None
    gesture: object = None

    def commit(self, new: Document, gesture: object = None) -> State:
        """Add a new document."""
        return State(new, (self.document, self.past), None, gesture)

    def amend(self, new: Document, gesture: object = None) -> State:
        """Replace the present document by a new one, or return to the one before if they are equal."""
        if self.past is not None and new == self.past[0]:
            return State(self.past[0], self.past[1])
        return State(new, self.past, None, gesture)

    def each(self, how: Callable[[Document], Document]) -> State:
        """Change all documents."""

        def changed(chain: Any) -> Any:
            documents: list[Document] = []
            while chain is not None:
                documents.append(chain[0])
                chain = chain[1]
            for doc in reversed(documents):
                chain = (how(doc), chain)
            return chain

        return State(how(self.document), changed(self.past), changed(self.future), self.gesture)


def _arranged(doc: Document, m: dict[str, Any]) -> Document:
    return edit.arrange(doc, {k: v for k, v in {**doc.layout, **m["layout"]}.items() if v is not None})


def again(state: State, page: int, m: dict[str, Any]) -> State:
    """Return the state after an accepted edit; the same object if it changes nothing."""
    doc = state.document
    match m["type"]:
        case "undo":
            return state if state.past is None else State(state.past[0], state.past[1], (doc, state.future))
        case "redo":
            return (
                state if state.future is None else State(state.future[0], (doc, state.past), state.future[1])
            )
        case "arrange":
            return state.commit(_arranged(doc, m)) if m["undoable"] else state.each(lambda d: _arranged(d, m))
        case _:
            new = _other(doc, m)
            mine = (page, m["gesture"]) if m.get("gesture") else None
            if new == doc:
                return state
            return (
                state.amend(new, mine)
                if mine is not None and mine == state.gesture
                else state.commit(new, mine)
            )


def _other(doc: Document, m: dict[str, Any]) -> Document:
    match m["type"]:
        case "set" if m["element"]:
            return plain_values.put(doc, [m["element"]], m["parameter"], m["value"])
        case "set":
            return edit.document_parameter(doc, m["parameter"], m["value"])
        case "add_document_parameter":
            value = float(get(doc.by_id()[m["element"]].element, m["parameter"]))
            return edit.link(
                edit.document_parameter(doc, m["name"], value), m["element"], m["parameter"], m["name"]
            )
        case "link":
            return edit.link(doc, m["element"], m["parameter"], m["name"])
        case "unlink":
            return edit.unlink(doc, m["element"], m["parameter"])
        case "remove_document_parameter":
            return edit.remove_document_parameter(doc, m["name"])
        case "describe":
            return edit.describe(doc, **{key: m[key] for key in ("name", "notes") if key in m})
        case _:
            return presets.applied(doc, document_files.from_data(json.loads(m["text"]), {}))[0]


async def attack(address: str, pages: int, edits: int, seed: int) -> Outcome:
    """Let pages edit the document of a studio at once, and compare the end with the edits one after the
    other.
    """
    async with contextlib.AsyncExitStack() as stack:
        editors = [await stack.enter_async_context(page(address, kind=Editor)) for _ in range(pages)]
        for visitor in editors:  # the first edits are made while the document is compiled
            await visitor.until(lambda visitor=visitor: visitor.said.get("opened", {}).get("document"))
        ids = {e["path"]: e["id"] for e in editors[0].document["elements"]}
        preset = small()
        preset.set({"u.tau": 33.0, "g.factor": 7.0})
        text = preset.to_json()
        logs = await asyncio.gather(
            *(
                _edit(visitor, random.Random(f"{seed} {k}"), edits // pages, ids, text)
                for k, visitor in enumerate(editors)
            )
        )
        done = [(k, m, answer) for k, log in enumerate(logs) for m, answer in log]
        last = max(answer["version"] for _, _, answer in done)
        for visitor in editors:
            await visitor.until(lambda visitor=visitor: visitor.version >= last and visitor.checked >= last)
        shown = await _running(editors[0], ids["s"])
        outcome = _outcome(done, [visitor.document for visitor in editors], last)
        expected = next(e for e in editors[0].document["elements"] if e["path"] == "s")["values"]["amplitude"]
        return (
            outcome
            if shown == pytest.approx(expected, rel=1e-6)
            else dc.replace(outcome, differ=[*outcome.differ, f"s runs at {shown}, not at {expected}"])
        )


async def _running(p: Page, stimulus: str) -> float:
    """Return the output of a stimulus in the running program."""
    await p.runs()
    await p.do("watch", stream=1, element=stimulus, port="output")
    await p.do("step", n=1)
    await p.until(lambda: 1 in p.frames and p.frames[1][0] == p.clock["time"] > 0)
    return float(p.frames[1][1])


async def _edit(
    p: Page, random: random.Random, n: int, ids: dict[str, str], preset: str
) -> list[tuple[dict[str, Any], dict[str, Any]]]:
    """Send edits, a few at once, in the order in which they are drawn."""
    log: list[tuple[dict[str, Any], dict[str, Any]]] = []
    while len(log) < n:
        expected = [drawn(random, ids, preset) for _ in range(min(AT_ONCE, n - len(log)))]
        log += zip(expected, await asyncio.gather(*(p.ask(**m) for m in expected)), strict=True)
    return log


def _outcome(
    done: list[tuple[int, dict[str, Any], dict[str, Any]]], documents: list[dict[str, Any]], last: int
) -> Outcome:
    problems = [p["what"] for _, _, answer in done for p in answer["problems"]]
    versions: dict[int, list[tuple[int, dict[str, Any]]]] = {}
    for k, m, answer in done:
        if not answer["problems"]:
            versions.setdefault(answer["version"], []).append((k, m))
    state, differ = State(small().document), []
    for version in sorted(versions):
        after = _one_version(state, versions[version])
        if after is None:
            differ.append(f"no order of {versions[version]} gives one version ({version})")
            break
        state = after
    differ += [f"page {k} differs from page 0" for k, seen in enumerate(documents) if seen != documents[0]]
    undo, redo = _length(state.past), _length(state.future)
    expected = json.loads(
        msgspec.json.encode(view.document(state.document, "edits.json", documents[0]["unsaved"], undo, redo))
    )
    differ += [
        f"{key} is {documents[0][key]!r}, and one after the other {expected[key]!r}"
        for key in expected
        if documents[0][key] != expected[key]
    ]
    accepted = sum(map(len, versions.values()))
    return Outcome(
        accepted,
        len(done) - accepted,
        last,
        [what for what in problems if "error of deodar itself" in what],
        differ,
    )


def _one_version(state: State, edits: list[tuple[int, dict[str, Any]]]) -> State | None:
    """Return the state after the edits of one version, of which the first alone changes something; None if
    that is impossible.
    """
    for k, m in edits:
        try:
            after = again(state, k, m)
            if all(again(after, *other) is after for other in edits if other[1] is not m):
                return after
        except DeodarError:
            continue
    return None


def _length(chain: Any) -> int:
    n = 0
    while chain is not None:
        n, chain = n + 1, chain[1]
    return n


def run(folder: Path, pages: int = 8, edits: int = 10_000, seed: int = 0) -> Outcome:
    """Start a studio with a small document in a folder, and attack it."""
    dd.save(small(), folder / "edits.json", force=True)
    with studio(folder, folder / "edits.json") as address:
        return asyncio.run(attack(address, pages, edits, seed))
