"""What all tests share: where compiled programs are kept, and one oracle for everything."""

from __future__ import annotations

import os

import pytest


@pytest.hookimpl(tryfirst=True)
def pytest_configure(config: pytest.Config) -> None:
    """Tests keep compiled programs in pytest's own folder, never in the user's."""
    os.environ.setdefault("DEODAR_CACHE", str(config.rootpath / ".pytest_cache" / "programs"))
