"""The ports of a model to a world."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar

from deodar.element import Arrays, Element, PortAxes, PortUnits, Setting
from deodar.numerics.axes import Axis
from deodar.registry import register


@register
@dataclass(frozen=True)
class Sensor(Element):
    r"""A reading of a world's sensor, over axes that the model states.

    The world is chosen when the model is run; it must have a sensor of this name.

    Equation:
        y(x, t) = \mathrm{sensor}(x, t)

    Parameters:
        axes: axes of the reading; the world samples the reading at their points.
        sensor: name of the world's sensor.

    Ports:
        output: over `axes`.

    Reference:
        Lomp, Richter, Zibner & Schöner (2016), Front. Neurorobot. 10:14, section 2.5.1.
    """

    name: str = ""
    axes: Sequence[Axis] = ()
    sensor: str = "picture"

    inputs: ClassVar[tuple[str, ...]] = ()
    external: ClassVar[str] = "reading"

    def sensor_name(self) -> str:
        return self.sensor

    def position_units(self, ins: PortAxes, inputs: PortUnits) -> PortUnits:
        return {"output": inputs["reading"]}

    def output(self, at: Setting) -> Arrays:
        return {"output": at.inputs["reading"]}


@register
@dataclass(frozen=True)
class Motor(Element):
    r"""A command to a motor of a world.

    The world is chosen when the model is run; without a world the command has no effect. The world's motor
    of this name receives y once per period of the world and holds the latest command in between.

    Equation:
        y(t) = \sum \mathrm{inputs}(t)

    Parameters:
        axes: axes of the command; none: one number.
        motor: name of the world's motor.

    Ports:
        input: the command, over `axes`, in the motor's unit.
        output: the command, over `axes`.

    Reference:
        Billing, Lowe & Sandamirskaya (2015), Adapt. Behav. 23(5), section 4, figure 4.
    """

    name: str = ""
    axes: Sequence[Axis] = ()
    motor: str = "left"

    direct: ClassVar[Mapping[str, tuple[str, ...]]] = {"output": ("input",)}

    def motor_name(self) -> str:
        return self.motor

    def output(self, at: Setting) -> Arrays:
        return {"output": at.inputs["input"]}
