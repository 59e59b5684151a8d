"""Draw the pictures of the examples for the gallery, one small picture each.

    python examples/pictures.py

Every function below runs one document for as long as its notes say and draws it, `NAME.png`. Activation is
drawn in the colours of the manual and the studio: blue below the threshold, white at it, red above. Time runs
to the right.
"""

from __future__ import annotations

import dataclasses as dc
import io
import re
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import TwoSlopeNorm, to_rgb
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Rectangle
from matplotlib.patheffects import withStroke
from PIL import Image

import deodar as dd

HERE = Path(__file__).parent
SIZE = (320, 200)
COLORS = dd.figures.ACTIVATION
DARK, LINE = COLORS(0.0), (1.0, 1.0, 1.0, 0.9)
ACTIVATION, EMBER = "#62b5f0", "#ff8a4c"
"""The colours of activation below and above the threshold on dark ground, as in the studio."""
EDGE = [withStroke(linewidth=3.6, foreground="#202020")]
"""The edge of a white line, which can be seen on every colour of the map."""
SCALE = 3
"""Drawn so much larger, then made smaller: soft edges."""

Box = tuple[float, float, float, float]
WHOLE: Box = (0, 0, 1, 1)


def run(name: str, *paths: str, seed: int = 0) -> xarray.Dataset:
    """A document, for as long as its notes say."""
    model = dd.load(HERE / f"{name}.json")
    found = re.search(r"(\d+) ms\.$", model.document.notes)
    assert found is not None
    return dd.simulate(model, float(found[1]), seed=seed, record=list(paths), every=5 * model.document.step)


# ---------------------------------------------------------------------------------------------- what is drawn


def blank() -> Figure:
    """An empty picture."""
    return Figure(figsize=(SIZE[0] / 100, SIZE[1] / 100), dpi=100 * SCALE, facecolor=DARK)


def part(figure: Figure, box: Box = WHOLE) -> Axes:
    """A part of the picture, without frame or numbers."""
    axes = figure.add_axes(box)
    axes.set_axis_off()
    return axes


def heat(axes: Axes, values: np.ndarray, low: float, high: float, threshold: bool = True) -> None:
    """Activation over two dimensions, the second upwards."""
    width, height = values.shape
    axes.imshow(
        values.T,
        origin="lower",
        aspect="auto",
        cmap=COLORS,
        norm=TwoSlopeNorm(0, min(low, -1e-6), max(high, 1e-6)),
        extent=(0, width, 0, height),
        interpolation="bilinear",
    )
    if threshold and values.min() < 0 < values.max():
        axes.contour(
            np.arange(width) + 0.5,
            np.arange(height) + 0.5,
            values.T,
            levels=[0],
            colors=["#202020"],
            linewidths=0.5,
        )
    axes.set_xlim(0, width)
    axes.set_ylim(0, height)


def course(axes: Axes, u: xarray.DataArray, low: float, high: float) -> None:
    """The activation of a node over time, bright where it is on."""
    axes.fill_between(u.time, u, 0, where=u > 0, color=EMBER, alpha=0.6, linewidth=0)
    axes.axhline(0, color=LINE, linewidth=0.5)
    axes.plot(u.time, u, color=ACTIVATION, linewidth=1.6)
    axes.plot(u.time, np.where(u > 0, u, np.nan), color=EMBER, linewidth=1.6)
    axes.set_xlim(float(u.time[0]), float(u.time[-1]))
    axes.set_ylim(low, high)


def space_time(name: str, seed: int = 0, darkest: float = 0.01) -> Figure:
    """A field of one dimension over time; below the quantile `darkest` all is dark."""
    figure = blank()
    u = run(name, "u.activation", seed=seed)["u.activation"].values
    heat(part(figure), u, *np.quantile(u, (darkest, 0.985)))
    return figure


# ----------------------------------------------------------------------------------------------- the examples


def detection() -> Figure:
    """One peak, after a while of nothing."""
    return space_time("detection")


def selection() -> Figure:
    """Two inputs, one peak."""
    return space_time("selection")


def working_memory() -> Figure:
    """A peak that stays."""
    return space_time("working_memory")


def forgetting() -> Figure:
    """A peak that stays until it is erased."""
    return space_time("forgetting")


def boost() -> Figure:
    """Traces, and a peak for as long as the boost lasts."""
    return space_time("boost")


def timed_stimuli() -> Figure:
    """Peaks here and there."""
    return space_time("timed_stimuli")


def correlated_noise() -> Figure:
    """A peak out of noise."""
    return space_time("correlated_noise", seed=10, darkest=0.3)


