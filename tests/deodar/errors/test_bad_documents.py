"""Broken, foreign and hostile documents are read, or refused by one DocumentError that states the place."""

from __future__ import annotations

import copy
import json
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import deodar as dd
from deodar.couplings.arithmetic import Product
from deodar.couplings.weights import Weighting
from deodar.elements.function import Function
from deodar.elements.stimuli import Boost
from deodar.errors import DeodarError, DocumentError
from deodar.model import document_files
from deodar.model.check import check
from deodar.model.document import Document
from deodar.numerics.kernels.separable import Shifted
from tests.deodar.errors.refused import paragraph, refused

X = dd.Axis("x", 0, 10, samples=11)
HUE = dd.Axis("hue", 0, 360, samples=6, periodic=True, unit="deg")


def rich() -> dd.Model:
    """Return a model that uses every part of a document."""
    model = dd.Model("rich", time_unit="ms", dt=0.5)
    u = model.add(dd.Field("u", [X], kernel=[dd.Gaussian(sigma=2), Shifted(dd.Gaussian(), 1.0)], noise=0.1))
    v = model.add(
        dd.Field("v", [X, HUE], kernel=[dd.Gaussian(sigma=[2, 30], boundary=["zero", "periodic"])]),
        group="g.inner",
        ticks=2,
    )
    boost = model.add(Boost("boost", windows=[(0, 5)]))
    product = model.add(Product(name="gate"))
    f = model.add(Function("f", [X], values={"rate": 0.5}))
    w = model.add(Weighting(np.linspace(0, 1, 11), (X,), name="w"))
    u >> dd.Gain(2) >> f
    u >> w >> product["input"]
    boost >> product["factor"]
    product >> v
    model.connect(v, u, reads="delayed")
    model.connect(u, u, reads="current")
    model.parameter("gain", 3.0)
    model.link("u.tau", "gain")
    model.link("f.values.rate", "gain")
    model.describe(notes="a note", t0=2.0, layout={"u": [1, 2]})
    part = dd.Model("part")
    part.add(dd.Field("n", []))
    model.insert(part, "use", link=True)
    model.group("empty")
    return model


DATA, ARRAYS = document_files.to_data(rich().document)
DATA["packages"] = {"Gain": "deodar-gain 1.0"}
TEXT = json.dumps(DATA)


def test_the_unchanged_document_is_valid() -> None:
    assert document_files.from_data(json.loads(TEXT), ARRAYS) == rich().document
    assert set(document_files.KEYS) - set(DATA) == {"arrays", "written_by"}


