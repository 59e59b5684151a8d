"""Two processes, one of which is killed or stopped: motors go to rest, the model ends with a named error."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from deodar_robots.zenoh.served_world import free_endpoint
from tests.house.source import ROOT

STOPS_AFTER = 0.2
PERIOD = 0.01
SLACK = 0.3
"""Delay of a machine that other tests use too, s."""


@pytest.fixture
def pair(tmp_path: Path):
    """Return the processes of a robot and of the model that moves it, and the file of its commands."""
    log = tmp_path / "commands.txt"
    at = free_endpoint()
    plant = started("tests.deodar_robots.zenoh.plant", at, str(log), "live")
    assert "clock live" in line(plant)
    brain = started("tests.deodar_robots.zenoh.brain", at)
    assert line(brain) == "ready\n"
    wait_for(lambda: moving(log))
    yield plant, brain, log
    for each in (brain, plant):
        each.kill()
        each.communicate()


def test_a_robot_whose_model_is_killed_is_at_rest_in_time_and_takes_the_next_model(pair, tmp_path: Path):
    plant, brain, log = pair
    killed = time.monotonic()
    brain.kill()
    wait_for(lambda: not moving(log))
    assert stopped(log) - killed < STOPS_AFTER + PERIOD + SLACK
    at = plant.args[3]
    with started("tests.deodar_robots.zenoh.brain", at) as second:
        assert line(second) == "ready\n"
        wait_for(lambda: moving(log))
        second.kill()
    wait_for(lambda: not moving(log))


@pytest.mark.skipif(sys.platform == "win32", reason="Windows cannot stop a process")
def test_a_robot_whose_model_stands_still_is_at_rest_in_time(pair):
    _, brain, log = pair
    halted = time.monotonic()
    os.kill(brain.pid, signal.SIGSTOP)
    wait_for(lambda: not moving(log))
    assert stopped(log) - halted < STOPS_AFTER + PERIOD + SLACK
    os.kill(brain.pid, signal.SIGCONT)
    wait_for(lambda: moving(log))


def test_a_model_whose_robot_is_killed_ends_with_an_error_that_names_it(pair):
    plant, brain, _ = pair
    killed = time.monotonic()
    plant.kill()
    at, _, text = line(brain).partition(" ")
    assert float(at) - killed < 0.5 + SLACK
    assert "the robot 'wheel' has left the network; its last message came 0." in text
    assert "Its motors stop by themselves" in text
    assert brain.wait(10) == 0


@pytest.mark.skipif(sys.platform == "win32", reason="Windows cannot stop a process")
def test_a_model_whose_robot_stands_still_ends_within_its_patience(pair):
    plant, brain, _ = pair
    halted = time.monotonic()
    os.kill(plant.pid, signal.SIGSTOP)
    at, _, text = line(brain).partition(" ")
    assert 0.45 < float(at) - halted < 0.5 + 2 * SLACK
    assert "the robot 'wheel' shows nothing new of 'angle'; its last message came 0.5" in text
    os.kill(plant.pid, signal.SIGCONT)


def test_a_robot_that_is_asked_to_end_puts_its_motors_to_rest(pair):
    plant, brain, log = pair
    plant.terminate()
    assert plant.wait(10) == 0
    assert not moving(log), "its last command is that at rest"
    assert "wheel has stopped. Messages: " in plant.stdout.read()
    assert "has left the network" in line(brain)


def started(module: str, *arguments: str) -> subprocess.Popen[str]:
    """Start a module of the tests in a process of its own."""
    command = [sys.executable, "-m", module, *arguments]
    return subprocess.Popen(
        command, stdout=subprocess.PIPE, text=True, cwd=ROOT, env=os.environ | ENVIRONMENT
    )


ENVIRONMENT = {
    "PYTHONPATH": os.pathsep.join([str(ROOT), str(ROOT / "src"), os.environ.get("PYTHONPATH", "")])
}


def line(process: subprocess.Popen[str]) -> str:
    """Return the next line that a process prints."""
    assert process.stdout is not None
    return process.stdout.readline()


def commands(log: Path) -> list[tuple[float, float]]:
    """Return the time and the value of each command that reached the wheel."""
    text = log.read_text(encoding="utf-8") if log.is_file() else ""
    rows = [row.split() for row in text.splitlines() if row.count(" ") == 1]
    return [(float(row[0]), float(row[1])) for row in rows]


def moving(log: Path) -> bool:
    """Return whether the newest command moves the wheel."""
    rows = commands(log)
    return bool(rows) and rows[-1][1] != 0


def stopped(log: Path) -> float:
    """Return the time at which the wheel came to rest last."""
    rows = commands(log)
    last = max(k for k, row in enumerate(rows) if row[1] != 0)
    return rows[last + 1][0]


def wait_for(holds, seconds: float = 20.0) -> None:
    """Wait until a condition holds."""
    end = time.monotonic() + seconds
    while not holds():
        assert time.monotonic() < end, "timed out"
        time.sleep(0.02)