def projection() -> Figure:
    """The field over place and hue in the middle, hue at its left, place below."""
    figure = blank()
    end = run("projection", "scene.activation", "colour.activation", "where.activation").isel(time=-1)
    scene, colour, where = (end[f"{name}.activation"].values for name in ("scene", "colour", "where"))
    low = min(float(u.min()) for u in (scene, colour, where))
    heat(part(figure, (0.1, 0.16, 0.9, 0.84)), scene, low, float(scene.max()))
    heat(
        part(figure, (0, 0.16, 0.085, 0.84)),
        np.repeat(colour[None], 2, 0),
        low,
        float(colour.max()),
        threshold=False,
    )
    heat(
        part(figure, (0.1, 0, 0.9, 0.136)),
        np.repeat(where[:, None], 2, 1),
        low,
        float(where.max()),
        threshold=False,
    )
    return figure


def node() -> Figure:
    """A switch, turned on and off."""
    figure = blank()
    u = run("node", "u.activation")["u.activation"]
    course(part(figure), u, -6, 7)
    return figure


def groups() -> Figure:
    """Four behaviours in turn."""
    figure = blank()
    names = ("search", "approach", "grasp", "lift")
    data = run("groups", *(f"{name}.intention.activation" for name in names))
    for k, name in enumerate(names):
        course(part(figure, (0, 0.75 - 0.25 * k, 1, 0.25)), data[f"{name}.intention.activation"], -11, 8)
    return figure


def motor_attractor() -> Figure:
    """Two peaks one after the other, and the motor variable that turns to them, the short way round."""
    figure = blank()
    data = run("motor_attractor", "target.activation", "turn.output")
    u, turn = data["target.activation"].values, data["turn.output"].values
    axes = part(figure)
    heat(axes, u, float(np.quantile(u, 0.01)), float(u.max()), threshold=False)
    place = (turn + 180) / 360 * u.shape[1]
    place[1:][np.abs(np.diff(place)) > u.shape[1] / 2] = np.nan
    axes.plot(np.arange(len(place)) + 0.5, place, color="white", linewidth=1.8, path_effects=EDGE)
    return figure


def saliency() -> Figure:
    """A photograph as the model sees it, and where the peak for red stands."""
    figure = blank()
    scene = next(s for s in dd.papers.saliency.scenes.photographs() if s.name == "coffee")
    model = dd.load(HERE / "saliency.json")
    model.set("cue.center", 5.0)
    paths = ["eye.output", "spatial.activation", "pan.output", "tilt.output"]
    end = dd.simulate(model, 3500, record=paths, every=3500, world=scene.picture).isel(time=-1)
    seen, u = end["eye.output"].values, end["spatial.activation"]
    width, height = scene.picture.size
    x, y = u[u.dims[0]].values, u[u.dims[1]].values
    side = float(x[0] + x[-1])
    axes = part(figure)
    axes.imshow(
        0.15 + 0.75 * seen.transpose(1, 0, 2),
        extent=(0, side, side, 0),
        interpolation="nearest",
        aspect="auto",
    )
    axes.contour(x, y, u.values.T, levels=[0], colors=["white"], linewidths=2)
    axes.plot(
        float(end["pan.output"]),
        float(end["tilt.output"]),
        "+",
        color="white",
        markersize=11,
        markeredgewidth=2,
    )
    half = side / 2 * min(height / width, SIZE[1] / SIZE[0])
    axes.set_xlim(0, side)
    axes.set_ylim(side / 2 + half, side / 2 - half)
    return figure


def plan() -> Figure:
    """The wave that goes left first and right later, and the walker's way."""
    figure = blank()
    data = dd.simulate(
        dd.load(HERE / "plan.json"), 1200, record=["left.motivation.activation", "gone.activation"], every=5
    )
    axes = part(figure)
    heat(axes, data["left.motivation.activation"].values, -12, 10, threshold=False)
    axes.plot(
        np.arange(len(data["time"])) + 0.5,
        dd.architectures.PLAN_START + data["gone.activation"].values,
        color="white",
        linewidth=2.2,
        path_effects=EDGE,
    )
    return figure


def spa() -> Figure:
    """The motivation to go north when the plan is complete, and the robot's way to the goal."""
    figure = blank()
    arena = dd.architectures.maze("z")
    model = dd.architectures.spa(arena)
    data = dd.simulate(model, 220, record=["north.motivation.activation"], every=220, world=arena)
    pose = dd.simulate(model, 760, record=["pose.output"], every=5, world=arena)["pose.output"].values
    u = data["north.motivation.activation"].isel(time=-1)
    x, y = u["x"].values, u["y"].values
    axes = part(figure)
    axes.imshow(
        u.values.T,
        extent=(x[0], x[-1], y[0], y[-1]),
        cmap=COLORS,
        norm=TwoSlopeNorm(0, -12, 10),
        interpolation="bilinear",
        aspect="auto",
        origin="lower",
    )
    axes.plot(pose[:, 0], pose[:, 1], color="white", linewidth=2.2, path_effects=EDGE)
    axes.plot(pose[0, 0], pose[0, 1], "o", color="white", markersize=7)
    return figure


