"""Runs: a seed of a condition learns, its map is tested, and the gain of its camera is changed."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from deodar.architectures.looking import REACH, SAMPLES, shifts
from deodar.experiments.jobs import Job
from deodar.experiments.rows import Row
from deodar_papers.looking.conditions import AFTER, CHANGED, TESTS, LearningRun, after, conditions
from deodar_papers.looking.gazes import STEP, Learned, learn, observed, summary, test
from deodar_robots.eye.eye import PAN_TILT, Eye
from deodar_robots.eye.pan_tilt import PanTilt

COST = 0.05
"""Approximate duration of a gaze, s."""

SHOWN_FOR, SHOWN_EVERY = 20.0, 5
"""Seconds at the beginning and at the end of a run whose motor variables are stored, and their stride."""


def jobs(quick: bool) -> list[Job]:
    """Return one job for each seed of each condition, the longest first."""
    found = [
        Job(
            _keys(name, seed, condition),
            run,
            {"condition": name, "seed": seed, "quick": quick},
            _cost(condition),
        )
        for name, condition in conditions(quick).items()
        for seed in condition.seeds
    ]
    return sorted(found, key=lambda job: -job.cost)


def run(condition: str, seed: int, quick: bool) -> Sequence[Row]:
    """Learn with one seed, and return a row for each test of the map."""
    what = conditions(quick)[condition]
    model = observed(what.mechanism, seed=seed, **what.settings)
    learned = learn(model, Eye(), seed, what.marks)
    out = [
        _row(after(condition, mark), seed, mark, _errors(what, learned.maps[mark], seed))
        | _learned(learned, mark)
        for mark in what.marks
    ]
    out[-1] |= course(learned) | projections(learned.maps[what.last])
    if what.changes:
        for gain in CHANGED:
            out += _changed(condition, seed, gain, learned.maps[what.last], what)
    return out


def _changed(condition: str, seed: int, gain: float, weights: np.ndarray, what: LearningRun) -> list[Row]:
    """Change the gain of the camera, test the map at once, and learn further."""
    changed = PanTilt(gain=gain * PAN_TILT.gain)
    model = observed(what.mechanism, seed=seed, weights=weights)
    learned = learn(model, Eye(pan_tilt=changed), seed + 1000, AFTER)
    maps = {0: weights, **learned.maps}
    return [
        _row(after(condition, mark, gain), seed, mark, _errors(what, maps[mark], seed, changed))
        for mark in (0, *AFTER)
    ]


def _errors(what: LearningRun, weights: np.ndarray, seed: int, pan_tilt: PanTilt = PAN_TILT) -> np.ndarray:
    """Test a map."""
    return test(what.mechanism, weights, seed, TESTS, pan_tilt, SAMPLES)


def _row(condition: str, seed: int, mark: int, errors: np.ndarray) -> dict[str, Any]:
    return {
        "key": f"{condition}/{seed}",
        "condition": condition,
        "seed": seed,
        "gazes": mark,
        **summary(errors),
        "errors": [None if np.isnan(e) else round(float(e), 1) for e in errors],
    }


def _learned(learned: Learned, mark: int) -> dict[str, Any]:
    """Return the simulated time of a number of gazes, and the median distance after the last 200 of them."""
    late = learned.arrivals[max(0, mark - 200) : mark]
    return {
        "seconds": round(float(learned.ends[mark - 1]) * STEP / 1000, 2),
        "arrivals": round(float(np.median(late)), 2),
    }


def course(learned: Learned) -> dict[str, Any]:
    """Return command and pose of both motors at the beginning and at the end of the run, and the target."""
    n = int(SHOWN_FOR * 1000 / STEP)
    signals = learned.signals
    whole = np.concatenate([signals["pose"], signals["target"], signals["shift"]], axis=1)
    return {
        "course": {
            name: np.round(whole[part][::SHOWN_EVERY], 1).tolist()
            for name, part in (("begin", slice(0, n)), ("end", slice(-n, None)))
        }
    }


def projections(weights: np.ndarray) -> dict[str, Any]:
    """Return where the map sends each visual sample: the mean shift by its weights, servo units; and the map
    summed over row and tilt, and over column and pan.
    """
    pan, tilt = shifts()
    mass = weights.sum(axis=(0, 1))
    mean = [
        np.einsum("ptcr,p->cr", weights, pan.points) / np.maximum(mass, 1e-6),
        np.einsum("ptcr,t->cr", weights, tilt.points) / np.maximum(mass, 1e-6),
    ]
    return {
        "map": {
            "pan": np.round(weights.sum(axis=(1, 3)), 2).tolist(),
            "tilt": np.round(weights.sum(axis=(0, 2)), 2).tolist(),
            "shifts": np.round(np.stack(mean, axis=-1) / REACH, 3).tolist(),
        }
    }


def _keys(name: str, seed: int, condition: LearningRun) -> tuple[str, ...]:
    changed = [after(name, mark, gain) for gain in CHANGED for mark in (0, *AFTER)]
    own = [after(name, mark) for mark in condition.marks]
    return tuple(f"{test}/{seed}" for test in (*own, *(changed if condition.changes else [])))


def _cost(condition: LearningRun) -> float:
    return COST * (condition.last + (len(CHANGED) * AFTER[-1] if condition.changes else 0))
