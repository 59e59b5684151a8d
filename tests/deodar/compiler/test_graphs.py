"""The architectures whose compile time is measured: their size, and their few groups."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

import deodar as dd
from deodar.compiler.build import Build
from deodar.compiler.plan import plan
from deodar.elements.field import Field

sys.path.insert(0, str(Path(__file__).parents[3] / "benchmarks"))
import graphs


def counts(model: dd.Model) -> tuple[int, int]:
    fields = sum(isinstance(h.element, Field) for h in model)
    return fields, sum(1 for _ in model) - fields


def test_a_graph_of_sixty_fields_and_three_hundred_couplings_runs() -> None:
    for model, most in (
        (graphs.line_fields(0), 2),
        (graphs.line_fields(100), 3),
        (graphs.mixed_fields(), 30),
    ):
        assert counts(model) == (60, 300)
        assert len(plan(Build(model.document)).groups) <= most


def test_the_largest_graph_of_the_benchmarks_runs() -> None:
    record = dd.simulate(graphs.line_fields(100), 3)
    assert len(record.data_vars) == 60 and all(np.isfinite(v.values).all() for v in record.data_vars.values())
