"""The plan: plain data that groups nodes of equal structure, and its description."""

from __future__ import annotations

import random
import subprocess
import sys

import numpy as np
import pytest

import deodar as dd
from deodar.compiler.build import Build
from deodar.compiler.plan import Call, plan
from deodar.couplings.arithmetic import Sum
from deodar.couplings.weights import Weights
from deodar.elements.changing_stimuli import Noise

x = dd.Axis("x", 0, 10, samples=11)


def ring(n: int) -> dd.Model:
    model = dd.Model("ring")
    fields = [
        model.add(dd.Field(f"u{k}", [x], tau=10 + k, kernel=[dd.Gaussian(1 + k, 2)], noise=0.1))
        for k in range(n)
    ]
    for a, b in zip(fields, fields[1:] + fields[:1], strict=True):
        a >> dd.Gain(0.5) >> b
    return model


def test_elements_of_equal_structure_are_one_group() -> None:
    small, large = plan(Build(ring(3).document)), plan(Build(ring(40).document))
    assert [type(g.like.element).__name__ for g in small.groups] == [
        type(g.like.element).__name__ for g in large.groups
    ]
    assert sorted(g.rows for g in large.groups) == [40, 40]
    assert len(large.calls) == len(small.calls) == 3
    assert sorted(large.row) == sorted(e.id for e in ring(40).document.entries)


def test_rows_are_in_the_order_of_ids_and_tables_name_their_sources() -> None:
    p = plan(Build(ring(5).document))
    for group in p.groups:
        assert [n.id for n in group.nodes] == sorted(n.id for n in group.nodes)
    for (g, port), reads in p.reads.items():
        for r, node in enumerate(p.groups[g].nodes):
            named = [
                p.groups[read.source[0]].nodes[s].id
                for read in reads
                for s in read.table[r]
                if s < p.groups[read.source[0]].rows
            ]
            assert named == [slot[0] for slot in sorted(node.reads[port])]


def test_a_plan_does_not_depend_on_the_order_of_declaration() -> None:
    pieces = list(range(8))
    seen = []
    for seed in (0, 1):
        random.Random(seed).shuffle(pieces)
        model = dd.Model("shuffled")
        fields = {k: model.add(dd.Field(f"u{k}", [x], tau=10 + k)) for k in pieces}
        for k in pieces:
            model.connect(fields[k], fields[(k + 3) % 8])
        p = plan(Build(model.document))
        seen.append(
            (
                p.row,
                p.calls,
                [g.offset for g in p.groups],
                [[(r.source, r.table.tolist()) for r in rs] for rs in p.reads.values()],
            )
        )
    assert seen[0] == seen[1]


def test_a_parameter_that_changes_the_program_makes_another_group() -> None:
    model = dd.Model("kinds")
    model.add(dd.Field("a", [x], tau=10))
    model.add(dd.Field("b", [x], tau=20, resting_level=-3, global_inhibition=1))  # the same program
    model.add(dd.Field("c", [x], kernel=[dd.Gaussian()]))
    model.add(dd.Field("d", [x]), ticks=2)
    model.add(dd.Field("e", [dd.Axis("x", 0, 10, samples=21)]))
    model.add(dd.Field("f", [x], noise=0.5))
    model.add(dd.Field("g", [x], sigmoid=dd.Logistic(beta=9)))  # the same as a
    groups = {frozenset(n.path for n in g.nodes) for g in plan(Build(model.document)).groups}
    assert groups == {frozenset("abg"), frozenset("c"), frozenset("d"), frozenset("e"), frozenset("f")}


def test_constant_parts_are_computed_once_a_chunk() -> None:
    model = dd.Model("still")
    s = model.add(dd.GaussianStimulus("s", [x]))
    t = model.add(dd.GaussianStimulus("timed", [x], windows=[(0, 5)]))
    xi = model.add(Noise("xi", [x]))
    u = model.add(dd.Field("u", [x]))
    s >> dd.Gain(2.0) >> u
    for source, name in ((s, "of s"), (t, "of timed"), (xi, "of xi"), (u, "of u")):
        source >> model.add(Sum(name=name))
    still = {n.path for g in plan(Build(model.document)).groups if g.still for n in g.nodes}
    assert still == {"s", "s>Gain", "of s"}


def test_a_loop_through_current_reads_orders_the_advances() -> None:
    model = dd.Model("current")
    a, b, c = (model.add(dd.Field(n, [x])) for n in "abc")
    model.connect(a, b, reads="current")
    model.connect(b, c, reads="current")
    p = plan(Build(model.document))
    order = [p.groups[call.group].like.path for call in p.calls if call.role == "advance"]
    assert order == ["a", "b", "c"]
    model.connect(c, a, reads="current")
    with pytest.raises(dd.errors.ModelError, match=r"loop of connections that read 'current'.*a.*b.*c"):
        plan(Build(model.document))


def test_only_what_is_read_is_evaluated_for_a_record() -> None:
    model = dd.Model("needed")
    u, v, w = (model.add(dd.Field(n, [x])) for n in "uvw")
    u >> dd.Gain(2.0, name="uv") >> v >> dd.Gain(3.0, name="vw") >> w
    p = plan(Build(model.document))

    def names(path: str, port: str) -> set[str]:
        g, _ = p.row[model[path].id]
        return {n.path for call in p.needed([(g, port)]) for n in p.groups[call.group].nodes}

    fields, gains = {"u", "v", "w"}, {"uv", "vw"}
    assert names("u", "activation") == fields
    assert names("uv", "output") == fields | gains
    assert all(isinstance(c, Call) and c.role == "output" for c in p.needed([(0, "output")]))


def test_a_plan_is_plain_data_without_jax_and_can_be_printed() -> None:
    text = plan(Build(ring(6).document)).describe()
    assert "6 x Field" in text and "6 x Gain" in text and "advance" in text
    code = (
        "import ast, deodar.compiler.plan as p; t = ast.parse(open(p.__file__).read()); names = [a.name for n"
        " in ast.walk(t) "
    )
    code += (
        "if isinstance(n, ast.Import) for a in n.names]; assert not any(n.startswith('jax') for n in names),"
        " names"
    )
    assert subprocess.run([sys.executable, "-c", code], timeout=600).returncode == 0


def test_uniform_weights_in_large_batches_are_finite() -> None:
    """Weights are arguments of the program: as constants of it, uniform ones made XLA give NaN from batches
    of 64 on.
    """
    model = dd.Model("uniform")
    wide = dd.Axis("x", 0, 199, samples=200)
    u = model.add(dd.Field("u", [wide], kernel=[dd.Gaussian(1, 1e6)], global_inhibition=0.01, noise=0.1))
    u >> model.add(Weights(np.ones((200, 200)), [wide], name="w")) >> u
    record = dd.simulate(model, 5, trials=100)
    assert np.isfinite(record["u.activation"].values).all()


def test_a_port_without_axes_takes_the_largest_input_for_any_ids() -> None:
    y = dd.Axis("y", 0, 5, samples=6)
    for names in (("a", "b"), ("b", "a"), ("wide", "narrow")):
        model = dd.Model("sum")
        narrow, wide = model.add(dd.Field(names[0], [x])), model.add(dd.Field(names[1], [x, y]))
        total = model.add(Sum(name="total"))
        narrow >> total
        wide >> total
        record = dd.simulate(model, 2, record=["total.output"])
        assert record["total.output"].dims == ("time", "x", "y")
