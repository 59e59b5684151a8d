"""What is tuned, as JSON: parameters, bounds, requirements and options."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from deodar.analysis.tuning.requirement import REQUIREMENTS, Requirement
from deodar.errors import DocumentError, Problem, did_you_mean
from deodar.parameters import show
from deodar.part_data import part_of

OPTIONS = ("field", "strength", "sigma", "inputs", "seed", "budget", "limit")
"""Arguments of `tune` that a file may have."""

KEYS = ("parameters", "requirements", *OPTIONS)


@dataclass(frozen=True)
class TuningFile:
    """The content of a file of requirements.

    Attributes:
        parameters: paths of the parameters.
        bounds: bounds of those that have some.
        requirements: what is required.
        options: further arguments of `tune`.
    """

    parameters: tuple[str, ...]
    bounds: Mapping[str, Any]
    requirements: tuple[Requirement, ...]
    options: Mapping[str, Any]


def tuning_file(data: Any, where: str) -> TuningFile:
    """Return the content of a file of requirements.

    `parameters` is an object of bounds by path, `[low, high]` or null; `requirements` a list of names, or of
    objects such as `{"detects": {"at": 3, "within": 0.2}}`.

    Args:
        data: the parsed JSON.
        where: name of the file, for messages.

    Raises:
        DocumentError: the content is something else; the message lists every problem.
    """
    if not isinstance(data, dict):
        raise DocumentError(f"expected an object, not {show(data)}", where=where)
    problems = [
        Problem(where, f"unknown key {key!r}", did_you_mean(key, KEYS)) for key in data if key not in KEYS
    ]
    named, listed = data.get("parameters"), data.get("requirements")
    if not isinstance(named, dict) or not named:
        fix = 'Write such as {"u.resting_level": [-8, -1], "u.kernel.0.sigma": null}'
        problems.append(Problem(where, f"parameters is {show(named)}; expected bounds by path", fix))
        named = dict[str, Any]()
    if not isinstance(listed, list) or not listed:
        fix = 'Write such as [{"detects": {"at": 3, "within": 0.2}}, "remembers"]'
        problems.append(Problem(where, f"requirements is {show(listed)}; expected a list", fix))
        listed = []
    required = [_requirement(row, f"{where}: requirements.{k}", problems) for k, row in enumerate(listed)]
    if problems:
        raise DocumentError(problems)
    return TuningFile(
        tuple(named),
        {path: ends for path, ends in named.items() if ends is not None},
        tuple(required),
        {key: data[key] for key in OPTIONS if key in data},
    )


def _requirement(row: Any, where: str, problems: list[Problem]) -> Any:
    """Return a requirement, or None with its problems added."""
    by_name = {row: {}} if isinstance(row, str) else row
    if not isinstance(by_name, dict) or len(by_name) != 1:
        problems.append(Problem(where, f"{show(row)} is no requirement", 'Write such as "remembers"'))
        return None
    ((name, values),) = by_name.items()
    if name not in REQUIREMENTS:
        problems.append(Problem(where, f"there is no {show(name)} here", did_you_mean(name, REQUIREMENTS)))
        return None
    return part_of(REQUIREMENTS[name], values, where, {}, problems)
