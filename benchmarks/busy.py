"""The tests beside busy processes: none of them may depend on how fast the machine is.

python benchmarks/busy.py                          the whole suite, five times, beside four busy processes
python benchmarks/busy.py --times 1 tests/batch/test_workers.py
"""

from __future__ import annotations

import argparse
import contextlib
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parents[1]


@contextlib.contextmanager
def busy(count: int) -> Iterator[None]:
    """Processes that compute without a pause, as many as are asked for."""
    processes = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(count)]
    try:
        yield
    finally:
        for process in processes:
            process.kill()
        for process in processes:
            process.wait()


def main() -> None:
    """Run and count."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--times", type=int, default=5, help="how often (default 5)")
    parser.add_argument("--busy", type=int, default=4, help="busy processes beside them (default 4)")
    parser.add_argument("tests", nargs="*", help="of pytest (default: all)")
    args = parser.parse_args()
    passed = 0
    for run in range(1, args.times + 1):
        began = time.monotonic()
        with busy(args.busy):
            status = subprocess.run(
                [sys.executable, "-m", "pytest", "-q", *args.tests], cwd=ROOT, check=False
            ).returncode
        passed += status == 0
        print(
            f"run {run} of {args.times}: status {status} after {(time.monotonic() - began) / 60:.1f} min;"
            f" {passed} passed",
            flush=True,
        )
    raise SystemExit(passed < args.times)


if __name__ == "__main__":
    main()
