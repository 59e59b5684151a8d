"""Every problem of a document has words for the page, and a button whose press removes it."""

from __future__ import annotations

import ast
import dataclasses as dc
import re
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import FrameType
from typing import Any

import pytest

import deodar as dd
from deodar.couplings.arithmetic import Product
from deodar.couplings.projections import Resample
from deodar.element import PortAxes
from deodar.elements.stimuli import Boost
from deodar.errors import Problem
from deodar.model import edit
from deodar.model.check import check
from deodar.model.document import Document
from deodar.model.proposed import MOST_TRIED
from deodar_studio.views import view
from deodar_studio.views.repairs import repair_of
from deodar_studio.world import embodiment
from tests.deodar.model.proven_fix import finding
from tests.deodar.model.test_fixes import DECISIONS, DOCUMENTS, FURTHER, STRUCTURAL, Mute, shared_level
from tests.deodar.session.test_agreement import PLANE, Rail, coding

SOURCES = Path(dd.__file__).parent
X, Y = dd.Axis("x", 0, 10, samples=11), dd.Axis("y", 0, 10, samples=11)

CODE = re.compile(r"\bmodel\.\w|\bdd\.|--|`|\w\(|\w=[\w\"'\[{]|\.\.\.")
"""What only a script or a shell can use."""


@dataclass(frozen=True)
class Twofold(Boost):
    """A kind whose output has the name of a parameter."""

    def outputs(self, ins: PortAxes) -> PortAxes:
        return {"amplitude": tuple(self.axes)}


@dataclass(frozen=True)
class Failing(Boost):
    """A kind that raises."""

    def outputs(self, ins: PortAxes) -> PortAxes:
        raise ValueError("no outputs")


def _fields(*axes: Sequence[dd.Axis]) -> dd.Model:
    model = dd.Model("m")
    for name, its_axes in zip("uv", axes, strict=False):
        model.add(dd.Field(name, its_axes))
    return model


def _structures() -> Iterator[tuple[str, Document]]:
    """Yield documents with the problems of a structure that have no document elsewhere."""
    model = _fields([X])
    model.add(dd.Field("wide", [X], kernel=[dd.Gaussian(1, [1, 2])]))
    model.add(dd.Field("one name", [X, dd.Axis("x", 0, 5, samples=6)]))
    model.add(Twofold("twofold", [X]))
    yield "an element of its own", model.document
    model = _fields([X])
    model.add(Failing("failing", [X]))
    yield "a kind that fails", model.document
    model = _fields([X], [X])
    model["u"] >> model["v"]
    wires = tuple(dc.replace(c, source_port="nothing") for c in model.document.connections)
    yield "a port that is not there", dc.replace(model.document, connections=wires)
    model = _fields([X], [X, Y])
    product = model.add(Product(name="product"))
    model.connect("u", product)
    model.connect("v", product["factor"])
    yield "a factor with more axes", model.document
    model = _fields([Y])
    model["u"] >> Resample([X], name="resample")
    yield "a coupling of other axes", model.document


MODELS = FURTHER | STRUCTURAL | {name: model for name, (model, _) in DECISIONS.items()}
ALL = DOCUMENTS | {name: model.document for name, model in MODELS.items()} | dict(_structures())
PROBLEMS = [
    pytest.param(doc, problem, id=f"{name}: {problem.what[:40]}")
    for name, doc in ALL.items()
    for problem in check(doc)
]


@pytest.mark.parametrize(("doc", "problem"), PROBLEMS)
def test_a_problem_has_words_and_a_button_that_removes_it(doc: Document, problem: Problem) -> None:
    (listed, *_) = view.problems([problem], doc)
    assert not CODE.search(f"{listed.where} {listed.what} {listed.fix} {listed.repair}"), listed
    repair = repair_of(doc, problem)
    assert repair is not None and listed.repair == repair[0] and len(listed.repair) < 80
    repaired = repair[1](doc)
    assert finding(problem) not in map(finding, check(repaired))
    if listed.repair == "Remove it":
        assert [name for name in _names(doc) if name not in _names(repaired)] == [problem.where]


def _names(doc: Document) -> list[str]:
    """Return the paths of the elements and the names of the document parameters."""
    return [*(e.path for e in doc.entries), *(p.name for p in doc.parameters)]


def _beside(name: str, group: str = "") -> dd.Model:
    """Return a model with a field `u`, and one of another name that has two axes of one name."""
    model = _fields([X])
    model.add(dd.Field(name, [X, dd.Axis("x", 0, 5, samples=6)]), group=group)
    return model


@pytest.mark.parametrize(
    ("model", "path"),
    [
        (_beside("u (copy)"), "u (copy)"),
        (_beside("v", "u (old)"), "u (old).v"),
        (_beside("u.v"), '"u.v"'),
    ],
)
def test_a_problem_belongs_to_the_longest_path_that_its_place_begins_with(model: dd.Model, path: str) -> None:
    doc = model.document
    (problem,) = check(doc)
    assert problem.where == path
    for where in (path, f"{path}.tau", f"{path} (script.py:3)"):
        (listed,) = view.problems([dc.replace(problem, where=where)], doc)
        assert listed.element == model[path].id and listed.repair == "Remove it"
    repair = repair_of(doc, problem)
    assert repair is not None and _names(repair[1](doc)) == ["u"]


