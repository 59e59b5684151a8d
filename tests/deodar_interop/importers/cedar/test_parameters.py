"""The parameters that the file of a step leaves out, against the plain reference, and those beyond limits."""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from deodar_interop.importers.cedar import translate
from tests.deodar_interop.importers.cedar import models, oracle

Pairs = list[tuple[str, Any]]

FILES = {name: text for name, text in models.every_type().items() if ", " not in name}
"""A file with a step of each type, which is called `step`."""

NEEDED = {"name", "dimensionality", "sizes"}
"""Parameters without which a step does not fit those that it is connected with."""


class Missing(oracle.Par):
    """Parameters that note the default value of each one that is read and is not there."""

    def __init__(self, pairs: Pairs) -> None:
        super().__init__(pairs)
        self.defaults: dict[str, Any] = {}

    def _note(self, key: str, default: Any) -> None:
        if self.get(key) is None:
            self.defaults[key] = default

    def flag(self, key: str, default: Any) -> bool:
        self._note(key, default)
        return super().flag(key, default)

    def number(self, key: str, default: Any) -> float:
        self._note(key, default)
        return super().number(key, default)

    def time(self, key: str, default: Any) -> float:
        self._note(key, default)
        return super().time(key, default)

    def numbers(self, key: str, default: Any, n: int) -> list[float]:
        self._note(key, [default] * n)
        return super().numbers(key, default, n)

    def flags(self, key: str, default: Any, n: int) -> list[Any]:
        self._note(key, [default] * n)
        return super().flags(key, default, n)


def left_out(content: str) -> dict[str, Any]:
    """Return the parameters that the reference reads of the step and the file leaves out."""
    architecture, clock = oracle.Architecture(content), oracle.Clock(10.0)
    step = architecture.steps["step"]
    parameters = step.p = Missing(step.p.pairs)
    # the reference refuses what it does not compute after it has read it
    with np.errstate(all="ignore"), contextlib.suppress(ValueError):
        oracle.load(architecture, clock)
        oracle.iterate(architecture, clock)
    return parameters.defaults


def rewritten(content: str, change: Callable[[Pairs], Pairs]) -> str:
    """Return a file with other parameters of its step."""

    def copied(part: Any) -> Any:
        if isinstance(part, list) and part and isinstance(part[0], tuple):
            pairs = [(key, copied(inner)) for key, inner in part]
            return models.Many(change(pairs) if ("name", "step") in pairs else pairs)
        return [copied(inner) for inner in part] if isinstance(part, list) else part

    return models.written(copied(oracle.parsed(content)))


def as_it_is(name: str) -> str:
    return FILES[name]


def alone(name: str) -> str:
    model = models.Model()
    model.add(name.rpartition(".")[2], "step")
    return model.text()


def without_all(name: str) -> str:
    return rewritten(FILES[name], lambda pairs: [pair for pair in pairs if pair[0] in NEEDED])


@pytest.mark.parametrize("short", [as_it_is, without_all, alone])
def test_a_parameter_that_is_left_out_has_the_value_of_the_reference(short: Callable[[str], str]) -> None:
    different: dict[str, Any] = {}
    for name in FILES:
        content = short(name)
        defaults = left_out(content)
        full = rewritten(content, lambda pairs, defaults=defaults: [*pairs, *defaults.items()])
        a, b = (translate.read(text.encode(), "file.json").model.document for text in (content, full))
        if (a.entries, a.connections) != (b.entries, b.connections):
            different[name] = defaults
    assert different == {}


@pytest.mark.parametrize(
    ("name", "parameter", "beyond", "limit"),
    [
        ("cedar.processing.steps.ExponentialSmoothing", "data smoothing factor", 1.5, 1),
        ("cedar.processing.steps.ExponentialSmoothing", "data smoothing factor", -0.5, 0),
        ("cedar.processing.steps.ExponentialSmoothing", "trend smoothing factor", 1.5, 1),
        ("cedar.processing.steps.ExponentialSmoothing", "trend smoothing factor", -0.5, 0),
        ("cedar.processing.sources.BoxInput", "widths", [-2, 3], [0, 3]),
        ("cedar.processing.sources.GaussInput", "sigma", [-1, 2], [1e-6, 2]),
    ],
)
def test_a_parameter_beyond_a_limit_has_the_value_of_the_limit(
    name: str, parameter: str, beyond: Any, limit: Any
) -> None:
    def stated(number: Any) -> translate.Imported:
        others = rewritten(FILES[name], lambda pairs: [pair for pair in pairs if pair[0] != parameter])
        content = rewritten(others, lambda pairs: [*pairs, (parameter, number)])
        return translate.read(content.encode(), "file.json")

    outside, at_limit = stated(beyond), stated(limit)
    assert outside.model.document.entries == at_limit.model.document.entries
    lines = [line for line in outside.report.losses if line.where == "step" and line.part != "element"]
    assert [(line.what, line.verdict) for line in lines] == [(parameter, "approximated")]
