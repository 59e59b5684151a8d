"""Feature and position bound in one field: a cue to one of them retrieves the other."""

from __future__ import annotations

import numpy as np
import pytest
import xarray

import deodar as dd
from deodar.analysis.peaks import peaks
from deodar.architectures.feature_space import OBJECT, axes, feature_space
from deodar.elements.stimuli import Boost

SPACE, FEATURE = axes()
SCENE = ((20.0, 0.0), (50.0, 120.0), (80.0, 240.0))


def scene() -> dd.Model:
    """Return a model with three objects, and a later cue to each read-out."""
    model = feature_space()
    for k, at in enumerate(SCENE):
        (
            model.add(
                dd.GaussianStimulus(
                    f"object {k}", [SPACE, FEATURE], center=at, sigma=[5, 20], amplitude=OBJECT
                )
            )
            >> model["bound"]
        )
    for name, axis, sigma in (("space", SPACE, 5), ("feature", FEATURE, 20)):
        (
            model.add(
                dd.GaussianStimulus(
                    f"{name} cue", [axis], center=0, sigma=sigma, amplitude=0, windows=[(100, 400)]
                )
            )
            >> model[name]
        )
    return model


def at_end(model: dd.Model, sweep: dict[str, list[float]], duration: float = 700) -> xarray.Dataset:
    record = [f"{name}.activation" for name in ("bound", "space", "feature")]
    return dd.simulate(model, duration, record=record, every=duration, sweep=sweep, trials=5).isel(time=-1)


@pytest.mark.parametrize(("cue", "brings"), [(0, 1), (1, 0)], ids=["place to feature", "feature to place"])
def test_a_cue_activates_the_other_feature_of_its_object(cue: int, brings: int) -> None:
    names = ("space", "feature")
    model = scene()
    model.set(f"{names[cue]} cue.amplitude", 6.0)
    table = at_end(model, {f"{names[cue]} cue.center": [at[cue] for at in SCENE]})
    for k, at in enumerate(SCENE):
        for trial in range(5):
            trial_end = table.isel({f"{names[cue]} cue.center": k, "trial": trial})
            for name, place, tolerance in (("space", at[0], 3), ("feature", at[1], 12)):
                (peak,) = peaks(trial_end[f"{name}.activation"])
                apart = abs(peak.position[0] - place)
                assert min(apart, 360 - apart) < tolerance
            assert len(peaks(trial_end["bound.activation"])) == 1


def test_a_cue_without_a_matching_object_activates_nothing() -> None:
    model = scene()
    model.set("feature cue.amplitude", 6.0)
    table = at_end(model, {"feature cue.center": [60.0, 180.0]}, 390)
    assert float(table["space.activation"].max()) < 0 and float(table["bound.activation"].max()) < 0


def test_nothing_is_selected_without_a_cue() -> None:
    record = dd.simulate(scene(), 1000, record=["bound.activation"], every=10, trials=10)
    assert float(record["bound.activation"].max()) < 0


def test_conflicting_cues_create_no_peak() -> None:
    """The position of one object and the feature of another cross where there is no object."""
    model = scene()
    model.set("space cue.center", 20.0)
    model.set("feature cue.center", 120.0)
    for name in ("space", "feature"):
        model.set(f"{name} cue.amplitude", 6.0)
    u = dd.simulate(model, 390, record=["bound.activation"], every=390)["bound.activation"][-1]
    assert float(u.sel(space=20, feature=120)) < 0


def test_a_selection_remains_after_its_cue_until_inhibition_ends_it() -> None:
    model = scene()
    model.set("space cue.center", 50.0)
    model.set("space cue.amplitude", 6.0)
    release = model.add(Boost("release", [], amplitude=-10, windows=[(1200, 1300)]))
    for name in ("bound", "space", "feature"):
        release >> model[name]
    u = dd.simulate(model, 1600, record=["feature.activation"], every=10, trials=10)["feature.activation"]
    assert (np.asarray(u.sel(time=1190).max("feature")) > 0).all() and float(
        u.sel(time=slice(1290, None)).max()
    ) < 0
