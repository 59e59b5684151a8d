"""Write every file that follows from the code: entry points, public names, reference, schemas, documents.

    python tools/generate.py

Each step is a process of its own, because it reads what the steps before it wrote. The files that changed are
printed. What takes minutes stays apart: pictures (`docs/build.py --pages`), stored trajectories
(`benchmarks/trajectories.py`) and the CPU times of tests (`pytest --write-durations`).
"""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]

STEPS: Mapping[tuple[str, ...], Sequence[str]] = {
    ("tools/entry_points.py",): ["pyproject.toml"],
    ("tools/stub.py",): ["src/deodar/__init__.pyi", "src/deodar/figures/__init__.py"],
    ("-m", "deodar.model.schema"): ["src/deodar/model/document.schema.json"],
    ("-m", "deodar_robots.robot.schema"): ["src/deodar_robots/robot/robot.schema.json"],
    ("-m", "deodar_studio.requests.protocol"): [
        "src/deodar_studio/requests/protocol.schema.json",
        "studio/src/protocol.ts",
    ],
    ("tools/own_plots.py",): ["src/deodar_studio/catalogue/own_plots.txt"],
    ("examples/make.py",): ["examples/*.json", "examples/*.npz"],
    ("docs/reference.py",): ["docs/*.md", "docs/reference/*.md"],
    ("docs/evidence.py",): ["README.md", "docs/*.md", "evidence/*/results.json"],
}
"""For each command, in this order, patterns of the files that it may write."""


def contents(patterns: Sequence[str]) -> dict[Path, bytes]:
    """Return the content of each file that a pattern matches."""
    return {path: path.read_bytes() for pattern in patterns for path in ROOT.glob(pattern)}


def main() -> int:
    """Write the files, and print the names of those that changed; return the status of the first failure."""
    patterns = [pattern for written in STEPS.values() for pattern in written]
    before = contents(patterns)
    for command in STEPS:
        done = subprocess.run([sys.executable, *command], cwd=ROOT, stdout=subprocess.DEVNULL, check=False)
        if done.returncode:
            print(f"python {' '.join(command)} failed")
            return done.returncode
    after = contents(patterns)
    changed = sorted(path for path in before.keys() | after.keys() if before.get(path) != after.get(path))
    for path in changed:
        print(path.relative_to(ROOT))
    print(f"{len(changed)} files changed")
    return 0


if __name__ == "__main__":
    sys.exit(main())
