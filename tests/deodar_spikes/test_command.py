"""`deodar neuromorphic`, and `deodar export nir`."""

from __future__ import annotations

import json
from pathlib import Path

import nir
import pytest

import deodar as dd
from deodar.cli import main


def neurons(path: Path) -> int:
    """Return the number of neurons in a file of NIR."""
    nodes = nir.read(path).nodes.values()
    return sum(node.v_threshold.size for node in nodes if isinstance(node, nir.CubaLIF))


@pytest.fixture
def workspace(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    model = dd.Model("small", dt=0.5)
    u = model.add(dd.Field("u", [dd.Axis("x", 0, 9, samples=10)], 10, -5.0))
    model.add(dd.BoxStimulus("s", [dd.Axis("x", 0, 9, samples=10)], 4, 3, 8, windows=[(20, 60)])) >> u
    dd.save(model, tmp_path / "small.json")
    return tmp_path


def test_a_model_is_written_as_a_file_of_nir(workspace: Path, capsys: pytest.CaptureFixture[str]) -> None:
    call = ["export", "nir", "small.json", "-o", "small.nir", "--neurons", "4", "--chip", "digital-8-bit"]
    assert main([*call, "--json"]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert neurons(workspace / "small.nir") == 40 and answer["tool"] == "nir"
    assert any("8 bits" in line["why"] for line in answer["lines"])
    assert main([*call, "--force", "--tonic"]) == 0
    assert neurons(workspace / "small.nir") == 44
    assert "40 neurons" not in capsys.readouterr().err


def test_options_of_neurons_are_refused_elsewhere(
    workspace: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit):
        main(["export", "cosivina", "small.json", "--neurons", "4"])
    assert "--neurons is about spiking neurons" in capsys.readouterr().err
    assert main(["export", "cosivina", "small.json"]) == 0, "the default of --tonic is no option"
    assert main(["export", "nir", "small.json", "--chip", "digital"]) == 1
    assert "there is no chip 'digital'" in capsys.readouterr().err


def test_a_comparison_prints_a_table_and_draws(workspace: Path, capsys: pytest.CaptureFixture[str]) -> None:
    call = ["neuromorphic", "compare", "small.json", "--trials", "3", "--duration", "100", "--no-norse"]
    assert main([*call, "-o", "both.png"]) == 0
    printed = capsys.readouterr().out
    assert "200 neurons" in printed and "detection after" in printed and "forgetting after" in printed
    assert (workspace / "both.png").stat().st_size > 5000
    assert main([*call, "--json", "--mismatch", "0.1", "--seed", "3"]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert answer["elements"]["u"]["spikes"]["winner"]["value"] == 1.0 and answer["neurons"] == 200


def test_chips_are_listed_with_sources(workspace: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["neuromorphic", "chips"]) == 0
    printed = capsys.readouterr().out
    assert "digital-8-bit" in printed and "MAX_COMPARTMENTS" in printed
    assert main(["neuromorphic", "chips", "--json"]) == 0
    assert len(json.loads(capsys.readouterr().out)["chips"]) == 3


def test_a_comparison_without_a_file_is_an_invalid_call(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(["neuromorphic", "compare"])
    assert "the model is missing" in capsys.readouterr().err
