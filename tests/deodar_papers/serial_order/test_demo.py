"""The demonstration of serial order: a short sequence, and claims that follow from a trial."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
import xarray
from PIL import Image

from deodar.experiments.trial import Trial
from deodar_papers.figures.sequence import sequence_figure
from deodar_papers.serial_order import narrative
from deodar_papers.serial_order.arenas import Block, SearchArena
from deodar_papers.serial_order.colours import hue_of
from deodar_papers.serial_order.runs import ABSENT, COARSE, TaughtRun
from deodar_papers.serial_order.teaching import brief_lesson
from tests.command_line import typed

BEGINS = 2000.0
SEARCH = 2000.0
"""Duration of each search of the made trials, ms."""


def made(taught: str, recalled: str, satisfying: str, blocks: str = "RGBYV") -> narrative.SearchRun:
    """Return the events of a trial without noise: one node after another is active for `SEARCH`, has the
    recalled colours in the action field, and is switched off by a block of the colours in `found`.
    """
    arena = SearchArena(600.0, tuple(Block(c, (100.0, 0.0)) for c in blocks), (0.0, 0.0, 0.0))
    lesson, end = brief_lesson(taught)
    times = np.arange(0.0, BEGINS + SEARCH * len(taught) + 1000.0, COARSE)
    count = len(times)
    v = {name: np.full(count, -1.0) for name in ("strongest action.output", "strongest satisfaction.output")}
    v |= {f"hue of {name}.output": np.full(count, ABSENT) for name in narrative.FIELDS}
    v |= {f"{name}.activation": np.full((count, 180), -3.0) for name in narrative.FIELDS}
    v |= {f"item {k}.node.activation": np.full(count, -3.0) for k in range(1, len(taught) + 2)}
    v["strongest peak.output"], v["touching.output"] = np.zeros(count), np.zeros(count)
    v[narrative.PROJECTION], v[narrative.POSE] = np.zeros((count, 80)), np.zeros((count, 3))
    v[narrative.MEANINGS] = np.zeros((count, 180))
    for k, (remembered, got) in enumerate(zip(recalled, satisfying, strict=False), 1):
        on, off = BEGINS + SEARCH * (k - 1) + 500.0, BEGINS + SEARCH * k
        active = (times >= on) & (times < off)
        v[f"item {k}.node.activation"][active] = 5.0
        v["hue of action.output"][active] = hue_of(remembered)
        v[narrative.MEANINGS][active, round(hue_of(remembered))] = 1.0
        v["strongest peak.output"][(times >= off - 600.0) & (times < off)] = 1.0
        satisfied = (times >= off - COARSE) & (times < off + 60.0)
        v["strongest satisfaction.output"][satisfied] = 1.0
        v["hue of satisfaction.output"][satisfied] = hue_of(got)
    rest = times >= BEGINS + SEARCH * len(satisfying) + 100.0
    v[f"item {len(satisfying) + 1}.node.activation"][rest] = 5.0
    for remembered in recalled[len(satisfying) :][:1]:
        v["hue of action.output"][rest] = hue_of(remembered)
    return narrative.read(TaughtRun(taught, lesson, end, arena), Trial(times, v, {}, "over"), BEGINS)


def test_claims_and_times_follow_from_the_trial() -> None:
    run = made("RGB", "RGB", "RGB")
    assert (run.recalled, run.produced) == ("RGB", "RGB")
    assert run.found == pytest.approx([BEGINS + SEARCH * k - COARSE for k in (1, 2, 3)])
    assert run.seen == pytest.approx([BEGINS + SEARCH * k - 600.0 for k in (1, 2, 3)])
    assert [c.holds for c in narrative.claims(run)] == [True, True, True, None]
    assert narrative.sentence(run) == "Taught RGB; found R after 2.0 s, G after 4.0 s, B after 6.0 s."
    assert sequence_figure(run).axes[1].get_title(loc="left") == "action field"


@pytest.mark.parametrize(
    ("recalled", "satisfying", "false"),
    [("RYB", "RGB", 0), ("RGB", "RBG", 1), ("RGB", "RG", 1), ("RG", "", 1)],
)
def test_another_order_or_an_unfinished_sequence_fails_a_required_claim(
    recalled: str, satisfying: str, false: int
) -> None:
    run = made("RGB", recalled, satisfying)
    claim = narrative.claims(run)[false]
    assert claim.kind == "required" and claim.holds is False
    if len(satisfying) < 3:
        assert f"{3 - len(satisfying)} not found in" in narrative.sentence(run)


@pytest.mark.parametrize(
    ("recalled", "satisfying", "blocks", "why"),
    [
        ("RGB", "RG", "RGB", "1 not found in 7.0 s: still looking for B (item 3 of 3)."),
        ("R", "R", "RGB", "2 not found in 7.0 s: item 2 of 3 has learned no colour."),
        ("RGB", "RG", "RG", "still looking for B (item 3 of 3), of which the arena has no block."),
    ],
)
def test_a_run_that_ends_early_says_why(recalled: str, satisfying: str, blocks: str, why: str) -> None:
    assert narrative.sentence(made("RGB", recalled, satisfying, blocks)).endswith(why)


@pytest.mark.parametrize(
    ("sequence", "what", "fix"),
    [
        ("", "has 0 colours; expected 1 to 10", "--sequence RBGBY"),
        ("RGBYVRGBYVR", "has 11 colours; expected 1 to 10", "--sequence RBGBY"),
        ("RXB", "has the letter 'X'", "R, Y, G, B, V"),
    ],
)
def test_a_wrong_sequence_is_refused_before_the_run(
    sequence: str, what: str, fix: str, tmp_path: Path
) -> None:
    command = typed(f"demo serial-order --sequence '{sequence}' --out", out := tmp_path / "out")
    assert command.status == 1 and not out.exists()
    assert "--sequence: " in command.err and what in command.err and fix in command.err


@pytest.fixture(scope="module")
def demonstration(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, str]:
    """Return the folder of a demonstration with two colours, and what the command printed."""
    command = typed("demo serial-order --sequence gr --out", out := tmp_path_factory.mktemp("demo") / "order")
    assert command.status == 0, command.err
    return out, command.out


def test_the_command_teaches_and_produces_a_sequence(demonstration: tuple[Path, str]) -> None:
    out, printed = demonstration
    assert "Taught GR; found G after" in printed.splitlines()[-1]
    report = json.loads((out / "results.json").read_text())
    assert report["settings"]["sequence"] == "GR"
    assert [c["value"] for c in report["claims"][:2]] == ["GR", "GR"]
    with Image.open(out / "serial-order.png") as picture:
        assert min(picture.size) > 1000 and len(set(picture.convert("L").tobytes())) > 100
    with Image.open(out / "serial-order.gif") as film:
        assert film.size == (672, 460) and 100 < film.n_frames <= 200
    record = xarray.open_zarr(out / "serial-order.zarr")
    assert record["action.activation"].dims == ("time", "hue")
    assert record["pose.output"].sizes["x_y_heading"] == 3
    learning = record["item_1.node.activation"].values[record["time"].values < 1500.0]
    assert learning.max() > 0


def test_the_record_of_the_command_can_be_plotted(demonstration: tuple[Path, str], tmp_path: Path) -> None:
    for path in ("item 1.node.activation", "action.activation", "pose.output"):
        picture = tmp_path / f"{path}.png"
        assert typed("plot", demonstration[0] / "serial-order.zarr", f"'{path}' --out", picture).status == 0
        with Image.open(picture) as drawn:
            assert min(drawn.size) > 300 and len(set(drawn.convert("L").tobytes())) > 20


def test_the_learned_weights_are_those_in_production() -> None:
    run = made("RGB", "RGB", "RG")
    assert run.weights.shape == (4, 180)
    assert [int(row.argmax()) for row in run.weights[:2]] == [0, 60]
    assert not run.weights[3].any()
