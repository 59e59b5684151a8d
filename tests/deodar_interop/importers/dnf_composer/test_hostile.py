"""Broken and hostile files: one clear error or a report, and no other outcome."""

from __future__ import annotations

import json
import os
import random
from pathlib import Path

import numpy as np
import pytest

import deodar as dd
from deodar.elements.placeholder import Placeholder
from deodar.errors import DocumentError
from deodar.importers.opening import Imported, read
from deodar.importers.tools import IMPORTERS
from deodar.model.check import problems
from deodar_interop.importers.dnf_composer import element as elements
from deodar_interop.importers.dnf_composer import file
from tests.deodar_interop.importers import hostile
from tests.deodar_interop.importers.dnf_composer.files import (
    BELL,
    FIELD,
    HERE,
    KERNEL,
    SAMPLES,
    element,
    imported,
    text,
    written,
)

COUPLING = {"scalar": 1.0, "input_x_max": 20, "input_d_x": 1.0}


def tried(content: bytes | str) -> Imported | None:
    """Read a file, which may ask only for files of weights in its own folder."""
    asked: list[str] = []

    def beside(name: str) -> None:
        asked.append(name)

    done = hostile.tried("dnf-composer", content, beside=beside)
    if done is not None:
        assert all(name == Path(name).name and name.endswith("_weights.txt") for name in asked)
    return done


@pytest.mark.parametrize("path", SAMPLES, ids=lambda p: p.stem)
def test_a_hundred_mutations_of_every_sample_open_or_are_refused(path):
    files = hostile.broken(path.read_text(), random.Random(path.stem), 100)
    good = sum(tried(content) is not None for content in files)
    assert good > 50


def test_mutations_without_problems_run():
    source = (HERE / "syn-couplings.dnf").read_text()
    ran = hostile.run_without_problems(tried, source, 3, 6)
    assert ran > 2


@pytest.mark.parametrize(
    ("content", "says"),
    [
        (b"", "is not JSON"),
        (b'{"elements": [{"uniqueName": "u",', "is not JSON"),
        (b'[{"uniqueName": ' + b"[" * 100_000, "nested deeper"),
        (b'[{"uniqueName": ' + b"[" * 80 + b"]" * 80 + b"}]", "nested deeper"),
        (b"3", "no list of elements"),
        (b'"uniqueName"', "no list of elements"),
        (b'{"identifier": "a", "deltaT": 1.0}', "no list of elements"),
        (b'{"elements": {"uniqueName": "u"}}', "its elements are"),
        (b"[1, 2, {}]", "no entry of its list is an element"),
        (b'{"elements": [], "deltaT": ' + b"9" * 9000 + b"}", "digits"),
        (b'// a comment\n[{"uniqueName": "u"}]', "is not JSON"),
    ],
)
def test_what_is_no_simulation_is_an_error(content, says):
    with pytest.raises(DocumentError) as caught:
        IMPORTERS["dnf-composer"].read(content, "x.dnf")
    assert says in str(caught.value) and "\n" not in str(caught.value)


def test_a_broken_file_is_named_by_its_error(tmp_path):
    (tmp_path / "broken.dnf").write_text(text([element("u", "neural field", FIELD)])[:-20])
    with pytest.raises(DocumentError, match=r"broken\.dnf: is not JSON"):
        dd.load(tmp_path / "broken.dnf")


def test_a_byte_order_mark_and_text_after_the_document_are_accepted(tmp_path):
    source = text([element("u", "neural field", FIELD)])
    (tmp_path / "a.dnf").write_bytes(b"\xef\xbb\xbf " + source.encode() + b"\n} left over")
    assert [e.path for e in dd.load(tmp_path / "a.dnf").document.entries] == ["u"]


@pytest.mark.parametrize("content", ['{"identifier": "a", "deltaT": 2.0, "elements": []}'])
def test_a_simulation_without_elements_is_an_empty_model(content, tmp_path):
    (tmp_path / "a.dnf").write_text(content)
    done = read(tmp_path / "a.dnf")
    assert done.report.faithful and not done.model.document.entries and done.model.document.dt == 2


@pytest.mark.parametrize("step", [0, -1, "1", True, None, [1], 10**400])
def test_a_step_that_is_no_step_is_replaced_and_reported(step, tmp_path):
    body = json.loads(text([element("u", "neural field", FIELD)])) | {"deltaT": step}
    (tmp_path / "a.dnf").write_text(json.dumps(body))
    done = read(tmp_path / "a.dnf")
    assert done.model.document.dt == 1 and [line.what for line in done.report.losses] == ["deltaT"]


