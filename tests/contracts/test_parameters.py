"""The bounds that parameters declare hold for every kind."""

from __future__ import annotations

import dataclasses as dc

import pytest

from deodar.errors import ParameterError
from deodar.parameters import normal, parameters
from tests.contracts.build import KINDS, PARTS

BOUNDED = [
    pytest.param(cls, p, bound, side, id=f"{kind}.{p.name} {'below' if side < 0 else 'above'} {bound:g}")
    for kind, cls in {**KINDS, **PARTS}.items()
    for p in parameters(cls)
    for bound, side in ((p.lower, -1), (p.upper, 1))
    if bound is not None and p.form in ("number", "integer", "per_axis")
]


@pytest.mark.parametrize(("cls", "parameter", "bound", "side"), BOUNDED)
def test_a_value_beyond_its_bound_is_refused_and_the_bound_is_accepted(cls, parameter, bound, side) -> None:
    whole = parameter.form == "integer"
    assert normal(parameter, bound) == bound
    beyond = bound + side * (1 if whole else max(1e-9, 1e-6 * abs(bound)))
    says = rf"{parameter.name}: is \S+, {'below its lower' if side < 0 else 'above its upper'} bound"
    with pytest.raises(ParameterError, match=says):
        dc.replace(cls.example(), **{parameter.name: beyond})


def test_bounds_below_and_above_are_declared() -> None:
    assert {side for *_, side in (case.values for case in BOUNDED)} == {-1, 1} and len(BOUNDED) > 50
