"""The tests started in other ways: none may depend on how fast the machine is, nor on how they were started.

python tools/busy.py                       the whole suite, five times, beside four busy processes
python tools/busy.py --times 1 --keep      one run; its row is added to evidence/busy.csv
python tools/busy.py --times 1 tests/deodar/batch/test_workers.py
python tools/busy.py --as WAY,WAY ...      the verdict (or the tests that follow) once in each way

Ways: background (SIGINT ignored, as of a job that a script starts with `&`), closed (no standard input, no
terminal), umlaut (a folder with a blank and an umlaut), user (not root; only root can try it), readonly
(nothing can be written at home), C (LANG and LC_ALL), zone (14 hours from UTC), ci (variables that a public
CI sets), load (20 busy processes), twice (two at the same time, of two copies). A way that has to write
elsewhere runs in a copy of the files that git knows.
"""

from __future__ import annotations

import argparse
import contextlib
import csv
import dataclasses as dc
import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

import suite

ROOT = Path(__file__).parents[1]
ROWS = ROOT / "evidence" / "busy.csv"
FIELDS = ("date", "commit", "python", "cores", "busy", "minutes", "status", "passed", "failed")

COMPUTE = "while True: pass"
START = (
    "import subprocess, sys; a = [subprocess.Popen([sys.executable, '-c', sys.argv[2]]) "
    "for _ in range(int(sys.argv[1]))]; sys.stdin.read(); [x.kill() for x in a]; [x.wait() for x in a]"
)


@contextlib.contextmanager
def busy(count: int) -> Iterator[None]:
    """Run processes that compute without a pause. They have a session of their own, as another program of the
    same user has; they end with this one.
    """
    parent = subprocess.Popen(
        [sys.executable, "-c", START, str(count), COMPUTE], stdin=subprocess.PIPE, start_new_session=True
    )
    try:
        yield
    finally:
        assert parent.stdin is not None
        parent.stdin.close()
        parent.wait()


def counted(report: str) -> tuple[int, int]:
    """Read the numbers of tests that passed and that failed from the last line that pytest prints."""
    numbers = {"passed": 0, "failed": 0, "errors": 0, "error": 0}
    for part in report.strip().rpartition("\n")[2].split(" in ")[0].split(", "):
        words = part.strip("= ").split()
        if len(words) == 2 and words[0].isdigit() and words[1] in numbers:
            numbers[words[1]] = int(words[0])
    return numbers["passed"], numbers["failed"] + numbers["errors"] + numbers["error"]


def keep(row: dict[str, object], file: Path = ROWS) -> None:
    """Append a row to a table; a new table begins with its header."""
    new = not file.exists()
    with file.open("a", encoding="utf-8", newline="") as opened:
        writer = csv.DictWriter(opened, FIELDS)
        if new:
            writer.writeheader()
        writer.writerow(row)


def _commit() -> str:
    told = subprocess.run(["git", "rev-parse", "--short", "HEAD"], cwd=ROOT, capture_output=True, text=True)
    return told.stdout.strip()


@dc.dataclass(frozen=True)
class Way:
    """A way to start the tests.

    Attributes:
        shell: what a shell does before it becomes the tests.
        closed: whether the shell has no standard input.
        folder: name of the copy in which they run; empty: here.
        environment: variables that are set for them.
        user: number of their user; None: that of this process.
        busy: processes that compute beside them.
        runs: how many run at the same time, each in a copy of its own.
    """

    shell: str = ""
    closed: bool = False
    folder: str = ""
    environment: Mapping[str, str] = dc.field(default_factory=dict[str, str])
    user: int | None = None
    busy: int = 0
    runs: int = 1


NOBODY = 65534

WAYS = {
    "background": Way("trap '' INT;"),
    "closed": Way(closed=True),
    "umlaut": Way(folder="Ein Ordner f\u00fcr Tests"),
    "user": Way(folder="deodar", user=NOBODY),
    "readonly": Way(environment={"HOME": "/dev/null/home", "USERPROFILE": "/dev/null/home"}),
    "C": Way(environment={"LANG": "C", "LC_ALL": "C"}),
    "zone": Way(environment={"TZ": "Pacific/Kiritimati"}),
    "ci": Way(environment={"CI": "true", "GITHUB_ACTIONS": "true", "TERM": "dumb"}),
    "load": Way(busy=20),
    "twice": Way(folder="deodar", runs=2),
}


