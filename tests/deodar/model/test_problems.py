"""`check` lists all problems at once, each with its path and the line that declared it."""

from __future__ import annotations

import re
import sys

import numpy as np
import pytest

import deodar as dd
from deodar.couplings.arithmetic import Product, Sum
from deodar.couplings.projections import DiagonalExpansion, DiagonalSum, Resample
from deodar.couplings.weights import Weights
from deodar.elements.stimuli import Boost
from deodar.errors import ModelError
from deodar.model.check import problems
from deodar.numerics.kernels._base import Kernel
from deodar.numerics.kernels.separable import Box, Shifted

X = dd.Axis("x", 0, 10, samples=11)
Y = dd.Axis("y", 0, 10, samples=11)
WIDE = dd.Axis("x", 0, 20, samples=11)


def _line() -> int:
    return sys._getframe(1).f_lineno


def test_a_valid_model_has_no_problems() -> None:
    model = dd.Model("m")
    (
        model.add(dd.GaussianStimulus("left", [X], center=5, amplitude=4))
        >> dd.Gain(2)
        >> model.add(dd.Field("u", [X], kernel=[dd.Gaussian(sigma=2)]))
    )
    assert model.check() == []
    model.require()


def test_every_problem_is_listed_at_once_with_its_line() -> None:
    model = dd.Model("m")
    u = model.add(dd.Field("u", [X], kernel=[dd.Gaussian(sigma=[1, 2])]))
    first = _line() - 1
    v = model.add(dd.Field("v", [Y]))
    second = _line() - 1
    w = model.add(dd.Field("w", [WIDE]), group="g")
    third = _line() - 1
    loose = model.add(dd.Gain(2, name="loose"))
    fourth = _line() - 1
    u >> v
    u >> w
    loose >> u
    by_place = {p.where: p.what for p in model.check()}
    file = __file__.rsplit("/", 1)[-1].rsplit("\\", 1)[-1]
    assert set(by_place) == {
        f"u ({file}:{first})",
        f"v ({file}:{second})",
        f"g.w ({file}:{third})",
        f"loose ({file}:{fourth})",
    }
    assert "kernel.0.sigma has 2 values for 1 axes" in by_place[f"u ({file}:{first})"]
    with pytest.raises(ModelError) as caught:
        model.require()
    assert "4 problems" in str(caught.value)
    assert all(where in str(caught.value) for where in by_place)


def test_axes_missing_on_both_sides_are_printed_with_the_project_to_write() -> None:
    model = dd.Model("m")
    model.add(dd.Field("u", [X])) >> model.add(dd.Field("v", [Y]))
    (problem,) = model.check()
    assert "u.output [x 0..10, 11 samples] does not fit v.input [y 0..10, 11 samples]" in problem.what
    assert problem.fix == (
        "Rename the axis by a coupling: model.disconnect('u.output', 'v.input')"
        " and u >> Project([y], rename={'x': 'y'}) >> v"
    )


LONG = dd.Axis("sum", 0, 20, samples=21)
UNIT = dd.Axis("y", 0, 1, samples=3)


@pytest.mark.parametrize(
    ("source", "target", "coupling"),
    [
        ([X], [Y], "Project([y], rename={'x': 'y'})"),
        ([X], [UNIT], "Weights(w, [y])"),
        ([X, Y], [LONG], "DiagonalSum([sum])"),
        ([LONG], [X, Y], "DiagonalExpansion([x, y])"),
        ([X], [WIDE], "Resample([x])"),
        ([X], [dd.Axis("x", 0, 10, samples=11, periodic=True)], "Resample([x])"),
    ],
)
def test_the_fix_for_different_axes_keeps_the_positions_of_the_source(
    source: list[dd.Axis], target: list[dd.Axis], coupling: str
) -> None:
    """Two positions of the source give two different inputs of the target."""
    seen: list[np.ndarray] = []
    for center in (3, 7):
        model = dd.Model("m")
        u = model.add(dd.GaussianStimulus("u", source, center=center, sigma=1, amplitude=6))
        v = model.add(dd.Field("v", target))
        u >> v
        (problem,) = model.check()
        assert f"u >> {coupling} >> v" in problem.fix
        model.disconnect(u, v)
        w = np.random.default_rng(0).random((*(a.samples for a in target), *(a.samples for a in source)))
        names = {a.name: a for a in target} | {
            "w": w,
            "Project": dd.Project,
            "Weights": Weights,
            "Resample": Resample,
        }
        u >> eval(coupling, names | {"DiagonalSum": DiagonalSum, "DiagonalExpansion": DiagonalExpansion}) >> v
        assert not any(p.severity == "problem" for p in model.check())
        seen.append(dd.simulate(model, duration=1, dt=1, record="v.input")["v.input"].isel(time=-1).values)
    assert np.abs(seen[0] - seen[1]).max() > 0.1 * np.abs(seen[0]).max()


