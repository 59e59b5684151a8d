"""Files of branches and loci: what is read is what was written, with a model that works."""

from __future__ import annotations

import dataclasses as dc
import functools

import numpy as np
import pytest

import deodar as dd
from deodar.analysis import Locus, SteadyBranch
from deodar.errors import OutputExists, RecordError
from tests.deodar.analysis.continuation.models import line, node, node_folds, oscillator, plane, rivals


def assert_same(a: SteadyBranch, b: SteadyBranch) -> None:
    """Assert that two branches agree; states of even ones up to rounding."""
    assert b.data() == a.data() and (b.parameter, b.ended, b.not_refined) == (
        a.parameter,
        a.ended,
        a.not_refined,
    )
    for name in ("values", "rates", "growing"):
        assert np.array_equal(getattr(a, name), getattr(b, name))
    assert b.states == pytest.approx(a.states, abs=1e-13)
    assert len(a.bifurcations) == len(b.bifurcations)
    for old, new in zip(a.bifurcations, b.bifurcations, strict=True):
        apart = {f.name for f in dc.fields(old)} - {"state", "vector", "line"}
        assert {n: getattr(old, n) for n in apart} == {n: getattr(new, n) for n in apart}
        assert new.state == pytest.approx(old.state, abs=1e-13)
        assert new.vector == pytest.approx(old.vector, abs=1e-13)


@functools.cache
def whole_line() -> SteadyBranch:
    """Return a branch with both folds, each also on a finer grid."""
    return dd.continuation(line(51), "s.amplitude", (0, 8))


@pytest.mark.parametrize("name", ["branch.nc", "branch.zarr"])
def test_a_branch_survives_its_file(tmp_path, name):
    branch = whole_line()
    branch.save(tmp_path / name)
    loaded = SteadyBranch.load(tmp_path / name)
    assert_same(branch, loaded)
    assert np.array_equal(loaded.read("u.output"), branch.read("u.output"))
    up, same = branch.bifurcations[0], loaded.bifurcations[0]
    assert same.sensitivity == pytest.approx(up.sensitivity, rel=1e-9)
    with pytest.raises(OutputExists):
        branch.save(tmp_path / name)
    assert branch.save(tmp_path / name, force=True) == tmp_path / name


def test_other_programs_find_states_by_path_axis_and_parameter(tmp_path):
    branch = whole_line()
    record = dd.load_record(branch.save(tmp_path / "branch.nc"))
    assert record["u.activation"].dims == ("state", "x") and record["x"].size == 51
    assert record["value"].attrs["long_name"] == "s.amplitude"
    assert np.array_equal(record["u.activation"].values, branch.states)
    assert np.array_equal(record["bifurcation"], [b.value for b in branch.bifurcations])
    shape = len(branch.bifurcations), 51
    assert record["bifurcation:u.activation"].shape == record["mode:u.activation"].shape == shape


def test_a_loaded_branch_is_left_at_its_branch_point_and_followed_in_a_second_parameter(tmp_path):
    branch = dd.continuation(rivals(101), "u.global_inhibition", (0.32, 0.45), finer=False)
    branch.save(tmp_path / "both.nc")
    loaded = SteadyBranch.load(tmp_path / "both.nc")
    (point,) = loaded.bifurcations
    for old, new in zip(branch.switch(branch.bifurcations[0]), loaded.switch(point), strict=True):
        assert new.data() == old.data() or new.values == pytest.approx(old.values, abs=1e-6)
    curve = dd.locus(point, "u.kernel.0.amplitude", (11.9, 12.1), (0, 1))
    assert abs(curve.values[:, 0] - point.value).min() < 1e-6


