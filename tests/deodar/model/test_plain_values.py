"""Values of parameters as plain data, as an editor sends them."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import deodar as dd
from deodar.model import plain_values
from deodar.numerics.kernels.custom import Custom

X = dd.Axis("x", 0, 60, samples=61)


def model() -> dd.Model:
    model = dd.Model("m")
    model.add(dd.Field("u", [X], kernel=[dd.Gaussian(1, 5), Custom(np.ones(3))]), group="g")
    return model


@pytest.mark.parametrize(
    ("parameter", "number", "says"),
    [
        ("kernel", 3, "needs a list"),
        ("kernel", [{"kind": "Logistic"}], "got a Logistic"),
        ("kernel", [{"kind": "Gaussian", "sigma": -1}], "below"),
        ("axes", "x", "not among"),
        ("axes", [1], "not among"),
        ("sigmoid", {"kind": 4}, "kind"),
        ("nonsense", 1, "no parameter"),
        ("resting_level.x", 1, "the value before 'x' has no parts"),
    ],
)
def test_an_invalid_value_is_an_error_that_states_the_rule(parameter: str, number: Any, says: str) -> None:
    changed = model()
    doc, entry = changed.document, changed.document.by_id()[changed["g.u"].id]
    with pytest.raises(dd.errors.DeodarError, match=says):
        plain_values.put(doc, [entry.id], parameter, number)


def test_values_of_several_elements_name_the_axes_of_one_document() -> None:
    """Two axes of one name have the keys `x` and `x_2`, which the first change exchanges."""
    model = dd.Model("m")
    ids = [model.add(dd.Field(n, [dd.Axis("x", 0, s, samples=s + 1)])).id for n, s in (("u", 9), ("v", 19))]
    new = plain_values.put(model.document, ids, "axes", ["x_2"])
    assert [new.by_id()[i].element.axes[0].samples for i in ids] == [20, 20]


def test_an_array_is_given_by_its_key_or_by_its_numbers() -> None:
    doc = model().document
    [ident] = doc.by_id()
    new = plain_values.put(doc, [ident], "kernel.1.weights", [1.0, 2.0, 1.0])
    assert new.by_id()[ident].element.kernel[1].weights.data.tolist() == [1, 2, 1]
    same = plain_values.put(doc, [ident], "kernel.1", {"kind": "Custom", "weights": {"array": "array"}})
    assert same.by_id()[ident].element.kernel[1].weights.data.tolist() == [1, 1, 1]
    with pytest.raises(dd.errors.ParameterError, match="the array 'other' is not in"):
        plain_values.put(doc, [ident], "kernel.1.weights", {"array": "other"})
