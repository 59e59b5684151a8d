"""Widths of the columns of journals, in millimetres."""

from __future__ import annotations

from deodar.errors import did_you_mean

COLUMNS = {
    "nature": {"single": 89.0, "double": 183.0},
    "elsevier": {"single": 90.0, "double": 190.0},
    "ieee": {"single": 88.9, "double": 182.0},
}
"""Widths by journal or publisher, and column.

Sources, read in November 2026: Nature Research, figure guide, "Building and exporting figure panels" (89 and
183 mm); Elsevier, guide for authors, "Electronic artwork" (1063 and 2244 pixels at 300 dots per inch);
IEEE Author Center, "Resolution and size" (3.5 and 7.16 inches, there rounded to 182 mm).
"""

DEFAULT = "nature"
SMALLEST, LARGEST = 10.0, 1000.0
"""Range of a width or height, in millimetres."""

INCH = 25.4
"""Millimetres of an inch."""


def width(column: str, journal: str | None = None) -> float:
    """Return the width of a column in millimetres.

    Raises:
        ValueError: no such journal or column; the message names the known ones.
    """
    name = journal or DEFAULT
    if name not in COLUMNS:
        raise ValueError(f"there is no journal {name!r}. {did_you_mean(name, COLUMNS)}")
    if column not in COLUMNS[name]:
        raise ValueError(f"there is no column {column!r}. {did_you_mean(column, COLUMNS[name])}")
    return COLUMNS[name][column]
