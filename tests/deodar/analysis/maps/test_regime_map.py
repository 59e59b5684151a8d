"""Labels of maps of regimes against single measurements, closed forms and computed folds."""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd
from deodar.analysis.maps.labels import WORDS, RegimeLabel
from deodar.errors import AnalysisError, DeodarError, ParameterError, UnknownName

EXCITATION, INHIBITION = "u.kernel.0.amplitude", "u.global_inhibition"


def line(samples: int = 101, excitation: float = 8.0, inhibition: float = 0.1, **values) -> dd.Model:
    x = dd.Axis("x", 0, 100, samples, **{k: values.pop(k) for k in ("periodic",) if k in values})
    model = dd.Model("line")
    kernel = [dd.Gaussian(excitation, 5, normalized=True)]
    options = {"tau": 20, "resting_level": -5, "kernel": kernel, "global_inhibition": inhibition} | values
    model.add(dd.Field("u", [x], **options))
    return model


def node() -> dd.Model:
    model = dd.Model("node")
    model.add(dd.Field("u", tau=20, resting_level=-5, kernel=[dd.Gaussian(6.0)]))
    return model


def measured(excitation: float, inhibition: float, strength: float, **axis) -> str:
    """Return the word of a cell by single measurements of the same field, in double precision."""
    isolated = dd.isolate(line(31, excitation, inhibition, **axis), "u", sigma=5, precision="float64")
    isolated.reset()
    isolated.settle()
    if isolated.peaks():
        return "active at rest"
    isolated.put(input=strength)
    isolated.settle()
    if not isolated.peaks():
        return "silent"
    memory = dd.outlives(isolated, strength)
    if isolated.covers(memory.driven) or isolated.covers(memory.left):
        return "unbounded"
    selects = len(dd.selection(isolated, strength).equal) == 1
    words = {(False, False): "input-driven", (True, False): "self-sustained"}
    return (words | {(False, True): "selective", (True, True): "self-sustained and selective"})[
        memory.outlives, selects
    ]


@pytest.mark.parametrize("periodic", [False, True])
def test_labels_agree_with_single_measurements(periodic):
    model = line(31, periodic=periodic)
    regime_map = dd.regime_map(
        model, {EXCITATION: (2, 30, 5), INHIBITION: (0, 1.2, 4)}, sigma=5, refine=False
    )
    words = {
        (e, c): measured(e, c, 6.0, periodic=periodic)
        for e in regime_map.values[0]
        for c in regime_map.values[1]
    }
    assert [regime_map.word(*at) for at in words] == list(words.values())
    assert len(set(words.values())) >= 5


@pytest.mark.parametrize(
    ("excitation", "inhibition", "begin"),
    [
        (8.0, 0.1, "input-driven"),
        (22.0, 0.4, "self-sustained"),
        (12.0, 0.6, "selective"),
        (30.0, 0.0, "unbounded"),
    ],
)
def test_labels_agree_with_regimes(excitation, inhibition, begin):
    grid = {EXCITATION: [excitation, 31], INHIBITION: [inhibition, 2]}
    regimes = dd.regimes(line(51, excitation, inhibition), "u")
    words, up = regimes.words, regimes.thresholds.detection
    # regimes tests memory and selection with 1.2 times the detection threshold
    word = dd.regime_map(line(51), grid, strength=1.2 * up.after).words[0, 0]
    assert word.startswith(begin)
    assert ("selective (two inputs, one peak)" in words) == ("selective" in word)
    assert words[0].startswith("self-sustained") == word.startswith("self-sustained")
    assert words[0].startswith("unbounded") == word.startswith("unbounded")


def node_label(excitation: float, level: float, strength: float) -> RegimeLabel:
    """Return the label of a node from the roots of -u + h + s + w g(u), with g the logistic function."""
    u = np.linspace(-15, 40, 550_001)
    drive = level - u + excitation / (1 + np.exp(-4 * u))
    resting = u[(u >= level) & (drive <= 0)].min()  # the first root above the start
    if resting > 0:
        return RegimeLabel.ACTIVE
    driven = u[(u >= resting) & (drive + strength <= 0)].min()
    if driven <= 0:
        return RegimeLabel.SILENT
    decayed = u[(u <= driven) & (drive >= 0)].max()  # the first root below it
    return RegimeLabel.SUSTAINED if decayed > 0 else RegimeLabel.DRIVEN


def test_a_node_follows_its_closed_form():
    grid = {EXCITATION: (1, 12, 12), "u.resting_level": (-9.2, -1.2, 17)}
    regime_map = dd.regime_map(node(), grid, strength=6.0, precision="float64")
    levels = regime_map.values[1]
    expected = [[node_label(w, h, 6.0) for h in levels] for w in regime_map.values[0]]
    assert regime_map.labels.tolist() == expected
    assert len(np.unique(regime_map.labels)) == 4


