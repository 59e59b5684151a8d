"""Stimuli, their windows, and attractor dynamics against the plain reference."""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd
from deodar.elements.stimuli import Boost, BoxStimulus
from deodar.elements.variables import Attractor
from tests.oracle import fields

LINE = dd.Axis("x", -3, 12, 16)
RING = dd.Axis("phi", -180, 180, 24, periodic=True, unit="deg")
PLANE = (LINE, RING)

STIMULI = [
    dd.GaussianStimulus(
        "gauss on a line", [LINE], center=4.3, sigma=1.7, amplitude=2.5, windows=[(20, 45), (60, 61)]
    ),
    dd.GaussianStimulus("gauss over the seam", [RING], center=171, sigma=33, amplitude=-2.5),
    dd.GaussianStimulus(
        "gauss in a plane", PLANE, center=[1.1, 400], sigma=[2.0, 25.0], amplitude=1.5, windows=[(10, 30)]
    ),
    BoxStimulus("box on a line", [LINE], center=4.3, width=3.3, amplitude=2.0, windows=[(0, 7)]),
    BoxStimulus("box over the seam", [RING], center=-171, width=71, amplitude=2.0),
    BoxStimulus("box in a plane", PLANE, center=[11.0, 0], width=[4.4, 20.0], amplitude=2.0),
    BoxStimulus("box narrower than a cell", [LINE], center=4.6, width=0.3, amplitude=2.0),
    Boost("boost", [RING], 1.25, windows=[(33, 66), (50, 80)]),
    Boost("boost of a number", [], 1.25, windows=[(5, 1e30)]),
    dd.GaussianStimulus("number", [], amplitude=0.7),
]


def test_every_stimulus_agrees_with_the_oracle_over_time():
    model = dd.Model("stimuli")
    for s in STIMULI:
        model.add(s)
    record = dd.simulate(
        model, 100, dt=0.5, record=[f"{dd.quote(s.name)}.output" for s in STIMULI], precision="float64"
    )
    for s in STIMULI:
        reference = np.array([fields.stimulus(s, 0.5 * k) for k in range(201)])
        output = record[f"{s.name}.output"].values
        assert np.any(reference)
        np.testing.assert_allclose(
            output, reference, rtol=1e-9, atol=1e-9 * abs(reference).max(), err_msg=s.name
        )


@pytest.mark.parametrize("precision", ["float32", "float64"])
@pytest.mark.parametrize("dt", [0.1, 0.3, 1.0])
def test_windows_open_and_close_at_the_step_whose_time_they_name(dt, precision):
    model = dd.Model("windows")
    model.add(Boost("b", [], 1.0, windows=[(3.0, 6.0)]))
    record = dd.simulate(model, 30 * dt, dt=dt, record="b.output", precision=precision)
    # a time between two steps belongs to the nearer one
    first, last = round(3.0 / dt + 1e-9), round(6.0 / dt + 1e-9)
    assert np.flatnonzero(record["b.output"].values).tolist() == [k for k in range(31) if first <= k < last]


MOTORS = [
    Attractor("on a line", LINE, tau=40, initial=9.0, gain=0.8, offset=-1.0),
    Attractor("not too fast", LINE, tau=40, initial=9.0, fastest=0.02),
    Attractor("on a ring", RING, tau=900, initial=-150.0),
    Attractor("on a ring, not too fast", RING, tau=900, initial=100.0, fastest=0.6),
]


def test_attractors_agree_with_the_oracle():
    line = dd.GaussianStimulus("line", [LINE], center=2.2, sigma=1.5, amplitude=0.9, windows=[(10, 150)])
    ring = dd.GaussianStimulus("ring", [RING], center=168.0, sigma=20, amplitude=0.9, windows=[(10, 150)])
    model = dd.Model("motors")
    sources = {LINE: (line, model.add(line)), RING: (ring, model.add(ring))}
    for motor in MOTORS:
        model.connect(sources[motor.axis][1], model.add(motor))
    record = dd.simulate(model, 200, record=[dd.quote(m.name) for m in MOTORS], precision="float64")
    for motor in MOTORS:
        phi, reference = motor.initial, []
        for k in range(201):
            reference.append(phi)
            phi = fields.attractor(motor, phi, fields.stimulus(sources[motor.axis][0], float(k)), 1.0)
        output = record[f"{motor.name}.output"].values
        assert np.ptp(reference) > 1
        np.testing.assert_allclose(
            output, reference, rtol=1e-9, atol=1e-9 * np.abs(reference).max(), err_msg=motor.name
        )
        assert output[0] == output[9] and output[160] == output[200], f"{motor.name}: moves without a peak"
