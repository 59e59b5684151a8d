"""From a message to the reading of a sensor: the setting of the sensor, and the contract of all types."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Annotated, Any, TypeAlias, TypeVar

import msgspec
import numpy as np
from msgspec import Meta

from deodar.errors import WorldError, did_you_mean
from deodar.numerics.axes import Axes
from deodar.worlds._base import Signal
from deodar_robots.ros2.message_types import Unreadable

T = TypeVar("T")
ArraySamples = Annotated[list[Annotated[int, Meta(gt=0, le=10**6)]], Meta(max_length=7)]


Decode: TypeAlias = Callable[[], np.ndarray]
"""A function that decodes one message; it raises Unreadable."""


class TopicSensor(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A sensor whose readings come from a topic.

    Attributes:
        topic: name of the topic.
        type: type of its messages, such as sensor_msgs/LaserScan.
        shape: samples along each axis, where the type leaves them open.
        fields: which numbers of a message form the reading; a single name instead of a list is one number.
        joints: names of the joints, in the order of the reading.
        undefined: number in place of a distance that is not defined; None: such a message is refused.
        period: ms between two messages, where they are rarer than the exchanges.
    """

    topic: str
    type: str
    shape: ArraySamples | None = None
    fields: str | list[str] | None = None
    joints: list[str] | None = None
    undefined: float | None = None
    period: Annotated[float, Meta(gt=0)] | None = None


def converted(data: Any, form: type[T], where: str) -> T:
    """Return plain data as an entry of a form, or raise WorldError."""
    try:
        return msgspec.convert(data, form)
    except msgspec.ValidationError as error:
        raise WorldError(str(error), where) from None


def entries(data: Any, form: type[T], what: str) -> dict[str, T]:
    """Return the entries of a setting by name of the signal, or raise WorldError."""
    if not isinstance(data, Mapping) or not all(isinstance(name, str) and name for name in data):
        raise WorldError("are no topics by name of the signal", what)
    return {str(name): converted(entry, form, f"{what} {name}") for name, entry in data.items()}


class Reading:
    """What a sensor reads of the messages of a topic.

    Args:
        entry: the setting of the sensor.
        where: its place, for messages.

    Attributes:
        signal: signal of the sensor.
    """

    settings: Sequence[str] = ()
    """Settings that the type uses, besides topic, type and period."""

    def __init__(self, entry: TopicSensor, where: str) -> None:
        for name in ("shape", "fields", "joints", "undefined"):
            if getattr(entry, name) is not None and name not in self.settings:
                raise WorldError(f"the type {entry.type} has no setting {name!r}", where)
        self.entry, self.where = entry, where
        self.signal = self.declared()

    def declared(self) -> Signal:
        """Return the signal of the sensor."""
        raise NotImplementedError

    def take(self, message: Any) -> np.ndarray | Decode:
        """Return what a message says, with finite numbers, or a function that decodes it.

        Messages of all topics arrive in one thread. A type that takes long to decode returns a function,
        which the reader of the sensor calls.

        Raises:
            Unreadable: the message has another shape, or numbers that are not finite.
        """
        raise NotImplementedError

    def read(self, message: Any) -> np.ndarray:
        """Return what a message says, decoded; raise Unreadable as `take` does."""
        taken = self.take(message)
        return taken() if callable(taken) else taken

    def sampled(self, taken: np.ndarray, axes: Axes, sensor: str) -> np.ndarray:
        """Return the reading over axes, from what a message says."""
        return taken

    def shape_of(self, dimensions: int, example: str) -> tuple[int, ...]:
        """Return the shape that the setting states, or raise WorldError."""
        shape = self.entry.shape
        if shape is None or len(shape) != dimensions:
            raise WorldError(
                f"a {self.entry.type} needs its shape", self.where, f'State it: "shape": {example}'
            )
        return tuple(shape)

    def choice(self, known: Sequence[str]) -> str:
        """Return the one of the known fields that the setting names, by default the first."""
        field = self.entry.fields or known[0]
        if not isinstance(field, str) or field not in known:
            fix = did_you_mean(field, known) if isinstance(field, str) else f"Name one: {', '.join(known)}"
            raise WorldError(f"there is no field {field!r}", self.where, fix)
        return field


def finite(values: Any, what: str) -> np.ndarray:
    """Return numbers in float32.

    Raises:
        Unreadable: one of them is not finite.
    """
    with np.errstate(over="ignore"):  # what is too large for float32 is infinite
        array = np.asarray(values, np.float32)
    if not np.isfinite(array).all():
        raise Unreadable(f"its {what} is not finite")
    return array


def chosen_fields(
    fields: str | Sequence[str] | None, default: Sequence[str], units: Mapping[str, str], where: str
) -> tuple[list[str], tuple[int, ...], str]:
    """Return the names of the chosen fields, the shape of their vector, and their unit if it is one.

    Args:
        fields: the setting; a single name is one number.
        default: the fields without a setting.
        units: units of all fields by name.
        where: place of the setting, for messages.
    """
    names = [fields] if isinstance(fields, str) else list(default if fields is None else fields)
    for name in names:
        if name not in units:
            raise WorldError(f"there is no field {name!r}", where, did_you_mean(name, units))
    if not names or len(set(names)) < len(names):
        raise WorldError("names no field, or one twice", where)
    shared = {units[name] for name in names}
    shape = () if isinstance(fields, str) else (len(names),)
    return names, shape, shared.pop() if len(shared) == 1 else ""
