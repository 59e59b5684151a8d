"""Copies of a batch that diverged: all their values are NaN, and a coordinate of the record gives the
reason.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import xarray

REASON = "diverged"
"""Name of the coordinate with the reason for each copy ("" for a copy that did not diverge), and of the
attribute that counts them.
"""


def marked(
    record: xarray.Dataset, dimensions: Sequence[str], reasons: Mapping[tuple[int, ...], str]
) -> xarray.Dataset:
    """Return the record with all values of the copies that diverged set to NaN.

    All, from the start, because reductions such as `max` skip single missing values.

    Args:
        record: the record.
        dimensions: the dimensions of the copies.
        reasons: for the index of a copy along these dimensions, why it diverged.
    """
    if not reasons:
        return record
    texts = np.full([record.sizes[d] for d in dimensions], "", object)
    for place, reason in reasons.items():
        texts[place] = reason
        for variable in record.data_vars.values():  # their first dimensions are those of the copies
            variable.values[place] = np.nan
    return counted(record.assign_coords({_name(record): (list(dimensions), texts.astype(str))}))


def coordinate(sizes: Mapping[str, int], reasons: Mapping[tuple[int, ...], str]) -> xarray.Dataset:
    """Return the coordinate of a record with copies of these dimensions, and the attribute that counts them.

    Args:
        sizes: the dimensions of the copies.
        reasons: for the index of a copy along these dimensions, why it diverged.
    """
    texts = np.full(list(sizes.values()), "", object)
    for place, reason in reasons.items():
        texts[place] = reason
    empty = xarray.Dataset(coords={d: np.arange(n) for d, n in sizes.items()})
    return counted(empty.assign_coords({_name(empty): (list(sizes), texts.astype(str))}))


def alike(records: Sequence[xarray.Dataset], dimensions: Sequence[str]) -> list[xarray.Dataset]:
    """Return records that all have the coordinate, if any has it."""
    if not any(_name(record) in record.coords for record in records):
        return list(records)

    def blank(record: xarray.Dataset) -> xarray.Dataset:
        return record.assign_coords(
            {_name(record): (list(dimensions), np.full([record.sizes[d] for d in dimensions], "", "<U1"))}
        )

    return [record if _name(record) in record.coords else blank(record) for record in records]


def counted(record: xarray.Dataset) -> xarray.Dataset:
    """Return the record with an attribute that counts its diverged copies in a sentence, if any."""
    name = _name(record)
    if name not in record.coords:
        return record
    texts = np.ravel(record[name].values).tolist()
    bad = [text for text in texts if text]
    where = f"the coordinate {name!r} gives the reasons, the first is: {bad[0]}"
    return record.assign_attrs({REASON: f"{len(bad)} of {len(texts)} copies are NaN; {where}"})


def _name(record: xarray.Dataset) -> str:
    # a swept document parameter may have that name
    return REASON if REASON not in record.sizes else f"{REASON}.reason"
