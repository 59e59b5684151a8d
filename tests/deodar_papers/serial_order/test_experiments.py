"""The experiment files of the cases that the paper does not have."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import pytest

import deodar as dd
from deodar.cli import main
from deodar.experiments.actions import Move, Place, Remove, Set
from deodar_papers.serial_order import experiments
from deodar_papers.serial_order.colours import away, hue_of
from deodar_papers.serial_order.conditions import conditions


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with the files that the demonstration writes."""
    out = tmp_path_factory.mktemp("cases") / "out"
    assert main(["demo", "serial-order", "--experiments", "--out", str(out)]) == 0
    return out


@pytest.mark.parametrize("name", experiments.CASES)
def test_an_experiment_can_be_run_and_teaches_the_sequence_of_its_condition(folder: Path, name: str) -> None:
    experiment, c = dd.Experiment.load(folder / f"{name}.json"), conditions(False)[name]
    assert experiment.check() == [] and experiment.trials == 50
    actions = [a for a in experiment.plan.actions if isinstance(a, Place) and a.object == experiments.SHOWN]
    removed = [a for a in experiment.plan.actions if isinstance(a, Remove)]
    taught = len("".join(c.pair(0))) if name.startswith("cued") else len(c.sequence(0))
    assert (len(actions), len(removed)) == (2 * taught, taught)
    [begins] = [a.at for a in experiment.plan.actions if isinstance(a, Set) and a.path == "mode"]
    assert float(begins) > max(float(a.at) for a in removed)  # type: ignore[arg-type]
    assert sum(isinstance(a, Move) for a in experiment.plan.actions) == (name == "carried")
    cues = [a for a in experiment.plan.actions if isinstance(a, Set) and a.path == "cue"]
    assert len(cues) == {"cued": 2, "cued-changed": 3}.get(name, 0)


def test_a_robot_that_is_carried_elsewhere_completes_its_sequence(folder: Path) -> None:
    experiment = dataclasses.replace(dd.Experiment.load(folder / "carried.json"), trials=1)
    rows = experiment.run()
    assert rows.outcome.values.tolist() == ["complete"]
    sequence = conditions(False)["carried"].sequence(0)
    for k, letter in enumerate(sequence, 1):
        assert away(float(rows[f"colour {k}"].item()), hue_of(letter)) <= 5
