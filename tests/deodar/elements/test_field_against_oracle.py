"""Fields of 0 to 4 dimensions against the plain reference: every kernel, boundary and sigmoid, 200 steps in
float64.
"""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

import deodar as dd
from deodar.elements.stimuli import Boost
from deodar.numerics.kernels.custom import Custom
from deodar.numerics.kernels.separable import Box, MexicanHat, Shifted
from deodar.numerics.sigmoids import Absolute, Linear, SemiLinear, Step
from tests.oracle import fields

STEPS, EVERY, DT = 200, 20, 1.0
LINE = dd.Axis("x", -3, 12, 16, unit="cm")
RING = dd.Axis("x", -30, 330, 18, periodic=True, unit="deg")
LOPSIDED = [0.1, 0.7, 1.0, 0.2, -0.3]


def kernels(scale):
    """Return kernels with widths in units of `scale`: narrow, wide, and wider than the axis."""
    return {
        "gaussian": dd.Gaussian(1.5 / scale, 2.1 * scale),
        "gaussian normalized": dd.Gaussian(4.0, 1.6 * scale, normalized=True),
        "gaussian narrow": dd.Gaussian(5.0, 0.3 * scale, normalized=True),
        "gaussian wide": dd.Gaussian(0.3 / scale, 21 * scale),
        "box": Box(0.8 / scale, 4.6 * scale),
        "box normalized": Box(3.0, 5.0 * scale, normalized=True),
        "box narrow": Box(3.0, 0.4 * scale, normalized=True),
        "box wide": Box(0.1 / scale, 47.3 * scale),
        "mexican hat": MexicanHat(2.0 / scale, 1.5 * scale, 0.6 / scale, 4.0 * scale),
        "mexican hat normalized": MexicanHat(6.0, 1.5 * scale, 4.0, 4.0 * scale, normalized=True),
        "shifted": Shifted(dd.Gaussian(1.5 / scale, 2.1 * scale), 2.7 * scale),
        "shifted box": Shifted(Box(0.8 / scale, 4.6 * scale), -1.3 * scale),
        "custom": Custom(LOPSIDED, 1.2 / scale),
        "custom spaced": Custom(LOPSIDED, 1.2 / scale, spacing=1.7 * scale),
        "custom longer than the field": Custom(np.cos(np.arange(45)), 0.2 / scale),
    }


def bounded(kernel, boundary):
    return dataclasses.replace(kernel, boundary=boundary)


def line_cases():
    for axis in (LINE, RING):
        for name, kernel in kernels(axis.step).items():
            for boundary in (
                ["periodic"],
                ["zero"],
                ["reflect"],
                *([None] if name in ("gaussian", "custom") else []),
            ):
                case = (
                    f"{'ring' if axis.periodic else 'line'}, {name},"
                    f" {boundary[0] if boundary else 'by the axis'}"
                )
                yield case, axis, bounded(kernel, boundary)


def stimulus_on(axes, amplitude=9.0):
    center = [a.lower + 0.3 * a.range for a in axes]
    sigma = [2.2 * a.step for a in axes]
    return dd.GaussianStimulus("s", axes, center=center, sigma=sigma, amplitude=amplitude)


def compare(model, expected, record="activation", dt=DT, many=12):
    """Run the model, and require that each field's activation equals the reference to 1e-9 of its largest
    value.
    """
    recorded = dd.simulate(
        model,
        STEPS * dt,
        dt=dt,
        record=[f"{dd.quote(name)}.{record}" for name in expected],
        every=EVERY * dt,
        precision="float64",
    )
    wrong = []
    for name, (field, stimulus) in expected.items():
        reference = fields.run(
            field, lambda k, s=stimulus: fields.stimulus(s, k * dt) if s else 0.0, STEPS, dt, many
        )[::EVERY]
        values = recorded[f"{name}.{record}"].values
        assert values.dtype == np.float64
        assert np.ptp(reference) > 0.1, f"{name}: the activation is constant, so the test shows nothing"
        error = abs(values - reference).max() / abs(reference).max()
        if not error < 1e-9:
            wrong.append(f"{name}: off by {error:.1e}")
    assert not wrong, "\n".join(wrong)


def test_fields_with_every_kernel_and_boundary_agree_with_the_oracle():
    model, expected = dd.Model("lines"), {}
    sources = {}
    for axis, name in ((LINE, "on line"), (RING, "on ring")):
        s = stimulus_on([axis])
        sources[axis] = (
            s,
            model.add(
                dd.GaussianStimulus(name, [axis], center=s.center, sigma=s.sigma, amplitude=s.amplitude)
            ),
        )
    for case, axis, kernel in line_cases():
        field = dd.Field(case, [axis], tau=10, resting_level=-3, kernel=[kernel], sigmoid=dd.Logistic(2.0))
        s, handle = sources[axis]
        model.connect(handle, model.add(field))
        expected[case] = field, s
    compare(model, expected)


def alone(case, field, stimulus, many=12):
    """Return one field with one stimulus."""
    model = dd.Model("alone")
    model.connect(model.add(stimulus), model.add(field))
    compare(model, {case: (field, stimulus)}, many=many)


PLANE = (dd.Axis("x", 0, 14, 8), dd.Axis("y", -9, 9, 9, periodic=True))
ROOM = (dd.Axis("x", 0, 4, 5), dd.Axis("y", 0, 6, 6, periodic=True), dd.Axis("z", -3, 3, 7))
FOUR = (
    dd.Axis("x", 0, 8, 5),
    dd.Axis("y", 0, 4, 4, periodic=True),
    dd.Axis("z", 0, 5, 6),
    dd.Axis("c", 0, 3, 3, periodic=True),
)


