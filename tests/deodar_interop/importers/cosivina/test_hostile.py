"""Broken and hostile files: one clear error or a report, and no other outcome."""

from __future__ import annotations

import json
import random

import numpy as np
import pytest

import deodar as dd
from deodar.errors import DocumentError
from deodar.importers.opening import Imported, read
from deodar.importers.tools import IMPORTERS
from deodar.model.check import problems
from deodar_interop.importers.cosivina import file
from tests.deodar_interop.importers import hostile
from tests.deodar_interop.importers.cosivina.files import SAMPLES, element, text, written

FIELD = {"size": [1, 10], "tau": 10, "h": -5, "beta": 4}


def tried(content: bytes | str) -> Imported | None:
    """Read a file, with or without the known errors of cosivina."""
    return hostile.tried("cosivina", content, bugs=random.random() < 0.5)


@pytest.mark.parametrize("path", SAMPLES, ids=lambda p: p.stem)
def test_mutations_of_every_sample_open_or_are_refused(path):
    count = 100 if path.stat().st_size < 20_000 else 25
    files = hostile.broken(path.read_text(), random.Random(f"{path.stem} 0"), count)
    good = sum(tried(content) is not None for content in files)
    assert good > 0


def test_mutations_without_problems_run():
    source = next(p for p in SAMPLES if "OneLayer" in p.stem).read_text()
    ran = hostile.run_without_problems(tried, source, 7, 8)
    assert ran > 3


@pytest.mark.parametrize(
    ("content", "says"),
    [
        (b"", "is not JSON"),
        (b'{"simulator": {"deltaT": 1, "elements": [{"label": "u",', "is not JSON"),
        (b'{"simulator": ' + b"[" * 100_000, "nested deeper"),
        (b'{"simulator": {"elements": ' + b"[" * 80 + b"]" * 80 + b"}}", "nested deeper"),
        (b'{"simulator": 3}', "no simulator"),
        (b"[1, 2]", "no simulator"),
        (b'{"simulator": {"elements": [], "deltaT": ' + b"9" * 9000 + b"}}", "digits"),
        (text([element("u", "NeuralField", FIELD)]).encode("utf-16"), ""),
        (text([element("feld \u00fc", "NeuralField", FIELD)]).encode().replace(b"\\u00fc", b"\xfc"), ""),
    ],
)
def test_a_file_that_is_not_of_cosivina_is_an_error(content, says, tmp_path):
    path = tmp_path / "x.json"
    path.write_bytes(content)
    if says:
        with pytest.raises(DocumentError) as caught:
            IMPORTERS["cosivina"].read(content, "x.json", False)
        assert says in str(caught.value) and "\n" not in str(caught.value)
        with pytest.raises(DocumentError, match=r"x\.json"):
            dd.load(path)
    else:
        assert len(dd.load(path).document.entries) == 1


def test_a_file_of_100_megabytes_is_refused_before_it_is_read(tmp_path):
    path = tmp_path / "large.json"
    with path.open("wb") as file:
        file.write(b'{"simulator": {"elements": [')
        file.truncate(100 * 2**20)
    with pytest.raises(DocumentError, match="100 MiB"):
        dd.load(path)


def test_elements_of_implausible_size_become_placeholders(tmp_path):
    done = read(
        written(
            tmp_path,
            [
                element("u", "NeuralField", {**FIELD, "size": [10**6, 10**6]}),
                element("v", "NeuralField", FIELD),
            ],
        )
    )
    assert [(line.where, line.verdict) for line in done.report.lines if line.part == "element"] == [
        ("u", "dropped"),
        ("v", "carried"),
    ]


def test_labels_with_special_characters_are_names(tmp_path):
    names = [
        "../../up",
        "/etc/passwd",
        "u.output",
        "a\nb",
        "..",
        'q"uote',
        "{}",
        "$HOME",
        "u -> u (global)",
        " ",
    ]
    done = read(written(tmp_path, [element(n, "NeuralField", FIELD) for n in names]))
    dd.save(done.model, tmp_path / "out" if (tmp_path / "out").mkdir() else tmp_path / "out" / "m.json")
    assert [p.name for p in (tmp_path / "out").iterdir()] == ["m.json"]
    assert dd.load(tmp_path / "out" / "m.json").document == done.model.document
    dd.simulate(done.model, 2)