def test_keys_that_occur_twice_are_reported_with_the_value_in_use(tmp_path):
    source = text([element("u", "neural field", FIELD)]).replace('"tau": 10.0', '"tau": 30, "tau": 20')
    (tmp_path / "twice.dnf").write_text(source)
    done = read(tmp_path / "twice.dnf")
    assert [str(line) for line in done.report.losses] == [
        "u: key tau: approximated, it occurs 2 times, with the values 30, 20; the last one is used"
    ]
    assert done.model["u"].element.tau == 20


@pytest.mark.parametrize(
    ("name", "value"),
    [("tau", "10"), ("tau", None), ("tau", [1]), ("restingLevel", True), ("restingLevel", 10**400)],
)
def test_a_value_of_another_type_is_replaced_by_the_default(name, value, tmp_path):
    done = read(written(tmp_path, [element("u", "neural field", {**FIELD, name: value})]))
    assert [(line.what, line.verdict) for line in done.report.losses] == [(name, "approximated")]
    own = done.model["u"].element
    assert (own.tau, own.resting_level) == ((25, -2) if name == "tau" else (10, -5))


def test_numbers_that_are_not_finite_are_replaced(tmp_path):
    source = text([element("u", "neural field", FIELD)]).replace('"tau": 10.0', '"tau": NaN')
    (tmp_path / "nan.dnf").write_text(source)
    done = read(tmp_path / "nan.dnf")
    assert done.model["u"].element.tau == 25 and done.report.losses[0].what == "tau"


@pytest.mark.parametrize(
    ("label", "kind"),
    [([1, "Neural Field"], "Neural Field"), ([1, "field projection"], "field projection"), (None, "unknown")],
)
def test_an_unknown_label_becomes_a_placeholder(label, kind, tmp_path):
    odd = {**element("k", "x", {}, ["u"]), "label": label}
    done = read(written(tmp_path, [element("u", "neural field", FIELD, ["k"]), odd]))
    assert isinstance(done.model["k"].element, Placeholder)
    assert [
        (line.where, line.what, line.verdict) for line in done.report.losses if line.part == "element"
    ] == [("k", kind, "dropped")]
    assert np.allclose(dd.simulate(done.model, 3, every=3)["u.activation"], -2)


@pytest.mark.parametrize("x", [0, -5, "20", None, True, 1e300, 10**7])
def test_an_element_without_a_valid_size_becomes_a_placeholder(x, tmp_path):
    parts = [element("u", "neural field", FIELD, x=x), element("v", "neural field", FIELD, ["u"])]
    done = read(written(tmp_path, parts))
    assert [type(done.model[name].element).__name__ for name in "uv"] == ["Placeholder", "Field"]
    assert problems(done.model.document) == []


def test_weights_of_implausible_size_are_not_made(tmp_path, monkeypatch):
    monkeypatch.setattr(elements, "MOST_VALUES", 1000)
    parts = [element(n, "field coupling", COUPLING) for n in ("a", "b", "c")]
    done = imported(written(tmp_path, parts))
    assert [type(done.model[n].element).__name__ for n in "abc"] == ["Weights", "Weights", "Placeholder"]


@pytest.mark.parametrize("limit", ["MOST_ELEMENTS", "MOST_INPUTS"])
def test_too_many_elements_or_connections_are_refused(limit, tmp_path, monkeypatch):
    monkeypatch.setattr(file, limit, 2)
    parts = [element(n, "neural field", FIELD, ["a"]) for n in "abc"]
    with pytest.raises(DocumentError, match=r"at most 2|more than 2"):
        imported(written(tmp_path, parts))


def test_names_with_special_characters_are_names(tmp_path):
    names = ["../../up", "/etc/passwd", "u.output", "a\nb", "..", 'q"uote', "{}", "$HOME", " ", "", "k -> v"]
    done = read(written(tmp_path, [element(n, "neural field", FIELD, names) for n in names]))
    assert problems(done.model.document) == [] and len(done.model.document.entries) == len(names)
    dd.save(done.model, tmp_path / "m.json")
    assert dd.load(tmp_path / "m.json").document == done.model.document


def test_the_first_of_two_elements_of_one_name_is_kept(tmp_path):
    parts = [
        element("u", "neural field", FIELD),
        element("u", "neural field", {**FIELD, "restingLevel": 1.0}, ["v"]),
        element("v", "neural field", FIELD, ["u"]),
    ]
    done = read(written(tmp_path, parts))
    assert [(line.where, line.verdict) for line in done.report.losses] == [("u", "dropped")]
    assert done.model["u"].element.resting_level == -2
    assert [c.reads for c in done.model.document.connections] == ["current"]


# ------------------------------------------------------------------------------------ files beside the file


