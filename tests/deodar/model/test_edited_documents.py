"""Documents that were edited in any order: each can be written and read again, to the byte."""

from __future__ import annotations

import json

from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, rule

import deodar as dd
from deodar.errors import DeodarError
from deodar.model import document_files as files

PATHS = st.sampled_from([("x",), ("b",), ("b", "x"), ("c", "b"), ("c", "b", "x"), ("a",)])

EDITS = {
    "add": lambda model, at, new: model.add(dd.Gain(2, name=new[-1]), group=".".join(new[:-1])),
    "connect": lambda model, at, new: model.connect(".".join(at), ".".join(new)),
    "move": lambda model, at, new: model.move(".".join(at), ".".join(new[:-1])),
    "rename": lambda model, at, new: model.rename(".".join(at), new[-1]),
    "remove": lambda model, at, new: model.remove(".".join(at)),
    "ungroup": lambda model, at, new: model.ungroup(".".join(at)),
    "parameter": lambda model, at, new: model.parameter(".".join(new), 1.0),
    "link": lambda model, at, new: model.link(f"{'.'.join(at)}.factor", ".".join(new)),
    "undo": lambda model, at, new: model.undo(),
    "redo": lambda model, at, new: model.redo(),
}


class EditedDocuments(RuleBasedStateMachine):
    """A model with a group within a group and a document parameter, edited."""

    def __init__(self) -> None:
        super().__init__()
        self.model = dd.Model("edited")
        self.model.add(dd.Gain(2, name="x"), group="c.b")
        self.model.parameter("b.x", 1.0)

    @rule(kind=st.sampled_from(sorted(EDITS)), at=PATHS, new=PATHS)
    def edit(self, kind: str, at: tuple[str, ...], new: tuple[str, ...]) -> None:
        before = self.model.document
        try:
            EDITS[kind](self.model, at, new)
        except DeodarError:
            assert self.model.document is before, "a refused edit has no effect"

    @invariant()
    def opens_again(self) -> None:
        text, arrays = files.dumps(self.model.document)
        reopened = files.of_data(json.loads(text), lambda _: arrays)
        assert reopened == self.model.document
        assert files.dumps(reopened) == (text, arrays)


TestEditedDocuments = EditedDocuments.TestCase
TestEditedDocuments.settings = settings(settings(), max_examples=100, stateful_step_count=10)
