"""Document parameters: one value for several parameters."""

from __future__ import annotations

import json

import pytest

import deodar as dd
from deodar.errors import ModelError, ParameterError, UnknownName
from deodar.model import document_files, edit, find

X = dd.Axis("x", 0, 10, samples=11)


@pytest.fixture
def model() -> dd.Model:
    """Return two fields whose time constants, and a kernel width, are linked to one document parameter."""
    model = dd.Model("m")
    model.add(dd.Field("u", [X], kernel=[dd.Gaussian(sigma=2)]))
    model.add(dd.Field("v", [X]))
    model.parameter("gain", 3.0)
    for path in ("u.tau", "v.tau", "u.kernel.0.sigma"):
        model.link(path, "gain")
    return model


def test_linking_sets_the_value_of_the_document_parameter(model: dd.Model) -> None:
    assert [model.get(p) for p in ("gain", "u.tau", "v.tau", "u.kernel.0.sigma")] == [3.0, 3.0, 3.0, 3.0]


def test_a_document_parameter_sets_all_its_links(model: dd.Model) -> None:
    model.set("gain", 4)
    assert [model.get(p) for p in ("gain", "u.tau", "v.tau", "u.kernel.0.sigma")] == [4.0, 4.0, 4.0, 4.0]
    model.parameter("gain", 5)
    assert model.get("v.tau") == 5.0


@pytest.mark.parametrize("path", ["u.tau", "u.kernel.0.sigma", "u.kernel.0", "u.kernel"])
def test_a_linked_parameter_is_not_set_directly(model: dd.Model, path: str) -> None:
    before = model.document
    with pytest.raises(ParameterError) as caught:
        model.set(path, 9 if path.endswith(("tau", "sigma")) else [dd.Gaussian()])
    assert "driven by the document parameter 'gain'" in str(caught.value)
    assert "Set 'gain' instead, or unlink" in str(caught.value)
    assert model.document is before


def test_a_value_that_one_parameter_refuses_changes_none(model: dd.Model) -> None:
    before = model.document
    with pytest.raises(ParameterError, match="below its lower bound"):
        model.set("gain", 0)
    assert model.document is before


def test_unlinked_parameters_keep_their_value_and_are_independent(model: dd.Model) -> None:
    model.unlink("v.tau")
    model.set("gain", 8)
    assert (model.get("u.tau"), model.get("v.tau")) == (8.0, 3.0)
    model.set("v.tau", 2)
    assert model.get("v.tau") == 2.0


def test_links_follow_rename_and_move(model: dd.Model) -> None:
    model.rename("u", "w")
    model.move("w", "deep.inside")
    model.set("gain", 6)
    assert model.get("deep.inside.w.tau") == 6.0
    reloaded = document_files.from_data(json.loads(model.to_json()), {})
    assert reloaded == model.document


@pytest.mark.parametrize(
    ("call", "error", "says"),
    [
        (lambda m: m.link("u.tau", "gain"), ModelError, "already linked to 'gain'"),
        (lambda m: m.link("u.resting_level", "gian"), UnknownName, "Did you mean 'gain'"),
        (lambda m: m.link("u.sigmoid", "gain"), ParameterError, "not a number that can change"),
        (lambda m: m.link("u.axes", "gain"), ParameterError, "not a number that can change"),
        (lambda m: m.link("gain", "gain"), UnknownName, "itself a document parameter"),
        (lambda m: m.link("u.tua", "gain"), UnknownName, "Did you mean 'tau'"),
        (lambda m: m.parameter("", 1.0), ModelError, "needs a name"),
        (lambda m: m.parameter(5, 1.0), ModelError, "needs a name"),
        (lambda m: m.parameter("u", 1.0), ModelError, "an element has this name"),
        (lambda m: m.parameter("u.resting_level", 1.0), ModelError, "a parameter of u has this name"),
        (lambda m: m.add(dd.Field("gain", [X])), ModelError, "a document parameter is called 'gain'"),
        (lambda m: m.parameter("k", float("nan")), ParameterError, "finite number"),
        (lambda m: m.parameter("k", "3"), ParameterError, "finite number"),
        (lambda m: m.parameter("k", True), ParameterError, "finite number"),
        (lambda m: m.parameter("k", [1]), ParameterError, "finite number"),
        (lambda m: m.parameter("k", 10**400), ParameterError, "finite number"),
    ],
)
def test_invalid_document_parameters_are_refused(
    model: dd.Model, call: object, error: type[Exception], says: str
) -> None:
    before = model.document
    with pytest.raises(error) as caught:
        call(model)  # type: ignore[operator]
    assert says in str(caught.value)
    assert model.document is before


def test_a_missing_document_parameter_is_an_error_that_states_how_to_create_it() -> None:
    model = dd.Model("m")
    model.add(dd.Field("u", [X]))
    with pytest.raises(UnknownName, match=r"model.parameter\(name, value\)"):
        model.link("u.tau", "gain")


@pytest.mark.parametrize("change", ["link", "put", "number", "move", "every"])
def test_an_edit_of_a_removed_element_is_an_error(model: dd.Model, change: str) -> None:
    doc, gone = model.document, model["u"].id
    model.remove("u")
    with pytest.raises(UnknownName, match="removed"):
        match change:
            case "link":
                edit.link(model.document, gone, "tau", "gain")
            case "put":
                edit.put(model.document, gone, "tau", 3.0)
            case "number":
                find.number(model.document, gone, "tau")
            case "move":
                edit.move(model.document, gone, ("w",))
            case _:
                edit.every(model.document, gone, 2)
    assert find.number(doc, gone, "tau") == 3


@pytest.mark.parametrize("leaf", ["kernel", "kernel.0", "kernel.7.sigma", "axes", "nonsense", "tau.0", ""])
def test_only_a_number_can_become_a_document_parameter(model: dd.Model, leaf: str) -> None:
    with pytest.raises(ParameterError, match="cannot be linked"):
        find.number(model.document, model["u"].id, leaf)


@pytest.mark.parametrize("place", ["add", "rename", "group"])
def test_no_element_is_placed_where_its_parameter_has_the_name_of_a_document_parameter(place: str) -> None:
    model = dd.Model("m")
    model.parameter("u.tau" if place != "group" else "g.u.tau", 5.0)
    second = model.add(dd.Field("w", [X]))
    before = model.document
    with pytest.raises(ModelError, match=r"a document parameter is called '(g\.)?u\.tau', like a parameter"):
        match place:
            case "add":
                model.add(dd.Field("u", [X]))
            case "rename":
                edit.move(before, second.id, ("u",))
            case _:
                edit.move(before, second.id, ("g", "u"))
    assert model.document == before


def test_a_document_parameter_may_have_a_dotted_name_that_is_no_parameter_of_the_element() -> None:
    model = dd.Model("m")
    model.parameter("u.speed", 5.0)
    model.parameter("uu.tau", 6.0)
    model.add(dd.Field("u", [X]))
    assert (model.get("u.speed"), model.get("uu.tau"), model["u"].tau) == (5.0, 6.0, 20.0)
