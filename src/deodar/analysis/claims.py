"""Claims: figures and sentences that a run checks, each computed from it."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any, Literal


@dataclass(frozen=True)
class Claim:
    """One figure or sentence that was checked.

    Attributes:
        name: what is claimed, in words.
        value: what the run gave.
        target: what it should give.
        holds: whether it does; None where n cannot decide.
        kind: `required` (a target of ours) or `reported` (a sentence of a paper, true or not).
        source: where it comes from.
        n: number of runs it rests on.
        interval: 95 % interval of the value, or None.
    """

    name: str
    value: Any
    target: Any
    holds: bool | None
    kind: Literal["required", "reported"] = "required"
    source: str = ""
    n: int = 1
    interval: tuple[float, float] | None = None


def failed(claims: Sequence[Claim]) -> list[Claim]:
    """The required claims that are false: they decide the exit status."""
    return [c for c in claims if c.kind == "required" and c.holds is False]


def results(claims: Sequence[Claim], settings: Mapping[str, Any]) -> str:
    """The content of `results.json`."""
    return json.dumps({"claims": [asdict(c) for c in claims], "settings": dict(settings)}, indent=2, ensure_ascii=False) + "\n"
