"""The memory of a run grows only with what is recorded."""

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
grown(200)
grown(200, record=["u.activation"], every=100)
silent, _ = grown(4000)
sparse, size = grown(4000, record=["u.activation"], every=100)
dense, large = grown(4000, record=["u.activation"])
print(silent, sparse, size, dense, large)
assert silent < 12, silent
assert sparse < 12 + size, sparse
assert 30 < large and dense < 60 + 2 * large, dense
"""


def test_a_long_run_that_records_little_keeps_little() -> None:
    done = subprocess.run([sys.executable, "-c", CODE], capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stdout + done.stderr
