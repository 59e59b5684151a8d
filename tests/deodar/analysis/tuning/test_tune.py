"""Tuned models, judged by closed forms and by other measurements; what is not reached, and bad input."""

from __future__ import annotations

import sys
from dataclasses import dataclass

import numpy as np
import pytest

import deodar as dd
from deodar.errors import AnalysisError, MissingExtra, ParameterError, UnknownName
from tests.deodar.analysis.continuation.models import node_folds
from tests.deodar.analysis.maps.test_regime_map import EXCITATION, INHIBITION, line, node

LEVEL, WIDTH = "u.resting_level", "u.kernel.0.sigma"


def fine(samples: int = 33) -> dd.Model:
    """Return a field whose peaks have widths that change smoothly."""
    x = dd.Axis("x", 0, 40, samples)
    model = dd.Model("fine")
    kernel = [dd.Gaussian(20, 3, normalized=True)]
    options = {"tau": 20, "resting_level": -4, "kernel": kernel, "global_inhibition": 1.0}
    model.add(dd.Field("u", [x], quadrature="cell", **options))
    return model


@pytest.fixture(scope="module")
def tuned():
    requirements = [dd.detects(3.0, within=0.2), dd.remembers(), dd.selects(), dd.peak_width(8, within=0.5)]
    bounds = {LEVEL: (-6, -2), EXCITATION: (5, 40), WIDTH: (1.5, 8), INHIBITION: (0.1, 2)}
    return dd.tune(fine(), [LEVEL, EXCITATION, WIDTH, INHIBITION], requirements, bounds=bounds, sigma=4)


def test_all_requirements_are_met_and_stated_values_exact(tuned):
    assert tuned.met and not tuned.missed and not tuned.interrupted
    assert min(tuned.margins.values()) > 0.5
    assert tuned.exact == ("detects(at=3, within=0.2)", "peak_width(width=8, within=0.5)")
    assert tuned.reached["detects(at=3, within=0.2)"] == pytest.approx(3, abs=1e-7)
    assert tuned.reached["peak_width(width=8, within=0.5)"] == pytest.approx(8, abs=1e-7)


def test_the_result_says_how_it_was_measured(tuned):
    summary = tuned.data()
    assert summary["met"] and summary["not_exact"] is None and summary["precision"] == "float32"
    assert summary["strength"] == pytest.approx(3.6) and summary["places"] == [10.0, 30.0]
    assert (summary["sigma"], summary["dt"]) == ([4.0], 2.0)
    assert summary["bounds"][WIDTH] == [1.5, 8.0] and summary["candidates"] >= 512
    # plain data, and a sentence for each requirement
    assert repr(tuned).startswith("<Tuned u: meets all requirements") and repr(tuned).count("  met") == 4


def test_regimes_measures_the_same(tuned):
    measured = dd.regimes(tuned.model, "u", sigma=4, accuracy=1e-3, precision="float64")
    assert measured.detection == pytest.approx(3, abs=3e-3)
    assert measured.self_sustained and measured.selection.selects
    assert measured.memory.driven[0].width[0] == pytest.approx(8, abs=0.02)


def test_the_model_that_was_given_stays_as_it_is(tuned):
    assert tuned.before[LEVEL] == -4 and tuned.model.get(LEVEL) == tuned.values[LEVEL] != -4
    assert tuned.model.get(WIDTH) == tuned.values[WIDTH]


def test_the_derivative_of_a_value_is_that_of_differences(tuned):
    name, step = "detects(at=3, within=0.2)", 1e-3
    for path in (LEVEL, WIDTH):
        folds = []
        for sign in (-1, 1):
            document = dd.isolate(tuned.model, "u", sigma=4).session.document
            model = dd.Model(document=document)
            model.set(path.replace("u.", "field."), tuned.values[path] * (1 + sign * step))
            branch = dd.continuation(model, "input.amplitude", (0, 4), even=["x"], finer=False)
            folds += [b.value for b in branch.bifurcations if b.instability == "detection"]
        slope = (folds[1] - folds[0]) / (2 * step)
        # relative to the magnitude, so that a step of a negative level is towards larger magnitudes
        sign = np.sign(tuned.values[path])
        assert sign * tuned.sensitivity[name][path] == pytest.approx(slope, rel=1e-3)


