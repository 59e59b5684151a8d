"""The rules of the motors of a robot, applied from period to period."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from deodar.worlds._base import Signal
from deodar.worlds._motor_rule import MotorRule


class MotorLimiter:
    """Keeps commands within the limits and the rate of change of their motors.

    Args:
        motors: signals of the motors by name.
        rules: rules by name of the motor, read at each command; a motor without one allows any command.
    """

    def __init__(self, motors: Mapping[str, Signal], rules: Mapping[str, MotorRule]) -> None:
        self._motors, self._rules = motors, rules
        self._before: dict[str, np.ndarray] = {}
        self._copies = 1

    def begin(self, copies: int = 1) -> None:
        """Begin with all motors of a number of copies at rest."""
        self._before.clear()
        self._copies = copies

    def allowed(self, motor: str, command: np.ndarray, period: float) -> np.ndarray:
        """Return the nearest command that the motor allows after its last one, a period (ms) before."""
        rule = self._rules.get(motor, MotorRule())
        self._before[motor] = value = rule.allowed(command, self._before.get(motor), period)
        return value

    def rest(self, motor: str | None = None) -> None:
        """Note that a motor has gone to rest; None: all of them."""
        if motor is None:
            self._before.clear()
        else:
            self._before.pop(motor, None)

    def keep(self) -> dict[str, np.ndarray]:
        """Return the last command of each motor; not a number where there was none.

        The form is the same in every period and whatever motors are narrowed to, so that a file and a message
        can carry it. A motor without a shape has none before its first command, and is there if it has a rate
        of change.
        """
        commands: dict[str, np.ndarray] = {}
        for motor, signal in self._motors.items():
            if signal.shape is not None or self._rules.get(motor, MotorRule()).slew is not None:
                none = np.full((self._copies, *(signal.shape or ())), np.nan)
                commands[motor] = np.asarray(self._before.get(motor, none), float)
        return commands

    def put(self, kept: Mapping[str, np.ndarray]) -> None:
        """Restore what `keep` returned, of all motors or of some; the others were at rest."""
        self._before = {motor: np.asarray(v) for motor, v in kept.items() if not np.isnan(v).any()}


def slowed(commands: Mapping[str, np.ndarray], rules: Mapping[str, MotorRule]) -> dict[str, np.ndarray]:
    """Return what `MotorLimiter.keep` returned in older versions: motors with a rate of change alone."""
    return {motor: v for motor, v in commands.items() if motor in rules and rules[motor].slew is not None}
