"""A live run in the background of a script, where SIGINT is ignored, ends with SIGTERM as with Ctrl-C."""

from __future__ import annotations

import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

import deodar as dd
from deodar.session.interrupt import interrupted_at_end


def test_sigterm_interrupts_also_before_the_first_step_where_sigint_is_ignored() -> None:
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        with pytest.raises(KeyboardInterrupt), interrupted_at_end():
            signal.raise_signal(signal.SIGTERM)
    finally:
        signal.signal(signal.SIGINT, before)


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no SIGHUP")
def test_the_end_of_a_terminal_interrupts_unless_nohup_has_it_ignored() -> None:
    before = signal.getsignal(signal.SIGHUP)
    try:
        signal.signal(signal.SIGHUP, signal.SIG_DFL)
        with pytest.raises(KeyboardInterrupt), interrupted_at_end():
            signal.raise_signal(signal.SIGHUP)
        signal.signal(signal.SIGHUP, signal.SIG_IGN)
        with interrupted_at_end() as received:
            signal.raise_signal(signal.SIGHUP)
        assert received == []
    finally:
        signal.signal(signal.SIGHUP, before)


def test_a_live_run_in_the_background_of_a_script_ends_with_sigterm_and_says_so(tmp_path: Path) -> None:
    model = dd.Model("node")
    model.add(dd.Field("u", []))
    dd.save(model, tmp_path / "node.json")
    command = [sys.executable, "-m", "deodar", "run", "node.json", "--live", "--duration", "600000"]
    command += ["--record", "u", "--out", "run"]
    # a shell without job control makes what it starts with `&` ignore SIGINT
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        process = subprocess.Popen(
            command, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
        )
    finally:
        signal.signal(signal.SIGINT, before)
    try:
        # samples are on the disk
        while not any(tmp_path.glob("run/record.zarr/*/c/*")) and process.poll() is None:
            time.sleep(0.05)
    finally:
        process.terminate()
        _, complaint = process.communicate(timeout=600)
    assert process.returncode == 130
    assert re.search(r"stopped at [0-9.]+ of 600000 ms", complaint.replace("\n", " ")), complaint
