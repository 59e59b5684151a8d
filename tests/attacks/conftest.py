"""Every studio in these tests keeps its state in a folder of the test."""

from __future__ import annotations

from tests.deodar_studio.conftest import own_state, root

__all__ = ["own_state", "root"]
