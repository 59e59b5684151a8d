"""Every studio in these tests keeps its state in a folder of the test."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).parents[2] / "examples"


@pytest.fixture(autouse=True)
def own_state(tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch) -> Path:
    folder = tmp_path_factory.mktemp("state")
    monkeypatch.setenv("DEODAR_STATE", str(folder))
    return folder


@pytest.fixture
def root(tmp_path: Path) -> Path:
    """Make a folder with a few documents."""
    for name in ("selection", "working_memory", "saliency", "node"):
        shutil.copy(EXAMPLES / f"{name}.json", tmp_path)
    return tmp_path
