"""Files are recognised by their content."""

from __future__ import annotations

from pathlib import Path

import pytest

import deodar as dd
from deodar.errors import DocumentError
from deodar.importers.opening import read, tool_of
from deodar.importers.tools import IMPORTERS
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
