"""Every fix that is an edit is proven, and every other one states the decision that it needs."""

from __future__ import annotations

import ast
import copy
import math
import pickle
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from types import FrameType
from typing import Annotated, Any, ClassVar

import pytest

import deodar as dd
from deodar import registry
from deodar.element import PortAxes
from deodar.elements.stimuli import Boost
from deodar.errors import ConnectionFix, EditFix, ModelError, Problem, assign
from deodar.model import edit, fits, new_elements
from deodar.model.check import check
from deodar.model.checks.resolution import fix_with_cells
from deodar.model.document import Document
from deodar.model.document_graph import graph
from deodar.model.proposed import MOST_TRIED, CheckedDocument, apply, bound
from deodar.model.wiring import Wiring
from deodar.proposed_edit import InsertCoupling, SetAxis
from tests.deodar.model.proven_fix import faults, finding
from tests.deodar.model.test_mistakes import KINDS, document

SOURCES = Path(dd.__file__).parent
X = dd.Axis("x", 0, 100, samples=101)


def is_labelled(case: dict[str, Any], problem: Problem) -> bool:
    """Return whether a problem is the mistake that a case is about."""
    return (
        (problem.where, problem.severity) == (case["where"], case["severity"])
        and all(word in f"{problem.what} {problem.fix}" for word in case["words"])
    )  # fmt: skip


HEADING = dd.Axis("heading", 0, 360, samples=361, unit="deg")


def _model(field: dd.Field, stimulus: dd.GaussianStimulus | None = None) -> dd.Model:
    model = dd.Model("m")
    model.add(stimulus or dd.GaussianStimulus("s", field.axes, center=50, amplitude=6)) >> model.add(field)
    return model


def _linked() -> dd.Model:
    """The sign of a resting level that a document parameter drives."""
    model = _model(dd.Field("u", [X], resting_level=5))
    model.parameter("rest", 5)
    model.link("u.resting_level", "rest")
    return model


def _two_grids() -> dd.Model:
    """A circle that is open on two grids, which a connection resamples."""
    coarse = dd.Axis("heading", 0, 360, samples=73, unit="deg")
    stimulus = dd.GaussianStimulus("s", [coarse], center=50, sigma=20, amplitude=6)
    return _model(dd.Field("u", [HEADING]), stimulus)


def _white(of_field: bool) -> dd.Model:
    """A field with means over cells and white noise, of its own or of an element."""
    field = dd.Field("u", [X], noise=0.1 * of_field, quadrature="cell")
    model = _model(field)
    if not of_field:
        model.add(dd.Noise("noise", [X], amplitude=0.2)) >> model["u"]
    return model


def _memory(samples: int, beta: float, quadrature: str) -> dd.Model:
    """Return a field that holds peaks without input, on a grid."""
    axes, kernel = [dd.Axis("x", 0, 100, samples)], [dd.Gaussian(18, 5, normalized=True)]
    model = dd.Model("m")
    u = model.add(
        dd.Field(
            "u",
            axes,
            sigmoid=dd.Logistic(beta),
            kernel=kernel,
            global_inhibition=0.3,
            quadrature=quadrature,
        )
    )
    model.add(dd.GaussianStimulus("s", axes, center=50, sigma=6, amplitude=8, windows=[(100, 400)])) >> u
    return model


def _rated() -> dd.Model:
    """Return a field with cells whose output reaches a memory trace through two couplings."""
    model = _memory(401, 4.0, "cell")
    (
        model["u"]
        >> dd.Gain(1.0, name="gain")
        >> dd.Sum(name="sum")
        >> model.add(dd.MemoryTrace("trace", model["u"].element.axes))
    )
    return model


@dataclass(frozen=True)
class Mute(Boost):
    """A kind without ports."""

    def outputs(self, ins: PortAxes) -> PortAxes:
        return {}


def _mute() -> dd.Model:
    model = _model(dd.Field("u", [X]))
    model.add(Mute("mute", [X], amplitude=1))
    return model


