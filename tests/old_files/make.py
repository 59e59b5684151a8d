"""The script that made the files of `version_1` and `version_2`, with deodar at the last commit that wrote
documents of that version.

    git worktree add --detach OLD 792e504
    PYTHONPATH=OLD/src python tests/old_files/make.py 1 FOLDER
    git -C OLD checkout 85a2d0c
    PYTHONPATH=OLD/src python tests/old_files/make.py 2 FOLDER

`experiment_2` holds the files of an experiment of version 2:

    git -C OLD checkout 24269c2
    PYTHONPATH=OLD/src python tests/old_files/make.py experiment FOLDER

`version_3` holds files in which an empty list of time windows means that a stimulus is always on:

    git -C OLD checkout 2ba7d9e7
    PYTHONPATH=OLD/src python tests/old_files/make.py 3 FOLDER

The files are as those versions wrote them, with one exception: `axis` was removed from the peak position in
`version_1/choice.json`. Version 1 could read documents without it, but always wrote it, so the other files of
this document state the axis.
"""

from __future__ import annotations

import contextlib
import json
import sys
import warnings
from pathlib import Path

import deodar as dd
from deodar.couplings.positions import PeakPosition
from deodar.couplings.weights import Weights
from deodar.elements.changing_stimuli import MovingGaussian
from deodar.elements.stimuli import Boost
from deodar.elements.world_ports import Motor
from deodar.experiments.actions import Move, Place, Remove
from deodar.experiments.events import Appears, Crosses
from deodar.experiments.experiment import Experiment
from deodar.experiments.factor import Factor
from deodar.experiments.measures import Measure
from deodar.model.kept_presets import KeptPreset, with_presets
from deodar.recording import files
from deodar_studio.files.state_store import StateStore, StoredExperiment


def choice(version: int) -> dd.Model:
    """Return a field in which an input creates a peak, the position of the peak, and weights (an array)
    onto two nodes; the input moves in version 2.
    """
    x = dd.Axis("x", 0, 20, 21)
    two = dd.Axis("two", 0, 1, 2)
    model = dd.Model("choice")
    u = model.add(
        dd.Field(
            "u", [x], tau=10, resting_level=-5, kernel=[dd.Gaussian(1.2, 2)], global_inhibition=0.6, noise=1.0
        )
    )
    if version == 1:
        model.add(dd.GaussianStimulus("input", [x], center=8, sigma=2, amplitude=7, windows=[(10, 60)])) >> u
    else:
        moving = {"path": [[0, 8], [40, 12]]}  # the name of `waypoints` in versions 1 and 2
        model.add(MovingGaussian("input", [x], sigma=2, amplitude=7, windows=[(10, 60)], **moving)) >> u
    u >> model.add(PeakPosition(x, name="place"))
    weights = [[round(0.1 * ((3 * i + j) % 7), 1) for i in range(21)] for j in range(2)]
    u >> model.add(Weights(weights, [two], name="map")) >> model.add(dd.Field("n", [two], tau=10))
    return model


def objects(folder: Path) -> None:
    """Write an experiment in which objects of the world are placed, moved and removed, and its folder after
    the first of its two trials.
    """
    model = dd.Model("straight")
    model.describe(time_unit="1 = 64 ms")
    for wheel in ("left", "right"):
        model.add(Boost(f"go {wheel}", amplitude=500.0)) >> model.add(Motor(wheel, motor=wheel))
    box = {"thing": "box", "center": (0.4, 0.3)}  # the name of `object` in versions 1 and 2
    experiment = Experiment(
        "objects",
        model,
        dd.TrialPlan(
            100,
            events=[Crosses("touched", "touching", level=0.5, ends=False)],
            actions=[
                Place(10, size=(0.04, 0.2), **box),
                Move(60, thing="box", center=(0.4, 0.7)),
                Remove(80, "box"),
            ],
            every=5,
        ),
        trials=2,
        world="arena:blocks",
    )
    experiment.save(folder / "experiment.json")

    def stop(standing: object) -> None:
        if standing.rows:  # type: ignore[attr-defined]
            raise KeyboardInterrupt

    with contextlib.suppress(KeyboardInterrupt):
        experiment.run(folder / "stopped", on=dd.Resources(progress=stop))


