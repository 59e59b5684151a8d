"""Valid models have no warnings: examples, templates, demonstrations, imported models.

And a check compiles nothing.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import jax
import pytest

import deodar as dd
from deodar.architectures.behaviour import behaviour, behaviours
from deodar.architectures.change_detection import change_detection, change_trial
from deodar.architectures.corridor_plan import plan
from deodar.architectures.feature_space import binding, feature_space
from deodar.architectures.reference_frame import reference_frame, remapping
from deodar.architectures.saliency import saliency
from deodar.architectures.serial_order import action_axis, ordinal_pair, serial_order
from deodar.architectures.two_layer_field import two_layer_field
from deodar.importers.opening import read
from deodar.model.check import check
from tests.deodar_interop.importers.cosivina.files import SAMPLES
from tests.docs.source import EXAMPLES

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
import workloads

DOCUMENTS = sorted(EXAMPLES.glob("*.json"))
TEMPLATES = [
    behaviour,
    behaviours,
    change_detection,
    change_trial,
    binding,
    feature_space,
    plan,
    reference_frame,
    remapping,
    saliency,
    serial_order,
]


def warned(model: dd.Model) -> list[str]:
    return [str(p) for p in check(model.document) if p.severity == "warning"]


@pytest.mark.parametrize("path", DOCUMENTS, ids=lambda p: p.stem)
def test_examples_get_no_warning(path: Path) -> None:
    assert check(dd.load(path).document) == []


def test_the_other_templates_get_no_warning() -> None:
    assert warned(ordinal_pair(action_axis())) == []
    assert warned(two_layer_field([dd.Axis("x", 0, 100, 101)], [dd.Gaussian(1.2, 5)])) == []


@pytest.mark.parametrize("make", TEMPLATES, ids=lambda f: f.__name__)
def test_architectures_get_no_warning(make: Callable[..., dd.Model]) -> None:
    assert warned(make()) == []


@pytest.mark.parametrize("path", SAMPLES, ids=lambda p: p.stem)
def test_imported_models_get_no_warning(path: Path) -> None:
    assert warned(read(path).model) == []


@pytest.mark.parametrize("name", ["W1", "W2", "W3", "W5"])
def test_single_fields_of_the_benchmarks_get_no_warning(name: str) -> None:
    found = [which for which in workloads.WORKLOADS if which.startswith(name)]
    assert found
    for which in found:
        assert warned(workloads.WORKLOADS[which].model()) == []


@pytest.fixture
def compiled(monkeypatch: pytest.MonkeyPatch) -> Iterator[list[Any]]:
    """Collect the programs that JAX compiles."""
    seen: list[Any] = []
    real = jax._src.compiler.backend_compile_and_load  # type: ignore[attr-defined]

    def noted(*args: Any, **others: Any) -> Any:
        seen.append(args)
        return real(*args, **others)

    monkeypatch.setattr(jax._src.compiler, "backend_compile_and_load", noted)  # type: ignore[attr-defined]
    yield seen


def test_a_check_compiles_nothing(compiled: list[Any]) -> None:
    for path in DOCUMENTS:
        check(dd.load(path).document)
    assert compiled == []
    jax.jit(lambda x: x * 3.25 + 0.125)(1.0)
    assert len(compiled) == 1, "the watch works"
