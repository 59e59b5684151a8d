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


@pytest.mark.parametrize("is_stated", [False, True])
def test_a_key_that_others_can_access_is_an_error_with_the_command_that_ends_that(
    is_stated: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = hosts_key().path
    if is_stated:
        monkeypatch.setenv(HOSTS_KEY, str(path))
    for place, mode, command in ((path, 0o644, "chmod 600"), (path.parent, 0o775, "chmod go-w")):
        before = place.stat().st_mode
        place.chmod(mode)
        with pytest.raises(HostsError, match=rf"If it is the key of the hosts, type: {command} {place}\Z"):
            hosts_key()
        place.chmod(before)
    assert hosts_key().path == path


def test_a_folder_of_all_users_is_an_error_with_no_command(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """To take its rights away, as of /tmp, would harm other programs."""
    key = UserKey.at(tmp_path / "folder" / "key").path
    key.parent.chmod(0o1777)
    monkeypatch.setenv(HOSTS_KEY, str(key))
    with pytest.raises(HostsError, match=r"others can change its folder, .* Copy the key of another host"):
        hosts_key()


def test_a_file_of_another_text_may_be_removed() -> None:
    hosts_key().path.write_text("words", encoding="ascii")
    with pytest.raises(HostsError, match="Remove it; the next run makes another one"):
        hosts_key()
