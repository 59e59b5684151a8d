"""`deodar script`: a Python script that makes the same document, from the command line."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

import deodar as dd
from deodar.cli import main


def test_the_script_writes_the_same_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    model = dd.Model("two nodes")
    model.add(dd.Field("u")) >> dd.Gain(2.0) >> model.add(dd.Field("v", global_inhibition=1.0))
    dd.save(model, "nodes.json")
    assert main(["script", "nodes.json"]) == 0
    script = capsys.readouterr().out
    assert main(["script", "nodes.json", "--out", "nodes.py"]) == 0
    assert capsys.readouterr().out == "Wrote nodes.py. Type: python nodes.py\n"
    assert Path("nodes.py").read_text(encoding="utf-8") == script
    assert main(["script", "nodes.json", "--json"]) == 0
    assert json.loads(capsys.readouterr().out) == {"out": None, "script": script}
    assert main(["script", "nodes.json", "-o", "nodes.py"]) == 1
    assert "exists already" in capsys.readouterr().err
    subprocess.run([sys.executable, "nodes.py"], check=True)
    assert Path("nodes-2.json").read_bytes() == Path("nodes.json").read_bytes()
    before = Path("nodes.json").read_bytes()
    assert main(["script", "nodes.json", "-o", "nodes.json", "--force"]) == 1
    assert "is the document itself" in capsys.readouterr().err
    assert Path("nodes.json").read_bytes() == before
