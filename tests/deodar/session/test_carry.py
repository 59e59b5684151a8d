"""Changes of a running session: what is carried, and what is refused."""

from __future__ import annotations

import dataclasses as dc
import threading

import numpy as np
import pytest

import deodar as dd
from deodar.couplings.delays import DelayLine
from deodar.couplings.hebbian import Hebbian
from deodar.elements.memories import History, MemoryTrace
from deodar.errors import ParameterError, ThreadError, WorldError
from deodar.worlds._base import Signal, World

X = dd.Axis("x", 0, 100, samples=101)


def remembering(axis: dd.Axis = X, noise: float = 0.0) -> dd.Model:
    """Return a field with a peak, and its memory trace."""
    model = dd.Model("remembering")
    u = model.add(dd.Field("u", [axis], noise=noise))
    model.add(dd.GaussianStimulus("s", [axis], center=30, sigma=5, amplitude=9)) >> u
    u >> model.add(MemoryTrace("trace", [axis], tau_build=50.0))
    return model


def running(axis: dd.Axis = X, steps: int = 100) -> dd.Session:
    s = dd.Session(remembering(axis), precision="float64")
    s.step(steps)
    return s


def use(s: dd.Session, axis: dd.Axis) -> str:
    return s.set({f"{name}.axes": [axis] for name in ("u", "s", "trace")})


@pytest.mark.parametrize("samples", [201, 51, 67])
def test_other_samples_of_the_same_bounds_take_the_states_with_them(samples: int) -> None:
    s = running()
    before = {port: s.read(port) for port in ("u.activation", "trace.output")}
    fine = dd.Axis("x", 0, 100, samples=samples)
    assert use(s, fine) == "recompile"
    for port, values in before.items():
        assert np.allclose(s.read(port), np.interp(fine.points, X.points, values), atol=1e-12)
        assert values.max() > 0.5
    tick = s.tick
    s.step(20)
    assert s.tick == tick + 20 and s.read("u").max() > 0


def test_other_bounds_take_the_states_where_the_axes_overlap() -> None:
    s = running()
    before = s.read("trace.output")
    use(s, dd.Axis("x", 20, 140, samples=121))
    after = s.read("trace.output")
    assert np.array_equal(after[:81], before[20:]) and (after[81:] == 0).all()
    assert (s.read("u.activation")[81:] == s.get("u.resting_level")).all()


def test_the_same_number_of_samples_over_other_bounds_moves_nothing() -> None:
    s = running()
    use(s, dd.Axis("x", 10, 110, samples=101))
    assert dd.Axis("x", 10, 110, samples=101).points[s.read("trace.output").argmax()] == 30


def test_periodic_axes_are_carried_across_their_seam() -> None:
    ring = dd.Axis("x", 0, 360, samples=36, periodic=True)
    s = running(ring)
    s.set("s.center", 0.0)
    s.step(200)
    before = s.read("u.activation")
    use(s, dd.Axis("x", -180, 180, samples=72, periodic=True))
    after = s.read("u.activation")
    assert np.array_equal(after[::2], np.roll(before, 18))
    assert np.allclose(after[1::2], (np.roll(before, 18) + np.roll(before, 17)) / 2)


def test_another_unit_of_length_is_converted_and_another_quantity_refused() -> None:
    s = running(dd.Axis("x", 0, 100, samples=101, unit="mm"))
    before = s.read("trace.output")
    use(s, dd.Axis("x", 0, 10, samples=101, unit="cm"))
    assert np.allclose(s.read("trace.output"), before, atol=1e-12)
    with pytest.raises(ParameterError, match=r"the unit of the axis x was cm, and becomes rad"):
        use(s, dd.Axis("x", 0, 10, samples=101, unit="rad"))


def test_a_renamed_axis_is_the_same_axis_and_axes_may_change_places() -> None:
    s = running()
    before = s.read("u.activation")
    use(s, dd.Axis("place", 0, 100, samples=101))
    assert np.array_equal(s.read("u.activation"), before)

    y = dd.Axis("y", 0, 10, samples=11)
    model = dd.Model("plane")
    model.add(dd.Field("u", [X, y]))
    model.add(dd.GaussianStimulus("s", [X, y], center=[30, 4], sigma=[5, 2], amplitude=9)) >> model["u"]
    plane = dd.Session(model)
    plane.step(20)
    activation = plane.read("u.activation")
    plane.set({"u.axes": [y, X], "s.axes": [y, X], "s.center": [4, 30], "s.sigma": [2, 5]})
    assert np.array_equal(plane.read("u.activation"), activation.T)


