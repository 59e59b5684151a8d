"""Invalid values: wrong type, out of range, not finite, misspelt."""

from __future__ import annotations

import re
from collections.abc import Callable
from fractions import Fraction
from typing import Any

import numpy as np
import pytest

import deodar as dd
from deodar import registry
from deodar.couplings.projections import Project
from deodar.couplings.weights import Weighting
from deodar.elements.changing_stimuli import Noise
from deodar.elements.function import Function
from deodar.elements.stimuli import Boost
from deodar.errors import AxesError, DeodarError, ParameterError, UnknownName
from deodar.numerics.kernels.custom import Custom
from deodar.numerics.kernels.separable import Box, Shifted
from deodar.parameters import Part, parameters
from tests.deodar.errors.refused import paragraph, refused

X = dd.Axis("x", 0, 10, samples=11)
NAN, INF = float("nan"), float("inf")

Case = tuple[Callable[[], Any], type[DeodarError], tuple[str, ...]]

CASES: dict[str, Case] = {
    "misspelt": (
        lambda: dd.Field("u", [X], restng_level=-5),
        UnknownName,
        ("Field has no parameter 'restng_level'", "Did you mean 'resting_level'?"),
    ),
    "too many by position": (
        lambda: dd.Gain(1, 2),
        ParameterError,
        ("takes 1 values by position, not 2", "In this order: factor"),
    ),
    "text for a number": (
        lambda: dd.Field("u", [X], tau="20"),
        ParameterError,
        ("Field.tau", "needs a number, not '20'"),
    ),
    "true for a number": (
        lambda: dd.Field("u", [X], tau=True),
        ParameterError,
        ("Field.tau", "needs a number, not True"),
    ),
    "a list for a number": (
        lambda: dd.Field("u", [X], tau=[20]),
        ParameterError,
        ("Field.tau", "needs a number"),
    ),
    "an array for a number": (
        lambda: dd.Field("u", [X], tau=np.ones(3)),
        ParameterError,
        ("Field.tau", "needs a number"),
    ),
    "complex": (lambda: dd.Field("u", [X], tau=1j), ParameterError, ("Field.tau", "needs a number")),
    "none": (lambda: dd.Field("u", [X], tau=None), ParameterError, ("Field.tau", "needs a value")),
    "an object": (lambda: dd.Field("u", [X], tau=object), ParameterError, ("Field.tau", "needs a number")),
    "nan": (lambda: dd.Field("u", [X], tau=NAN), ParameterError, ("Field.tau", "finite number, not nan")),
    "infinite": (
        lambda: dd.Field("u", [X], resting_level=-INF),
        ParameterError,
        ("Field.resting_level", "finite number, not -inf"),
    ),
    "too large for a float": (
        lambda: dd.Field("u", [X], tau=10**5000),
        ParameterError,
        ("Field.tau", "finite number"),
    ),
    "below": (
        lambda: dd.Field("u", [X], tau=0),
        ParameterError,
        ("Field.tau: is 0, below its lower bound 1e-06",),
    ),
    "above": (
        lambda: dd.Logistic(beta=1e7),
        ParameterError,
        ("Logistic.beta: is 1e+07, above its upper bound 1e+06",),
    ),
    "negative noise": (
        lambda: dd.Field("u", [X], noise=-0.1),
        ParameterError,
        ("Field.noise", "below its lower bound 0"),
    ),
    "width 0": (lambda: dd.Gaussian(sigma=0), ParameterError, ("Gaussian.sigma", "below its lower bound")),
    "width 0 on one axis": (
        lambda: dd.Gaussian(sigma=[5, 0]),
        ParameterError,
        ("Gaussian.sigma", "below its lower bound"),
    ),
    "width nan": (lambda: dd.Gaussian(sigma=[5, NAN]), ParameterError, ("Gaussian.sigma", "finite")),
    "width of nothing": (
        lambda: dd.Gaussian(sigma=[]),
        ParameterError,
        ("Gaussian.sigma", "one for each axis, not none"),
    ),
    "width of lists": (
        lambda: dd.Gaussian(sigma=[[5]]),
        ParameterError,
        ("Gaussian.sigma", "needs a number"),
    ),
    "box of no width": (lambda: Box(width=0), ParameterError, ("Box.width", "below its lower bound")),
    "stimulus of no width": (
        lambda: dd.GaussianStimulus("s", [X], sigma=0),
        ParameterError,
        ("GaussianStimulus.sigma",),
    ),
    "a flag": (
        lambda: dd.Gaussian(normalized=1),
        ParameterError,
        ("Gaussian.normalized", "needs true or false, not 1"),
    ),
    "a choice": (
        lambda: Project([X], reduce="summ"),
        ParameterError,
        ("Project.reduce", "one of integral, sum", "Did you mean 'sum'?"),
    ),
    "a boundary": (
        lambda: dd.Gaussian(boundary="peridic"),
        ParameterError,
        ("Gaussian.boundary", "Did you mean 'periodic'?"),
    ),
    "an axis that is none": (
        lambda: dd.Field("u", ["x"]),
        ParameterError,
        ("Field.axes", "needs an Axis, not 'x'"),
    ),
    "axes that are no list": (
        lambda: dd.Field("u", 5),
        ParameterError,
        ("Field.axes", "needs a list, not 5"),
    ),
    "a class for a part": (
        lambda: dd.Field("u", [X], sigmoid=dd.Logistic),
        ParameterError,
        ("Field.sigmoid", "needs a Sigmoid"),
    ),
    "a kernel for a sigmoid": (
        lambda: dd.Field("u", [X], sigmoid=dd.Gaussian()),
        ParameterError,
        ("Field.sigmoid", "needs a Sigmoid"),
    ),
    "a number for a kernel": (
        lambda: dd.Field("u", [X], kernel=[5]),
        ParameterError,
        ("Field.kernel", "needs a Kernel, not 5"),
    ),
    "a name that is no text": (lambda: dd.Field(5, [X]), ParameterError, ("Field.name", "needs text, not 5")),
    "a name that is half a character": (
        lambda: dd.Field("\ud800", [X]),
        ParameterError,
        ("Field.name", "UTF-8 cannot encode"),
    ),
    "windows": (lambda: Boost("b", windows=[5]), ParameterError, ("Boost.windows", "needs a Window, not 5")),
    "a window of nan": (lambda: Boost("b", windows=[(0, NAN)]), ParameterError, ("Window.stop", "finite")),
    "weights with nan": (
        lambda: Weighting([1, NAN], (dd.Axis("x", 0, 1, 2),)),
        ParameterError,
        ("Weighting.weights", "finite numbers"),
    ),
    "weights of text": (
        lambda: Weighting(["a"], (X,)),
        ParameterError,
        ("Weighting.weights", "needs an array of numbers"),
    ),
    "weights of lists of two lengths": (
        lambda: Custom([[1, 2], [3]]),
        ParameterError,
        ("Custom.weights", "needs an array of numbers"),
    ),
    "weights too large": (
        lambda: Custom([10**400, 0, 0]),
        ParameterError,
        ("Custom.weights", "needs an array of numbers"),
    ),
    "a shifted array": (lambda: Shifted(Custom()), ParameterError, ("Shifted.kernel", "cannot be shifted")),
    "a boundary inside": (
        lambda: Shifted(dd.Gaussian(boundary=["zero"])),
        ParameterError,
        ("Shifted.kernel.boundary", "give it to Shifted itself"),
    ),
    "names for a table": (
        lambda: Project([X], rename="xy"),
        ParameterError,
        ("Project.rename", "needs a list"),
    ),
    "numbers for names": (
        lambda: Project([X], rename={"y": 5}),
        ParameterError,
        ("Project.rename", "needs text, not 5"),
    ),
    "a function that is none": (
        lambda: Function("f", function=5),
        ParameterError,
        ("Function.function", "needs text"),
    ),
    "a function without a name": (
        lambda: Function("f", function=lambda *a: a),
        ParameterError,
        ("Function.function", "a lambda"),
    ),
    "ports of no name": (
        lambda: Function("f", ports_in=["a b"]),
        ParameterError,
        ("Function.ports_in", "'a b'"),
    ),
    "a port twice": (
        lambda: Function("f", ports_in=["a", "a"]),
        ParameterError,
        ("Function.ports_in", "twice"),
    ),
    "a port called output": (
        lambda: Function("f", ports_in=["output"]),
        ParameterError,
        ("Function.ports_in", "output"),
    ),
    "numbers of nothing": (
        lambda: Function("f", values={"rate": NAN}),
        ParameterError,
        ("Function.values", "finite"),
    ),
    "numbers that are pairs of three": (
        lambda: Function("f", values=[("a", 1, 2)]),
        ParameterError,
        ("Function.values", "a mapping from names to numbers"),
    ),
    "negative correlation length": (
        lambda: Noise("n", [X], length=-1),
        ParameterError,
        ("Noise.length", "below its lower bound"),
    ),
    # axes
    "axis: no name": (lambda: dd.Axis("", 0, 1, 2), AxesError, ("needs a name",)),
    "axis: a name of numbers": (lambda: dd.Axis(1, 0, 1, 2), AxesError, ("axis 1: name needs text, not 1",)),
    "axis: upside down": (
        lambda: dd.Axis("x", 1, 0, 2),
        AxesError,
        ("axis 'x'", "lower 1 is not below upper 0"),
    ),
    "axis: of no length": (lambda: dd.Axis("x", 1, 1, 2), AxesError, ("lower 1 is not below upper 1",)),
    "axis: nan": (lambda: dd.Axis("x", NAN, 1, 2), AxesError, ("lower needs a finite number, not nan",)),
    "axis: infinite": (lambda: dd.Axis("x", 0, INF, 2), AxesError, ("upper needs a finite number, not inf",)),
    "axis: text": (lambda: dd.Axis("x", "0", 1, 2), AxesError, ("lower needs a number, not '0'",)),
    "axis: none": (lambda: dd.Axis("x", None, 1, 2), AxesError, ("lower needs a value",)),
    "axis: complex": (lambda: dd.Axis("x", 1j, 1, 2), AxesError, ("lower needs a number, not 1j",)),
    "axis: huge": (lambda: dd.Axis("x", 0, 10**400, 2), AxesError, ("upper needs a finite number",)),
    "axis: overflowing": (lambda: dd.Axis("x", -1e308, 1e308, 2), AxesError, ("cannot be sampled",)),
    "axis: finer than its numbers": (
        lambda: dd.Axis("x", 1e9, 1e9 + 1, 101),
        AxesError,
        ("cannot be sampled", "an origin nearer"),
    ),
    "axis: one sample": (lambda: dd.Axis("x", 0, 1, 1), AxesError, ("samples is 1; expected 2 to 1000000",)),
    "axis: no sample": (
        lambda: dd.Axis("x", 0, 1, 0, periodic=True),
        AxesError,
        ("samples is 0, below its lower bound 1",),
    ),
    "axis: too many samples": (
        lambda: dd.Axis("x", 0, 1, 10**7),
        AxesError,
        ("samples is 1e+07, above its upper bound 1e+06",),
    ),
    "axis: absurdly many samples": (
        lambda: dd.Axis("x", 0, 1, 10**5000),
        AxesError,
        ("samples needs a whole number, not int",),
    ),
    "axis: half samples": (
        lambda: dd.Axis("x", 0, 1, 2.5),
        AxesError,
        ("samples needs a whole number, not 2.5",),
    ),
    "axis: true samples": (
        lambda: dd.Axis("x", 0, 1, True),
        AxesError,
        ("samples needs a whole number, not True",),
    ),
    "axis: periodic by a word": (
        lambda: dd.Axis("x", 0, 1, 2, periodic="yes"),
        AxesError,
        ("periodic needs true or false, not 'yes'",),
    ),
    "axis: unit of numbers": (lambda: dd.Axis("x", 0, 1, 2, unit=5), AxesError, ("unit needs text, not 5",)),
    # models
    "model: a name of numbers": (lambda: dd.Model(5), ParameterError, ("name needs text, not 5",)),
    "model: a time unit": (
        lambda: dd.Model("m", time_unit="hours"),
        ParameterError,
        ("time_unit is 'hours'", "1 = 64 ms"),
    ),
    "model: a step": (lambda: dd.Model("m", dt=-1), ParameterError, ("dt is -1; expected a number above 0",)),
    "model: ticks": (
        lambda: dd.Model("m").add(dd.Field("u", [X]), ticks=0),
        ParameterError,
        ("u: the step is 0 ticks; expected a whole number from 1 to",),
    ),
}


