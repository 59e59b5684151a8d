"""What is tuned, as JSON: parameters, bounds, requirements and options."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from deodar.analysis.tuning import instabilities, peak_form
from deodar.analysis.tuning.requirement import Requirement
from deodar.errors import DocumentError, did_you_mean
from deodar.parameters import show

REQUIREMENTS: Mapping[str, Callable[..., Requirement]] = {
    call.__name__: call
    for call in (
        instabilities.detects,
        instabilities.reverse,
        instabilities.remembers,
        instabilities.forgets,
        instabilities.rests,
        instabilities.relaxes_within,
        peak_form.selects,
        peak_form.multi_peak,
        peak_form.peak_width,
        peak_form.peak_amplitude,
    )
}
"""The requirements of deodar by their names."""

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
        DocumentError: the content is something else.
    """
    if not isinstance(data, dict):
        raise DocumentError(f"expected an object, not {show(data)}", where=where)
    for key in data:
        if key not in KEYS:
            raise DocumentError(f"unknown key {key!r}", where=where, fix=did_you_mean(key, KEYS))
    named, listed = data.get("parameters"), data.get("requirements")
    if not isinstance(named, dict) or not named:
        fix = 'Write such as {"u.resting_level": [-8, -1], "u.kernel.0.sigma": null}'
        raise DocumentError(f"parameters is {show(named)}; expected bounds by path", where=where, fix=fix)
    if not isinstance(listed, list) or not listed:
        fix = 'Write such as [{"detects": {"at": 3, "within": 0.2}}, "remembers"]'
        raise DocumentError(f"requirements is {show(listed)}; expected a list", where=where, fix=fix)
    return TuningFile(
        tuple(named),
        {path: ends for path, ends in named.items() if ends is not None},
        tuple(_requirement(entry, where) for entry in listed),
        {key: data[key] for key in OPTIONS if key in data},
    )


def _requirement(entry: Any, where: str) -> Requirement:
    call_by_name = {entry: {}} if isinstance(entry, str) else entry
    if not isinstance(call_by_name, dict) or len(call_by_name) != 1:
        raise DocumentError(f"{show(entry)} is no requirement", where=where, fix='Write such as "remembers"')
    ((name, values),) = call_by_name.items()
    if name not in REQUIREMENTS:
        raise DocumentError(
            f"unknown requirement {name!r}", where=where, fix=did_you_mean(name, REQUIREMENTS)
        )
    call = REQUIREMENTS[name]
    parameters = inspect.signature(call).parameters
    if not isinstance(values, dict):
        raise DocumentError(f"{name} has {show(values)}; expected values by name", where=where)
    for key in values:
        if key not in parameters:
            raise DocumentError(
                f"{name} has no value {key!r}", where=where, fix=did_you_mean(key, parameters)
            )
    for key, parameter in parameters.items():
        if parameter.default is inspect.Parameter.empty and key not in values:
            raise DocumentError(f"{name} lacks the value {key!r}", where=where)
    return call(**values)
