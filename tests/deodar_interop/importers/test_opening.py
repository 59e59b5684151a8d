"""Files are recognised by their content."""

from __future__ import annotations

from pathlib import Path

import pytest

import deodar as dd
from deodar.errors import DocumentError
from deodar.importers import conversion
from deodar.importers._beside import in_folder
from deodar.importers.opening import read, tool_of
from deodar.importers.tools import IMPORTERS
from deodar.model import document_files
from tests.deodar_interop.importers.cosivina.files import SAMPLES


def test_importers_are_found_in_their_folders():
    assert "cosivina" in IMPORTERS
    assert all(callable(tool.sniff) and callable(tool.read) for tool in IMPORTERS.values())


def test_documents_of_deodar_need_no_importer(tmp_path):
    model = dd.Model("own")
    model.add(dd.Field('"simulator": {', [dd.Axis("x", 0, 1, samples=3)]))
    dd.save(model, tmp_path / "own.json")
    assert tool_of(tmp_path / "own.json") is None
    assert dd.load(tmp_path / "own.json").document == model.document
    with pytest.raises(DocumentError, match=r"own\.json: is not a file of a tool.*Tools: cedar, cosivina"):
        read(tmp_path / "own.json")


def test_the_name_of_a_file_does_not_matter(tmp_path):
    copy = tmp_path / "model.of.mine"
    copy.write_bytes(SAMPLES[0].read_bytes())
    assert dd.load(copy).name == "model.of"


@pytest.mark.parametrize("path", ["absent.json", Path("absent.json"), ".", 3, None, "\0"])
def test_a_path_without_a_file_is_an_error(path, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(DocumentError):
        dd.load(path)


@pytest.mark.parametrize("sample", SAMPLES, ids=lambda path: path.name)
def test_a_child_converts_a_file_as_this_process_does(sample: Path):
    """Document, texts and trust pass, and the report as a whole."""
    direct = IMPORTERS["cosivina"].read(sample.read_bytes(), sample.name, False, in_folder(sample.parent))
    imported = read(sample)
    assert imported.model.document == direct.model.document and imported.report == direct.report
    assert document_files.dumps(imported.model.document) == document_files.dumps(direct.model.document)
    assert imported.model.trusted


def test_a_file_that_keeps_its_importer_is_an_error_that_names_it(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(conversion, "SECONDS", 0.0)
    with pytest.raises(DocumentError, match=f"{SAMPLES[0].name}: cannot be read: it takes longer than 0 s"):
        dd.load(SAMPLES[0])
