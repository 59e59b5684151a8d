"""Public names that have changed: the table old -> new, and the errors that old names raise.

CHANGELOG.md has the same table; a test compares the two. Flat names are written `dd.NAME`, others with
their full path.
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterable
from typing import Any, ParamSpec, TypeVar

from deodar.errors import UnknownName, did_you_mean

P = ParamSpec("P")
R = TypeVar("R")

RENAMED = {
    "dd.Camera(number=...)": "dd.Camera(source=...)",
    "dd.Element.faults": "dd.Element.validate",
    "dd.Element.lasting": "dd.Element.learned_parameters",
    "dd.Element.misfits": "dd.Element.validate_axes",
    "dd.Element.outside": "dd.Element.external_code",
    "dd.Element.push": "dd.Element.inject",
    "dd.Element.sees_output": "dd.Element.reads_own_output",
    "dd.Element.settle": "dd.Element.hoist",
    "dd.Element.sharing": "dd.Element.convolution",
    "dd.Element.wants": "dd.Element.input_axes",
    "dd.Experiment.bench": "dd.Experiment.setup",
    "dd.Model.add(every=...)": "dd.Model.add(ticks=...)",
    "dd.Model.change": "dd.Model.set",
    "dd.Model.every": "dd.Model.set_ticks",
    "dd.Move(thing=...)": "dd.Move(object=...)",
    "dd.MovingGaussian(path=...)": "dd.MovingGaussian(waypoints=...)",
    "dd.Place(thing=...)": "dd.Place(object=...)",
    "dd.Remove(thing=...)": "dd.Remove(object=...)",
    "dd.Session.look": "dd.Session.read_ports",
    "dd.Session.push": "dd.Session.inject",
    "dd.Session.require_push": "dd.Session.require_injection",
    "dd.Setting.choices": "dd.Setting.convolve",
    "dd.Setting.shared": "dd.Setting.convolve",
    "dd.Setting.waves": "dd.Setting.convolve",
    "dd.Time.every": "dd.Time.ticks",
    "dd.animate_path(every=...)": "dd.animate_path(stride=...)",
    "dd.animate_path(trial=...)": "dd.animate_path(dd.figures.View(variable, trial=...))",
    "dd.animate_path(where=...)": "dd.animate_path(dd.figures.View(variable, where=...))",
    "dd.architectures.follow(limit=...)": "dd.architectures.follow(ending=Ending(limit=...))",
    "dd.architectures.follow(radius=...)": "dd.architectures.follow(ending=Ending(radius=...))",
    "dd.architectures.follow(times=...)": "dd.architectures.follow(ending=Ending(times=...))",
    "dd.architectures.two_layer_field(noise=...)": (
        "dd.architectures.two_layer_field(excitatory=Layer(noise=...))"
    ),
    "dd.architectures.two_layer_field(resting_inhibition=...)": (
        "dd.architectures.two_layer_field(inhibitory=Layer(resting_level=...))"
    ),
    "dd.architectures.two_layer_field(resting_level=...)": (
        "dd.architectures.two_layer_field(excitatory=Layer(resting_level=...))"
    ),
    "dd.architectures.two_layer_field(sigmoid=...)": (
        "dd.architectures.two_layer_field(excitatory=Layer(sigmoid=...))"
    ),
    "dd.architectures.two_layer_field(sigmoid_inhibition=...)": (
        "dd.architectures.two_layer_field(inhibitory=Layer(sigmoid=...))"
    ),
    "dd.architectures.two_layer_field(tau=...)": (
        "dd.architectures.two_layer_field(excitatory=Layer(tau=...))"
    ),
    "dd.architectures.two_layer_field(tau_inhibition=...)": (
        "dd.architectures.two_layer_field(inhibitory=Layer(tau=...))"
    ),
    "dd.carry_out": "dd.run_jobs",
    "dd.demos": "dd.papers",
    "dd.selects(isolated=...)": "dd.selection(isolated=...)",
    "deodar.analysis.paths.divergence": "dd.path_divergence",
    "deodar.analysis.paths.length": "dd.path_length",
    "deodar.analysis.paths.until": "dd.path_until",
    "deodar.analysis.phase_figure": "dd.phase_figure",
    "deodar.analysis.regimes_figure": "dd.regimes_figure",
    "deodar.analysis.shortest.grid": "dd.arena_grid",
    "deodar.analysis.shortest.shortest": "dd.shortest_path",
    "deodar.architectures.cascade.recorded": "dd.architectures.cascade_paths",
    "deodar.architectures.serial_order.end": "dd.architectures.lesson_end",
    "deodar.architectures.serial_order.production": "dd.architectures.production_start",
    "deodar.demos": "dd.papers",
    "deodar.experiments.jobs.carry_out": "dd.run_jobs",
    "deodar.experiments.results.load": "dd.load_results",
    "deodar.experiments.run.run": "dd.run_trial",
    "deodar.figures.path.animate": "dd.animate_path",
    "deodar.figures.path.draw": "dd.path_figure",
    "deodar.figures.projection.draw": "dd.projection",
    "deodar.figures.snapshot.draw": "dd.snapshot",
    "deodar.figures.snapshots.draw": "dd.snapshots",
    "deodar.figures.space_time.draw": "dd.space_time",
    "deodar.figures.time_course.draw": "dd.time_course",
    "deodar.importers.presets.apply": "dd.apply_preset",
    "deodar.model.document.Document.knobs": "dd.Model(...).document.parameters",
    "deodar.papers.saliency.scenes.look": "dd.papers.saliency.scenes.run_scene",
    "deodar.papers.spa.narrative.go": "dd.papers.spa.narrative.run",
    "deodar.recording.files.load": "dd.load_record",
    "deodar.recording.files.save": "dd.save_record",
    "deodar.runtime": "deodar.session, deodar.batch and deodar.live",
    "deodar.worlds.arena.Arena": "dd.Arena",
}
"""The new name of each old name."""


def fix(old: str) -> str:
    """Return what to write instead of an old name, as the `fix` of an error; "" for a name that was never
    public.
    """
    return f"{old} is now {RENAMED[old]}" if old in RENAMED else ""


def missing(module: str, name: str, known: Iterable[str] = ()) -> AttributeError:
    """Make the error for a name that a module does not have: the new name of a renamed one, else the nearest
    known name.
    """
    hint = fix(f"dd.{name}" if module == "deodar" else f"{module}.{name}") or (
        "" if name.startswith("_") else did_you_mean(name, known)
    )
    text = f"module {module!r} has no attribute {name!r}"
    return AttributeError(f"{text}. {hint}" if hint else text, name=name, obj=None)


def no_member(obj: object, name: str) -> AttributeError:
    """Make the error for an attribute that an object does not have; Python suggests the nearest one.

    A class is in the table under `dd`, or with its full path if it is not public.
    """
    kind = type(obj).__name__
    text = f"{kind!r} object has no attribute {name!r}"
    hint = fix(f"dd.{kind}.{name}") or fix(f"{type(obj).__module__}.{kind}.{name}")
    return (
        AttributeError(f"{text}. {hint}", name=name, obj=None)
        if hint
        else AttributeError(text, name=name, obj=obj)
    )


def arguments(call: str) -> Callable[[Callable[P, R]], Callable[P, R]]:
    """Make a decorator for a public function, under its name in the table: a call with an old argument raises
    an error that states the new one.
    """
    old = {
        key.removeprefix(f"{call}(").removesuffix("=...)") for key in RENAMED if key.startswith(f"{call}(")
    }

    def decorate(function: Callable[P, R]) -> Callable[P, R]:
        @functools.wraps(function)
        def checked(*args: P.args, **kwargs: P.kwargs) -> R:
            for name in old & kwargs.keys():
                raise UnknownName(f"{call} has no argument {name!r}", fix=fix(f"{call}({name}=...)"))
            return function(*args, **kwargs)

        return checked

    return decorate


def moved(module: str) -> ImportError:
    """Make the error that a module raises when it is imported by its old name."""
    return ImportError(fix(module), name=module)


def left(module: str) -> Callable[[str], Any]:
    """Make the `__getattr__` of a module from which public names have moved.

    An old name raises ImportError, because `from MODULE import NAME` replaces the message of an
    AttributeError with its own.
    """

    def __getattr__(name: str) -> Any:
        old = f"{module}.{name}"
        if old in RENAMED:
            raise ImportError(fix(old), name=module)
        raise missing(module, name)

    return __getattr__
