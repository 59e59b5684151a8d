"""Arrays of numbers: the message types Float32MultiArray and Float64MultiArray."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from deodar.errors import WorldError
from deodar.worlds._base import Signal
from deodar_robots.ros2.message_types import Unreadable
from deodar_robots.ros2.reading import Reading


class ArrayReading(Reading):
    """The numbers of a std_msgs/Float32MultiArray or Float64MultiArray, in C order of `shape`."""

    settings = ("shape",)

    def declared(self) -> Signal:
        if self.entry.shape is None:
            fix = 'State it: "shape": [50, 50]'
            raise WorldError(f"a {self.entry.type} needs its shape", self.where, fix)
        return Signal(f"numbers of {self.entry.topic}", tuple(self.entry.shape), "", self.entry.period)

    def take(self, message: Any) -> np.ndarray:
        shape = self.signal.shape or ()
        begin = message.layout.data_offset
        values = np.asarray(message.data)[begin:]
        if len(values) != math.prod(shape):
            raise Unreadable(f"it has {len(values)} numbers, not {math.prod(shape)}")
        if not np.isfinite(values).all():
            raise Unreadable("its numbers are not finite")
        return values.reshape(shape)
