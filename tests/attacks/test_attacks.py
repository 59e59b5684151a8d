"""The attacks in a quick form; `python benchmarks/attacks.py` runs them at length."""

from __future__ import annotations

from pathlib import Path

from tests.attacks import documents, kills, messages, soak


def test_mutated_documents_are_read_or_refused_and_nothing_else() -> None:
    outcome = documents.attack(150, seed=2)
    assert outcome.errors == []
    assert outcome.read > 5 and outcome.refused > 50


def test_hostile_messages_are_answered_and_the_studio_goes_on(tmp_path: Path) -> None:
    outcome = messages.run(tmp_path, 200, seed=3)
    assert outcome.errors == []
    assert outcome.refused > 100 and outcome.connections > 1


def test_a_studio_that_is_killed_leaves_a_whole_file(tmp_path: Path) -> None:
    outcome = kills.attack(tmp_path, 1, seed=4)
    assert outcome.errors == [] and outcome.kills == 1


def test_pages_that_come_and_go_leave_no_threads_and_no_connections(tmp_path: Path) -> None:
    outcome = soak.attack(tmp_path, 3)
    assert outcome.visits > 3
    assert outcome.late.files <= outcome.early.files + 4 and outcome.late.threads <= outcome.early.threads + 8
