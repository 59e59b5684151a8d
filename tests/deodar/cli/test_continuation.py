"""`deodar continuation`: bifurcations in words, as JSON, and as a diagram."""

from __future__ import annotations

import json

import pytest
from PIL import Image

import deodar as dd
from deodar.cli import main
from tests.deodar.analysis.continuation.models import node, oscillator, rivals


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    dd.save(node(), "node.json")
    return tmp_path


def test_it_prints_values_names_and_sensitivities_and_draws_them(folder, capsys):
    assert main(["continuation", "node.json", "s.amplitude", "-1", "8"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert "steady states over s.amplitude from -1 to 8" in lines[0]
    assert lines[1].split()[0] == "3.9663703" and "detection of u (fold" in lines[1]
    assert "moves by" in lines[2] and "per u.resting_level" in lines[2]
    assert lines[-1] == "Figure: node-continuation-001.png"
    with Image.open(folder / "node-continuation-001.png") as picture:
        assert picture.width > 500


def test_json_has_everything_and_a_switched_branch(folder, capsys):
    dd.save(rivals(101), "rivals.json")
    call = ["continuation", "rivals.json", "u.global_inhibition", "0.3", "0.5", "--one-grid", "--switch"]
    assert main([*call, "--json", "-o", "all.svg"]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert answer["bifurcations"][0]["kind"] == "branch point"
    assert len(answer["switched"]) == 2 * len(answer["bifurcations"]) and answer["figure"] == "all.svg"
    assert (folder / "all.svg").is_file()


def test_the_step_of_a_hopf_point_is_printed(capsys):
    dd.save(oscillator(), "pair.json")
    assert main(["continuation", "pair.json", "e.resting_level", "-1", "1", "--show", "i.output"]) == 0
    assert "with the Euler step 1 at -0.0728882" in capsys.readouterr().out


def test_a_wrong_parameter_is_answered(capsys):
    assert main(["continuation", "node.json", "s.amplitud", "0", "8"]) == 1
    assert "Did you mean 'amplitude'" in capsys.readouterr().err
