"""`deodar draw`: a picture of an architecture, from the command line."""

from __future__ import annotations

import json

import pytest

import deodar as dd
from deodar.cli import main


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    model = dd.Model("node")
    u = model.add(dd.Field("u"))
    u >> dd.Gain(2.0) >> model.add(dd.Field("v", global_inhibition=1.0))
    dd.save(model, "node.json")
    return tmp_path


def test_draw_writes_a_picture_and_prints_its_path(folder, capsys):
    assert main(["draw", "node.json"]) == 0 and (folder / "node-architecture-001.svg").read_text(
        encoding="utf-8"
    ).startswith("<svg")
    assert main(["draw", "node.json", "-o", "a.pdf", "--width", "3.5"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].startswith("Drew node.json into node-architecture-001.svg, ") and lines[1].startswith(
        "Drew node.json into a.pdf, 3.5 x "
    )
    assert main(["draw", "node.json", "-o", "b.svg", "--no-legend", "--json"]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert (
        answer["out"] == "b.svg"
        and len(answer["inches"]) == 2
        and "inhibition" not in (folder / "b.svg").read_text(encoding="utf-8")
    )


def test_draw_replaces_no_file_without_force(folder, capsys):
    assert main(["draw", "node.json", "-o", "a.svg"]) == 0
    assert main(["draw", "node.json", "-o", "a.svg"]) == 1 and "exists already" in capsys.readouterr().err
    assert main(["draw", "node.json", "-o", "a.svg", "--force"]) == 0
    assert (
        main(["draw", "node.json", "-o", "a.gif"]) == 1 and "no format of pictures" in capsys.readouterr().err
    )
    assert main(["draw", "nothing.json"]) == 1
