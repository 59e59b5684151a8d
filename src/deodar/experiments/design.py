"""The design of an experiment as data: its model, the plan of its trials and their factors, and its file."""

from __future__ import annotations

import contextlib
import dataclasses as dc
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Self, cast

from deodar import codec, file_version, plugins, regular_file
from deodar.codec import Json, JsonObject
from deodar.errors import (
    DeodarError,
    DocumentError,
    Fix,
    ParameterError,
    Problem,
    UnknownName,
    did_you_mean,
    reading,
)
from deodar.experiments.actions import ACTIONS
from deodar.experiments.events import EVENTS
from deodar.experiments.experiment_migrations import VERSION, migrate
from deodar.experiments.factor import DESIGNS, Factor, assign
from deodar.experiments.measures import MEASURES
from deodar.experiments.trial import TrialPlan
from deodar.model import output
from deodar.model.document_files import require_file
from deodar.model.model import Model, load, save
from deodar.model.parts import schema
from deodar.parameters import Part, Recompile, parameters, show
from deodar.part_data import defaults, from_data, part_of, to_data
from deodar.summary import Summarised, Summary
from deodar.worlds._base import World

KINDS: Mapping[str, Mapping[str, type[Part]]] = {
    "conditions": EVENTS,
    "actions": ACTIONS,
    "factors": {"Factor": Factor},
    "measures": MEASURES,
}
"""The kinds of parts that are valid under each key of a file."""

OF_PLAN = {
    "limit": "limit",
    "every": "every",
    "record": "watch",
    "dt": "dt",
    "conditions": "events",
    "actions": "actions",
    "measures": "measures",
}
"""For each key of a file that is a parameter of the plan, the name of the parameter."""

MOST_TRIALS = 10_000_000
"""Largest number of trials (a guess: the list of their levels takes about a gibibyte)."""

SETTINGS = ("limit", "trials", "design", "seed", "every", "record", "world", "dt", "precision")
"""The keys of a file that are neither names nor parts, in the order in which they are shown and written."""

USUAL = {"factors": "Factor", "measures": "Measure"}
"""The default kind under each key, which a file need not state."""

OWN = ("trial", "key", "outcome", "awaited", "diverged", "duration", "time")
"""Names of columns that every table has."""


