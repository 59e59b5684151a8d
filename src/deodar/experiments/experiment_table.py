"""The table of an experiment: its rows as columns over the trials."""

from __future__ import annotations

import csv
import io
from array import array
from collections.abc import Callable, Iterable, Mapping
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from deodar import codec
from deodar.errors import DamagedFile, first_line
from deodar.experiments import row_line
from deodar.experiments.jobs import MACHINE
from deodar.experiments.observations import DIVERGED
from deodar.experiments.rows import KEY, Row
from deodar.recording import provenance

if TYPE_CHECKING:
    import xarray

NUMBER = (int, float, type(None))
"""Types of a number in a row; None: there is none."""


def lacks(about: Mapping[str, Any]) -> Callable[[Any], str]:
    """Return a function that says what a row of an experiment lacks; "" if it is complete.

    Args:
        about: the identity of the experiment.

    Raises:
        LookupError, TypeError: it is no identity of an experiment.
    """
    names = {part: [*about.get(part, {})] for part in ("factors", "conditions", "measures")}
    inside = {"levels": names["factors"], "events": names["conditions"], "measures": names["measures"]}
    kinds = {KEY: str, "trial": int, "outcome": str, "awaited": str, "duration": NUMBER}

    def lacking(row: Any) -> str:
        if not isinstance(row, dict):
            return "it is no object of JSON"
        fields = cast("Row", row)
        for name, kind in kinds.items():
            if not isinstance(fields.get(name), kind):
                return name
        for part, names_inside in inside.items():
            part_values = fields.get(part)
            if not isinstance(part_values, dict) or not all(name in part_values for name in names_inside):
                return part
        if not all(isinstance(fields["events"][name], NUMBER) for name in inside["events"]):
            return "events"
        if not all(isinstance(fields["measures"][name], (list, *NUMBER)) for name in inside["measures"]):
            return "measures"
        return ""

    return lacking


def read_row(line: bytes, number: int, file: str, lacking: Callable[[Any], str], checked: bool) -> Row:
    """Return the row in a line of a file.

    Args:
        line: the line.
        number: its number in the file, from 1.
        file: the file, for the error.
        lacking: what `lacks` returned for the experiment of the file.
        checked: whether the lines of the file have checksums.

    Raises:
        DamagedFile: it is not a row of this experiment, or not the one that was written.
    """
    try:
        row = row_line.read(line, checked)
        wrong = lacking(row)
    except ValueError as error:
        row, wrong = None, first_line(error)
    if wrong:
        raise DamagedFile(
            f"line {number} is not a row of its experiment: {wrong}",
            where=file,
            fix="Remove that line; the trial is then run again",
        )
    return cast("Row", row)


def dataset(rows: Iterable[Row], about: Mapping[str, Any]) -> xarray.Dataset:
    """Return rows as a Dataset over `trial`.

    Levels are coordinates; `outcome`, `awaited` (the conditions that the limit cut off), `duration`, the time
    of each condition and the measures are variables. A condition that did not occur is NaN. Measures of
    several numbers have a dimension of their own. If trials diverged, the variable `diverged` gives the
    reason of each (empty: it did not diverge), and the attribute of this name counts them.

    Args:
        rows: the rows in any order; each is read once and not kept.
        about: the identity of the experiment.
    """
    # start-up time: this brings xarray
    from deodar.experiments.results_table import ResultsTable

    columns = _TableColumns(about)
    for row in rows:
        columns.append(row)
    order = np.argsort(np.asarray(columns.trials), kind="stable")
    unit = {"units": about["time_unit"]}
    coords: dict[str, Any] = {"trial": ("trial", np.asarray(columns.trials, np.int64)[order])}
    for name, labels in columns.levels.items():
        coords[name] = ("trial", _column(labels)[order])
    out: dict[str, Any] = {
        key: ("trial", np.asarray(columns.words[key], dtype=str)[order]) for key in ("outcome", "awaited")
    }
    attributes = {provenance.KEY: codec.line(about), "title": about["name"]}
    reasons = columns.words[DIVERGED]
    bad = [reasons[k] for k in order if reasons[k]] if any(reasons) else []
    if bad:
        out[DIVERGED] = ("trial", np.asarray(reasons, dtype=str)[order])
        where = f"the variable {DIVERGED!r} gives the reasons, the first is: {bad[0]}"
        attributes[DIVERGED] = f"{len(bad)} of {len(reasons)} trials diverged; {where}"
    if columns.machines:
        out[MACHINE] = ("trial", np.asarray(columns.words[MACHINE], dtype=str)[order])
    out["duration"] = ("trial", np.asarray(columns.durations)[order], unit)
    for name, times in columns.events.items():
        out[name] = ("trial", np.asarray(times)[order], {**unit, "long_name": f"time of {name}"})
    for name, measured in columns.measures.items():
        count = max((len(v) for v in measured if isinstance(v, list)), default=0)
        if count:
            values = np.asarray([[np.nan] * count if v is None else v for v in measured], float)
            out[name] = (("trial", f"{name}.axis"), values[order])
        else:
            out[name] = ("trial", np.asarray([_or_nan(v) for v in measured], float)[order])
    return ResultsTable(out, coords, attributes)


class _TableColumns:
    """The columns of a table while rows arrive; equal words are kept once.

    Attributes:
        machines: whether a row names its machine.
    """

    def __init__(self, about: Mapping[str, Any]) -> None:
        self.trials, self.durations = array("q"), array("d")
        self.levels: dict[str, list[Any]] = {name: [] for name in about.get("factors", {})}
        self.words: dict[str, list[str]] = {key: [] for key in ("outcome", "awaited", DIVERGED, MACHINE)}
        self.events = {name: array("d") for name in about.get("conditions", {})}
        self.measures: dict[str, list[Any]] = {name: [] for name in about.get("measures", {})}
        self.machines = False
        self._interned: dict[Any, Any] = {}

    def append(self, row: Row) -> None:
        interned = self._interned
        self.trials.append(row["trial"])
        self.durations.append(_or_nan(row["duration"]))
        for name, labels in self.levels.items():
            label = row["levels"][name]
            labels.append(interned.setdefault((type(label), label), label))
        for key, words in self.words.items():
            word = row[key] if key in ("outcome", "awaited") else row.get(key, "")
            words.append(interned.setdefault((str, word), word))
        self.machines |= MACHINE in row
        for name, times in self.events.items():
            times.append(_or_nan(row["events"][name]))
        for name, values in self.measures.items():
            values.append(row["measures"][name])


def table(trials: xarray.Dataset) -> str:
    """Return the table as CSV, one line per trial; a cell is empty if the condition did not occur."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    columns: list[tuple[str, np.ndarray]] = []
    for name in [*trials.coords, *trials.data_vars]:
        values = trials[name].values
        if values.ndim == 1:
            columns.append((str(name), values))
        else:
            columns += [(f"{name}.{k}", values[:, k]) for k in range(values.shape[1])]
    writer.writerow([name for name, _ in columns])
    for k in range(trials.sizes["trial"]):
        writer.writerow([_cell(values[k]) for _, values in columns])
    return text.getvalue()


def _cell(value: Any) -> str:
    if isinstance(value, (float, np.floating)):
        return "" if np.isnan(value) else repr(float(value)).removesuffix(".0")
    return str(value)


def _column(values: list[Any]) -> np.ndarray:
    """Return numbers if all values are numbers, else text."""
    if any(isinstance(v, str) for v in values):
        return np.asarray([str(v) for v in values], dtype=str)
    return np.asarray(values, float)


def _or_nan(number: Any) -> Any:
    return np.nan if number is None else number
