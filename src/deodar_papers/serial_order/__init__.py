"""Sandamirskaya & Schöner (2010): sequences of colours are taught by showing them, and produced by searching
an arena.

Learning with demonstrations of 1 to 30 s; production in random arenas; blocks that are taken away,
duplicates, repeated colours, a vehicle that is carried elsewhere; every parameter of table B.1 varied alone
on a ring of blocks, where nothing has to be searched.

Reference:
    Sandamirskaya & Schöner (2010), An embodied account of serial order: how instabilities drive sequence
    generation, Neural Networks 23(10), 1164-1179, sections 4 to 6.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from deodar.codec import JsonObject
from deodar_papers import papers

if TYPE_CHECKING:
    from deodar.experiments.jobs import Job
    from deodar.experiments.rows import Row
    from deodar_papers._report import Report

HELP = "Sandamirskaya & Schöner (2010): a robot learns a sequence of colours and looks for them in an arena"

BY_CONDITION = ("runs",)
"""Entries of `about` that map names of conditions to their settings."""

PICTURES = {"serial-order-parameters": "table-B1-varied"}
"""Pictures of the manual, each with its figure."""

__getattr__ = papers.files(__name__)


def about(quick: bool) -> JsonObject:
    """Return the settings of the design; rows with other settings are not mixed with these."""
    # start-up time: these bring JAX
    from deodar_papers.serial_order import conditions

    return {"paper": "serial-order", "quick": quick, **conditions.design(quick)}


def jobs(quick: bool) -> Sequence[Job]:
    """Return all batches of runs."""
    # start-up time: these bring JAX
    from deodar_papers.serial_order import trials

    return trials.jobs(quick)


def kept(row: Row) -> Row:
    """Return the row as the repository stores it: unchanged."""
    return row


def report(rows: Mapping[str, Row], quick: bool) -> Report:
    """Return claims, figures, tables and numbers of the stored runs."""
    # start-up time: these bring JAX
    from deodar_papers._report import Report
    from deodar_papers.serial_order import robustness, tables, targets

    by_condition = targets.by_condition(rows, quick)
    claims = targets.claims(by_condition, quick)
    return Report(
        claims, robustness.draw(by_condition), tables.write(by_condition), tables.numbers(by_condition)
    )