def test_weights_are_carried_along_both_of_their_sides() -> None:
    y = dd.Axis("y", 0, 10, samples=101)
    model = dd.Model("learning")
    u, v = (model.add(dd.Field(n, [a])) for n, a in (("u", X), ("v", y)))
    model.add(dd.GaussianStimulus("to u", [X], center=30, sigma=5, amplitude=9)) >> u
    model.add(dd.GaussianStimulus("to v", [y], center=7, sigma=1, amplitude=9)) >> v
    w = model.add(Hebbian([y], rate=0.01, name="w"))
    model.connect(u, w["input"])
    model.connect(v, w["post"])
    s = dd.Session(model, precision="float64")
    s.step(100)
    weights = s.read("w.weights")
    half = dd.Axis("y", 0, 10, samples=51)
    s.set({"v.axes": [half], "to v.axes": [half], "w.axes": [half]})
    assert np.allclose(s.read("w.weights"), weights[::2], atol=1e-12) and weights.max() > 0


def test_noise_goes_on_with_its_keys_after_a_change_of_axes() -> None:
    def after(*axes: dd.Axis) -> np.ndarray:
        s = dd.Session(remembering(noise=1.0), seed=4)
        s.step(10)
        for axis in axes:
            use(s, axis)
        s.step(10)
        return s.read("u.activation")

    there_and_back = after(dd.Axis("x", 0, 100, samples=201), X)
    assert np.array_equal(there_and_back, after())


def test_what_cannot_be_carried_is_refused_and_nothing_changes() -> None:
    y = dd.Axis("y", 0, 10, samples=11)
    model = dd.Model("rows")
    model.add(dd.Boost("s", amplitude=1.0)) >> model.add(DelayLine("d", delay=5.0, slots=10))
    model["s"] >> model.add(History("h", slots=dd.Axis("slot", 0, 4, samples=5)))
    model["s"] >> model.add(dd.Field("u", [X]))
    s = dd.Session(model)
    s.step(3)
    document, journal, program = s.document, list(s.journal), s.program
    for path, value, reason in (
        ("u.axes", [X, y], "nothing is known along the axis y"),
        ("u.axes", [], "it is no longer along the axis x"),
        ("u.axes", [dd.Axis("x", 200, 300, samples=101)], "no position in common"),
        ("d.slots", 20, "nothing is known along 22 rows of it"),
        ("h.slots", dd.Axis("slot", 0, 9, samples=10), "nothing is known along 10 rows of it"),
        ("h.empty", "nan", "it now also stores count"),
    ):
        with pytest.raises(ParameterError, match=rf"{path.split('.')[0]}: .*cannot be carried: .*{reason}"):
            s.set(path, value)
    assert (s.document, s.journal, s.program, s.tick) == (document, journal, program, 3)
    s.reset()
    assert s.set("d.slots", 20) == "recompile"  # at the start there is nothing to lose


def test_another_kind_in_the_place_of_an_element_takes_the_states_of_its_names() -> None:
    model = dd.Model("node")
    model.add(dd.Field("n", [])) >> model.add(MemoryTrace("trace", []))
    model.add(dd.Boost("s", amplitude=9.0)) >> model["n"]
    s = dd.Session(model)
    s.step(20)
    before = s.read("n.activation")
    n, trace, boost = s.document.entries
    node = dc.replace(n, element=dd.RateNode("n"))
    field = dc.replace(trace, element=dd.Field("trace", []))
    s.edit(dc.replace(s.document, entries=(node, field, boost)))
    assert s.read("n.activation") == before > 0
    assert s.read("trace.activation") == -5


def test_reset_begins_with_what_keep_wrote_as_a_new_session_does() -> None:
    model = remembering()
    s = dd.Session(model)
    s.step(100)
    trace = s.read("trace.output")
    s.keep()
    s.reset()
    assert s.time == 0 and np.array_equal(s.read("trace.output"), trace)
    assert (s.read("u.activation") == model["u"].resting_level).all()
    assert np.array_equal(dd.Session(model).read("trace.output"), trace)
    s.step(30)
    fresh = dd.Session(model)
    fresh.step(30)
    assert np.array_equal(s.read("u.activation"), fresh.read("u.activation"))


def test_what_was_kept_is_carried_to_axes_that_changed_since() -> None:
    s = running()
    s.keep()
    use(s, dd.Axis("x", 0, 100, samples=201))
    trace = s.read("trace.output")
    s.reset()
    assert np.allclose(s.read("trace.output"), trace, atol=1e-12) and trace.max() > 0.5


def test_reset_keeps_what_was_learned_on_request_and_only_once() -> None:
    s = running()
    trace = s.read("trace.output")
    s.reset(seed=3, keep_learned=True)
    assert (s.time, s.seed) == (0, 3)
    assert np.array_equal(s.read("trace.output"), trace)
    assert (s.read("u.activation") == s.get("u.resting_level")).all()
    s.reset()
    assert s.read("trace.output").max() == 0


