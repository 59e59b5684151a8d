"""Random edits, undone and redone: a document has the bytes that it had, and patches give it to a page.

The walk makes edits of every kind on one history. The text of every document is stored when it is made; after
each undo and redo the document of that moment is written again, and compared.
"""

from __future__ import annotations

import dataclasses as dc
import json
import random
from collections.abc import Callable
from typing import Any

import msgspec

import deodar as dd
from deodar.errors import DeodarError
from deodar.model import building, clipboard, edit, files, script
from deodar.model.building import Around
from deodar.model.document import Document, Entry
from deodar.server import converted, view
from deodar.server.converted import Status
from tests.server.page import patched

MOST_ELEMENTS = 30
"""Number of elements from which the walk adds no more."""

SCRIPTED = 20
"""Number of steps after which a document is also made again by its script."""

Draw = random.Random
X, Y = dd.Axis("x", 0, 10, samples=11), dd.Axis("y", 0, 1, samples=5)


@dc.dataclass
class Outcome:
    """Numbers of edits and steps by outcome."""

    edits: dict[str, int] = dc.field(default_factory=dict[str, int])
    refused: int = 0
    steps: int = 0
    errors: list[str] = dc.field(default_factory=list[str])


def _entry(draw: Draw, doc: Document) -> Entry:
    if not doc.entries:
        raise dd.errors.ModelError("empty")
    return draw.choice(doc.entries)


def _wire(draw: Draw, doc: Document) -> tuple[str, str, str, str]:
    if not doc.connections:
        raise dd.errors.ModelError("no connections")
    return draw.choice(doc.connections).ends


def _group(draw: Draw, doc: Document) -> tuple[str, ...]:
    if not doc.groups:
        raise dd.errors.ModelError("no groups")
    return draw.choice(doc.groups)


def _some(draw: Draw, doc: Document) -> list[str]:
    return [e.id for e in draw.sample(doc.entries, min(len(doc.entries), draw.randint(1, 3)))]


def _added(draw: Draw, doc: Document, kind: str, **more: Any) -> Document:
    if len(doc.entries) >= MOST_ELEMENTS:
        raise dd.errors.ModelError("full")
    return building.add(doc, kind, {}, draw.choice(("", "u", "v")), at=(draw.randint(0, 99), 5.0), **more)[0]


def _at_an_end(wire: tuple[str, str, str, str]) -> Around:
    return Around(source=wire[:2], replaces=wire)


EDITS: dict[str, Callable[[Draw, Document], Document]] = {
    "add a field": lambda r, d: _added(r, d, "Field"),
    "add a stimulus": lambda r, d: _added(r, d, "GaussianStimulus"),
    "add in a group": lambda r, d: _added(r, d, "Field", group=_group(r, d)),
    "add after": lambda r, d: _added(r, d, "Gain", around=Around(source=(_entry(r, d).id, ""))),
    "add before": lambda r, d: _added(r, d, "Noise", around=Around(target=(_entry(r, d).id, ""))),
    "add on a wire": lambda r, d: _added(r, d, "Sigmoid", around=Around(wire=_wire(r, d))),
    "add with an array": lambda r, d: _added(r, d, "Weights"),
    "add at an end": lambda r, d: _added(r, d, "Field", around=_at_an_end(_wire(r, d))),
    "insert": lambda r, d: building.insert_element(d, _entry(r, d).id, _wire(r, d)),
    "connect": lambda r, d: building.connect(d, (_entry(r, d).id, "", _entry(r, d).id, "")),
    "connect delayed": lambda r, d: building.connect(
        d, (_entry(r, d).id, "", _entry(r, d).id, ""), "delayed"
    ),
    "disconnect": lambda r, d: building.disconnect(d, [_wire(r, d)]),
    "reconnect": lambda r, d: building.reconnect(d, w := _wire(r, d), (*w[:2], _entry(r, d).id, "")),
    "remove": lambda r, d: building.remove(d, [_entry(r, d).id]),
    "remove several": lambda r, d: building.remove(d, _some(r, d)),
    "remove a group": lambda r, d: building.remove(d, [], [_group(r, d)]),
    "remove a wire": lambda r, d: building.remove(d, [], [], [_wire(r, d)]),
    "rename": lambda r, d: building.rename(d, _entry(r, d).id, f"n{r.randint(0, 99)}"),
    "rename a group": lambda r, d: building.rename_group(d, _group(r, d), f"g{r.randint(0, 99)}"),
    "group": lambda r, d: building.group(d, _some(r, d), [], at=(0.0, 0.0))[0],
    "ungroup": lambda r, d: building.ungroup(d, _group(r, d)),
    "move into": lambda r, d: building.move_into(d, _some(r, d), [], _group(r, d)),
    "move out": lambda r, d: building.move_into(d, _some(r, d), [], ()),
    "paste": lambda r, d: building.paste(d, _copied(r, d), at=(3.0, 4.0))[0],
    "paste in a group": lambda r, d: building.paste(d, _copied(r, d), ("pasted",))[0],
    "set": lambda r, d: edit.put(d, _named(r, d, "tau").id, "tau", r.uniform(5, 50)),
    "set axes": lambda r, d: edit.put(d, _named(r, d, "axes").id, "axes", [r.choice((X, Y))]),
    "change an axis": lambda r, d: edit.replace_axis(d, *r.sample((X, Y, dd.Axis("x", 0, 9, samples=10)), 2)),
    "step of an element": lambda r, d: edit.every(d, _entry(r, d).id, r.randint(1, 3)),
    "document parameter": lambda r, d: edit.document_parameter(d, r.choice("abc"), r.uniform(5, 50)),
    "link": lambda r, d: edit.link(d, _named(r, d, "tau").id, "tau", r.choice("abc")),
    "unlink": lambda r, d: edit.unlink(d, _named(r, d, "tau").id, "tau"),
    "remove a parameter": lambda r, d: edit.remove_document_parameter(d, r.choice("abc")),
    "describe": lambda r, d: edit.describe(d, notes=str(r.random()), dt=r.choice((None, 0.5, 1.0))),
    "place": lambda r, d: building.placed(d, {i: (r.random(), 1.0) for i in _some(r, d)}),
    "comment": lambda r, d: building.comment(d, "", {"text": str(r.random()), "x": 1, "y": 2})[0],
}
"""Edits by name; an edit that does not apply raises an error of deodar."""


