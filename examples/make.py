"""Write the examples: one document for each idea, made with the public calls that any script uses.

    python examples/make.py

Every function below makes one document, `NAME.json`, and its notes say what to look at.
`tests/docs/test_examples.py` runs each of them and checks what its notes claim.
"""

from __future__ import annotations

import itertools
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import deodar as dd

HERE = Path(__file__).parent
Layout = dict[str, Any]
TITLES = {"world": "World", "inspector": "Inspector", "graph": "Architecture", "pins": "Sliders"}
HEIGHT = 700
"""Height of the studio's panels on a page of 1280 x 800 pixels."""

X = dd.Axis("x", 0, 100, samples=101, unit="deg")


def field(name: str, excitation: float, inhibition: float, axis: dd.Axis = X, **others: object) -> dd.Field:
    """A field with local excitation and global inhibition; the two numbers decide what it does with its
    input.
    """
    kernel = [dd.Gaussian(excitation, 5, normalized=True)]
    given: dict[str, object] = {
        "tau": 20,
        "resting_level": -5,
        "sigmoid": dd.Logistic(beta=4),
        "global_inhibition": inhibition,
    } | others
    return dd.Field(name, [axis], kernel=kernel, **given)  # type: ignore[arg-type]


def detection() -> dd.Model:
    """Input that grows in steps through the detection instability, and shrinks again."""
    model = dd.Model("detection")
    u = model.add(field("u", 8, 0.1, noise=0.2))
    model.add(dd.GaussianStimulus("weak", [X], center=50, sigma=5, amplitude=3.5, windows=[(100, 1000)])) >> u
    model.add(dd.GaussianStimulus("more", [X], center=50, sigma=5, amplitude=2.5, windows=[(400, 700)])) >> u
    model.describe(
        notes=(
            "Detection. An input that grows makes a peak all at once; the peak stays when the input shrinks"
            " again. An input of 3.5 comes at 100 ms and leaves the field below threshold. At 400 ms it grows"
            " to 6 and one peak arises at 50 deg. At 700 ms it is 3.5 again: the peak stays, where there was"
            " none before (hysteresis). At 1000 ms the input goes, and the peak with it. Run it for 1300 ms."
        )
    )
    return model


def selection() -> dd.Model:
    """Two inputs of the same strength, one peak."""
    model = dd.Model("selection")
    u = model.add(field("u", 12, 0.6, noise=1.0))
    for name, center in (("left", 30), ("right", 70)):
        (
            model.add(
                dd.GaussianStimulus(name, [X], center=center, sigma=5, amplitude=6, windows=[dd.Window(100)])
            )
            >> u
        )
    model.describe(
        notes=(
            "Selection. Two inputs of the same strength, one peak: the field decides. The inputs come at"
            " 100 ms, at 30 and 70 deg. Both grow, and one wins: at 600 ms exactly one peak is left. The"
            " noise decides which one: each wins in about half of the trials. Run 100 trials for 600 ms."
        )
    )
    return model


def working_memory() -> dd.Model:
    """A peak that outlives its input."""
    model = dd.Model("working memory")
    # as points its edges are narrower than a sample: it would not drift
    u = model.add(field("u", 18, 0.3, noise=0.13, noise_length=1, quadrature="cell"))
    model.add(dd.GaussianStimulus("cue", [X], center=35, sigma=5, amplitude=6, windows=[(100, 300)])) >> u
    model.describe(
        notes=(
            "Working memory. A peak that outlives its input. An input at 35 deg is there from 100 to 300 ms."
            " The peak it makes sustains itself: at 1500 ms there is still one peak, within 5 deg of where"
            " the input was. Run it for 1500 ms."
        )
    )
    return model


def forgetting() -> dd.Model:
    """Reverse detection: a homogeneous inhibition erases a memory."""
    model = working_memory()
    model.describe(name="forgetting")
    model.add(dd.Boost("inhibition", [X], amplitude=-3, windows=[(900, 1100)])) >> model["u"]
    model.describe(
        notes=(
            "Forgetting. Inhibition of the whole field erases a memory. The working memory again, and a"
            " homogeneous inhibition of -3 from 900 to 1100 ms. It takes the field through the reverse"
            " detection instability: the peak is there at 900 ms, gone at 1100 ms, and does not come back."
            " Run it for 1500 ms."
        )
    )
    return model


