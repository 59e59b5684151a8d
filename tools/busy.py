"""The tests beside busy processes: none of them may depend on how fast the machine is.

python tools/busy.py                      the whole suite, five times, beside four busy processes
python tools/busy.py --times 1 --keep     one run; its row is added to evidence/busy.csv
python tools/busy.py --times 1 tests/deodar/batch/test_workers.py
"""

from __future__ import annotations

import argparse
import contextlib
import csv
import os
import subprocess
import sys
import time
from collections.abc import Iterator
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


def main() -> None:
    """Run and count."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--times", type=int, default=5, help="how often (default 5)")
    parser.add_argument("--busy", type=int, default=4, help="busy processes beside them (default 4)")
    parser.add_argument("--keep", action="store_true", help=f"add a row a run to {ROWS.relative_to(ROOT)}")
    parser.add_argument("tests", nargs="*", help="of pytest (default: all)")
    args = parser.parse_args()
    if args.keep and args.tests:
        parser.error("--keep is for runs of the whole suite; leave out the tests")
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
