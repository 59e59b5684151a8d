"""Experiment files of the cases that the paper does not have: one lesson and one arena each, which the studio
opens and `deodar experiment` runs; trials differ in their noise.
"""

from __future__ import annotations

from pathlib import Path

from deodar import codec
from deodar.codec import JsonObject
from deodar.experiments.actions import Action, Move, Place, Remove, Set
from deodar.experiments.events import All, Crosses, Event
from deodar.experiments.experiment import Experiment
from deodar.experiments.measures import Measure
from deodar.experiments.trial import TrialPlan
from deodar.model import output
from deodar_papers.serial_order.arenas import BLOCK, HEIGHT, SearchArena
from deodar_papers.serial_order.colours import rgb
from deodar_papers.serial_order.conditions import CARRIED, CuedCondition, SearchCondition, conditions
from deodar_papers.serial_order.cued import AFTER
from deodar_papers.serial_order.runs import COARSE, OVER, Settings, TaughtRun, prepared
from deodar_papers.serial_order.teaching import Showing, brief_lesson
from deodar_papers.serial_order.trials import free
from deodar_papers.serial_order.world import FRAMES, NOISE, PERIOD, SIDES, Lesson, placed

CASES = ("ten", "cued", "cued-changed", "carried")
"""Conditions that have an experiment file."""

TRIALS, LONGEST = 50, 600.0
"""Trials of an experiment, and longest production, s."""

SHOWN = "shown"
"""The block of a lesson; there is one at a time."""


def write(folder: Path) -> list[Path]:
    """Write the experiments with their models and arenas, and return the experiment files."""
    return [_write(name, folder) for name in CASES]


def _write(name: str, folder: Path) -> Path:
    c = conditions(False)[name]
    arena, layout = c.arena(0), f"{name}.arena.json"
    output.write(folder / layout, (codec.text(_layout(arena), finite=True) + "\n").encode())
    path = folder / f"{name}.json"
    experiment(name, f"arena:{layout}{_settings()}").save(path, force=True)
    return path


def experiment(name: str, world: str) -> Experiment:
    """Return the experiment of a condition: its first run, with a brief lesson.

    A trial whose sequence is complete has the outcome `complete`. `colour K` is the hue (of 180) that the
    action field holds when the vehicle looks for item K.

    Args:
        name: name of the condition, one of `CASES`.
        world: the arena, as on the command line.
    """
    c = conditions(False)[name]
    lesson, second, begins = _lessons(c)
    length = len(c.sequence(0))
    model = prepared(length, Settings(cues=2 if isinstance(c, CuedCondition) else 1))
    model.set("mode", 0.0)
    times = round(OVER / COARSE)
    events: list[Event] = [Crosses("has an action", "strongest action.output", 0.0, ends=False)]
    for k in range(1, length + 1):
        events.append(Crosses(f"looks for {k}", f"produced {k}.output", 0.5, ends=False))
        events.append(All(f"wants {k}", [f"looks for {k}", "has an action"], ends=False))
    events.append(Crosses("complete", f"produced {length + 1}.output", 0.5, times=times))
    return Experiment(
        f"serial order: {name}",
        model,
        TrialPlan(
            begins + 1000.0 * LONGEST,
            events=events,
            measures=[
                Measure(f"colour {k}", "hue of action.output", when=f"wants {k}")
                for k in range(1, length + 1)
            ],
            actions=[
                *(action for showing in lesson for action in _shown(c.arena(0), showing)),
                Set(begins, "mode", 1.0),
                *(
                    Place(
                        begins, f"block {k}", block.center, (BLOCK, BLOCK), rgb(block.letter), height=HEIGHT
                    )
                    for k, block in enumerate(c.arena(0).blocks)
                ),
                *_events(c, second, begins),
            ],
            every=COARSE,
        ),
        trials=TRIALS,
        world=world,
    )


def _lessons(c: SearchCondition) -> tuple[Lesson, float, float]:
    """Return the showings of a condition's first run, the time at which those of its second sequence begin,
    and that at which production begins, ms.
    """
    if not isinstance(c, CuedCondition):
        lesson, lasts = brief_lesson(c.sequence(0))
        return lesson, lasts, lasts
    first, second = c.pair(0)
    lesson, begins = brief_lesson(first)
    later, lasts = brief_lesson(second)
    return (*lesson, *(showing.later(begins) for showing in later)), begins, begins + lasts


def _shown(arena: SearchArena, showing: Showing) -> list[Action]:
    """Return the actions that show a block: at the side, in the middle, and taken away."""
    out = list[Action]()
    for side in SIDES:
        center, color, (begins, _) = placed(arena, showing, side)
        out.append(Place(begins, SHOWN, center, (BLOCK, BLOCK), color, height=HEIGHT))
    return [*out, Remove(showing.ends, SHOWN)]


def _events(c: SearchCondition, second: float, begins: float) -> list[Action]:
    """Return the actions of a condition on its first run, besides lesson and arena."""
    if isinstance(c, CuedCondition):
        cue, position = c.cue(0), c.position(0)
        out: list[Action] = [Set(second, "cue", 2.0), Set(begins, "cue", float(cue))]
        if position:
            out.append(Set(AFTER, "cue", float(3 - cue), when=f"looks for {position}"))
        return out
    if c.event == "carried":
        run = TaughtRun(c.sequence(0), *brief_lesson(c.sequence(0)), c.arena(0))
        return [Move(CARRIED, "khepera", free(run), when="looks for 2")]
    return []


def _layout(arena: SearchArena) -> JsonObject:
    """Return the arena without its blocks, which are placed when production begins."""
    x, y, heading = arena.start
    return {**arena.layout(), "start": [x, y], "heading": heading}


def _settings() -> str:
    """Return the settings of the world, as on the command line."""
    noise = {name: getattr(NOISE, name) for name in ("hue_noise", "outliers", "slip", "infrared_noise")}
    settings = {"unit": "mm", "vehicle": "khepera", "period": PERIOD, "camera_every": FRAMES, **noise}
    return "".join(f", {name}={value}" for name, value in settings.items())
