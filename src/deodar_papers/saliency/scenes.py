"""Scenes, which are photographs, videos and cameras with colour cues, and the run of all cues on a scene."""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from dataclasses import dataclass
from importlib import resources
from pathlib import Path
from typing import TYPE_CHECKING, Any

from deodar import codec
from deodar.analysis.peaks import Peaks, peaks
from deodar.architectures.saliency import CUE_AT, SIDE, retina, saliency, scene
from deodar.batch.simulate import simulate
from deodar.elements.world_ports import Sensor
from deodar.errors import DocumentError
from deodar.model.model import Model
from deodar.numerics.axes import Axes
from deodar.resources import Resources
from deodar.worlds._base import World
from deodar.worlds.camera import Camera
from deodar.worlds.picture import Picture
from deodar.worlds.recorded_run import Recording
from deodar.worlds.video import Video

if TYPE_CHECKING:
    import xarray
    from matplotlib.figure import Figure

DURATION = 3500.0
EVERY = 50.0
PERCEPTUAL = "perceptual.activation"
PERIOD = 50.0
"""ms between two pictures of a video or a camera."""

NEAR = 2.0
"""Distance from a peak within which the motor variable counts as converged, in scene units: one sample of the
fields (a choice of deodar).
"""

WHEEL = (0.0, 60.0, 120.0, 180.0, 240.0, 300.0)
"""Cues for a picture without marks."""

Outline = tuple[tuple[float, float], ...]
"""Corners (column, row) of a polygon, in pixels."""


@dataclass(frozen=True)
class Cue:
    """A cued hue; for a marked picture also whether it shows such an object, and where.

    Attributes:
        hue: degrees.
        name: of the colour.
        expect: `present`, `absent`, or "" for a picture without marks.
        object: the object in the marked region, as a person names it.
        outlines: of the region; an outline inside another one is a hole.
    """

    hue: float
    name: str = ""
    expect: str = ""
    object: str = ""
    outlines: tuple[Outline, ...] = ()

    def holds(self, place: tuple[float, float]) -> bool:
        """Return whether a place (column, row) lies in the marked region."""
        return sum(_inside(place, outline) for outline in self.outlines) % 2 == 1


@dataclass(frozen=True)
class CueScene:
    """A picture and its cues.

    For a video or a camera `picture` is the last picture, and `world` provides the sensed ones. `tuned`
    states whether parameters were tuned on the picture.
    """

    name: str
    title: str
    picture: Picture
    cues: tuple[Cue, ...]
    world: World | None = None
    tuned: bool = True


@dataclass(frozen=True)
class Outcome:
    """The result of one cue: all peaks of both fields at the end, and the end of the motor variable.

    Attributes:
        cue: the cue.
        places, spatial_places, motor: peaks of the colour-space field and of the spatial field, and the motor
            variable, in pixels.
        spatial: peaks of the spatial field, in scene units.
        gap: distance of the motor variable from the nearest peak of the spatial field, in scene units; None
            without a peak.
        moved: distance of the motor variable from its initial value, in scene units.
    """

    cue: Cue
    places: tuple[tuple[float, float], ...]
    spatial_places: tuple[tuple[float, float], ...]
    spatial: tuple[tuple[float, float], ...]
    motor: tuple[float, float]
    gap: float | None
    moved: float

    @property
    def right(self) -> bool:
        """Whether the fields select the marked object: one peak in each, in the region; no peak in
        either where the colour is absent.
        """
        if self.cue.expect == "absent":
            return not self.places and not self.spatial
        one = len(self.places) == 1 and len(self.spatial_places) == 1
        return one and all(self.cue.holds(p) for p in (*self.places, *self.spatial_places))

    @property
    def converged(self) -> bool:
        """Whether the motor variable ended at the peak; without a peak, whether it stayed."""
        return self.moved <= NEAR / 10 if self.gap is None else self.gap <= NEAR


@dataclass(frozen=True)
class Found:
    """Result of a scene: the largest activation before the cue, and an outcome for each cue.

    Before the run `quiet` is None, and there are no outcomes.
    """

    scene: CueScene
    quiet: float | None = None
    outcomes: tuple[Outcome, ...] = ()


@dataclass(frozen=True, kw_only=True)
class SceneResult(Found):
    """Result of a scene with its record over time."""

    record: xarray.Dataset

    @property
    def corners(self) -> tuple[float, float, float, float]:
        """Return left, right, bottom and top of the spatial field in pixels of the picture."""
        x, y, _ = scene()
        to_pixels = self.scene.picture.to_pixels
        left, top = to_pixels((x, y), x.lower - x.step / 2, y.lower - y.step / 2)
        right, bottom = to_pixels((x, y), x.upper + x.step / 2, y.upper + y.step / 2)
        return left, right, bottom, top

    def figure(self) -> Figure:
        """Draw the scene with one row for each cue: selected place, both fields, motor variable over time."""
        from deodar_papers.figures.cues import cues_figure  # start-up time: matplotlib

        return cues_figure(self)


