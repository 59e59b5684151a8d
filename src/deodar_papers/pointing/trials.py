"""Trials: scenes with all cues in sequence, and the special cases of one cycle each."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from deodar.architectures.pointing import COLOURS, CUES, SIDES
from deodar.experiments.jobs import Job
from deodar.experiments.rows import Row
from deodar_papers.pointing import photographs, sensitivity
from deodar_papers.pointing.cycle import COUNT, ON, SETTLING, Hook, PointingCycle, clear, control, run_cycle
from deodar_papers.pointing.scenes import BAND, BEYOND, SERVED, TEST, Disc, equal_pair, scene
from deodar_papers.pointing.table import SPEECH, Table

SCENES, QUICK_SCENES = 200, 20
EACH, QUICK_EACH = 50, 10
"""Scenes, and trials of each special case, whole and quick."""

BEYOND_SCENES = 50
VARIANTS: Mapping[str, Mapping[str, Any]] = {
    "grid 50 x 50 x 30": {"samples": (50, 50, 30)},
    "grid 80 x 60 x 60": {"samples": (80, 60, 60)},
    "robot six": {"robot": "six"},
    "robot four": {"robot": "four"},
}
"""Conditions with another sampling of the perceptual field, or with another arm, and nothing else."""

VARIANT_SCENES = 10
SEEN = 0.75
"""Least share of an object that the camera sees if it counts as a match; below 0.1 it counts as absent."""

HIDDEN = 0.1
DELAYS = (0.0, 0.3, 0.8)
"""Delays of the second cue, s."""

PAIRS = tuple((colour, side) for colour in COLOURS for side in SIDES)

CASES = ("equal", "same", "moved", "jumped", "removed", "pushed", "noisy", "dim")
"""Special cases: two equal matches for 2 s; the same cues twice; the target moves, jumps, is taken away and
put back; the arm is pushed; the noise of the camera is doubled; half of the light.
"""

FORCE = 60.0
"""Force of a push, N, for 0.2 s (a guess: the arm yields by some centimetres)."""

WAIT = 0.3
"""Time between detection and a change of the scene, s."""

PATH, SPEED, JUMP = 0.10, 0.06, 0.12
"""A target that moves: its way (m) and speed (m/s); a target that jumps: how far (m)."""

AWAY = 1.5
"""Duration for which a target is taken away, s."""

LONG = 2.0
"""Duration for which equal matches are watched, s."""

SLOW = {"toward the target.fastest": 0.12e-3}
"""In cases that change the scene during the reach the tool is slower, so that the reach lasts long enough."""


def jobs(quick: bool) -> list[Job]:
    """Return one job for each scene and each special case."""
    count, each = (QUICK_SCENES, QUICK_EACH) if quick else (SCENES, EACH)
    out = [_scene_job("scene", k, TEST + k) for k in range(count)]
    if not quick:
        out += [_scene_job("beyond", k, BAND + k) for k in range(BEYOND_SCENES)]
        for name in VARIANTS:
            out += [_scene_job(name, k, TEST + k) for k in range(VARIANT_SCENES)]
        for name in sensitivity.changes():
            out += [_scene_job(name, k, sensitivity.FIRST + k) for k in range(sensitivity.SCENES)]
    for photograph, _, _ in photographs.chosen():
        out += [_photograph_job(photograph.name, side, TEST) for side in SIDES]
    for case in CASES:
        out += [Job((f"{case}/{k}",), special, {"case": case, "trial": k}, 6.0) for k in range(each)]
    return out


def _scene_job(condition: str, trial: int, seed: int) -> Job:
    keys = tuple(f"{condition}/{trial} {name}" for name in ("camera", *CUES, *(" ".join(p) for p in PAIRS)))
    return Job(keys, whole_scene, {"condition": condition, "trial": trial, "seed": seed}, 20.0)


def _photograph_job(name: str, side: str, seed: int) -> Job:
    keys = tuple(f"photograph/{name} {side} {colour} {where}" for colour, where in PAIRS)
    return Job(keys, photographs.watch, {"name": name, "side": side, "seed": seed}, 8.0)


def whole_scene(condition: str, trial: int, seed: int) -> list[Row]:
    """Run a scene: the camera alone, each cue alone, and all pairs of cues in random order, without a reset.

    Args:
        condition: name of the condition.
        trial: number of the scene.
        seed: seed of the scene, of the order, and of all noise.
    """
    random = np.random.default_rng(seed + 1_000_000)
    served = BEYOND if condition == "beyond" else SERVED
    changed = sensitivity.changes().get(condition)
    at = _table(scene(seed, served=served), seed, changed, **VARIANTS.get(condition, {}))
    base = {"condition": condition, "trial": trial}
    rows: list[Row] = [{**base, "key": f"{condition}/{trial} camera", **_row(control(at))}]
    rows += [{**base, "key": f"{condition}/{trial} {cue}", **_row(control(at, [cue]))} for cue in CUES]
    for n in random.permutation(len(PAIRS)):
        pair = PAIRS[n]
        seen = {d.name: at.seen(d.name) for d in at.discs.values() if (d.colour, d.side) == pair}
        cues = list(pair) if random.random() < 0.5 else list(pair)[::-1]
        done = run_cycle(at, cues, float(random.choice(DELAYS)))
        counts = {
            "matches": sum(share >= SEEN for share in seen.values()),
            "hidden": sum(HIDDEN < share < SEEN for share in seen.values()),
        }
        rows.append(
            {**base, "key": f"{condition}/{trial} {' '.join(pair)}", **counts, **_row(done, pair, at.discs)}
        )
        if "rest" not in done.events:
            clear(at)
    return rows


def special(case: str, trial: int) -> list[Row]:
    """Run a special case."""
    pair, seed = PAIRS[trial % len(PAIRS)], TEST + 1000 * (CASES.index(case) + 1) + trial
    discs = equal_pair(seed, *pair) if case == "equal" else scene(seed, [pair], 4, alone=True)
    world = {"noisy": {"pixel_noise": 0.06}, "dim": {"light": 0.5}}.get(case, {})
    slow = SLOW if case in ("moved", "jumped", "removed", "pushed") else {}
    at = _table(discs, seed, slow, settings=world)
    control(at)
    row: Row = {"key": f"{case}/{trial}", "condition": case, "trial": trial}
    if case == "same":
        run_cycle(at, pair)
    hook, seen = _hook(case, discs[0])
    if case == "equal":
        return [{**row, **_row(_held(at, pair), pair, at.discs)}]
    done = run_cycle(at, pair, hook=hook, longest=12.0, no_match=4.0)
    return [{**row, **seen, **_row(done, pair, at.discs)}]


def _held(at: Table, pair: Sequence[str]) -> PointingCycle:
    """Hold both cues without the condition of satisfaction, so that selection is watched for a while."""
    at.session.set("target strength.factor", 0.0)
    done, dt = PointingCycle(), at.session.dt / 1000
    for k in range(round((LONG + 1.0) / dt)):
        at.say(pair if k < SPEECH else ())
        now = at.step()
        done.highest = max(done.highest, now.perceptual)
        if now.perceptual > ON:
            done.events.setdefault("detection", k * dt)
        detected = done.events.get("detection")
        if detected is not None and k % COUNT == 0 and k * dt > detected + SETTLING:
            peaks = at.peaks()
            done.peaks = max(done.peaks, len(peaks))
            done.two += COUNT * dt * (len(peaks) > 1)
            if done.peak is None and peaks:
                done.peak, done.object = peaks[0], at.nearest(peaks[0])
            if k * dt > detected + LONG:
                break
    return done


def _hook(case: str, target: Disc) -> tuple[Hook | None, dict[str, Any]]:
    """Return what changes the scene during the reach, and what is seen of it, filled in on the way."""
    seen: dict[str, Any] = {}
    side = -1 if target.y > 0.3 else 1

    def change(at: Table, time: float, events: Mapping[str, float]) -> None:
        since = time - events["detection"] - WAIT if "detection" in events else -1.0
        if since < 0 or ("satisfaction" in events and case != "removed"):
            if case == "pushed" and "pushed" in seen:
                at.world.push("link 5", (0.0, 0.0, 0.0))
            return
        if case == "moved":
            way = min(PATH, since * SPEED)
            at.put(replace(target, y=target.y + side * way))
            seen["way"] = way
        elif case == "jumped" and "way" not in seen:
            at.put(replace(target, y=target.y + side * JUMP))
            seen["way"] = JUMP
        elif case == "pushed":
            at.world.push("link 5", (FORCE * (1 if target.x < 0 else -1) * (since < 0.2), 0.0, 0.0))
            seen["pushed"] = True
        elif case == "removed":
            _take_away(at, since, seen, target)

    return (change if case in ("moved", "jumped", "removed", "pushed") else None), seen


def _take_away(at: Table, since: float, seen: dict[str, Any], target: Disc) -> None:
    tool = at.world.tool()[:2]
    if "taken" not in seen:
        at.take(target.name)
        seen["taken"], seen["gone"], seen["drift"] = since, None, None
    elif target.name not in at.discs:
        if at.activation.max() < 0:
            seen["gone"] = since if seen["gone"] is None else seen["gone"]
            still = seen.setdefault("still", tool)
            seen["drift"] = float(np.hypot(tool[0] - still[0], tool[1] - still[1]))
        else:
            seen["gone"] = None
        if since > AWAY:
            seen["cues on"] = at.cues_on()
            at.put(target)
            seen.pop("still", None)


def _table(
    discs: Sequence[Disc], seed: int, values: Mapping[str, float | np.ndarray] | None, **others: Any
) -> Table:
    """Open a table with values of parameters of the model by path."""
    at = Table(discs, seed, **others)
    for path, value in (values or {}).items():
        at.session.set(path, value)
    return at


def _row(
    done: PointingCycle, pair: Sequence[str] | None = None, discs: Mapping[str, Disc] | None = None
) -> dict[str, Any]:
    """Return a cycle as plain data."""
    row: dict[str, Any] = {"highest": round(done.highest, 3), "peaks": done.peaks, "moved": done.moved}
    if pair is None:
        return row
    found = done.object
    now = None if found is None or discs is None else discs.get(found.name)
    return row | {
        "events": {name: round(time, 3) for name, time in done.events.items()},
        "ordered": done.ordered,
        "two": round(done.two, 3),
        "right": found is not None and [found.colour, found.side] == list(pair),
        "object": None if found is None else found.to_data(),
        "radius": None if now is None else now.radius,
        "peak": None if done.peak is None else [done.peak.x, done.peak.y, done.peak.hue, done.peak.volume],
        "miss": done.miss,
        "miss_after": done.miss_after,
    }
