"""Associations: every rule against its closed form and a plain loop; gates, sampling, order and batches."""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd
from deodar.couplings.hebbian import Hebbian
from deodar.elements.stimuli import Boost, Pattern
from deodar.errors import ModelError, ParameterError
from deodar.numerics.plasticity import RULES, SOURCE_RULES

X, Z = dd.Axis("x", 0, 6, 4), dd.Axis("z", 0, 1, 3)
PRE, POST = np.array([0.0, 1.0, 0.6, 0.3]), np.array([1.0, 0.4, 0.8])


def model(rule="outstar", pre=PRE, post=POST, x=X, z=Z, gate=None, **others):
    m = dd.Model("learning", dt=0.5)
    w = m.add(Hebbian([z] if z else [], rule, name="w", gated=gate is not None, **others))
    m.connect(m.add(Pattern("pre", [x] if x else [], pre)), w["input"])
    m.connect(m.add(Pattern("post", [z] if z else [], post)), w["post"])
    if gate is not None:
        m.connect(m.add(Boost("gate", [], 1.0, windows=gate)), w["gate"])
    return m


def weights(m, duration, **options):
    return dd.simulate(m, duration, record=["w.weights"], precision="float64", every=duration, **options)[
        "w.weights"
    ].values[-1]


def plain(rule, w, pre, post, steps, rate, decay, most, threshold=0.5, dt=0.5):
    """The docstring, step by step; w has the target first."""
    x, z = np.where(pre > threshold, pre, 0)[None, :], np.where(post > threshold, post, 0)[:, None]
    learned = (x > 0) | (z < 0) if rule in SOURCE_RULES else (z > 0) | (x < 0)
    for _ in range(steps):
        change = {
            "outstar": x * (z - w),
            "hebb": x * z,
            "association": np.sign(x) * (np.sign(z) - w),
            "instar": z * (x - w),
            "oja": z * (x - z * w),
        }[rule]
        new = np.minimum(w + dt * (rate * change - decay * w), most)
        w = np.where(learned & (x.max() > 0) & (z.max() > 0), new, w)
    return w


@pytest.mark.parametrize("rule", RULES)
def test_each_rule_agrees_with_numpy_step_by_step(rule):
    m = model(rule, rate=0.1, initial=0.2)
    for decay, saturation in ((0.0, 0.0), (0.03, 0.0), (0.01, 0.45)):
        m.set({"w.decay": decay, "w.saturation": saturation})
        learned = weights(m, 20)
        expected = plain(rule, np.full((3, 4), 0.2), PRE, POST, 40, 0.1, decay, saturation or np.inf)
        np.testing.assert_allclose(learned, expected, rtol=0, atol=1e-12)
        assert (learned != 0.2).any()


def test_learning_agrees_with_its_closed_form_and_fixed_points():
    n, dt, rate = 200, 0.5, 0.02
    x, z = np.array([0.8]), np.array([0.7])
    axes = {
        "pre": x,
        "post": z,
        "x": dd.Axis("x", 0, 1, 1, periodic=True),
        "z": dd.Axis("z", 0, 1, 1, periodic=True),
        "rate": rate,
    }
    course = {
        "outstar": (0.7 * (1 - (1 - dt * rate * 0.8) ** n), 0.7),
        "instar": (0.8 * (1 - (1 - dt * rate * 0.7) ** n), 0.8),
        "association": (1 - (1 - dt * rate) ** n, 1),
        "oja": (0.8 / 0.7 * (1 - (1 - dt * rate * 0.49) ** n), 0.8 / 0.7),
    }
    for rule, (then, end) in course.items():
        m = model(rule, **axes)
        assert weights(m, n * dt).item() == pytest.approx(then, abs=1e-9), rule
        assert weights(m, 4000).item() == pytest.approx(end, abs=1e-6), rule
    m = model("hebb", **axes)
    assert weights(m, n * dt).item() == pytest.approx(n * dt * rate * 0.8 * 0.7, abs=1e-9)
    m.set("w.decay", 0.05)  # it settles where learning and decay are equal
    assert weights(m, 2000).item() == pytest.approx(rate * 0.56 / 0.05, abs=1e-6)
    m.set({"w.decay": 0.0, "w.saturation": 0.3})
    assert weights(m, 2000).item() == 0.3


def test_oja_from_its_own_output_ends_at_unit_length():
    m = dd.Model("oja", dt=0.5)
    w = m.add(Hebbian([], "oja", rate=0.05, initial=0.1, threshold=0.05, name="w"))
    m.connect(m.add(Pattern("pre", [X], PRE)), w["input"])
    m.connect(w, w["post"])
    learned = weights(m, 2000)
    assert X.step * np.sum(learned**2) == pytest.approx(1, abs=1e-6)
    seen = PRE / np.sqrt(X.step * np.sum(PRE**2))
    np.testing.assert_allclose(learned, seen, atol=1e-6)


