"""A key of the user is made once, is the same for all processes, and proves without travelling."""

from __future__ import annotations

import threading
from pathlib import Path

import pytest

from deodar.user_key import UserKey


def test_processes_that_come_at_once_get_one_key_that_only_the_user_reads(tmp_path: Path) -> None:
    path, keys = tmp_path / "state" / "key", list[UserKey]()
    threads = [threading.Thread(target=lambda: keys.append(UserKey.at(path))) for _ in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(keys) == 8 and len({key.password for key in keys}) == 1
    assert path.stat().st_mode & 0o777 == 0o600
    assert keys[0].password not in repr(keys[0])


def test_a_proof_is_of_one_challenge_and_of_one_key(tmp_path: Path) -> None:
    first, second = UserKey.at(tmp_path / "a"), UserKey.at(tmp_path / "b")
    assert first.proven(b"challenge", first.proof(b"challenge"))
    assert not first.proven(b"another", first.proof(b"challenge"))
    assert not first.proven(b"challenge", second.proof(b"challenge"))
    assert not first.proven(b"challenge", b"")


def test_a_key_that_is_stated_is_not_made(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError):
        UserKey.at(tmp_path / "key", new=False)


@pytest.mark.parametrize("text", ["", "deodar:short\n", f"other:{'x' * 32}\n"])
def test_a_file_that_is_no_key_is_refused(text: str, tmp_path: Path) -> None:
    path = tmp_path / "key"
    path.touch(0o600)
    path.write_text(text, encoding="ascii")
    with pytest.raises(ValueError, match="it does not hold deodar: and a password"):
        UserKey.at(path)


def test_a_key_that_others_can_read_is_refused(tmp_path: Path) -> None:
    UserKey.at(tmp_path / "key")
    (tmp_path / "key").chmod(0o640)
    with pytest.raises(PermissionError, match="others can access it"):
        UserKey.at(tmp_path / "key")
