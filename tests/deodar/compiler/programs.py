"""Programs and plans for tests."""

from __future__ import annotations

from typing import Any

import deodar as dd
from deodar.compiler.build import Build
from deodar.compiler.device import find
from deodar.compiler.division import Distribution
from deodar.compiler.dynamics import Dynamics
from deodar.compiler.executable import Executable
from deodar.compiler.plan import Plan, plan


def executable(model: dd.Model, **choices: Any) -> Executable:
    """Return the program of a model; `choices` are those of a `Build`."""
    return Dynamics(model, Build(model.document, **choices)).compiled()


def divided(model: dd.Model, count: int) -> Plan:
    """Return the plan for a number of devices, which need not be here."""
    return plan(Build(model.document, on=Distribution((find(),) * count, "field")))