def test_weights_connect_arrays_of_any_dimension():
    y = dd.Axis("y", 0, 2, 5)
    rng = np.random.default_rng(1)
    for pre_axes, post_axes in (([], []), ([], [Z]), ([X], []), ([X, y], [dd.Axis("p", 0, 1, 2), Z])):
        pre, post = (0.6 + 0.4 * rng.random([a.samples for a in axes]) for axes in (pre_axes, post_axes))
        m = dd.Model("any", dt=1)
        w = m.add(Hebbian(post_axes, rate=0.1, name="w"))
        m.connect(m.add(Pattern("pre", pre_axes, pre)), w["input"])
        m.connect(m.add(Pattern("post", post_axes, post)), w["post"])
        record = dd.simulate(m, 3, record=["w.weights", "w.output"], precision="float64", every=3).isel(
            time=-1
        )
        expected = post[(...,) + (None,) * pre.ndim] * (1 - (1 - 0.1 * pre) ** 3)
        np.testing.assert_allclose(record["w.weights"].values, expected, atol=1e-12)
        cell = np.prod([a.step for a in pre_axes])
        np.testing.assert_allclose(
            record["w.output"].values, cell * np.tensordot(expected, pre, axes=pre.ndim), atol=1e-12
        )


@pytest.mark.parametrize("rule", RULES)
def test_weights_keep_their_bits_while_the_gate_is_closed_or_a_side_is_silent(rule):
    start = np.random.default_rng(2).standard_normal((3, 4))
    m = model(rule, rate=0.3, decay=0.2, start=start, gate=[(10, 12)])
    expected = plain(rule, start, PRE, POST, 4, 0.3, 0.2, np.inf)
    np.testing.assert_allclose(weights(m, 50), expected, atol=1e-12)
    for path in ("gate.amplitude", "pre.amplitude", "post.amplitude"):
        m.set(path, 0.4 if path != "gate.amplitude" else 0.0)
        for trials in [None, 3] if rule in ("outstar", "oja") else [None]:
            learned = (
                dd.simulate(m, 50, record=["w.weights"], precision="float64", trials=trials, every=50)[
                    "w.weights"
                ]
                .isel(time=-1)
                .values
            )
            assert np.array_equal(learned, np.broadcast_to(start, learned.shape))
        m.set(path, 1.0)


def test_weights_of_a_source_without_target_activity_do_not_change():
    start = np.array([[0.0, 2, 0, 0], [0, 1, 0, 0], [0, 3, 0, 0]])
    record = dd.simulate(
        model(start=start, post=0 * POST, rate=1.0), 10, record=["w.output", "w.weights"], every=10
    ).isel(time=-1)
    np.testing.assert_allclose(record["w.output"], X.step * np.array([2, 1, 3]))
    np.testing.assert_array_equal(record["w.weights"], start)


@pytest.mark.parametrize("rule", ["outstar", "hebb", "oja"])
def test_a_learned_map_does_not_depend_on_the_sampling(rule):
    def learned(n):
        x, z = dd.Axis("x", 0, 40, n, periodic=True), dd.Axis("z", -10, 10, n + 1)
        pre, post = np.exp(-((x.points - 17) ** 2) / 18), np.exp(-((z.points - 2) ** 2) / 8)
        m = model(rule, pre, post, x, z, rate=0.05, threshold=0.0, initial=0.1)
        record = dd.simulate(m, 50, record=["w.weights", "w.output"], precision="float64", every=50).isel(
            time=-1
        )
        return record["w.weights"].values, record["w.output"].values

    (coarse, drive), (fine, finer) = learned(40), learned(80)
    np.testing.assert_allclose(fine[::2, ::2], coarse, atol=1e-12)
    np.testing.assert_allclose(finer[::2], drive, atol=1e-8 * drive.max())


def test_the_order_of_declaration_does_not_matter():
    def built(order):
        m = dd.Model("order", dt=1)
        parts = {
            "w": Hebbian([Z], "oja", rate=0.1, name="w", random=True, initial=0.5),
            "pre": dd.Field("pre", [X], resting_level=1.0, noise=0.2),
            "post": dd.Field("post", [Z], resting_level=1.0, noise=0.2),
        }
        for name in order:
            m.add(parts[name])
        for source, target in (("pre", "w.input"), ("post", "w.post"), ("w", "post.input")):
            m.connect(source, target)
        return weights(m, 100, seed=4)

    np.testing.assert_allclose(built(["w", "pre", "post"]), built(["post", "w", "pre"]), atol=1e-10)


