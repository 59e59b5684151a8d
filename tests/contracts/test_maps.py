"""The array parameters that an element draws over the axes of its ports have the shape of these axes."""

from __future__ import annotations

import pytest

from deodar.model.document_graph import graph
from deodar.numerics.axes import shape
from deodar.parameters import FrozenArray
from tests.contracts.build import KINDS, around


@pytest.mark.parametrize("kind", [name for name, cls in KINDS.items() if cls.maps])
def test_maps_name_arrays_and_the_ports_of_their_dimensions(kind: str) -> None:
    model = around(KINDS[kind].example())
    [node] = [n for n in graph(model.document).nodes if n.path == "example"]
    axes = {**node.ins, **node.outs}
    for name, ports in node.element.maps.items():
        array = getattr(node.element, name)
        assert isinstance(array, FrozenArray)
        assert array.shape == tuple(n for port in ports for n in shape(axes[port]))


def test_fixed_weights_and_tuning_curves_are_maps() -> None:
    assert {"Weights", "PopulationActivity"} <= {name for name, cls in KINDS.items() if cls.maps}
