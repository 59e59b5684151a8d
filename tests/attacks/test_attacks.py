"""Short forms of the attacks; `python benchmarks/attacks.py` runs them in full."""

from __future__ import annotations

import dataclasses as dc
import os
import signal
from pathlib import Path

import pytest

from deodar.model import edit
from tests.attacks import bits, documents, formats, kills, messages, records, soak, undo


def test_mutated_documents_are_read_or_refused_without_other_errors() -> None:
    outcome = documents.attack(150, seed=2)
    assert outcome.errors == []
    assert outcome.read > 5 and outcome.refused > 50


def test_random_edits_are_undone_and_redone_to_the_same_bytes() -> None:
    outcome = undo.attack(2, seed=1)
    assert outcome.errors == []
    assert len(undo.KINDS) >= 30 and all(outcome.least(kind) >= 2 for kind in undo.KINDS)


def test_hostile_messages_are_answered_and_the_studio_continues(tmp_path: Path) -> None:
    outcome = messages.run(tmp_path, 200, seed=3)
    assert outcome.errors == []
    assert outcome.refused > 100 and outcome.connections > 1


def test_a_killed_studio_leaves_a_complete_file(tmp_path: Path) -> None:
    outcome = kills.attack(tmp_path, 1, seed=4)
    assert outcome.errors == [] and outcome.kills == 1


def test_a_killed_run_leaves_its_record_and_is_resumed_to_the_same_end(tmp_path: Path) -> None:
    # other tests use the cores meanwhile, so that a run may lose more than on a machine of its own
    cases = ("plane", "workers")  # one process, and several; `test_every_moment` kills at every write
    resumed = ("plane", "pieces")
    outcome = records.attack(tmp_path, 2, 4, cases, resumed, longest=4.0, limit=3.0)
    assert outcome.errors == [] and outcome.kills == 2 and outcome.resumed == 2
    assert outcome.samples > 100


def test_flipped_bits_of_stored_files_give_no_wrong_values(tmp_path: Path) -> None:
    outcome = bits.attack(tmp_path, 300, seed=5)
    assert outcome.errors == []
    assert min(outcome.by_kind.values()) == 30 and outcome.refused > 150


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no named pipes on this system")
def test_no_reader_waits_for_a_named_pipe_in_place_of_a_file(tmp_path: Path) -> None:
    outcome = bits.pipes(tmp_path)
    assert outcome.errors == []
    assert outcome.by_kind.keys() == bits.KINDS.keys() and outcome.refused > 20


def test_mutated_files_of_all_formats_are_read_or_refused(tmp_path: Path) -> None:
    part = formats.Part(tmp_path / "rows.jsonl")
    outcome = formats.attack(tmp_path / "first", 500, seed=6, part=part)
    assert outcome.errors == []
    assert outcome.by_format.keys() == formats.formats().keys() and outcome.count() == 500
    assert outcome.count("read") > 100 and outcome.count("refused") > 100
    assert formats.attack(tmp_path / "second", 500, seed=6, part=part) == outcome, "nothing is left to read"


def test_the_same_number_gives_the_same_mutation(tmp_path: Path) -> None:
    seeds = {kind: file_format.seeds() for kind, file_format in formats.formats().items()}
    for number in range(2 * len(seeds)):
        places = [tmp_path / name / str(number) for name in ("first", "second")]
        opened = [formats.write(seeds, place, 7, number) for place in places]
        contents = [
            {path.relative_to(place): path.read_bytes() for path in place.rglob("*") if path.is_file()}
            for place in places
        ]
        assert contents[0] == contents[1] and contents[0] and opened[0][:2] == opened[1][:2]


def test_readers_that_misbehave_are_detected(tmp_path: Path) -> None:
    reading = formats.Reading("tests.attacks.misbehaving", longest=5.0)
    outcome = formats.attack(tmp_path, 12, reading=reading)
    became = {kind: next(iter(summary.states)) for kind, summary in outcome.by_format.items()}
    assert became.pop("crash") == f"crash ({-signal.SIGABRT})"
    assert became.pop("without a message") == became.pop("more memory") == "foreign"
    assert became.pop("program") == became.pop("import") == "run"
    assert became.pop("slow") in ("slow", "hang")
    assert became == {kind: kind for kind in ("read", "refused", "foreign", "hang", "memory", "run")}
    assert len(outcome.errors) == 10 and outcome.errors[0].startswith(
        "--only 2: foreign, node.json: foreign: KeyError"
    )


def test_closed_pages_leave_no_data_in_the_studio(tmp_path: Path) -> None:
    outcome = soak.attack(tmp_path, 1)
    assert outcome.visits >= 10 and outcome.errors == []


@pytest.mark.parametrize(
    ("more", "visits"),
    [
        ({"mebibytes": 60.0}, 100),
        ({"files": 1}, 1),
        ({"objects": 30_000}, 1000),
        ({"tasks": 1}, 1),
        ({"threads": 9}, 1),
        ({"sessions": 1}, 1),
    ],
)
def test_a_studio_that_stores_data_of_closed_pages_is_detected(more: dict[str, float], visits: int) -> None:
    early = soak.Held(500, 10, 300_000, 8, 20, 1, 0)
    (error,) = soak.beyond(
        early,
        dc.replace(early, **{name: getattr(early, name) + increase for name, increase in more.items()}),
        visits,
    )
    assert next(iter(more)) in error and f"after {visits} visits" in error
    assert soak.beyond(early, early, visits) == []


def test_an_undo_that_returns_another_document_is_detected(monkeypatch: pytest.MonkeyPatch) -> None:
    returned = edit.UndoHistory.undo

    def forgetful(history: edit.UndoHistory) -> bool:
        done = returned(history)
        history.document = edit.describe(history.document, notes="other notes")
        return done

    monkeypatch.setattr(edit.UndoHistory, "undo", forgetful)
    outcome = undo.attack(2, seed=1)
    assert any("has other bytes" in error for error in outcome.errors)