@pytest.mark.parametrize("rule", ["outstar", "oja"])
def test_trials_rows_and_sweeps_equal_single_runs(rule):
    m = dd.Model("batch", dt=1)
    for k in (0, 1):  # two of one kind: rows of a group
        w = m.add(Hebbian([Z], rule, name=f"w{k}", rate=0.1, decay=0.01, random=True, initial=0.5, seed=3))
        m.connect(m.add(dd.Field(f"pre{k}", [X], noise=2.0, resting_level=0.5)), w["input"])
        m.connect(m.add(dd.Field(f"post{k}", [Z], noise=2.0, resting_level=0.2)), w["post"])
    names = ["w0.weights", "w1.weights"]
    many = dd.simulate(
        m, 60, trials=4, sweep={"w1.rate": [0.05, 0.1]}, record=names, precision="float64", every=60
    ).isel(time=-1)
    m.remove("w1")
    alone = dd.simulate(m, 60, trials=[2], record=names[:1], precision="float64", every=60)[
        "w0.weights"
    ].values[0, -1]
    for rate in (0.05, 0.1):
        first = many["w0.weights"].sel(trial=2)
        first = first.sel({"w1.rate": rate}).values if "w1.rate" in first.dims else first.values
        np.testing.assert_allclose(first, alone, atol=1e-10)
    second = many["w1.weights"].sel(trial=2)
    assert not np.allclose(second.sel({"w1.rate": 0.05}), second.sel({"w1.rate": 0.1}))


# --------------------------------------------------------------------------------------- weights at the start


def test_random_weights_are_one_map_at_any_sampling():
    def start(n, **others):
        x, z = dd.Axis("x", 0, 40, n, periodic=True), dd.Axis("z", -10, 10, n // 2 + 1)
        m = model(
            pre=np.zeros(n),
            post=np.zeros(n // 2 + 1),
            x=x,
            z=z,
            random=True,
            initial=2.0,
            share=0.3,
            **others,
        )
        return dd.Session(m, precision="float64").read("w.weights")

    coarse, fine = start(64), start(128)
    assert np.array_equal(fine[::2, ::2], coarse)
    patches = fine[:64:4, ::8]
    assert 0.2 < (patches > 0).mean() < 0.4 and patches.max() < 2 and 0.8 < patches[patches > 0].mean() < 1.2
    assert not np.array_equal(start(64, seed=1), coarse)


def test_sparse_weights_may_have_equal_values():
    x = dd.Axis("x", 0, 40, 64, periodic=True)
    m = model(pre=np.zeros(64), x=x, initial=0.7, share=0.5)
    assert set(np.unique(dd.Session(m, precision="float64").read("w.weights"))) == {0.0, 0.7}


def test_weights_of_another_shape_are_refused_with_both_shapes():
    with pytest.raises(
        ModelError, match=r"start has shape \[4, 3\], target and source have \[3, 4\] samples"
    ):
        dd.Session(model(start=np.zeros((4, 3))))


def test_an_unknown_rule_names_the_others():
    with pytest.raises(ParameterError, match=r"'instarr'; expected one of .*instar.*Did you mean 'instar'"):
        Hebbian([Z], "instarr")


WIDE, TALL = dd.Axis("wide", 0, 10, 21), dd.Axis("tall", 0, 8, 17)


@pytest.mark.parametrize("rule", ["association", "outstar", "oja"])
def test_a_map_that_learns_apart_is_the_one_of_its_teacher(rule: str) -> None:
    """It has the weights of the coupling that reads what it learns, whatever it reads itself."""
    m = dd.Model("two readers", dt=1.0)
    seen = m.add(dd.GaussianStimulus("seen", [WIDE], center=3, sigma=1, amplitude=1))
    other = m.add(dd.GaussianStimulus("other", [WIDE], center=7, sigma=1, amplitude=1))
    target = m.add(dd.GaussianStimulus("target", [TALL], center=4, sigma=1, amplitude=1))
    settings = {"rule": rule, "rate": 0.02, "random": True, "initial": 0.2, "threshold": 0.3}
    one = m.add(Hebbian([TALL], name="one", **settings))
    two = m.add(Hebbian([TALL], name="two", apart=True, **settings))
    seen >> one
    other >> two
    seen >> two["pre"]
    for coupling in (one, two):
        target >> coupling["post"]
    record = dd.simulate(m, 60, record=["one.weights", "two.weights", "one", "two"], every=60)
    first, second = (record[f"{name}.weights"].values for name in ("one", "two"))
    assert np.array_equal(first, second) and np.ptp(first[-1] - first[0]) > 0.1
    here, there = record["one.output"].values[-1], record["two.output"].values[-1]
    assert here.max() > 2 * there.max(), "the second one reads where nothing was learned"


def test_what_is_learned_apart_needs_the_axes_of_the_input() -> None:
    m = dd.Model("wrong")
    coupling = m.add(Hebbian([TALL], apart=True, name="w"))
    m.add(dd.GaussianStimulus("a", [WIDE], center=3, sigma=1)) >> coupling
    m.add(dd.GaussianStimulus("b", [TALL], center=3, sigma=1)) >> coupling["pre"]
    assert any("are not those that arrive at pre" in problem.what for problem in m.check())
