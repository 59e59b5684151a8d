"""The looking architecture: the order of a gaze, and what both mechanisms learn from it."""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd
from deodar.architectures.looking import SAMPLES, looking, retina, shifts
from deodar.errors import ParameterError
from deodar_robots.eye.pan_tilt import CENTRE, PanTilt

EYE = dd.Eye()


def true_map() -> np.ndarray:
    """Return the map that sends each place of the retina to the shift that centres it."""
    (column, row), (pan, tilt) = retina(), shifts()
    places = np.stack(np.meshgrid(column.points, row.points, indexing="ij"), axis=-1)
    goals = np.asarray(EYE.pan_tilt.to_direction(places))
    away = [(axis.points[:, None, None] - goals[None, ..., k]) for k, axis in enumerate((pan, tilt))]
    return (np.hypot(away[0][:, None], away[1][None]) < 70).astype(np.float32)


def gaze(model: dd.Model, first: tuple[float, float], record: list[str], duration: float = 2000.0):
    model.add(dd.Sensor("target", [dd.Axis("component", 0, 1, 2)], sensor="target"))
    world = dd.Eye(screen=dd.EyeScreen(endless=False), first=first)
    return dd.simulate(model, duration, record=[*record, "target"], every=10, world=world, seed=2)


def onset(values: np.ndarray, above: float) -> int:
    """Return the first sample above a value; fails if there is none."""
    indices = np.flatnonzero(values > above)
    assert len(indices), f"never above {above}"
    return int(indices[0])


@pytest.mark.parametrize("first", [(25.0, 90.0), (60.0, 20.0), (30.0, 95.0)])
def test_with_the_true_map_a_gaze_centres_the_target_in_the_order_of_the_paper(first) -> None:
    fields = ["perceptual", "visual intention", "motor intention"]
    record = [*(f"{name}.output" for name in fields), "pan arrived.activation", "satisfied.activation"]
    data = gaze(looking("paper", weights=true_map(), learns=False), first, record)
    peaks = [onset(data[f"{name}.output"].values.max(axis=(1, 2)), 0.5) for name in fields]
    arrived = onset(data["pan arrived.activation"].values, 0.0)
    done = onset(data["satisfied.activation"].values, 0.0)
    assert [*peaks, arrived, done] == sorted([*peaks, arrived, done])
    away = np.linalg.norm(data["target.output"].values - CENTRE, axis=1)
    assert away[0] > 40 and away[done] < 6
    # the condition of satisfaction ends both intentions, and so itself
    for name in fields[1:]:
        assert data[f"{name}.output"].values[done + 15].max() < 0.1
    assert data["satisfied.activation"].values[done:].min() < 0


def test_the_visual_intention_remembers_where_the_target_was() -> None:
    """During the movement the peak stays, while the target and the perceptual peak move on the retina."""
    record = ["visual intention.output", "motor intention.output", "arrived"]
    data = gaze(looking("paper", weights=true_map(), learns=False), (30.0, 95.0), record)
    column, row = (axis.points for axis in retina())
    moving = data["motor intention.output"].values.max(axis=(1, 2)) > 0.5
    moving[int(np.flatnonzero(data["arrived.output"].values > 0.5)[0]) :] = False
    seen = data["visual intention.output"].values[moving]
    mass = seen.sum(axis=(1, 2))
    places = np.stack(
        [np.einsum("tcr,c->t", seen, column) / mass, np.einsum("tcr,r->t", seen, row) / mass], axis=-1
    )[10:-10]
    assert np.ptp(places, axis=0).max() < 2.5
    target = data["target.output"].values[moving]
    assert np.linalg.norm(target[-1] - target[0]) > 30


@pytest.mark.parametrize("mechanism", ["paper", "correcting"])
def test_a_gaze_that_centres_the_target_is_learned_where_the_target_was(mechanism: str) -> None:
    """The map is right, but weak. It grows where the target was, and where it then is: in the centre. Both
    maps of the correcting mechanism are the same.
    """
    start = 0.4 * true_map()
    first = (35.0, 90.0)
    maps = ["map.weights", *(["map read again.weights"] if mechanism == "correcting" else [])]
    data = gaze(looking(mechanism, weights=start), first, maps, 1200.0)
    learned, *again = (data[name].values for name in maps)
    column, row = (axis.points for axis in retina())
    changed = np.abs(learned[-1] - start).max(axis=(0, 1))
    around = np.hypot(column[:, None] - first[0], row[None, :] - first[1]) < 25
    centre = np.hypot(column[:, None] - CENTRE, row[None, :] - CENTRE) < 25
    assert changed[~around & ~centre].max() == 0.0 and changed[around].max() > 0.02
    assert all(np.array_equal(learned, weights) for weights in again)


def test_a_gaze_that_misses_is_not_learned_by_the_paper_and_is_corrected_by_the_other() -> None:
    """A map that is right near the centre and wrong at one place: its error is what is corrected."""
    column, row = (axis.points for axis in retina())
    first = (35.0, 90.0)
    wrong = np.hypot(column[:, None] - first[0], row[None, :] - first[1]) < 14
    true, moved = true_map(), np.roll(true_map(), 3, axis=0)  # three samples: 90 servo units, 16 pixels
    start = np.where(wrong[None, None], moved, true)
    pan = shifts()[0].points

    def aim(weights: np.ndarray) -> float:
        here = weights[:, :, 8, 22].sum(axis=1)
        return float((here * pan).sum() / here.sum())

    after = {}
    for mechanism in ("paper", "correcting"):
        data = gaze(looking(mechanism, weights=start), first, ["map.weights"], 1200.0)
        after[mechanism] = data["map.weights"].values[-1]
    assert np.abs(after["paper"] - start)[..., wrong].max() < 0.03
    before, right = aim(start), aim(true)
    assert abs(before - right) > 60
    assert abs(aim(after["correcting"]) - right) < 0.75 * abs(before - right)


def test_at_rest_nothing_is_done() -> None:
    record = dd.simulate(
        looking("correcting"),
        1500,
        record=["visual intention.output", "motor intention.output"],
        every=10,
        world=dd.Eye(screen=dd.EyeScreen(wait=1e9, endless=False)),
    )
    assert record["visual intention.output"].values.max() < 0.5
    assert record["motor intention.output"].values.max() < 0.5


def test_a_finer_sampling_looks_at_the_same_place() -> None:
    (column, row), (pan, tilt) = retina(48), shifts(37)
    optics = PanTilt(0.18, 0.12, 0.06)
    places = np.stack(np.meshgrid(column.points, row.points, indexing="ij"), axis=-1)
    goals = np.asarray(optics.to_direction(places))
    away = [(axis.points[:, None, None] - goals[None, ..., k]) for k, axis in enumerate((pan, tilt))]
    fine = (np.hypot(away[0][:, None], away[1][None]) < 70).astype(np.float32)
    model = looking("paper", samples=(48, 37), weights=fine, learns=False)
    data = gaze(model, (25.0, 90.0), ["arrived"])
    done = onset(data["arrived.output"].values, 0.5)
    assert np.linalg.norm(data["target.output"].values[done] - CENTRE) < 8


def test_wrong_arguments_are_refused() -> None:
    with pytest.raises(ParameterError, match="mechanism is 'papre'"):
        looking("papre")
    with pytest.raises(ParameterError, match="weights is None"):
        looking(learns=False)
    assert SAMPLES == (32, 25)
