"""What happened in the first act, read from its run, and the sentences that say so."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from deodar.analysis.claims import Claim
from deodar_papers.story.one_field import FieldRun

if TYPE_CHECKING:
    from deodar.analysis.regimes import Regimes

VISIBLE = 0.5
"""Smallest input that a picture shows as growing."""


@dataclass(frozen=True)
class Moments:
    """Numbers of samples at which something happened; None: it did not happen.

    Attributes:
        grows: the first input becomes visible.
        detected: the first peak appears.
        second: the second scene begins.
        compete: a peak or two appear.
        selected: of two peaks one is left, or only one has appeared, while both inputs are on.
        go: the inputs begin to fall.
        gone: the inputs are 0.
        remembered: equal to `gone`, with a peak.
        falls: the field begins to be lowered.
        forgotten: no peak is left after the field has begun to be lowered.
    """

    grows: int
    detected: int | None
    second: int
    compete: int | None
    selected: int | None
    go: int
    gone: int
    remembered: int | None
    falls: int
    forgotten: int | None


@dataclass(frozen=True)
class StripLine:
    """One of the four lines of the video: its name, what it says, and its sample."""

    name: str
    text: str
    sample: int


@dataclass(frozen=True)
class FieldThresholds:
    """The measured thresholds of the field, each with half the width of its interval.

    Attributes:
        detection: the localised input above which a peak appears.
        forgetting: the homogeneous input below which no peak outlives its input; below 0.
    """

    detection: tuple[float, float]
    forgetting: tuple[float, float]

    @classmethod
    def of(cls, measured: Regimes) -> FieldThresholds:
        """Return the thresholds that `regimes` measured."""
        pairs = []
        for name in ("detection", "forgetting"):
            transition = measured.transitions[name]
            low, high = transition.interval
            pairs.append((transition.value, abs(high - low) / 2))
        return cls(*pairs)

    @property
    def needed(self) -> str:
        """The input of detection, as the video shows it."""
        return f"{self.detection[0]:.1f}"

    @property
    def lowering(self) -> str:
        """By how much the field is lowered when it forgets, as the video shows it."""
        return f"{-self.forgetting[0]:.1f}"


def moments(run: FieldRun) -> Moments:
    """Read the moments from a run."""
    strength = run.input.max(1)
    up = run.activation.max(1) > 0
    half = run.activation.shape[1] // 2
    left, right = (side.max(1) > 0 for side in (run.activation[:, :half], run.activation[:, half:]))
    second, end = run.second, len(up)
    full = second + np.flatnonzero(strength[second:] >= strength[second:].max())
    go = int(full[-1]) + 1
    gone = _first(strength[go:] <= 0, go) or end - 1
    compete = _first(up[second:go], second)
    selected = None
    if compete is not None:
        two_peaks = compete + np.flatnonzero(left[compete:go] & right[compete:go])
        alone = int(two_peaks[-1]) + 1 if len(two_peaks) else compete
        selected = alone if alone < go else None
    falls = _first(run.lowered[gone:] < 0, gone) or end - 1
    last = falls + np.flatnonzero(up[falls:])
    return Moments(
        grows=_first(strength >= VISIBLE) or 0,
        detected=_first(up[:second]),
        second=second,
        compete=compete,
        selected=selected,
        go=go,
        gone=gone,
        remembered=gone if up[gone] else None,
        falls=falls,
        forgotten=int(last[-1]) + 1 if len(last) and last[-1] + 1 < end else None,
    )


def _first(true: np.ndarray, begin: int = 0) -> int | None:
    """Return the number of the first true sample, counted from `begin`; None if there is none."""
    return begin + int(np.argmax(true)) if true.any() else None


def summary(m: Moments) -> str:
    """Return the sentence of the first and the last picture: what the field did in this run."""
    did = {"detects": m.detected, "selects": m.selected, "remembers": m.remembered, "forgets": m.forgotten}
    verbs = [verb for verb, sample in did.items() if sample is not None]
    if not verbs:
        return "One field, and no peak this time."
    *most, last = verbs
    return f"One field: it {', '.join(most)}{' and ' if most else ''}{last}."


def events(m: Moments, measured: FieldThresholds) -> Sequence[StripLine]:
    """Return the four lines of the video."""
    if m.detected is not None:
        detection = StripLine("Detection", f"input above {measured.needed}", m.detected)
    else:
        detection = StripLine("No detection", "no peak this time", m.second - 1)
    if m.selected is not None:
        selection = StripLine("Selection", "two inputs, one peak", m.selected)
    else:
        selection = StripLine("No selection", "no peak" if m.compete is None else "two peaks remain", m.go)
    if m.remembered is not None:
        memory = StripLine("Memory", "stays at input 0", m.remembered)
    else:
        memory = StripLine("No memory", "goes with its input", m.gone)
    if m.forgotten is not None:
        forgetting = StripLine("Forgetting", f"lowered by {measured.lowering}", m.forgotten)
    else:
        forgetting = StripLine(
            "No forgetting", "no peak" if m.remembered is None else "the peak stays", m.falls
        )
    return [detection, selection, memory, forgetting]


def sentences(m: Moments, measured: FieldThresholds) -> Sequence[tuple[int, str]]:
    """Return the sentences of the video, each with the sample at which it begins.

    A sentence grows when what it announces has happened; until then nothing is claimed.
    """
    spoken = [(0, "One field at rest, below its threshold.")]
    spoken.append((m.grows, "An input grows. The field only follows it."))
    if m.detected is not None:
        spoken.append((m.detected, f"Past {measured.needed} a peak rises by itself: detection."))
    spoken.append((m.second, "Once more from rest: two equal inputs."))
    if m.compete is None:
        spoken.append((m.go, "They go, and no peak has risen this time."))
    elif m.selected is None:
        spoken += [(m.compete, "They compete"), (m.go, "They compete, and two peaks remain this time.")]
    else:
        spoken += [(m.compete, "They compete"), (m.selected, "They compete, and one wins: selection.")]
        spoken.append((m.go, "The inputs go."))
    if m.remembered is not None:
        stays = "The peak stays" if m.selected is not None else "A peak stays"
        spoken += [(m.gone, f"The inputs go. {stays}: memory."), (m.falls, "The field is lowered")]
    elif m.compete is not None:
        spoken.append((m.gone, "The inputs go, and no peak outlives them this time."))
    if m.forgotten is not None:
        spoken.append((m.forgotten, "The field is lowered, and the peak is gone: forgetting."))
    return spoken


def verdicts(m: Moments, measured: FieldThresholds) -> Sequence[tuple[str, str]]:
    """Return the four lines of the terminal: the name of each, and what was measured and happened."""
    (up, up_width), (down, down_width) = measured.detection, measured.forgetting
    selection = {
        (True, True): "of two equal inputs one makes a peak",
        (True, False): "of two equal inputs both keep a peak in this run",
        (False, False): "of two equal inputs none makes a peak in this run",
    }[m.compete is not None, m.selected is not None]
    return [
        (
            "detection",
            f"a peak rises when the input exceeds {up:.2f} ± {up_width:.2f}"
            + ("" if m.detected is not None else "; not in this run"),
        ),
        ("selection", selection),
        (
            "memory",
            "the peak stays when its input goes"
            if m.remembered is not None
            else "no peak outlives its input in this run",
        ),
        (
            "forgetting",
            f"it is gone when the field is lowered by {-down:.3f} ± {down_width:.3f}"
            + ("" if m.forgotten is not None else "; not in this run"),
        ),
    ]


def claims(m: Moments, measured: FieldThresholds) -> list[Claim]:
    """Return the four verdicts as claims; noise decides them, so none is required."""
    happened = (m.detected, m.selected, m.remembered, m.forgotten)
    measured_values = (measured.detection[0], None, None, measured.forgetting[0])
    return [
        Claim(f"one field, {name}: {says}", threshold, "it happens", k is not None, "reported", origin="ours")
        for (name, says), threshold, k in zip(verdicts(m, measured), measured_values, happened, strict=True)
    ]
