"""Which fields share transforms."""

from __future__ import annotations

import numpy as np

import deodar as dd
from deodar.compiler.build import Build
from deodar.compiler.plan import plan
from tests.deodar.compiler.test_sharing import SQUARE, coupled


def test_fields_coupled_by_two_kinds_of_boundaries_share_transforms_of_either_kind() -> None:
    """u is coupled with w by kernels that wrap, and with v by kernels that do not."""
    model = coupled(dd.Field)
    u = model["u"]
    v = model.add(dd.Field("v", SQUARE, resting_level=-1, kernel=[dd.Gaussian(15, 3, normalized=True)]))
    for a, b in ((u, v), (v, u)):
        a >> dd.Convolve([dd.Gaussian(6, 4, normalized=True, boundary=("zero", "zero"))]) >> b
    shared = {n.path: g.strategy.shared for g in plan(Build(model.document)).groups for n in g.nodes}
    assert shared == {
        **dict.fromkeys(["u", "w", "u>Convolve", "u>Convolve>Gain", "w>Convolve"], "periodic periodic"),
        **dict.fromkeys(["v", "u>Convolve2", "v>Convolve"], "zero zero"),
        "s": "",
    }
    default, exact = (
        dd.simulate(model, 20, record=["w.activation", "v.activation"], precision=precision)
        for precision in ("float32", "float64")
    )
    for name in ("w.activation", "v.activation"):
        assert exact[name].values.max() > 2
        np.testing.assert_allclose(default[name].values[-1], exact[name].values[-1], atol=1e-4)
