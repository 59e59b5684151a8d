"""Figures 3, 8 and 12: what they show follows from their runs."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from deodar_papers.figures.ordinal_dynamics import OrdinalMoment, OrdinalTransition
from deodar_papers.figures.perception import ColourPerception
from deodar_papers.serial_order import figures
from tests.command_line import typed
from tests.deodar_papers.serial_order.test_demo import made


def transition() -> OrdinalTransition:
    """Return a transition without noise, with the inputs of table B.1."""
    silent = np.zeros(4)
    nodes = (np.asarray([0.0, 1.0, 0.0, 0.0]), silent, silent)
    memories = np.asarray([0.0, 1.0, 0.0, 0.0])
    moments = [
        OrdinalMoment(title, time, figures.inputs(d, memories, satisfied))
        for title, time, d, satisfied in zip("abc", (0.0, 50.0, 100.0), nodes, (0.0, 3.0, 0.0), strict=True)
    ]
    times = np.arange(-50.0, 150.0, 4.0)
    return OrdinalTransition(
        times, np.outer(times, np.ones(4)) / 20.0, 2, 20.0, 80.0, moments, -0.5, 7.2, 100.0
    )


@pytest.fixture(scope="module")
def seen() -> ColourPerception:
    """Return what the model sees after it was taught green, with three blocks in view."""
    return figures.perception()


def test_the_stable_states_follow_from_the_equation() -> None:
    run = transition()
    # h_d, h_d + c0 without input; the next node: h_d + c0 + c2 alone
    assert run.attractors(0.0) == pytest.approx([-0.5, 6.7], abs=0.01)
    assert run.attractors(run.moments[2].inputs[2]) == pytest.approx([7.6], abs=0.01)
    assert run.attractors(run.moments[0].inputs[1]) == pytest.approx([-1.3, 5.9], abs=0.01)
    assert [len(run.attractors(run.moments[1].inputs[k])) for k in range(4)] == [1, 1, 1, 1]


def test_the_wanted_block_alone_makes_a_peak(seen: ColourPerception) -> None:
    assert seen.picture.shape == (160, 120, 3)
    hues = np.flatnonzero(seen.shares.max(axis=0) > 0.3) * 2
    assert {0, 60, 120} <= set(hues.tolist())
    above = np.flatnonzero((seen.activation > 0).any(axis=0)) * 2
    assert len(above) and np.abs(above - 60).max() <= 9


def test_the_command_draws_the_figures(
    seen: ColourPerception, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    done = figures.PaperFigures(transition(), seen, [made(s, s, s) for s in figures.DEMONSTRATIONS])
    assert [c.holds for c in figures.claims(done)] == [True] * 5
    dark = replace(seen, activation=seen.activation - 10.0)
    wrong = replace(done, perception=dark, demonstrations=[made("RGBY", "RGBY", "RBGY")])
    assert [c.holds for c in figures.claims(wrong)] == [True, False, False]
    monkeypatch.setattr(figures, "run", lambda *_: done)
    out = tmp_path / "out"
    assert typed("demo serial-order --figures --out", out).status == 0
    for name in ("figure-3", "figure-8", "figure-12"):
        with Image.open(out / f"{name}.png") as picture:
            assert min(picture.size) > 1000 and len(set(picture.convert("L").tobytes())) > 50


def test_a_repeated_colour_is_dashed_and_every_node_has_its_number() -> None:
    [nodes, *_] = figures.demonstrations_figure([made("RGGY", "RGGY", "RGGY")], ["RGGY"]).axes
    assert [line.get_linestyle() for line in nodes.lines[:5]] == ["-", "-", "--", "-", "-"]
    assert {"1", "2", "3", "4", "5", "teaching", "production"} == {text.get_text() for text in nodes.texts}


def test_hues_are_in_degrees_and_a_line_surrounds_the_peak(seen: ColourPerception) -> None:
    field = figures.perception_figure(seen).axes[0]
    assert field.get_ylabel() == "hue (degrees)" and field.get_ylim() == (0.0, 360.0)
    lines: list[Any] = [c for c in field.collections if hasattr(c, "levels")]
    heights = np.concatenate([path.vertices[:, 1] for path in lines[0].get_paths() if len(path.vertices)])
    assert np.abs(heights - 120.0).max() <= 18.0


def test_letters_of_moments_are_inside_their_panel() -> None:
    course = figures.transition_figure(transition()).axes[3]
    letters: list[Any] = [text for text in course.texts if text.get_text() in ("a", "b", "c")]
    assert len(letters) == 3 and all(text.get_va() == "top" and text.xyann[1] < 0 for text in letters)


def test_figures_and_a_sequence_are_not_asked_for_together() -> None:
    command = typed("demo serial-order --figures --sequence RG")
    assert command.status == 2 and "not allowed with" in command.err
