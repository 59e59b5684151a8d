"""The studio, opened by a script on a model."""

from __future__ import annotations

import http.cookiejar
import shutil
import sys
import urllib.request
from pathlib import Path
from typing import Any, cast

import pytest

import deodar as dd
from deodar.errors import DocumentError, OutputError, ParameterError
from deodar_studio import from_script


def model() -> dd.Model:
    """Return a model of one field, with a name that is not one of a file."""
    field_model = dd.Model("my <model>")
    field_model.add(dd.Field("u", [dd.Axis("x", 0, 20, samples=21)]))
    return field_model


def test_a_model_is_opened_and_its_address_is_a_link_until_it_is_stopped() -> None:
    with dd.studio(model(), browser=False, port=0) as opened:
        assert opened.runs, "it returns before the studio has started"
        cookies = urllib.request.HTTPCookieProcessor(http.cookiejar.CookieJar())
        with urllib.request.build_opener(cookies).open(opened.address) as page:
            assert page.status == 200 and "token=" in opened.address
        markup = opened._repr_html_()
        assert f'<a href="{opened.address}"' in markup and "<model>" not in markup
        assert opened.address in repr(opened)
        assert opened.model.document == model().document
        path = opened.path
    assert not opened.runs and "ended" in repr(opened) and "href" not in opened._repr_html_()
    assert not path.parent.exists(), "a document that was not changed is not kept"
    with pytest.raises(OutputError, match="the studio has ended"):
        _ = opened.address


def test_a_document_that_was_saved_is_kept_and_a_failed_start_says_why(tmp_path: Path) -> None:
    opened = dd.studio(model(), browser=False, port=0)
    opened.path.write_text(dd.Model("changed").to_json(), encoding="utf-8")
    opened.stop()
    assert opened.model.name == "changed"
    opened.path.unlink()
    opened.path.parent.rmdir()
    dd.save(model(), tmp_path / "model.json")
    failed = dd.studio(tmp_path / "model.json", browser=False, port=0)
    (tmp_path / "model.json").unlink()
    with pytest.raises(OutputError, match=r"the studio has ended: .*no such file"):
        _ = failed.address
    failed.stop()


@pytest.mark.parametrize(
    ("stated", "options"),
    [
        ({}, []),
        ({"browser": False}, ["--no-browser"]),
        ({"port": 9000}, ["--port", "9000"]),
        ({"browser": False, "port": 0}, ["--no-browser", "--port", "0"]),
    ],
)
def test_the_studio_has_the_options_that_are_stated_and_a_folder_of_its_own(
    stated: dict[str, Any], options: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(from_script, "OpenedStudio", lambda *call: call)
    path, command, folder = cast("Any", dd.studio(model(), **stated))
    assert command == [sys.executable, "-m", "deodar", "studio", str(path), "--trust", *options]
    assert path.parent == folder and [*folder.iterdir()] == [path]
    shutil.rmtree(folder)


def test_what_is_no_model_and_no_port_is_refused() -> None:
    with pytest.raises(ParameterError, match="expected a model or the path of a document, got 5"):
        dd.studio(5)  # type: ignore[arg-type]
    with pytest.raises(ParameterError, match="port is 70000"):
        dd.studio(model(), port=70000)
    with pytest.raises(DocumentError):
        dd.studio("no.json")