def test_a_suggested_project_states_what_it_loses() -> None:
    model = dd.Model("m")
    model.add(dd.Field("u", [X])) >> model.add(dd.Field("v", [UNIT]))
    (problem,) = model.check()
    assert problem.fix.index("Weights") < problem.fix.index("Project([y]) >> v loses the signal")
    assert "v is uniform along y" in problem.fix


def test_units_that_differ_are_named() -> None:
    model = dd.Model("m")
    model.add(dd.Field("u", [X])) >> model.add(dd.Field("v", [dd.Axis("x", 0, 10, samples=11, unit="deg")]))
    (problem,) = model.check()
    assert (
        problem.fix.startswith("Write: one axis 'x' for both")
        and "only the units '' and 'deg' differ" in problem.fix
    )


def test_axes_of_other_bounds_print_both_and_the_resample_to_write() -> None:
    model = dd.Model("m")
    model.add(dd.Field("u", [X])) >> model.add(dd.Field("v", [WIDE]))
    (problem,) = model.check()
    assert "[x 0..10, 11 samples]" in problem.what and "[x 0..20, 11 samples]" in problem.what
    assert "bounds, unit or periodicity of 'x' differ" in problem.what
    assert "u >> Resample([x]) >> v" in problem.fix


@pytest.mark.parametrize(
    "axis",
    [
        dd.Axis("x", 0, 10, samples=11, unit="deg"),
        dd.Axis("x", 0, 10, samples=11, periodic=True),
        dd.Axis("x", 0, 10.001, samples=11),
    ],
)
def test_unit_periodicity_and_bounds_must_be_equal(axis: dd.Axis) -> None:
    model = dd.Model("m")
    model.add(dd.Field("u", [X])) >> model.add(dd.Field("v", [axis]))
    assert len(model.check()) == 1


@pytest.mark.parametrize("axis", [dd.Axis("x", 0, 10, samples=21), dd.Axis("x", 0, 10 + 1e-9, samples=11)])
def test_another_sampling_of_the_same_axis_fits(axis: dd.Axis) -> None:
    model = dd.Model("m")
    model.add(dd.Field("u", [X])) >> model.add(dd.Field("v", [axis]))
    assert model.check() == []


def test_a_loop_without_a_state_is_named() -> None:
    model = dd.Model("m")
    u = model.add(dd.Field("u", [X]))
    g, h = model.add(dd.Gain(1, name="g")), model.add(dd.Gain(1, name="h"))
    u >> g
    g >> h
    h >> g
    problems = model.check()
    assert any(
        "a loop without a state in it: g -> h -> g" in p.what
        or "a loop without a state in it: h -> g -> h" in p.what
        for p in problems
    )
    assert any("reads='delayed'" in p.fix for p in problems)
    model.disconnect(h, g)
    model.connect(h, g, reads="delayed")
    assert model.check() == []
    assert float(dd.simulate(model, duration=3, record="h.output", dt=1)["h.output"].isel(time=-1).max()) < 1


def test_a_delayed_loop_sums_its_input_over_time() -> None:
    model = dd.Model("m")
    one = model.add(Boost("one"))
    total = model.add(Sum(name="total"))
    one >> total
    model.connect(total, total, reads="delayed")
    assert model.check() == []
    record = dd.simulate(model, duration=4, record="total.output", dt=1)
    assert record["total.output"].values.tolist() == [1, 2, 3, 4, 5]


def test_axes_that_depend_only_on_themselves_are_unknown() -> None:
    model = dd.Model("m")
    g, h = model.add(dd.Gain(1, name="g")), model.add(dd.Gain(1, name="h"))
    g >> h
    model.connect(h, g, reads="delayed")
    assert any("follow only from themselves and are unknown: g -> h -> g" in p.what for p in model.check())


def test_a_loop_of_current_reads_is_named() -> None:
    model = dd.Model("m")
    u, v = model.add(dd.Field("u", [X])), model.add(dd.Field("v", [X]))
    model.connect(u, v, reads="current")
    model.connect(v, u, reads="current")
    (problem,) = model.check()
    assert "a loop of connections that read 'current'" in problem.what
    assert "u -> v" in problem.what or "v -> u" in problem.what
    assert "'previous'" in problem.fix and "'delayed'" in problem.fix
    model.disconnect(v, u)
    model.connect(v, u, reads="previous")
    assert model.check() == []


def test_a_field_that_reads_its_own_current_output_is_a_loop() -> None:
    model = dd.Model("m")
    u = model.add(dd.Field("u", [X]))
    model.connect(u, u, reads="current")
    (problem,) = model.check()
    assert "read 'current'" in problem.what and "u -> u" in problem.what