def test_the_border_of_silence_is_the_fold_that_continuation_finds():
    strength = 4.0
    model = line()
    model.add(dd.GaussianStimulus("s", model["u"].axes, center=50, sigma=5, amplitude=strength)) >> model["u"]
    branch = dd.continuation(model, "u.resting_level", (-7, -2), finer=False)
    fold = next(b for b in branch.bifurcations if b.instability == "detection").value
    grid = {"u.resting_level": (fold - 0.1, fold + 0.1, 41), INHIBITION: [0.1, 0.2]}
    regime_map = dd.regime_map(model, grid, strength=strength, sigma=5)
    first = int((regime_map.labels[:, 0] != RegimeLabel.SILENT).argmax())
    below, above = regime_map.values[0][first - 1 : first + 1]
    assert above - below == pytest.approx(0.005)
    assert below - 0.005 <= fold <= above


def test_refinement_gives_the_labels_of_the_full_grid():
    grid = {EXCITATION: (1, 30, 37), INHIBITION: (0, 1.5, 41)}
    some, all_ = (dd.regime_map(line(51), grid, refine=refine) for refine in (True, False))
    assert (some.labels == all_.labels).all()
    assert all_.computed.all() and some.computed.mean() < 0.6
    assert len(some.shares) >= 5


def test_single_precision_has_the_labels_of_double_precision():
    grid = {EXCITATION: (1, 30, 24), INHIBITION: (0, 1.5, 24)}
    single, double = (dd.regime_map(line(51), grid, precision=p) for p in ("float32", "float64"))
    differ = np.argwhere(single.labels != double.labels)
    assert len(differ) <= 2


def test_a_width_is_rebuilt_in_each_cell():
    grid = {"u.kernel.0.sigma": [3, 5, 8], INHIBITION: [0.1, 0.8]}
    regime_map = dd.regime_map(line(51, 12), grid, sigma=5)
    for i, width in enumerate(regime_map.values[0]):
        for j, inhibition in enumerate(regime_map.values[1]):
            model = line(51, 12, float(inhibition))
            model.set("u.kernel.0.sigma", float(width))
            memory = dd.outlives(dd.isolate(model, "u", sigma=5), 6.0)
            assert memory.outlives == ("self-sustained" in regime_map.words[i, j])


def test_a_field_that_does_not_settle_has_a_label():
    """A strong inhibition with a long Euler step makes the activation alternate."""
    model = line(51, 12, 0.2)
    regime_map = dd.regime_map(model, {INHIBITION: [0.1, 3], EXCITATION: [12, 13]}, dt=18, limit=50)
    assert (regime_map.labels[1] == RegimeLabel.RESTLESS).all()
    assert not (regime_map.labels[0] == RegimeLabel.RESTLESS).any()


def test_document_parameters_and_kept_inputs_are_mapped():
    model = line()
    u = model["u"]
    model.add(dd.Boost("boost", u.axes, amplitude=0.0)) >> u
    model.parameter("strength", 0.1)
    model.link(INHIBITION, "strength")
    regime_map = dd.regime_map(
        model, {"strength": [0.1, 0.6], "boost.amplitude": [-9, 0, 9]}, inputs=["boost"]
    )
    assert regime_map.words[0].tolist() == ["silent", "input-driven", "active at rest"]
    assert regime_map.at == (0.1, 0.0) and regime_map.about["inputs"] == ["boost"]


def test_the_threshold_may_be_mapped():
    regime_map = dd.regime_map(line(), {"u.sigmoid.threshold": [-4, 0, 4], INHIBITION: [0.1, 0.2]})
    assert regime_map.words[:, 0].tolist()[1:] == ["input-driven", "silent"]


def test_noise_is_off():
    grid = {EXCITATION: [4, 8, 16], INHIBITION: [0.1, 0.2, 0.4]}
    noisy, quiet = (dd.regime_map(line(noise=noise), grid) for noise in (3.0, 0.0))
    assert (noisy.labels == quiet.labels).all()
    with pytest.raises(AnalysisError, match="noise is off in the measurement"):
        dd.regime_map(line(noise=3.0), {"u.noise": [0.1, 0.2], INHIBITION: [0.1, 0.2]})


