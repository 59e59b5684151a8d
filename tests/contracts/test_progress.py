"""One word for progress, with the same values in all functions that take long."""

from __future__ import annotations

import sys
from collections.abc import Callable
from types import SimpleNamespace

import pytest

import deodar as dd
from deodar import progress
from deodar.progress import Progress
from tests.contracts.test_notebook import field_model

Run = Callable[[dd.Resources], object]


def functions() -> dict[str, Run]:
    """Return a short call of each function."""
    model, _ = field_model("m")
    amplitude = f"{model.document.entries[1].path}.amplitude"
    over = {"u.resting_level": (-6, -4, 2), "u.global_inhibition": (0.5, 1.5, 2)}
    experiment = dd.Experiment(
        "two", model, dd.TrialPlan(10), factors=[dd.Factor("a", [0.0, 1.0], amplitude)]
    )
    return {
        "simulating": lambda on: dd.simulate(model, 30, record=["u.activation"], on=on),
        "running": lambda on: experiment.run(on=on),
        "regimes": lambda on: dd.regimes(dd.Field("node", []), on=on),
        "regime map": lambda on: dd.regime_map(model, over, "u", on=on),
    }


@pytest.fixture(params=functions())
def call(request) -> tuple[str, Run]:
    """Return the word of a function, and its call."""
    return request.param, functions()[request.param]


def test_print_prints_sentences_and_false_nothing(call, capsys) -> None:
    word, run = call
    run(dd.Resources(progress=print))
    lines = capsys.readouterr().out.splitlines()
    assert lines and any(line.startswith(word) for line in lines), lines
    assert not any(line.replace(" ", "").isdigit() for line in lines), "a number alone says nothing"
    run(dd.Resources(progress=False))
    run(dd.Resources())
    assert capsys.readouterr() == ("", ""), "nothing in a pipe"


def test_true_writes_lines_without_a_terminal(call, capsys, monkeypatch) -> None:
    word, run = call
    monkeypatch.setattr(progress, "LINE_AFTER", 0.0)
    run(dd.Resources(progress=True))
    assert capsys.readouterr().err.startswith(word)


def test_a_number_of_progress_is_a_whole_number_with_its_total() -> None:
    done = Progress(3, 12, task="running", unit="trials", seconds_left=4.2)
    assert done + 1 == 4 and done.share == 0.25 and done == 3
    assert str(done) == f"{done}" == "running: 3 of 12 trials, about 4 s left"
    assert (
        str(Progress(0, task="regimes", stage="ramp")) == "regimes: ramp"
        and str(Progress(7, unit="cells")) == "7 cells"
    )


@pytest.mark.parametrize("terminal", [True, False])
def test_a_bar_is_drawn_on_a_terminal_alone(terminal, monkeypatch) -> None:
    written: list[str] = []
    stream = SimpleNamespace(write=written.append, flush=lambda: None, isatty=lambda: terminal)
    monkeypatch.setattr(sys, "stderr", stream)
    with progress.telling(True, "simulating", "steps") as tell:
        tell(5, 10)
    bars = [text for text in written if "[###############...............] simulating: 5 of 10 steps" in text]
    assert len(bars) == terminal


def test_a_notebook_shows_a_bar_that_ends_with_an_empty_line(monkeypatch) -> None:
    written: list[str] = []
    stream = type("OutStream", (), {"__module__": "ipykernel.iostream"})()
    stream.write, stream.flush = written.append, lambda: None
    monkeypatch.setattr(sys, "stdout", stream)
    with progress.telling(True, "simulating", "steps") as tell:
        tell(5, 10)
    assert "[###############...............] simulating: 5 of 10 steps" in written[0]
    assert not written[-1].strip()
    with progress.telling(None, "simulating", "steps") as tell:
        tell(5, 10)
    assert len(written) == 3 and not written[-1].strip(), "short work shows no bar"
