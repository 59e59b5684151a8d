"""Claims: numbers and statements that are computed from a run and compared with a target."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from typing import Literal

from deodar import codec
from deodar.codec import Json
from deodar.errors import AnalysisError

ClaimKind = Literal["required", "reported"]
Origin = Literal["printed", "read off a figure", "ours", "none"]
"""The origin of a target: printed in the paper's text (the target states a tolerance that deodar adds); read
off a figure of the paper; deodar's own, although the statement may be the paper's; or no target.
"""


@dataclass(frozen=True)
class Claim:
    """One number or statement that a run checks.

    Attributes:
        name: the claim, in words.
        value: the value from the run.
        target: the expected value.
        holds: whether the value meets the target; None if n runs cannot decide, or without a target.
        kind: `required` (a target of deodar, which decides the exit status) or `reported` (a statement of a
            paper, true or false).
        source: where the target is stated, such as a section of the paper.
        n: number of runs from which the value is computed.
        interval: 95 % interval of the value, or None.
        origin: origin of the target: `printed`, `read off a figure`, `ours`, or `none` without a
            target.
        assumes: a setting that the value depends on and that the paper does not state, in words; empty:
            none.
        inferred: whether that setting was chosen from this same number in earlier runs. Such a claim
            is no evidence that a reproduction succeeds, so it cannot be required.

    Raises:
        AnalysisError: if the attributes contradict each other.
    """

    name: str
    value: Json
    target: Json
    holds: bool | None
    kind: ClaimKind = "required"
    source: str = ""
    n: int = 1
    interval: tuple[float, float] | None = None
    origin: Origin = field(kw_only=True)
    assumes: str = field(default="", kw_only=True)
    inferred: bool = field(default=False, kw_only=True)

    def __post_init__(self) -> None:
        if self.inferred and self.kind == "required":
            raise AnalysisError(
                "a setting was inferred from this very number, so the claim cannot be required",
                where=self.name,
            )
        if self.inferred and not self.assumes:
            raise AnalysisError("inferred, but assumes does not say which setting was", where=self.name)
        if self.origin == "none" and (self.holds is not None or self.kind == "required"):
            raise AnalysisError(
                "a value without a target neither holds nor fails, and is not required", where=self.name
            )


def failed(claims: Sequence[Claim]) -> list[Claim]:
    """Return the required claims that are false; they decide the exit status."""
    return [c for c in claims if c.kind == "required" and c.holds is False]


def results(claims: Sequence[Claim], settings: Mapping[str, Json]) -> str:
    """The content of `results.json`."""
    return codec.text({"claims": [asdict(c) for c in claims], "settings": dict(settings)}) + "\n"