def boost() -> dd.Model:
    """A homogeneous boost turns graded traces into one decision."""
    model = dd.Model("boost")
    u = model.add(field("u", 12, 0.6, noise=0.2))
    for name, center, amplitude in (("frequent", 65, 2.0), ("rare", 30, 1.4)):
        model.add(dd.GaussianStimulus(name, [X], center=center, sigma=5, amplitude=amplitude)) >> u
    model.add(dd.Boost("boost", [X], amplitude=2.6, windows=[(300, 900)])) >> u
    model.describe(
        notes=(
            "Boost. Lifting the whole field turns weak traces into one decision. Two weak inputs preshape the"
            " field at 65 deg (2.0) and 30 deg (1.4); both stay below threshold. At 300 ms a boost of 2.6"
            " lifts the whole field, and one peak arises at the stronger preshape, 65 deg, as high as any"
            " other. At 900 ms the boost goes, and the peak too. Run it for 1200 ms."
        )
    )
    return model


def projection() -> dd.Model:
    """A colour selects a place: a one-dimensional field, a two-dimensional one, and back."""
    hue = dd.Axis("hue", 0, 360, samples=36, periodic=True, unit="deg")
    place = dd.Axis("place", 0, 50, samples=51, unit="cm")
    model = dd.Model("projection")
    colour = model.add(
        dd.Field(
            "colour",
            [hue],
            resting_level=-5,
            kernel=[dd.Gaussian(10, 20, normalized=True)],
            global_inhibition=0.02,
            noise=0.2,
        )
    )
    scene = model.add(
        dd.Field(
            "scene",
            [place, hue],
            resting_level=-5,
            kernel=[dd.Gaussian(12, [3, 20], normalized=True)],
            global_inhibition=0.004,
            noise=0.2,
        )
    )
    where = model.add(
        dd.Field(
            "where",
            [place],
            resting_level=-5,
            kernel=[dd.Gaussian(10, 3, normalized=True)],
            global_inhibition=0.1,
            noise=0.2,
        )
    )
    for name, at in (("red", [12, 0]), ("green", [36, 120])):
        model.add(dd.GaussianStimulus(name, [place, hue], center=at, sigma=[3, 20], amplitude=3.5)) >> scene
    (
        model.add(dd.GaussianStimulus("cue", [hue], center=120, sigma=20, amplitude=7, windows=[(300, 5000)]))
        >> colour
    )
    colour >> dd.Gain(3) >> model.add(dd.Project([place, hue], name="expand")) >> scene
    scene >> model.add(dd.Project([place], name="contract")) >> dd.Gain(0.15) >> where
    model.describe(
        notes=(
            "Projection. A colour selects a place, through a field over both. A scene of two objects, red at"
            " 12 cm and green at 36 cm, over place and hue; neither makes a peak. At 300 ms a colour cue"
            " makes a peak at 120 deg in `colour`; its output expands over place into a ridge in `scene`,"
            " where it meets the green object: one peak. Contracted over hue it makes one peak in `where`, at"
            " 36 cm. Run it for 900 ms."
        )
    )
    return model


def node() -> dd.Model:
    """A node with self-excitation: a switch."""
    model = dd.Model("node")
    u = model.add(
        dd.Field(
            "u", [], tau=20, resting_level=-2, sigmoid=dd.Logistic(beta=8), kernel=[dd.Gaussian(4)], noise=0.1
        )
    )
    model.add(dd.Boost("on", [], amplitude=3, windows=[(200, 350)])) >> u
    model.add(dd.Boost("off", [], amplitude=-3, windows=[(700, 850)])) >> u
    model.describe(
        notes=(
            "Node. A field of no dimension that excites itself is a switch. With self-excitation 4 and"
            " resting level -2 it has two stable states, near -2 and +2. A pulse at 200 ms turns it on, and"
            " it stays on; a pulse at 700 ms turns it off, and it stays off. Run it for 1100 ms."
        )
    )
    return model


