"""The labels of a map of regimes: one byte for each cell, and its words."""

from __future__ import annotations

from enum import IntEnum


class RegimeLabel(IntEnum):
    """What a field does with its input, as the label of a cell.

    Attributes:
        SILENT: the input makes no peak.
        DRIVEN: the input makes a peak, which vanishes with it; two equal inputs do not end in one.
        SUSTAINED: the peak outlives its input.
        SELECTIVE: two equal inputs end in one peak, at one of them.
        SUSTAINED_SELECTIVE: both.
        UNBOUNDED: the peak spreads over the field, or activation grows without limit.
        ACTIVE: a peak exists without input.
        RESTLESS: the field does not settle within the limit: it oscillates, or its peaks travel.
    """

    SILENT = 0
    DRIVEN = 1
    SUSTAINED = 2
    SELECTIVE = 3
    SUSTAINED_SELECTIVE = 4
    UNBOUNDED = 5
    ACTIVE = 6
    RESTLESS = 7


WORDS = (
    "silent",
    "input-driven",
    "self-sustained",
    "selective",
    "self-sustained and selective",
    "unbounded",
    "active at rest",
    "does not settle",
)
"""The words of each label."""
