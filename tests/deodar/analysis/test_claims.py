"""Claims state the sources of their targets, and a target inferred from a run is not required."""

from __future__ import annotations

import json

import pytest

from deodar.analysis.claims import Claim, failed, results
from deodar.errors import AnalysisError


def test_results_contain_every_entry_of_a_claim():
    claim = Claim(
        "a",
        0.5,
        ">= 0.4",
        True,
        "reported",
        "a paper",
        20,
        (0.4, 0.6),
        origin="printed",
        assumes="the start",
        inferred=True,
    )
    answer = json.loads(results([claim], {"quick": False}))
    assert answer["claims"] == [
        {
            "name": "a",
            "value": 0.5,
            "target": ">= 0.4",
            "holds": True,
            "kind": "reported",
            "source": "a paper",
            "n": 20,
            "interval": [0.4, 0.6],
            "origin": "printed",
            "assumes": "the start",
            "inferred": True,
        }
    ]


def test_a_claim_without_an_origin_is_refused():
    with pytest.raises(TypeError, match="origin"):
        Claim("a", 1, 1, True)  # pyright: ignore[reportCallIssue]


@pytest.mark.parametrize(
    ("marks", "words"),
    [
        (
            {"kind": "required", "origin": "printed", "assumes": "the start", "inferred": True},
            "cannot be required",
        ),
        ({"kind": "reported", "origin": "printed", "inferred": True}, "does not say which"),
        ({"kind": "reported", "origin": "none"}, "neither holds nor fails"),
    ],
)
def test_marks_that_contradict_each_other_are_refused(marks, words):
    with pytest.raises(AnalysisError, match=words):
        Claim("a", 1, 1, True, **marks)


def test_only_a_required_claim_that_is_false_fails():
    cases = [(False, "required"), (None, "required"), (False, "reported")]
    claims = [Claim(str(k), 0, 1, holds, kind, origin="ours") for k, (holds, kind) in enumerate(cases)]
    assert [c.name for c in failed(claims)] == ["0"]