def correlated_noise() -> dd.Model:
    """Noise with a correlation length makes peaks by itself, here and there."""
    model = dd.Model("correlated noise")
    kernel = [dd.Gaussian(12, 5, normalized=True)]
    model.add(
        dd.Field(
            "u",
            [X],
            tau=10,
            resting_level=-1.5,
            kernel=kernel,
            global_inhibition=0.5,
            noise=3,
            noise_length=8,
        )
    )
    model.describe(
        notes=(
            "Correlated noise. Noise that neighbours share makes peaks by itself, here and there. A field"
            " below detection, without any input. Neighbours within about 8 deg share their noise, so that"
            " it can lift a whole stretch over the threshold. At 400 ms about half of the trials hold one"
            " peak, none holds two, and the peaks lie anywhere in the field. `noise` is here the standard"
            " deviation at a point; with a correlation length, refining the grid leaves the rate of such"
            " events as it is. Run 100 trials for 400 ms."
        )
    )
    return model


def timed_stimuli() -> dd.Model:
    """Stimuli that come and go: a script without a script."""
    model = dd.Model("timed stimuli")
    u = model.add(field("u", 10, 0.3))
    (
        model.add(
            dd.BoxStimulus("early", [X], center=20, width=12, amplitude=6, windows=[(100, 300), (700, 900)])
        )
        >> u
    )
    (
        model.add(
            dd.BoxStimulus("late", [X], center=80, width=12, amplitude=6, windows=[(400, 600), (1000, 1200)])
        )
        >> u
    )
    model.describe(
        notes=(
            "Timed stimuli. Inputs come and go at times that the document states. Two box stimuli, each on"
            " in two windows of time. The peak is at 20 deg at 250 and 850 ms, and at 80 deg at 550 and 1150"
            " ms; at 50, 380 and 680 ms there is none: the windows are part of the document. Run it for 1300"
            " ms."
        )
    )
    return model


def behaviour() -> dd.Model:
    """The template: an intention that a condition of satisfaction switches off."""
    model = dd.Model("behaviour")
    sharp = dd.Logistic(beta=8)
    intention = model.add(
        dd.Field("intention", [], tau=20, resting_level=-2, sigmoid=sharp, kernel=[dd.Gaussian(4)])
    )
    satisfied = model.add(
        dd.Field("satisfied", [], tau=20, resting_level=-4, sigmoid=sharp, kernel=[dd.Gaussian(2)])
    )
    intention >> model.add(dd.Gain(2.5, name="expects")) >> satisfied
    satisfied >> model.add(dd.Gain(-6, name="ends")) >> intention
    return model


def groups() -> dd.Model:
    """Four behaviours from one template, with one document parameter for the speed of all."""
    model = dd.Model("groups")
    names = ("search", "approach", "grasp", "lift")
    model.parameter("tempo", 20.0)
    for name in names:
        model.insert(behaviour(), name)
        for part in ("intention", "satisfied"):
            model.link(f"{name}.{part}.tau", "tempo")
    model.add(dd.Boost("start", [], amplitude=4, windows=[(100, 200)])) >> model["search.intention"]
    for k, name in enumerate(names):
        begins = 500.0 + 600 * k
        (
            model.add(dd.Boost(f"{name} done", [], amplitude=3, windows=[(begins, begins + 200)]))
            >> model[f"{name}.satisfied"]
        )
    for before, after in itertools.pairwise(names):
        (
            model[f"{before}.satisfied"]
            >> model.add(dd.Gain(4, name=f"{before} then {after}"))
            >> model[f"{after}.intention"]
        )
    model.describe(
        notes=(
            "Groups. Four behaviours follow one another, each until its condition of satisfaction. They are"
            " copied from one template: a bistable intention node and a condition of satisfaction that ends"
            " it. One intention is on at a time, in the order search, approach, grasp, lift; each goes off"
            " when its signal `done` comes, at 500, 1100, 1700 and 2300 ms, and the next one begins. The"
            " document parameter `tempo` is the time constant of all eight nodes. Run it for 2800 ms."
        )
    )
    return model


