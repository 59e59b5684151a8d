"""What all tests share: where compiled programs are kept, and one oracle for everything."""

from __future__ import annotations

import os

import pytest
from hypothesis import HealthCheck, settings

settings.register_profile(
    "quick",
    max_examples=5,
    deadline=None,
    derandomize=True,
    database=None,
    suppress_health_check=list(HealthCheck),
)
settings.register_profile("thorough", settings.get_profile("quick"), max_examples=200, derandomize=False)
settings.load_profile("quick")


@pytest.hookimpl(tryfirst=True)
def pytest_configure(config: pytest.Config) -> None:
    """Tests keep compiled programs in pytest's own folder, never in the user's."""
    os.environ.setdefault("DEODAR_CACHE", str(config.rootpath / ".pytest_cache" / "programs"))