def copied(folder: Path) -> Path:
    """Copy the files that git knows, and the page that was built, into a folder."""
    told = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, check=True).stdout
    page = ROOT / "src" / "deodar_studio" / "static"
    for path in [*(ROOT / name for name in told.decode().split("\0") if name), *page.rglob("*")]:
        if path.is_file():
            target = folder / path.relative_to(ROOT)
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(path, target)
    return folder


def started(way: Way, call: Sequence[str], root: Path) -> subprocess.Popen[str]:
    """Start a call of Python in a way."""
    environment = {**os.environ, **way.environment}
    if way.folder:
        environment["PYTHONPATH"] = str(root / "src")
    if way.user is not None:
        environment["HOME"] = str(root.parent)
    shell = ["sh", "-c", f'{way.shell} exec "$@"{" <&-" if way.closed else ""}', "sh"]
    return subprocess.Popen(
        [*shell, sys.executable, *call],
        cwd=root,
        env=environment,
        user=way.user,
        start_new_session=way.closed,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )


def tried(name: str, calls: Sequence[Sequence[str]]) -> bool:
    """Run calls of Python in a way, and print what failed; return whether all passed."""
    way, began, good = WAYS[name], time.monotonic(), True
    with tempfile.TemporaryDirectory() as place, busy(way.busy):
        roots = [copied(Path(place, str(k), way.folder)) for k in range(way.runs)] if way.folder else [ROOT]
        if way.user is not None:
            subprocess.run(["chown", "-R", str(way.user), place], check=True)
        for call in calls:
            for process in [started(way, call, root) for root in roots]:
                report, _ = process.communicate()
                passed, failed = counted(report)
                if process.returncode:
                    good = False
                    print(report)
                print(f"{name}: {passed} passed, {failed} failed, status {process.returncode}", flush=True)
    print(
        f"{name}: {'passed' if good else 'FAILED'} after {(time.monotonic() - began) / 60:.1f} min",
        flush=True,
    )
    return good


def main() -> None:
    """Run and count."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--times", type=int, default=5, help="how often (default 5)")
    parser.add_argument("--busy", type=int, default=4, help="busy processes beside them (default 4)")
    parser.add_argument("--keep", action="store_true", help=f"add a row a run to {ROWS.relative_to(ROOT)}")
    parser.add_argument("--as", dest="ways", help=f"ways to start them: {','.join(WAYS)}")
    parser.add_argument("tests", nargs="*", help="of pytest (default: all)")
    args = parser.parse_args()
    if args.keep and args.tests:
        parser.error("--keep is for runs of the whole suite; leave out the tests")
    if args.ways is not None:
        ways = args.ways.split(",")
        if unknown := [way for way in ways if way not in WAYS]:
            parser.error(f"unknown ways {', '.join(unknown)}; there are {', '.join(WAYS)}")
        calls = [(*suite.PYTEST, *suite.SPREAD, *args.tests)] if args.tests else suite.calls("verdict")
        raise SystemExit(not all([tried(way, calls) for way in ways]))
    good = 0
    for run in range(1, args.times + 1):
        began = time.monotonic()
        status = passed = failed = 0
        with busy(args.busy):
            for call in [(*suite.PYTEST, *args.tests)] if args.tests else suite.calls("whole"):
                tests = subprocess.Popen([sys.executable, *call], cwd=ROOT, stdout=subprocess.PIPE, text=True)
                assert tests.stdout is not None
                report = ""
                for line in tests.stdout:
                    print(line, end="", flush=True)
                    report = report if not line.strip() else line
                status = tests.wait() or status
                here = counted(report)
                passed, failed = passed + here[0], failed + here[1]
        minutes = (time.monotonic() - began) / 60
        good += status == 0
        if args.keep:
            row = {"date": time.strftime("%Y-%m-%d"), "commit": _commit(), "python": sys.version.split()[0]}
            row |= {"cores": os.cpu_count(), "busy": args.busy, "minutes": f"{minutes:.1f}"}
            keep({**row, "status": status, "passed": passed, "failed": failed})
        print(
            f"run {run} of {args.times}: status {status} after {minutes:.1f} min; {good} passed", flush=True
        )
    raise SystemExit(good < args.times)


if __name__ == "__main__":
    main()
