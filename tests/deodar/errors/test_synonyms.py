"""Each name of papers and other tools leads to a call that runs."""

from __future__ import annotations

import json
from typing import Any

import pytest

import deodar as dd
from deodar.errors import DeodarError, UnknownName
from deodar.model.document_files import to_data
from deodar.model.reader import from_data
from deodar.parameters import Needed, parameters
from deodar.synonyms import KINDS, Synonym, rows, synonym
from tests.command_line import typed

X = dd.Axis("x", 0, 100, samples=101)
SETTINGS: dict[str, Any] = {
    "axes": [X],
    "kernel": [dd.Gaussian(1.2, 5)],
    "sigmoid": dd.Logistic(4),
    "windows": [(0, 100)],
    "samples": 51,
    "periodic": True,
    "lower": -100,
    "upper": 200,
}
"""Values for parameters that are no number above 0."""

PARAMETERS = [pytest.param(r, id=f"{r.kind}.{r.word}") for r in rows() if r.kind != KINDS]
NAMES = [pytest.param(r, id=r.word) for r in rows() if r.kind == KINDS]


def needed(kind: type[Any], without: str) -> dict[str, Any]:
    """Return what a call of a kind needs besides a parameter."""
    if kind is dd.Axis:
        return {k: v for k, v in dict(name="x", lower=0, upper=100, samples=101).items() if k != without}
    values = {"weights": [[1.0]], "axes": [X]}
    return {p.name: values[p.name] for p in parameters(kind) if isinstance(p.default, Needed)}


def setting(row: Synonym) -> Any:
    """Return a value for the parameter of a row."""
    return SETTINGS.get(row.path, 1.5)


def test_there_are_at_least_60_names_each_with_a_source_and_none_of_deodar_itself() -> None:
    assert len(PARAMETERS) >= 60 and all(row.source for row in rows())
    for row in rows():
        if row.kind != KINDS:
            assert row.word not in [p.name for p in parameters(getattr(dd, row.kind))], row


@pytest.mark.parametrize("row", PARAMETERS)
def test_a_call_with_the_name_is_refused_and_the_proposed_call_runs(row: Synonym) -> None:
    kind, number = getattr(dd, row.kind), setting(row)
    others = needed(kind, row.path)
    with pytest.raises(UnknownName, match=f"{row.kind} has no parameter '{row.word}'") as caught:
        kind(**others, **{row.word: number})
    fix = caught.value.problems[0].fix
    assert fix.startswith("Write: ")
    arguments = eval(
        f"dict({fix.removeprefix('Write: ').replace('...', 'number')})", {"dd": dd, "number": number}
    )
    built = kind(**{**others, **arguments})
    for step in row.path.split("."):
        built = built[int(step)] if step.isdigit() else getattr(built, step)
    assert built == 1.5 or row.path in SETTINGS


@pytest.mark.parametrize("row", [p for p in PARAMETERS if hasattr(getattr(dd, p.values[0].kind), "inputs")])
def test_a_parameter_that_is_set_by_the_name_can_be_set_as_proposed(row: Synonym) -> None:
    kind, number = getattr(dd, row.kind), setting(row)
    model = dd.Model("m")
    model.add(kind(**needed(kind, ""), name="e"))
    with pytest.raises(UnknownName, match=f"e has no parameter '{row.word}'") as caught:
        model.set(f"e.{row.word}", number)
    verb, _, proposal = caught.value.problems[0].fix.partition(" ")
    if verb == "Write:":
        path = proposal
    else:  # a part that the element does not have: the whole part
        path, _, call = proposal.partition(": ")
        number = eval(call.partition("=")[2].replace("...", "number"), {"dd": dd, "number": number})
    model.set(path, number)
    assert model.get(path) is not None


@pytest.mark.parametrize("row", NAMES)
def test_a_kind_of_another_tool_leads_to_the_kind(row: Synonym) -> None:
    with pytest.raises(AttributeError, match=f"Did you mean '{row.path}'"):
        getattr(dd, row.word)
    assert isinstance(getattr(dd, row.path), type)


def _document(**parameters: Any) -> dict[str, Any]:
    model = dd.Model("m")
    model.add(dd.Field("u", [X]))
    document: Any = json.loads(json.dumps(to_data(model.document)[0]))
    document["elements"]["u"] |= parameters
    return document


@pytest.mark.parametrize(
    ("word", "setting", "entry"),
    [
        ("h", -3, {"resting_level": -3}),
        ("beta", 8, {"sigmoid": {"kind": "Logistic", "beta": 8}}),
        ("sigma_exc", 3, {"kernel": [{"kind": "Gaussian", "sigma": 3}]}),
    ],
)
def test_a_document_with_the_name_is_refused_with_the_entry_to_write(
    word: str, setting: float, entry: dict[str, Any]
) -> None:
    with pytest.raises(DeodarError) as caught:
        from_data(_document(**{word: setting}), {})
    (problem,) = caught.value.problems
    assert problem.where == f"u.{word}" and json.loads(f"{{{problem.fix.removeprefix('Write: ')}}}") == entry
    assert from_data(_document(**entry), {}).entries


def test_a_shell_a_sweep_and_a_handle_propose_the_path(tmp_path: Any) -> None:
    model = dd.Model("m")
    u = model.add(dd.Field("u", [X]))
    dd.save(model, tmp_path / "m.json")
    refused = typed("run", str(tmp_path / "m.json"), "--duration", "2", "--set", "u.h=-3")
    assert refused.status == 1 and "Write: u.resting_level" in refused.err
    with pytest.raises(DeodarError, match=r"Write: u\.noise"):
        dd.simulate(model, 2, sweep={"u.q": [0, 1]})
    with pytest.raises(UnknownName, match=r"Write: u\.sigmoid\.beta"):
        u.beta = 8
    with pytest.raises(UnknownName, match=r"Write: threshold=\.\.\."):
        u.sigmoid.theta = 1
    with pytest.raises(UnknownName, match="Its name here: beta"):
        model.set("u.sigmoid.steepness", 8)


def test_case_hyphens_and_underscores_do_not_matter_and_a_name_has_one_row() -> None:
    assert synonym("Field", "SigmaExc") == synonym("Field", "sigma_exc") == synonym("Field", "sigma-exc")
    assert synonym("Field", "tau") is None and synonym("Gain", "h") is None
