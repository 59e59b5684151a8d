"""Versions agree, the sdist is small, and what only a person can give is blank where RELEASING.md says so."""

from __future__ import annotations

import json
import re
import tarfile
import tomllib
import zipfile
from pathlib import Path

import pytest
from packaging.requirements import Requirement

import deodar
from tests.house.source import ROOT, texts

import release  # isort: skip (a script of `tools`, which tests.house.source puts on the path)

PAGE_MOST = 1_150_000
"""Bytes of the built page in an archive, which tests do not wait for; it has 1.07 MB."""


def _read(name: str) -> str:
    return (ROOT / name).read_text(encoding="utf-8")


def test_the_version_is_the_newest_of_the_changelog_and_that_of_citations() -> None:
    sections = re.findall(r"^## \[?([\w.]+)\]?", _read("CHANGELOG.md"), re.MULTILINE)
    assert next(name for name in sections if name != "Unreleased") == deodar.__version__
    assert re.findall(r"^version: (\S+)$", _read("CITATION.cff"), re.MULTILINE) == [deodar.__version__]
    assert json.loads(_read("codemeta.json"))["version"] == deodar.__version__


def test_the_package_to_copy_accepts_this_version_and_the_manual_shows_its_bounds() -> None:
    [bounds] = tomllib.loads(_read("examples/package/pyproject.toml"))["project"]["dependencies"]
    assert Requirement(bounds).specifier.contains(deodar.__version__)
    assert f'dependencies = ["{bounds}"]' in _read("docs/adding-an-element.md")


def test_both_distributions_have_the_same_licence() -> None:
    assert _read("native/LICENSE") == _read("LICENSE")


def test_an_sdist_is_small_and_has_what_builds_and_tests_deodar() -> None:
    files = release.sdist_files()
    assert {"LICENSE", "pyproject.toml", "studio/.npmrc", "studio/hook.py", "tests/conftest.py"} <= set(files)
    assert not [name for name in files if name.startswith((".ci", "docs/pictures", "evidence", "native"))]
    assert release.packed(files) + PAGE_MOST < release.MOST[".tar.gz"]
    build = tomllib.loads(_read("pyproject.toml"))["tool"]["hatch"]["build"]
    assert set(build["artifacts"]) < set(build["targets"]["sdist"]["artifacts"]), "the page would be left out"


def test_every_blank_is_in_the_files_that_it_names_and_in_no_other() -> None:
    places = release.blanks()
    table = release.GUIDE.read_text(encoding="utf-8").partition("\n## Steps")[0]
    assert table.count("\n| `") == len(places), "a row is not read"
    read = {path.relative_to(ROOT).as_posix(): path.read_text(encoding="utf-8") for path in texts()}
    del read[release.GUIDE.name]
    for text, files in places.items():
        assert sorted(name for name, content in read.items() if text in content) == sorted(files), text
    invalid = "deodar.inva" + "lid"
    for name, content in read.items():
        listed = sum(content.count(text) for text in places if invalid in text)
        assert content.count(invalid) == listed, f"{name} has a blank that RELEASING.md does not name"


def test_blanks_that_are_left_are_printed(capsys: pytest.CaptureFixture[str]) -> None:
    assert release.main(["blanks"]) == (1 if release.blanks() else 0)
    assert capsys.readouterr().out.count("\n") == len(release.blanks())


def test_a_distribution_that_is_too_large_or_has_no_page_is_found(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    wheel, sdist = tmp_path / "deodar-1-py3-none-any.whl", tmp_path / "deodar-1.tar.gz"
    with zipfile.ZipFile(wheel, "w") as file:
        file.writestr("deodar_studio/static/index.html", "")
    tarfile.open(sdist, "w:gz").close()
    assert list(release.judged(wheel)) == []
    assert list(release.judged(sdist)) == [f"{sdist.name} has no page of the studio: is DEODAR_NO_PAGE set?"]
    monkeypatch.setitem(release.MOST, ".whl", 100)
    assert list(release.judged(wheel)) == [f"{wheel.name} has {wheel.stat().st_size} bytes, more than 100"]


def test_a_folder_with_another_build_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "deodar-0.tar.gz").touch()
    assert release.main(["build", str(tmp_path)]) == 1
    assert "is not empty" in capsys.readouterr().out