def motor_attractor() -> dd.Model:
    """A motor variable turns to the place of a peak, and stays where it is without one."""
    heading = dd.Axis("heading", -180, 180, samples=180, periodic=True, unit="deg")
    model = dd.Model("motor attractor")
    target = model.add(field("target", 10, 0.1, heading, noise=0.1))
    (
        model.add(
            dd.GaussianStimulus("first", [heading], center=150, sigma=8, amplitude=7, windows=[(200, 900)])
        )
        >> target
    )
    (
        model.add(
            dd.GaussianStimulus(
                "second", [heading], center=-120, sigma=8, amplitude=7, windows=[(1300, 2000)]
            )
        )
        >> target
    )
    target >> model.add(dd.Attractor("turn", heading, tau=1500, initial=0))
    model.describe(
        notes=(
            "Motor attractor. A motor variable turns to the place of a peak, and keeps its value without"
            " one. The peak of `target` moves the motor variable `turn` to 150 deg; without a peak, from 900"
            " to 1300 ms, it stays there. Then a peak at -120 deg moves it the short way round, across 180"
            " deg: it ends at -120 deg and never passes 0. Run it for 2000 ms."
        )
    )
    return model


def saliency() -> dd.Model:
    """The architecture of `deodar demo saliency`."""
    model = dd.architectures.saliency(hue=0.0)
    model.describe(
        notes=(
            "Saliency. A colour cue selects an object in a picture, and a motor variable turns to it."
            " Sandamirskaya (2014), figure 2, over both dimensions of a picture. It senses a picture, so it"
            " is run with one: --world picture:FILE. A cue for red comes at 500 ms; where the picture holds a"
            " red object, exactly one peak arises on it in `perceptual` and in `spatial`, and `pan` and"
            " `tilt` turn to it. Run it for 3500 ms."
        )
    )
    return model


def plan() -> dd.Model:
    """A plan on a line: `dd.architectures.plan`."""
    model = dd.architectures.plan()
    model.describe(
        notes=(
            "Plan. A wave of motivation spreads from a goal until it meets the walker, who then goes there."
            " Billing, Lowe & Sandamirskaya (2015), figure 3. The goal is at 40 cm; in `left.motivation` the"
            " wave spreads to the right at a constant speed. Near step 85 it is at 100 cm, where the walker"
            " is: this place releases the precondition, `left.intention` rises, and it walks (`gone`). At"
            " step 450 the goal goes to 150 cm: the plan decays, another one spreads, and it walks back."
            " Time is in steps of 64 ms. Run it for 1200 steps."
        )
    )
    return model


def spa() -> dd.Model:
    """The architecture of `deodar demo spa`, for the Z-maze in metres."""
    model = dd.architectures.spa(dd.Arena("z"))
    model.describe(
        notes=(
            "Simultaneous planning and action. A robot plans its way through a maze by a wave of motivation,"
            " and follows it. Billing, Lowe & Sandamirskaya (2015), figure 4. It is run in an arena: --world"
            " arena:z. Four behaviours go north, south, west and east; each has a motivation, a precondition,"
            " an intention and a condition of satisfaction over the whole maze. Where the wave meets the"
            " robot, an intention rises, and the action field turns the wheels. Time is in steps of 64 ms."
            " Run it for 1000 steps."
        )
    )
    return model


def behaviours() -> dd.Model:
    """Templates: `dd.architectures.behaviour`."""
    model = dd.architectures.behaviours()
    model.describe(
        notes=(
            "Behaviours. Five elementary behaviours are ordered by precondition, suppression and"
            " competition. All tasks but `avoid` come at 100 ms. `find` is satisfied at 500 ms; only then"
            " `reach` begins. An obstacle from 900 to 1200 ms turns `avoid` on, which suppresses `reach`;"
            " afterwards it continues until the hand is at the target at 1600 ms, as `reach.outcome`"
            " predicts. `look left` and `look right` compete: noise decides which is first, and the other"
            " follows when the first is satisfied, at 700 ms. Run it for 2400 ms."
        )
    )
    return model


def serial_order() -> dd.Model:
    """Templates: `dd.architectures.serial_order`."""
    model = dd.architectures.lesson([30.0, 6.0, 30.0, 54.0])
    model.describe(
        name="serial order",
        notes=(
            "Serial order. A chain of ordinal nodes learns a sequence of four actions, one of them twice,"
            " and produces it. Sandamirskaya & Schöner (2010), without a robot. From 1000 to 5000 ms the"
            " actions 30, 6, 30, 54 are shown, one a second, and the weights `meaning` of successive ordinal"
            " nodes learn them. At 5000 ms all is cleared but the weights, at 5300 ms the first node is"
            " started. From 6000 ms on the places 6, 30 and 54 are perceived in turn, over and over; each"
            " action waits for its own, and the order is 30, 6, 30, 54 again. Run it for 11200 ms."
        ),
    )
    return model


