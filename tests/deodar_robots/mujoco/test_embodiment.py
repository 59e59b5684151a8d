"""A model that points is opened with the table, where no world was chosen and the extra is installed."""

from __future__ import annotations

import sys

import pytest

import deodar as dd
from deodar_studio.world.embodiment import Embodiment, problems


def test_a_model_that_points_gets_the_table_and_another_model_does_not(monkeypatch: pytest.MonkeyPatch):
    document = dd.architectures.pointing().document
    assert isinstance(Embodiment(None).world(document), dd.MuJoCo)
    colours = dd.load("example:color_search").document
    assert isinstance(Embodiment(None).world(colours), dd.Arena)
    monkeypatch.setitem(sys.modules, "mujoco", None)
    assert Embodiment(None).world(document) is None
    fixes = [p.fix for p in problems(document, None) if "'tool_plane'" in p.what]
    assert fixes and all(fix.endswith("such as MuJoCo") for fix in fixes)
