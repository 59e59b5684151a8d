"""What a release needs besides its tests; RELEASING.md has the steps.

    python tools/release.py blanks         the blanks that are left, with their files; status 1 if any is
    python tools/release.py build [DIST]   both distributions into an empty folder, by default `dist`, judged:
                                           sizes, the page of the studio, what an index checks

`build` makes its own environment with `build` and `twine` in `.cache/release`.
"""

from __future__ import annotations

import argparse
import fnmatch
import re
import subprocess
import sys
import tarfile
import tomllib
import zipfile
import zlib
from collections.abc import Iterator, Sequence
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PLACE = ROOT / ".cache" / "release"
GUIDE = ROOT / "RELEASING.md"
PAGE = "src/deodar_studio/static"

MOST = {".tar.gz": 6_000_000, ".whl": 4_400_000}
"""Bytes that a distribution may have."""

BLANK = re.compile(r"^\| `([^`]+)` \| [^|]+ \| ((?:`[^`]+`(?:, )?)+) \|$", re.MULTILINE)
"""A row of the table of blanks: its text, what it stands for, and its files."""


def blanks() -> dict[str, list[str]]:
    """Return the text of every blank of RELEASING.md, with the files that it names."""
    rows = BLANK.findall(GUIDE.read_text(encoding="utf-8"))
    return {text: re.findall(r"`([^`]+)`", files) for text, files in rows}


def repository() -> list[str]:
    """Return the files that git knows or would add, relative to the repository."""
    command = ["git", "ls-files", "-co", "--exclude-standard"]
    listed = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
    return [name for name in listed.stdout.splitlines() if (ROOT / name).is_file()]


def sdist_files() -> list[str]:
    """Return the files of the repository that the sdist has; the page of the studio, which is built, comes
    with them.
    """
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    left_out = project["tool"]["hatch"]["build"]["targets"]["sdist"]["exclude"]
    return [name for name in repository() if not any(_is_below(name, pattern) for pattern in left_out)]


def _is_below(name: str, pattern: str) -> bool:
    parts = name.split("/")
    if not pattern.startswith("/"):
        return any(fnmatch.fnmatch(part, pattern) for part in parts)
    depth = pattern.count("/")
    return fnmatch.fnmatch("/" + "/".join(parts[:depth]), pattern)


def packed(names: Sequence[str]) -> int:
    """Return the bytes of files of the repository in an archive, about as many as in an sdist."""
    packer = zlib.compressobj()
    return sum(len(packer.compress((ROOT / name).read_bytes())) for name in names) + len(packer.flush())


def main(arguments: Sequence[str]) -> int:
    """Do what the first word says; return the status."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("word", choices=["blanks", "build"])
    parser.add_argument("dist", nargs="?", type=Path, default=ROOT / "dist")
    args = parser.parse_args(arguments)
    if args.word == "build":
        return _build(args.dist)
    for text, files in blanks().items():
        print(f"{text}: {', '.join(files)}")
    return 1 if blanks() else 0


def _build(dist: Path) -> int:
    if dist.is_dir() and any(dist.iterdir()):
        print(f"{dist} is not empty: files of another build would be judged, and uploaded, with these")
        return 1
    python = PLACE / ("Scripts" if sys.platform == "win32" else "bin") / "python"
    _run(sys.executable, "-m", "venv", "--clear", str(PLACE))
    _run(str(python), "-m", "pip", "install", "-q", "build", "twine")
    for project in (ROOT, ROOT / "native"):
        _run(str(python), "-m", "build", "--outdir", str(dist), str(project))
    distributions = sorted(dist.iterdir())
    _run(str(python), "-m", "twine", "check", "--strict", *map(str, distributions))
    problems = [problem for path in distributions for problem in judged(path)]
    for path in distributions:
        print(f"{path.stat().st_size / 1e6:5.2f} MB  {path.name}")
    for problem in problems:
        print(problem)
    return 1 if problems else 0


def judged(path: Path) -> Iterator[str]:
    """Yield what is wrong with a distribution: its size, or no page of the studio in one of deodar."""
    most = next(size for ending, size in MOST.items() if path.name.endswith(ending))
    if path.stat().st_size > most:
        yield f"{path.name} has {path.stat().st_size} bytes, more than {most}"
    if path.name.startswith("deodar-") and not any(
        name.endswith("deodar_studio/static/index.html") for name in _names(path)
    ):
        yield f"{path.name} has no page of the studio: is DEODAR_NO_PAGE set?"


def _names(path: Path) -> list[str]:
    if path.suffix == ".whl":
        with zipfile.ZipFile(path) as wheel:
            return wheel.namelist()
    with tarfile.open(path) as sdist:
        return sdist.getnames()


def _run(*command: str) -> None:
    subprocess.run(command, cwd=ROOT, check=True)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
