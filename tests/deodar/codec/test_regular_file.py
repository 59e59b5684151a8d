"""Files are opened by their names only if they are regular files, and no module opens them in another way."""

from __future__ import annotations

import os
import re
from pathlib import Path

import pytest

from deodar import regular_file

SRC = Path(regular_file.__file__).parents[1]

OPENS = re.compile(r"\.read_bytes\(\)|\.read_text\(|open\([^()]*\"rb\"|\.open\(\"rb\"\)")
"""Calls that open a file for reading."""

OWN = {
    "deodar/worlds/arena/arena_layout.py": "the layouts of deodar itself, resources of the package",
    "deodar_papers/saliency/scenes.py": "the same",
    "deodar_papers/spa/pairs.py": "the same",
    "deodar_studio/access/token.py": "opened by its descriptor, with its owner",
    "deodar_studio/files/open_folder.py": "opened in its folder, by its descriptor",
}
"""Modules that open files for reading, and why they may."""


def test_content_is_read_and_other_files_are_errors_at_once(tmp_path: Path) -> None:
    (tmp_path / "text").write_bytes(b"one\r\ntwo\n")
    assert regular_file.read_text(tmp_path / "text") == "one\ntwo\n"
    assert regular_file.read_bytes(tmp_path / "text") == b"one\r\ntwo\n"
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


def test_no_module_opens_files_in_another_way() -> None:
    places = {
        path.relative_to(SRC).as_posix()
        for package in SRC.glob("deodar*")
        for path in package.rglob("*.py")
        if path.name != "regular_file.py"
        and OPENS.search(path.read_text(encoding="utf-8").replace("regular_file.read_text(", ""))
    }
    assert places == OWN.keys()