def test_fields_over_two_axes_with_mixed_boundaries_agree_with_the_oracle():
    model, expected = dd.Model("planes"), {}
    s = stimulus_on(PLANE)
    source = model.add(s)
    lopsided = np.outer([0.2, 1.0, 0.5], [0.1, 0.4, 1.0, 0.3, -0.2]) + np.eye(3, 5) * 0.2
    for name, kernel in {
        "gaussian": dd.Gaussian(0.5, [3.1, 2.4]),
        "gaussian normalized": dd.Gaussian(5.0, [2.6, 0.5], normalized=True),
        "box": Box(0.4, [6.3, 4.9]),
        "mexican hat": MexicanHat(7.0, 2.2, 4.0, [5.0, 4.0], normalized=True),
        "shifted": Shifted(dd.Gaussian(0.5, [3.1, 2.4]), [1.7, -3.3]),
        "custom": Custom(lopsided, 0.4),
        "custom spaced": Custom(lopsided, 0.4, spacing=[2.9, 1.5]),
    }.items():
        for boundary in (None, ["reflect", "zero"], ["periodic", "reflect"], ["zero", "zero"]):
            case = f"{name}, {boundary}"
            field = dd.Field(
                case,
                PLANE,
                tau=12,
                resting_level=-3,
                kernel=[bounded(kernel, boundary)],
                global_inhibition=0.02,
            )
            model.connect(source, model.add(field))
            expected[case] = field, s
    compare(model, expected, many=4)


def test_fields_over_three_axes_agree_with_the_oracle():
    kernel = [
        dd.Gaussian(1.1, [0.8, 0.7, 0.9], boundary=["reflect", "periodic", "zero"]),
        MexicanHat(3, 0.6, 1, 1.0, normalized=True),
    ]
    alone(
        "u",
        dd.Field("u", ROOM, tau=15, resting_level=-4, kernel=kernel, global_inhibition=0.05),
        stimulus_on(ROOM),
        many=2,
    )


def test_fields_over_four_axes_agree_with_the_oracle():
    kernel = [dd.Gaussian(0.5, [1.1, 0.6, 0.5, 0.5], boundary=["reflect", "periodic", "zero", "periodic"])]
    alone(
        "u",
        dd.Field("u", FOUR, tau=15, resting_level=-4, kernel=kernel, global_inhibition=0.01),
        stimulus_on(FOUR),
        many=1,
    )


def test_a_node_excites_itself_with_the_amplitudes_of_its_kernels():
    kernel = [dd.Gaussian(2.5), MexicanHat(2.0, 1, 1.5, 2), Shifted(Box(0.7), 3.0)]
    node = dd.Field("n", [], tau=8, resting_level=-2, kernel=kernel, global_inhibition=0.4)
    alone("n", node, Boost("b", [], 1.5, windows=[(30, 90)]))


def test_a_sum_of_kernels_with_global_inhibition_agrees_with_the_oracle():
    kernel = [
        dd.Gaussian(3.0, 1.2),
        Box(-0.4, 6.0, boundary=["zero"]),
        Custom(LOPSIDED, 0.5, boundary=["reflect"]),
        MexicanHat(1, 1, 0.5, 3),
    ]
    alone(
        "u",
        dd.Field("u", [RING], tau=9, resting_level=-3, kernel=kernel, global_inhibition=0.01),
        stimulus_on([RING]),
    )


@pytest.mark.parametrize("axis", [LINE, RING], ids=["line", "ring"])
def test_fields_with_every_sigmoid_agree_with_the_oracle(axis):
    model, expected = dd.Model("sigmoids"), {}
    s = stimulus_on([axis], 6.3)
    source = model.add(s)
    sigmoids = [
        dd.Logistic(3.0, 0.4),
        Absolute(20.0, -0.3),
        Step(0.2),
        Linear(0.6, 0.1),
        SemiLinear(0.5, 0.3),
    ]
    for g in sigmoids:
        name = type(g).__name__
        field = dd.Field(
            name,
            [axis],
            tau=10,
            resting_level=-3.1,
            kernel=[dd.Gaussian(0.9, 2.3 * axis.step, normalized=True)],
            sigmoid=g,
        )
        model.connect(source, model.add(field))
        expected[name] = field, s
    compare(model, expected)


def test_output_and_interaction_agree_with_the_oracle():
    s = stimulus_on([RING])
    field = dd.Field(
        "u",
        [RING],
        tau=10,
        resting_level=-3,
        kernel=[dd.Gaussian(0.1, 40), Box(-0.01, 90)],
        global_inhibition=0.01,
    )
    model = dd.Model("ports")
    model.connect(model.add(s), model.add(field))
    record = dd.simulate(
        model, 60, record=["u.output", "u.interaction", "u.input"], every=60, precision="float64"
    )
    reference = fields.Field(field)
    for time in range(2):
        for port, expected in {
            "output": reference.output,
            "interaction": reference.interaction,
            "input": fields.stimulus(s, 0),
        }.items():
            np.testing.assert_allclose(
                record[f"u.{port}"].values[time], expected, rtol=1e-9, atol=1e-9 * abs(expected).max()
            )
        for _ in range(60):
            reference.step(fields.stimulus(s, 0), 1.0)
