"""Trials: all cues of a photograph as one batch, and the row of each cue."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from deodar.experiments.jobs import Job
from deodar.experiments.rows import Row
from deodar_papers.saliency.scenes import CueScene, Found, Outcome, photographs, run_scene

COST = 15.0
"""Approximate duration of a photograph, s."""

MEASURED = ("places", "spatial_places", "spatial", "motor", "gap", "moved")
"""Entries of a row that are attributes of an `Outcome`."""


def scenes(quick: bool) -> list[CueScene]:
    """Return the tuned photographs, and without `quick` also the untuned ones."""
    return [*photographs(), *([] if quick else photographs(untuned=True))]


def jobs(quick: bool) -> list[Job]:
    """Return one job for each photograph."""
    return [Job(_keys(s), photograph, {"name": s.name, "untuned": not s.tuned}, COST) for s in scenes(quick)]


def photograph(name: str, untuned: bool) -> Sequence[Row]:
    """Run a photograph and return its rows, one for each cue."""
    [scene] = [s for s in photographs(untuned) if s.name == name]
    result = run_scene(scene)
    return [
        {
            "key": key,
            "condition": name,
            "trial": k,
            "hue": o.cue.hue,
            "quiet": result.quiet,
            **{entry: getattr(o, entry) for entry in MEASURED},
        }
        for k, (key, o) in enumerate(zip(_keys(scene), result.outcomes, strict=True))
    ]


def found(rows: Mapping[str, Row], quick: bool) -> list[Found]:
    """Return the result of each photograph from its rows; a photograph without rows has no outcomes."""
    return [_found(s, [rows[key] for key in _keys(s) if key in rows]) for s in scenes(quick)]


def _found(scene: CueScene, rows: Sequence[Row]) -> Found:
    if len(rows) < len(scene.cues):
        return Found(scene)
    outcomes = tuple(
        Outcome(
            cue,
            _pairs(row["places"]),
            _pairs(row["spatial_places"]),
            _pairs(row["spatial"]),
            (row["motor"][0], row["motor"][1]),
            row["gap"],
            row["moved"],
        )
        for cue, row in zip(scene.cues, rows, strict=True)
    )
    return Found(scene, rows[0]["quiet"], outcomes)


def _pairs(places: Sequence[Sequence[float]]) -> tuple[tuple[float, float], ...]:
    return tuple((x, y) for x, y in places)


def _keys(scene: CueScene) -> tuple[str, ...]:
    return tuple(f"{scene.name}/{k}" for k in range(len(scene.cues)))
