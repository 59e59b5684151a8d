"""What it takes to open a large record and to draw one time course: `python benchmarks/drawing.py`
(Linux).

The record has a field of 100 x 100 samples and a node. Its values are noise, of which files hold every bit: a
block of 1,024 different frames is repeated, and no chunk of the file contains two equal frames. Each figure
is drawn by a process of its own, `deodar plot`; time and memory are those of the whole process, with starting
Python. On a busy machine the CPU time shows what a quiet one would take.
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

import deodar as dd
from deodar.recording.growing import GrowingRecord

SIDE = 100
BLOCK = 1024
NODE_LIMIT = 2.0, 500.0
"""Seconds and MB that drawing the time course of a node may take."""


def make(path: Path, size: float) -> int:
    """Write a record of that many bytes as a run does; return the number of its times."""
    x, y = (dd.Axis(name, 0, SIDE, samples=SIDE) for name in "xy")
    model = dd.Model("large")
    model.add(dd.Field("u", [x, y]))
    model.add(dd.Field("n", []))
    empty = dd.simulate(model, 1, record=["u.activation", "n.activation"]).isel(time=slice(0, 0))
    frames = round(size / (4 * SIDE * SIDE + 4 + 8))
    rng = np.random.default_rng(1)
    field = rng.standard_normal((BLOCK, SIDE, SIDE), np.float32) - 5
    node = rng.standard_normal(BLOCK, np.float32) - 5
    writer = GrowingRecord(path, empty)
    for first in range(0, frames, BLOCK):
        n = min(BLOCK, frames - first)
        times = np.arange(first, first + n, dtype=float)
        writer.put("time", times, {"u.activation": field[:n], "n.activation": node[:n]})
    writer.close(complete=True)
    return frames


PLOT = """
import sys
from deodar.cli import main
status = main(["plot", *sys.argv[1:], "--force"])
for line in open("/proc/self/status"):
    if line.startswith("VmHWM"):
        print(line.split()[1], file=sys.stderr)
sys.exit(status)
"""
"""`deodar plot`, and the peak of the memory of its process in KiB."""


def plot(*words: str) -> tuple[float, float, float]:
    """Seconds, CPU seconds and MB (10^6 bytes) of `deodar plot` with these arguments."""
    begin, before = time.perf_counter(), os.times()
    done = subprocess.run([sys.executable, "-c", PLOT, *words], capture_output=True, text=True, check=False)
    seconds = time.perf_counter() - begin
    if done.returncode:
        raise SystemExit(done.stderr)
    after = os.times()
    cpu = after.children_user + after.children_system - before.children_user - before.children_system
    return seconds, cpu, float(done.stderr) * 1024 / 1e6


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--size", type=float, default=10.0, help="size of the record in GB (default 10)")
    parser.add_argument("--rounds", type=int, default=3, help="figures of each kind (default 3)")
    parser.add_argument("--folder", type=Path, help="where the record is written, and kept")
    given = parser.parse_args()
    folder = given.folder or Path(tempfile.mkdtemp(prefix="deodar-drawing-"))
    folder.mkdir(exist_ok=True)
    record, figure = folder / "large.zarr", str(folder / "figure.png")
    try:
        if not record.exists():
            begin = time.perf_counter()
            frames = make(record, 1e9 * given.size)
            print(f"written: {frames} times in {time.perf_counter() - begin:.0f} s", flush=True)
        data = dd.open_record(record)
        last = float(data["time"][-1])
        on_disk = sum(p.stat().st_size for p in record.rglob("*") if p.is_file())
        print(f"record: {data.nbytes / 1e9:.2f} GB, {on_disk / 1e9:.2f} GB on the disk")
        print(f"load: {os.getloadavg()[0]:.1f}")
        place = ["u.activation", "--place", "50,50"]
        thousandth = ["--time-range", f"{last / 2:g}", f"{last / 2 + last / 1000:g}"]
        rows = {
            "time course of a node": ["n.activation"],
            "a field at one time": ["u.activation", "--at", f"{round(last / 2)}"],
            "a place of a field, a thousandth of the times": [*place, *thousandth],
            "a place of a field, one sample of 500": [*place, "--every", "500"],
            "a place of a field, all times": place,
        }
        print(f"{'figure':48} {'s':>6} {'CPU s':>6} {'MB':>6}")
        for name, words in rows.items():
            runs = [plot(str(record), *words, "--out", figure) for _ in range(given.rounds)]
            seconds, cpu, _ = map(min, zip(*runs, strict=True))
            memory = max(m for _, _, m in runs)
            print(f"{name:48} {seconds:6.2f} {cpu:6.2f} {memory:6.0f}", flush=True)
        begin, before = time.perf_counter(), time.process_time()
        dd.save_figure(dd.time_course(dd.open_record(record)["n.activation"]), figure, force=True)
        seconds, cpu = time.perf_counter() - begin, time.process_time() - before
        print(f"{'time course of a node, in a running Python':48} {seconds:6.2f} {cpu:6.2f}")
        print(f"limits of the first row: {NODE_LIMIT[0]:g} s, {NODE_LIMIT[1]:g} MB")
    finally:
        if given.folder is None:
            shutil.rmtree(folder, ignore_errors=True)


if __name__ == "__main__":
    main()
