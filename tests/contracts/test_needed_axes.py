"""No element invents an axis: missing axes are an error or a problem."""

from __future__ import annotations

import json

import numpy as np
import pytest

import deodar as dd
from deodar.declarations import Needed
from deodar.elements.memories import History
from deodar.elements.stimuli import Pattern
from deodar.errors import DocumentError, ParameterError
from deodar.model import document_files
from deodar.model.document import VERSION
from deodar.model.migrations import DEFAULTS_OF_1
from deodar.numerics.axes import Axis
from deodar.parameters import parameters
from tests.contracts.build import KINDS

AXES = {
    (kind, p.name): p for kind, cls in KINDS.items() for p in parameters(cls) if p.form in ("axis", "axes")
}
NEEDED = [place for place, p in AXES.items() if isinstance(p.default, Needed)]
SPACE = {"space": {"lower": 0, "upper": 100, "samples": 101}}


def test_axes_have_no_default_or_default_to_a_node() -> None:
    defaults = {place: p.default for place, p in AXES.items()}
    invented = {p: d for p, d in defaults.items() if not isinstance(d, Needed) and d not in ((), None)}
    assert AXES and not invented, f"declare these axes as needed(...): {invented}"


OLD = [(kind, name) for kind, old in DEFAULTS_OF_1.items() for name in old]
"""Axes that had a default in documents of version 1."""


def test_axes_that_had_a_default_before_are_required_or_inferred_from_the_source() -> None:
    inferred = {place for place in OLD if AXES[place].optional and AXES[place].default is None}
    assert OLD and not set(OLD) - inferred - set(NEEDED)


@pytest.mark.parametrize(("kind", "name"), NEEDED)
def test_a_missing_axis_is_an_error_that_states_what_to_write(kind: str, name: str) -> None:
    for absence in ({}, {name: None}):
        with pytest.raises(ParameterError) as caught:
            KINDS[kind](**absence)
        [problem] = caught.value.problems
        assert problem.where == f"{kind}.{name}" and problem.what == f"{kind} needs {name}"
        assert problem.fix.startswith(f"Write: {kind}(")


def test_the_call_that_an_error_proposes_has_every_value_in_its_place() -> None:
    with pytest.raises(
        ParameterError, match=r"Pattern needs axes. Write: Pattern\(name, \[x\]\), where x is an Axis"
    ):
        Pattern("p")
    with pytest.raises(
        ParameterError,
        match=r"History needs slots. Write: History\(name, \[x\], slot\), where x and slot are each an Axis",
    ):
        History("h", [Axis("x", 0, 1, 2)])


@pytest.mark.parametrize(("kind", "name"), NEEDED)
def test_a_document_without_the_axes_has_a_problem_that_names_an_axis_of_it(kind: str, name: str) -> None:
    document = {"deodar": VERSION, "axes": SPACE, "elements": {"e": {"kind": kind}}}
    with pytest.raises(DocumentError) as caught:
        document_files.from_data(document, {})
    [problem] = [p for p in caught.value.problems if p.where == f"e.{name}"]
    assert problem.what == f"{kind} needs {name}" and f'"{name}": ' in problem.fix
    assert '"space"' in problem.fix or name == "slots", problem.fix
    with pytest.raises(DocumentError, match='"samples"'):
        document_files.from_data({**document, "axes": {}}, {})


@pytest.mark.parametrize(("kind", "name"), OLD)
def test_a_document_of_version_1_without_the_axes_keeps_its_meaning(kind: str, name: str) -> None:
    body = {"kind": kind, **({"axes": []} if kind in ("History", "SampledHistory") else {})}
    taken = {"x": {"lower": 0, "upper": 100, "samples": 101}}
    doc = document_files.from_data({"deodar": 1, "axes": taken, "elements": {"e": body}}, {})
    [entry] = doc.entries
    found = getattr(entry.element, name)
    assert (tuple(found) if isinstance(found, tuple) else (found,)) == tuple(
        Axis(**axis) for axis in DEFAULTS_OF_1[kind][name]
    )
    again, arrays = document_files.to_data(doc)
    assert (
        again["deodar"] == VERSION and document_files.from_data(json.loads(json.dumps(again)), arrays) == doc
    )


def test_a_document_of_version_1_runs_as_before() -> None:
    """A stimulus with the old axis drives a field on the same axis."""
    x = {"x": {"lower": 0, "upper": 20, "samples": 21}}
    rows = [{"source": "p", "target": "u"}]
    data = {
        "deodar": 1,
        "axes": x,
        "elements": {"p": {"kind": "Pattern"}, "u": {"kind": "Field", "axes": ["x"]}},
        "connections": rows,
    }
    model = dd.Model(document=document_files.from_data(data, {}))
    values = dd.simulate(model, 1, record=["p"])["p.output"].values[-1]
    assert np.array_equal(values, [float(k % 7 == 3) for k in range(21)])


def test_a_document_of_version_1_that_states_its_axes_is_read_as_it_is() -> None:
    document = {"deodar": 1, "axes": SPACE, "elements": {"e": {"kind": "SpaceCode", "axes": ["space"]}}}
    [entry] = document_files.from_data(document, {}).entries
    assert entry.element.axes == (Axis("space", 0, 100, 101),)  # type: ignore[attr-defined]
