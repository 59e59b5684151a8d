"""Two elements of a kind in one model are what each is alone, also with different parameters."""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd
from tests.contracts.build import KINDS, PARTS, any_example, around, changes, node, record

DURATION = 10.0


WITHOUT_CHANCE = [kind for kind in (*KINDS, *PARTS) if any_example(kind).noise_axes() is None]


@pytest.mark.parametrize("kind", WITHOUT_CHANCE)
def test_two_of_a_kind_are_two_alone(kind):
    one, other, network = around(any_example(kind)), around(any_example(kind)), dd.Model("both")
    for path, number in changes(other["example"].element)[:1]:
        other.set(f"example.{path}", number)
    groups = {"a": one, "b": other, "c": one}
    ports = [f"example.{port}" for port in node(one).outs]
    for group, model in groups.items():
        network.insert(model, group)
        if kind == "Motor":  # two of one motor of a world are refused
            network.set(f"{group}.example.motor", group)
    together = record(network, DURATION, [f"{group}.{port}" for group in groups for port in ports])
    for group, model in groups.items():
        alone = record(model, DURATION, ports)
        for port in ports:
            np.testing.assert_allclose(
                together[f"{group}.{port}"].values, alone[port].values, rtol=1e-5, atol=1e-6
            )


@pytest.mark.parametrize("kind", sorted({*KINDS, *PARTS} - {*WITHOUT_CHANCE}))
def test_two_of_a_kind_with_noise_have_noise_of_their_own(kind):
    model = dd.Model("both")
    for group in "ab":
        model.insert(around(any_example(kind)), group)
    port = next(iter(node(model, "a.example").outs))
    values = record(model, 200.0, [f"{group}.example.{port}" for group in "ab"], seed=1)
    a, b = (values[f"{group}.example.{port}"].values.ravel() for group in "ab")
    assert abs(np.corrcoef(a, b)[0, 1]) < 0.2 and np.std(a) == pytest.approx(np.std(b), rel=0.2)
