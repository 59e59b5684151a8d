"""The memory of a run grows only with its record."""

from __future__ import annotations

import subprocess
import sys

CODE = """
import psutil, deodar as dd
x = dd.Axis("x", 0, 100, samples=2001)
model = dd.Model("memory")
model.add(dd.Field("u", [x], noise=0.1))
def grown(steps, **record):
    before = psutil.Process().memory_info().rss
    kept = dd.simulate(model, steps, **record)
    return (psutil.Process().memory_info().rss - before) / 2**20, kept.nbytes / 2**20
# what compiling and the first buffers take is not counted: the smallest growth of two like runs;
# buffers of 16 MiB come and go
silent = min(grown(16000)[0] for _ in range(4))
sparse, size = min(grown(16000, record=["u.activation"], every=100) for _ in range(2))
dense, large = min(grown(16000, record=["u.activation"]) for _ in range(2))
print(silent, sparse, size, dense, large)
assert silent < 40, silent
assert sparse < 40 + size, sparse
assert 100 < large and dense < 60 + 2 * large, dense
"""


def test_memory_of_a_long_run_grows_only_with_the_record() -> None:
    done = subprocess.run([sys.executable, "-c", CODE], capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stdout + done.stderr