@pytest.mark.parametrize("name", ["u.free", "u (old)", "free"])
def test_removing_a_document_parameter_leaves_the_element_of_a_similar_name(name: str) -> None:
    model = _fields([X])
    model.add(dd.GaussianStimulus("s", [X])) >> model["u"]
    doc = edit.document_parameter(model.document, name, 3.0)
    problem = next(p for p in check(doc) if p.where == name)
    (listed,) = view.problems([problem], doc)
    repair = repair_of(doc, problem)
    assert (listed.element, listed.repair) == ("", "Remove it")
    assert repair is not None and repair[1](doc) == model.document


def test_problems_of_a_run_or_a_request_have_their_elements_and_no_buttons() -> None:
    arena, model = _in_a_world("another unit")
    problems = [*embodiment.problems(model.document, arena), *check(_beside("v").document)]
    assert all(p.repair for p in view.problems(problems[:1], model.document))
    for listed in view.problems(problems, model.document, buttons=False):
        assert (listed.repair, listed.wire, listed.world) == ("", None, False)
    assert view.problems(problems, model.document, buttons=False)[0].element == model[problems[0].where].id


def reports(path: Path) -> Iterator[int]:
    """Yield the lines of a file that report a problem of the structure."""
    for n in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(n, ast.Call) and ast.unparse(n.func) in ("self.problem", "Problem"):
            yield n.lineno


def test_every_line_that_reports_a_structure_reports_it_in_one_of_the_documents() -> None:
    """So a new problem needs a document, and with it words and a button."""
    files = [SOURCES / "model" / name for name in ("resolve.py", "order.py")]
    lines = {(str(path), line) for path in files for line in reports(path)}
    seen = set[tuple[str, int]]()

    def trace(frame: FrameType, event: str, _: Any) -> Any:
        if frame.f_code.co_filename not in map(str, files):
            return None
        seen.add((frame.f_code.co_filename, frame.f_lineno))
        return trace

    before = sys.gettrace()
    sys.settrace(trace)
    try:
        for doc in ALL.values():
            check(dc.replace(doc))  # the graph of a document is known
    finally:
        sys.settrace(before)
    assert lines - seen == set()


REPORTS = ("warning", "Problem", "self.problem", "EditFix", "assign")
READERS = ("Fix", "ConnectionFix", "option")
"""What states a text for each reader."""


def texts(node: ast.AST) -> Iterator[str]:
    """Yield the texts in a part of a program that all readers get."""
    if isinstance(node, ast.Call) and ast.unparse(node.func).partition(".")[0] in READERS:
        return
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        yield node.value
    for inner in ast.iter_child_nodes(node):
        yield from texts(inner)


def test_no_line_that_reports_a_mistake_writes_code_for_all_readers() -> None:
    """Those of kinds state no fix, or one in words."""
    paths = [
        p
        for folder in ("model/checks", "elements", "couplings", "numerics")
        for p in (SOURCES / folder).rglob("*.py")
    ]
    code: list[str] = []
    for path in [*paths, SOURCES / "session" / "agreement.py", SOURCES / "model" / "resolve.py"]:
        for n in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(n, ast.Yield) or (isinstance(n, ast.Call) and ast.unparse(n.func) in REPORTS):
                code += [f"{path.name}:{n.lineno}: {text}" for text in texts(n) if CODE.search(text)]
    assert code == []


def _in_a_world(sort: str) -> tuple[dd.World, dd.Model]:
    """Return a world, and a model that has one problem or warning in it."""
    if sort == "another unit":
        return dd.Arena("blocks"), coding()
    model = dd.Model("m", dt=64)
    if sort == "another number of samples":
        model.add(dd.Sensor("eyes", [dd.Axis("of", 0, 8, 9)], "infrared"))
    elif sort == "no such motor":
        model.add(dd.Motor("arm", motor="arm"))
    else:
        model.add(dd.Sensor("eye", [X, Y], sensor="picture"))
    return dd.Arena("blocks"), model


@pytest.mark.parametrize(
    ("sort", "repair", "world"),
    [
        ("no such sensor", "Remove it", True),
        ("no such motor", "Remove it", True),
        ("another number of samples", "Use its axes", False),
        ("another unit", "Set its gain", False),
    ],
)
def test_a_problem_of_a_world_has_words_and_a_button_that_removes_it(
    sort: str, repair: str, world: bool
) -> None:
    arena, model = _in_a_world(sort)
    (problem,) = embodiment.problems(model.document, arena)
    (listed,) = view.problems([problem], model.document)
    assert not CODE.search(f"{listed.where} {listed.what} {listed.fix} {listed.repair}"), listed
    assert (listed.repair, listed.world) == (repair, world)
    button = repair_of(model.document, problem)
    assert button is not None and not embodiment.problems(button[1](model.document), arena)


OF = dd.Axis("of", 0, 8, 9)