@pytest.mark.parametrize("reads", ["previous", "current"])
def test_the_output_of_a_coupling_has_no_step_of_its_own(reads: str) -> None:
    model = dd.Model("m")
    u, v = model.add(dd.Field("u", [X])), model.add(dd.Field("v", [X]))
    gain = u >> dd.Gain(2)
    model.connect(gain, v, reads=reads)
    (problem,) = model.check()
    assert f"says {reads!r}, but u>Gain shows no state" in problem.what
    assert "u>Gain.output -> v.input" in problem.what
    assert "Leave reads out" in problem.fix


def test_delayed_reads_are_allowed_for_elements_and_couplings() -> None:
    model = dd.Model("m")
    u, v = model.add(dd.Field("u", [X])), model.add(dd.Field("v", [X]))
    gain = u >> dd.Gain(2)
    model.connect(gain, v, reads="delayed")
    model.connect(u, v, reads="delayed")
    assert model.check() == []


def test_a_coupling_without_a_source_is_a_problem() -> None:
    model = dd.Model("m")
    model.add(dd.Gain(2, name="g"))
    (problem,) = model.check()
    assert "nothing is connected to g.input" in problem.what and "model.connect(..., 'g')" in problem.fix


def test_weights_of_another_shape_name_both() -> None:
    model = dd.Model("m")
    u = model.add(dd.Field("u", [X]))
    u >> Weights([[1.0, 2.0]], [Y], name="w")
    (problem,) = model.check()
    assert "weights has shape [1, 2], target and source have [11, 11] samples" in problem.what


def test_a_field_over_five_axes_is_refused() -> None:
    model = dd.Model("m")
    model.add(dd.Field("u", [dd.Axis(name, 0, 1, samples=2) for name in "abcde"]))
    (problem,) = model.check()
    assert "at most 4" in problem.what


def test_two_axes_of_one_name_are_refused() -> None:
    model = dd.Model("m")
    model.add(dd.Field("u", [X, X]))
    (problem,) = model.check()
    assert "two of its axes are called 'x'" in problem.what


def test_a_product_of_fields_over_different_axes_is_a_problem() -> None:
    model = dd.Model("m")
    u, v = model.add(dd.Field("u", [X])), model.add(dd.Field("v", [Y]))
    p = model.add(Product(name="p"))
    u >> p["input"]
    v >> p["factor"]
    assert any(
        "v.output [y 0..10, 11 samples] does not fit p.factor [x 0..10, 11 samples]" in q.what
        for q in model.check()
    )


def test_problems_of_a_source_are_not_repeated() -> None:
    """A coupling with an invalid source adds no problem of its own: one cause is one line."""
    model = dd.Model("m")
    loose = model.add(dd.Gain(1, name="loose"))
    loose >> dd.Gain(2, name="after") >> model.add(dd.Field("u", [X]))
    assert len(model.check()) == 1


def test_the_suggested_coupling_removes_the_problem() -> None:
    """For all axes that do not fit, each suggested coupling compiles."""
    x, y = dd.Axis("x", 0, 10, samples=11), dd.Axis("y", 0, 10, samples=6, unit="deg")
    hue, far = dd.Axis("hue", 0, 360, samples=12, periodic=True), dd.Axis("x", 0, 20, samples=11)
    names = {"dd": dd, "Project": dd.Project, "Resample": Resample, "Weights": Weights}
    for source, target in (([x], [y]), ([hue], [x]), ([x, hue], [y]), ([x], [far]), ([x, y], [far])):
        model = dd.Model("remedy")
        u, v = model.add(dd.Field("u", source)), model.add(dd.Field("an odd name", target))
        u >> v
        (problem,) = model.check()
        assert "u >> Project(" in problem.fix
        model.disconnect(u, v)
        w = np.zeros([a.samples for a in (*target, *source)])
        lines = re.findall(r"u >> .*? >> model\['an odd name'\]", problem.fix)
        assert lines
        for text in lines:
            before = model.document
            eval(text, names | {a.name: a for a in target} | {"u": u, "model": model, "w": w})
            assert problems(model.document) == [], text
            model.history.commit(before)


@pytest.mark.parametrize(
    "kernel", [dd.Gaussian(1, 1e30), dd.Gaussian(1, [1e30]), Box(1, 1e30), Shifted(dd.Gaussian(1, 1), 1e30)]
)
def test_a_kernel_beyond_any_axis_is_a_problem(kernel: Kernel) -> None:
    model = dd.Model("m")
    model.add(dd.Field("u", [X], kernel=[kernel]))
    (problem,) = model.check()
    assert (
        "kernel.0: " in problem.what
        and "is 1e+30, more than 1e+12 times the axis 'x' (10)" in problem.what
        and "at most 1e+13" in problem.what
    )
    with pytest.raises(ModelError):
        dd.simulate(model, duration=1, dt=1)
