"""Parameters of table B.1, each varied alone."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from deodar.errors import UnknownName, did_you_mean
from deodar_papers.serial_order.parameters import TABLE, ParameterValues

PARAMETERS: Mapping[str, Callable[[float], ParameterValues]] = {
    parameter.name: parameter.values for parameter in TABLE if parameter.values is not None
}
"""For each parameter the values of the model's parameters, when it is multiplied by a factor."""


def values(parameter: str, factor: float, items: int) -> dict[str, float]:
    """Return the values of parameters of a chain of `items` items, one parameter of the table multiplied."""
    if parameter not in PARAMETERS:
        raise UnknownName(f"there is no parameter {parameter!r}", fix=did_you_mean(parameter, PARAMETERS))
    out: dict[str, float] = {}
    for path, value in PARAMETERS[parameter](factor).items():
        every = path.startswith("*.")
        names = [f"item {k}{path[1:]}" for k in range(1, items + 1)] if every else [path]
        out |= dict.fromkeys(names, value)
    return out
