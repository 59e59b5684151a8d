"""The key of the hosts is made once, or is the file that a variable names; another text is an error."""

from __future__ import annotations

from pathlib import Path

import pytest

from deodar.compiler.host_key import HOSTS_KEY, hosts_key
from deodar.errors import HostsError
from deodar.user_key import UserKey


@pytest.fixture(autouse=True)
def states(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.delenv(HOSTS_KEY, raising=False)
    monkeypatch.setenv("DEODAR_STATE", str(tmp_path / "state"))
    return tmp_path / "state"


def test_the_key_is_made_once_in_the_folder_of_states(states: Path) -> None:
    assert hosts_key() == hosts_key()
    assert hosts_key().path == states / "hosts" / "key"


def test_a_variable_names_another_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, states: Path) -> None:
    copy = UserKey.at(tmp_path / "copy")
    monkeypatch.setenv(HOSTS_KEY, str(copy.path))
    assert hosts_key() == copy
    assert not states.exists()


def test_a_file_that_a_variable_names_must_exist(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(HOSTS_KEY, str(tmp_path / "missing"))
    with pytest.raises(HostsError, match=r"missing: cannot be used as the key .* Copy the key of another"):
        hosts_key()
    assert not (tmp_path / "missing").exists()


def test_a_key_that_others_can_read_is_an_error_with_what_to_do() -> None:
    hosts_key().path.chmod(0o644)
    with pytest.raises(HostsError, match=r"others can access it, or own it\. Remove it; the next run"):
        hosts_key()
