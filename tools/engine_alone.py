"""Run tests with the engine alone: the packages beside it are hidden, and so are their entry points.

    python tools/engine_alone.py [PYTEST ARGUMENTS]        by default tests/deodar

Python finds a copy of the engine as it would be installed without the other packages: its modules, the
examples, and its metadata without the entry points of the packages. A `sitecustomize` takes `src` off the
path of every process that the tests start.
"""

from __future__ import annotations

import importlib.metadata
import os
import shutil
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PLACE = ROOT / ".cache" / "engine"

SITE = """\
import sys

sys.path[:] = [path for path in sys.path if path != {src!r}]
"""
"""The program of `sitecustomize`: an editable installation has put `src` on the path."""

METADATA = ("METADATA", "RECORD", "WHEEL", "INSTALLER")


def install(place: Path = PLACE) -> Path:
    """Write the engine into a folder, as it would be installed alone, and return the folder."""
    shutil.rmtree(place, ignore_errors=True)
    hidden = shutil.ignore_patterns("__pycache__")
    shutil.copytree(ROOT / "src" / "deodar", place / "deodar", ignore=hidden)
    shutil.copytree(ROOT / "examples", place / "deodar" / "examples", ignore=hidden)
    distribution = importlib.metadata.distribution("deodar")
    info = place / f"deodar-{distribution.version}.dist-info"
    info.mkdir()
    for name in METADATA:
        if (text := distribution.read_text(name)) is not None:
            (info / name).write_text(text, encoding="utf-8")
    (info / "entry_points.txt").write_text("[console_scripts]\ndeodar = deodar.cli:main\n", encoding="utf-8")
    (place / "sitecustomize.py").write_text(SITE.format(src=str(ROOT / "src")), encoding="utf-8")
    return place


def environment(place: Path) -> dict[str, str]:
    """Return the environment in which Python finds the engine in a folder, and no package beside it."""
    before = os.environ.get("PYTHONPATH")
    return {**os.environ, "PYTHONPATH": os.pathsep.join([str(place), *([before] if before else [])])}


def main(arguments: Sequence[str]) -> int:
    """Run pytest; return its status."""
    paths = [] if any(argument.startswith("tests") for argument in arguments) else ["tests/deodar"]
    command = [sys.executable, "-m", "pytest", *arguments, *paths]
    return subprocess.run(command, cwd=ROOT, env=environment(install())).returncode


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
