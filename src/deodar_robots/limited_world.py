"""Worlds that keep commands within the rules of their motors, which a user may narrow."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, cast

from deodar.codec import Json, JsonObject
from deodar.worlds._base import World
from deodar.worlds._motor_rule import MotorRule


class LimitedWorld(World):
    """Base class of worlds that apply `rules` to each command before it is sent."""

    _robot_rules: Mapping[str, MotorRule] = {}
    _rules: dict[str, MotorRule]
    _narrowed: Mapping[str, MotorRule] = {}

    @property
    def rules(self) -> Mapping[str, MotorRule]:  # type: ignore[override]
        """What motors allow, by name."""
        return self._rules

    def _declare_rules(self, declared: Mapping[str, MotorRule]) -> dict[str, MotorRule]:
        """Take the rules that a robot declares, within what its motors were narrowed to before.

        Return the rules, the dictionary that `narrow` changes.
        """
        narrowed = {
            m: declared.get(m, MotorRule()).within(r.limits, r.slew, m) for m, r in self._narrowed.items()
        }
        self._robot_rules, self._rules = declared, {**declared, **narrowed}
        return self._rules

    @property
    def can_narrow(self) -> bool:
        return True

    def narrow(
        self, motor: str, limits: tuple[float, float] | None = None, slew: float | None = None
    ) -> None:
        self.require_motor(motor)
        rule = self._rules.get(motor, MotorRule()).within(limits, slew, motor)
        self._rules[motor] = rule
        self._narrowed = {**self._narrowed, motor: rule}

    def _narrowing(self) -> JsonObject:
        """Return what motors were narrowed to, as a part of `describe`; empty if none was."""
        narrowed: dict[str, Json] = {motor: rule.to_data() for motor, rule in self._narrowed.items()}
        return {"narrowed": narrowed} if narrowed else {}

    def _narrow_as(self, described: Mapping[str, Json]) -> None:
        """Narrow the motors as `describe` says."""
        narrowed = cast("Mapping[str, Mapping[str, Any]]", described.get("narrowed") or {})
        for motor, entry in narrowed.items():
            rule = MotorRule.from_data(entry, motor)
            self.narrow(motor, rule.limits, rule.slew)
