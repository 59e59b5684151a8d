"""What all tests share: how programs are compiled and kept, the markers, and one profile of hypothesis."""

from __future__ import annotations

import os
import sys

import pytest
from hypothesis import HealthCheck, settings

from tests import durations

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

QUICK_PROGRAMS = "--xla_cpu_use_fusion_emitters=false"
"""XLA's older code generator: a program compiles in two thirds of the time, and its steps take up to
three times as long. Single precision differs in the last digits.
"""

DEFAULT_PROGRAM = (
    "tests/contracts/",
    "tests/old_files/",
    "tests/benchmarks/test_bits.py",
    "tests/benchmarks/test_trajectories.py",
    "tests/session/test_invariance.py",
    "tests/elements/test_moving_gaussian.py::test_how_a_run_is_cut",
    "tests/elements/test_time_series.py::test_how_a_run_is_cut",
)
"""What judges the bits of programs, or compares them with stored ones: `make test` runs it with
`--default-programs`.
"""


def pytest_addoption(parser: pytest.Parser) -> None:
    """Options of this suite."""
    group = parser.getgroup("deodar")
    group.addoption(
        "--default-programs", action="store_true", help="compile as deodar does, not in a quicker way"
    )
    group.addoption(
        "--write-durations",
        action="store_true",
        help=f"measure CPU seconds and write them to {durations.FILE}",
    )


@pytest.hookimpl(tryfirst=True)
def pytest_configure(config: pytest.Config) -> None:
    """Keep compiled programs in pytest's own folder, and byte code, also for processes that tests start."""
    os.environ.setdefault("DEODAR_CACHE", str(config.rootpath / ".pytest_cache" / "programs"))
    os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
    sys.dont_write_bytecode = False
    flags = os.environ.get("XLA_FLAGS", "")
    if not config.getoption("--default-programs") and QUICK_PROGRAMS not in flags:
        os.environ["XLA_FLAGS"] = f"{flags} {QUICK_PROGRAMS}".strip()
    if config.getoption("--write-durations"):
        config.pluginmanager.register(durations.Recorder(), "durations-recorder")


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Mark tests; in a process of xdist the longest files come first, so that all processes end together."""
    seconds = durations.seconds()
    for item in items:
        if durations.function(item.nodeid) not in seconds:
            item.add_marker(pytest.mark.fast)
        if item.nodeid.startswith(DEFAULT_PROGRAM):
            item.add_marker(pytest.mark.default_program)
    if hasattr(config, "workerinput"):
        files = durations.files(seconds)
        items.sort(key=lambda item: -files[item.nodeid.split("::")[0]])
