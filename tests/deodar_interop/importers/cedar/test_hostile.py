"""Broken and hostile files: one clear error or a report, and no other outcome."""

from __future__ import annotations

import json
import random
from pathlib import Path

import pytest

from deodar.errors import DocumentError
from deodar.importers.opening import Imported, read
from deodar_interop.importers.cedar import file
from tests.deodar_interop.importers import hostile
from tests.deodar_interop.importers.cedar.models import every_type

DATA = Path(__file__).parent / "data"
SAMPLES = sorted(DATA.glob("*.json"))

STEP = {"name": "u", "dimensionality": "1", "sizes": ["5"]}
FIELD = "cedar.dynamics.NeuralField"


def tried(content: bytes | str) -> Imported | None:
    """Read a file of cedar."""
    return hostile.tried("cedar", content)


@pytest.mark.parametrize("path", SAMPLES, ids=lambda p: p.stem)
def test_a_hundred_mutations_of_every_sample_open_or_are_refused(path):
    rng = random.Random(path.stem)
    good = sum(tried(hostile.mutations.changed(path.read_text(), rng)) is not None for _ in range(100))
    assert good > 40


def test_mutations_of_every_type_of_step_open_or_are_refused():
    rng, good, all_types = random.Random(5), 0, every_type()
    for text in all_types.values():
        for _ in range(6):
            good += tried(hostile.mutations.changed(text, rng)) is not None
    assert good > 3 * len(all_types)


# what a parameter of a step may hold that is a number, a list, a word or a switch elsewhere
ODD = ("-1", "0", "1e30", "nan", "text", "true", "", [], ["0"], ["-3", "1e9"], {}, {"type": "x"}, None)


def test_odd_values_of_every_parameter_of_a_step_open():
    rng = random.Random(6)
    for text in every_type().values():
        steps = json.loads(text, object_pairs_hook=hostile.mutations.numbered)
        step = next((body for body in steps["steps"].values() if body["name"] == "step"), {})
        for key in [key for key in step if key != "name"]:
            kept = step[key]
            step[key] = rng.choice(ODD)
            done = tried(hostile.mutations.written(steps))
            assert done is not None and done.model.document.entries
            step[key] = kept


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("", "is not JSON"),
        ("[]", "holds no architecture of cedar"),
        ('{"meta": {"format": "1"}}', "holds no architecture of cedar"),
        ('{"steps": {"cedar.x": {"name": "u"}', "is not JSON"),
        ("[" * 100_000, "nested deeper"),
    ],
)
def test_what_is_no_architecture_is_one_error(text, why):
    with pytest.raises(DocumentError, match=why):
        file.parse(text.encode())


def test_too_many_steps_and_groups_in_groups_are_refused():
    many = ",".join(f'"{FIELD}": {{"name": "u{k}"}}' for k in range(file.MOST_STEPS + 1))
    with pytest.raises(DocumentError, match="more than 4000 steps"):
        file.parse(f'{{"steps": {{{many}}}}}'.encode())
    inside = {"steps": {}}
    for k in range(file.DEEPEST + 2):
        inside = {"steps": {}, "groups": {f"g{k}": inside}}
    with pytest.raises(DocumentError, match="nested deeper"):
        file.parse(json.dumps(inside).encode())


def test_connectors_that_lead_in_a_circle_lead_nowhere():
    group = {
        "steps": {},
        "connectors": {"in": "true", "out": "false"},
        "connections": [{"source": "in.output", "target": "out.input"}],
    }
    wires = [
        {"source": "a.out", "target": "b.in"},
        {"source": "b.out", "target": "a.in"},
        {"source": "a.out", "target": "u.input"},
    ]
    done = tried(
        json.dumps({"steps": {FIELD: STEP}, "groups": {"a": group, "b": group}, "connections": wires})
    )
    assert done is not None and not done.model.document.connections


def test_a_group_that_links_itself_ends_with_an_error(tmp_path):
    link = {"linked file": {"path": "own.json", "isRelative": "true"}, "linked group name": "g"}
    inside = {"groups": {"g": link}, "steps": {"cedar.processing.StaticGain": {"name": "a"}}}
    (tmp_path / "own.json").write_text(json.dumps({"groups": {"g": inside}, "steps": {FIELD: STEP}}))
    with pytest.raises(DocumentError, match="nested deeper"):
        read(tmp_path / "own.json")


def test_names_of_files_do_not_lead_out_of_the_folder(tmp_path):
    outside = tmp_path / "secret.json"
    outside.write_text(json.dumps({"groups": {"g": {"steps": {FIELD: STEP}}}, "steps": {}}))
    folder = tmp_path / "inside"
    folder.mkdir()
    link = {"linked file": {"path": "../secret.json"}, "linked group name": "g"}
    (folder / "own.json").write_text(json.dumps({"steps": {FIELD: STEP}, "groups": {"g": link}}))
    done = read(folder / "own.json")
    assert len(done.model.document.entries) == 1
    assert any("put secret.json beside this file" in line.why for line in done.report.lines)


@pytest.mark.parametrize("name", ["", "a.b", "\ud800", "u" * 10_000, "[", '"', " ", "..", "u.input"])
def test_any_name_of_a_step_opens(name):
    step = {**STEP, "name": name}
    done = tried(json.dumps({"steps": {FIELD: step, "cedar.processing.StaticGain": {"name": "g"}}}))
    assert done is not None and len(done.model.document.entries) == 2


@pytest.mark.parametrize(
    "key", ["dimensionality", "sizes", "sigmoid", "lateral kernels", "time scale", "name"]
)
@pytest.mark.parametrize(
    "value", ["-1", "nan", "1e400", [], {}, None, True, ["a"], {"type": {}}, 10**400, "9" * 400]
)
def test_any_value_of_a_parameter_opens(key, value):
    done = tried(json.dumps({"steps": {FIELD: {**STEP, key: value}}}))
    assert done is not None and len(done.model.document.entries) == 1
