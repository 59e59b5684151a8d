"""The first act says what happened in its run, also where noise decided otherwise."""

from __future__ import annotations

import dataclasses as dc
import functools
from types import SimpleNamespace
from typing import Any, cast

import pytest

from deodar.analysis.thresholds import Transition
from deodar_papers.story import demo, one_field
from deodar_papers.story.field_moments import (
    FieldThresholds,
    claims,
    events,
    moments,
    sentences,
    summary,
    verdicts,
)
from tests.deodar_papers.story.traces import AGAIN, FALLS, GO, GONE, THRESHOLDS, field_run

DETECTED = (50, 20, 39)
USUAL = field_run(DETECTED, (28, 48, 51), (72, 47, 90))


def test_moments_are_read_from_the_run() -> None:
    m = moments(USUAL)
    assert dc.astuple(m) == (10, 20, AGAIN, 47, 51, GO, GONE, GONE, FALLS, 90)


def test_the_sentences_of_a_usual_run_grow_when_what_they_announce_has_happened() -> None:
    spoken = dict(sentences(moments(USUAL), THRESHOLDS))
    assert spoken[20] == "Past 4.1 a peak rises by itself: detection."
    assert (spoken[47], spoken[51]) == ("They compete", "They compete, and one wins: selection.")
    assert (spoken[GO], spoken[GONE]) == ("The inputs go.", "The inputs go. The peak stays: memory.")
    assert spoken[FALLS] == "The field is lowered"
    assert spoken[90] == "The field is lowered, and the peak is gone: forgetting."
    assert summary(moments(USUAL)) == "One field: it detects, selects, remembers and forgets."
    assert [(e.name, e.sample) for e in events(moments(USUAL), THRESHOLDS)] == [
        ("Detection", 20),
        ("Selection", 51),
        ("Memory", GONE),
        ("Forgetting", 90),
    ]


@pytest.mark.parametrize(
    ("peaks", "at", "says", "in_all"),
    [
        (
            [DETECTED, (28, 47, 75), (72, 47, 90)],
            GO,
            "They compete, and two peaks remain this time.",
            "One field: it detects, remembers and forgets.",
        ),
        (
            [DETECTED, (28, 47, 75), (72, 47, 90)],
            GONE,
            "The inputs go. A peak stays: memory.",
            "One field: it detects, remembers and forgets.",
        ),
        ([DETECTED], GO, "They go, and no peak has risen this time.", "One field: it detects."),
        (
            [DETECTED, (28, 47, 66)],
            GONE,
            "The inputs go, and no peak outlives them this time.",
            "One field: it detects and selects.",
        ),
        (
            [DETECTED, (28, 47, 100)],
            FALLS,
            "The field is lowered",
            "One field: it detects, selects and remembers.",
        ),
        ([], 10, "An input grows. The field only follows it.", "One field, and no peak this time."),
    ],
)
def test_another_outcome_has_a_sentence_of_its_own(
    peaks: list[tuple[int, int, int]], at: int, says: str, in_all: str
) -> None:
    m = moments(field_run(*peaks))
    spoken = sentences(m, THRESHOLDS)
    assert (at, says) in spoken and summary(m) == in_all
    assert [k for k, _ in spoken] == sorted(k for k, _ in spoken)


@pytest.mark.parametrize(
    ("peaks", "names", "texts"),
    [
        ([DETECTED, (28, 47, 75), (72, 47, 90)], ["No selection"], ["two peaks remain"]),
        (
            [],
            ["No detection", "No selection", "No memory", "No forgetting"],
            ["no peak this time", "no peak", "goes with its input", "no peak"],
        ),
        ([DETECTED, (28, 47, 100)], ["No forgetting"], ["the peak stays"]),
    ],
)
def test_the_lines_of_the_video_name_what_did_not_happen(
    peaks: list[tuple[int, int, int]], names: list[str], texts: list[str]
) -> None:
    m = moments(field_run(*peaks))
    missing = [e for e in events(m, THRESHOLDS) if e.name.startswith("No ")]
    assert [e.name for e in missing] == names and [e.text for e in missing] == texts
    happened = {c.name.split()[2].rstrip(":"): c.holds for c in claims(m, THRESHOLDS)}
    assert [f"No {name}" for name, holds in happened.items() if not holds] == names


@pytest.mark.parametrize(
    ("peaks", "line", "says"),
    [
        ([], 0, "a peak rises when the input exceeds 4.09 ± 0.01; not in this run"),
        ([], 1, "of two equal inputs none makes a peak in this run"),
        ([DETECTED, (28, 47, 75), (72, 47, 90)], 1, "of two equal inputs both keep a peak in this run"),
        ([], 2, "no peak outlives its input in this run"),
        (
            [DETECTED, (28, 47, 100)],
            3,
            "it is gone when the field is lowered by 0.826 ± 0.003; not in this run",
        ),
    ],
)
def test_the_lines_of_the_terminal_say_what_the_run_did_not_show(
    peaks: list[tuple[int, int, int]], line: int, says: str
) -> None:
    assert verdicts(moments(field_run(*peaks)), THRESHOLDS)[line][1] == says


def test_thresholds_are_those_that_regimes_measures() -> None:
    transition = functools.partial(Transition, before=0.0, after=0.0, jump=True, state=cast("Any", None))
    regimes = SimpleNamespace(
        transitions={
            "detection": transition(value=4.0, interval=(3.5, 4.5)),
            "forgetting": transition(value=-0.75, interval=(-0.5, -1.0)),
        }
    )
    measured = FieldThresholds.of(cast("Any", regimes))
    assert measured == FieldThresholds((4.0, 0.5), (-0.75, 0.25))
    assert (measured.needed, measured.lowering) == ("4.0", "0.8")


def test_in_a_run_the_moments_lie_beyond_the_measured_thresholds_and_in_order() -> None:
    run = one_field.run(demo.SEED)
    m = moments(run)
    assert m.detected is not None and m.selected is not None and m.forgotten is not None
    assert run.input[m.grows].max() < THRESHOLDS.detection[0] < run.input[m.detected].max()
    assert run.lowered[m.forgotten] < THRESHOLDS.forgetting[0] < run.lowered[m.falls]
    assert m.detected < m.second < m.selected < m.go < m.gone == m.remembered < m.falls < m.forgotten
    assert run.input[m.gone].max() == 0 < run.activation[m.gone].max()


def test_noise_alone_decides_between_the_two_inputs_that_compete() -> None:
    model = one_field.selection()
    left, right = (model[name].element for name in ("left", "right"))
    assert dc.replace(left, name="", center=0.0) == dc.replace(right, name="", center=0.0)
    axis = one_field.AXIS
    assert left.center - axis.lower == axis.upper - right.center, "equally far from the ends"  # type: ignore[attr-defined]
