"""Copies of a batch that diverged: all their values are NaN, and a coordinate of the record gives the
reason.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import xarray

REASON = "diverged"
"""The coordinate that gives the reason for each copy ("" where there is none), and the attribute that counts
them.
"""


def marked(
    data: xarray.Dataset, dimensions: Sequence[str], reasons: Mapping[tuple[int, ...], str]
) -> xarray.Dataset:
    """The record with the copies that diverged made NaN, from the start: reductions such as `max` skip single
    missing values.

    Args:
        data: the record.
        dimensions: those of the copies.
        reasons: for the place of a copy along these dimensions why it diverged.
    """
    if not reasons:
        return data
    texts = np.full([data.sizes[d] for d in dimensions], "", object)
    for place, reason in reasons.items():
        texts[place] = reason
        for variable in data.data_vars.values():  # of which these are the first dimensions
            variable.values[place] = np.nan
    return counted(data.assign_coords({_name(data): (list(dimensions), texts.astype(str))}))


def alike(records: Sequence[xarray.Dataset], dimensions: Sequence[str]) -> list[xarray.Dataset]:
    """Records of which all have the coordinate, if any has."""
    if not any(_name(data) in data.coords for data in records):
        return list(records)

    def blank(data: xarray.Dataset) -> xarray.Dataset:
        return data.assign_coords(
            {_name(data): (list(dimensions), np.full([data.sizes[d] for d in dimensions], "", "<U1"))}
        )

    return [data if _name(data) in data.coords else blank(data) for data in records]


def counted(data: xarray.Dataset) -> xarray.Dataset:
    """The record with a sentence about its copies that diverged among its attributes, where there are any."""
    name = _name(data)
    if name not in data.coords:
        return data
    texts = np.ravel(data[name].values).tolist()
    bad = [text for text in texts if text]
    where = f"the coordinate {name!r} gives the reasons, the first is: {bad[0]}"
    return data.assign_attrs({REASON: f"{len(bad)} of {len(texts)} copies are NaN; {where}"})


def _name(data: xarray.Dataset) -> str:
    return (
        REASON if REASON not in data.sizes else f"{REASON}.reason"
    )  # a document parameter that is swept may have that name
