"""The array file beside a document: it must be its own, in its folder, complete, and contain plain
numbers.
"""

from __future__ import annotations

import hashlib
import io
import json
import pickle
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import deodar as dd
from deodar.couplings.weights import Weighting
from deodar.errors import DocumentError, OutputExists
from deodar.model import document_files
from tests.deodar.errors.refused import refused

X = dd.Axis("x", 0, 10, samples=11)


class Trap:
    """An object that runs code when it is unpickled."""

    def __reduce__(self) -> Any:
        return (print, ("the trap was sprung",))


@pytest.fixture
def saved(tmp_path: Path) -> Path:
    """Save a document with an array file into a folder of its own."""
    folder = tmp_path / "mine"
    folder.mkdir()
    model = dd.Model("m")
    u = model.add(dd.Field("u", [X]))
    u >> Weighting(np.linspace(0, 1, 11), (X,), name="w") >> u
    dd.save(model, folder / "m.json")
    return folder / "m.json"


def _document(path: Path) -> dict[str, Any]:
    return json.loads(path.read_text())


def _array_file(path: Path) -> Path:
    return path.with_name(_document(path)["arrays"]["file"])


def _point_to(path: Path, name: str, content: bytes | None = None) -> None:
    """Make the document name another array file, with the right hash of its content."""
    document = _document(path)
    document["arrays"]["file"] = name
    if content is not None:
        document["arrays"]["sha256"] = hashlib.sha256(content).hexdigest()
    path.write_text(json.dumps(document))


def _replace(path: Path, content: bytes) -> None:
    _array_file(path).write_bytes(content)
    _point_to(path, _array_file(path).name, content)


def _npz(**arrays: Any) -> bytes:
    buffer = io.BytesIO()
    np.savez(buffer, **arrays, allow_pickle=True)  # type: ignore[arg-type]
    return buffer.getvalue()


def test_the_file_that_was_saved_loads(saved: Path) -> None:
    model = dd.load(saved)
    assert np.array_equal(model.get("w.weights").data, np.linspace(0, 1, 11))
    assert sorted(p.name for p in saved.parent.iterdir()) == sorted([saved.name, _array_file(saved).name])


def test_a_missing_array_file_is_refused(saved: Path) -> None:
    name = _array_file(saved).name
    _array_file(saved).unlink()
    refused(
        lambda: dd.load(saved),
        DocumentError,
        "arrays: the array file",
        name,
        "is missing; it belongs beside the document",
    )


@pytest.mark.parametrize("where", ["parent", "absolute", "below", "backslash", "dots", "dot", "empty"])
def test_an_array_file_outside_of_the_folder_is_refused(saved: Path, where: str) -> None:
    inside = _array_file(saved)
    outside = saved.parent.parent / inside.name
    outside.write_bytes(inside.read_bytes())
    (saved.parent / "sub").mkdir()
    (saved.parent / "sub" / inside.name).write_bytes(inside.read_bytes())
    name = {
        "parent": f"../{inside.name}",
        "absolute": str(outside),
        "below": f"sub/{inside.name}",
        "backslash": f"..\\{inside.name}",
        "dots": "..",
        "dot": ".",
        "empty": "",
    }[where]
    _point_to(saved, name)
    refused(lambda: dd.load(saved), DocumentError, "lies outside the document's folder")


def test_a_symbolic_link_as_array_file_is_refused(saved: Path) -> None:
    inside = _array_file(saved)
    outside = saved.parent.parent / "other.npz"
    outside.write_bytes(inside.read_bytes())
    inside.unlink()
    inside.symlink_to(outside)
    refused(lambda: dd.load(saved), DocumentError, "lies outside the document's folder")


def test_a_folder_as_array_file_is_refused(saved: Path) -> None:
    inside = _array_file(saved)
    inside.unlink()
    inside.mkdir()
    refused(lambda: dd.load(saved), DocumentError, "is missing")


def test_an_array_file_with_another_content_is_refused(saved: Path) -> None:
    content = _array_file(saved).read_bytes()
    _array_file(saved).write_bytes(content[:-1] + bytes([content[-1] ^ 1]))
    refused(
        lambda: dd.load(saved), DocumentError, "not the one this document was saved with: its hash differs"
    )


@pytest.mark.parametrize("keep", [0, 1, 30, 0.5, -1])
def test_a_truncated_array_file_is_refused(saved: Path, keep: float) -> None:
    content = _array_file(saved).read_bytes()
    cut = content[: int(len(content) * keep)] if isinstance(keep, float) else content[:keep]
    _array_file(saved).write_bytes(cut)
    refused(lambda: dd.load(saved), DocumentError, "its hash differs")
    _replace(saved, cut)  # even if the hash is right
    refused(lambda: dd.load(saved), DocumentError, "cannot be read as plain arrays")


