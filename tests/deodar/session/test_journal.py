"""The journal of a session: calls that are repeated, and their words in records."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest

import deodar as dd
from deodar.errors import RecordError
from deodar.session.journal import Change, from_file, repeat_changes, to_file, until
from tests.deodar.recording.models import model

WORDS: list[tuple[tuple[Any, ...], str, Any]] = [
    (("set", "u.tau", 20.0), "u.tau", 20.0),
    (("inject", "u", 2.0, 3), "push u", [2.0, 3]),
    (("move", "red block", [1.0, 2.0]), "world.move red block", [1.0, 2.0]),
    (("place", "block", [1.0, 2.0], [0.1, 0.1]), "world.place block", [[1.0, 2.0], [0.1, 0.1]]),
    (("remove", "block"), "world.remove block", None),
    (("push_body", "cart", [1.0, 0.0, 0.0]), "world.push cart", [1.0, 0.0, 0.0]),
    (("narrow_motor", "left", [-1.0, 1.0], None), "world.narrow left", [[-1.0, 1.0], None]),
]


@pytest.mark.parametrize(("call", "subject", "value"), WORDS)
def test_a_change_has_the_same_words_in_a_record_and_is_read_again(
    call: tuple[Any, ...], subject: str, value: Any
) -> None:
    change = Change(7, call[0], call[1:])
    written = json.loads(json.dumps(to_file(change)))
    assert written == {"tick": 7, "what": subject, "value": value}
    assert from_file(written) == change


@pytest.mark.parametrize("subject", ["document", "dt", "world", "reset", "restore"])
def test_a_change_that_a_record_does_not_describe_is_refused(subject: str) -> None:
    with pytest.raises(RecordError, match=f"the change of '{subject}' at step 3 cannot be repeated"):
        from_file({"tick": 3, "what": subject, "value": None})


def test_an_injected_input_lasts_until_the_tick_to_which_changes_are_cut() -> None:
    changes = [Change(2, "set", ("u.tau", 20.0)), Change(4, "inject", ("u", 1.0, 5))]
    assert until(changes, 4) == changes[:1]
    assert until(changes, 6) == [changes[0], Change(4, "inject", ("u", 1.0, 2))]
    assert until(changes, 20) == changes


def test_the_calls_of_a_journal_repeat_a_session() -> None:
    first, repeated = dd.Session(model(), seed=2), dd.Session(model(), seed=2)
    first.step(3)
    first.set({"u.tau": 20.0, "u.kernel": [dd.Gaussian(2, 3)]})
    first.inject("u", np.linspace(0, 1, 11), 4)
    first.dt = 0.5
    first.step(5)
    first.edit(model().document)
    first.step(2)
    repeat_changes(repeated, first.journal, first.tick, lambda done, steps: None)
    assert repeated.time == first.time and repeated.dt == 0.5
    assert repeated.read("u").tobytes() == first.read("u").tobytes()
    assert [(c.tick, c.method) for c in repeated.journal] == [(c.tick, c.method) for c in first.journal]