FURTHER = {
    "a kind without ports": _mute(),
    "on without any input": _model(dd.Field("u", [X], resting_level=5, global_inhibition=1)),
    "below the rounding": _model(dd.Field("u", [X], tau=1e9)),
    "a linked parameter": _linked(),
    "two grids": _two_grids(),
    "white noise over cells": _white(True),
    "white noise of an element": _white(False),
    "a rate through couplings": _rated(),
    "a line that is a little coarse": _memory(101, 4.0, "point"),
    "a coarse line": _memory(51, 4.0, "point"),
    "few samples for cells": _memory(25, 2.0, "cell"),
    "a hat of equal widths": _model(dd.Field("u", [X], kernel=[dd.MexicanHat(10, 5, 4, 5)])),
}
CASES = [case for group in KINDS.values() for case in group["cases"]]
DOCUMENTS = {case["document"]["name"]: document(case) for case in CASES}
EDITS = [
    pytest.param(name, problem, is_labelled(case, problem), id=f"{name}: {problem.what[:40]}")
    for case in CASES
    if (name := case["document"]["name"])
    for problem in check(DOCUMENTS[name])
    if problem.edits
]

FURTHER_EDITS = [
    pytest.param(name, problem, id=f"{name}: {problem.where}")
    for name, model in FURTHER.items()
    for problem in check(model.document)
    if problem.edits
]


Y = dd.Axis("y", 0, 100, samples=101)
Z = dd.Axis("z", 0, 10, samples=11)


def _flat(name: str, axes: list[dd.Axis]) -> dd.Field:
    """Return a field whose output follows each input."""
    return dd.Field(name, axes, resting_level=-1, sigmoid=dd.Logistic(beta=1))


def _loop(axes_known: bool = True) -> dd.Model:
    """Return a model with two gains that read each other; one of them reads a field, too."""
    model = _model(dd.Field("u", [X]))
    first, second = model.add(dd.Gain(0.5, name="g > h")), model.add(dd.Gain(0.5, name="a"))
    first >> second >> first
    if axes_known:
        model["u"] >> first
        second >> model.add(_flat("v", [X]))
    return model


def _reading(reads: str, back: str = "", through: bool = False) -> dd.Model:
    """Return a model with a connection that states an instant."""
    model = _model(dd.Field("u", [X]), dd.GaussianStimulus("s", [X], center=50, amplitude=9))
    source: Any = model["u"] >> dd.Gain(2.0, name="g") if through else model["u"]
    model.connect(source, model.add(_flat("v", [X])), reads=reads)
    if back:
        model.connect("v", "u", reads=back)
    return model


def _joined(source: list[dd.Axis], target: list[dd.Axis], reads: str = "") -> dd.Model:
    """Return a model of two fields over other axes."""
    model = dd.Model("m")
    model.add(dd.GaussianStimulus("s", source, center=5, amplitude=9)) >> model.add(dd.Field("u", source))
    model.connect("u", model.add(_flat("v w", target)), reads=reads)
    return model


STRUCTURAL = {
    "a loop without a state": _loop(),
    "a loop of current reads": _reading("current", back="current"),
    "a coupling with an instant": _reading("current", through=True),
    "another name of an axis": _joined([X], [Y]),
    "another name, read after a delay": _joined([X], [Y], "delayed"),
    "another name and another unit": _joined([X], [dd.Axis("y", 0, 100, samples=51, unit="mm")]),
    "another name of one axis of two": _joined([X, Z], [Y, Z]),
}
"""Models with one problem of their structure, whose fix is one edit."""

DECISIONS = {
    "which axes": (_loop(axes_known=False), "nothing states the axes of the loop"),
    "other bounds": (_joined([X], [dd.Axis("x", 0, 50, samples=51)]), "the axes may be meant to be one"),
    "other names": (_joined([X, Z], [Y, dd.Axis("w", 0, 10, 11)]), "each axis may become either"),
    "other dimensions": (_joined([X], [Z]), "which place goes where is not known, or what is lost"),
    "no source": (dd.Model("m"), "which element the gain is for"),
}
"""Models with problems of their structure whose fix is text, and why. So are those of worlds: the document
does not say which world has a sensor, or which unit is meant.
"""
DECISIONS["no source"][0].add(dd.Gain(2.0, name="g"))


@pytest.mark.parametrize("name", STRUCTURAL)
def test_the_fix_of_a_structure_is_proven_and_made_by_the_model(name: str) -> None:
    model = STRUCTURAL[name]
    (problem,) = check(model.document)
    assert problem.severity == "problem" and faults(model.document, problem) == []
    for place in ("script", "shell", "page"):
        assert problem.fix_at(place) and all(e.at(place) in problem.fix_at(place) for e in problem.edits)
    assert all(isinstance(e.plain_data(), dict) and pickle.loads(pickle.dumps(e)) == e for e in problem.edits)
    copied = dd.Model(document=model.document)
    copied.apply_fix(problem)
    assert not graph(copied.document).problems