def test_a_snapshot_has_as_many_futures_as_seeds() -> None:
    model = remembering(noise=1.0)
    first = dd.Session(model, seed=1)
    first.step(10)
    moment = first.snapshot()

    def future(s: dd.Session, seed: int | None) -> np.ndarray:
        s.restore(moment, seed)
        assert s.tick == 10 and s.seed == (1 if seed is None else seed)
        assert np.array_equal(
            s.read("u.activation"), moment.states[first.document.entries[0].id][0]["activation"]
        )
        s.step(10)
        return s.read("u.activation")

    second = dd.Session(model, seed=2)
    same, another = future(second, None), future(second, 2)
    assert np.array_equal(same, future(first, 1)) and np.array_equal(another, future(first, 2))
    assert not np.array_equal(same, another)
    with pytest.raises(ParameterError, match=r"a seed"):
        first.restore(moment, -1)


def test_the_noise_of_a_world_follows_the_seed_of_the_restored_moment() -> None:
    class Noisy(World):
        period = 1.0

        def __init__(self) -> None:
            self.sensors = {"light": Signal("its strength")}
            self.seed = 0

        def reset(self, seed: int, trials: object = (0,), precision: str = "float32") -> None:
            self.seed = seed

        def sense(self, sensor: str, axes: object, time: float) -> np.ndarray:
            return np.asarray(self.seed + time)

    model = dd.Model("seeing")
    model.add(dd.Sensor("light", sensor="light")) >> model.add(dd.Field("u"))
    first, second = dd.Session(model, seed=1, world=Noisy()), dd.Session(model, seed=2, world=Noisy())
    first.step(5)
    second.restore(first.snapshot())
    assert second.read("light.output") == first.read("light.output") == 6
    second.restore(first.snapshot(), seed=9)
    assert second.read("light.output") == 14


def test_a_second_thread_is_refused_by_name_and_the_session_stays_whole() -> None:
    alone, shared = (dd.Session(remembering(noise=0.5), seed=5) for _ in range(2))
    alone.run_live(20, speed=None)
    refusals: list[str] = []

    def intrude() -> None:
        for call in (lambda: shared.step(1), lambda: shared.set("u.tau", 5), lambda: shared.reset()):
            try:
                call()
            except ThreadError as error:
                refusals.append(str(error))

    def between() -> None:
        thread = threading.Thread(target=intrude, name="intruder")
        thread.start()
        thread.join()

    shared.run_live(20, speed=None, between=between, between_every=0.0)
    assert len(refusals) >= 3 and not shared.journal
    assert all("'intruder'" in r and "'MainThread'" in r for r in refusals)
    assert np.array_equal(shared.read("u.activation"), alone.read("u.activation"))


def test_a_failed_reset_or_restore_changes_nothing() -> None:
    class Failing(World):
        period = 1.0
        fails = False

        def __init__(self) -> None:
            self.sensors = {"light": Signal("its strength")}

        def reset(self, seed: int, trials: object = (0,), precision: str = "float32") -> None:
            if self.fails:
                raise OSError("unplugged")

        def sense(self, sensor: str, axes: object, time: float) -> np.ndarray:
            return np.asarray(1.0)

    model = dd.Model("seeing")
    model.add(dd.Sensor("light", sensor="light")) >> model.add(dd.Field("u"))
    world = Failing()
    s = dd.Session(model, seed=1, world=world)
    moment = s.snapshot()
    s.step(5)
    before = s.read("u.activation")
    world.fails = True
    for call in (lambda: s.reset(seed=2), lambda: s.restore(moment, seed=2)):
        with pytest.raises(WorldError, match=r"unplugged"):
            call()
        assert (s.tick, s.seed, s.world, s.journal) == (5, 1, world, [])
        assert np.array_equal(s.read("u.activation"), before)


def test_of_two_axes_of_one_name_that_of_the_same_place_is_continued() -> None:
    x = dd.Axis("x", 0, 10, samples=11)
    model = dd.Model("pair")
    start = np.arange(121.0).reshape(11, 11) / 100
    u, v = model.add(dd.Field("u", [x])), model.add(dd.Field("v", [x]))
    u >> model.add(dd.AdaptiveWeights([x], start=start, rate=0.0, name="w")) >> v
    s = dd.Session(model, precision="float64")
    s.set({"u.axes": [dd.Axis("y", 0, 10, samples=11)]})
    weights = [row[0]["weights"] for row in s.snapshot().states.values() if "weights" in row[0]]
    assert np.array_equal(weights[0], start)


def test_what_is_stated_after_keep_stays() -> None:
    s = running()
    s.keep()
    s.set("trace.start", np.full(101, 0.25))
    s.reset()
    assert np.allclose(s.read("trace.output"), 0.25)
