"""`deodar demo saliency`: a colour cue selects an object in a photograph, and a motor variable turns to
it.
"""

from __future__ import annotations

import json
import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from importlib import resources
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from deodar.analysis.claims import Claim
from deodar.analysis.peaks import Peaks, peaks
from deodar.architectures.saliency import CUE_AT, SIDE, retina, saliency, scene
from deodar.batch.simulate import simulate
from deodar.elements.sensor import Sensor
from deodar.errors import DocumentError
from deodar.model.model import Model
from deodar.numerics.axes import Axes
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

NEAR = 2.0
"""Distance from a peak within which the motor variable counts as converged, in scene units: one sample of the
fields. Ours.
"""

LEAST_RIGHT = 10
"""Of the twelve cues for a colour that is present in an untuned photograph, how many have to be selected.

Ours.
"""

FOUND_HERE = "parameters that were found on this photograph"

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

    Of a film or a camera the picture is the last one, and `world` what is sensed. `tuned` says whether
    parameters were found on the picture.
    """

    name: str
    title: str
    picture: Picture
    cues: tuple[Cue, ...]
    world: World | None = None
    tuned: bool = True


@dataclass(frozen=True)
class Outcome:
    """What one cue brought: all peaks of both fields at the end, and where the motor variable ended.

    Attributes:
        cue: the cue.
        peaks, spatial: peaks of the colour-space field and of the spatial field.
        places, spatial_places, motor: the same and the motor variable, in pixels.
        gap: distance of the motor variable from the nearest peak of the spatial field, in scene units; None
            without a peak.
        moved: distance of the motor variable from where it began, in scene units.
    """

    cue: Cue
    peaks: Peaks
    spatial: Peaks
    places: tuple[tuple[float, float], ...]
    spatial_places: tuple[tuple[float, float], ...]
    motor: tuple[float, float]
    gap: float | None
    moved: float

    @property
    def right(self) -> bool:
        """Whether the fields select what the marks ask for: one peak in each, in the region; no peak in
        either where the colour is absent.
        """
        if self.cue.expect == "absent":
            return not self.peaks and not self.spatial
        one = len(self.places) == 1 and len(self.spatial_places) == 1
        return one and all(self.cue.holds(p) for p in (*self.places, *self.spatial_places))

    @property
    def converged(self) -> bool:
        """Whether the motor variable ended at the peak; without a peak, whether it stayed."""
        return self.moved <= NEAR / 10 if self.gap is None else self.gap <= NEAR


@dataclass(frozen=True)
class Result:
    """A scene, run: the record over time, the largest activation before the cue, and an outcome for each
    cue.
    """

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
        untuned: the twelve that were marked before the architecture first saw them, in place of the three on
            which its parameters were found.
    """
    folder = resources.files("deodar.demos") / "photographs"
    if untuned:
        folder = folder / "untuned"
    marks: dict[str, Any] = json.loads((folder / "marks.json").read_text())
    scenes: list[Scene] = []
    for name, entry in marks.items():
        with resources.as_file(folder / entry["picture"]) as path:
            picture = Picture(path)
        cues = [
            Cue(c["hue"], c["name"], c["expect"], c.get("object", ""), _outlines(c.get("outlines", [])))
            for c in entry["cues"]
        ]
        scenes.append(Scene(name, entry["title"], picture, tuple(cues), tuned=not untuned))
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
    """What a camera sees for as long as a run lasts, recorded by the clock on the wall, so that all cues are
    tried on the same.
    """
    cues, eye = _cues(hues), Model("eye", dt=PERIOD)
    eye.add(Sensor("eye", retina(), sensor="picture"))
    began: list[float] = []

    def wait(done: int) -> None:
        began.append(
            time.monotonic() - done * PERIOD / 1000
        )  # the first counts: before it, programs are compiled
        time.sleep(max(0.0, began[0] + done * PERIOD / 1000 - time.monotonic()))

    try:
        seen = simulate(eye, DURATION, record="eye.output", world=camera, progress=wait)
        return Scene("camera", f"camera {camera.number}", Picture(camera.picture()), cues, Recording(seen))
    finally:
        camera.close()


