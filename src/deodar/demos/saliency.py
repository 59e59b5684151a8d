"""`deodar demo saliency`: a colour cue selects an object in a photograph, and a motor variable turns to it."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from importlib import resources
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from deodar.analysis.claims import Claim
from deodar.analysis.peaks import Peaks, peaks
from deodar.architectures.saliency import CUE_AT, retina, saliency, scene
from deodar.elements.sensor import Sensor
from deodar.errors import DocumentError
from deodar.model.model import Model
from deodar.numerics.axes import Axes
from deodar.runtime.simulate import simulate
from deodar.worlds._base import World
from deodar.worlds.camera import Camera
from deodar.worlds.picture import Picture
from deodar.worlds.recording import Recording
from deodar.worlds.video import Video

if TYPE_CHECKING:
    import xarray

HELP = "a colour cue selects an object in a photograph, and a motor variable turns to it"
SOURCE = "Sandamirskaya (2014), Front. Neurosci. 7:276, figure 2"

DURATION = 3500.0
EVERY = 50.0
PERIOD = 50.0
"""ms between two pictures of a film or a camera."""

WHEEL = (0.0, 60.0, 120.0, 180.0, 240.0, 300.0)
"""Cues for a picture in which nobody has marked anything."""

Outline = tuple[tuple[float, float], ...]
"""Corners (column, row) of a polygon, in pixels."""


@dataclass(frozen=True)
class Cue:
    """A cued hue; for a marked picture whether such an object is in it, and where.

    Attributes:
        hue: degrees.
        name: of the colour.
        expect: `present`, `absent`, or "" where nobody has marked the picture.
        object: what a person sees in the marked region.
        outlines: of the region; an outline inside another one is a hole.
    """

    hue: float
    name: str = ""
    expect: str = ""
    object: str = ""
    outlines: tuple[Outline, ...] = ()

    def holds(self, place: tuple[float, float]) -> bool:
        """Whether a place (column, row) lies in the marked region."""
        return sum(_inside(place, outline) for outline in self.outlines) % 2 == 1


@dataclass(frozen=True)
class Scene:
    """A picture and the cues to be tried on it.

    Of a film or a camera the picture is the last one, and `world` what is sensed.
    """

    name: str
    title: str
    picture: Picture
    cues: tuple[Cue, ...]
    world: World | None = None


@dataclass(frozen=True)
class Outcome:
    """What one cue brought: peaks at the end, and where the motor variable ended, in pixels."""

    cue: Cue
    peaks: Peaks
    spatial: Peaks
    places: tuple[tuple[float, float], ...]
    spatial_places: tuple[tuple[float, float], ...]
    motor: tuple[float, float]

    @property
    def right(self) -> bool:
        """Whether it is what the marks ask for."""
        if self.cue.expect == "absent":
            return not self.peaks and not self.spatial
        one = len(self.places) == 1 and len(self.spatial_places) == 1
        return one and all(self.cue.holds(p) for p in (*self.places, *self.spatial_places, self.motor))


@dataclass(frozen=True)
class Result:
    """A scene, run: the record over time, the largest activation before the cue, and an outcome for each cue."""

    scene: Scene
    record: xarray.Dataset
    quiet: float
    outcomes: tuple[Outcome, ...]


def _inside(place: tuple[float, float], outline: Outline) -> bool:
    """Whether a ray from the place to the right crosses the outline an odd number of times."""
    x, y = place
    inside = False
    for (x0, y0), (x1, y1) in zip(outline, (*outline[1:], outline[0]), strict=True):
        if (y0 > y) != (y1 > y) and x < x0 + (y - y0) / (y1 - y0) * (x1 - x0):
            inside = not inside
    return inside


def photographs(untuned: bool = False) -> list[Scene]:
    """The photographs that come with deodar, with what a person marked in them.

    Args:
        untuned: the twelve that were marked before the architecture first saw them, in place of the three on which its parameters were found.
    """
    folder = resources.files("deodar.demos") / "photographs"
    if untuned:
        folder = folder / "untuned"
    marks: dict[str, Any] = json.loads((folder / "marks.json").read_text())
    scenes: list[Scene] = []
    for name, entry in marks.items():
        with resources.as_file(folder / entry["picture"]) as path:
            picture = Picture(path)
        cues = [Cue(c["hue"], c["name"], c["expect"], c.get("object", ""), _outlines(c.get("outlines", []))) for c in entry["cues"]]
        scenes.append(Scene(name, entry["title"], picture, tuple(cues)))
    return scenes


def _outlines(corners: Sequence[Sequence[Sequence[float]]]) -> tuple[Outline, ...]:
    return tuple(tuple((float(x), float(y)) for x, y in outline) for outline in corners)


def own(file: Path, hues: Sequence[float]) -> Scene:
    """A picture of one's own; what is right in it nobody has marked."""
    cues = _cues(hues)
    return Scene(file.stem, file.name, Picture(file), cues)


def filmed(file: Path, hues: Sequence[float]) -> Scene:
    """A film of one's own, from its beginning; after its end its last picture stays."""
    cues, film = _cues(hues), Video(file, period=PERIOD)
    return Scene(file.stem, file.name, Picture(film.picture(DURATION)), cues, film)