def test_states_that_are_even_held_or_induced_are_restored(tmp_path):
    x = dd.Axis("state", 0, 100, samples=101)
    model = dd.Model("memory", dt=2)
    kernel = [dd.Gaussian(22, 5, normalized=True)]
    u = model.add(
        dd.Field("u", [x], tau=20, resting_level=-5, kernel=kernel, global_inhibition=0.4, noise=0.3)
    )
    model.add(dd.GaussianStimulus("input", [x], center=50, sigma=5, amplitude=0)) >> u
    model.add(dd.Boost("boost", [x], amplitude=0)) >> u
    # a second array over another axis of the same name, and a field that is held
    v = model.add(dd.Field("v", [dd.Axis("state", 0, 1, samples=11)], tau=10))
    model.add(dd.Field("w", tau=10))
    branch = dd.continuation(
        model, "boost.amplitude", (0, -4), {"input.amplitude": 8}, hold=["w"], even=["state"], finer=False
    )
    branch.save(tmp_path / "memory.nc")
    loaded = SteadyBranch.load(tmp_path / "memory.nc")
    assert_same(branch, loaded)
    before, new = branch.line.right_hand_side, loaded.line.right_hand_side
    assert new.even == ("state",) and new.held == before.held and new.dt == 2
    assert np.array_equal(loaded.line.parameters, branch.line.parameters)
    record = dd.load_record(tmp_path / "memory.nc")
    assert record["u.activation"].dims == ("state", "u.activation.state")
    assert record[f"{v.path}.activation"].dims == ("state", "v.activation.state")
    assert branch.bifurcations[-1].instability == "forgetting"


def test_a_branch_without_bifurcations_and_one_of_two_axes_survive(tmp_path):
    quiet = dd.continuation(node(), "s.amplitude", (-4, -3), finer=False)
    assert not quiet.bifurcations
    quiet.save(tmp_path / "quiet.nc")
    assert_same(quiet, SteadyBranch.load(tmp_path / "quiet.nc"))
    large = dd.continuation(plane(), "s.amplitude", (0, 2), finer=False)
    large.save(tmp_path / "large.zarr")
    loaded = SteadyBranch.load(tmp_path / "large.zarr")
    assert_same(large, loaded)
    assert loaded.line.right_hand_side.size > 600


def test_hopf_points_keep_their_frequency_and_step_value(tmp_path):
    branch = dd.continuation(oscillator(), "e.resting_level", (-4, 6), finer=False)
    branch.save(tmp_path / "hopf.nc")
    first = SteadyBranch.load(tmp_path / "hopf.nc").bifurcations[0]
    assert (first.kind, first.frequency) == ("Hopf", branch.bifurcations[0].frequency)
    assert first.step_value == branch.bifurcations[0].step_value and first.step_value is not None


@pytest.mark.parametrize("name", ["locus.nc", "locus.zarr"])
def test_a_locus_survives_its_file(tmp_path, name):
    fold = dd.continuation(node(), "s.amplitude", (0, 8)).bifurcations[0]
    curve = dd.locus(fold, "u.kernel.0.amplitude", (0.5, 10), (-10, 10))
    curve.save(tmp_path / name)
    loaded = Locus.load(tmp_path / name)
    assert loaded.data() == curve.data() and np.array_equal(loaded.values, curve.values)
    assert loaded.points == curve.points and loaded.distance((2, 6)) == curve.distance((2, 6))
    assert loaded.line is not None and loaded.line.right_hand_side.parameters == ("s.amplitude",)
    record = dd.load_record(tmp_path / name)
    assert record["second"].attrs["long_name"] == "u.kernel.0.amplitude"
    s, excitation = float(record["first"][3]), float(record["second"][3])
    assert min(abs(s - fold) for fold in node_folds(excitation)) < 1e-8
    loaded.over("u.kernel.0.amplitude", "s.amplitude").save(tmp_path / f"turned-{name}")
    turned = Locus.load(tmp_path / f"turned-{name}")
    assert turned.parameters == ("u.kernel.0.amplitude", "s.amplitude")


def test_a_locus_without_a_model_survives_its_file(tmp_path):
    plain = Locus("fold", ("a", "b"), np.array([[0.0, 1.0], [2.0, 3.0]]))
    plain.save(tmp_path / "plain.nc")
    assert Locus.load(tmp_path / "plain.nc").data() == plain.data()


def test_other_records_are_refused(tmp_path):
    dd.save_record(dd.simulate(node(), 10), tmp_path / "run.nc")
    with pytest.raises(RecordError, match="without a branch of steady states"):
        SteadyBranch.load(tmp_path / "run.nc")
    with pytest.raises(RecordError, match="without a locus"):
        Locus.load(tmp_path / "run.nc")
    with pytest.raises(RecordError, match="there is no such record"):
        Locus.load(tmp_path / "nothing.nc")
    content = bytearray(
        dd.continuation(line(), "s.amplitude", (0, 1), finer=False).save(tmp_path / "b.nc").read_bytes()
    )
    content[-200] ^= 1
    (tmp_path / "b.nc").write_bytes(content)
    with pytest.raises(RecordError):
        SteadyBranch.load(tmp_path / "b.nc")
