"""Do the commands of docs/install.md lead to a first peak, where nothing of the repository is?

    python tools/install_check.py DIST [PYTHON ...]      wheels of the folder DIST; by default this Python

For each Python the commands of the section *From an index* run word for word in an empty folder, with an
empty home, the wheel of deodar in DIST in place of that of an index, and nothing but this Python on the path.
Each command is printed with its time; the status is 1 where one fails or the page promises another line.
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs" / "install.md"
SECTION = "From an index"
KEPT = ("PIP_", "SSL_", "REQUESTS_", "HTTP", "NO_PROXY", "http", "no_proxy", "LANG", "LC_")
"""Beginnings of the variables that lead pip to an index; all others are left out."""


@dataclass(frozen=True)
class Walk:
    """What the page asks a reader to do: a file to write, commands to type, and the line that they print."""

    file: str
    content: str
    commands: list[str]
    prints: str


def walk(page: str) -> Walk:
    """Return what the section of the page asks a reader to do."""
    [section] = re.findall(rf"^## {SECTION}\n(.*?)(?=^## )", page, re.MULTILINE | re.DOTALL)
    [(file, content)] = re.findall(r'^```python title="([\w.]+)"\n(.*?)^```$', section, re.M | re.S)
    [commands] = re.findall(r"^```sh\n(.*?)^```$", section, re.M | re.S)
    [prints] = re.findall(r"^```text\n(.*?)\n```$", section, re.M | re.S)
    return Walk(file, content, commands.splitlines(), prints)


def main(arguments: Sequence[str]) -> int:
    """Run the commands with each Python; return the status."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("dist", type=Path)
    parser.add_argument("python", nargs="*", default=[sys.executable])
    args = parser.parse_args(arguments)
    wheels = sorted(args.dist.resolve().glob("deodar-*.whl"))
    if len(wheels) != 1:
        parser.error(f"{args.dist} has {len(wheels)} wheels of deodar; one is needed")
    steps = walk(PAGE.read_text(encoding="utf-8"))
    return max(_check(steps, wheels[0], python) for python in args.python)


def _check(steps: Walk, wheel: Path, python: str) -> int:
    """Run the commands in an empty folder; return the status."""
    question = "import sys; print(sys.executable, sys.version.split()[0])"
    real, version = subprocess.check_output([python, "-c", question], text=True).split()
    print(f"Python {version}, {wheel.name}", flush=True)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        environment = surroundings(folder, Path(real), wheel)
        (folder / steps.file).write_text(steps.content, encoding="utf-8")
        printed, begun = "", time.perf_counter()
        for command in steps.commands:
            before = time.perf_counter()
            done = subprocess.run(
                ["/bin/sh", "-c", command], cwd=folder, env=environment, capture_output=True, text=True
            )
            print(f"{time.perf_counter() - before:7.1f} s  {command}", flush=True)
            if done.returncode:
                print(done.stdout[-2000:], done.stderr[-2000:], sep="\n")
                return 1
            printed += done.stdout
        print(f"{(time.perf_counter() - begun) / 60:7.1f} min until the last command has ended")
    if steps.prints not in printed.splitlines():
        print(f"not printed: {steps.prints!r}; printed:\n{printed[-2000:]}")
        return 1
    print(f"          {steps.prints}")
    return 0


def surroundings(folder: Path, python: Path, wheel: Path) -> dict[str, str]:
    """Return the environment of the commands: this Python alone on the path, and the wheel for pip."""
    programs, home = folder / ".programs", folder / ".home"
    programs.mkdir()
    home.mkdir()
    (programs / "python3").symlink_to(python)
    taken = folder / ".constraints"
    taken.write_text(f"deodar @ {wheel.as_uri()}\n", encoding="utf-8")
    of_pip = {name: os.environ[name] for name in os.environ if name.startswith(KEPT)}
    environment = of_pip | {"PATH": str(programs), "HOME": str(home), "PIP_CONSTRAINT": str(taken)}
    assert shutil.which("node", path=environment["PATH"]) is None
    return environment


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
