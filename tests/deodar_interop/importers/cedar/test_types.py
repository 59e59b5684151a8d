"""Each type of step between two fields, and random architectures, against the plain reference."""

from __future__ import annotations

import numpy as np
import pytest

from deodar_interop.importers.cedar import translate
from tests.deodar_interop.importers.cedar import models, oracle
from tests.deodar_interop.importers.cedar.compared import run

DT = 10.0
TYPES = models.every_type()

ASSUMED = {
    "cedar.dynamics.RateMatrixToSpaceCode": "the bins of rates between two bins and beyond the limits",
    "cedar.dynamics.SerialOrder": "which outputs inhibit all nodes",
    "cedar.dynamics.SpaceCodeToRateMatrix": "the rates of the bins, and which of equal bins counts",
    "cedar.processing.SynapticConnection, weights": "where its point-wise weights lie",
    "cedar.processing.sources.SpatialTemplate": "where the angle begins",
    "cedar.processing.sources.StepSignal": "the form of the wave",
    "cedar.processing.steps.ExponentialSmoothing": "the first level and trend",
    "cedar.processing.steps.HarmonicOscillatorRHS": "the equation",
    "cedar.processing.steps.Histogram": "in which bin an edge is",
    "cedar.processing.steps.NumericalDifferentiation": "the first step",
    "cedar.processing.steps.NumericalIntegration, all": "where a reset signal is on",
    "cedar.processing.steps.NumericalIntegration, reset": "where a reset signal is on",
    "cedar.processing.steps.OverTime": "its maximum before the first input",
    "cedar.processing.steps.Timer": "where a signal is on",
}
"""What is not documented of cedar: the reference assumes the same as the import, which reports it."""

SENSITIVE = 8
"""Seed of a model whose trajectory amplifies rounding."""


def off(content, steps):
    """Return the largest difference of each slot, from the first iteration on."""
    expected = oracle.run(content, steps, DT)
    record = run(content.encode(), steps, DT, set(expected))
    out = {}
    for slot, values in record.items():
        a, b = (np.asarray(v).reshape(steps + 1, -1)[1:] for v in (values, expected[slot]))
        assert a.shape == b.shape, slot
        finite = np.isfinite(a)
        out[slot] = np.abs(a - b)[finite].max() if finite.any() else 0.0
    return out


@pytest.mark.parametrize("name", sorted(TYPES))
def test_a_step_runs_as_in_the_reference(name):
    errors = off(TYPES[name], 200)
    assert "target.activation" in errors or len(errors) > 2
    assert {slot: error for slot, error in errors.items() if not error < 1e-5} == {}


@pytest.mark.parametrize("name", sorted(TYPES))
def test_what_is_assumed_is_reported_and_nothing_else_is_lost(name):
    report = translate.read(TYPES[name].encode(), "file.json").report
    lost = [line.verdict for line in report.losses if (line.where, line.part) == ("step", "element")]
    assumed = any(name == start or name.startswith(f"{start},") for start in ASSUMED)
    assert lost == (["approximated"] if assumed else [])


@pytest.mark.parametrize("seed", [0, 1, 3, 11, 14, 17])
def test_a_random_architecture_runs_as_in_the_reference(seed):
    errors = off(models.random_models(seed), 200)
    assert len(errors) >= 8
    assert {slot: error for slot, error in errors.items() if not error < 1e-5} == {}