@pytest.mark.parametrize(
    "name", ["../secret", "/etc/passwd", "sub/deep", "c:\\secret", "\\\\host\\x", "a\0b"]
)
def test_names_of_weights_never_lead_out_of_the_folder(name, tmp_path):
    inside = tmp_path / "inside"
    (inside / "sub").mkdir(parents=True)
    for place in (tmp_path / "secret_weights.txt", inside / "sub" / "deep_weights.txt"):
        np.savetxt(place, np.ones((20, 20)))
    done = read(written(inside, [element(name, "field coupling", COUPLING)]))
    lines = [line for line in done.report.losses if line.part == "file"]
    assert len(lines) == 1 and lines[0].verdict == "approximated" and "weights of 0" in lines[0].why
    assert not done.model.document.entries[0].element.weights.data.any()


def test_weights_with_an_odd_name_in_the_folder_are_read(tmp_path):
    np.savetxt(tmp_path / ".._weights.txt", np.ones((20, 20)))
    done = read(written(tmp_path, [element("..", "field coupling", COUPLING)]))
    assert not [line for line in done.report.losses if line.part == "file"]
    assert done.model.document.entries[0].element.weights.data.all()


if hasattr(os, "symlink"):

    def test_a_link_out_of_the_folder_is_not_followed(tmp_path):
        (tmp_path / "inside").mkdir()
        np.savetxt(tmp_path / "secret.txt", np.ones((20, 20)))
        (tmp_path / "inside" / "k_weights.txt").symlink_to(tmp_path / "secret.txt")
        done = read(written(tmp_path / "inside", [element("k", "field coupling", COUPLING)]))
        assert "link to another folder" in done.report.losses[0].why
        assert not done.model["k"].element.weights.data.any()


@pytest.mark.parametrize(
    ("content", "says"),
    [
        ("1 2 3", "does not hold 20 x 20"),
        ("1 " * 401, "does not hold 20 x 20"),
        ("x " * 400, "more than numbers"),
        ("nan " * 400, "not finite"),
        ("1e300 " * 400, "not finite"),
        ("", "does not hold 20 x 20"),
    ],
)
def test_a_file_of_weights_with_errors_counts_as_zeros(content, says, tmp_path):
    (tmp_path / "k_weights.txt").write_text(content)
    done = read(written(tmp_path, [element("k", "field coupling", COUPLING)]))
    assert [line.what for line in done.report.losses] == ["k_weights.txt"] and says in done.report.losses[
        0
    ].why
    assert not done.model["k"].element.weights.data.any()


def test_a_folder_in_place_of_weights_counts_as_no_file(tmp_path):
    (tmp_path / "k_weights.txt").mkdir()
    done = read(written(tmp_path, [element("k", "field coupling", COUPLING)]))
    assert "there is no such file" in done.report.losses[0].why


def test_many_periods_of_a_stimulus_are_refused(tmp_path):
    times = [[2.0 * k, 2.0 * k + 0.5] for k in range(1, 3000)]
    done = read(written(tmp_path, [element("s", "timed gauss stimulus", {**BELL, "onTimes": times})]))
    assert isinstance(done.model["s"].element, Placeholder) and "periods" in done.report.losses[0].why


def test_a_word_of_another_tool_as_a_name_does_not_mislead(tmp_path):
    parts = [
        element("simulator", "neural field", FIELD, ["k"]),
        element("k", "gauss kernel", KERNEL, ["simulator"]),
    ]
    assert read(written(tmp_path, parts)).report.tool == "dnf-composer"


@pytest.mark.parametrize("peak", [[5, 5, 1e308, 1e-308], [1e308, 5, 1, 1], [5, 5, 1, 1e-300]])
def test_peaks_of_extreme_numbers_are_finite_or_refused(peak, tmp_path):
    values = {**COUPLING, "circular": True, "normalized": True, "couplings": [peak]}
    own = read(written(tmp_path, [element("k", "gauss field coupling", values)])).model["k"].element
    assert isinstance(own, Placeholder) or np.isfinite(own.weights.data).all()


def test_stimuli_of_extreme_numbers_are_added_without_a_crash(tmp_path):
    extreme = {**BELL, "amplitude": 1e308, "width": 1e-308, "normalized": True}
    parts = [element("s", "gauss stimulus", extreme), element("b", "gauss stimulus", BELL, ["s"])]
    model = read(written(tmp_path, parts)).model
    assert {"s", "b"} <= {e.path for e in model.document.entries} and all(p.what for p in model.check())


def test_a_report_has_a_largest_number_of_lines(tmp_path):
    bodies = [element("u", "neural field", FIELD) | {"inputs": [None] * 50_001}]
    (tmp_path / "many.dnf").write_text(text(bodies))
    with pytest.raises(
        DocumentError, match=r"many\.dnf: its report has 50,0\d\d lines, .*u: connection None: dropped"
    ):
        read(tmp_path / "many.dnf")