def wires(doc: Document, before: Document) -> set[tuple[str, ...]]:
    """Return the ends of all connections; an element that is not in `before` is called by its kind.

    The instant that a connection states is kept by the edit of a coupling alone.
    """
    paths = {
        e.id: e.path if e.id in before.by_id() else f"new {type(e.element).__name__}" for e in doc.entries
    }
    new = bool(set(doc.by_id()) - set(before.by_id()))
    return {
        (paths[c.source], c.source_port, paths[c.target], c.target_port, "" if new else c.reads)
        for c in doc.connections
    }


@pytest.mark.parametrize("name", STRUCTURAL)
def test_the_text_for_a_script_makes_the_edit(name: str) -> None:
    doc = STRUCTURAL[name].document
    (problem,) = check(doc)
    typed = dd.Model(document=doc)
    names = {e.path: typed[e.path] for e in doc.entries}
    axes = {a.name: a for e in doc.entries for a in getattr(e.element, "axes", ())}
    text = problem.fix.partition(": ")[2].partition(". Or")[0]
    for call in text.split(" and "):
        eval(call, {"model": typed, "Project": dd.Project, **names, **axes})
    assert wires(typed.document, doc) == wires(apply(doc, problem.edits), doc)


@pytest.mark.parametrize("name", [n for n in STRUCTURAL if "name" in n])
def test_the_studio_offers_the_coupling_of_the_fix_first(name: str) -> None:
    doc = STRUCTURAL[name].document
    (problem,) = check(doc)
    (insert,) = problem.edits
    assert isinstance(insert, InsertCoupling)
    source, target = (next(e for e in doc.entries if e.path == path) for path in ("u", "v w"))
    axes: Any = [e.element.axes for e in (source, target)]  # type: ignore[attr-defined]
    best, *_ = fits.offers(axes[0], axes[1], lambda axis: axis.name)
    fixed = apply(doc, problem.edits)
    (coupling,) = [e for e in fixed.entries if e.id not in doc.by_id()]
    assert (best.kind, best.note) == (type(coupling.element).__name__, "")
    assert fits._converts(type(coupling.element), {"axes": axes[1], **insert.values()}, *axes) == ""  # pyright: ignore[reportPrivateUsage]


@pytest.mark.parametrize("name", DECISIONS)
def test_a_structure_that_needs_a_decision_has_text(name: str) -> None:
    model, reason = DECISIONS[name]
    problems = check(model.document)
    assert problems and reason and all(p.fix and not p.edits for p in problems)


def test_few_edits_of_a_structure_are_tried() -> None:
    """Each is tried in the whole document."""
    model = dd.Model("m")
    for k in range(MOST_TRIED + 5):
        model.add(dd.Field(f"u{k}", [X], noise=0.1)) >> model.add(dd.Field(f"v{k}", [Y]))
    problems = check(model.document)
    assert [bool(p.edits) for p in problems] == [True] * MOST_TRIED + [False] * 5
    fix = problems[-1].fix
    assert " >> Project([" in fix and isinstance(fix, ConnectionFix)
    last = MOST_TRIED + 4
    assert fix.ends == (f"u{last}", "output", f"v{last}", "input")
    assert fix.page.endswith("Or remove the connection") and fix.shell.startswith("Rename the axis")
    assert pickle.loads(pickle.dumps(fix)).shell == fix.shell != fix


@pytest.mark.parametrize(("name", "problem"), FURTHER_EDITS)
def test_the_fix_of_a_further_document_is_proven(name: str, problem: Problem) -> None:
    assert faults(FURTHER[name].document, problem) == []


@pytest.mark.parametrize(("name", "problem", "labelled"), EDITS)
def test_an_edit_solves_its_problem_without_another_one_and_the_signal_arrives(
    name: str, problem: Problem, labelled: bool
) -> None:
    assert faults(DOCUMENTS[name], problem, labelled) == []


def test_what_is_no_edit_states_the_decision_that_it_needs() -> None:
    """The reasons are beside the documents: `decision`."""
    edits: list[str] = []
    for case in CASES:
        problem = next(p for p in check(DOCUMENTS[case["document"]["name"]]) if is_labelled(case, p))
        assert bool(problem.edits) != bool(case.get("decision")), problem
        edits += [case["document"]["name"]] if problem.edits else []
    assert (len(edits), len(CASES) - len(edits)) == (68, 32)


def yields(path: Path, functions: frozenset[str]) -> Iterator[int]:
    """Yield the lines of `yield` in functions of a file, in all functions without names."""
    for f in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(f, ast.FunctionDef) and (not functions or f.name in functions):
            yield from (n.lineno for n in ast.walk(f) if isinstance(n, ast.Yield))