def color_search() -> dd.Model:
    """The architecture of `deodar demo serial-order`, with the panels of the studio for a lesson."""
    model = dd.architectures.color_search(5)
    nodes = [model[f"item {k}.node"].id for k in range(1, 6)]
    traces = [{"element": e, "port": "output", "reduce": "at", "at": []} for e in nodes]
    traces.append({"element": model["satisfaction"].id, "port": "output", "reduce": "max", "at": []})
    plots = {
        "weights": (model["item 1.meaning"].id, "multiples", "weights", {"range": [-0.05, 1.05]}),
        "nodes": (nodes[0], "course", "output", {"traces": traces, "window": 10_000, "range": [-0.1, 1.1]}),
        "action": (model["action"].id, "curve", "activation", {}),
    }
    top = [(230, "pins"), (590, "inspector", "graph")]
    bottom = [(480, "nodes"), (340, "action")]
    columns = [(460, "world"), (820, [(285, top), (170, "weights"), (245, bottom)])]
    produce = {"element": "", "parameter": "mode", "lower": 0, "upper": 1, "label": "produce", "switch": True}
    model.describe(
        name="colour search",
        layout={"pins": [produce], "panels": _panels(columns, plots)},
        notes=(
            "Colour search. A robot is shown coloured blocks, one after another, and then looks for blocks of"
            " these colours in the same order. Sandamirskaya & Schöner (2010), section 5. Press Play. A click"
            " on a colour shows a block to the camera: the ordinal node that is on learns its colour and is"
            " switched off within half a second; its curve of `weights` then has a peak at this hue. Click"
            " again to take the block away: the next node is switched on. After the last block turn the"
            " switch produce on: the robot looks for the first colour. It is run with a Khepera in an arena:"
            ' --world "arena:search, unit=mm, vehicle=khepera, period=20, camera_every=4". Without a block'
            " the first node is on from 500 ms on. Run it for 1000 ms."
        ),
    )
    return model


def pointing() -> dd.Model:
    """The architecture of `deodar demo pointing`, with the panels of the studio for a table and an arm."""
    model = dd.architectures.pointing()
    names = ("red", "green", "left", "right")
    traces = [{"element": model[name].id, "port": "activation", "reduce": "at", "at": []} for name in names]
    traces.append({"element": model["satisfaction"].id, "port": "activation", "reduce": "max", "at": []})
    plots = {
        "perceptual": (model["perceptual"].id, "heat", "activation", {}),
        "cues": (model["red"].id, "course", "activation", {"traces": traces, "window": 10_000}),
    }
    say = [
        {
            "element": model[f"say {name}"].id,
            "parameter": "amplitude",
            "lower": 0,
            "upper": 3,
            "label": name,
            "switch": True,
        }
        for name in names
    ]
    top = [(230, "pins"), (350, "inspector", "graph")]
    right = (580, [(285, top), (240, "perceptual"), (175, "cues")])
    model.describe(
        layout={"pins": say, "panels": _panels([(700, "world"), right], plots)},
        notes=(
            "Pointing. An arm points at the object that a colour and a side name, such as the green object on"
            " the left. Lomp et al. (2016), section 5. Press Play. Turn on the switches of a colour and of a"
            " side, and off again: the nodes stay on, the perceptual field builds a peak at the object that"
            " the camera sees there, the arm points at it, and the condition of satisfaction ends all of it."
            " Drag an object during the reach, or pull at the arm. It needs the extra robots, and a world:"
            " --world mujoco:table. Without cues there is no peak. Run it for 500 ms."
        ),
    )
    return model


