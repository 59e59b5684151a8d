"""The graph of a document is made once."""

from __future__ import annotations

import pickle

import pytest

import deodar as dd
from deodar.errors import ModelError
from deodar.model import document_graph as graphs
from deodar.model.document import Document
from deodar.model.document_graph import graph


def chain() -> dd.Model:
    model = dd.Model("chain")
    model.add(dd.Boost("b", [], 1.0)) >> dd.Gain(2.0) >> model.add(dd.Field("u", []))
    return model


def test_a_document_is_resolved_once_for_its_check_its_program_and_its_runs(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    resolved: list[Document] = []
    resolve = graphs.resolve
    monkeypatch.setattr(graphs, "resolve", lambda doc: (resolved.append(doc), resolve(doc))[1])
    model = chain()
    model.check()
    dd.Session(model).step()
    dd.simulate(model, 1)
    assert len(resolved) == 1


def test_what_follows_from_a_document_does_not_travel_with_it() -> None:
    model = chain()
    doc, size = model.document, len(pickle.dumps(model.document))
    assert graph(doc) is graph(doc)
    dd.Session(model)
    assert len(pickle.dumps(doc)) == size


def test_documents_of_the_past_keep_no_graph() -> None:
    model = chain()
    model.check()
    model.set("b.amplitude", 2.0)
    model.check()
    assert ["_graph" in doc.__dict__ for doc in model.history.documents[-2:]] == [False, True]
    model.history.undo()
    assert not any("_graph" in doc.__dict__ for doc in model.history.documents)


def test_a_graph_with_problems_has_no_order() -> None:
    model = dd.Model("open")
    model.add(dd.Gain(2.0, name="g"))
    assert graph(model.document).problems and not graph(model.document).acts
    with pytest.raises(ModelError, match="its axes are unknown"):
        graph(model.document).required()