def test_every_line_that_reports_a_mistake_reports_it_in_one_of_the_documents() -> None:
    """So a new check needs a document, and with it a proven fix or a reason."""
    everywhere, in_kinds = frozenset[str](), frozenset(("warnings", "placed"))
    folders = {"model/checks": everywhere, "elements": in_kinds, "couplings": in_kinds}
    lines = {
        (str(path), line)
        for folder, functions in folders.items()
        for path in (SOURCES / folder).glob("*.py")
        for line in yields(path, functions)
    }
    files, seen = {path for path, _ in lines}, set[tuple[str, int]]()

    def trace(frame: FrameType, event: str, _: Any) -> Any:
        if frame.f_code.co_filename not in files:
            return None
        if event == "line":
            seen.add((frame.f_code.co_filename, frame.f_lineno))
        return trace

    before = sys.gettrace()
    sys.settrace(trace)
    try:
        for doc in [*DOCUMENTS.values(), *(m.document for m in FURTHER.values())]:
            check(doc)
    finally:
        sys.settrace(before)
    assert lines - seen == set()


def test_a_fix_is_written_for_each_reader_and_made_by_the_model() -> None:
    model = _model(dd.Field("u", [X], resting_level=5, global_inhibition=1))
    (problem,) = check(model.document)
    assert problem.fix_at("script") == 'Change the sign: model.set("u.resting_level", -5)'
    assert problem.fix_at("shell") == "Change the sign: --set u.resting_level=-5"
    assert problem.fix_at("page") == "Change the sign: u.resting_level = -5"
    for copied in (pickle.loads(pickle.dumps(problem)), copy.deepcopy(problem)):
        assert copied == problem and copied.edits == problem.edits
    model.apply_fix(problem)
    assert model.get("u.resting_level") == -5 and model.check() == []
    assert model.undo() and model.get("u.resting_level") == 5


@dataclass(frozen=True)
class Doubling(dd.Coupling):
    """A coupling of a user, which warns of a strength."""

    strength: Annotated[float, dd.Live()] = 3.0
    direct: ClassVar = {"output": ("input",)}

    def output(self, at: dd.Setting) -> dd.Arrays:
        return {"output": self.strength * at.inputs["input"]}

    def warnings(self, ins: Any) -> Iterator[tuple[str, str]]:
        if self.strength > 2:
            yield "is too strong", assign("Weaken it", {"strength": 2.0})