@dataclass(frozen=True, repr=False)
class Design(Summarised, Part):
    """An experiment as data, which `Experiment` runs.

    Attributes:
        name: name of the experiment.
        model: the model, or the path of its document.
        plan: what is done and observed in each trial; each trial keeps a record of the ports to watch.
        trials: number of trials for each combination of levels; for a random design in total.
        factors: parameters in which trials differ, and their levels.
        design: `crossed`, `shuffled` (the same in an order drawn from the seed) or `random` (levels drawn for
            each trial).
        seed: seed of all noise, and of the random order or levels.
        world: the world of the model's sensors and motors: a world, or KIND:ARGUMENT as on the command line.
        precision: float32 or float64.
    """

    name: str
    model: object
    plan: TrialPlan
    trials: Annotated[int, Recompile(lower=1)] = 1
    factors: Sequence[Factor] = ()
    design: Annotated[str, Recompile(choices=DESIGNS)] = dc.field(default="crossed", kw_only=True)
    seed: Annotated[int, Recompile(lower=0, upper=2**32 - 1)] = dc.field(default=0, kw_only=True)
    world: object = dc.field(default=None, kw_only=True)
    precision: Annotated[str, Recompile(choices=("float32", "float64"))] = dc.field(
        default="float32", kw_only=True
    )

    def __new__(cls, *args: Any, **kwargs: Any) -> Self:
        if key := next((key for key in kwargs if key in OF_PLAN), ""):
            fix = f"Write: dd.Experiment(name, model, dd.TrialPlan({OF_PLAN[key]}=...))"
            raise UnknownName(f"Experiment has no parameter {key!r}: it belongs to the plan", fix=fix)
        return cast("Self", super().__new__(cls, *args, **kwargs))

    def __post_init__(self) -> None:
        if self.world is None:  # the type of this parameter is open, so that None is accepted too
            object.__setattr__(self, "world", "")
        super().__post_init__()

    def validate(self) -> Iterator[tuple[str, str]]:
        if not isinstance(self.model, (Model, str, Path)):
            yield "model", f"needs a model or the path of its document, not {show(self.model)}"
        if not isinstance(self.world, (World, str)):
            yield "world", f"needs a world, or text such as arena:blocks, not {show(self.world)}"
        if self.count > MOST_TRIALS:
            yield "trials", f"gives {self.count:,} trials; at most {MOST_TRIALS:,} are run"
        names = [p.name for p in (*self.plan.events, *self.factors, *self.plan.measures)]
        for name in dict.fromkeys(names):
            if not name or name in OWN or names.count(name) > 1:
                problem = "is a column of every table" if name else "is not a name"
                problem = "is the name of two columns" if names.count(name) > 1 else problem
                yield "conditions, factors and measures", f"{name!r} {problem}; give each a name of its own"

    # ---------------------------------------------------------------------------------------- what it will do

    @property
    def count(self) -> int:
        """Number of all trials, without listing them."""
        combinations = 1 if self.design == "random" else math.prod(len(f.labels) for f in self.factors)
        return self.trials * combinations

    @property
    def cells(self) -> list[tuple[int, ...]]:
        """For each trial the level (its number) of each factor."""
        return assign(self.factors, self.design, self.trials, self.seed)

    # -------------------------------------------------------------------------------------------------- files

    def to_data(self) -> JsonObject:
        """Return plain data as a file contains them; a model or a world without a file is left out."""
        out: JsonObject = {"experiment": VERSION, "name": self.name}
        out |= {"model": str(self.model)} if isinstance(self.model, (str, Path)) else {}
        out |= {"world": self.world} if isinstance(self.world, str) and self.world else {}
        settings = to_data(self, False, ("name", "model", "world", "plan", "factors"))
        of_plan = to_data(self.plan, False, ("events", "measures", "actions"))
        out |= by_key(settings, of_plan)
        for key in KINDS:
            parts: Sequence[Any] = getattr(self.plan, OF_PLAN[key]) if key in OF_PLAN else self.factors
            plain = [to_data(part, type(part).__name__ != USUAL.get(key)) for part in parts]
            if plain:
                out[key] = (
                    plain
                    if key == "actions"
                    else {part.name: plain_part for part, plain_part in zip(parts, plain, strict=True)}
                )
        packages = {type(part).__name__: MEASURES.package(type(part)) for part in self.plan.measures}
        packages = {kind: package for kind, package in sorted(packages.items()) if package}
        return {**out, "packages": packages} if packages else out

    @classmethod
    def from_data(cls, data: Any, folder: Path | None = None, read: Callable[[str], Model] = load) -> Self:
        """Return the experiment that plain data describe.

        Args:
            data: the plain data.
            folder: folder of the files that the data name.
            read: function that opens the model of an experiment of version 1, whose paths are converted.

        Raises:
            DocumentError: the data do not describe an experiment; every problem is listed.
        """
        if not isinstance(data, dict) or "experiment" not in data:
            if isinstance(data, dict) and "deodar" in data:
                fix = Fix("Open it: dd.load(FILE)", "Type: deodar run FILE --duration MS")
                raise DocumentError("is not an experiment: it is a model", fix=fix)
            raise DocumentError("is not an experiment: it has no key 'experiment'")
        content = _migrated(cast("dict[str, Any]", data), folder, read)
        with file_version.naming_later_writer(data):
            return cls._of_content(content, folder)

    @classmethod
    def _of_content(cls, content: dict[str, Any], folder: Path | None) -> Self:
        """Return the experiment of plain data of the present version."""
        for key in ("experiment", file_version.KEY):
            content.pop(key, None)
        problems: list[Problem] = []
        needed = plugins.stated(content.pop("packages", {}), problems)
        for key, kinds in KINDS.items():
            if (rows := content.pop(key, None)) is None:
                continue
            content[key] = _parts(key, rows, kinds, problems)
        if problems:
            packaged = [p.name for p in MEASURES.packaged()]
            unfit = plugins.unfit(needed, lambda kind: MEASURES.package(MEASURES[kind]), packaged)
            raise DocumentError([*unfit, *problems])
        for key in ("model", "world"):
            content[key] = _beside(content.get(key, ""), folder, key == "world") if key in content else ""
        if not content["model"]:
            problems.append(
                Problem("model", "is missing", 'Name the file of the model: "model": "model.json"')
            )
        experiment = cls._of_keys(content, problems)
        if problems:
            keys = {name: key for key, name in OF_PLAN.items()}
            raise DocumentError([dc.replace(p, where=keys.get(p.where, p.where)) for p in problems])
        return experiment

    @classmethod
    def _of_keys(cls, content: dict[str, Any], problems: list[Problem]) -> Any:
        """Return the experiment of the keys of a file, whose parts are made, with all problems added."""
        keys = ["name", "model", *SETTINGS, *KINDS]
        for key in [key for key in content if key not in keys]:
            del content[key]
            problems.append(Problem(key, "Experiment has no such parameter", did_you_mean(key, keys)))
        of_plan = {name: content.pop(key) for key, name in OF_PLAN.items() if key in content}
        plan = part_of(TrialPlan, of_plan, "", {}, problems, "Experiment")
        # an experiment with another plan states its other problems
        parts = {"plan": plan or TrialPlan(1.0)}
        return part_of(cls, content, "", parts, problems, "Experiment")

    def save(self, path: str | Path, force: bool = False) -> None:
        """Write a file; a model without a file is written beside it, as NAME.model.json."""
        path = output.claim(path, force)
        content = self.to_data()
        of_file = {"experiment": VERSION, file_version.KEY: file_version.HERE}
        if isinstance(self.model, Model):
            beside = path.with_name(f"{path.stem}.model.json")
            save(self.model, beside, force)
            of_file |= {"name": self.name, "model": beside.name}
        if isinstance(self.world, World):
            raise ParameterError(
                "a world that was made by a script cannot be written",
                where="world",
                fix="Name it as on the command line: world='arena:blocks'",
            )
        output.write(path, (codec.text(of_file | content, finite=True) + "\n").encode())

    @classmethod
    def load(cls, path: str | Path, read: Callable[[str], Model] = load) -> Self:
        """Read a file; the model that it names is in the same folder.

        Args:
            path: the file.
            read: function that opens the model of an experiment of version 1, whose paths are converted.

        Raises:
            DocumentError: the file does not exist or does not describe an experiment; every problem is
                listed.
        """
        path = output.location(path)
        with reading(path, DocumentError):
            require_file(path)
            return cls.from_data(codec.read(regular_file.read_bytes(path)), path.parent, read)

    @staticmethod
    def schema() -> dict[str, Any]:
        """Return the JSON Schema of a file."""
        classes = (Design, TrialPlan)
        properties_of = [_schema({"": cls}, named=False)["oneOf"][0]["properties"] for cls in classes]
        properties = by_key(*properties_of) | {
            "experiment": {"enum": list(range(1, VERSION + 1))},
            file_version.KEY: {"type": "string"},
            "name": {"type": "string"},
            "model": {"type": "string"},
            "world": {"type": "string"},
            "packages": {"type": "object", "additionalProperties": {"type": "string"}},
        }
        for key, kinds in KINDS.items():
            parts = _schema(kinds, named=key != "actions")
            for part in parts["oneOf"]:
                if part["title"] == USUAL.get(key):
                    part["required"].remove("kind")
            properties[key] = (
                {"type": "array", "items": parts}
                if key == "actions"
                else {"type": "object", "additionalProperties": parts}
            )
        return {
            "$schema": "https://json-schema.org/draft/2020-12/schema",
            "title": "deodar experiment",
            "type": "object",
            "properties": properties,
            "required": ["experiment", "name", "model", "limit"],
            "additionalProperties": False,
        }

    def _summary(self) -> Summary:
        model = self.model.name if isinstance(self.model, Model) else str(self.model)
        rows = [
            ("model", model),
            ("trials", f"{len(self.cells)} ({self.design})"),
            *((f.name, ", ".join(str(level) for level in f.labels)) for f in self.factors),
            ("limit of a trial", f"{self.plan.limit:g}"),
            ("conditions", ", ".join(e.name for e in self.plan.events) or "none"),
            ("measures", ", ".join(m.name for m in self.plan.measures) or "none"),
            ("seed", self.seed),
        ]
        return Summary(f"{type(self).__name__} {self.name!r}", rows)


