"""Sizes of outputs, which follow from the parameters of a class as in cosivina."""

from __future__ import annotations

import pytest

from deodar.numerics.axes import MOST_SAMPLES
from deodar_interop.importers._axes import LengthAxes, SizeLimit
from deodar_interop.importers.cosivina import file
from deodar_interop.importers.cosivina.values import output_size
from tests.deodar_interop.importers.cosivina.files import element, text


@pytest.mark.parametrize(
    ("kind", "param", "component", "size"),
    [
        ("NeuralField", {"size": [1, 7]}, "", (1, 7)),
        ("NeuralField", {"size": 7}, "", (1, 7)),
        ("NeuralField", {"size": [4, 7]}, "", (4, 7)),
        ("NeuralField", {"size": [4, 7, 3]}, "", (4, 7, 3)),
        ("SumInputs", {}, "", (1, 1)),
        ("LateralInteractions2D", {"size": [4, 7]}, "horizontalSum", (1, 4)),
        ("LateralInteractions2D", {"size": [4, 7]}, "verticalSum", (1, 7)),
        ("LateralInteractions2D", {"size": [4, 7]}, "fullSum", (1, 1)),
        ("LateralInteractions2D", {"size": [4, 7]}, "output", (4, 7)),
        ("SumAllDimensions", {"size": [4, 7]}, "output", (1, 1)),
        ("GaussKernel1D", {"size": [4, 7]}, "output", (1, 7)),
        ("WeightMatrix", {"size": [4, 7]}, "output", (1, 7)),
        ("DiagonalSum", {"inputSize": [5, 5]}, "output", (1, 9)),
        ("DiagonalSum", {"inputSize": [5, 5], "size": [1, 4]}, "output", (1, 9)),
        ("DiagonalExpansion", {"inputSize": [1, 9]}, "output", (5, 5)),
        ("RunningHistory", {"size": [1, 7], "timeSlots": 3}, "", (3, 7)),
        ("RunningHistory", {"size": [4, 7], "timeSlots": 3}, "", (4, 7, 3)),
        ("History", {"size": [1, 7], "storingTimes": [1, 5]}, "", (2, 7)),
        ("ExpandDimension", {"inputSize": [1, 7], "outputSize": [4, 7]}, "", (4, 7)),
    ],
)
def test_the_size_of_an_output_follows_from_the_parameters(
    kind: str, param: dict[str, object], component: str, size: tuple[int, ...]
) -> None:
    (parsed,) = file.parse(text([element("e", kind, param)]).encode()).elements
    assert output_size(parsed, component) == size


def test_the_largest_axis_is_accepted_and_a_larger_one_is_not():
    axes = LengthAxes(["y", "x"], [])
    single, longest = axes.of((1, MOST_SAMPLES))
    assert single is None and longest is not None and longest.samples == MOST_SAMPLES
    with pytest.raises(SizeLimit):
        axes.of((1, MOST_SAMPLES + 1))