@dataclass(frozen=True)
class BumpSensor(dd.Sensor):
    """A kind of a package that reads a sensor."""


@dataclass(frozen=True)
class PairMotor(dd.Motor):
    """A kind of a package that drives a motor."""


def _exchanging(*elements: dd.Element) -> dd.Model:
    model = dd.Model("m", dt=64)
    for element in elements:
        model.add(element)
    return model


@pytest.mark.parametrize("kind", [dd.Sensor, BumpSensor])
def test_the_axes_of_a_sensor_are_those_of_its_readers_too(kind: type[dd.Sensor]) -> None:
    model = _exchanging(kind("eyes", [OF], "infrared"), dd.Field("u", [OF], tau=640))
    model["eyes"] >> model["u"]
    arena, doc = dd.Arena("blocks"), model.document
    (problem,) = embodiment.problems(doc, arena)
    repair = repair_of(doc, problem)
    assert repair is not None and repair[0] == "Use its axes"
    fitted = repair[1](doc)
    assert not embodiment.problems(fitted, arena)
    assert not [p for p in check(fitted) if p.severity == "problem"]
    assert fitted.entries[0].axes == fitted.entries[1].axes and fitted.entries[0].axes[0].samples == 8


@pytest.mark.parametrize("kind", [dd.Motor, PairMotor])
def test_a_motor_of_another_size_gets_the_axes_of_the_world(kind: type[dd.Motor]) -> None:
    model, arena = _exchanging(kind("wheel", [OF], "left")), dd.Arena("blocks")
    (problem,) = embodiment.problems(model.document, arena)
    repair = repair_of(model.document, problem)
    assert repair is not None and repair[0] == "Use its axes"
    assert not embodiment.problems(repair[1](model.document), arena)


def test_an_axis_that_fits_another_signal_stays_as_it_is() -> None:
    fits = dd.Axis("of", 0, 7, 8)
    model = _exchanging(dd.Sensor("eyes", [fits], "infrared"), dd.Motor("wheel", [fits], "left"))
    arena, doc = dd.Arena("blocks"), model.document
    (problem,) = embodiment.problems(doc, arena)
    repair = repair_of(doc, problem)
    assert problem.where == "wheel" and repair is not None
    fitted = repair[1](doc)
    assert fitted.entries[0] == doc.entries[0] and not embodiment.problems(fitted, arena)


def test_a_gain_that_a_document_parameter_drives_is_set_there() -> None:
    model = coding()
    model.parameter("k", 1.0)
    model.link("own place.gain", "k")
    arena, doc = dd.Arena("blocks"), model.document
    (problem,) = embodiment.problems(doc, arena)
    assert 'model.set("k", ' in problem.fix
    repair = repair_of(doc, problem)
    assert repair is not None and not embodiment.problems(repair[1](doc), arena)


def test_an_axis_in_another_unit_than_the_world_has_a_button_for_the_world() -> None:
    model = _exchanging(dd.Sensor("place", [dd.Axis("of", 0, 1, 2, unit="cm")], "place"))
    arena = dd.Arena("blocks")
    problems = [*embodiment.problems(model.document, arena), *embodiment.warnings(model.document, arena)]
    (listed,) = view.problems(problems, model.document)
    assert listed.world and listed.fix == "Choose the unit of the world: cm"


def test_a_kind_without_ports_connects_to_nothing() -> None:
    model = _fields([X])
    mute = model.add(Mute("mute", [X]))
    with pytest.raises(dd.errors.ModelError, match="mute has no output port"):
        model.connect(mute, "u")


def test_the_words_of_a_problem_name_what_its_button_removes() -> None:
    """Also of the problems whose edit is not tried, and where a document parameter prevents it."""
    model = dd.Model("m")
    for k in range(MOST_TRIED + 1):
        model.add(dd.Field(f"u{k}", [X])) >> model.add(dd.Field(f"v{k}", [dd.Axis("y", 0, 10, 11)]))
    doc = model.document
    untried = check(doc)[-1]
    (listed,) = view.problems([untried], doc)
    assert listed.repair == "Remove the connection" and listed.fix.endswith("Or remove the connection")
    repair = repair_of(doc, untried)
    assert repair is not None and len(repair[1](doc).connections) == MOST_TRIED
    doc = shared_level().document
    unlinked = [p for p in view.problems(check(doc), doc) if "First unlink" in p.fix]
    assert unlinked and all(p.fix.endswith(f"Or remove {p.where}") for p in unlinked)


def test_a_motor_that_takes_another_unit_loses_the_connection_and_not_itself() -> None:
    model, rail = dd.Model("rail", dt=10), Rail()
    read = model.add(dd.Field("u", [PLANE[0]])) >> model.add(dd.PeakPosition(name="read"))
    read >> model.add(dd.Motor("cart", motor="reach"))
    (problem,) = embodiment.problems(model.document, rail)
    repair = repair_of(model.document, problem)
    assert repair is not None and repair[0] == "Remove the connection"
    repaired = repair[1](model.document)
    assert _names(repaired) == _names(model.document) and not embodiment.problems(repaired, rail)