def by_key(of_experiment: Mapping[str, Any], of_plan: Mapping[str, Any]) -> dict[str, Any]:
    """Return what belongs to parameters of an experiment and of its plan, by the keys of a file."""
    settings = {**of_experiment, **{key: of_plan[name] for key, name in OF_PLAN.items() if name in of_plan}}
    return {key: settings[key] for key in SETTINGS if key in settings}


EXAMPLE = "example:"
"""Prefix of the name of an example, which commands accept in place of a file."""


def _migrated(data: Mapping[str, Json], folder: Path | None, read: Callable[[str], Model]) -> JsonObject:
    """Return plain data in the present version.

    If the model cannot be opened, it resolves no paths: no trial can run without the model.
    """
    doc = None
    if data["experiment"] in range(1, VERSION):
        with contextlib.suppress(DeodarError):
            doc = read(str(_beside(data.get("model", ""), folder, False))).document
    return migrate(data, doc)


def _beside(text: Any, folder: Path | None, world: bool) -> Any:
    """Return the path of a file that an experiment names, which is in its folder."""
    if not isinstance(text, str) or folder is None or not text:
        return text
    if not world and text.startswith(EXAMPLE):
        return text
    kind, sign, argument = text.partition(":") if world else ("", "", text)
    # settings of a world follow the file
    place, comma, settings = argument.partition(",") if world else (argument, "", "")
    path = folder / place.strip()
    if world and place.strip() and not path.exists() and (folder / path.name).is_file():
        path = folder / path.name  # results that were copied, with the file of their world beside them
    if world and not (place.strip() and path.exists()):
        # a name of something that deodar installs, or a file in the working folder
        return text
    return f"{kind}{sign}{path}{comma}{settings}"


