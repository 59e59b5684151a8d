"""An experiment as data: which model, which trials, what may happen, what is done, what is measured."""

from __future__ import annotations

import dataclasses as dc
import json
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, cast

from deodar.errors import DeodarError, DocumentError, ParameterError, Problem, RunWarning, did_you_mean
from deodar.experiments import actions as done
from deodar.experiments import events as happens
from deodar.experiments.actions import Action
from deodar.experiments.events import Event
from deodar.experiments.factor import DESIGNS, Factor, assign
from deodar.experiments.measures import Measure
from deodar.experiments.plain import from_data, schema, to_data
from deodar.experiments.tally import DIVERGED
from deodar.model import files, output
from deodar.model.model import Model, save
from deodar.parameters import Part, Recompile, show
from deodar.worlds._base import World

if TYPE_CHECKING:
    import xarray

    from deodar.experiments.bench import Bench
    from deodar.experiments.jobs import Standing

VERSION = 1
EVENTS = (happens.Crosses, happens.Reached, happens.Appears, happens.Vanishes, happens.Within, happens.Leaves, happens.All, happens.AnyOf)
ACTIONS = (done.Place, done.Move, done.Remove, done.Set, done.Ramp, done.Push, done.Record, done.Snapshot, done.Reset, done.End)
KINDS: Mapping[str, Mapping[str, type[Part]]] = {
    "conditions": {cls.__name__: cls for cls in EVENTS},
    "actions": {cls.__name__: cls for cls in ACTIONS},
    "factors": {"Factor": Factor},
    "measures": {"Measure": Measure},
}
"""What may stand under each key of a file."""

OWN = ("trial", "key", "outcome", "awaited", "diverged", "duration", "time")
"""Names of columns that every table has."""


