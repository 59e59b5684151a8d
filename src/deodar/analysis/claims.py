"""Claims: figures and sentences that a run checks, each computed from it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from typing import Any, Literal

from deodar import codec
from deodar.errors import AnalysisError

ClaimKind = Literal["required", "reported"]
Origin = Literal["printed", "read off a figure", "ours", "none"]
"""Where a target comes from: the text of the paper prints it (a tolerance round it may be ours, and the
target then says so); it was read off a figure of the paper; it is ours, although the sentence may be the
paper's; or the value has no target.
"""


@dataclass(frozen=True)
class Claim:
    """One figure or sentence that was checked.

    Attributes:
        name: what is claimed, in words.
        value: what the run gave.
        target: what it should give.
        holds: whether it does; None where n cannot decide, or where there is no target.
        kind: `required` (a target of ours, which decides the exit status) or `reported` (a sentence of a
            paper, true or not).
        source: where it comes from.
        n: number of runs it rests on.
        interval: 95 % interval of the value, or None.
        origin: where the target comes from: `printed`, `read off a figure`, `ours`, or `none` without a
            target.
        assumes: a setting of ours that the value depends on and the paper does not give, in words; empty:
            none.
        inferred: whether that setting was found by looking at this very number in earlier runs. Such a claim
            is no evidence that a reproduction succeeds, so it cannot be required.

    Raises:
        AnalysisError: the marks contradict each other.
    """

    name: str
    value: Any
    target: Any
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
    """The required claims that are false: they decide the exit status."""
    return [c for c in claims if c.kind == "required" and c.holds is False]


def results(claims: Sequence[Claim], settings: Mapping[str, Any]) -> str:
    """The content of `results.json`."""
    return codec.text({"claims": [asdict(c) for c in claims], "settings": dict(settings)}) + "\n"
