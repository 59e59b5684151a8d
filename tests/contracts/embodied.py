"""Models around the example of each registered world: they read every sensor and drive every motor."""

from __future__ import annotations

import deodar as dd
from deodar import registry
from deodar.elements.stimuli import Boost
from deodar.elements.world_ports import Motor, Sensor
from deodar.numerics.axes import Axis

WORLDS = registry.kinds("worlds")


def example_axes(kind, sensor):
    return WORLDS[kind].example_axes(sensor)


def everything(kind):
    """Return a model with every sensor of a world, and a constant that drives its motors."""
    model, world = dd.Model("embodied"), WORLDS[kind].example()
    for sensor in world.sensors:
        model.add(Sensor(f"see {sensor}", example_axes(kind, sensor), sensor))
    for k, (motor, signal) in enumerate(world.motors.items()):
        axes = [Axis(f"a{d}", 0, n - 1, n) for d, n in enumerate(signal.shape or ())]
        name, strength = f"push {motor}", 300.0 + 100 * k
        push = model.add(
            dd.GaussianStimulus(name, axes, center=0, sigma=1, amplitude=strength)
            if axes
            else Boost(name, [], strength)
        )
        model.connect(push, model.add(Motor(f"move {motor}", axes, motor)))
    return model


def step_of(kind):
    """Return half the period of a world, so that it takes two steps; 1 if the world never changes."""
    period = WORLDS[kind].example().period
    return 1.0 if period is None else period / 2