def _cues(hues: Sequence[float]) -> tuple[Cue, ...]:
    if not all(0 <= h < 360 for h in hues):
        raise DocumentError(
            f"a cue is a hue from 0 to 360 degrees, not {', '.join(f'{h:g}' for h in hues)}",
            fix="0 is red, 120 green, 240 blue",
        )
    return tuple(Cue(h) for h in hues or WHEEL)


def look(
    scene: Scene, seed: int = 0, step: Callable[[], None] = lambda: None, model: Model | None = None
) -> Result:
    """All cues of a scene as one batch: first half a second without a cue, then three seconds with it.

    Args:
        scene: the picture and its cues.
        seed: of the noise.
        step: called after each of two simulations.
        model: the architecture; none: `saliency()`.
    """
    model = model or saliency()
    sweep = {"cue.center": [c.hue for c in scene.cues]}
    paths = ["seen.output", "colour.activation", "spatial.activation", "pan.output", "tilt.output"]
    world = scene.world or scene.picture
    record = simulate(
        model, DURATION, seed=seed, record=paths, every=EVERY, sweep=sweep, world=world, progress=False
    )
    step()
    end = simulate(model, DURATION, seed=seed, sweep=sweep, world=world, progress=False).isel(time=-1)
    step()
    before = record["seen.output"].sel(time=record["time"] < CUE_AT)
    return Result(
        scene,
        record,
        float(before.max()),
        tuple(_outcome(scene, record, end, k) for k in range(len(scene.cues))),
    )


def _outcome(scene_: Scene, record: xarray.Dataset, end: xarray.Dataset, k: int) -> Outcome:
    x, y, hues = scene()
    point = {"cue.center": k}
    found = peaks(end["perceptual.activation"].isel(point).values, [x, y, hues])
    spatial = peaks(end["spatial.activation"].isel(point).values, [x, y])
    last = record.isel({**point, "time": -1})
    motor = float(last["pan.output"]), float(last["tilt.output"])
    gap = min((math.dist(motor, p.position) for p in spatial), default=None)
    moved = math.dist(motor, (SIDE / 2, SIDE / 2))
    places, spatial_places = (_places(scene_, p, (x, y)) for p in (found, spatial))
    return Outcome(
        scene_.cues[k],
        found,
        spatial,
        places,
        spatial_places,
        scene_.picture.to_pixels((x, y), *motor),
        gap,
        moved,
    )


def _places(scene: Scene, found: Peaks, axes: Axes) -> tuple[tuple[float, float], ...]:
    return tuple(scene.picture.to_pixels(axes, p.position[0], p.position[1]) for p in found)


def claims(result: Result) -> list[Claim]:
    """One claim for the time without a cue, and for each cue of a marked picture one for the fields and one
    for the motor variable.

    Each is reported. On the photographs on which the parameters were found none of them is evidence; `totals`
    says what is required of the others.
    """
    name = result.scene.name
    found: dict[str, Any] = (
        {"assumes": FOUND_HERE, "inferred": True}
        if result.scene.tuned and any(c.expect for c in result.scene.cues)
        else {}
    )
    marks: dict[str, Any] = {"kind": "reported", "source": SOURCE, "origin": "ours", **found}
    quiet = f"{name}, no cue: the colour-space field stays below threshold"
    out = [Claim(quiet, round(result.quiet, 3), "< 0", result.quiet < 0, **marks)]
    for o in result.outcomes:
        value: dict[str, Any] = {
            "peaks": len(o.places),
            "spatial peaks": len(o.spatial_places),
            "places": [[round(v) for v in p] for p in o.places],
            "motor variable": [round(v) for v in o.motor],
        }
        if not o.cue.expect:
            out.append(
                Claim(
                    f"{name}, cue {o.cue.hue:g} deg",
                    value,
                    "not marked",
                    None,
                    kind="reported",
                    origin="none",
                )
            )
            continue
        cue = f"{name}, cue {o.cue.name} ({o.cue.hue:g} deg)"
        present = o.cue.expect == "present"
        what = (
            f"exactly one peak, on {o.cue.object}; the spatial field follows"
            if present
            else "no such colour in the picture, no peak"
        )
        target = (
            "one peak in the marked region, one spatial peak there too"
            if present
            else "no peak in either field"
        )
        out.append(Claim(f"{cue}: {what}", value, target, o.right, **marks))
        what = "the motor variable converges to the peak" if present else "the motor variable stays"
        distance, target = (
            (o.gap, f"at most {NEAR:g} from the spatial peak")
            if present
            else (o.moved, f"at most {NEAR / 10:g} from its start")
        )
        held = o.converged if (o.gap is not None) == present else False
        out.append(
            Claim(f"{cue}: {what}", None if distance is None else round(distance, 2), target, held, **marks)
        )
    return out


