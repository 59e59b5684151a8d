"""Units of positions pass through every registered kind as it declares."""

from __future__ import annotations

import dataclasses as dc
import math
from collections.abc import Mapping

import pytest

from deodar import registry
from deodar.model.resolve import Node
from deodar.numerics.axes import shape
from deodar.numerics.positions import PositionUnit, PositionUnits
from deodar.parameters import parameters
from tests.contracts.build import KINDS, around, example, node

METRE = PositionUnit("length", 1.0, (-2.0, 3.0), "the sensor")


def resolved(kind: str) -> Node:
    return node(around(example(kind)))


def arriving(n: Node, unit: PositionUnit | None) -> Mapping[str, PositionUnits]:
    """Return the same unit at all samples of all inputs; none if it is None."""
    ports = {**n.ins, **({n.element.external: n.outs["output"]} if n.element.external else {})}
    return {port: () if unit is None else (unit,) * math.prod(shape(axes)) for port, axes in ports.items()}


@pytest.mark.parametrize("kind", KINDS)
def test_units_are_declared_for_each_sample_of_output_ports(kind: str) -> None:
    n = resolved(kind)
    for unit in (METRE, None):
        for port, units in n.element.position_units(n.ins, arriving(n, unit)).items():
            assert len(units) in (0, math.prod(shape(n.outs[port])))


@pytest.mark.parametrize("kind", KINDS)
def test_a_kind_reads_units_off_its_axes_or_passes_on_those_that_arrive(kind: str) -> None:
    n = resolved(kind)
    alone = n.element.position_units(n.ins, arriving(n, None))
    assert all(p is None or p.source == "" for units in alone.values() for p in units)
    small = dc.replace(METRE, size=0.01)
    one, other = (n.element.position_units(n.ins, arriving(n, unit)) for unit in (METRE, small))
    assert one.keys() == other.keys()
    for port in one:
        for p, q in zip(one[port], other[port], strict=True):
            if p is None or q is None or not p.source:
                assert p == q
            else:
                assert p.source == q.source == METRE.source and q.size == pytest.approx(p.size / 100)


@pytest.mark.parametrize("kind", KINDS)
def test_a_position_code_has_a_gain_for_each_number_of_an_input_port(kind: str) -> None:
    n = resolved(kind)
    for port, code in n.element.position_codes(n.ins).items():
        count = math.prod(shape(n.ins[port]))
        assert len(code.axes) == len(code.gains) == count
        assert code.offsets is None or len(code.offsets) == count
        assert code.parameter in [p.name for p in parameters(type(n.element))]


def test_some_kinds_pass_units_on_some_read_them_off_and_some_use_positions() -> None:
    nodes = {kind: resolved(kind) for kind in KINDS}
    units = {k: n.element.position_units(n.ins, arriving(n, METRE)) for k, n in nodes.items()}
    passing = {k for k, ports in units.items() if any(ports.values())}
    coding = {k for k, n in nodes.items() if n.element.position_codes(n.ins)}
    assert passing >= {"Gain", "Delay", "Sum", "Weights", "Sensor"} and "Field" not in passing
    assert coding >= {"SpaceCode", "SteeredShift"} and "Gain" not in coding


def test_sensors_and_motors_name_their_signal() -> None:
    """And no other kind does."""
    for kind in KINDS:
        e = example(kind)
        assert bool(e.sensor_name()) == isinstance(e, registry.kind("Sensor")), kind
        assert bool(e.motor_name()) == isinstance(e, registry.kind("Motor")), kind