def test_the_region_is_one_in_which_all_are_met(tuned):
    alone = tuned.tolerated_alone
    assert 0.005 < tuned.tolerated <= min(min(pair) for pair in alone.values())
    # the resting level alone moves detection out of its tolerance
    for move, inside in ((0.9 * alone[LEVEL][1], True), (1.5 * alone[LEVEL][1], False)):
        moved = dd.Model(document=tuned.model.document)
        moved.set(LEVEL, tuned.values[LEVEL] + move * abs(tuned.values[LEVEL]))
        measured = dd.regimes(moved, "u", sigma=4)
        assert (abs(measured.detection - 3) <= 0.2 and measured.self_sustained) == inside


def test_folds_of_a_node_are_reached_exactly():
    requirements = [dd.detects(3.5, within=0.1), dd.reverse(1.0, within=0.1)]
    tuned = dd.tune(node(), [LEVEL, EXCITATION], requirements, seed=3)
    assert tuned.met and len(tuned.exact) == 2
    level, excitation = tuned.values[LEVEL], tuned.values[EXCITATION]
    folds = np.array(node_folds(excitation)) - 5 - level
    assert folds == pytest.approx([3.5, 1.0], abs=1e-8)


def test_equal_seeds_give_equal_results():
    requirements = [dd.detects(3.5, within=0.1), dd.forgets()]
    tuned = [dd.tune(node(), [LEVEL, EXCITATION], requirements, seed=seed) for seed in (1, 1, 2)]
    assert tuned[0].data() == tuned[1].data()
    assert tuned[0].values != tuned[2].values


def test_a_field_of_a_whole_architecture_is_measured_alone():
    model = line(31)
    v = model.add(dd.Field("v", tau=20, resting_level=-5, kernel=[dd.Gaussian(6.0)]))
    model.add(dd.Boost("s", amplitude=3.0)) >> v
    tuned = dd.tune(model, ["v.resting_level"], [dd.detects(3.2, within=0.05)], field="v")
    assert tuned.met and tuned.field == "v" and len(tuned.model.document.entries) == 3
    assert -5 - tuned.values["v.resting_level"] == pytest.approx(3.2 - node_folds()[0], abs=1e-6)


def test_a_document_parameter_moves_all_it_drives():
    model = node()
    model.parameter("level", -5.0)
    model.link(LEVEL, "level")
    tuned = dd.tune(model, ["level"], [dd.detects(3.2, within=0.05)])
    assert tuned.met and tuned.model.get("level") == tuned.model.get(LEVEL) == tuned.values["level"]


def test_what_is_not_reached_is_said():
    # a node without enough excitation has no memory at its resting level
    requirements = [dd.detects(3.5, within=0.1), dd.remembers()]
    bounds = {LEVEL: (-6, -4), EXCITATION: (1, 3)}
    tuned = dd.tune(node(), [LEVEL, EXCITATION], requirements, bounds=bounds, budget=300)
    assert not tuned.met and tuned.missed and tuned.tolerated == 0
    assert tuned.unreachable == ("remembers()",)
    assert "NOT MET  remembers()" in repr(tuned)
    assert "no candidate met remembers()" in repr(tuned)


def test_a_pair_that_no_candidate_meets_is_named():
    # with one free parameter: detection at 3.5 needs another level than an amplitude of 7
    requirements = [dd.detects(3.5, within=0.1), dd.peak_amplitude(7, within=0.5, strength=8.0)]
    tuned = dd.tune(node(), [LEVEL], requirements, budget=400)
    assert not tuned.met
    ((first, second, best),) = tuned.conflicts
    assert (first, second) == tuple(str(requirement) for requirement in requirements) and best < 0
    assert f"no candidate met both {first} and {second}" in repr(tuned)


@pytest.mark.parametrize("after", [1, 30])
def test_an_interrupt_returns_the_best_so_far(after):
    calls = []

    def stop(progress):
        calls.append(progress.margin)
        if len(calls) == after:
            raise KeyboardInterrupt

    requirements = [dd.detects(3.5, within=1e-4), dd.reverse(1.0, within=1e-4)]
    tuned = dd.tune(node(), [LEVEL, EXCITATION], requirements, on=dd.Resources(progress=stop))
    assert tuned.interrupted and "interrupted" in repr(tuned)
    assert min(tuned.margins.values()) == pytest.approx(calls[-1], abs=1e-3)