@pytest.mark.parametrize(
    ("numbers", "says"),
    [
        ((1, 1, 5), "do not grow"),
        ((2, 1, 5), "do not grow"),
        ((1, float("nan"), 5), "not all finite"),
        ([1.0, float("inf")], "not all finite"),
        ((1, 2, 1), "needs 2 or more"),
        ((1, 2, 2.5), "needs 2 or more"),
        ([1.0], "needs 2 or more"),
        ([], "needs 2 or more"),
        ("abc", "expected numbers"),
        (3.0, "expected numbers"),
    ],
)
def test_values_that_are_no_axis_are_answered(numbers, says):
    with pytest.raises(ParameterError, match=says):
        dd.regime_map(line(), {EXCITATION: numbers, INHIBITION: [0.1, 0.2]})


@pytest.mark.parametrize(
    ("path", "error", "says"),
    [
        ("u.kernel.0.amplitud", DeodarError, "Did you mean 'amplitude'"),
        ("u.resting_levl", UnknownName, "Did you mean 'resting_level'"),
        ("v.resting_level", UnknownName, "nothing is called"),
        ("u.quadrature", ParameterError, "makes another program"),
        ("u.tau", AnalysisError, "do not depend on it"),
        ("s.amplitude", AnalysisError, "measured alone"),
    ],
)
def test_paths_that_cannot_be_mapped_are_answered(path, error, says):
    model = line()
    model.add(dd.GaussianStimulus("s", model["u"].axes, center=50)) >> model["u"]
    with pytest.raises(error, match=says):
        dd.regime_map(model, {path: [1, 2], INHIBITION: [0.1, 0.2]})


def test_values_out_of_the_range_of_a_parameter_are_answered():
    with pytest.raises(ParameterError, match="sigma"):
        dd.regime_map(line(), {"u.kernel.0.sigma": [-1, 2], INHIBITION: [0.1, 0.2]})


def test_other_mistakes_are_answered():
    x, y = dd.Axis("x", 0, 10, 11), dd.Axis("y", 0, 10, 11)
    model = line()
    grid = {EXCITATION: [1, 2], INHIBITION: [0.1, 0.2]}
    with pytest.raises(ParameterError, match="two parameters, not 1"):
        dd.regime_map(model, {EXCITATION: [1, 2]})
    with pytest.raises(ParameterError, match="strength is -1"):
        dd.regime_map(model, grid, strength=-1)
    with pytest.raises(ParameterError, match="limit is nan"):
        dd.regime_map(model, grid, limit=float("nan"))
    with pytest.raises(UnknownName, match="Valid names: u"):
        dd.regime_map(model, grid, field="uu")
    model.add(dd.Field("plane", [x, y]))
    with pytest.raises(AnalysisError, match="2 fields"):
        dd.regime_map(model, grid)
    plane = {"plane.resting_level": [-5, -4], "plane.global_inhibition": [0, 1]}
    with pytest.raises(AnalysisError, match="counts peaks on one axis"):
        dd.regime_map(model, plane, "plane")


def test_a_map_survives_its_file(tmp_path):
    regime_map = dd.regime_map(line(31), {EXCITATION: (1, 30, 9), INHIBITION: (0, 1.5, 9)})
    regime_map.save(tmp_path / "map.nc")
    loaded = dd.analysis.RegimeMap.load(tmp_path / "map.nc")
    assert loaded.data() == regime_map.data()
    assert (loaded.computed == regime_map.computed).all() and loaded.labels.dtype == np.uint8
    assert loaded.provenance["made_by"]["deodar"] == dd.__version__
    assert loaded.document == regime_map.document == line(31).document
    record = dd.load_record(tmp_path / "map.nc")
    assert record["regime_map"].attrs["flag_meanings"].split()[0] == "silent"
    broken = dd.open_record(tmp_path / "map.nc").load()
    broken[EXCITATION] = [float("nan"), *broken[EXCITATION].values[1:]]
    dd.save_record(broken, tmp_path / "broken.nc")
    with pytest.raises(DeodarError, match=r"broken\.nc: is damaged: the values of .* are not all finite"):
        dd.analysis.RegimeMap.load(tmp_path / "broken.nc")
    dd.save_record(dd.simulate(line(31), 10), tmp_path / "run.nc")
    with pytest.raises(DeodarError, match="without a map"):
        dd.analysis.RegimeMap.load(tmp_path / "run.nc")


def test_progress_counts_cells():
    reports: list[tuple[int, int]] = []
    regime_map = dd.regime_map(
        line(31),
        {EXCITATION: (1, 30, 9), INHIBITION: (0, 1.5, 9)},
        on=dd.Resources(progress=lambda now: reports.append((int(now), now.of))),
    )
    assert reports[-1] == (int(regime_map.computed.sum()),) * 2
    assert [done for done, _ in reports] == sorted(done for done, _ in reports)
    assert "cells over u.kernel.0.amplitude" in repr(regime_map) and set(regime_map.words.ravel()) <= set(
        WORDS
    )
