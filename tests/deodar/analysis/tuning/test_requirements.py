"""Margins of requirements where it is known whether they are met."""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd
from deodar.analysis.isolated import WHOLE
from deodar.analysis.tuning.protocol import TuningProtocol
from deodar.analysis.tuning.request import requested
from deodar.analysis.tuning.response import MISSED, STEP, FieldResponse, SettledBatch
from deodar.errors import ParameterError
from tests.deodar.analysis.continuation.models import node_folds
from tests.deodar.analysis.maps.test_regime_map import EXCITATION, INHIBITION, line, node

FIELDS = {"driven": (8.0, 0.1), "memory": (22.0, 0.4), "selective": (12.0, 0.6), "unbounded": (30.0, 0.0)}
"""Excitation and inhibition of fields whose regimes with inputs of 6 and width 5 are known; see the tests of
maps.
"""


def margins(model, parameters, values, requirements, **options) -> np.ndarray:
    """Return the margins of candidates, (candidates, requirements)."""
    bounds = {path: (-1e3, 1e3) for path in parameters if path == "u.resting_level"}
    request = requested(model, parameters, requirements, "", bounds, options)
    parts = [
        np.stack([requirement.margin(response) for requirement in requirements], axis=1)
        for response, _ in TuningProtocol(request).responses(np.array(values, float))
    ]
    return np.concatenate(parts)


def test_on_off_requirements_are_met_by_the_fields_of_which_it_is_known():
    requirements = {
        "remembers": dd.remembers(),
        "forgets": dd.forgets(),
        "selects": dd.selects(),
        "multi_peak": dd.multi_peak(strength=6.0),
        "rests": dd.rests(),
        "relaxes": dd.relaxes_within(60),
        "soon": dd.relaxes_within(1.0),
    }
    expected = {
        "driven": {"forgets", "multi_peak", "rests", "relaxes"},
        "memory": {"remembers", "multi_peak", "rests"},
        "selective": {"forgets", "selects", "rests", "relaxes"},
        "unbounded": {"rests"},
    }
    # some contradict each other: one request each
    met = {name: set() for name in FIELDS}
    for kind, requirement in requirements.items():
        found = margins(
            line(101), [EXCITATION, INHIBITION], list(FIELDS.values()), [requirement], strength=6, sigma=5
        )
        assert (found <= 1).all()
        for name, margin in zip(FIELDS, found[:, 0], strict=True):
            if margin >= 0:
                met[name].add(kind)
    assert met == expected


def test_thresholds_of_a_field_lie_where_they_are_computed():
    model = line(101)
    up, down = 4.326958, 3.049414
    requirements = [
        dd.detects(up + 0.02, within=0.05),
        dd.detects(up + 0.02, within=0.01),
        dd.reverse(down - 0.02, within=0.05),
        dd.reverse(down - 0.02, within=0.01),
    ]
    options = {"strength": 6.0, "sigma": 5, "precision": "float64"}
    signs = [
        margins(model, [INHIBITION], [[0.1]], [requirement], **options)[0, 0] >= 0
        for requirement in requirements
    ]
    assert signs == [True, False, True, False]


def test_width_and_amplitude_are_those_of_peaks():
    isolated = dd.isolate(line(101), "u", sigma=5, precision="float64")
    isolated.reset(input=6.0)
    isolated.settle()
    peak = isolated.peaks()[0]
    width, height = peak.width[0], peak.amplitude
    requirements = [
        dd.peak_width(width, within=0.5),
        dd.peak_width(width + 0.25, within=0.5, strength=6.0),
        dd.peak_amplitude(height, within=0.1),
        dd.peak_amplitude(height + 0.2, within=0.1, strength=6.0),
    ]
    options = {"strength": 6.0, "sigma": 5, "precision": "float64"}
    reached = [
        margins(line(101), [INHIBITION], [[0.1]], [requirement], **options)[0, 0]
        for requirement in requirements
    ]
    assert reached == pytest.approx([1, 0.5, 1, -1], abs=5e-3)


