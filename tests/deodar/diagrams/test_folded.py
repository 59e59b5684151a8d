"""Groups drawn as one box each."""

from __future__ import annotations

from pathlib import Path

import pytest

import deodar as dd
from deodar.diagrams.graph import Graph, Item, Wire, fold
from deodar.errors import ModelError

EXAMPLES = Path(__file__).parents[3] / "examples"
ITEMS = (
    Item("a", "field", "a"),
    Item("b", "node", "b", group=("g",)),
    Item("c", "node", "c", group=("g", "h")),
    Item("d", "node", "d", group=("k",)),
)
GROUPS = {("g",): "", ("g", "h"): "", ("k",): "a template"}


def graph(*wires: Wire) -> Graph:
    return Graph("g", ITEMS, wires, GROUPS, {box.id: (0.0, 0.0) for box in ITEMS})


def test_every_group_is_one_box_and_connections_end_at_it() -> None:
    folded = fold(graph(Wire("a", "b", "out", "gate", "-", ("× −2",)), Wire("b", "c"), Wire("c", "d")), 0)
    assert [(i.form, i.name, i.kind) for i in folded.items] == [
        ("field", "a", ""),
        ("group", "g", "2 elements"),
        ("group", "k", "linked to a template"),
    ]
    a, g, k = (i.id for i in folded.items)
    assert folded.wires == (Wire(a, g, "out", "", "-", ("× −2",)), Wire(g, k)), (
        "the connection inside is left out"
    )
    assert not folded.groups and not folded.places


def test_groups_down_to_the_depth_stay_open() -> None:
    folded = fold(graph(Wire("a", "b"), Wire("b", "c"), Wire("c", "d")), 1)
    assert [(i.form, i.name, i.group) for i in folded.items] == [
        ("field", "a", ()),
        ("node", "b", ("g",)),
        ("group", "h", ("g",)),
        ("node", "d", ("k",)),
    ]
    assert len(folded.wires) == 3 and folded.groups == {("g",): "", ("k",): "a template"}
    whole = graph(Wire("a", "b"))
    assert fold(whole, 2) is whole


@pytest.mark.parametrize(("signs", "sign"), [("++", "+"), ("--", "-"), ("+-", "±"), ("±+", "±")])
def test_several_connections_become_one_with_their_signs(signs: str, sign: str) -> None:
    [wire] = fold(
        graph(Wire("a", "b", "out", sign=signs[0], delayed=True), Wire("a", "c", "out", sign=signs[1])), 0
    ).wires  # type: ignore[arg-type]
    assert (wire.sign, wire.captions, wire.source_port, wire.delayed) == (
        sign,
        ("2 connections",),
        "out",
        False,
    )


def test_folding_makes_a_wide_architecture_narrow() -> None:
    model = dd.load(EXAMPLES / "spa.json")
    whole, folded = dd.draw(model), dd.draw(model, depth=0)
    assert folded.size[0] < whole.size[0] / 3
    assert "8 elements" in folded.svg and "satisfaction" not in folded.svg
    with pytest.raises(ModelError, match="got -1"):
        dd.draw(model, depth=-1)