def test_without_the_package_the_error_says_how_to_install_it(monkeypatch):
    monkeypatch.setitem(sys.modules, "cma", None)
    with pytest.raises(MissingExtra, match=r"pip install 'deodar\[tune\]'"):
        dd.tune(node(), [LEVEL], [dd.detects(3.5, within=0.1)])


@dataclass(frozen=True)
class LowRest(dd.Requirement):
    """The resting activation is below a value."""

    below: float

    def margin(self, response):
        return self.below - response.above(dd.FieldInput())


@dataclass(frozen=True)
class WrongShape(dd.Requirement):
    def margin(self, response):
        return np.zeros(3)


def test_users_write_their_own_requirements():
    tuned = dd.tune(node(), [LEVEL, EXCITATION], [dd.detects(3.5, within=0.1), LowRest(-4.2)])
    assert tuned.met and tuned.values[LEVEL] < -4.2
    with pytest.raises(AnalysisError, match="has the shape"):
        dd.tune(node(), [LEVEL], [WrongShape()])


@pytest.mark.parametrize(
    ("requirements", "message"),
    [
        ([dd.detects(3, within=0.1), dd.reverse(4, within=0.1)], "contradicts"),
        ([dd.detects(3, within=0.1), dd.detects(4, within=0.1)], "contradicts"),
        ([dd.remembers(), dd.forgets()], "contradicts"),
        ([dd.forgets(-1, within=0.1), dd.forgets()], "contradicts"),
        ([dd.remembers(), dd.reverse(1, within=0.5)], "contradicts"),
        ([dd.remembers(), dd.relaxes_within(30)], "contradicts"),
        ([dd.selects(), dd.multi_peak()], "contradicts"),
        ([dd.peak_width(8, within=1), dd.peak_width(12, within=1)], "contradicts"),
        ([dd.peak_amplitude(8, within=1), dd.peak_amplitude(12, within=1)], "contradicts"),
    ],
)
def test_requirements_that_contradict_each_other_are_refused(requirements, message):
    with pytest.raises(AnalysisError, match=message):
        dd.tune(line(31), [LEVEL], requirements)


@pytest.mark.parametrize(
    ("model", "arguments", "error", "message"),
    [
        (line(31), ([LEVEL], []), ParameterError, "no requirement is given"),
        (line(31), ([], [dd.rests()]), ParameterError, "expected one path or more"),
        (line(31), (LEVEL, [dd.rests()]), ParameterError, "expected one path or more"),
        (line(31), ([LEVEL], [3]), ParameterError, "expected a requirement, not 3"),
        (line(31), ([LEVEL], [dd.rests(), dd.rests()]), ParameterError, "is required twice"),
        (line(31), ([LEVEL, LEVEL], [dd.rests()]), ParameterError, "is named twice"),
        (line(31), (["u.resting_leve"], [dd.rests()]), UnknownName, "Did you mean 'resting_level'"),
        (line(31), (["u.sigmoid"], [dd.rests()]), ParameterError, "is not one number"),
        (line(31), (["u.noise"], [dd.rests()]), ParameterError, "bounds cannot be guessed"),
        (line(31), ([LEVEL, "u.tau"], [dd.rests()]), AnalysisError, "changes no regime"),
        (node(), ([LEVEL], [dd.selects()]), AnalysisError, "has no meaning on a node"),
    ],
)
def test_bad_input_is_refused(model, arguments, error, message):
    with pytest.raises(error, match=message):
        dd.tune(model, *arguments)


@pytest.mark.parametrize(
    ("bounds", "message"),
    [
        ({LEVEL: (-1, -5)}, "the lower one first"),
        ({LEVEL: (float("nan"), 1)}, "expected finite numbers"),
        ({LEVEL: 3}, r"expected \(low, high\)"),
        ({"u.taus": (1, 2)}, "is not among the parameters"),
    ],
)
def test_bounds_that_are_none_are_refused(bounds, message):
    with pytest.raises(ParameterError, match=message):
        dd.tune(line(31), [LEVEL], [dd.rests()], bounds=bounds)


def test_a_parameter_of_another_element_is_refused():
    model = line(31)
    model.add(dd.Field("v", tau=20, resting_level=-5, kernel=[dd.Gaussian(6.0)]))
    with pytest.raises(AnalysisError, match="does not belong to u"):
        dd.tune(model, ["v.resting_level"], [dd.rests()], field="u")
    with pytest.raises(AnalysisError, match="has 2 fields"):
        dd.tune(model, ["v.resting_level"], [dd.rests()])