def test_a_label_that_occurs_twice_is_numbered(tmp_path):
    parts = [
        element("u", "NeuralField", FIELD),
        element("u", "NeuralField", {**FIELD, "h": 1}),
        element("k", "ScaleInput", {"size": [1, 10]}, [("u", "output")]),
    ]
    done = read(written(tmp_path, parts))
    assert {e.path for e in done.model.document.entries} == {"u", "u (2)", "k"}
    assert [line.where for line in done.report.losses] == ["u (2)"]


@pytest.mark.parametrize("count", [1, 2, 3])
def test_loops_without_a_state_run(count, tmp_path):
    """A ring of couplings, or one that reads itself, is computed one step later by cosivina."""
    ring = [
        element(
            f"s{k}", "ScaleInput", {"size": [1, 3], "amplitude": 0.5}, [(f"s{(k + 1) % count}", "output")]
        )
        for k in range(count)
    ]
    field = element("u", "NeuralField", {**FIELD, "size": [1, 3]}, [("s0", "output")])
    done = read(written(tmp_path, [*ring, field]))
    assert problems(done.model.document) == [] and done.report.faithful
    assert np.allclose(dd.simulate(done.model, 5, every=5)["u.activation"], -5)


def test_a_loop_through_a_sum_runs(tmp_path):
    kernel = {
        "size": [1, 3],
        "sigmaExc": 1,
        "amplitudeExc": 0.1,
        "sigmaInh": 1,
        "amplitudeInh": 0,
        "amplitudeGlobal": 0,
    }
    parts = [
        element("s", "SumInputs", {"size": [1, 3]}, [("k", "fullSum"), ("k", "output"), ("b", "output")]),
        element("k", "LateralInteractions1D", kernel, [("s", "output")]),
        element("b", "BoostStimulus", {"amplitude": 1}),
    ]
    done = read(written(tmp_path, parts))
    assert problems(done.model.document) == [] and done.report.faithful
    values = dd.simulate(done.model, 3, every=3, record=["s.output"])["s.output"].values[-1]
    assert np.isfinite(values).all() and values.min() > 1


@pytest.mark.parametrize(
    "shape",
    [
        {"label": "v", "component": "output"},
        [{"label": "v", "component": "output"}],
        [[{"label": "v", "component": "output"}]],
        {"label": ["v"], "component": ["output"]},
        {"label": "v"},
        "v",
    ],
)
def test_every_form_of_one_input_is_read(shape, tmp_path):
    parts = [element("v", "NeuralField", FIELD), {**element("u", "NeuralField", FIELD), "input": shape}]
    model = read(written(tmp_path, parts)).model
    assert [(c.source_port, c.reads) for c in model.document.connections] == [("output", "current")]


@pytest.mark.parametrize(
    "shape",
    [
        None,
        [],
        {},
        {"_ArrayType_": "double", "_ArraySize_": [0, 0], "_ArrayData_": None},
        {"_ArrayType_": "double", "_ArraySize_": [0, 0], "_ArrayData_": []},
        [None],
        [{"label": {"_ArrayType_": "double", "_ArraySize_": [0, 0], "_ArrayData_": None}, "component": None}],
    ],
)
def test_every_form_of_no_input_is_read(shape, tmp_path):
    done = read(written(tmp_path, [{**element("u", "NeuralField", FIELD), "input": shape}]))
    assert done.report.faithful and not done.model.document.connections


@pytest.mark.parametrize("elements", ["missing", None, [], {}, 27, "field u", True, {"label": "u"}])
def test_a_file_without_elements_is_refused(elements, tmp_path):
    body = json.loads(text([element("u", "NeuralField", FIELD)]))["simulator"] | {
        "nElements": 27,
        "elements": elements,
    }
    if elements == "missing":
        del body["elements"]
    (tmp_path / "lost.json").write_text(json.dumps({"simulator": body}))
    with pytest.raises(DocumentError, match=r"lost\.json: holds no elements: .* nElements is 27"):
        dd.load(tmp_path / "lost.json")


@pytest.mark.parametrize(
    "elements", [None, [], {"_ArrayType_": "double", "_ArraySize_": [0, 0], "_ArrayData_": None}]
)
def test_a_simulator_with_zero_elements_is_an_empty_model(elements, tmp_path):
    (tmp_path / "empty.json").write_text(
        json.dumps({"simulator": {"deltaT": 1, "nElements": 0, "elements": elements}})
    )
    done = read(tmp_path / "empty.json")
    assert done.report.faithful and not done.model.document.entries


