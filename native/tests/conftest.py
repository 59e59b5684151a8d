"""The kernels are tested with deodar, in the same environment, each test with a folder of programs of its
own.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from deodar.compiler import executable
from deodar.numerics import native


@pytest.fixture(autouse=True)
def place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return the folder of compiled programs."""
    monkeypatch.setenv("DEODAR_CACHE", str(tmp_path / "programs"))
    monkeypatch.delenv(native.SWITCH, raising=False)
    executable._shared.cache_clear()
    return tmp_path / "programs"
