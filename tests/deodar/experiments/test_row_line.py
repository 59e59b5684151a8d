"""Lines of rows: each carries the checksum of what precedes it; files of earlier versions have none."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from deodar.errors import DamagedFile, RecordError
from deodar.experiments import row_line
from deodar.experiments.rows import Rows

ABOUT = {"experiment": "test", "runs": 3}
ROW = {"key": "a/0", "place": 0.5, "word": "größe"}


def test_a_line_comes_back_and_is_json_for_other_programs() -> None:
    line = row_line.write(ROW, True)
    assert row_line.read(line, True) == ROW
    assert {**ROW, row_line.CHECKSUM: json.loads(line)[row_line.CHECKSUM]} == json.loads(line)
    assert row_line.read(row_line.write(ROW, False), False) == ROW
    with pytest.raises(ValueError, match="no checksum"):
        row_line.read(row_line.write(ROW, False), True)


@pytest.mark.parametrize("first", [True, False])
def test_each_flipped_bit_of_a_line_is_noticed(first: bool) -> None:
    line = row_line.write({"about": ABOUT} if first else ROW, True)
    for bit in range(8 * (len(line) - 1)):
        flipped = bytearray(line)
        flipped[bit // 8] ^= 1 << (bit % 8)
        with pytest.raises(ValueError):
            if first:
                row_line.read_first(bytes(flipped), "about", Path("rows"))
            else:
                row_line.read(bytes(flipped), True)


def test_a_damaged_row_is_named_and_runs_again_without_its_line(tmp_path: Path) -> None:
    file = tmp_path / "runs.jsonl"
    Rows(file, ABOUT).append([ROW, ROW | {"key": "a/1"}])
    whole = file.read_bytes()
    file.write_bytes(whole.replace(b"0.5", b"0.7", 1))
    with pytest.raises(DamagedFile, match=r"line 2 is not a row: its checksum"):
        Rows(file, ABOUT)
    file.write_bytes(b"".join(line for k, line in enumerate(whole.splitlines(True)) if k != 1))
    assert list(Rows(file, ABOUT).found) == ["a/1"]


def test_a_file_without_checksums_is_continued_without(tmp_path: Path) -> None:
    file = tmp_path / "runs.jsonl"
    file.write_bytes(row_line.write({"about": ABOUT}, False) + row_line.write(ROW, False))
    rows = Rows(file, ABOUT)
    assert dict(rows.found) == {"a/0": ROW}
    rows.append([ROW | {"key": "a/1"}])
    assert b"crc32c" not in file.read_bytes() and len(Rows(file, ABOUT).found) == 2


def test_a_first_line_with_another_entry_is_no_file_of_rows(tmp_path: Path) -> None:
    file = tmp_path / "runs.jsonl"
    file.write_text(json.dumps({"about": ABOUT, "crc32b": "00000000"}) + "\n")
    with pytest.raises(RecordError, match="holds no rows"):
        Rows(file, ABOUT)