def _copied(draw: Draw, doc: Document) -> Document:
    if len(doc.entries) >= MOST_ELEMENTS:
        raise dd.errors.ModelError("full")
    return clipboard.read(clipboard.text(building.excerpt(doc, _some(draw, doc))))


def _named(draw: Draw, doc: Document, parameter: str) -> Entry:
    found = [e for e in doc.entries if hasattr(e.element, parameter)]
    if not found:
        raise dd.errors.ModelError("none")
    return draw.choice(found)


def written(doc: Document) -> tuple[str, bytes | None]:
    """Return the bytes of a document's files."""
    return files.dumps(doc, "walk")


def whole(doc: Document) -> Any:
    """Return a document as a page has it, with problems of its structure: the warnings follow later."""
    made = converted.convert(doc)
    shown = view.document(doc, "", False, 0, 0, made)
    shown = msgspec.structs.replace(shown, problems=view.problems(made.problems, doc))
    return json.loads(msgspec.json.encode(shown))


def _scripted(doc: Document) -> Document:
    """Return the document that the script of a document makes."""
    space: dict[str, Any] = {"__name__": "script"}
    exec(script.script(doc), space)
    return space["make"]().document


def attack(steps: int, seed: int) -> Outcome:
    """Make, undo and redo edits at random."""
    draw, outcome = random.Random(seed), Outcome()
    history = edit.UndoHistory(Document("walk"))
    texts = [written(history.document)]
    page, shown = whole(history.document), converted.convert(history.document)
    for _ in range(steps):
        choice = draw.random()
        if choice < 0.28:
            history.undo()
        elif choice < 0.46:
            history.redo()
        elif choice < 0.5:
            steps_of = history.depth, history.ahead
            folded = draw.choice(([], ["a"], ["a", "b"], None))
            edit.arrange_everywhere(history, {"folded": folded, "panels": {"k": draw.random()}})
            if (history.depth, history.ahead) != steps_of:
                outcome.errors.append(f"step {outcome.steps}: a layout without undo changed the history")
            texts = [written(doc) for doc in (*history.documents[: history.depth + 1],)]
            texts += [written(doc) for doc in reversed(history.documents[history.depth + 1 :])]
            outcome.edits["fold"] = outcome.edits.get("fold", 0) + 1
        elif choice < 0.56 and history.depth:  # one more edit of a drag
            new = edit.describe(history.document, notes=str(draw.random()))
            history.amend(new)
            texts[history.depth :] = [written(new)]
            outcome.edits["amend"] = outcome.edits.get("amend", 0) + 1
        else:
            name = draw.choice(list(EDITS))
            try:
                new = EDITS[name](draw, history.document)
            except DeodarError:
                outcome.refused += 1
                continue
            if new is not history.document:
                history.commit(new)
                outcome.edits[name] = outcome.edits.get(name, 0) + 1
                texts[history.depth :] = [written(new)]
        outcome.steps += 1
        doc = history.document
        if written(doc) != texts[history.depth]:
            outcome.errors.append(f"step {outcome.steps}: the document after undo or redo has other bytes")
        if outcome.steps % SCRIPTED == 0 and written(_scripted(doc)) != written(doc):
            outcome.errors.append(f"step {outcome.steps}: the script makes another document")
        after = converted.convert(doc, shown)
        status = Status(1, False, 0, 0, "live")
        found = converted.patch(
            shown, after, status, lambda after=after, doc=doc: view.problems(after.problems, doc)
        )
        page = whole(doc) if found is None else patched(page, json.loads(msgspec.json.encode(found)))
        if page != whole(doc):
            outcome.errors.append(f"step {outcome.steps}: the patched document differs")
        shown = after
    return outcome