def test_the_forgetting_threshold_lies_where_it_is_measured():
    model = line(101, 22.0, 0.4)
    isolated = dd.isolate(model, "u", sigma=5, precision="float64")
    forgotten = dd.forgetting(isolated, 6.0, accuracy=1e-3).value
    options = {"strength": 6.0, "sigma": 5, "precision": "float64"}
    requirements = [dd.forgets(forgotten + 0.02, within=0.05), dd.forgets(forgotten + 0.1, within=0.05)]
    reached = [
        margins(model, [INHIBITION], [[0.4]], [requirement], **options)[0, 0] for requirement in requirements
    ]
    assert reached[0] >= 0 > reached[1]


def test_thresholds_of_a_node_are_those_of_the_closed_form():
    up, down = node_folds()
    requirements = [dd.detects(up, 0.02), dd.reverse(down, 0.02)]
    reached = margins(node(), ["u.resting_level"], [[-5], [-4.9], [-5.1]], requirements, precision="float64")
    assert (reached[0] >= 0).all()
    assert (reached[1:] < 0).all()


def test_the_time_of_relaxation_is_that_of_the_closed_form():
    """A node without interaction falls from h + s to h: u = h + s exp(-t / tau)."""
    model = dd.Model("node")
    model.add(dd.Field("u", tau=20, resting_level=-5, kernel=[]))
    request = requested(
        model, ["u.resting_level"], [dd.relaxes_within(20)], "", None, {"strength": 8.0, "dt": 0.05}
    )
    response, _ = next(TuningProtocol(request).responses(np.array([[-5.0], [-4.0]])))
    times = request.requirements[0].value(response)
    assert times == pytest.approx(20 * np.log(8 / np.array([5.0, 4.0])), rel=0.01)


@pytest.mark.parametrize(
    ("below", "margin"), [(2 * STEP, 1.0), (0.5 * STEP, 0.5), (0.0, MISSED), (-STEP, -1.0)]
)
def test_a_peak_that_nearly_covers_its_field_has_a_small_margin(below: float, margin: float):
    axis = dd.Axis("x", 0, 50, 51)
    widest = WHOLE * axis.range
    width = widest - below * widest
    response = FieldResponse(lambda stages: batch, (axis,), 1.0, 1.0, np.zeros(1), (10, 40), 10.0)
    ones = np.ones(1)
    batch = SettledBatch(np.full((1, 51), 5.0), ones, width * ones, ones > 0, ones)
    assert response.active(response.after()).tolist() == [pytest.approx(margin)]


def test_a_margin_grows_towards_where_the_requirement_is_met():
    # excitation that does not suffice for a memory: the peak outlasts its input longer
    reached = margins(line(101), [EXCITATION], [[5], [8], [10]], [dd.remembers()], strength=6, sigma=5)[:, 0]
    assert (reached < 0).all() and (np.diff(reached) > 0).all()


def test_a_field_that_is_not_finite_meets_nothing():
    requirements = [dd.rests(), dd.peak_width(5, within=100), dd.peak_amplitude(0, within=1e9, strength=1.0)]
    reached = margins(line(31), ["u.resting_level"], [[np.inf], [-5]], requirements)
    assert (reached[0] < 0).all() and reached[1, 0] == 1


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: dd.detects(3, within=0), "detects.within: is 0, below its lower bound"),
        (lambda: dd.detects(float("nan"), within=1), "detects.at: needs a finite number, not nan"),
        (lambda: dd.peak_width(-1, within=1), "peak_width.width: is -1, below"),
        (lambda: dd.reverse("a", within=1), "reverse.at: needs a number, not 'a'"),
        (lambda: dd.relaxes_within(0), "relaxes_within.time: is 0"),
        (lambda: dd.forgets(within=1), "forgets.at: is None"),
        (lambda: dd.forgets(at=1), "forgets.within: is None"),
        (lambda: dd.remembers(strength=-2), "strength: is -2"),
        (lambda: dd.selects(dd.isolate(line(31), "u")), "strength: needs a number, not <Isolated"),
    ],
)
def test_values_that_are_none_are_refused(call, message):
    with pytest.raises(ParameterError, match=message):
        call()


def test_a_requirement_is_shown_as_it_is_typed():
    requirements = [
        dd.detects(3, within=0.2),
        dd.remembers(),
        dd.forgets(-1, within=0.1),
        dd.selects(strength=4),
    ]
    assert [eval(f"dd.{requirement!r}") for requirement in requirements] == requirements
