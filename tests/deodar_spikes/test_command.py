"""`deodar neuromorphic`, and `deodar export nir`."""

from __future__ import annotations

from pathlib import Path

import nir
import numpy as np
import pytest

import deodar as dd
from deodar_spikes.figure import spikes_figure
from tests.command_line import typed


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


def test_a_model_is_written_as_a_file_of_nir(workspace: Path) -> None:
    call = "export nir small.json -o small.nir --neurons 4 --chip digital-8-bit"
    command = typed(call, "--json")
    assert command.status == 0 and command.json["tool"] == "nir"
    assert neurons(workspace / "small.nir") == 40
    assert any("8 bits" in line["why"] for line in command.json["lines"])
    tonic = typed(call, "--force --tonic")
    assert tonic.status == 0 and neurons(workspace / "small.nir") == 44
    assert "40 neurons" not in command.err + tonic.err


@pytest.mark.usefixtures("workspace")
def test_options_of_neurons_are_refused_elsewhere() -> None:
    refused = typed("export cosivina small.json --neurons 4")
    assert refused.status == 2 and "--neurons is about spiking neurons" in refused.err
    assert typed("export cosivina small.json").status == 0, "the default of --tonic is no option"
    unknown = typed("export nir small.json --chip digital")
    assert unknown.status == 1 and "there is no chip 'digital'" in unknown.err


def test_a_comparison_prints_a_table_and_draws(workspace: Path) -> None:
    call = "neuromorphic compare small.json --trials 3 --duration 100 --no-norse"
    drawn = typed(call, "-o both.png")
    assert drawn.status == 0
    assert all(words in drawn.out for words in ("200 neurons", "detection after", "forgetting after"))
    assert (workspace / "both.png").stat().st_size > 5000
    command = typed(call, "--json --mismatch 0.1 --seed 3")
    assert command.status == 0 and command.json["neurons"] == 200
    assert command.json["elements"]["u"]["spikes"]["winner"]["value"] == 1.0


@pytest.mark.usefixtures("workspace")
def test_chips_are_listed_with_sources() -> None:
    chips = typed("neuromorphic chips")
    assert chips.status == 0 and "digital-8-bit" in chips.out and "MAX_COMPARTMENTS" in chips.out
    command = typed("neuromorphic chips --json")
    assert command.status == 0 and len(command.json["chips"]) == 3


def test_a_figure_has_a_row_for_each_element_and_a_column_for_each_run() -> None:
    outputs = {"field": np.zeros((5, 3), np.float32), "node": np.ones((5, 1), np.float32)}
    figure = spikes_figure({"rates": outputs, "spikes": outputs}, np.arange(5.0), "ms")
    panels, (scale,) = figure.axes[:4], figure.axes[4:]
    assert [axes.get_title() for axes in panels] == ["rates", "spikes", "", ""]
    assert [axes.get_ylabel() for axes in panels] == ["field", "", "node", ""]
    assert [axes.get_xlabel() for axes in panels] == ["", "", "time (ms)", "time (ms)"]
    assert scale.get_ylabel() == "output"


def test_a_comparison_without_a_file_is_an_invalid_call() -> None:
    command = typed("neuromorphic compare")
    assert command.status == 2 and "the model is missing" in command.err