def behaviours() -> Figure:
    """Find, reach and avoid above, which two of them compete below."""
    figure = blank()
    names = ("find", "reach", "avoid", "look left", "look right")
    data = run("behaviours", *(f"{name}.intention.activation" for name in names))
    for k, name in enumerate(names):
        course(
            part(figure, (0, 0.8 - 0.2 * k, 1, 0.2)), data[f"{name}.intention.activation"].clip(min=-6), -7, 5
        )
    return figure


def serial_order() -> Figure:
    """The ordinal nodes above, the action field below: shown, and then produced."""
    figure = blank()
    nodes = [f"item {k}.node.activation" for k in range(1, 5)]
    data = run("serial_order", *nodes, "action.activation")
    for k, name in enumerate(nodes):
        course(part(figure, (0, 0.9 - 0.1 * k, 1, 0.1)), data[name].clip(min=-2), -3, 8)
    u = data["action.activation"].values
    heat(part(figure, (0, 0, 1, 0.58)), u, -4, 4, threshold=False)
    return figure


def pointing() -> Figure:
    """What the camera sees when the arm points at the green object on the left (of the robot)."""
    figure = blank()
    world = dd.MuJoCo.example()
    session = dd.Session(dd.load(HERE / "pointing.json"), world=world)
    for level in (3.0, 0.0):
        for name in ("green", "left"):
            session.set(f"say {name}.amplitude", level)
        session.run(300)
    while float(session.read("satisfaction.activation").max()) < 1:
        session.run(20)
    pixels = [dd.Axis("column", 0, 2, 3 * SIZE[0]), dd.Axis("row", 0, 2, 3 * SIZE[1]), dd.Axis("c", 0, 2, 3)]
    world.cameras = dc.replace(world.cameras, pixel_noise=0.0)
    seen = world.sense("camera", pixels, session.time)[0]
    part(figure).imshow(seen.transpose(1, 0, 2), aspect="auto")
    return figure


def looking() -> Figure:
    """All events while the gaze turns to the disc, and the way of the disc on the retina."""
    figure = blank()
    eye = dd.Eye(screen=dd.EyeScreen(endless=False), first=(93, 86))
    session = dd.Session(dd.load(HERE / "looking.json"), world=eye, seed=6)
    pixels = [dd.Axis("column", 0, 127, 128), dd.Axis("row", 0, 127, 128)]
    pair = [dd.Axis("component", 0, 1, 2)]
    events, way = np.zeros((128, 128)), []
    while session.time < 620:
        session.run(10)
        session.read("pose.output")  # the world is now at the present
        events += eye.sense("events", pixels, session.time)[0]
        way.append(eye.sense("target", pair, session.time)[0])
    axes = part(figure)
    events[events < 300] = 0  # noise
    axes.imshow(events.T, cmap="magma", vmax=np.quantile(events, 0.998), aspect="auto")
    axes.plot(*np.array(way).T, color="#ffffff", linewidth=1.2, path_effects=EDGE)
    axes.plot([63.5], [63.5], "+", color="#ffffff", markersize=14)
    axes.set(xlim=(0, 127), ylim=(127, 0))
    return figure


def color_search() -> Figure:
    """The way of the robot to blue, yellow and red, which it was shown in this order, from above."""
    figure = blank()
    arena = dd.Arena(
        "search",
        unit="mm",
        vehicle="khepera",
        physics=dd.ArenaPhysics(period=20, camera_every=4),
        noise=dd.ArenaNoise(hue_noise=6),
    )
    session = dd.Session(dd.load(HERE / "color_search.json"), world=arena)
    session.run(1000)
    blocks = {box.name: box for box in arena.scene().boxes}
    for name in ("blue", "yellow", "red"):
        session.place("shown", (122, 0), (50, 50), blocks[name].color)
        session.run(800)
        session.remove("shown")
        session.run(800)
    session.set("mode", 1.0)
    session.run(600)  # until the first node is on
    way: list[np.ndarray] = []
    while float(session.read("item 4.node")) < 0:
        way.append(session.read("pose.output"))
        session.run(100)
    axes = part(figure)
    axes.set(xlim=(-336, 336), ylim=(-210, 210), facecolor="#f5f5f0")
    axes.set_axis_on()
    axes.set(xticks=[], yticks=[])
    for box in blocks.values():
        low = (box.center[0] - box.size[0] / 2, box.center[1] - box.size[1] / 2)
        axes.add_patch(Rectangle(low, *box.size, color=box.color))
    x, y, heading = np.array(way).T
    axes.plot(x, y, color="#202020", linewidth=2.2)
    axes.add_patch(
        Circle((x[-1], y[-1]), 27.5, facecolor="white", edgecolor="#202020", linewidth=1.6, zorder=3)
    )
    ahead = 27.5 * np.array([np.cos(heading[-1]), np.sin(heading[-1])])
    axes.plot([x[-1], x[-1] + ahead[0]], [y[-1], y[-1] + ahead[1]], color="#202020", linewidth=2, zorder=4)
    return figure


