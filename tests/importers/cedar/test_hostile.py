"""Broken and hostile files: one clear error or a report, and no other outcome."""

from __future__ import annotations

import json
import random
from pathlib import Path

import pytest

from deodar.errors import DocumentError
from deodar.importers.cedar import file
from deodar.importers.opening import Imported, read
from tests.importers import hostile

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