@dataclass(frozen=True)
class Experiment(Part):
    """An unattended experiment: many trials of a model, each until a condition ends it, with one row of a table for each.

    Trials run beside each other in batches where nothing is done to them on the way and their world, if there is one, can be computed inside
    the step; otherwise one by one. Trial k has the noise of trial k of the seed, whatever runs beside it.

    Attributes:
        name: what it is called.
        model: the model, or the path of its document.
        limit: document time after which a trial ends at the latest.
        trials: of each combination of levels; with a random design of the whole experiment.
        conditions: what may happen; those that `ends` says end a trial, and give its outcome.
        actions: what is done to each trial, and when.
        factors: what trials differ in.
        measures: what is measured of each trial.
        design: `crossed`, `shuffled` (the same in an order drawn from the seed) or `random` (levels drawn for each trial).
        seed: of all noise, and of what is drawn.
        every: document time between looks (and records); none: each step.
        record: paths of ports of which every trial keeps a record.
        world: what sensors read and motors move: a world, or KIND:ARGUMENT as on the command line.
        dt: Euler step; none: the document's own.
        precision: float32 or float64.
    """

    name: Annotated[str, Recompile(meaning="what it is called")]
    model: Annotated[object, Recompile(meaning="the model, or the path of its document")]
    limit: Annotated[float, Recompile("time", role="duration", lower=0.0, meaning="after which a trial ends at the latest")]
    trials: Annotated[int, Recompile(lower=1, meaning="of each combination of levels")] = 1
    conditions: Annotated[Sequence[Event], Recompile(meaning="what may happen")] = ()
    actions: Annotated[Sequence[Action], Recompile(meaning="what is done to each trial, and when")] = ()
    factors: Annotated[Sequence[Factor], Recompile(meaning="what trials differ in")] = ()
    measures: Annotated[Sequence[Measure], Recompile(meaning="what is measured of each trial")] = ()
    design: Annotated[str, Recompile(choices=DESIGNS, meaning="how trials are given levels")] = dc.field(default="crossed", kw_only=True)
    seed: Annotated[int, Recompile(lower=0, upper=2**32 - 1, meaning="of all noise, and of what is drawn")] = dc.field(default=0, kw_only=True)
    every: Annotated[float | None, Recompile("time", role="duration", meaning="between looks; none: each step")] = dc.field(
        default=None, kw_only=True
    )
    record: Annotated[Sequence[str], Recompile(meaning="ports of which a record is kept")] = dc.field(default=(), kw_only=True)
    world: Annotated[object, Recompile(meaning="what sensors read and motors move")] = dc.field(default=None, kw_only=True)
    dt: Annotated[float | None, Recompile("time", role="duration", meaning="Euler step; none: the document's own")] = dc.field(
        default=None, kw_only=True
    )
    precision: Annotated[str, Recompile(choices=("float32", "float64"), meaning="of all numbers")] = dc.field(default="float32", kw_only=True)

    def __post_init__(self) -> None:
        if self.world is None:  # a parameter that may be anything may also be nothing
            object.__setattr__(self, "world", "")
        super().__post_init__()

    def faults(self) -> Iterator[tuple[str, str]]:
        if not isinstance(self.model, (Model, str, Path)):
            yield "model", f"needs a model or the path of its document, not {show(self.model)}"
        if not isinstance(self.world, (World, str)):
            yield "world", f"needs a world, or text such as arena:blocks, not {show(self.world)}"
        names = [p.name for p in (*self.conditions, *self.factors, *self.measures)]
        for name in dict.fromkeys(names):
            if not name or name in OWN or names.count(name) > 1:
                what = "is the name of two columns" if names.count(name) > 1 else "is a column of every table" if name else "is no name"
                yield "conditions, factors and measures", f"{name!r} {what}; give each a name of its own"

    # -------------------------------------------------------------------------------- what it will do

    @property
    def cells(self) -> list[tuple[int, ...]]:
        """For each trial the level (its number) of each factor."""
        return assign(self.factors, self.design, self.trials, self.seed)

    def bench(self, trust: bool = False) -> Bench:
        """The experiment with its model and its world opened, and everything checked that can be checked before a trial runs.

        Raises:
            ParameterError: it names what is not there, or holds what cannot be; all problems are listed.
        """
        from deodar.experiments.bench import Bench

        return Bench.open(self, trust)

    def check(self) -> list[Problem]:
        """What is wrong with it; nothing where it can be run."""
        try:
            self.bench(trust=True)
        except DeodarError as error:
            return list(error.problems)
        return []

    def run(
        self,
        out: str | Path | None = None,
        workers: int | None = None,
        progress: Callable[[Standing], None] | None = None,
        trust: bool = False,
    ) -> xarray.Dataset:
        """Run all trials that are not there yet, and give the table of all.

        Args:
            out: folder of the results. The run of an earlier call in this folder is resumed, with the same results as without the stop. None:
                nothing is kept.
            workers: number of processes of one core each; none: this process.
            progress: called with a `Standing` after each piece.
            trust: whether functions that the document names may be imported and run.

        Returns:
            A Dataset over `trial`: levels as coordinates; outcome, duration, times of conditions (NaN: did not happen) and measures as variables.
            A trial that diverges has the outcome `diverged`, and NaN for every number; the variable `diverged` gives its reason, the attribute
            `diverged` counts such trials, and a `RunWarning` repeats it. The rows of the other trials are not affected. A `RunWarning` is also
            given before trials that may take 10^9 steps in total.

        Raises:
            OutputExists: the folder holds another experiment, or something else.
            KeyboardInterrupt: on Ctrl-C, when the pieces that run are done; their rows are kept.
        """
        from deodar.experiments.results import carry
        from deodar.runtime.simulate import LONG_STEPS

        bench = self.bench(trust)
        if bench.trials * bench.steps >= LONG_STEPS:
            total = f"{bench.trials * bench.steps:.3g} steps in total ({bench.trials} trials of at most {bench.steps:.3g} steps of dt = {bench.dt:g})"
            warnings.warn(f"{total}: a smaller number may be meant", RunWarning, stacklevel=2)
        data = carry(bench, out, workers, progress)
        if DIVERGED in data.attrs:
            warnings.warn(str(data.attrs[DIVERGED]), RunWarning, stacklevel=2)
        return data

    # -------------------------------------------------------------------------------- files

    def to_data(self) -> dict[str, Any]:
        """Plain data, as a file holds it; a model or a world that is no file is left out."""
        out: dict[str, Any] = {"experiment": VERSION, "name": self.name}
        out |= {"model": str(self.model)} if isinstance(self.model, (str, Path)) else {}
        out |= {"world": self.world} if isinstance(self.world, str) and self.world else {}
        out |= to_data(self, False, ("name", "model", "world", *KINDS))
        for key in KINDS:
            parts = cast("Sequence[Any]", getattr(self, key))
            plain = [to_data(part, key in ("conditions", "actions")) for part in parts]
            if plain:
                out[key] = plain if key == "actions" else {part.name: data for part, data in zip(parts, plain, strict=True)}
        return out

    @classmethod
    def from_data(cls, data: Any, folder: Path | None = None) -> Experiment:
        """The experiment that plain data describe; `folder`: where the files that it names stand.

        Raises:
            DocumentError: the data describe none; every problem is listed.
        """
        if not isinstance(data, dict) or "experiment" not in data:
            raise DocumentError("is no experiment: it has no key 'experiment'")
        given = dict(cast("dict[str, Any]", data))
        if given.pop("experiment") != VERSION:
            raise DocumentError(f"is an experiment of another version; this deodar reads version {VERSION}", fix="Type: pip install --upgrade deodar")
        problems: list[Problem] = []
        for key, kinds in KINDS.items():
            rows = given.pop(key, None)
            if rows is None:
                continue
            if not isinstance(rows, list if key == "actions" else dict):
                problems.append(Problem(key, f"needs {'a list' if key == 'actions' else 'an object of named parts'}, not {show(rows)}"))
                continue
            pairs = list(enumerate(rows)) if isinstance(rows, list) else list(rows.items())
            kind = "" if len(kinds) > 1 else next(iter(kinds))
            given[key] = [from_data(v, f"{key}.{k}", kinds, {} if key == "actions" else {"name": k}, problems, kind) for k, v in pairs]
        if problems:
            raise DocumentError(problems)
        for key in ("model", "world"):
            given[key] = _beside(given.get(key, ""), folder, key == "world") if key in given else ""
        if not given["model"]:
            problems.append(Problem("model", "is missing", 'Name the file of the model: "model": "model.json"'))
        found: Any = from_data(given, "", {"Experiment": cls}, {}, problems, "Experiment") if not problems else None
        if problems:
            raise DocumentError([dc.replace(p, where=p.where.strip(".")) for p in problems])
        return found

    def save(self, path: str | Path, force: bool = False) -> None:
        """Write it as a file; a model that is no file yet is written beside it, as NAME.model.json."""
        path = output.claim(path, force)
        data = self.to_data()
        if isinstance(self.model, Model):
            beside = path.with_name(f"{path.stem}.model.json")
            save(self.model, beside, force)
            data = {"experiment": VERSION, "name": self.name, "model": beside.name} | data
        if isinstance(self.world, World):
            raise ParameterError(
                "a world that was made by a script cannot be written", where="world", fix="Name it as on the command line: world='arena:blocks'"
            )
        output.write(path, (json.dumps(data, indent=2, ensure_ascii=False) + "\n").encode())

    @classmethod
    def load(cls, path: str | Path) -> Experiment:
        """Read a file; the model that it names is in the same folder.

        Raises:
            DocumentError: there is none, or it holds something else; every problem is listed.
        """
        path = output.location(path)
        try:
            if not path.is_file():
                near = did_you_mean(path.name, [p.name for p in path.parent.glob("*.json")]) if path.parent.is_dir() else ""
                raise DocumentError("there is no such file", fix=near)
            return cls.from_data(files.parse(path.read_bytes()), path.parent)
        except DeodarError as error:
            raise DocumentError([Problem(f"{path}: {p.where}" if p.where else str(path), p.what, p.fix) for p in error.problems]) from None
        except OSError as error:
            raise DocumentError(f"cannot be read: {error.strerror}", where=str(path)) from None

    @staticmethod
    def schema() -> dict[str, Any]:
        """JSON Schema of a file."""
        own: dict[str, Any] = schema({"Experiment": Experiment}, named=False)["oneOf"][0]["properties"]
        own = {key: value for key, value in own.items() if key not in (*KINDS, "kind")}
        own |= {"experiment": {"const": VERSION}, "name": {"type": "string"}, "model": {"type": "string"}, "world": {"type": "string"}}
        for key, kinds in KINDS.items():
            parts = schema(kinds, named=key != "actions")
            if len(kinds) == 1:
                parts["oneOf"][0]["required"].remove("kind")
            own[key] = {"type": "array", "items": parts} if key == "actions" else {"type": "object", "additionalProperties": parts}
        return {
            "$schema": "https://json-schema.org/draft/2020-12/schema",
            "title": "deodar experiment",
            "type": "object",
            "properties": own,
            "required": ["experiment", "name", "model", "limit"],
            "additionalProperties": False,
        }


EXAMPLE = "example:"
"""What the name of an example begins with, which the commands open in the place of a file."""


def _beside(text: Any, folder: Path | None, world: bool) -> Any:
    """The path of a file that an experiment names, which stands in its folder."""
    if not isinstance(text, str) or folder is None or not text:
        return text
    if not world and text.startswith(EXAMPLE):
        return text
    kind, sign, argument = text.partition(":") if world else ("", "", text)
    if world and not (argument and (folder / argument).exists()):
        return text  # the name of something that comes with deodar, or a file that is found from the working folder
    return f"{kind}{sign}{folder / argument}"