def totals(results: Sequence[Result]) -> list[Claim]:
    """What is required of the untuned photographs together, and in how many the motor variable arrives in
    time. The targets are ours.
    """
    asked = [o for r in results if not r.scene.tuned for o in r.outcomes]
    if not asked:
        return []
    present, absent = ([o for o in asked if o.cue.expect == e] for e in ("present", "absent"))
    right, silent = sum(o.right for o in present), sum(o.right for o in absent)
    arrived = sum(o.gap is not None and o.converged for o in present)
    says = (
        "a present colour is selected",
        "an absent colour selects nothing",
        "the motor variable converges to the peak",
    )
    selected, nothing, motor = (f"untuned: {what}" for what in says)
    return [
        Claim(
            selected,
            right,
            f"at least {LEAST_RIGHT} of {len(present)}",
            right >= LEAST_RIGHT,
            n=len(present),
            origin="ours",
        ),
        Claim(nothing, silent, f"all of {len(absent)}", silent == len(absent), n=len(absent), origin="ours"),
        Claim(
            motor,
            arrived,
            f"all of {len(present)}",
            arrived == len(present),
            "reported",
            n=len(present),
            origin="ours",
        ),
    ]


def sentence(results: Sequence[Result]) -> str:
    """The outcome in one line of plain words."""
    asked = [o for r in results for o in r.outcomes if o.cue.expect]
    quiet = sum(r.quiet < 0 for r in results)
    if asked:
        present, absent = ([o.right for o in asked if o.cue.expect == e] for e in ("present", "absent"))
        return (
            f"{len(results)} photographs: silent without a cue in {quiet}; {sum(present)} of {len(present)}"
            f" cued colours selected on the right object; {sum(absent)} of {len(absent)} cues of absent"
            " colours selected nothing."
        )
    found = [f"{o.cue.hue:g} deg: {_where(o)}" for r in results for o in r.outcomes if o.peaks or o.spatial]
    return (
        f"Selected: {'; '.join(found)}. Other cues selected nothing."
        if found
        else "No cue selected anything."
    )


def _where(outcome: Outcome) -> str:
    """Where the peaks of the spatial field are; of the colour-space field, where the spatial field has
    none.
    """
    places = outcome.spatial_places or outcome.places
    text = " and ".join(f"column {x:.0f}, row {y:.0f}" for x, y in places)
    return text if outcome.spatial else f"{text} (without a peak of the spatial field)"


def spatial_pixels(result: Result) -> np.ndarray:
    """Corners (left, right, bottom, top) of the spatial field's picture in pixels, for drawing over the
    photograph.
    """
    x, y, _ = scene()
    left, top = result.scene.picture.to_pixels((x, y), x.lower - x.step / 2, y.lower - y.step / 2)
    right, bottom = result.scene.picture.to_pixels((x, y), x.upper + x.step / 2, y.upper + y.step / 2)
    return np.array([left, right, bottom, top])
