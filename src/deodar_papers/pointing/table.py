"""The architecture at the table: a session with a scene, its user, and what is observed in each step."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy import ndimage

from deodar.architectures.pointing import CUES, SAMPLES, USER, pointing, table
from deodar.model.model import Model
from deodar.numerics.axes import cell
from deodar.session.port_reader import port_reader
from deodar.session.session import Session
from deodar.worlds._base import World
from deodar.worlds._settings import arguments
from deodar.worlds.combined import Combined
from deodar_papers.pointing.scenes import Disc
from deodar_robots.mujoco.mujoco import MuJoCo

CAMERA = "camera"
PIXEL_NOISE, TOOL_NOISE = 0.03, 0.002
"""Standard deviations of the noise of the camera, and of the measured place of the tool (m)."""

SPEECH = 40
"""Steps for which the user holds a cue."""

LEAST_PEAK = 0.06
"""Smallest volume of a peak, m2 deg: a tenth of that of a peak; fewer samples are noise at the threshold."""

HEIGHT = 0.01
"""Height of the discs, m."""


@dataclass(frozen=True)
class Moment:
    """What is observed after a step.

    Attributes:
        time: ms since the start of the session.
        perceptual: largest activation of the perceptual field.
        satisfaction: largest activation of the CoS field.
        satisfied: activation of the CoS node.
        nodes: activation of each cue node, in the order of `CUES`.
        tool: true x and y of the tool, m.
    """

    time: float
    perceptual: float
    satisfaction: float
    satisfied: float
    nodes: tuple[float, ...]
    tool: tuple[float, float]


@dataclass(frozen=True)
class HuePeak:
    """A connected region of the perceptual field above threshold.

    Attributes:
        x, y: its middle, m.
        hue: its middle, degrees.
        volume: m2 deg.
    """

    x: float
    y: float
    hue: float
    volume: float


class Table:
    """A session of the architecture in a scene; `camera` is a world that is seen in place of it.

    Attributes:
        world: the table.
        session: the session.
        discs: the objects of the scene by name.
        samples: samples of the perceptual field.
        activation: activation of the perceptual field after the last step.
        watch: called after each step.
    """

    def __init__(
        self,
        discs: Sequence[Disc],
        seed: int,
        samples: Sequence[int] = SAMPLES,
        settings: Mapping[str, float] | None = None,
        model: Model | None = None,
        robot: str | None = None,
        camera: World | None = None,
    ) -> None:
        given: dict[str, Any] = {"pixel_noise": PIXEL_NOISE, "tool_noise": TOOL_NOISE, **(settings or {})}
        self.world = MuJoCo("table", robot, **arguments(MuJoCo, given))
        self.discs: dict[str, Disc] = {}
        for disc in discs:
            self.put(disc)
        self.samples = tuple(samples)
        self.model = _architecture(self.samples) if model is None else model
        seen = self.world if camera is None else Combined(self.world, {CAMERA: camera})
        self.session = Session(self.model, world=seen, seed=seed)
        self._said: dict[str, float] = {}
        self._places = [
            (self.model["perceptual"].id, "activation"),
            (self.model["satisfaction"].id, "activation"),
            (self.model["satisfied"].id, "activation"),
            *((self.model[name].id, "activation") for name in CUES),
        ]
        self._reader = port_reader(self.session.program, self._places)
        self.activation = np.zeros(self.samples)
        self.watch: Callable[[Moment], None] | None = None

    # ---------------------------------------------------------------------------------------------- the scene

    def put(self, disc: Disc) -> None:
        """Place a disc, or move the one of this name."""
        if disc.name in self.discs and self.discs[disc.name].radius == disc.radius:
            self.world.move(disc.name, (disc.x, disc.y))
        else:
            size = (2 * disc.radius, 2 * disc.radius)
            self.world.place(disc.name, (disc.x, disc.y), size, disc.rgb, height=HEIGHT)
        self.discs[disc.name] = disc

    def take(self, name: str) -> Disc:
        """Remove a disc."""
        self.world.remove(name)
        return self.discs.pop(name)

    def seen(self, name: str) -> float:
        """Return the share of a disc that the camera sees."""
        return self.world.visible(name, CAMERA)

    # ----------------------------------------------------------------------------------------------- the user

    def say(self, cues: Sequence[str], level: float = USER) -> None:
        """Hold the user's input to these cues at a level, and to the others at 0."""
        for name in CUES:
            wanted = level if name in cues else 0.0
            if self._said.get(name, 0.0) != wanted:
                self.session.set(f"say {name}.amplitude", wanted)
                self._said[name] = wanted

    def step(self) -> Moment:
        """Take one step of 10 ms."""
        session = self.session
        session.step()
        arrays = session.read_ports(self._reader, self._places)
        u, c, s, *nodes = (np.asarray(arrays[place]) for place in self._places)
        self.activation = u
        x, y, _ = self.world.tool()
        levels = tuple(float(n) for n in nodes)
        now = Moment(session.time, float(u.max()), float(c.max()), float(s), levels, (x, y))
        if self.watch is not None:
            self.watch(now)
        return now

    def cues_on(self) -> int:
        """Return how many cue nodes are on."""
        return sum(float(np.asarray(self.session.read(f"{name}.activation"))) > 0 for name in CUES)

    def peaks(self) -> list[HuePeak]:
        """Return the peaks of the perceptual field, the largest first."""
        if not (self.activation > 0).any():
            return []
        axes = table(self.samples)
        found: Any = ndimage.label(self.activation > 0, structure=np.ones((3, 3, 3)))
        labels, count = found
        # hue is a ring: regions at both ends of the array are one
        for a, b in set(
            zip(labels[:, :, 0].ravel().tolist(), labels[:, :, -1].ravel().tolist(), strict=True)
        ):
            if a and b and a != b:
                labels[labels == b] = a
        peaks: list[HuePeak] = []
        for k in range(1, count + 1):
            i, j, n = np.nonzero(labels == k)
            volume = len(i) * cell(axes)
            if volume < LEAST_PEAK:
                continue
            weight, turn = self.activation[i, j, n], np.radians(axes[2].points[n])
            hue = math.degrees(math.atan2((weight * np.sin(turn)).sum(), (weight * np.cos(turn)).sum())) % 360
            x, y = (float(np.average(axes[d].points[at], weights=weight)) for d, at in enumerate((i, j)))
            peaks.append(HuePeak(x, y, hue, volume))
        return sorted(peaks, key=lambda p: -p.volume)

    def nearest(self, peak: HuePeak) -> Disc | None:
        """Return the disc nearest to a peak."""
        return min(self.discs.values(), key=lambda d: d.distance(peak.x, peak.y), default=None)


@functools.lru_cache(maxsize=4)
def _architecture(samples: tuple[int, ...]) -> Model:
    return pointing(samples)
