"""The work grows with the size of a file, not with its square.

Work is counted in lines of the package that are executed, never in seconds.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Callable
from types import FrameType
from typing import Any

import pytest

import deodar as dd
from deodar.compiler.build import Build
from deodar.compiler.plan import plan
from deodar.importers.tools import IMPORTERS
from deodar.model import document_files
from tests.deodar_interop.importers.cosivina.files import element, text

FIELD = {"size": [1, 5], "tau": 10, "h": -5, "beta": 4}
BELL = {"size": [1, 5], "sigma": 1, "amplitude": 1, "position": 3, "circular": 1, "normalized": 0}
SMALL, LARGE = 300, 3000
MOST = 12.0
"""Largest ratio of work for ten times the size: ten, and some more for work that grows with its logarithm."""


def lines(action: Callable[[], Any]) -> int:
    """Return how many lines of the package an action executes."""
    count = 0

    def line(frame: FrameType, event: str, _: Any) -> Any:
        nonlocal count
        count += event == "line"
        return line

    def call(frame: FrameType, event: str, _: Any) -> Any:
        return line if "deodar" in frame.f_code.co_filename else None

    before = sys.gettrace()
    sys.settrace(call)
    try:
        action()
    finally:
        sys.settrace(before)
    return count


def from_stimuli(n: int) -> list[dict[str, Any]]:
    """Return one field that reads many stimuli, each several times."""
    sources = [element(f"s{k}", "GaussStimulus1D", BELL) for k in range(n // 5)]
    return [
        *sources,
        element("u", "NeuralField", FIELD, [(f"s{k % len(sources)}", "output") for k in range(n)]),
    ]


def from_one(n: int) -> list[dict[str, Any]]:
    """Return one field that reads one stimulus many times."""
    return [element("s", "GaussStimulus1D", BELL), element("u", "NeuralField", FIELD, [("s", "output")] * n)]


def from_later_couplings(n: int) -> list[dict[str, Any]]:
    """Return one field that reads couplings of one node that are computed after it."""
    scaled = [
        element(f"k{k}", "ScaleInput", {"size": [1, 1], "amplitude": 1}, [("n", "output")])
        for k in range(n // 5)
    ]
    reads = [(f"k{k}", "output") for k in range(n // 5)]
    node = element("n", "NeuralField", {**FIELD, "size": [1, 1]})
    return [
        element("u", "NeuralField", FIELD, reads),
        node,
        element("sum", "SumInputs", {"size": [1, 1]}, reads),
        *scaled,
    ]


@pytest.mark.parametrize("made", [from_stimuli, from_one, from_later_couplings])
def test_work_grows_with_the_number_of_inputs(made):
    found: dict[str, list[int]] = {}
    for n in (SMALL, LARGE):
        content = text(made(n)).encode()
        models: list[dd.Model] = []
        found.setdefault("import", []).append(
            lines(
                lambda c=content, m=models: m.append(IMPORTERS["cosivina"].read(c, "large.json", False).model)
            )
        )
        model = models[0]
        document = json.loads(model.to_json())
        found.setdefault("check", []).append(lines(lambda m=model: m.check()))
        found.setdefault("plan", []).append(lines(lambda m=model: plan(Build(m.document))))
        found.setdefault("write", []).append(lines(model.to_json))
        found.setdefault("read", []).append(lines(lambda d=document: document_files.from_data(d, {})))
        assert model.check() == []
    for name, (few, many) in found.items():
        assert many <= MOST * few, (name, few, many)


def test_work_grows_with_the_number_of_connections_that_a_script_makes():
    def script(n: int) -> Callable[[], None]:
        model = dd.Model("script")
        source, target = model.add(dd.Field("u")), model.add(dd.Field("v"))
        gains = [model.add(dd.Gain(1.0, name=f"g{k}")) for k in range(n)]

        def connect() -> None:
            for gain in gains:
                model.connect(source, gain)
                model.connect(gain, target)

        return connect

    few, many = (lines(script(n)) for n in (30, 300))
    assert many <= MOST * few, (few, many)


def test_a_source_that_occurs_many_times_becomes_one_gain():
    done = IMPORTERS["cosivina"].read(text(from_one(20_000)).encode(), "large.json", False)
    assert done.report.faithful and len(done.model.document.entries) == 3
    once = IMPORTERS["cosivina"].read(text(from_one(1)).encode(), "large.json", False)
    rest = FIELD["h"]
    u, v = (
        dd.simulate(m, 1, every=1, record=["u.activation"], precision="float64")["u.activation"].values[-1]
        for m in (done.model, once.model)
    )
    assert abs((u - rest) - 20_000 * (v - rest)).max() < 1e-9 * 20_000 and (v - rest).max() > 0.05