def binding() -> Figure:
    """The field over both dimensions while a feature is cued, its read-outs at its left and below."""
    figure = blank()
    now = run("binding", "bound.activation", "feature.activation", "space.activation").sel(time=590)
    bound, feature, space = (now[f"{name}.activation"].values for name in ("bound", "feature", "space"))
    heat(part(figure, (0.1, 0.16, 0.9, 0.84)), bound, -6, 4)
    heat(part(figure, (0, 0.16, 0.085, 0.84)), np.repeat(feature[None], 2, 0), -6, 9, threshold=False)
    heat(part(figure, (0.1, 0, 0.9, 0.136)), np.repeat(space[:, None], 2, 1), -6, 9, threshold=False)
    return figure


def remapping() -> Figure:
    """A position that jumps on the retina, above, is constant relative to the body, below."""
    figure = blank()
    data = run("remapping", "diagonal.retina.activation", "diagonal.body.activation")
    heat(part(figure, (0, 0.54, 1, 0.46)), data["diagonal.retina.activation"].values, -8, 6, threshold=False)
    heat(part(figure, (0, 0, 1, 0.5)), data["diagonal.body.activation"].values, -8, 6, threshold=False)
    return figure


def change_detection() -> Figure:
    """The contrast field above, the memory in the middle, the decision below."""
    figure = blank()
    data = run("change_detection", "contrast.activation", "memory.activation", "different.activation")
    heat(part(figure, (0, 0.62, 1, 0.38)), data["contrast.activation"].values, -9, 5, threshold=False)
    heat(part(figure, (0, 0.22, 1, 0.38)), data["memory.activation"].values, -9, 8, threshold=False)
    course(part(figure, (0, 0, 1, 0.2)), data["different.activation"], -8, 9)
    return figure


PICTURES: tuple[Callable[[], Figure], ...] = (
    detection,
    selection,
    working_memory,
    forgetting,
    boost,
    node,
    timed_stimuli,
    correlated_noise,
    projection,
    groups,
    motor_attractor,
    saliency,
    plan,
    spa,
    behaviours,
    serial_order,
    color_search,
    pointing,
    looking,
    binding,
    remapping,
    change_detection,
)


def scale_colors() -> Image.Image:
    """The colours of the scale, pure and mixed with the white of lines, for pictures that hold no others."""
    lines = np.array([to_rgb(ACTIVATION), to_rgb(EMBER)])
    pure = np.array([*COLORS(np.linspace(0, 1, 40))[:, :3], *lines, to_rgb("#202020")])
    ground = np.array(DARK[:3])
    mixed = [pure[::5] * (1 - part) + part for part in (0.33, 0.67)]
    mixed += [ground * (1 - part) + lines * part for part in (0.3, 0.6, 0.8)]
    palette = Image.new("P", (1, 1))
    palette.putpalette((np.concatenate([pure, *mixed, [[1, 1, 1]]]) * 255).round().astype(np.uint8).tobytes())
    return palette


def write(figure: Figure, path: Path, photograph: bool) -> None:
    """A small file: as many colours as the eye sees."""
    drawn = io.BytesIO()
    FigureCanvasAgg(figure).print_png(drawn)
    picture = Image.open(drawn).convert("RGB").resize(SIZE, Image.Resampling.BOX)
    few = (
        picture.quantize(40)
        if photograph
        else picture.quantize(palette=scale_colors(), dither=Image.Dither.NONE)
    )
    few.save(path, optimize=True)


def main(folder: Path = HERE) -> None:
    """Draw every example."""
    for draw in PICTURES:
        write(
            draw(),
            folder / f"{draw.__name__}.png",
            photograph=draw in (saliency, color_search, pointing, looking),
        )


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
