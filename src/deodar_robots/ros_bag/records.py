"""Records as bags of ROS 2 (rosbag2): a topic for each variable, a message for each sample."""

from __future__ import annotations

import heapq
import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import xarray

from deodar import codec
from deodar.codec import JsonObject
from deodar.errors import Fix, RecordError
from deodar.model.unit import unit_seconds
from deodar.recording import places
from deodar.recording.record import time_dimension
from deodar_robots.ros2.message_types import make, to_bytes
from deodar_robots.ros_bag.bag_file import write_bag

BLOCK = 2**20
"""Number of values that are read at a time."""

SINGLE, DOUBLE = "std_msgs/msg/Float32MultiArray", "std_msgs/msg/Float64MultiArray"


def save(data: xarray.Dataset, path: str | Path, force: bool = False) -> Path:
    """Write a record as a bag.

    The topic of `eye.output` is /eye/output. Its messages are Float32MultiArray, or Float64MultiArray for all
    types of numbers but float32; their dimensions have the names of the axes. The time of a message is that
    of the sample in ns, so that the world `ROSBag` reads what the record holds, at its times.

    Args:
        data: the record, of one trial; it is read in blocks.
        path: the folder.
        force: whether to replace an existing folder.

    Raises:
        RecordError: a variable has no time or several trials, or its unit of time is not in seconds.
        OutputExists: the folder exists, and `force` is not given.
        OutputError: it cannot be written.
    """
    path = Path(path)
    times = {str(name): _times(str(name), variable) for name, variable in data.data_vars.items()}
    topics = _topics(list(times))
    types = {topics[n]: SINGLE if data[n].dtype == np.float32 else DOUBLE for n in times}
    steps = [int(np.diff(t).min()) for t in times.values() if len(t) > 1]
    elements = _elements(data)
    moved = [str(e.get("motor", "left")) for e in elements.values() if e.get("kind") == "Motor"]
    added: JsonObject = {"record": 1, "origin": 0, "motors": list(moved)}
    added["sensors"] = _sensors(data, elements, topics, types)
    if steps:
        added["period"] = min(steps) / 1e6
    parts = [_messages(data[name], topics[name], times[name]) for name in times]
    places.claim_folder(path, force)
    places.write_folder(
        path, lambda folder: write_bag(folder, types, heapq.merge(*parts, key=lambda m: m[1]), added), force
    )
    return path


def _times(name: str, variable: xarray.DataArray) -> np.ndarray:
    """Return the times of the samples in ns."""
    time = time_dimension(variable)
    if time is None:
        raise RecordError("has no times", where=name, fix="Name the variables that have some")
    lead = list(map(str, variable.dims))[: list(map(str, variable.dims)).index(time)]
    if lead:
        fix = Fix(
            f"Choose one: record.sel({{{lead[0]!r}: ...}})",
            "Choose one: --trial 0" if lead == ["trial"] else "Choose one: --where PATH=VALUE",
        )
        raise RecordError(f"is over {', '.join(lead)}, and a bag holds one run", name, fix)
    unit = str(variable[time].attrs.get("units", "ms"))
    if unit == "abstract":
        raise RecordError(
            "has abstract times, and a bag has nanoseconds", name, Fix("Save it as .csv", "Type: --to csv")
        )
    stamps = np.round(np.asarray(variable[time].values, float) * unit_seconds(unit) * 1e9).astype(np.int64)
    if len(stamps) and stamps[0] < 0:
        raise RecordError("begins before the time 0, and a bag does not", name)
    return stamps


def _topics(names: list[str]) -> dict[str, str]:
    """Return a topic for each variable; two may differ in what no name of a topic holds."""
    found: dict[str, str] = {}
    for name in names:
        parts = [re.sub(r"\W", "_", part, flags=re.ASCII) or "_" for part in re.split(r"[./]", name)]
        parts = [f"_{part}" if part[0].isdigit() else part for part in parts]
        topic, n = "/" + "/".join(parts), 1
        while topic in found.values():
            n += 1
            topic = f"/{'/'.join(parts)}_{n}"
        found[name] = topic
    return found


def _elements(data: xarray.Dataset) -> Mapping[str, Mapping[str, Any]]:
    """Return the elements of the model of a record, by path; none if it does not state them."""
    try:
        return codec.parse(data.attrs["deodar"])["document"]["elements"]
    except (KeyError, TypeError, ValueError):
        return {}


def _sensors(
    data: xarray.Dataset,
    elements: Mapping[str, Mapping[str, Any]],
    topics: Mapping[str, str],
    types: Mapping[str, str],
) -> JsonObject:
    """Return the settings by which `ROSBag` reads the bag; outputs of sensors have the names of these."""
    found: JsonObject = {}
    for name, topic in topics.items():
        element = elements.get(name.removesuffix(".output"), {})
        sensor = str(element.get("sensor", "picture")) if element.get("kind") == "Sensor" else name
        shape = [int(n) for n in data[name].shape[1:]]
        found[name if sensor in found else sensor] = {"topic": topic, "type": types[topic], "shape": shape}
    return found


def _messages(variable: xarray.DataArray, topic: str, times: np.ndarray) -> Iterator[tuple[str, int, bytes]]:
    """Yield topic, time and bytes of each sample."""
    shape = variable.shape[1:]
    size = max(1, int(np.prod(shape)))
    single = variable.dtype == np.float32
    strides = [int(np.prod(shape[k:])) for k in range(len(shape))]
    dims = [
        make("std_msgs/msg/MultiArrayDimension", label=str(d), size=int(n), stride=s)
        for d, n, s in zip(variable.dims[1:], shape, strides, strict=True)
    ]
    layout = make("std_msgs/msg/MultiArrayLayout", dim=dims, data_offset=0)
    rows = max(1, BLOCK // size)
    for start in range(0, len(times), rows):
        block = variable[start : start + rows].values.astype(np.float32 if single else np.float64)
        for time, values in zip(times[start : start + rows], block, strict=True):
            message = make(SINGLE if single else DOUBLE, layout=layout, data=np.ravel(values))
            yield topic, int(time), to_bytes(message)
