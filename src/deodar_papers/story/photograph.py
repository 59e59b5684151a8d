"""The second act: what a cue does on a photograph, read from the run of the saliency model, in words."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from deodar.architectures.saliency import CUE_AT, SIDE
from deodar_papers.saliency.scenes import NEAR, Outcome, SceneResult, photographs, run_scene

PHOTOGRAPH = "coffee"
THINGS = {"red": "the saucer", "light brown": "the coffee"}
"""What a present colour belongs to, shorter than in the marks of the photograph."""

ABSENT_AT = 2000.0
"""Time from which on it is spoken that there is no peak, ms: a peak appears 1.2 s after its cue."""


@dataclass(frozen=True)
class CueCourse:
    """What one cue did.

    Attributes:
        name: the colour.
        target: what has this colour in the photograph; "" if nothing has.
        outcome: the end, judged by the marks of the photograph.
        begins: number of the first sample with the cue.
        appears: the sample from which on the spatial field has a peak until the end; None: it has none.
        turns: the sample at which the motor variable has begun to move; None: it stays.
        judged: the sample at which the missing peak is stated.
        spatial: activation of the spatial field over time, x and y.
        colour: activation of the colour field over time and hue.
        motor: the motor variable over time: x and y in units of the scene.
    """

    name: str
    target: str
    outcome: Outcome
    begins: int
    appears: int | None
    turns: int | None
    judged: int
    spatial: np.ndarray
    colour: np.ndarray
    motor: np.ndarray

    @property
    def peaks(self) -> int:
        """Number of peaks of the spatial field at the end."""
        return len(self.outcome.spatial)

    @property
    def selects(self) -> bool:
        """Whether there is one peak, on the object of the cued colour."""
        return bool(self.target) and self.outcome.right


def run(seed: int) -> SceneResult:
    """Run the cues on the photograph as one batch."""
    [scene] = [scene for scene in photographs() if scene.name == PHOTOGRAPH]
    return run_scene(scene, seed)


def courses(scene: SceneResult) -> Sequence[CueCourse]:
    """Return what each cue did."""
    record = scene.record
    times = record["time"].values
    begins, judged = (int(np.searchsorted(times, at)) for at in (CUE_AT, ABSENT_AT))
    all_courses: list[CueCourse] = []
    for k, outcome in enumerate(scene.outcomes):
        cue = record.isel({"cue.center": k})
        spatial = cue["spatial.activation"].transpose("time", "x", "y").values
        motor = np.stack([cue[f"{name}.output"].values for name in ("pan", "tilt")], axis=1)
        appears = _appears(spatial.max((1, 2)) > 0) if outcome.spatial else None
        moved = np.hypot(*(motor - SIDE / 2).T) > NEAR
        all_courses.append(
            CueCourse(
                name=outcome.cue.name,
                target=THINGS[outcome.cue.name] if outcome.cue.expect == "present" else "",
                outcome=outcome,
                begins=begins,
                appears=appears,
                turns=int(np.argmax(moved)) if moved.any() else None,
                judged=judged,
                spatial=spatial,
                colour=cue["colour.activation"].transpose("time", "hue").values,
                motor=motor,
            )
        )
    return all_courses


def _appears(up: np.ndarray) -> int:
    """Return the sample from which on something is true until the end."""
    false = np.flatnonzero(~up)
    return int(false[-1]) + 1 if len(false) else 0


def label(course: CueCourse) -> str:
    """Return what the video writes below a cue when it is decided."""
    if course.selects:
        return f"peak on {course.target}"
    if not course.peaks:
        return "no peak"
    return "peak elsewhere" if course.peaks == 1 else f"{course.peaks} peaks"


def sentences(course: CueCourse) -> Sequence[tuple[int, str]]:
    """Return the sentences of the video for one cue, each with the sample at which it begins."""
    spoken = [(0, f"Cue: {course.name}.")]
    if course.appears is not None:
        spoken.append((course.appears, _rises(course)))
        if course.turns is not None and course.outcome.converged:
            spoken.append((max(course.turns, course.appears + 5), "The motor variable turns to it."))
    elif course.target:
        spoken.append((course.judged, "No peak rises this time."))
    else:
        stays = ", and the arrow stays" if course.outcome.converged else ""
        spoken.append((course.judged, f"Nothing here is {course.name}: no peak{stays}."))
    return spoken


def _rises(course: CueCourse) -> str:
    if course.selects:
        return f"One peak rises, on {course.target}."
    if course.peaks > 1:
        return f"{course.peaks} peaks rise this time."
    if course.target:
        return f"One peak rises, this time not on {course.target}."
    return f"One peak rises, though nothing here is {course.name}."


def summary(cues: Sequence[CueCourse]) -> str:
    """Return the sentence of the first and the last picture."""
    if all(course.outcome.right for course in cues):
        return "A peak for a colour that is there, none for one that is not."
    return "One photograph, three cues: this time not all select their colour."


def verdict(course: CueCourse) -> str:
    """Return the line of the terminal for one cue."""
    if course.selects:
        peak = f"one peak, on {course.target}"
    elif course.peaks == 1:
        peak = f"one peak, not on {course.target}" if course.target else "not in the picture, but one peak"
    elif course.peaks:
        peak = f"{course.peaks} peaks"
    else:
        peak = "no peak" if course.target else "not in the picture: no peak"
    if course.peaks:
        motor = "turns to it" if course.outcome.converged else "does not reach it"
    else:
        motor = "stays" if course.outcome.converged else "moves"
    return f"{peak}{',' if not course.peaks else ';'} the motor variable {motor}"