def _inside(place: tuple[float, float], outline: Outline) -> bool:
    """Return whether a ray from the place to the right crosses the outline an odd number of times."""
    x, y = place
    inside = False
    for (x0, y0), (x1, y1) in zip(outline, (*outline[1:], outline[0]), strict=True):
        if (y0 > y) != (y1 > y) and x < x0 + (y - y0) / (y1 - y0) * (x1 - x0):
            inside = not inside
    return inside


def photographs(untuned: bool = False) -> list[CueScene]:
    """Return the photographs of deodar with the regions that a person marked.

    Args:
        untuned: the twelve that were marked before the architecture was run on them, instead of the three on
            which its parameters were tuned.
    """
    folder = resources.files("deodar_papers.saliency") / "photographs"
    if untuned:
        folder = folder / "untuned"
    marks: dict[str, Any] = codec.parse((folder / "marks.json").read_text())
    scenes: list[CueScene] = []
    for name, entry in marks.items():
        with resources.as_file(folder / entry["picture"]) as path:
            picture = Picture(path)
        cues = [
            Cue(c["hue"], c["name"], c["expect"], c.get("object", ""), _outlines(c.get("outlines", [])))
            for c in entry["cues"]
        ]
        scenes.append(CueScene(name, entry["title"], picture, tuple(cues), tuned=not untuned))
    return scenes


def _outlines(corners: Sequence[Sequence[Sequence[float]]]) -> tuple[Outline, ...]:
    return tuple(tuple((float(x), float(y)) for x, y in outline) for outline in corners)


def own(file: Path, hues: Sequence[float]) -> CueScene:
    """Return a custom picture, without marks."""
    cues = _cues(hues)
    return CueScene(file.stem, file.name, Picture(file), cues)


def filmed(file: Path, hues: Sequence[float]) -> CueScene:
    """Return a custom video, from its beginning; after its end its last picture stays."""
    cues, film = _cues(hues), Video(file, period=PERIOD)
    return CueScene(file.stem, file.name, Picture(film.picture(DURATION)), cues, film)


def watched(camera: Camera, hues: Sequence[float]) -> CueScene:
    """Record a camera by the wall clock for the duration of a run, so that all cues are tried on the same
    pictures.
    """
    cues, eye = _cues(hues), Model("eye", dt=PERIOD)
    eye.add(Sensor("eye", retina(), sensor="picture"))
    began: list[float] = []

    def wait(done: int) -> None:
        # time counts from the first picture; programs are compiled before it
        began.append(time.monotonic() - done * PERIOD / 1000)
        time.sleep(max(0.0, began[0] + done * PERIOD / 1000 - time.monotonic()))

    try:
        seen = simulate(eye, DURATION, record="eye.output", world=camera, on=Resources(progress=wait))
        return CueScene("camera", f"camera {camera.source}", Picture(camera.picture()), cues, Recording(seen))
    finally:
        camera.close()


def _cues(hues: Sequence[float]) -> tuple[Cue, ...]:
    if not all(0 <= h < 360 for h in hues):
        raise DocumentError(
            f"a cue is a hue from 0 to 360 degrees, not {', '.join(f'{h:g}' for h in hues)}",
            fix="0 is red, 120 green, 240 blue",
        )
    return tuple(Cue(h) for h in hues or WHEEL)


def run_scene(scene: CueScene, seed: int = 0) -> SceneResult:
    """Run all cues of a scene as one batch: half a second without a cue, then three seconds with it.

    Args:
        scene: the picture and its cues.
        seed: seed of the noise.
    """
    paths = ["seen.output", "colour.activation", "spatial.activation", "pan.output", "tilt.output"]
    record = simulate(
        saliency(),
        DURATION,
        seed=seed,
        record=[*paths, PERCEPTUAL],
        every=EVERY,
        sweep={"cue.center": [c.hue for c in scene.cues]},
        world=scene.world or scene.picture,
        on=Resources(progress=False),
    )
    before = record["seen.output"].sel(time=record["time"] < CUE_AT)
    outcomes = tuple(_outcome(scene, record, k) for k in range(len(scene.cues)))
    # of the largest field only the end is judged
    return SceneResult(scene, float(before.max()), outcomes, record=record.drop_vars(PERCEPTUAL))


def _outcome(scene_: CueScene, record: xarray.Dataset, k: int) -> Outcome:
    x, y, hues = scene()
    last = record.isel({"cue.center": k, "time": -1})
    perceptual = peaks(last[PERCEPTUAL].values, [x, y, hues])
    spatial = peaks(last["spatial.activation"].values, [x, y])
    motor = float(last["pan.output"]), float(last["tilt.output"])
    gap = min((math.dist(motor, p.position) for p in spatial), default=None)
    moved = math.dist(motor, (SIDE / 2, SIDE / 2))
    places, spatial_places = (_places(scene_, p, (x, y)) for p in (perceptual, spatial))
    positions = tuple((float(p.position[0]), float(p.position[1])) for p in spatial)
    pixels = scene_.picture.to_pixels((x, y), *motor)
    return Outcome(scene_.cues[k], places, spatial_places, positions, pixels, gap, moved)


def _places(scene: CueScene, found: Peaks, axes: Axes) -> tuple[tuple[float, float], ...]:
    return tuple(scene.picture.to_pixels(axes, p.position[0], p.position[1]) for p in found)
