"""What a setting says of a sensor that is a topic of ROS 2."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, TypeVar

import msgspec
from msgspec import Meta

from deodar.errors import WorldError

T = TypeVar("T")
ArraySamples = Annotated[list[Annotated[int, Meta(gt=0, le=10**6)]], Meta(max_length=7)]


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
