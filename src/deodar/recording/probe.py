"""What is recorded: a port, at which times, and under which condition."""

from __future__ import annotations

import dataclasses as dc
import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from deodar.errors import ParameterError, did_you_mean
from deodar.model.document import Entry
from deodar.model.model import Handle, path_of
from deodar.parameters import real, show

TIME = "time"
CONDITIONS = ("peak", "crossing")


@dc.dataclass(frozen=True)
class Probe:
    """A port that is recorded with an interval or a condition of its own.

    Its text form, which the command line takes, is `PATH,every=T,when=CONDITION`.

    Attributes:
        path: path of the port; the path of a field alone means its activation.
        every: document time between two samples; None: that of the record.
        when: `peak`: only samples whose maximum is above a threshold, that of the sigmoid for the activation
            of a field, 0.5 for its output, 0 for other ports. `crossing`: only the first sample after the
            maximum has crossed the threshold, in either direction. None: every sample.

    Raises:
        ParameterError: the condition does not exist, or the interval is not above 0.
    """

    path: str
    every: float | None = None
    when: str | None = None

    def __post_init__(self) -> None:
        if self.every is not None and not 0 < (real(self.every) or 0) < math.inf:
            raise ParameterError(f"every is {show(self.every)}; expected a time above 0", where=self.path)
        if self.when is not None and self.when not in CONDITIONS:
            raise ParameterError(
                f"there is no condition {show(self.when)}",
                where=self.path,
                fix=did_you_mean(str(self.when), CONDITIONS),
            )

    @property
    def alone(self) -> bool:
        """Whether it has times of its own."""
        return self.every is not None or self.when is not None

    def __str__(self) -> str:
        every = "" if self.every is None else f",every={self.every:g}"
        return f"{self.path}{every}" + ("" if self.when is None else f",when={self.when}")


def parsed(text: str) -> Probe:
    """Return the probe of a text: a path, then `,every=T` and `,when=CONDITION` in any order.

    Raises:
        ParameterError: an interval is not a number, or the condition does not exist.
    """
    path, every, when = text, None, None
    while True:
        before, comma, last = path.rpartition(",")
        name, sign, setting = last.partition("=")
        quoted = (before.count('"') - before.count('\\"')) % 2 == 1
        if not comma or not sign or quoted or name.strip() not in ("every", "when"):
            return Probe(path, every, when)
        path = before
        if name.strip() == "when":
            when = setting.strip()
            continue
        try:
            every = float(setting)
        except ValueError:
            raise ParameterError(
                f"every is {setting!r}; expected a time", where=text, fix=f"For example {path},every=10"
            ) from None


def is_time(dimension: str) -> bool:
    """Return whether a dimension is one of times: `time`, or that of a variable with times of its own."""
    return dimension.rpartition(".")[2] == TIME


def probes(record: Probe | Handle | str | Iterable[Probe | Handle | str]) -> list[Probe]:
    """Return what a script asks to record as probes: one or several of paths, handles and probes.

    Raises:
        ParameterError: it is something else, or empty.
    """
    is_one = isinstance(record, (str, Handle, Probe)) or not np.iterable(record)
    requested: list[Any] = [record] if is_one else list(record)  # type: ignore[arg-type]
    texts = [path_of(port) if isinstance(port, Handle) else port for port in requested]
    if not all(isinstance(port, (str, Probe)) for port in texts):
        raise ParameterError(
            f"record names ports by their paths, not {show(record)}",
            fix="For example record=['u.activation']",
        )
    if not texts:
        raise ParameterError("record is empty", fix="Name at least one port, or leave it out")
    return [port if isinstance(port, Probe) else parsed(port) for port in texts]


def threshold(element: object, port: str) -> float:
    """Return the threshold of a condition on a port.

    It is that of the sigmoid for the activation of a field, 0.5 for its output, and 0 for other ports.
    """
    level = getattr(getattr(element, "sigmoid", None), "threshold", None)
    if not isinstance(level, float):
        return 0.0
    return {"activation": level, "output": 0.5}.get(port, 0.0)


class Series(NamedTuple):
    """Variables that share their times: each `stride`-th sample of the run, under one condition.

    Attributes:
        dimension: name of their dimension of time.
        stride: number of samples of the run from one to the next.
        when: condition, or None.
        names: names of the variables.
    """

    dimension: str
    stride: int
    when: str | None
    names: tuple[str, ...]


def series(names: Sequence[str], strides: Sequence[int], conditions: Sequence[str | None]) -> list[Series]:
    """Group variables by their times.

    The times of the first variables without a condition are `time`; other groups are called after their first
    variable. Variables with a condition stand alone.
    """
    groups: dict[tuple[int, str | None, str], list[str]] = {}
    for name, stride, when in zip(names, strides, conditions, strict=True):
        groups.setdefault((stride, when, name if when else ""), []).append(name)
    main = next((key for key in groups if key[1] is None), None)
    return [
        Series(TIME if key == main else f"{members[0]}.{TIME}", key[0], key[1], tuple(members))
        for key, members in groups.items()
    ]


class Chosen(NamedTuple):
    """Samples of a series: number of the first one (None: after the last), times, values by name."""

    dimension: str
    first: int | None
    times: np.ndarray
    values: dict[str, np.ndarray]


class Selector:
    """Chooses from the samples of a run those of each series.

    Args:
        listed: the series.
        thresholds: threshold of each variable with a condition.

    Attributes:
        above: for each variable with a condition whether its last sample was above the threshold.
    """

    def __init__(self, listed: Sequence[Series], thresholds: Mapping[str, float]) -> None:
        self.found, self.thresholds = list(listed), dict(thresholds)
        self.above: dict[str, bool] = {}

    def choose(
        self, first: int, times: np.ndarray, values: Mapping[str, np.ndarray], axis: int = 0
    ) -> Iterator[Chosen]:
        """Yield the chosen samples of each series, if any.

        Args:
            first: number of the first sample of the run.
            times: times of the samples.
            values: values by name, the samples along `axis`; variables with a condition have them first.
            axis: number of leading dimensions of copies.
        """
        for group in self.found:
            skipped = -first % group.stride
            # a slice copies nothing
            place: slice | np.ndarray = slice(skipped, None, group.stride)
            number: int | None = (first + skipped) // group.stride
            if group.when is not None:
                every = np.arange(skipped, len(times), group.stride)
                place, number = self._met(group, every, values[group.names[0]]), None
            if times[place].size:
                lead = (slice(None),) * axis
                chosen = {name: values[name][*lead, place] for name in group.names}
                yield Chosen(group.dimension, number, times[place], chosen)

    def _met(self, group: Series, place: np.ndarray, values: np.ndarray) -> np.ndarray:
        """Return the places of samples that meet the condition of a series."""
        name = group.names[0]
        if not place.size:
            return place
        above = values[place].reshape(place.size, -1).max(1) > self.thresholds[name]
        before = np.concatenate([[self.above.get(name, bool(above[0]))], above[:-1]])
        self.above[name] = bool(above[-1])
        return place[above] if group.when == "peak" else place[above != before]


def selector(
    ports: Sequence[tuple[Entry, str]], strides: Sequence[int], conditions: Sequence[str | None]
) -> Selector:
    """Return what chooses the samples of ports, of which each is `PATH.PORT` of an element."""
    limits = {f"{entry.path}.{port}": threshold(entry.element, port) for entry, port in ports}
    return Selector(series(list(limits), strides, conditions), limits)