CONTENTS: dict[str, tuple[Callable[[], bytes], str]] = {
    "pickled objects": (
        lambda: _npz(array=np.array([Trap()], dtype=object)),
        "cannot be read as plain arrays",
    ),
    "a pickle": (lambda: pickle.dumps(Trap()), "cannot be read as plain arrays"),
    "a pickle inside": (lambda: _zip({"array.npy": pickle.dumps(Trap())}), "cannot be read as plain arrays"),
    "text": (lambda: b"hello", "cannot be read as plain arrays"),
    "one array": (lambda: _npy(np.ones(11)), "cannot be read as plain arrays"),
    "not a number": (lambda: _npz(array=np.array([0.0, np.nan])), "does not hold finite numbers only"),
    "infinite": (lambda: _npz(array=np.array([0.0, np.inf])), "does not hold finite numbers only"),
    "words": (lambda: _npz(array=np.array(["a", "b"])), "does not hold finite numbers only"),
    "complex": (lambda: _npz(array=np.array([1j])), "does not hold finite numbers only"),
    "moments": (
        lambda: _npz(array=np.array(["2020-01-01"], dtype="datetime64[D]")),
        "does not hold finite numbers only",
    ),
    "a record": (lambda: _npz(array=np.zeros(2, dtype=[("a", float)])), "does not hold finite numbers only"),
    "no such array": (
        lambda: _npz(other=np.ones(11)),
        "w.weights: the array 'array' is not in the document's array file",
    ),
    "a shape that lies": (lambda: _zip({"array.npy": _header((10**12,))}), "cannot be read as plain arrays"),
    "a shape below nothing": (lambda: _zip({"array.npy": _header((-5,))}), "cannot be read as plain arrays"),
}


def _npy(array: np.ndarray) -> bytes:
    buffer = io.BytesIO()
    np.save(buffer, array)
    return buffer.getvalue()


def _header(shape: tuple[int, ...]) -> bytes:
    buffer = io.BytesIO()
    np.lib.format.write_array_header_1_0(buffer, {"descr": "<f8", "fortran_order": False, "shape": shape})
    return buffer.getvalue() + b"\0" * 80


def _zip(entries: dict[str, bytes]) -> bytes:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as z:
        for name, content in entries.items():
            z.writestr(name, content)
    return buffer.getvalue()


@pytest.mark.parametrize("name", CONTENTS)
def test_arrays_of_other_types_than_numbers_are_refused(
    saved: Path, name: str, capsys: pytest.CaptureFixture[str]
) -> None:
    make, says = CONTENTS[name]
    _replace(saved, make())
    refused(lambda: dd.load(saved), DocumentError, says)
    assert "sprung" not in capsys.readouterr().out, "nothing in the file was run"


def test_an_array_file_that_expands_too_much_is_refused_before_it_is_read(
    saved: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A small file that unpacks to more memory than the machine has; its directory states its size."""
    monkeypatch.setattr(document_files, "ARRAY_SHARE", 1e-9)
    _replace(saved, _zip({"array.npy": b"\0" * 10_000_000}))
    refused(lambda: dd.load(saved), DocumentError, "the arrays in", "GiB are free")


@pytest.mark.parametrize(
    "entry",
    [
        5,
        [],
        {},
        {"file": "m.npz"},
        {"sha256": "0"},
        {"file": 5, "sha256": "0"},
        {"file": "m.npz", "sha256": "0", "url": "x"},
    ],
)
def test_an_invalid_entry_of_arrays_is_refused(saved: Path, entry: Any) -> None:
    saved.write_text(json.dumps(_document(saved) | {"arrays": entry}))
    refused(lambda: dd.load(saved), DocumentError, "arrays: needs a file and its sha256")


def test_an_existing_array_file_of_the_same_name_is_not_replaced(saved: Path) -> None:
    """Saving beside a foreign file of the same name is refused, and writes nothing."""
    stranger = _array_file(saved)
    model = dd.load(saved)
    saved.unlink()
    stranger.write_bytes(b"a stranger's")
    refused(lambda: dd.save(model, saved), OutputExists, stranger.name, "force=True")
    assert not saved.exists()
    assert stranger.read_bytes() == b"a stranger's"


def test_saving_again_removes_the_previous_array_file(saved: Path) -> None:
    old = _array_file(saved)
    model = dd.load(saved)
    model.set("w.weights", np.linspace(0, 2, 11))
    dd.save(model, saved, force=True)
    assert _array_file(saved) != old
    assert sorted(p.name for p in saved.parent.iterdir()) == sorted([saved.name, _array_file(saved).name])


def test_saving_never_deletes_a_file_that_is_not_an_array_file(saved: Path) -> None:
    """If a document names another file as its arrays, saving over it with force keeps that file."""
    neighbour = saved.with_name("thesis.npz")
    neighbour.write_bytes(b"precious")
    _point_to(saved, neighbour.name)
    model = dd.Model("new")
    dd.save(model, saved, force=True)
    assert neighbour.read_bytes() == b"precious"
