"""What the packages cost that deodar needs: their size on disk, and the time of an import."""

from __future__ import annotations

import importlib.metadata
import subprocess
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

MB = 1e6

MEASURE = "import time; a = time.process_time(); import {}; print(time.process_time() - a)"
"""A program that prints the CPU seconds of an import."""


@dataclass(frozen=True)
class PackageCost:
    """The cost of one package.

    Attributes:
        name: of the distribution.
        version: its version.
        needed_by: the first distribution that requires it, by the number of steps from deodar.
        mb: size of its files, in millions of bytes.
        seconds: CPU time of its import in a new process, with all that it imports; None: it has no module
            that can be imported.
    """

    name: str
    version: str
    needed_by: str
    mb: float
    seconds: float | None


def closure(root: str = "deodar") -> dict[str, str]:
    """Return the installed distributions that one needs without an extra, each with the one that requires
    it.
    """
    parents: dict[str, str] = {}
    waiting = [root]
    while waiting:
        parent = waiting.pop(0)
        for name in _requirements(parent):
            if name != root and name not in parents and _is_installed(name):
                parents[name] = parent
                waiting.append(name)
    return parents


def _requirements(name: str) -> Iterator[str]:
    """Yield the requirements of a distribution that hold for this Python without an extra."""
    for text in importlib.metadata.requires(name) or ():
        requirement = Requirement(text)
        if requirement.marker is None or requirement.marker.evaluate({"extra": ""}):
            yield canonicalize_name(requirement.name)


def _is_installed(name: str) -> bool:
    try:
        importlib.metadata.distribution(name)
    except importlib.metadata.PackageNotFoundError:
        return False
    return True


def measure(name: str, needed_by: str, modules: Mapping[str, Sequence[str]]) -> PackageCost:
    """Measure one package.

    Args:
        name: of the distribution.
        needed_by: the distribution that requires it.
        modules: the modules of each distribution (`modules_by_distribution`).
    """
    distribution = importlib.metadata.distribution(name)
    paths = [Path(str(distribution.locate_file(file))) for file in distribution.files or ()]
    size = sum(path.stat().st_size for path in paths if path.is_file())
    names = modules.get(canonicalize_name(name), ())
    seconds = _import_seconds(_main(name, names)) if names else None
    return PackageCost(distribution.name, distribution.version, needed_by, size / MB, seconds)


def modules_by_distribution() -> dict[str, list[str]]:
    """Return the modules that each distribution installs at the top level, by its canonical name."""
    modules: dict[str, list[str]] = {}
    for module, distributions in importlib.metadata.packages_distributions().items():
        for name in distributions:
            modules.setdefault(canonicalize_name(name), []).append(module)
    return modules


def _main(name: str, modules: Sequence[str]) -> str:
    """Return the module that has the name of its distribution, or the first one that is public."""
    return min(modules, key=lambda m: (canonicalize_name(m) != name, m.startswith("_"), m))


def _import_seconds(module: str) -> float | None:
    run = subprocess.run(
        [sys.executable, "-c", MEASURE.format(module)], capture_output=True, text=True, check=False
    )
    return float(run.stdout) if run.returncode == 0 else None
