"""Arguments that are objects: a dict, or another object, is refused by name where it is given."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import deodar as dd
from deodar.errors import ParameterError

RECORDING = Path(__file__).parents[1] / "deodar_robots" / "event_file" / "one.aedat4"


def model() -> dd.Model:
    node_model = dd.Model("node")
    node_model.add(dd.Field("u", [], tau=10, resting_level=-1.0))
    return node_model


CALLS: dict[str, tuple[str, str, Callable[[Any], object]]] = {
    "physics of an arena": ("physics", "ArenaPhysics", lambda x: dd.Arena(physics=x)),
    "noise of an arena": ("noise", "ArenaNoise", lambda x: dd.Arena(noise=x)),
    "camera of an eye": ("camera", "EventCamera", lambda x: dd.Eye(camera=x)),
    "pan-tilt unit": ("pan_tilt", "PanTilt", lambda x: dd.Eye(pan_tilt=x)),
    "screen": ("screen", "EyeScreen", lambda x: dd.Eye(screen=x)),
    "camera of a file": ("camera", "EventCamera", lambda x: dd.EventFile(RECORDING, camera=x)),
    "cameras of a scene": ("cameras", "MuJoCoCameras", lambda x: dd.MuJoCo("table", cameras=x)),
    "plan of trials": ("plan", "TrialPlan", lambda x: dd.Trials(model(), x)),
    "place of a record": ("out", "Output", lambda x: dd.simulate(model(), 5, out=x)),
    "start of a rollout": ("start", "RolloutStart", lambda x: dd.rollout(dd.dynamics(model()), 3, start=x)),
    "options of spikes": ("options", "SpikingOptions", lambda x: dd.compare_spikes(model(), 5, options=x)),
    "resources of a run": ("on", "Resources", lambda x: dd.simulate(model(), 5, on=x)),
    "resources of a session": ("on", "Resources", lambda x: dd.Session(model(), on=x)),
    "resources of an experiment": (
        "on",
        "Resources",
        lambda x: dd.Experiment("e", model(), dd.TrialPlan(5)).run(on=x),
    ),
}


@pytest.mark.parametrize("argument", [{}, 3], ids=["dict", "number"])
@pytest.mark.parametrize("case", CALLS)
def test_an_argument_of_another_type_is_refused_by_name(case: str, argument: object) -> None:
    name, kind, call = CALLS[case]
    with pytest.raises(ParameterError, match=rf"{name}: needs an? {kind}, not .*Write: {name}={kind}\("):
        call(argument)
