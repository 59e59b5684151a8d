"""The table of the trials of an experiment, as a Dataset that shows itself in a few lines."""

from __future__ import annotations

from collections import Counter

import xarray

from deodar.recording.shown_dataset import ShownDataset
from deodar.summary import Summary, counted


class ResultsTable(ShownDataset):
    """The table of an experiment; its lines in a notebook are its columns: counts of words, means of numbers.

    What is selected or computed from it has the same class, and shows its columns too.
    """

    __slots__ = ()

    def _summary(self) -> Summary:
        named = [*self.coords.items(), *self.data_vars.items()]
        columns = [(str(name), _column(column)) for name, column in named]
        trials = counted(self.sizes.get("trial", 1), "trial")
        return Summary(f"Results of {str(self.attrs.get('title', ''))!r}: {trials}", columns)


def _column(column: xarray.DataArray) -> str:
    values = column.values.ravel()
    if values.dtype.kind not in "fiu":
        return ", ".join(f"{word or 'none'} {n}" for word, n in Counter(values.tolist()).items())
    measured = values[values == values]  # a condition that did not occur is NaN
    if not measured.size:
        return "no value"
    missing = f", {values.size - measured.size} without" if measured.size < values.size else ""
    return f"{measured.min():.4g} to {measured.max():.4g}, mean {measured.mean():.4g}{missing}"