def always(folder: Path) -> None:
    """Write files of a node with two inputs, one always on and one for a time, and of an experiment whose
    factor and action switch the second to always on.
    """
    model = dd.Model("always")
    node = model.add(dd.RateNode("n", tau=10, resting_level=-2))
    model.add(Boost("lasting", amplitude=1.0)) >> node
    cue = model.add(Boost("cue", amplitude=3.0, windows=[(10, 60)]))
    cue >> node
    values = {cue.id: {"windows": [], "amplitude": 2.0}}
    model.commit(with_presets(model.document, [KeptPreset("always on", "", values)]))
    dd.save(model, folder / "always.json")
    dd.save(model, folder / "always.deodar")
    files.save_record(dd.simulate(model, 100, record=["n.activation"], every=5), folder / "record.nc")
    session = dd.Session(model)
    with session.record(folder / "session.zarr", ["n.activation"], every=5):
        session.run(20)
        dd.save_snapshot(session.snapshot(), folder / "snapshot.npz")
        session.set("cue.windows", [])
        session.run(80)
    experiment = Experiment(
        "always",
        model,
        dd.TrialPlan(
            100,
            watch=["n.activation"],
            actions=[dd.Set(80, "cue.windows", [])],
            measures=[Measure("end", "n.activation", "mean")],
            every=5,
        ),
        trials=2,
        factors=[
            Factor("when", [[], [[20, 40]]], "cue.windows"),
            Factor("how", {"weak": {"lasting.amplitude": 1.0, "lasting.windows": []}}),
        ],
        precision="float64",
    )
    experiment.save(folder / "experiment.json")

    def stop(trials: int) -> None:
        if trials:
            raise KeyboardInterrupt

    experiment.run(folder / "whole")
    with contextlib.suppress(KeyboardInterrupt):
        experiment.run(folder / "stopped", on=dd.Resources(progress=stop))
    plain = experiment.to_data()
    del plain["experiment"]
    stored = StoredExperiment(plain, "experiment.json")
    StateStore(folder / "state").store_edits("0123456789abcdef", model.document, "always.json", stored)


def main(version: str, folder: Path) -> None:
    """Write every kind of file."""
    if version == "experiment":
        return objects(folder)
    if version == "3":
        return always(folder)
    model = choice(int(version))
    dd.save(model, folder / "choice.json")
    if version == "1":
        document = json.loads((folder / "choice.json").read_text())
        del document["elements"]["place"]["axis"]
        (folder / "choice.json").write_text(json.dumps(document, indent=2) + "\n")
    model = dd.load(folder / "choice.json")
    dd.save(model, folder / "choice.deodar")
    record = dd.simulate(
        model, 40, seed=3, record=["u.activation", "place.output", "n.activation"], every=10, trials=2
    )
    files.save(record, folder / "record.nc")
    if version == "1":
        files.save(record, folder / "record.zarr")
    experiment = Experiment(
        "choice",
        model,
        dd.TrialPlan(
            80,
            watch=["n.activation"],
            events=[Appears("detected", "u", threshold=1.0)],
            measures=[Measure("end", "u.activation", "mean")],
            every=5,
        ),
        trials=4,
        factors=[Factor("strength", [6.0, 7.0], "input.amplitude")],
        seed=2,
        precision="float64",
    )
    experiment.save(folder / "experiment.json")

    def stop(standing: object) -> None:
        if standing.rows >= 3:  # type: ignore[attr-defined]
            raise KeyboardInterrupt

    experiment.run(folder / "whole")
    import deodar.experiments.setup as bench

    bench.MOST_COPIES = 2
    try:
        experiment.run(folder / "stopped", on=dd.Resources(progress=stop))
    except KeyboardInterrupt:
        rows = folder / "stopped" / "trials.jsonl"
        rows.write_bytes(rows.read_bytes()[:-40])
    StateStore(folder / "state").store_edits("0123456789abcdef", model.document, "choice.json")


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    main(sys.argv[1], Path(sys.argv[2]))
