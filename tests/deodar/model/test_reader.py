"""Reading of a document: all its problems are collected, each with its place."""

from __future__ import annotations

import itertools
import json

import pytest

import deodar as dd
from deodar.errors import DocumentError
from deodar.model import document_files
from deodar.model.reader import MOST_ENTRIES, MOST_LISTED, MOST_PROBLEMS, from_data


@pytest.mark.parametrize("wrong", [MOST_PROBLEMS - 1, MOST_PROBLEMS, MOST_PROBLEMS + 1, 5000])
def test_after_a_hundred_problems_no_further_connection_is_read(wrong: int) -> None:
    rows = [{"source": f"absent{k}", "target": "u"} for k in range(wrong)]
    with pytest.raises(DocumentError) as caught:
        document_files.from_data({"deodar": 1, "elements": {"u": {"kind": "Field"}}, "connections": rows}, {})
    *listed, last = caught.value.problems
    assert len(listed) == min(wrong, MOST_PROBLEMS + 1) - 1
    assert ("were not read" in last.what) == (wrong > MOST_PROBLEMS)
    assert last.where == f"connections.{len(listed)}"


USED = {
    "deodar": 3,
    "elements": {"g.a": {"kind": "Field", "id": "00000001"}},
    "uses": {"g": {"template": "switch", "elements": {"00000001": "g.a"}}},
}


def test_uses_of_a_template_are_read() -> None:
    (use,) = document_files.from_data(USED, {}).uses
    assert (use.group, use.template, use.elements) == (("g",), "switch", (("00000001", "00000001"),))


@pytest.mark.parametrize(
    "use",
    [
        None,
        {},
        {"template": "switch"},
        {"template": "", "elements": {}},
        {"template": 1, "elements": {}},
        {"template": "switch", "elements": ["g.a"]},
        {"template": "switch", "elements": {"00000001": 1}},
        {"template": "switch", "elements": {"00000001": "g.a"}, "color": "red"},
    ],
)
def test_a_use_with_other_content_is_refused(use: object) -> None:
    with pytest.raises(DocumentError, match=r"uses.g: needs a template .* and nothing else"):
        document_files.from_data({**USED, "uses": {"g": use}}, {})


@pytest.mark.parametrize(
    "parameter",
    [
        None,
        {},
        {"value": True},
        {"value": "1"},
        {"value": 1, "links": "g.a.tau"},
        {"value": 1, "links": [1]},
        {"value": 1, "unit": "ms"},
    ],
)
def test_a_document_parameter_with_other_content_is_refused(parameter: object) -> None:
    with pytest.raises(DocumentError, match=r"parameters.tempo: needs a value \(a number\) and links"):
        document_files.from_data({**USED, "parameters": {"tempo": parameter}}, {})


@pytest.mark.parametrize("version", [1, 2, 3])
@pytest.mark.parametrize("body", [5, None, [], "u"])
def test_an_element_that_is_no_object_is_refused(version: int, body: object) -> None:
    with pytest.raises(DocumentError, match=r"elements\.u|u: "):
        document_files.from_data({"deodar": version, "elements": {"u": body}}, {})


@pytest.mark.parametrize("key", sorted(MOST_ENTRIES))
def test_more_entries_than_are_read_are_refused_before_one_of_them_is(key: str) -> None:
    most = MOST_ENTRIES[key]
    rows = [0] * (most + 1) if key in ("connections", "groups") else dict.fromkeys(map(str, range(most + 1)))
    with pytest.raises(DocumentError, match=f"holds {most + 1:,} {key}; at most {most:,} are read"):
        document_files.from_data({"deodar": 3, "elements": {}, key: rows}, {})


@pytest.mark.parametrize(
    "content",
    [
        {"elements": dict.fromkeys(map(str, range(2 * MOST_LISTED)))},
        {"axes": dict.fromkeys(map(str, range(2 * MOST_LISTED)))},
        {"parameters": {"a": {"value": 1, "links": list(map(str, range(2 * MOST_LISTED)))}}},
        {"groups": [0] * (2 * MOST_LISTED)},
    ],
)
def test_a_thousand_problems_are_listed(content: dict[str, object]) -> None:
    with pytest.raises(DocumentError) as caught:
        document_files.from_data({"deodar": 3, "elements": {}, **content}, {})
    assert len(caught.value.problems) == MOST_LISTED + 1
    assert caught.value.problems[-1].what.startswith("has more than 1,000 problems")


def test_an_element_has_no_more_axes_than_an_array() -> None:
    model = dd.Model("m")
    model.add(dd.Field("u", [dd.Axis("x", 0, 1, samples=2)]))
    document = json.loads(model.to_json())
    document["elements"]["u"]["axes"] *= 65
    with pytest.raises(DocumentError, match=r"u\.axes: 65 axes, more than 64"):
        from_data(document, {})


@pytest.mark.parametrize("size", [20, 40])
def test_a_spare_axis_is_compared_once_with_each_element(size: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """An edit of a part of a document must not walk all of its elements: this would be quadratic."""
    counts: list[int] = []
    axis_hash = dd.Axis.__hash__

    def counted_hash(axis: dd.Axis) -> int:
        counts[-1] += 1
        return axis_hash(axis)

    def build(spare: bool) -> dd.Model:
        model = dd.Model("m")
        if spare:
            model.add_axis(dd.Axis("y", 0, 1, samples=3))
        fields = [model.add(dd.Field(f"u{k}", [dd.Axis("x", 0, 1, samples=2)])) for k in range(size)]
        for before, after in itertools.pairwise(fields):
            model.connect(before, after)
            model.connect(after, before)
        return model

    monkeypatch.setattr(dd.Axis, "__hash__", counted_hash)
    for spare in (False, True):
        counts.append(0)
        text = build(spare).to_json()
        assert len(document_files.loads(text.encode(), lambda name: None).spare_axes) == spare
    assert counts[1] - counts[0] < 12 * size
