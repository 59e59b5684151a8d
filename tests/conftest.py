"""Settings of all tests: options of compiled programs, their folder, the markers, and the profiles of
hypothesis.
"""

from __future__ import annotations

import gc
import os
import signal
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings

from tests import durations, verdict

# small matrices: more threads of BLAS would only wait for each other beside other tests
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

settings.register_profile(
    "quick",
    max_examples=5,
    deadline=None,
    derandomize=True,
    database=None,
    # stated: hypothesis takes another default where the variable CI is set
    print_blob=False,
    suppress_health_check=list(HealthCheck),
)
# `make whole` draws other examples each time; a failure prints the decorator that repeats it
settings.register_profile(
    "new", settings.get_profile("quick"), max_examples=20, derandomize=False, print_blob=True
)
settings.load_profile("quick")

QUICK_PROGRAMS = (
    "--xla_cpu_use_fusion_emitters=false",
    "--xla_backend_optimization_level=0",
    "--xla_cpu_parallel_codegen_split_count=1",
)
"""XLA's older code generator, and no optimisation by LLVM: a program compiles several times as fast, and its
steps take several times as long. Single precision differs in the last digits.
"""

DEFAULT_PROGRAM = (
    # bits
    "tests/contracts/test_worlds.py::test_a_run_is_independent_of_chunks_and_equal_after_a_reset",
    "tests/contracts/test_worlds.py::test_the_run_inside_the_step_equals_that_outside_of_it",
    "tests/old_files/",
    "tests/benchmarks/test_bits.py",
    "tests/benchmarks/test_trajectories.py",
    "tests/docs/test_pages.py::test_a_page_runs[command-line]",
    "tests/docs/test_pages.py::test_a_page_runs[instabilities]",
    "tests/deodar/session/test_invariance.py",
    "tests/deodar/elements/test_moving_gaussian.py::test_how_a_run_is_cut",
    "tests/deodar/elements/test_time_series.py::test_how_a_run_is_cut",
    # long runs
    "tests/deodar/architectures/test_change_detection.py",
    "tests/deodar/architectures/test_serial_order.py",
    "tests/deodar/architectures/test_spa.py",
    "tests/benchmarks/test_resolution.py",
    "tests/docs/test_pages.py::test_a_page_runs[saliency]",
    "tests/docs/test_pages.py::test_a_page_runs[spa]",
    "tests/deodar_papers/looking/test_looking.py",
    "tests/deodar_papers/pointing/test_trials.py",
    "tests/deodar_papers/saliency/test_demo.py",
    "tests/deodar_papers/saliency/test_untuned.py",
    "tests/deodar_papers/serial_order/test_experiments.py::test_a_robot_that_is_carried_elsewhere_completes",
    "tests/deodar/session/test_memory.py",
    "tests/deodar/session/test_resolution.py",
)
"""Tests that judge the bits of programs or compare them with stored ones, and tests that run so long that
optimised steps save more time than their compilation takes: `tools/suite.py` runs them in calls of their own,
with `--default-programs`.
"""


GARBAGE = (20_000, 20, 20)
"""Thresholds of the three generations of garbage; by default the first one is 700."""


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
    group.addoption(
        "--require-durations",
        action="store_true",
        help=f"fail if a function without a row takes more than {durations.UNMEASURED:g} s of CPU time",
    )


@pytest.hookimpl(tryfirst=True)
def pytest_configure(config: pytest.Config) -> None:
    """Keep compiled programs in pytest's own folder, and byte code, also for processes that tests start; keys
    of robots and other states of a user are in a temporary folder.
    """
    os.environ.setdefault("DEODAR_CACHE", str(config.rootpath / ".pytest_cache" / "programs"))
    if not hasattr(config, "workerinput"):  # workers inherit it
        states = tempfile.TemporaryDirectory(prefix="deodar-states-", ignore_cleanup_errors=True)
        os.environ["DEODAR_STATE"] = states.name
        config.add_cleanup(states.cleanup)
    # a shell without job control makes what it starts with `&` ignore SIGINT, and that what it starts
    signal.signal(signal.SIGINT, signal.default_int_handler)
    # compiled kernels have tests of their own, in `native/tests`
    os.environ["DEODAR_NATIVE"] = "off"
    os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
    sys.dont_write_bytecode = False
    flags = os.environ.get("XLA_FLAGS", "").split()
    if not config.getoption("--default-programs"):
        os.environ["XLA_FLAGS"] = " ".join(dict.fromkeys((*flags, *QUICK_PROGRAMS)))
    keep, required = (config.getoption(f"--{name}-durations") for name in ("write", "require"))
    if keep or required:
        config.pluginmanager.register(durations.Meter())
        if not hasattr(config, "workerinput"):
            config.pluginmanager.register(durations.Durations(keep))


@pytest.hookimpl(wrapper=True)
def pytest_collection() -> Iterator[None]:
    """Search for garbage rarely, and never among what collecting the tests has made.

    A search visits all objects that may be part of a cycle. Modules and tests are half a million, which
    stay, and tracing a program makes enough others to start a search with the default thresholds.
    """
    gc.disable()
    try:
        return (yield)
    finally:
        gc.collect()
        gc.freeze()
        gc.set_threshold(*GARBAGE)
        gc.enable()


def pytest_ignore_collect(collection_path: Path, config: pytest.Config) -> bool | None:
    """Read only the files of DEFAULT_PROGRAM if nothing else was asked for."""
    if not config.option.markexpr.startswith("default_program") or collection_path.is_dir():
        return None
    place = collection_path.relative_to(config.rootpath).as_posix()
    return not any(place.startswith(name.partition("::")[0]) for name in DEFAULT_PROGRAM) or None


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Mark tests; in a process of xdist the longest files come first, so that all processes end together."""
    rows = durations.read()
    fast = durations.fast((item.nodeid for item in items), rows)
    chosen = verdict.chosen(rows, verdict.read(verdict.KILLS), verdict.read(verdict.FLOOR))
    for item in items:
        if item.nodeid.startswith(DEFAULT_PROGRAM):
            item.add_marker(pytest.mark.default_program)
        elif item.nodeid in fast:
            item.add_marker(pytest.mark.fast)
        if (name := durations.function(item.nodeid)) in chosen or name not in rows:
            item.add_marker(pytest.mark.verdict)
    if hasattr(config, "workerinput"):
        files = durations.files(rows)
        items.sort(key=lambda item: -files[item.nodeid.split("::")[0]])