def _places(document: Any, at: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """Yield every place of a value in a document."""
    yield at
    if isinstance(document, dict):
        for key, part in document.items():
            yield from _places(part, (*at, key))
    elif isinstance(document, list):
        for k, part in enumerate(document):
            yield from _places(part, (*at, k))


def _with(document: Any, at: tuple[Any, ...], replacement: Any) -> Any:
    if not at:
        return replacement
    out = copy.copy(document)
    out[at[0]] = _with(document[at[0]], at[1:], replacement)
    return out


VALUES: dict[str, Any] = {
    "null": None,
    "text": "x",
    "empty text": "",
    "minus one": -1,
    "zero": 0,
    "half": 0.5,
    "list": [],
    "object": {},
    "true": True,
    "nested": [[{}]],
    "kind": {"kind": "Field"},
    "huge": 10**250,
    "tiny": 1e-300,
    "infinite": float("inf"),
    "half a character": "\ud800",
}


def _read(content: Any) -> Document | None:
    """Return the document, or None after an error that states the problem; any other outcome fails the
    test.
    """
    try:
        doc = document_files.from_data(content, ARRAYS)
    except DeodarError as error:
        assert str(error).strip()
        assert "Traceback" not in str(error) and " at 0x" not in str(error)
        return None
    for problem in check(doc):  # a document that loads can be checked
        assert problem.what
    return doc


@pytest.mark.parametrize("kind", VALUES)
def test_a_wrong_value_at_any_place_is_refused_or_read(kind: str) -> None:
    """Each value of a valid document is replaced by each wrong value."""
    taken = refusals = 0
    for at in _places(DATA):
        doc = _read(_with(DATA, at, VALUES[kind]))
        if doc is None:
            refusals += 1
        else:
            taken += 1
            if kind not in ("infinite", "half a character"):
                written = document_files.to_data(doc)
                assert document_files.from_data(*written) == doc, (
                    f"{at}: what loads is written and read again as the same"
                )
    assert refusals > 100
    assert taken + refusals == len(list(_places(DATA)))


def test_a_missing_key_is_refused_or_has_a_default() -> None:
    opened: list[bool] = []
    for at in _places(DATA):
        if at and isinstance(at[-1], str):
            holder = DATA
            for key in at[:-1]:
                holder = holder[key]
            without = {k: v for k, v in holder.items() if k != at[-1]}
            opened.append(_read(_with(DATA, at[:-1], without)) is not None)
    assert any(opened) and not all(opened)


def test_a_misspelt_key_is_refused_with_a_suggestion() -> None:
    """No unknown key is ignored, except names that a user chooses."""
    free = {"axes", "elements", "parameters", "layout", "values", "packages"}
    tried = 0
    for at in _places(DATA):
        if not at or not isinstance(at[-1], str) or (len(at) > 1 and at[-2] in free) or at[0] == "layout":
            continue
        holder = DATA
        for key in at[:-1]:
            holder = holder[key]
        spelt = {(k + "_" if k == at[-1] else k): v for k, v in holder.items()}
        tried += 1
        assert _read(_with(DATA, at[:-1], spelt)) is None, f"{at} may be misspelt"
    assert tried > 50


@pytest.mark.parametrize("length", [0, 1, 10, 100, len(TEXT) // 2, len(TEXT) - 1])
def test_a_truncated_file_is_refused(tmp_path: Path, length: int) -> None:
    path = tmp_path / "cut.json"
    path.write_text(TEXT[:length])
    refused(lambda: dd.load(path), DocumentError, str(path), "is not JSON", "line 1")


RAW: dict[str, tuple[bytes, tuple[str, ...]]] = {
    "empty": (b"", ("is not JSON",)),
    "not UTF-8": (b'{"deodar": 1, "name": "\xff\xfe"}', ("is not JSON: it is not text in UTF-8",)),
    "binary": (bytes(range(256)) * 4, ("is not JSON",)),
    "lists without end": (b"[" * 100_000, ("nested deeper than 64 levels",)),
    "lists 100,000 deep": (b"[" * 100_000 + b"]" * 100_000, ("nested deeper than 64 levels",)),
    "objects 100,000 deep": (b'{"a":' * 100_000 + b"1" + b"}" * 100_000, ("nested deeper than 64 levels",)),
    "65 levels": (
        b'{"deodar": 1, "layout": ' + b"[" * 64 + b"]" * 64 + b"}",
        ("nested deeper than 64 levels",),
    ),
    "1e999": (b'{"deodar": 1, "dt": 1e999}', ("holds the number 1e999, which is not finite",)),
    "-1e999": (b'{"deodar": 1, "dt": -1e999}', ("holds the number -1e999, which is not finite",)),
    "NaN": (b'{"deodar": 1, "dt": NaN}', ("holds the number NaN, which is not finite",)),
    "Infinity": (b'{"deodar": 1, "dt": -Infinity}', ("holds the number -Infinity, which is not finite",)),
    "10,000 digits": (b'{"deodar": 1, "dt": ' + b"9" * 10_000 + b"}", ("holds a number of 10000 digits",)),
    "400 digits": (b'{"deodar": 1, "t0": ' + b"9" * 400 + b"}", ("holds a number of 400 digits",)),
    "a key twice": (b'{"deodar": 1, "name": "a", "name": "b"}', ("the key 'name' occurs twice",)),
    "a key twice inside": (
        b'{"deodar": 1, "elements": {"u": {"kind": "Field", "tau": 1, "tau": 2}}}',
        ("elements.u: the key 'tau' occurs twice",),
    ),
    "several keys several times": (
        b'{"deodar": 1, "layout": {"a": [{"b": 1, "b": 2, "b": 3}]}, '
        b'"elements": {"u": {"kind": "Field"}, "u": {"kind": "Field"}}}',
        ("elements: the key 'u' occurs twice", "layout.a.0: the key 'b' occurs 3 times"),
    ),
    "no elements": (b'{"deodar": 1, "name": "a", "axes": {}}', ("elements: is missing", '"elements": {}')),
    "half a character": (b'{"deodar": 1, "name": "\\ud800"}', ("half a character",)),
    "a list": (b"[]", ("is not a deodar document: it holds list",)),
    "a number": (b"5", ("is not a deodar document: it holds int",)),
    "null": (b"null", ("is not a deodar document",)),
    "of another program": (b'{"format": 1, "layers": {}}', ("has no key 'deodar'",)),
    "of another version": (
        b'{"deodar": 5, "elements": {}}',
        ("of version 5; this deodar, ", "reads versions 1 to 4", "pip install --upgrade"),
    ),
    "of a version in words": (b'{"deodar": "1", "elements": {}}', ("is a document of version '1'",)),
    "of no version": (b'{"deodar": true, "elements": {}}', ("is a document of version True",)),
    "an unknown kind": (
        b'{"deodar": 1, "elements": {"u": {"kind": "Feild"}}}',
        ("u: ", "'Feild'", "Did you mean 'Field'?"),
    ),
    "a kernel as an element": (
        b'{"deodar": 1, "elements": {"u": {"kind": "Gaussian"}}}',
        ("u: expected an Element, got a Gaussian",),
    ),
    "a world as an element": (b'{"deodar": 1, "elements": {"u": {"kind": "Picture"}}}', ("got a Picture",)),
    "an element without a kind": (
        b'{"deodar": 1, "elements": {"u": {"tau": 5}}}',
        ("u: needs an object with a kind",),
    ),
    "a misspelt parameter": (
        b'{"deodar": 1, "elements": {"u": {"kind": "Field", "tua": 5}}}',
        ("u.tua: Field has no such parameter", "Did you mean 'tau'?"),
    ),
    "an unknown axis": (
        b'{"deodar": 1, "elements": {"u": {"kind": "Field", "axes": ["x"]}}}',
        ("u.axes", "not among the document's axes"),
    ),
    "an axis upside down": (
        b'{"deodar": 1, "axes": {"x": {"lower": 1, "upper": 0, "samples": 5}}, "elements": {}}',
        ("axes.x: lower 1 is not below",),
    ),
    "an axis without an end": (
        b'{"deodar": 1, "axes": {"x": {"lower": 1, "samples": 5}}, "elements": {}}',
        ("axes.x: needs upper",),
    ),
    "a value out of range": (
        b'{"deodar": 1, "elements": {"u": {"kind": "Field", "tau": 0}}}',
        ("u.tau: is 0, below its lower bound",),
    ),
    "an element twice": (
        b'{"deodar": 1, "elements": {"u": {"kind": "Field"}, "\\"u\\"": {"kind": "Field"}}}',
        ("occurs twice, in two spellings",),
    ),
    "an element in an element": (
        b'{"deodar": 1, "elements": {"u": {"kind": "Field"}, "u.v": {"kind": "Field"}}}',
        ("elements.u.v: lies inside an element",),
    ),
    "an element without a name": (b'{"deodar": 1, "elements": {"": {"kind": "Field"}}}', ("elements",)),
    "an open quotation mark": (
        b'{"deodar": 1, "elements": {"\\"u": {"kind": "Field"}}}',
        ("never closes it",),
    ),
    "an id twice": (
        b'{"deodar": 1, "elements": {"u": {"kind": "Field", "id": "00000001"}, '
        b'"v": {"kind": "Field", "id": "00000001"}}}',
        ("elements.v.id: 00000001 belongs to another element too",),
    ),
    "an id of words": (
        b'{"deodar": 1, "elements": {"u": {"kind": "Field", "id": "../../x"}}}',
        ("elements.u.id", "eight hexadecimal digits"),
    ),
    "a connection from nowhere": (
        b'{"deodar": 1, "elements": {"u": {"kind": "Field"}}, "connections": [{"source": "w", '
        b'"target": "u"}]}',
        ("connections.0: nothing is called 'w'",),
    ),
    "a link to nothing": (
        b'{"deodar": 1, "elements": {"u": {"kind": "Field"}}, "parameters": {"k": {"value": 1, '
        b'"links": ["u.tua"]}}}',
        ("parameters.k", "Did you mean 'tau'?"),
    ),
    "a link to a port": (
        b'{"deodar": 1, "elements": {"u": {"kind": "Field"}}, "parameters": {"k": {"value": 1, '
        b'"links": ["u.output"]}}}',
        ("parameters.k", "is a port, not a parameter"),
    ),
}


@pytest.mark.parametrize("name", RAW)
def test_a_file_without_a_document_is_refused(tmp_path: Path, name: str) -> None:
    content, says = RAW[name]
    path = tmp_path / "bad.json"
    path.write_bytes(content)
    refused(lambda: dd.load(path), DocumentError, str(path), *says)


def test_all_problems_of_a_document_are_listed(tmp_path: Path) -> None:
    path = tmp_path / "bad.json"
    path.write_text(
        json.dumps(
            {
                "deodar": 1,
                "nmae": "x",
                "dt": -1,
                "time_unit": "hours",
                "axes": {"x": {"lower": 0, "upper": 0, "samples": 5}},
                "elements": {
                    "u": {
                        "kind": "Field",
                        "tau": -1,
                        "noise": -1,
                        "kernel": [{"kind": "Gaussian", "sigma": 0}],
                    },
                    "v": {"kind": "Feild"},
                },
                "groups": [5],
            }
        )
    )
    text = refused(lambda: dd.load(path), DocumentError, "9 problems")
    for place in ("nmae", "dt", "time_unit", "axes.x", "u.tau", "u.noise", "u.kernel.0.sigma", "v", "groups"):
        assert f": {place}: " in text or f"{place} " in text, place


def test_a_missing_file_suggests_the_nearest_name(tmp_path: Path) -> None:
    dd.save(dd.Model("m"), tmp_path / "selection.json")
    refused(
        lambda: dd.load(tmp_path / "selecton.json"),
        DocumentError,
        "there is no such file",
        "Did you mean 'selection.json'?",
    )


@pytest.mark.parametrize(
    "path", [".", "", "no/such/folder/file.json", "a" * 300, "nul\0byte.json", 5, None, b"bytes"]
)
def test_a_path_without_a_regular_file_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, path: Any
) -> None:
    monkeypatch.chdir(tmp_path)
    with pytest.raises(DocumentError) as caught:
        dd.load(path)
    assert (
        "no such file" in str(caught.value)
        or "not a file" in str(caught.value)
        or "path of a file" in str(caught.value)
        or "cannot" in str(caught.value)
    )


def test_a_file_that_is_too_large_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(document_files, "MOST_BYTES", 1000)
    path = tmp_path / "long.json"
    path.write_text(" " * 2000)
    refused(lambda: dd.load(path), DocumentError, "a document has at most")


def test_a_named_pipe_is_refused_as_a_document(tmp_path: Path) -> None:
    import os

    path = tmp_path / "pipe.json"
    os.mkfifo(path)
    refused(lambda: dd.load(path), DocumentError, "is not a file")


CHANGES: dict[str, Callable[[dict[str, Any]], object]] = {
    "a loop of couplings": lambda d: d["connections"].append({"source": "gate", "target": "w"}),
    "another shape of weights": lambda d: d["elements"]["w"].update(axes=["hue"]),
    "an unconnected coupling": lambda d: d.update(connections=[]),
}


@pytest.mark.parametrize("name", CHANGES)
def test_a_document_that_loads_and_cannot_run_fails_check(name: str) -> None:
    document = json.loads(TEXT)
    CHANGES[name](document)
    model = dd.Model(document=document_files.from_data(document, ARRAYS))
    assert model.check()
    for problem in model.check():
        paragraph(str(problem))
