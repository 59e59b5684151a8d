"""Long runs show a progress bar on a terminal, and nothing elsewhere."""

from __future__ import annotations

import os
import pty
import subprocess
import sys

CODE = """
import deodar as dd, deodar.progress as progress
progress.SHOW_AFTER = 0.0
model = dd.Model("bar")
model.add(dd.Field("u", []))
dd.simulate(model, 2000, record=["u.activation"], every=10{progress})
import sys; assert "rich" not in sys.modules
"""


def on_a_terminal(progress: str) -> str:
    ours, theirs = pty.openpty()
    environment = os.environ | {"TERM": "xterm", "COLUMNS": "80"}
    process = subprocess.Popen(
        [sys.executable, "-c", CODE.format(progress=progress)], stderr=theirs, env=environment
    )
    os.close(theirs)
    seen = b""
    while True:
        try:
            part = os.read(ours, 4096)
        except OSError:  # the other end is closed
            break
        if not part:
            break
        seen += part
    os.close(ours)
    assert process.wait(timeout=600) == 0, seen.decode()
    return seen.decode()


def test_a_terminal_shows_a_progress_bar() -> None:
    seen = on_a_terminal("")
    assert "simulating" in seen and "2000 steps" in seen


def test_the_progress_bar_is_not_written_to_a_file_and_can_be_switched_off() -> None:
    assert on_a_terminal(", on=dd.Resources(progress=False)") == ""
    done = subprocess.run(
        [sys.executable, "-c", CODE.format(progress="")], stderr=subprocess.PIPE, text=True, timeout=600
    )
    assert done.returncode == 0 and done.stderr == ""
