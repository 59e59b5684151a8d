"""Every file of an extension folder registers the parts that it declares."""

from __future__ import annotations

import sys
import types
from collections.abc import Iterator
from pathlib import Path

import pytest

import deodar
from deodar import registry
from deodar.errors import ModelError, UnknownName
from deodar.parameters import Part
from deodar.worlds._base import World

ONE = """
from dataclasses import dataclass
from deodar.parameters import Part
from deodar.registry import register
"""


def _kind(name: str) -> str:
    return f"\n@register\n@dataclass(frozen=True)\nclass {name}(Part):\n    pass\n"


@pytest.fixture
def room(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """Make an extension folder for the test, `deodar.annexe`, and restore the registry afterwards."""
    folder = tmp_path / "annexe"
    folder.mkdir()
    (folder / "__init__.py").write_text("")
    package = types.ModuleType("deodar.annexe")
    package.__path__ = [str(folder)]
    monkeypatch.setitem(sys.modules, "deodar.annexe", package)
    monkeypatch.setattr(deodar, "annexe", package, raising=False)
    monkeypatch.setattr(registry, "ROOMS", (*registry.ROOMS, "annexe"))
    before = dict(registry._kinds)
    yield folder
    registry._kinds.clear()
    registry._kinds.update(before)
    for name in [n for n in sys.modules if n.startswith("deodar.annexe.")]:
        del sys.modules[name]


def test_every_part_of_a_room_is_registered_or_the_base_of_one_that_is() -> None:
    kinds = registry.kinds().values()
    bases = {base for cls in kinds for base in cls.__mro__}
    files = [module for room in registry.ROOMS for module in registry.modules(f"deodar.{room}")]
    declared = [
        cls
        for file in files
        for cls in vars(sys.modules[file]).values()
        if isinstance(cls, type) and issubclass(cls, (Part, World)) and cls.__module__ == file
    ]
    assert {cls.__module__ for cls in declared} == set(files)
    assert not [cls for cls in declared if cls not in bases]


def test_the_groups_contain_the_parts_of_a_first_model() -> None:
    for room, some in {
        "elements": {"Field", "GaussianStimulus", "Boost", "Noise", "Sensor"},
        "couplings": {"Gain", "Project", "Resample", "Weights"},
        "numerics.kernels": {"Gaussian", "Box", "MexicanHat", "Custom", "Shifted"},
        "numerics.sigmoids": {"Logistic", "Absolute", "Step", "Linear", "SemiLinear"},
        "worlds": {"Picture"},
    }.items():
        assert some <= set(registry.kinds(room))


def test_a_file_that_registers_one_kind_is_found(room: Path) -> None:
    (room / "alone.py").write_text(ONE + _kind("Alone"))
    assert registry.kind("Alone").__name__ == "Alone"
    assert list(registry.kinds("annexe")) == ["Alone"]


def test_a_file_registers_a_family_of_kinds(room: Path) -> None:
    (room / "sides.py").write_text(ONE + _kind("Left") + _kind("Right"))
    assert list(registry.kinds("annexe")) == ["Left", "Right"]


def test_a_file_that_registers_none_is_refused(room: Path) -> None:
    (room / "odd.py").write_text(ONE)
    with pytest.raises(ModelError, match=r"deodar\.annexe\.odd registers no kind"):
        registry.kinds()


def test_a_kind_that_is_registered_twice_is_refused(room: Path) -> None:
    (room / "field.py").write_text(ONE + _kind("Field"))
    with pytest.raises(
        ModelError,
        match=r"'Field' is registered twice, by deodar\.elements\.field and by deodar\.annexe\.field",
    ):
        registry.kinds()


def test_files_with_a_leading_underscore_register_no_kind(room: Path) -> None:
    (room / "_base.py").write_text(ONE)
    assert registry.modules("deodar.annexe") == []


def test_a_folder_registers_the_kind_of_the_file_of_its_name_alone(room: Path) -> None:
    (room / "pair").mkdir()
    (room / "pair" / "__init__.py").write_text("")
    (room / "pair" / "pair.py").write_text(ONE + _kind("Pair"))
    (room / "pair" / "helper.py").write_text("")
    assert registry.modules("deodar.annexe") == ["deodar.annexe.pair.pair"]
    assert list(registry.kinds("annexe")) == ["Pair"]


def test_an_unknown_kind_suggests_the_nearest() -> None:
    with pytest.raises(UnknownName, match=r"'Feild'.*Did you mean 'Field'"):
        registry.kind("Feild")