def _parts(key: str, rows: Any, kinds: Mapping[str, type[Part]], problems: list[Problem]) -> list[Any]:
    """Return the parts of one key of an experiment, with their problems added."""
    usual = USUAL.get(key, "")
    if key == "actions" and isinstance(rows, list):
        listed = enumerate(cast("list[Any]", rows))
        return [from_data(row, f"{key}.{k}", kinds, {}, problems, usual) for k, row in listed]
    if key != "actions" and isinstance(rows, dict):
        named = cast("dict[str, Any]", rows).items()
        return [from_data(row, f"{key}.{k}", kinds, {"name": k}, problems, usual) for k, row in named]
    form = "a list" if key == "actions" else "an object of named parts"
    problems.append(Problem(key, f"needs {form}, not {show(rows)}"))
    return []


def _schema(kinds: Mapping[str, type[Part]], named: bool) -> dict[str, Any]:
    """Return the JSON Schema of any of some kinds; `named`: their name is the key beside them."""
    out: list[dict[str, Any]] = []
    for cls in kinds.values():
        part_schema = schema(cls, lambda base: {})
        for p in parameters(cls):
            if p.of is object:  # any value that the parameter that it sets accepts
                part_schema["properties"][p.name] = {"description": p.meaning}
        part_schema["required"] = [
            "kind",
            *(
                p.name
                for p in parameters(cls)
                if p.name not in defaults(cls) and (p.name != "name" or not named)
            ),
        ]
        out.append(part_schema | {"additionalProperties": False})
    return {"oneOf": out}
