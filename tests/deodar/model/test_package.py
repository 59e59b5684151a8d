"""A document and its arrays in one file: they are read unchanged, and other content is refused."""

from __future__ import annotations

import json
import zipfile
from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np
import pytest

import deodar as dd
from deodar.elements.stimuli import Pattern
from deodar.errors import DocumentError, OutputExists
from deodar.model import document_files, package

X = dd.Axis("x", 0, 10, samples=11)


def model(arrays: bool = True) -> dd.Model:
    """Return a small model, with an array or without."""
    model = dd.Model("packed")
    model.add(dd.Field("u", [X]))
    if arrays:
        model.add(Pattern("p", [X], np.linspace(0, 1, 11)))
    return model


@pytest.mark.parametrize("arrays", [True, False])
def test_one_file_holds_the_document_and_its_arrays(arrays: bool, tmp_path: Path) -> None:
    dd.save(model(arrays), tmp_path / "a.deodar")
    assert [p.name for p in tmp_path.iterdir()] == ["a.deodar"]
    assert dd.load(tmp_path / "a.deodar").document == model(arrays).document


def test_any_zip_tool_unpacks_it_to_a_document(tmp_path: Path) -> None:
    dd.save(model(), tmp_path / "a.deodar")
    with zipfile.ZipFile(tmp_path / "a.deodar") as z:
        z.extractall(tmp_path / "out")
    assert dd.load(tmp_path / "out" / "a.json").document == model().document


def test_the_same_model_gives_the_same_bytes(tmp_path: Path) -> None:
    dd.save(model(), tmp_path / "a.deodar")
    first = (tmp_path / "a.deodar").read_bytes()
    dd.save(model(), tmp_path / "a.deodar", force=True)
    assert (tmp_path / "a.deodar").read_bytes() == first
    with pytest.raises(OutputExists, match="exists already"):
        dd.save(model(), tmp_path / "a.deodar")


def test_a_package_is_recognised_by_its_content(tmp_path: Path) -> None:
    dd.save(model(), tmp_path / "a.deodar")
    (tmp_path / "a.deodar").rename(tmp_path / "a.json")
    assert dd.load(tmp_path / "a.json").document == model().document


# ---------------------------------------------------------------------------------------------- hostile files


def parts() -> dict[str, bytes]:
    """Return the entries of a valid package."""
    text, packed = document_files.dumps(model().document, "a")
    assert packed is not None
    return {"a.json": text.encode(), json.loads(text)["arrays"]["file"]: packed}


def archive(path: Path, entries: Mapping[str, bytes] | list[tuple[str, bytes]]) -> Path:
    """Write a zip file of these entries."""
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as z:
        for name, content in entries.items() if isinstance(entries, Mapping) else entries:
            z.writestr(name, content)
    return path


def longer(path: Path) -> Path:
    """Write a package whose table of contents understates the size of the document."""
    archive(path, {"a.json": b" " * 5000 + b"{}"})
    content = bytearray(path.read_bytes())
    at = content.rindex(b"PK\x01\x02") + 24
    content[at : at + 4] = (10).to_bytes(4, "little")
    path.write_bytes(bytes(content))
    return path


def misplaced(path: Path) -> Path:
    """Write a package whose table of contents states that it lies further back than it does."""
    content = bytearray(archive(path, parts()).read_bytes())
    at = content.rindex(b"PK\x05\x06") + 16
    content[at : at + 4] = (int.from_bytes(content[at : at + 4], "little") + 1000).to_bytes(4, "little")
    path.write_bytes(bytes(content))
    return path


HOSTILE: dict[str, tuple[Callable[[Path], object], str]] = {
    "cut off": (lambda p: p.write_bytes(archive(p, parts()).read_bytes()[:-30]), "is damaged"),
    "a misplaced table": (misplaced, "places 'a.json' before its beginning"),
    "an understated size": (longer, "is damaged"),
    "nothing in it": (lambda p: archive(p, {}), "holds no document"),
    "no document": (lambda p: archive(p, {"a.npz": b"x"}), "holds no document"),
    "two documents": (lambda p: archive(p, {**parts(), "b.json": b"{}"}), "holds 2 documents"),
    "something else": (
        lambda p: archive(p, {**parts(), "run.py": b"x"}),
        "holds 'run.py', which the document does not name",
    ),
    "a path upwards": (lambda p: archive(p, {"../a.json": b"{}"}), "holds '../a.json'"),
    "an absolute path": (lambda p: archive(p, {"/a.json": b"{}"}), "holds '/a.json'"),
    "a path of Windows": (lambda p: archive(p, {"C:\\a.json": b"{}"}), "holds 'C:"),
    "a folder": (lambda p: archive(p, {"in/a.json": b"{}"}), "holds 'in/a.json'"),
    "the arrays are missing": (lambda p: archive(p, {"a.json": parts()["a.json"]}), "is missing"),
    "other arrays": (
        lambda p: archive(p, {n: c if n == "a.json" else c[::-1] for n, c in parts().items()}),
        "its hash differs",
    ),
    "a bomb": (lambda p: archive(p, {"a.json": b" " * (document_files.MOST_BYTES + 1)}), "at most 64"),
}


@pytest.mark.parametrize("damage", HOSTILE)
def test_hostile_packages_are_refused(damage: str, tmp_path: Path) -> None:
    make, says = HOSTILE[damage]
    path = tmp_path / "a.deodar"
    make(path)
    with pytest.raises(DocumentError, match=says.replace("(", r"\(").replace(".", r"\.")) as caught:
        dd.load(path)
    assert str(path) in str(caught.value)
    assert [p.name for p in tmp_path.iterdir()] == ["a.deodar"]


@pytest.mark.filterwarnings("ignore:Duplicate name")
def test_a_package_with_a_duplicate_name_is_refused(tmp_path: Path) -> None:
    archive(tmp_path / "a.deodar", [("a.json", b"{}"), ("a.json", b"{}")])
    with pytest.raises(DocumentError, match="twice"):
        dd.load(tmp_path / "a.deodar")


def test_arrays_that_would_not_fit_are_refused_before_they_are_read(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    dd.save(model(), tmp_path / "a.deodar")
    monkeypatch.setattr(document_files, "ARRAY_SHARE", 1e-12)
    with pytest.raises(DocumentError, match="GiB are free"):
        dd.load(tmp_path / "a.deodar")


def test_encrypted_files_are_refused(tmp_path: Path) -> None:
    path = archive(tmp_path / "a.deodar", parts())
    content = bytearray(path.read_bytes())
    at = content.index(b"PK\x01\x02") + 8
    content[at] |= 1
    path.write_bytes(bytes(content))
    with pytest.raises(DocumentError, match="encrypted"):
        dd.load(path)


def test_a_package_begins_with_the_signature_of_zip_files(tmp_path: Path) -> None:
    dd.save(model(), tmp_path / "a.deodar")
    assert (tmp_path / "a.deodar").read_bytes().startswith(package.MAGIC)