def looking() -> dd.Model:
    """The architecture of `deodar demo looking`, with the panels of the studio for an eye and its map."""
    model = dd.architectures.looking(seed=1)
    projections = {"pan map": ["column", "pan"], "tilt map": ["row", "tilt"]}
    plots: dict[str, tuple[str, str, str, Layout]] = {
        name: (model[name].id, "heat", "output", {})
        for name in ("events", "perceptual", "visual intention", "motor intention")
    }
    plots |= {
        name: (model["map"].id, "heat", "weights", {"drawn": drawn, "range": [0, 1]})
        for name, drawn in projections.items()
    }
    left = (440, [(400, "world"), (300, "inspector", "graph")])
    middle = (420, [(350, "events"), (350, "perceptual")])
    right = (420, [(240, "visual intention"), (220, "motor intention"), (240, *projections)])
    model.describe(
        layout={"panels": _panels([left, middle, right], plots)},
        notes=(
            "Looking. An event camera on a pan-tilt unit learns where to turn to have a blinking disc in its"
            " centre. Sandamirskaya (2014), section 3. Press Play, several times as fast. At first the gaze"
            " turns anywhere; each gaze that ends near the disc, or at a place that the map knows, changes"
            " the map. After some hundred gazes most end at the disc. It is run with an eye: --world eye. A"
            " map that was learned is written by `deodar demo looking`. Run it for 1500 ms."
        ),
    )
    return model


def _panels(columns: list[Any], plots: dict[str, tuple[str, str, str, Layout]]) -> Layout:
    """The arrangement of the studio's panels, as Dockview reads it.

    Columns, rows in them, columns in these, and so on: each a size and either the parts inside it, or the
    names of the panels that share a place, the first of which is shown.
    """
    panels: Layout = {}

    def part(size: int, *inside: Any) -> Layout:
        if isinstance(inside[0], list):
            return {"type": "branch", "size": size, "data": [part(*one) for one in inside[0]]}
        for name in inside:
            plot = dict(zip(("element", "kind", "port", "settings"), plots.get(name, ()), strict=False))
            kind = {"contentComponent": "plot", "params": plot} if plot else {"contentComponent": name}
            panels[name] = {"id": name, **kind, "title": TITLES.get(name, name)}
        group = {"id": f"{inside[0]} group", "views": list(inside), "activeView": inside[0]}
        return {"type": "leaf", "size": size, "data": group}

    root, width = part(HEIGHT, columns), sum(size for size, *_ in columns)
    grid = {"root": root, "width": width, "height": HEIGHT, "orientation": "HORIZONTAL"}
    return {"grid": grid, "panels": panels}


def binding() -> dd.Model:
    """Templates: `dd.architectures.feature_space`."""
    model = dd.architectures.binding()
    model.describe(
        notes=(
            "Binding. What is where: a cue for a feature brings its place, a cue for a place its feature."
            " Three objects lie below threshold in `bound`. At 200 ms a cue for 120 deg in `feature` makes a"
            " ridge, which meets the green object: one peak at 50 deg in `space`. It outlives the cue, until"
            " all is released at 800 ms. At 1000 ms a cue for 80 deg in `space` brings 240 deg in `feature`."
            " Run it for 1800 ms."
        )
    )
    return model


def remapping() -> dd.Model:
    """Templates: `dd.architectures.reference_frame`."""
    model = dd.architectures.remapping()
    model.describe(
        notes=(
            "Remapping. From the retina to the body, by a steered shift and by the diagonals of a field,"
            " with the same result. An object stays at 12 deg relative to the body; the gaze jumps to 15 deg"
            " at 400 ms and to -10 deg at 800 ms, so that it jumps on the retina to -3 and 22 deg. In both"
            " fields `body` its peak is at 12 deg before and after. At 1000 ms another object appears at -25"
            " deg. Run it for 1400 ms."
        )
    )
    return model


def change_detection() -> dd.Model:
    """Templates: `dd.architectures.change_detection`."""
    model = dd.architectures.change_trial()
    model.describe(
        name="change detection",
        notes=(
            "Change detection. Three colours are remembered, one has changed when they are shown again:"
            " different. A sample of 40, 130 and 250 deg is shown from 200 ms to 700 ms; `memory` stores it"
            " and inhibits `contrast` there. The test at 1700 ms has 180 instead of 130 deg: it alone makes"
            " a peak in `contrast`, and the node `different` comes on. Set `test 2.center` to 130, and"
            " `same` does. Run it for 2600 ms."
        ),
    )
    return model


EXAMPLES: tuple[Callable[[], dd.Model], ...] = (
    detection,
    selection,
    working_memory,
    forgetting,
    boost,
    projection,
    node,
    correlated_noise,
    timed_stimuli,
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


def main(folder: Path = HERE) -> None:
    """Write every document."""
    for make in EXAMPLES:
        dd.save(make(), folder / f"{make.__name__}.json", force=True)


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
