"""One cycle of pointing: the user gives cues, and the events until everything is below threshold again."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

from deodar.architectures.pointing import CUES, USER
from deodar_papers.pointing.scenes import Disc
from deodar_papers.pointing.table import SPEECH, HuePeak, Moment, Table

ON = 1.0
"""Activation from which a peak of the perceptual field counts as detected, above fluctuations at 0."""

MOVING = 0.02
"""Speed from which the arm counts as moving, m/s."""

AFTER = 100
"""Steps after the condition of satisfaction after which the place of the tool is judged again."""

REST = 50
"""Steps of rest between two cycles."""

SETTLING = 0.1
"""Time after detection at which the selected peak is read, s, if the cycle is not over before."""

COUNT = 5
"""Steps after which the peaks are counted again."""

QUIET = 100
"""Steps of a control: the camera alone, or one cue."""

SETTLED = 30
"""Steps after which activation is judged in a control, so that the cycle before does not count."""

EVENTS = (
    *("cues", "detection", "movement", "satisfaction"),
    *("nodes off", "field off", "satisfaction off", "rest"),
)

Hook = Callable[[Table, float, Mapping[str, float]], None]
"""Called before each step with the table, the time of the cycle (s), and the events so far."""


@dataclass
class PointingCycle:
    """What happened in a cycle; times in s from the first cue, lengths in m.

    Attributes:
        events: time of each event.
        peak: the selected peak, soon after detection; None without a detection.
        object: the disc nearest to this peak.
        two: duration for which there were two peaks or more.
        peaks: largest number of peaks at once.
        miss: distance of the tool from the middle of the selected object at the condition of satisfaction.
        miss_after: the same 1 s later.
        moved: way of the tool from its start to its end.
        highest: largest activation of the perceptual field.
        settled: whether peak and object were read when the peak had its whole size.
    """

    events: dict[str, float] = field(default_factory=dict[str, float])
    peak: HuePeak | None = None
    object: Disc | None = None
    two: float = 0.0
    peaks: int = 0
    miss: float | None = None
    miss_after: float | None = None
    moved: float = 0.0
    highest: float = -math.inf
    settled: bool = False

    @property
    def ordered(self) -> bool:
        """Whether the events are those of figure 11, in this order.

        The arm may start in the step of detection, and not at all if it is there. Nodes and field go off in
        either order.
        """
        e = self.events
        if any(name not in e for name in EVENTS if name != "movement"):
            return False
        moves = e.get("movement", e["detection"])
        first = e["cues"] <= e["detection"] <= moves <= e["satisfaction"]
        last = e["satisfaction"] <= min(e["nodes off"], e["field off"]) and e["satisfaction off"] <= e["rest"]
        return first and last and max(e["nodes off"], e["field off"]) <= e["rest"]


def run_cycle(
    at: Table,
    cues: Sequence[str],
    delay: float = 0.0,
    longest: float = 8.0,
    no_match: float = 2.0,
    hook: Hook | None = None,
) -> PointingCycle:
    """Give cues, the second `delay` s after the first, and run until the cycle is over.

    Args:
        at: the table.
        cues: names of cue nodes.
        delay: s.
        longest: s after which a cycle ends that is not over.
        no_match: s after the last cue, from which on a cycle without a peak is over.
        hook: changes the scene during the cycle.
    """
    done, dt = PointingCycle(), at.session.dt / 1000
    nodes = [CUES.index(name) for name in cues]
    start = before = at.world.tool()[:2]
    rest_since: float | None = None
    k = 0
    while k * dt < longest:
        time = k * dt
        spoken = [c for n, c in enumerate(cues) if n * delay <= time < n * delay + SPEECH * dt - 1e-9]
        at.say(spoken)
        if hook is not None:
            hook(at, time, done.events)
        now = at.step()
        k += 1
        time = k * dt
        speed = math.dist(now.tool, before) / dt
        before = now.tool
        _note(done, now, nodes, speed, time)
        if now.perceptual > 0 and (k % COUNT == 0 or (done.peak is None and "detection" in done.events)):
            _look(done, at, time, dt)
        since = done.events.get("satisfaction", math.inf)
        if time >= since and done.object is not None:
            miss = at.discs[done.object.name].distance(*now.tool) if done.object.name in at.discs else None
            if done.miss is None:
                done.miss = miss
            if done.miss_after is None and time >= since + AFTER * dt:
                done.miss_after = miss
        low = max(now.perceptual, now.satisfaction, now.satisfied, *now.nodes) < 0
        if low and "satisfaction off" in done.events:
            rest_since = time if rest_since is None else rest_since
            done.events.setdefault("rest", rest_since)
            if time >= max(rest_since + REST * dt, since + AFTER * dt):
                break
        last = (len(cues) - 1) * delay
        if "detection" not in done.events and now.perceptual < 0 and time >= last + no_match:
            break
    done.moved = math.dist(start, before)
    at.say([])
    return done


def _note(done: PointingCycle, now: Moment, nodes: Sequence[int], speed: float, time: float) -> None:
    """Store the events of a step."""
    events = done.events
    done.highest = max(done.highest, now.perceptual)
    if all(now.nodes[n] > 0 for n in nodes):
        events.setdefault("cues", time)
    if now.perceptual > ON:
        events.setdefault("detection", time)
    if "detection" in events and speed > MOVING:
        events.setdefault("movement", time)
    if "detection" in events and now.satisfied > 0:
        events.setdefault("satisfaction", time)
    if "satisfaction" not in events:
        return
    if now.perceptual < 0:
        events.setdefault("field off", time)
    if max(now.nodes) < 0:
        events.setdefault("nodes off", time)
    if "field off" in events and max(now.satisfaction, now.satisfied) < 0:
        events.setdefault("satisfaction off", time)


def _look(done: PointingCycle, at: Table, time: float, dt: float) -> None:
    """Count the peaks, and store the selected one."""
    peaks = at.peaks()
    done.peaks = max(done.peaks, len(peaks))
    done.two += dt * (COUNT if len(peaks) > 1 else 0)
    detected = done.events.get("detection")
    if peaks and detected is not None and "satisfaction" not in done.events and not done.settled:
        done.peak, done.object = peaks[0], at.nearest(peaks[0])
        done.settled = time > detected + SETTLING


def control(at: Table, cues: Sequence[str] = (), clears: bool = True) -> PointingCycle:
    """Give no cue, or one, for a second, and return the activation and peaks of that time; with `clears`
    the cue is cleared again.
    """
    done, dt = PointingCycle(), at.session.dt / 1000
    start = at.world.tool()[:2]
    for k in range(QUIET):
        at.say(cues if k < SPEECH else ())
        now = at.step()
        if k >= SETTLED:
            done.highest = max(done.highest, now.perceptual)
        if now.perceptual > 0 and k % COUNT == 0:
            found = len(at.peaks())
            done.peaks, done.two = max(done.peaks, found), done.two + dt * COUNT * (found > 1)
    done.moved = math.dist(start, at.world.tool()[:2])
    if cues and clears:
        clear(at)
    return done


def clear(at: Table) -> None:
    """Switch all cue nodes off, as a user does after a cue that led to nothing."""
    for k in range(60):
        at.say(CUES if k < 30 else (), -USER)
        at.step()
    at.say(())
