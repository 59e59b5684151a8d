"""The first difference of two records, port by port, read chunk by chunk."""

from __future__ import annotations

import dataclasses as dc
import itertools
from collections.abc import Callable, Mapping, Sequence

import numpy as np

from deodar.errors import RecordError
from deodar.model import find
from deodar.recording.replay import Copy, PortPlace, RecordReader


@dc.dataclass(frozen=True)
class FirstDifference:
    """The first moment at which a port of two records differs.

    Attributes:
        place: the port.
        path: its path.
        time: document time of the moment.
        copy: the trial and the point of a sweep, as indices.
        index: the sample within the frame, the one with the largest difference.
        values: its value in each record.
    """

    place: PortPlace
    path: str
    time: float
    copy: Mapping[str, int]
    index: tuple[int, ...]
    values: tuple[float, float]


def common_ports(one: RecordReader, other: RecordReader) -> list[PortPlace]:
    """Return the ports that both records have, over the same axes.

    Raises:
        RecordError: they have none, or other trials or points of a sweep.
    """
    shared = [p for p in one.ports if p in set(other.ports) and one.axes(p) == other.axes(p)]
    if not shared:
        raise RecordError("has no recorded port in common with the open record", where=str(other.path))
    sizes, others = ({d: len(v) for d, v in r.copies.items()} for r in (one, other))
    if sizes != others:
        raise RecordError(
            f"has other trials or points of a sweep: {others or 'none'}, the open record {sizes or 'none'}",
            where=str(other.path),
        )
    return shared


def first_differences(
    one: RecordReader, other: RecordReader, progress: Callable[[float], bool]
) -> list[FirstDifference]:
    """Return the first difference of each port that differs, the earliest first.

    Values are equal if they are the same number, or both NaN. Moments that one of the records does not have
    are left out.

    Args:
        one: a record.
        other: another one.
        progress: called with the share that was compared; if it returns False, the comparison ends.

    Raises:
        RecordError: a chunk cannot be read.
    """
    places = common_ports(one, other)
    copies = _copies(one)
    differences: dict[PortPlace, FirstDifference] = {}
    total = len(places) * len(copies)
    for done, (place, copy) in enumerate(itertools.product(places, copies)):
        times = one.sample_times(place)
        count = max(1, len(times))
        for first, last in one.chunks(place):
            before = differences.get(place)
            if before is not None and times[first] >= before.time:
                break
            difference = _within(one, other, place, copy, (first, last))
            if difference is not None and (before is None or difference.time < before.time):
                differences[place] = difference
            if not progress((done + last / count) / total):
                return []
            if difference is not None:
                break
    progress(1.0)
    return sorted(differences.values(), key=lambda d: (d.time, d.path))


def _copies(record: RecordReader) -> Sequence[Copy]:
    sizes = {d: len(values) for d, values in record.copies.items()}
    return [dict(zip(sizes, k, strict=True)) for k in itertools.product(*map(range, sizes.values()))]


def _within(
    one: RecordReader, other: RecordReader, place: PortPlace, copy: Copy, part: tuple[int, int]
) -> FirstDifference | None:
    """Return the first difference within samples of the first record."""
    first, last = part
    times, others = one.sample_times(place)[first:last], other.sample_times(place)
    low, high = np.searchsorted(others, times[0], "left"), np.searchsorted(others, times[-1], "right")
    _, mine, theirs = np.intersect1d(times, others[low:high], return_indices=True)
    if not len(mine):
        return None
    a = one.block(place, copy, first, last)[mine]
    b = other.block(place, copy, int(low), int(high))[theirs]
    differs = (a != b) & ~(np.isnan(a) & np.isnan(b))
    frames = np.flatnonzero(differs.reshape(len(mine), -1).any(axis=1))
    if not len(frames):
        return None
    k = int(frames[0])
    gap = np.abs(np.asarray(a[k], np.float64) - b[k])
    gap = np.where(differs[k], np.where(np.isfinite(gap), gap, np.inf), -1.0)
    index = np.unravel_index(int(np.argmax(gap)), gap.shape)
    path = f"{find.entry(one.document, place[0]).path}.{place[1]}"
    at = tuple(int(i) for i in index)
    values = float(a[k][index]), float(b[k][index])
    return FirstDifference(place, path, float(times[mine[k]]), copy, at, values)
