"""Names may be any text; paths address them, and files preserve them."""

from __future__ import annotations

import json

import pytest

import deodar as dd
from deodar.errors import UnknownName
from deodar.model import document_files
from deodar.model.paths import Index, display, readings, split, stored_id

X = dd.Axis("x", 0, 10, samples=11)

STRANGE = [
    "u -> u (global)",
    "a.b",
    "a..b",
    ".",
    "..",
    'say "u"',
    '"',
    "'",
    "ünïcode 场",
    "two words",
    " leading",
    "0",
    "u.tau",
    "kernel.0.sigma",
    "back\\slash",
    "tab\tline\nbreak",
    "output",
    "none",
    "{}",
    "100 %",
    "a/b",
    "-1",
    "class",
]


@pytest.mark.parametrize("name", STRANGE)
def test_split_reverses_quote(name: str) -> None:
    assert split(dd.quote(name)) == (name,)
    assert split(f"{dd.quote('g')}.{dd.quote(name)}.output") == ("g", name, "output")
    assert split(display(("g", name))) == ("g", name)


def test_plain_names_stay_plain() -> None:
    assert dd.quote("u") == "u"
    assert dd.quote("resting_level2") == "resting_level2"
    assert dd.quote("u -> u (global)") == '"u -> u (global)"'


@pytest.mark.parametrize("name", STRANGE)
def test_an_element_of_any_name_is_reached_and_set(name: str) -> None:
    model = dd.Model("m")
    u = model.add(dd.Field(name, [X]))
    safe = dd.quote(name)
    assert model[safe].id == u.id
    assert model[u.path].id == u.id
    assert safe in model and u.path in model
    model.set(f"{safe}.tau", 7)
    assert model.get(f"{u.path}.tau") == 7
    model.connect(f"{safe}.output", f"{u.path}.input")
    assert len(model.document.connections) == 1


@pytest.mark.parametrize("name", STRANGE)
def test_any_name_is_saved_and_loaded(name: str) -> None:
    model = dd.Model(name)
    u = model.add(dd.Field(name, [X], kernel=[dd.Gaussian()]), group="grp")
    v = model.add(dd.Field(f"{name}2", [X]))
    u >> dd.Gain(2) >> v
    model.parameter(f"parameter of {name}", 3.0)
    model.link(f"{u.path}.kernel.0.sigma", f"parameter of {name}")
    reloaded = document_files.from_data(json.loads(model.to_json()), {})
    assert reloaded == model.document


def test_a_name_with_a_dot_needs_no_quotes_if_it_is_unambiguous() -> None:
    model = dd.Model("m")
    model.add(dd.Field("a.b", [X]))
    assert model["a.b"].id == model['"a.b"'].id
    model.set("a.b.tau", 5)
    assert model.get('"a.b".tau') == 5


def test_quotes_select_one_of_two_readings_of_a_path() -> None:
    model = dd.Model("m")
    dotted = model.add(dd.Field("a.b", [X]))
    grouped = model.add(dd.Field("b", [X]), group="a")
    assert (dotted.path, grouped.path) == ('"a.b"', "a.b")
    assert model["a.b"].id == grouped.id, "a path without quotes is groups and a name first"
    assert model['"a.b"'].id == dotted.id
    model.set('"a.b".tau', 5)
    model.set("a.b.tau", 6)
    assert (dotted.element.tau, grouped.element.tau) == (5, 6)
    assert document_files.from_data(json.loads(model.to_json()), {}) == model.document


def test_an_element_named_like_a_parameter_is_found_by_its_path() -> None:
    model = dd.Model("m")
    u = model.add(dd.Field("u", [X]))
    odd = model.add(dd.Field("u.tau", [X]))
    model.set("u.tau", 9)
    model.set(f"{dd.quote('u.tau')}.tau", 11)
    assert (u.element.tau, odd.element.tau) == (9, 11)


@pytest.mark.parametrize("path", ['"open', '"u"x', '"u"x.tau', '"\\q"'])
def test_unbalanced_quotes_are_reported(path: str) -> None:
    model = dd.Model("m")
    model.add(dd.Field("u", [X]))
    with pytest.raises(UnknownName) as caught:
        model.set(path, 1)
    assert repr(path) in str(caught.value)


def test_readings_lists_every_reading_of_a_path() -> None:
    paths = [("a",), ("a", "b"), ("a.b",)]
    assert [names for names, _ in readings("a.b", Index.of(paths))] == [("a", "b"), ("a",), ("a.b",)]
    assert readings("a.tau", Index.of(paths)) == [(("a",), "tau")]
    assert readings("z", Index.of(paths)) == []


def test_ids_come_from_the_path_and_never_collide() -> None:
    assert stored_id("u", []) == stored_id("u", ["00000000"])
    taken: list[str] = []
    for _ in range(5):
        taken.append(stored_id("u", taken))
    assert len(set(taken)) == 5
    assert all(len(i) == 8 and int(i, 16) >= 0 for i in taken)


def test_accents_of_both_forms_of_unicode_are_one_name() -> None:
    for first, second in (("caf\u00e9", "cafe\u0301"), ("cafe\u0301", "caf\u00e9")):
        model = dd.Model("m")
        place = dd.Axis(f"{first} axis", 0, 10, samples=11)
        u = model.add(dd.Field(f"{first} u", [place]))
        assert model[f"{second} u"].id == u.id
        model.set(f"{second} u.tau", 30)
        assert u.element.tau == 30
        with pytest.raises(dd.errors.ModelError, match=r"there is already an element"):
            model.add(dd.Field(f"{second} u", []))
        v = model.add(dd.Field(f"{second}.v", [dd.Axis(f"{second} axis", 0, 10, samples=11)]))
        u >> v
        assert model[f"{first}.v.activation"] is not None and not model.check()
        assert display(model.document.entries[0].names) == f"{first} u", "files keep what was written"


@pytest.mark.parametrize("name", ["R\u2126.r", "k\u2126", "e\u0301\u00e9"])
def test_an_element_is_found_by_its_own_path_however_its_accents_are_written(name: str) -> None:
    model = dd.Model("m")
    model.add(dd.Field(name, [dd.Axis("x", 0, 10, samples=11)]))
    (entry,) = model.document.entries
    model.set(f"{entry.path}.tau", 20.0)
    assert model.document.entries[0].element.tau == 20.0  # type: ignore[attr-defined]
