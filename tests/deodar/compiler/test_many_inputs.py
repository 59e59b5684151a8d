"""Elements with thousands of inputs: their sums are right, and neither plan nor program grows with inputs
times rows.
"""

from __future__ import annotations

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import deodar as dd
from deodar.compiler.build import Build
from deodar.compiler.plan import COLUMNS, Plan, plan
from deodar.compiler.program import gather
from deodar.elements.stimuli import Boost


def inputs(*counts: int) -> dd.Model:
    """Return a model of nodes with the same structure; each reads the given number of boosts."""
    model = dd.Model("inputs")
    amplitudes = np.random.default_rng(1).normal(size=max(counts))
    boosts = [model.add(Boost(f"b{k}", amplitude=float(a))) for k, a in enumerate(amplitudes)]
    for n, count in enumerate(counts):
        node = model.add(dd.Field(f"u{n}", []))
        for boost in boosts[:count]:
            boost >> node
    return model


def entries(plan: Plan) -> int:
    """Return the count of numbers in all tables."""
    return sum(
        r.table.size + sum(rows.size + block.size for rows, block in r.more)
        for reads in plan.reads.values()
        for r in reads
    )


@pytest.mark.parametrize("precision", ["float32", "float64"])
def test_inputs_of_rows_with_many_and_few_sources_are_summed(precision: str) -> None:
    counts = (3, 5 * COLUMNS + 7, 0, COLUMNS, 2 * COLUMNS + 1, COLUMNS + 1)
    model = inputs(*counts)
    seen = dd.simulate(model, 0, record=[f"u{n}.input" for n in range(len(counts))], precision=precision)
    amplitudes = np.array([model.get(f"b{k}.amplitude") for k in range(max(counts))])
    for n, count in enumerate(counts):
        np.testing.assert_allclose(
            seen[f"u{n}.input"].item(),
            amplitudes[:count].sum(),
            atol=1e-12 if precision == "float64" else 1e-4,
        )


def test_the_order_of_summation_is_that_of_a_row_alone() -> None:
    few, many = (
        plan(Build(inputs(*counts).document)) for counts in ((5 * COLUMNS,), (5 * COLUMNS, 2, 9 * COLUMNS))
    )
    values = np.float32(10.0) ** np.random.default_rng(2).uniform(-4, 4, 9 * COLUMNS).astype(np.float32)

    def summed(plan: Plan) -> float:
        [read] = next(reads for (g, port), reads in plan.reads.items() if port == "input" and reads)
        source, row = (
            plan.groups[read.source[0]],
            plan.row[next(n.id for g in plan.groups for n in g.nodes if n.path == "u0")][1],
        )
        ordered = np.array([values[int(n.path[1:])] for n in source.nodes], np.float32)
        return float(jax.jit(lambda x: gather(x, read))(jnp.asarray(ordered))[row])

    assert summed(few) == summed(many)


def test_neither_tables_nor_programs_grow_with_rows_times_inputs() -> None:
    planned = plan(Build(inputs(2000, *[1] * 200).document))
    assert entries(planned) < 4 * 2200 + 201 * COLUMNS

    def equations(count: int) -> int:
        [read] = next(
            reads
            for (g, port), reads in plan(Build(inputs(count).document)).reads.items()
            if port == "input" and reads
        )
        return len(str(jax.make_jaxpr(lambda x: gather(x, read))(jnp.zeros(count))).splitlines())

    assert equations(2000) <= equations(3 * COLUMNS) + 2