def test_fixes_are_made_in_a_document_with_a_kind_of_a_user(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(registry, "_kinds", dict(registry.kinds()))
    model = _model(dd.Field("u", [X], resting_level=5, global_inhibition=1))
    model["u"] >> model.add(dd.register(Doubling)(name="d")) >> model.add(_flat("v", [X]))
    for where, path, number in (("d", "d.strength", 2.0), ("u", "u.resting_level", -5)):
        problem = next(p for p in check(model.document) if p.where == where and p.edits)
        model.apply_fix(problem)
        assert model.get(path) == number
    assert not {"d", "u"} & {p.where for p in check(model.document) if p.edits}


def test_a_fix_of_a_linked_parameter_sets_the_document_parameter() -> None:
    problems = check(FURTHER["a linked parameter"].document)
    assert {p.fix_at("shell") for p in problems if "Change the sign" in p.fix} == {
        "Change the sign: --set rest=-5"
    }


def shared_level() -> dd.Model:
    """A document parameter that drives a resting level of the wrong sign, and the factor of a gain."""
    model = _linked()
    model.connect(model.add(dd.Gain(5.0, name="g")), model.add(dd.Field("v", [X])))
    model.connect("s", "g")
    model.link("g.factor", "rest")
    return model


def _shared_widths() -> dd.Model:
    """A document parameter that drives both widths of a hat."""
    model = _model(dd.Field("u", [X], kernel=[dd.MexicanHat(10, 5, 4, 5)]))
    model.parameter("w", 5)
    for name in ("excitation", "inhibition"):
        model.link(f"u.kernel.0.sigma_{name}", "w")
    return model


def _shared_source(*others: str) -> dd.Model:
    """A stimulus that inhibits a field which gets nothing else, and others."""
    stimulus = dd.GaussianStimulus("s", [X], center=50, amplitude=-9, windows=[(10, 20)])
    model = _model(dd.Field("u", [X]), stimulus)
    for name in others:
        model.add(dd.GaussianStimulus(f"b_{name}", [X], center=50, amplitude=8)) >> model.add(
            dd.Field(name, [X])
        )
        model.connect("s", name)
    return model


@pytest.mark.parametrize(
    ("model", "text"),
    [
        (shared_level(), "First unlink u.resting_level from 'rest', which also drives g.factor"),
        (_shared_widths(), "First unlink u.kernel.0.sigma_inhibition from 'w', which also drives"),
        (_shared_source("v"), "Change the sign of what should excite it"),
        (_shared_source("v", "w"), "Change the sign of what should excite it"),
    ],
)
def test_an_edit_that_would_change_something_else_is_text(model: dd.Model, text: str) -> None:
    stated = [p for p in check(model.document) if text in p.fix]
    assert {p.where for p in stated} == {"u"} and not any(p.edits for p in stated)


def test_a_source_with_one_target_changes_its_sign() -> None:
    (problem,) = _shared_source().check()
    assert problem.fix_at("shell").startswith("Change the sign of what should excite it: --set s.amplitude=9")


def test_all_grids_of_a_circle_are_joined_together() -> None:
    """One grid alone would be refused: its connection joins a periodic axis with one that is not."""
    (problem, *_) = check(FURTHER["two grids"].document)
    assert problem.fix_at("script") == (
        'Join the ends: model.set_axis("heading_2", periodic=True, samples=360) and'
        ' model.set_axis("heading", periodic=True, samples=72)'
    )
    assert problem.fix_at("shell").startswith("Join the ends: in the file, axes.heading_2: periodic = true, ")


def _circles(*axes: tuple[float, int, bool]) -> dd.Model:
    """Axes of one name, each with its end, its samples, and whether its ends meet."""
    model = dd.Model("m")
    for k, (upper, samples, periodic) in enumerate(axes):
        axis = dd.Axis("heading", 0, upper, samples=samples, unit="deg", periodic=periodic)
        model.add(dd.Field(f"u{k}", [axis], noise=0.1))
    return model


def _grids(model: dd.Model) -> list[tuple[float, int, bool]]:
    axes: list[Any] = [e.element.axes[0] for e in model.document.entries]  # type: ignore[attr-defined]
    return [(a.upper, a.samples, a.periodic) for a in axes]


OPEN, CLOSED, COARSE, QUARTER = (360, 361, False), (360, 360, True), (360, 73, False), (90, 37, False)


@pytest.mark.parametrize(
    "axes",
    [(OPEN, CLOSED, COARSE, QUARTER), (COARSE, OPEN, QUARTER, CLOSED), (CLOSED, QUARTER, COARSE, OPEN)],
)
def test_an_edit_and_its_text_change_no_other_axis(axes: tuple[tuple[float, int, bool], ...]) -> None:
    """An axis that becomes equal to another one moves the keys of later ones."""
    edited, typed = _circles(*axes), _circles(*axes)
    problem = next(p for p in check(edited.document) if "whole circle" in p.what)
    edited.apply_fix(problem)
    expected = {OPEN: CLOSED, COARSE: (360, 72, True)}
    assert _grids(edited) == [expected.get(axis, axis) for axis in axes]
    calls = problem.fix_at("script").removeprefix("Join the ends: ").split(" and ")
    for call in calls:
        eval(call, {"model": typed})
    assert len(calls) == 2 and _grids(typed) == _grids(edited)


def test_edits_whose_text_would_change_other_axes_are_text() -> None:
    """One grid becomes equal to another one that becomes a third."""
    doc = CheckedDocument(_circles((360, 73, False), (360, 72, False)).document)
    longer = [SetAxis(key, (("samples", samples),)) for key, samples in (("heading", 72), ("heading_2", 71))]
    for order, names in ((longer, ()), (longer[::-1], tuple(longer[::-1]))):
        assert bound(doc, Problem("u0", "has grids", EditFix("Change them", order))).edits == names


@pytest.mark.parametrize(("unit", "upper"), [("deg", 360.0), ("rad", 2 * math.pi)])
def test_joining_a_circle_brings_no_problem_to_any_kind(unit: str, upper: float) -> None:
    """An axis that is open is warned, so no kind may refuse the closed one; arrays first need its length."""
    circle, joined, with_arrays = dd.Axis("x", 0, upper, samples=61, unit=unit), 0, set[str]()
    for kind in new_elements.kinds():
        doc, source = edit.add(Document("d"), dd.GaussianStimulus("s", [circle], center=1, amplitude=6))
        doc, entry = edit.add(doc, new_elements.element(doc, kind.__name__, "e", {}, (circle,), (circle,)))
        for port in entry.element.ports():
            doc = edit.connect(doc, source, "output", entry, port)
        before = check(doc)
        if any(p.severity == "problem" for p in before):
            continue  # a kind for other axes than one circle
        (problem,) = [p for p in before if "whole circle" in p.what]
        if not problem.edits:
            with_arrays.add(kind.__name__)
            continue
        joined += 1
        new = [p for p in check(apply(doc, problem.edits)) if finding(p) not in {finding(q) for q in before}]
        assert new == [], kind
    assert joined >= 40 and with_arrays == {
        "Pattern",
        "PopulationActivity",
        "TimeSeries",
        "Weighting",
        "Weights",
    }


def test_an_edit_that_the_document_cannot_have_is_text_with_the_reason() -> None:
    model = dd.Model("m")
    model.add(dd.Pattern("seen", [HEADING], values=[1.0] * 361)) >> model.add(dd.Field("u", [HEADING]))
    (problem,) = [p for p in model.check() if "whole circle" in p.what]
    assert problem.edits == () and "First change seen" in problem.fix
    with pytest.raises(ModelError, match="needs a decision"):
        model.apply_fix(problem)


def test_set_axis_changes_every_element_and_refuses_an_unknown_axis() -> None:
    model = _model(dd.Field("u", [X]))
    model.set_axis("x", samples=201)
    assert [e.element.axes[0].samples for e in model.document.entries] == [201, 201]
    with pytest.raises(dd.errors.UnknownName, match="no axis 'y'"):
        model.set_axis("y", samples=3)


def test_a_fix_with_more_text_keeps_its_edits() -> None:
    fix = check(_model(dd.Field("u", [X], resting_level=5, global_inhibition=1)).document)[0].fix
    assert isinstance(fix, EditFix) and fix.then("Or not").edits == fix.edits
    assert fix.then("Or not").at("shell").endswith("--set u.resting_level=-5. Or not")


def _tiny_input(resting_level: float, kernel: dd.Gaussian) -> dd.Model:
    """A field whose input is smaller than any sigmoid resolves."""
    model = _model(dd.Field("u", [X], resting_level=resting_level, kernel=[kernel]))
    model.set("s.amplitude", 1e-7)
    model.set("s.windows", [(10, 20)])
    return model


def _weak_output() -> dd.Model:
    """A field that gets the output of another one at rest."""
    model = _model(dd.Field("v", [X]), dd.GaussianStimulus("s", [X], center=50, amplitude=1))
    model["v"] >> model.add(dd.Field("u", [X], resting_level=1, kernel=[dd.Gaussian(1, 5)]))
    return model


@pytest.mark.parametrize(
    "model",
    [_weak_output(), *(_tiny_input(level, dd.Gaussian(1, 5)) for level in (1.0, 0.2, 0.0, -1e-8))],
)
def test_values_that_no_field_can_have_are_not_proposed(model: dd.Model) -> None:
    problems = model.check()
    assert problems and not any("sigmoid.beta" in p.fix or "First change" in p.fix for p in problems)
    for problem in problems:
        apply(model.document, problem.edits)


@pytest.mark.parametrize("values", [{"sigmoid.beta": 1e9}, {"global_inhibition": math.inf}])
def test_values_that_a_field_refuses_stay_as_they_are(values: dict[str, Any]) -> None:
    """The fix of which they are a part states the reason; the check does not raise."""
    model = _model(dd.Field("u", [X]))
    fix = assign("Change it", values)
    wiring = Wiring(model.document, graph(model.document).nodes)
    assert fix_with_cells(wiring, model["u"].element, fix) is fix  # type: ignore[arg-type]


def test_checks_of_many_fixes_take_little_longer_than_those_of_few() -> None:
    """Each fix is tried in the part of the document that it concerns."""
    seconds: list[float] = []
    for count in (20, 160):
        model = dd.Model("m")
        for k in range(count):
            axis = dd.Axis(f"h{k}", 0, 360, samples=361, unit="deg")
            source = model.add(dd.GaussianStimulus(f"s{k}", [axis], center=50, sigma=20, amplitude=6))
            source >> model.add(dd.Field(f"u{k}", [axis], resting_level=5))
        start = time.process_time()
        assert sum(bool(p.edits) for p in check(model.document)) >= count
        seconds.append(time.process_time() - start)
    assert seconds[1] < 24 * seconds[0], seconds
