"""The second act says what each cue did, also where it did not select its colour."""

from __future__ import annotations

import numpy as np
import pytest

from deodar_papers.story import photograph
from deodar_papers.story.photograph import CueCourse, label, sentences, summary, verdict
from tests.deodar_papers.story.traces import course

SAUCER = course("red", "the saucer", (22.0, 49.0), right=True)
NOTHING = course("blue", "", right=True)


@pytest.mark.parametrize(
    ("cue", "below", "says", "line"),
    [
        (
            SAUCER,
            "peak on the saucer",
            "One peak rises, on the saucer.",
            "one peak, on the saucer; the motor variable turns to it",
        ),
        (
            NOTHING,
            "no peak",
            "Nothing here is blue: no peak, and the arrow stays.",
            "not in the picture: no peak, the motor variable stays",
        ),
        (
            course("red", "the saucer", (22.0, 49.0), right=False),
            "peak elsewhere",
            "One peak rises, this time not on the saucer.",
            "one peak, not on the saucer; the motor variable turns to it",
        ),
        (
            course("red", "the saucer", (22.0, 49.0), (60.0, 20.0), right=True, arrives=False),
            "2 peaks",
            "2 peaks rise this time.",
            "2 peaks; the motor variable does not reach it",
        ),
        (
            course("red", "the saucer", right=True),
            "no peak",
            "No peak rises this time.",
            "no peak, the motor variable stays",
        ),
        (
            course("blue", "", (22.0, 49.0), right=True),
            "peak elsewhere",
            "One peak rises, though nothing here is blue.",
            "not in the picture, but one peak; the motor variable turns to it",
        ),
        (
            course("blue", "", right=True, arrives=False),
            "no peak",
            "Nothing here is blue: no peak.",
            "not in the picture: no peak, the motor variable moves",
        ),
    ],
)
def test_every_outcome_of_a_cue_has_its_words(cue: CueCourse, below: str, says: str, line: str) -> None:
    spoken = sentences(cue)
    assert label(cue) == below and spoken[1][1] == says and verdict(cue) == line
    turns = any(text == "The motor variable turns to it." for _, text in spoken)
    assert turns == line.endswith("turns to it")


def test_the_summary_claims_a_selection_only_if_every_cue_is_right() -> None:
    assert summary([SAUCER, NOTHING]) == "A peak for a colour that is there, none for one that is not."
    wrong = course("red", "the saucer", right=True)
    assert summary([wrong, NOTHING]) == "One photograph, three cues: this time not all select their colour."


def test_a_peak_appears_at_the_first_sample_from_which_on_it_stays() -> None:
    assert photograph._appears(np.array([False, True, False, True, True])) == 3
    assert photograph._appears(np.array([True, True])) == 0
