"""Files are opened by their names only if they are regular files."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from deodar import regular_file


def test_content_is_read_and_other_files_are_errors_at_once(tmp_path: Path) -> None:
    (tmp_path / "text").write_bytes(b"one\r\ntwo\n")
    assert regular_file.read_text(tmp_path / "text") == "one\ntwo\n"
    assert regular_file.read_bytes(tmp_path / "text") == b"one\r\ntwo\n"
    with regular_file.open_binary(tmp_path / "text") as file:
        assert file.name == str(tmp_path / "text"), "messages and other readers name it by this"
    with pytest.raises(FileNotFoundError):
        regular_file.read_bytes(tmp_path / "none")
    with pytest.raises(IsADirectoryError):
        regular_file.read_bytes(tmp_path)
    with pytest.raises(OSError, match="not a regular file"):
        regular_file.read_bytes("/dev/null")


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no named pipes on this system")
def test_a_named_pipe_is_refused_at_once(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(OSError, match="not a regular file"):
        regular_file.open_binary(tmp_path / "pipe")