def watched(camera: Camera, hues: Sequence[float]) -> Scene:
    """What a camera sees for as long as a run lasts, recorded by the clock on the wall, so that all cues are tried on the same."""
    cues, eye = _cues(hues), Model("eye", dt=PERIOD)
    eye.add(Sensor("eye", retina(), sensor="picture"))
    began: list[float] = []

    def wait(done: int) -> None:
        began.append(time.monotonic() - done * PERIOD / 1000)  # the first counts: before it, programs are compiled
        time.sleep(max(0.0, began[0] + done * PERIOD / 1000 - time.monotonic()))

    try:
        seen = simulate(eye, DURATION, record="eye.output", world=camera, progress=wait)
        return Scene("camera", f"camera {camera.number}", Picture(camera.picture()), cues, Recording(seen))
    finally:
        camera.close()


def _cues(hues: Sequence[float]) -> tuple[Cue, ...]:
    if not all(0 <= h < 360 for h in hues):
        raise DocumentError(f"a cue is a hue from 0 to 360 degrees, not {', '.join(f'{h:g}' for h in hues)}", fix="0 is red, 120 green, 240 blue")
    return tuple(Cue(h) for h in (hues or WHEEL))


def look(scene: Scene, seed: int = 0, step: Callable[[], None] = lambda: None) -> Result:
    """All cues of a scene as one batch: first half a second without a cue, then three seconds with it."""
    model = saliency()
    sweep = {"cue.center": [c.hue for c in scene.cues]}
    paths = ["seen.output", "colour.activation", "spatial.activation", "pan.output", "tilt.output"]
    world = scene.world or scene.picture
    record = simulate(model, DURATION, seed=seed, record=paths, every=EVERY, sweep=sweep, world=world, progress=False)
    step()
    end = simulate(model, DURATION, seed=seed, sweep=sweep, world=world, progress=False).isel(time=-1)
    step()
    before = record["seen.output"].sel(time=record["time"] < CUE_AT)
    return Result(scene, record, float(before.max()), tuple(_outcome(scene, record, end, k) for k in range(len(scene.cues))))


def _outcome(scene_: Scene, record: xarray.Dataset, end: xarray.Dataset, k: int) -> Outcome:
    x, y, hues = scene()
    point = {"cue.center": k}
    found = peaks(end["perceptual.activation"].isel(point).values, [x, y, hues])
    spatial = peaks(end["spatial.activation"].isel(point).values, [x, y])
    last = record.isel({**point, "time": -1})
    motor = scene_.picture.to_pixels((x, y), float(last["pan.output"]), float(last["tilt.output"]))
    return Outcome(scene_.cues[k], found, spatial, _places(scene_, found, (x, y)), _places(scene_, spatial, (x, y)), motor)


def _places(scene: Scene, found: Peaks, axes: Axes) -> tuple[tuple[float, float], ...]:
    return tuple(scene.picture.to_pixels(axes, p.position[0], p.position[1]) for p in found)


def claims(result: Result) -> list[Claim]:
    """One claim for the time without a cue, and one for each cue of a marked picture."""
    name = result.scene.name
    out = [Claim(f"{name}, no cue: the colour-space field stays below threshold", round(result.quiet, 3), "< 0", result.quiet < 0, source=SOURCE)]
    for o in result.outcomes:
        value: dict[str, Any] = {
            "peaks": len(o.places),
            "spatial peaks": len(o.spatial_places),
            "places": [[round(v) for v in p] for p in o.places],
            "motor variable": [round(v) for v in o.motor],
        }
        if o.cue.expect == "present":
            what = (
                f"{name}, cue {o.cue.name} ({o.cue.hue:g} deg): exactly one peak, on {o.cue.object}; the spatial field and the motor variable follow"
            )
            out.append(Claim(what, value, "one peak in a marked region, spatial peak and motor variable there too", o.right, source=SOURCE))
        elif o.cue.expect == "absent":
            what = f"{name}, cue {o.cue.name} ({o.cue.hue:g} deg): no such colour in the picture, no peak"
            out.append(Claim(what, value, "no peak in either field", o.right, source=SOURCE))
        else:
            out.append(Claim(f"{name}, cue {o.cue.hue:g} deg", value, "not marked", None, kind="reported"))
    return out


def sentence(results: Sequence[Result]) -> str:
    """The outcome in one line of plain words."""
    asked = [o for r in results for o in r.outcomes if o.cue.expect]
    quiet = sum(r.quiet < 0 for r in results)
    if asked:
        present, absent = ([o.right for o in asked if o.cue.expect == e] for e in ("present", "absent"))
        return (
            f"{len(results)} photographs: silent without a cue in {quiet}; {sum(present)} of {len(present)} cued colours selected on the right"
            f" object; {sum(absent)} of {len(absent)} cues of absent colours selected nothing."
        )
    found = [f"{o.cue.hue:g} deg at column {o.places[0][0]:.0f}, row {o.places[0][1]:.0f}" for r in results for o in r.outcomes if len(o.places) == 1]
    return f"Selected: {'; '.join(found) or 'nothing'}. Other cues selected nothing."


def spatial_pixels(result: Result) -> np.ndarray:
    """Corners (left, right, bottom, top) of the spatial field's picture in pixels, for drawing over the photograph."""
    x, y, _ = scene()
    left, top = result.scene.picture.to_pixels((x, y), x.lower - x.step / 2, y.lower - y.step / 2)
    right, bottom = result.scene.picture.to_pixels((x, y), x.upper + x.step / 2, y.upper + y.step / 2)
    return np.array([left, right, bottom, top])
