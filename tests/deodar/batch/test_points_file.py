"""Files of the points of a sweep: what is refused."""

from __future__ import annotations

from pathlib import Path

import pytest

from deodar.batch import points_file
from deodar.errors import DocumentError


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("u.tau\n" + "1" * 200_000, "points.csv: is not a table in CSV"),
        ("u.tau\n" + "1\n" * points_file.MOST_NUMBERS, "points.csv: holds about 1,000,001 values; at most"),
        ("u.tau\nfast\n", "points.csv: point 0 is fast"),
    ],
)
def test_a_table_that_is_too_large_or_malformed_is_refused(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "points.csv"
    path.write_text(text)
    with pytest.raises(DocumentError, match=message):
        points_file.read(path)