@pytest.mark.parametrize("name", CASES)
def test_invalid_values_are_refused(name: str) -> None:
    call, error, says = CASES[name]
    refused(call, error, *says)


def test_all_problems_of_a_part_are_listed() -> None:
    text = refused(
        lambda: dd.Field("u", [X], tau=-1, noise=-1, resting_level="low"), ParameterError, "3 problems"
    )
    assert all(f"Field.{p}" in text for p in ("tau", "noise", "resting_level"))


NUMBERS: list[Any] = [
    7,
    7.0,
    np.float32(7),
    np.float64(7),
    np.int32(7),
    np.array(7.0),
    np.array(7),
    Fraction(7),
]


@pytest.mark.parametrize("number", NUMBERS, ids=lambda n: f"{type(n).__name__} {getattr(n, 'dtype', '')}")
def test_numbers_of_python_and_numpy_are_accepted(number: Any) -> None:
    assert dd.Field("u", [X], tau=number).tau == 7.0
    assert type(dd.Field("u", [X], tau=number).tau) is float
    assert dd.Axis("x", 0, number, samples=8).upper == 7.0


def test_numbers_of_jax_are_accepted() -> None:
    import jax.numpy as jnp

    assert dd.Field("u", [X], tau=jnp.float32(7)).tau == 7.0
    assert dd.Gaussian(sigma=np.array([1.0, 2.0])).sigma == (1.0, 2.0)


WRONG: list[Any] = [
    None,
    "x",
    -1,
    [],
    {},
    NAN,
    INF,
    True,
    10**400,
    object(),
    1j,
    [NAN],
    [[1]],
    b"x",
    dd.Gaussian(),
    dd.Field,
    np.ones((2, 2)),
]


@pytest.mark.parametrize(
    "kind",
    [
        n
        for n, cls in registry.kinds().items()
        if issubclass(cls, Part) and cls.__module__.startswith("deodar.")
    ],
)
def test_any_value_of_a_parameter_is_accepted_or_refused_by_an_error_of_deodar(kind: str) -> None:
    """For every kind, parameter and type of wrong value: it is accepted, or refused by an error of deodar
    with its place.
    """
    cls = registry.kind(kind)
    good = cls.example()
    arguments = {p.name: getattr(good, p.name) for p in parameters(cls)}
    refused = 0
    for p in parameters(cls):
        for wrong in WRONG:
            try:
                cls(**(arguments | {p.name: wrong}))
            except DeodarError as error:
                refused += 1
                paragraph(str(error))
                assert re.search(rf"\b{p.name}\b", str(error))
    assert refused or not parameters(cls)
