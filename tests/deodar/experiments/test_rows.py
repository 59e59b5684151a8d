"""Rows on the disk: complete rows of a truncated file are read."""

from __future__ import annotations

import pytest

from deodar.errors import OutputError, OutputExists, RecordError
from deodar.experiments.rows import Rows

ABOUT = {"experiment": "test", "runs": 3}
ROWS = [{"key": f"a/{k}", "outcome": "reached", "path": [[0.5, k]]} for k in range(3)]


def test_rows_are_found_again(tmp_path):
    file = tmp_path / "runs.jsonl"
    Rows(file, ABOUT).append(ROWS)
    assert list(Rows(file, ABOUT).found.values()) == ROWS
    assert len(file.read_text().splitlines()) == 4


@pytest.mark.parametrize("cut", range(1, 120, 7))
def test_a_file_truncated_at_any_byte_can_be_resumed(tmp_path, cut):
    file = tmp_path / "runs.jsonl"
    Rows(file, ABOUT).append(ROWS)
    whole = file.read_bytes()
    file.write_bytes(whole[:-cut])
    reopened = Rows(file, ABOUT)
    assert list(reopened.found.values()) == ROWS[: len(reopened.found)]
    reopened.append(ROWS)
    assert file.read_bytes() == whole


def test_a_file_truncated_in_its_first_line_is_started_again(tmp_path):
    file = tmp_path / "runs.jsonl"
    Rows(file, ABOUT).append(ROWS)
    whole = file.read_bytes()
    file.write_bytes(whole[:20])
    Rows(file, ABOUT).append(ROWS)
    assert file.read_bytes() == whole


def test_a_row_with_a_stored_key_is_not_added(tmp_path):
    rows = Rows(tmp_path / "runs.jsonl", ABOUT)
    rows.append(ROWS[:1])
    rows.append([ROWS[0] | {"outcome": "time"}])
    assert rows.found["a/0"]["outcome"] == "reached" and len(rows.path.read_text().splitlines()) == 2


def test_a_file_of_another_experiment_is_refused_and_unchanged(tmp_path):
    file = tmp_path / "runs.jsonl"
    Rows(file, ABOUT).append(ROWS)
    before = file.read_bytes()
    with pytest.raises(OutputExists, match="another experiment: runs, seed differ"):
        Rows(file, {"experiment": "test", "runs": 4, "seed": 1})
    assert file.read_bytes() == before


SMALL = {"paper": "test", "made_by": {"jax": "1"}, "runs": {"a": 3}, "carrots": {}}
BY = ("runs", "carrots", "planners")


def test_an_experiment_with_additional_conditions_resumes_the_file(tmp_path):
    file = tmp_path / "runs.jsonl"
    Rows(file, SMALL, BY).append(ROWS)
    larger = {**SMALL, "runs": {"b": 1, "a": 3}, "planners": {"b": {"reflection": 0.8}}}
    reopened = Rows(file, larger, BY)
    assert list(reopened.found.values()) == ROWS
    reopened.append([{"key": "b/0"}])
    assert list(Rows(file, larger, BY).found) == ["a/0", "a/1", "a/2", "b/0"]
    lines = file.read_text().splitlines()
    assert [k for k, line in enumerate(lines) if '"about"' in line] == [0, 4]


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"runs": {"a": 4}}, "runs of a differ"),
        ({"runs": {"b": 3}}, "runs of a differ"),
        ({"carrots": {"a": "fast"}}, "carrots of a differ"),
        ({"planners": {"a": None}}, "planners of a differ"),
        ({"runs": {"a": 3, "b": 1}, "made_by": {"jax": "2"}}, "made_by differ"),
        ({"runs": {"a": 3, "b": 1}, "limit": 4}, "limit differ"),
    ],
)
def test_a_condition_with_other_settings_or_another_version_is_refused(tmp_path, change, words):
    file = tmp_path / "runs.jsonl"
    Rows(file, SMALL, BY).append(ROWS)
    before = file.read_bytes()
    with pytest.raises(OutputExists, match=words):
        Rows(file, SMALL | change, BY)
    assert file.read_bytes() == before


def test_settings_without_conditions_must_be_equal(tmp_path):
    file = tmp_path / "runs.jsonl"
    Rows(file, SMALL).append(ROWS)
    with pytest.raises(OutputExists, match="runs differ"):
        Rows(file, SMALL | {"runs": {"a": 3, "b": 1}})


@pytest.mark.parametrize("cut", [1, 20, 60])
def test_a_truncated_extension_is_extended_again(tmp_path, cut):
    file = tmp_path / "runs.jsonl"
    Rows(file, SMALL, BY).append(ROWS)
    larger = SMALL | {"runs": {"a": 3, "b": 1}}
    Rows(file, larger, BY)
    whole = file.read_bytes()
    file.write_bytes(whole[:-cut])
    assert list(Rows(file, larger, BY).found.values()) == ROWS
    assert file.read_bytes() == whole


@pytest.mark.parametrize("text", ["hello", '{"key": 1}\n', "[1]\n", '{"about": {}}\nhello\n'])
def test_a_file_without_rows_is_refused_and_unchanged(tmp_path, text):
    file = tmp_path / "runs.jsonl"
    file.write_text(text)
    with pytest.raises(RecordError):
        Rows(file, {})
    assert file.read_text() == text


def test_a_missing_folder_is_named(tmp_path):
    with pytest.raises(OutputError, match=r"the folder .* does not exist"):
        Rows(tmp_path / "none" / "runs.jsonl", ABOUT)


def test_rows_are_on_the_disk_when_append_returns(tmp_path, monkeypatch):
    file, synced = tmp_path / "runs.jsonl", []
    rows = Rows(file, ABOUT)
    monkeypatch.setattr("os.fsync", lambda handle: synced.append(file.read_bytes()))
    for row in ROWS:
        rows.append([row])
        assert synced.pop() == file.read_bytes()