def test_elements_that_are_counted_or_named_but_missing_are_reported(tmp_path):
    body = json.loads(text([element("u", "NeuralField", FIELD), element("v", "NeuralField", FIELD)]))
    del body["simulator"]["elements"][1]
    (tmp_path / "cut.json").write_text(json.dumps(body))
    assert [str(line) for line in read(tmp_path / "cut.json").report.losses] == [
        "file nElements: approximated, it is 2, and the list of elements holds 1",
        "v: element unknown: dropped, elementLabels names it, the list of elements does not hold it",
    ]


def test_keys_that_occur_twice_are_reported_with_the_value_in_use(tmp_path):
    source = text([element("u", "NeuralField", FIELD)])
    source = source.replace('"tau": 10', '"tau": 30, "tau": 20').replace(
        '"deltaT": 1', '"deltaT": 3, "deltaT": 2, "deltaT": 1'
    )
    (tmp_path / "twice.json").write_text(source)
    done = read(tmp_path / "twice.json")
    assert not done.report.faithful
    assert [str(line) for line in done.report.losses] == [
        (
            "key simulator.deltaT: approximated, it occurs 3 times, with the values 3, 2, 1; the last one is"
            " used"
        ),
        "u: key param.tau: approximated, it occurs 2 times, with the values 30, 20; the last one is used",
    ]
    assert done.model["u"].element.tau == 20 and done.model.document.dt == 1


@pytest.mark.parametrize("param", [FIELD | {"tau": 35}, [FIELD | {"tau": 35}]], ids=["object", "list"])
def test_a_single_element_may_be_given_without_a_list_and_parameters_in_one(param, tmp_path):
    document = json.loads(text([element("u", "NeuralField", param)]))
    document["simulator"]["elements"] = document["simulator"]["elements"][0]
    (tmp_path / "one.json").write_text(json.dumps(document))
    [entry] = dd.load(tmp_path / "one.json").document.entries
    assert entry.element.tau == 35


def test_wrong_values_are_reported_and_replaced(tmp_path):
    done = read(
        written(
            tmp_path,
            [
                element(
                    "u",
                    "NeuralField",
                    {"size": [1, 10], "tau": "fast", "h": "_NaN_", "beta": -1, "colour": 3},
                )
            ],
            dt=-1,
        )
    )
    told = {(line.what, line.verdict) for line in done.report.losses}
    assert told == {
        ("tau", "approximated"),
        ("h", "approximated"),
        ("beta", "approximated"),
        ("colour", "dropped"),
        ("deltaT", "approximated"),
    }
    assert done.model["u"].element.tau == 10 and done.model["u"].element.resting_level == -5


def test_impossible_connections_are_reported(tmp_path):
    parts = [
        element(
            "u",
            "NeuralField",
            FIELD,
            [("absent", "output"), ("v", "noise"), ("v", "output"), ("u", "activation")],
        ),
        element("v", "NeuralField", {**FIELD, "size": [1, 7]}),
        element("k", "ScaleInput", {"size": [1, 10], "amplitude": 1}),
    ]
    done = read(written(tmp_path, parts))
    assert [line.why for line in done.report.losses] == [
        "there is no such element",
        "'v' gives no 'noise' here; it gives output, activation",
        "its size does not fit: [1, 7] into [1, 10]",
        "nothing is connected to it; zero arrives",
    ]
    dd.simulate(done.model, 2)


def test_a_file_with_too_many_elements_or_connections_is_refused(monkeypatch):
    monkeypatch.setattr(file, "MOST_ELEMENTS", 5)
    monkeypatch.setattr(file, "MOST_INPUTS", 12)

    def parsed(elements, inputs):
        own = [element(f"e{k}", "SumInputs", {"size": [1, 5]}) for k in range(elements - 1)]
        many = [(f"e{k % (elements - 1)}", "output") for k in range(inputs)]
        content = text([*own, element("u", "SumInputs", {"size": [1, 5]}, many)])
        return file.parse(content.encode())

    assert len(parsed(5, 12).elements) == 5
    with pytest.raises(DocumentError, match="holds 6 elements; at most 5 are read"):
        parsed(6, 12)
    with pytest.raises(DocumentError, match="holds more than 12 connections"):
        parsed(5, 13)
