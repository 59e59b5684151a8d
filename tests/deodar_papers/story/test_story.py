"""`deodar demo`: the whole command, its lines, its files, and its offer at a terminal."""

from __future__ import annotations

import io
import json
import os
import pty
import re
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest
from PIL import Image

import deodar as dd
from deodar import cli
from deodar_papers.commands import demo as command
from deodar_papers.story import demo, one_field
from deodar_papers.story.demo import Story

LARGEST = 1_500_000
"""Bytes of a moving picture."""

MOST_CPU = 120.0
"""CPU seconds: 25 on an idle machine, up to 52 beside a browser on two cores that share their caches. A fault
would be a demo of minutes."""


@dataclass(frozen=True)
class Run:
    """A run of the command in an empty folder."""

    out: str
    err: str
    folder: Path
    cpu: float


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Run:
    folder = tmp_path_factory.mktemp("story")
    before = os.times()
    done = subprocess.run(
        [sys.executable, "-m", "deodar", "demo"], cwd=folder, capture_output=True, text=True, timeout=600
    )
    after = os.times()
    assert done.returncode == 0, done.stderr
    cpu = after.children_user - before.children_user + after.children_system - before.children_system
    return Run(done.stdout, done.stderr, folder / demo.FOLDER, cpu)


def test_the_command_prints_fifteen_lines_into_a_pipe(run: Run) -> None:
    lines = run.out.splitlines()
    assert len(lines) == 15 and max(map(len, lines)) <= 75
    assert not run.err and "computing the" not in run.out and not re.search(r"[\r\x1b]", run.out)
    assert re.fullmatch(r"1  The story of one field +story\.gif, \d+ s +\d+ s", lines[2])
    assert re.fullmatch(r"2  The same on a photograph +photograph\.gif, \d+ s +\d+ s", lines[7])
    assert [line.split()[0] for line in lines[3:7]] == ["detection", "selection", "memory", "forgetting"]
    assert lines[8:11] == [
        "     red           one peak, on the saucer; the motor variable turns to it",
        "     light brown   one peak, on the coffee; the motor variable turns to it",
        "     blue          not in the picture: no peak, the motor variable stays",
    ]
    assert lines[11] == "Both are in deodar-demo/. Now try"


def test_the_four_lines_have_the_numbers_of_regimes(run: Run) -> None:
    measured = dd.regimes(one_field.field())
    assert measured.reverse is None and measured.detection and measured.forgetting
    assert len(measured.selection.equal) == 1 and measured.memory.outlives
    lines = run.out.splitlines()[3:7]
    assert f"exceeds {measured.detection:.2f} ± 0.01" in lines[0] and "one makes a peak" in lines[1]
    assert "stays when its input goes" in lines[2]
    assert f"lowered by {-measured.forgetting:.3f} ± 0.003" in lines[3]


def test_the_folder_has_both_videos_the_claims_and_the_model(run: Run) -> None:
    names = ["photograph.gif", "results.json", "selection.json", "story.gif"]
    assert sorted(p.name for p in run.folder.iterdir()) == names
    claims = json.loads((run.folder / "results.json").read_text())["claims"]
    assert len(claims) == 11 and all(c["holds"] for c in claims)
    assert dd.load(run.folder / "selection.json").document == one_field.selection().document


@pytest.mark.parametrize(("name", "seconds", "pictures"), [("story", 29.7, 280), ("photograph", 27.3, 140)])
def test_a_video_is_small_and_loops(name: str, seconds: float, pictures: int, run: Run) -> None:
    file = run.folder / f"{name}.gif"
    assert file.stat().st_size < LARGEST
    with Image.open(file) as gif:
        assert gif.size == (960, 600) and gif.info["loop"] == 0 and gif.n_frames >= pictures
        total = 0.0
        for k in range(gif.n_frames):
            gif.seek(k)
            total += gif.info["duration"]
        assert total / 1000 == pytest.approx(seconds, abs=2.0)


def test_the_command_costs_little(run: Run) -> None:
    assert run.cpu < MOST_CPU


def told_at_once(args: object, show: command._Shown) -> Story:
    """Return a story without a run, for what the command does after it."""
    show.line("1  The story of one field")
    return Story([], {}, "story.gif", "", lambda folder: None, "selection.json")


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(demo, "run", told_at_once)
    yield tmp_path


def test_a_second_run_leaves_the_folder_of_the_first(folder: Path) -> None:
    assert cli.main(["demo"]) == 0
    (folder / "deodar-demo" / "mine.txt").write_text("do not lose me")
    assert cli.main(["demo", "story"]) == 0
    assert sorted(p.name for p in folder.iterdir()) == ["deodar-demo", "deodar-demo-001"]
    assert (folder / "deodar-demo" / "mine.txt").is_file()


@pytest.mark.parametrize(("answer", "opens"), [("y\n", True), ("\n", False)])
def test_the_studio_is_offered_at_a_terminal_with_a_display(
    answer: str,
    opens: bool,
    folder: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    opened: list[list[str]] = []
    main = cli.main
    monkeypatch.setattr(command, "_display", lambda: True)
    monkeypatch.setattr(sys, "stdin", io.StringIO(answer))
    monkeypatch.setattr(cli, "main", lambda words: opened.append(words) or 0)
    assert main(["demo", "--no-progress"]) == 0
    assert opened == ([["studio", str(folder / "deodar-demo" / "selection.json")]] if opens else [])
    assert "Open the studio on this field? [y/N]" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("environment", "terminal", "offered"),
    [({"DISPLAY": ":0"}, True, True), ({}, True, False), ({"WAYLAND_DISPLAY": "wayland-0"}, False, False)],
)
def test_without_a_display_or_a_terminal_nothing_is_offered(
    environment: dict[str, str], terminal: bool, offered: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)
    for name, text in environment.items():
        monkeypatch.setenv(name, text)
    monkeypatch.setattr(sys, "platform", "linux")
    for stream in ("stdin", "stdout", "stderr"):
        monkeypatch.setattr(getattr(sys, stream), "isatty", lambda: terminal, raising=False)
    assert command._display() is offered


TERMINAL = """
from deodar.progress import telling
from deodar_papers.commands.demo import _Shown
import time
with telling(True, "compiling") as tell:
    show = _Shown(tell, quiet=False)
    show("computing the run of a field", 0.0)
    time.sleep(0.3)
    show.line("1  The story of one field")
print("the end")
"""


def test_at_a_terminal_the_line_of_the_present_task_is_overwritten() -> None:
    master, slave = pty.openpty()
    environment = {**os.environ, "TERM": "xterm", "COLUMNS": "80"}
    process = subprocess.Popen(
        [sys.executable, "-c", TERMINAL], stdin=slave, stdout=slave, stderr=slave, env=environment
    )
    os.close(slave)
    output = b""
    while True:
        try:
            part = os.read(master, 4096)
        except OSError:  # the other end is closed
            break
        if not part:
            break
        output += part
    os.close(master)
    assert process.wait() == 0
    text = output.decode()
    assert text.index("computing the run of a field") < text.index("1  The story of one field")
    after = text[text.rindex("computing the run") :]
    assert f"\r{' ' * 79}\r1  The story" in after, "the line of the task is erased"
    assert text.rstrip().endswith("the end")
