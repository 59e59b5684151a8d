"""Write the reference pages and the tables of the command line from the code.

    python docs/reference.py      also a step of tools/generate.py

One page for each room of the registry, one for what a script calls, one for measuring and drawing. Nothing
here is written by hand twice: equations (TeX), ports and sources are the docstrings', units, ranges and costs
of change the declarations'.
"""

from __future__ import annotations

import argparse
import dataclasses
import importlib
import inspect
import re
import typing
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import msgspec

import deodar as dd
from deodar import cli, docstring, kinds, registry
from deodar.cli._options import CommandParser
from deodar.parameters import Needed
from deodar.worlds import _settings

DOCS = Path(__file__).parent
MADE = "<!-- Written by tools/generate.py from the code: change the docstrings, not this page. -->\n"
WORDS = ("required", "none", "never")
"""Defaults that are words, not code."""

ROOMS = {
    "elements": (
        "Elements",
        "Parts of a model: fields and nodes, stimuli, sensors, motors, motor variables.",
    ),
    "couplings": (
        "Couplings",
        "Elements between elements. They are written `a >> Gain(2) >> b`, or added and connected by name.",
    ),
    "numerics.kernels": (
        "Interaction kernels",
        "What `kernel=[...]` of a field, or of `Convolve`, holds: any number of them, summed.",
    ),
    "numerics.sigmoids": ("Sigmoids", "Output functions g(u) of fields."),
    "worlds": (
        "Worlds",
        (
            "What a model senses and moves. A model names sensors and motors; the world that has them is"
            " chosen when it is run."
        ),
    ),
}

SCRIPT = [
    "Axis",
    "Model",
    "Session",
    "simulate",
    "dynamics",
    "rollout",
    "unbounded",
    "bounded",
    "resume",
    "Resources",
    "Points",
    "Output",
    "Probe",
    "save_snapshot",
    "load_snapshot",
    "session_at",
    "Experiment",
    "Cluster",
    "ClusterPool",
    "as_env",
    "save",
    "load",
    "save_record",
    "load_record",
    "open_record",
    "load_cedar",
    "load_cedar_experiment",
    "load_mat",
    "repeat",
    "pack",
    "contents",
    "unpack",
    "draw",
    "quote",
    "studio",
    "use_cores",
    "join_hosts",
    "use_separate_rounding",
]
"""What a script calls, under `dd`."""

CLASSES = [
    *(
        "Element",
        "Coupling",
        "Kernel",
        "Term",
        "SigmoidFunction",
        "World",
        "PureWorld",
        "Signal",
        "Setting",
        "Convolution",
        "PositionUnit",
        "PositionCode",
        "Time",
        "Action",
        "Event",
        "BaseMeasure",
    ),
    *("register", "needed", "euler", "on_axis", "check_kind"),
]
"""What a script derives its own kinds from, under `dd`, with what their methods get."""

DECLARATIONS = ["Live", "Rebuild", "Recompile"]
ALIASES = {
    "Arrays": "arrays by name: a state, inputs, outputs",
    "Axes": "a tuple of `dd.Axis`, () for a single number",
    "PerAxis": "one number for all axes, or a tuple with one for each",
    "Interval": "lowest and highest value, two numbers",
    "PositionUnits": "a tuple: for each sample a `dd.PositionUnit`, or None for a number that is no position",
}


def _derived(base: type[Any]) -> list[str]:
    """The public classes that derive from one, in the order of their declaration."""
    found = [getattr(dd, name) for name in dd.__all__]
    own = [cls for cls in found if isinstance(cls, type) and issubclass(cls, base) and cls is not base]
    return [f"dd.{cls.__name__}" for cls in sorted(own, key=lambda cls: inspect.getsourcelines(cls)[1])]


MEASURES = [
    *("dd.peaks", "dd.analysis.Peaks", "dd.analysis.Peak", "dd.regimes", "dd.analysis.Regimes"),
    *("dd.continuation", "dd.analysis.SteadyBranch", "dd.analysis.Bifurcation", "dd.bifurcation_diagram"),
    *("dd.locus", "dd.analysis.Locus", "dd.analysis.LocusPoint", "dd.locus_figure"),
    *("dd.right_hand_side", "dd.analysis.RightHandSide"),
    *("dd.regime_map", "dd.analysis.RegimeMap", "dd.regime_loci", "dd.regime_map_figure"),
    *("deodar.compiler.dynamics.Dynamics", "deodar.compiler.dynamics.TrialKey", "dd.RolloutStart"),
    *("deodar.compiler.dynamics.PreparedStep", "deodar.gradients.rollout.Rollout"),
    *("dd.tune", "dd.analysis.Tuned", "dd.analysis.RegionSize"),
    *("dd.detects", "dd.reverse", "dd.remembers", "dd.forgets", "dd.rests", "dd.relaxes_within"),
    *("dd.selects", "dd.multi_peak", "dd.peak_width", "dd.peak_amplitude"),
    *("dd.Requirement", "dd.FieldInput", "dd.analysis.FieldResponse", "dd.analysis.SettledBatch"),
    *("dd.thresholds", "dd.analysis.Thresholds", "dd.analysis.Transition", "dd.descend"),
    *("dd.outlives", "dd.analysis.Memory", "dd.forgetting", "dd.selection", "dd.analysis.Selection"),
    *(
        "dd.phase",
        "dd.analysis.Phase",
        "dd.analysis.FixedPoint",
        "dd.ramp",
        "dd.analysis.SettledRamp",
        "dd.analysis.Branch",
    ),
    *(
        "dd.isolate",
        "dd.analysis.Isolated",
        "dd.settle",
        "dd.analysis.Settled",
        "dd.regimes_figure",
        "dd.phase_figure",
    ),
    *(
        "dd.path_length",
        "dd.path_until",
        "dd.path_divergence",
        "dd.clearance",
        "dd.shortest_path",
        "dd.arena_grid",
        "dd.analysis.Grid",
    ),
    *("dd.wilson", "dd.mean_interval", "dd.median_interval", "dd.anova"),
    *(
        "dd.Factor",
        "dd.Measure",
        "dd.load_results",
        "dd.merge_results",
        "dd.compare_results",
        "deodar.experiments.repeated_results.RepeatedResults",
        "deodar.recording.repeat.Repetition",
        "deodar.model.package_contents.Contents",
        "deodar.model.package_contents.Module",
        "dd.open_records",
        "deodar.experiments.stored_records.StoredRecords",
        "dd.TrialPlan",
        "dd.Trials",
        "dd.Trial",
    ),
    *_derived(dd.Event),
    *_derived(dd.Action),
    *("dd.run_jobs", "dd.Job", "dd.Rows"),
    *(
        "deodar.session.run_live.run_live",
        "deodar.session.meter.Meter",
        "deodar.session.cost.StepCost",
        "deodar.session.cost.ElementCost",
        "dd.studio",
        "deodar_studio.from_script.OpenedStudio",
        "deodar.progress.Progress",
    ),
    *(
        "deodar.model.diagram.Diagram",
        "dd.read",
        "dd.apply_preset",
        "dd.export",
        "dd.SpikingOptions",
        "dd.compare_spikes",
        "deodar_spikes.comparison.SpikingComparison",
        "deodar_spikes.comparison.Estimate",
        "deodar.importers.report.ImportReport",
        "deodar.importers.report.Line",
    ),
]
"""A public name stands with `dd`; a class that scripts get but do not make, or a method's function, with the
module it is in.
"""

FIGURES = [name for name in dd.figures.__all__ if name.islower() and f"dd.{name}" not in MEASURES]
"""The functions that draw records, under `dd`; those of analyses are named beside what they draw."""


def pages() -> dict[Path, str]:
    """Every generated page and what it should hold."""
    folder = DOCS / "reference"
    out = {folder / f"{room.split('.')[-1]}.md": room_page(room) for room in registry.ROOMS}
    out[folder / "script.md"] = script_page()
    out[folder / "contract.md"] = contract_page()
    out[folder / "analysis.md"] = analysis_page()
    command_line = DOCS / "command-line.md"
    out[command_line] = fill(command_line.read_text(encoding="utf-8"))
    robot_files = DOCS / "robots.md"
    out[robot_files] = robots(robot_files.read_text(encoding="utf-8"))
    return out


def write() -> None:
    """Write what differs."""
    for path, text in pages().items():
        path.parent.mkdir(exist_ok=True)
        if not path.is_file() or path.read_text(encoding="utf-8") != text:
            path.write_text(text, encoding="utf-8", newline="\n")


# ------------------------------------------------------------------------------------------------- docstrings


def cell(text: Any) -> str:
    """Return the text escaped for a table."""
    return str(text).replace("|", "\\|").replace("\n", " ").strip()


def table(head: tuple[str, ...], rows: list[tuple[Any, ...]]) -> str:
    """A table of Markdown."""
    lines = [f"| {' | '.join(head)} |", f"|{'---|' * len(head)}"]
    return "\n".join([*lines, *(f"| {' | '.join(cell(c) for c in row)} |" for row in rows)]) + "\n"


def prose(text: str) -> str:
    """Paragraphs as they are; a list that was indented in the docstring stays a list."""
    return re.sub(r"``([^`]+)``", r"`\1`", text)


# ------------------------------------------------------------------------------------------------------ kinds


def room_page(room: str) -> str:
    """All kinds of one room."""
    title, about = ROOMS[room]
    listed = list(registry.kinds(room).values())
    if room == "elements":
        listed.append(registry.kind("Window"))
    parts = [MADE, f"# {title}\n", f"{about}\n"]
    return "\n".join([*parts, *(kind_section(kinds.describe(cls)) for cls in listed)])


def kind_section(kind: kinds.Description) -> str:
    """Heading, equation, parameters, ports, source."""
    out = [f"## {kind.name}\n", f"`{kind.public_name}`\n", prose(kind.text) + "\n"]
    out += [f"```math\n{line}\n```\n" for line in kind.equation]
    if kind.parameters:
        head = ("parameter", "meaning", "unit", "default", "range", "a change costs")
        rows = [
            (f"`{p.name}`", p.description or p.meaning, p.unit, default(p.typed), limits(p), p.cost)
            for p in kind.parameters
        ]
        out.append(table(head, rows))
    if kind.arguments:
        out.append(table(("argument", "meaning"), [(f"`{k}`", v) for k, v in kind.arguments.items()]))
    for group in _settings.groups(registry.kind(kind.name)).values() if kind.room == "worlds" else ():
        read = docstring.parse(docstring.source(type(group)))
        out += [f"`dd.{type(group).__name__}`\n", prose(read.opening) + "\n", attributes(read)]
    ports = [(f"`{name}`", text) for name, text in kind.ports.items() if text]
    if ports:
        out.append(table(("sensor or motor" if kind.room == "worlds" else "port", "what it carries"), ports))
    if kind.shapes:
        out.append(f"**Shapes.** {kind.shapes}\n")
    out.append(f"**Reference.** {kind.reference or 'no reference'}\n")
    return "\n".join(out)


def default(text: str) -> str:
    """A default as it is typed, as code."""
    return text if text in WORDS else f"`{text}`"


def limits(p: kinds.ParameterDescription) -> str:
    """The range of a parameter, in words; allowed texts as code."""
    return ", ".join(f"`{c}`" for c in p.choices) or p.range


# -------------------------------------------------------------------------------------- functions and classes


def script_page() -> str:
    """What a script calls."""
    parts = [
        MADE,
        "# In a script\n",
        (
            "`import deodar as dd` gives every public name: `dd.Field`, `dd.peaks`, `dd.Arena`. A name is"
            " imported when it is first used. This page has what every script calls; elements, couplings,"
            " kernels, sigmoids, worlds, measuring and drawing, and base classes have their own pages."
            " `dd.analysis`, `dd.architectures`, `dd.figures` and `dd.worlds` are modules: results and"
            " published models are found there.\n"
        ),
    ]
    parts += [section(getattr(dd, name), f"dd.{name}") for name in SCRIPT]
    listed = [
        (f"`dd.errors.{n}`", opening(c))
        for n, c in vars(dd.errors).items()
        if isinstance(c, type) and issubclass(c, dd.errors.DeodarError)
    ]
    parts += [
        "## dd.errors\n",
        (
            "Every error raised on purpose is one of these. The message says what is wrong, where, and what"
            " to type.\n"
        ),
    ]
    parts.append(table(("error", "when"), listed))
    return "\n".join(parts)


def contract_page() -> str:
    """What authors of kinds derive from and declare."""
    parts = [
        MADE,
        "# Base classes and declarations\n",
        (
            "What a kind of your own derives from, declares and gets. [Adding an"
            " element](../adding-an-element.md) builds one step by step, [Worlds](../worlds.md) a world.\n"
        ),
    ]
    parts += [
        section(
            getattr(dd, name), f"dd.{name}", constructed=name in ("Signal", "needed", "register", "euler")
        )
        for name in CLASSES
    ]
    for name in DECLARATIONS:
        parts.append(section(getattr(dd, name), f"dd.{name}"))
    read = docstring.parse(inspect.getdoc(dd.Live.__base__) or "")
    parts += ["## The arguments of a declaration\n", prose(read.opening) + "\n", attributes(read)]
    parts += [
        "## Types\n",
        table(("type", "what it is"), [(f"`dd.{name}`", about) for name, about in ALIASES.items()]),
    ]
    return "\n".join(parts)


def analysis_page() -> str:
    """Measuring, drawing, files."""
    parts = [
        MADE,
        "# Measuring, drawing, files\n",
        "Peaks, instabilities, experiments, importing, and figures of records.\n",
    ]
    for path in MEASURES:
        title = path if path.startswith("dd.") else path.rpartition(".")[2]
        parts.append(section(named(path), title, constructed=not path.startswith("dd.analysis.")))
    parts += [section(getattr(dd, name), f"dd.{name}") for name in FIGURES]
    parts += [
        section(getattr(dd.figures, name), f"dd.figures.{name}") for name in ("FigureFile", "FigurePanel")
    ]
    parts.append("The words of `view`:\n")
    parts.append(
        table(
            ("argument", "meaning"),
            [(f"`{k}`", v) for k, v in _described(dd.figures.View).items() if k != "variable"],
        )
    )
    return "\n".join(parts)


def named(path: str) -> Any:
    """What a path such as `dd.analysis.Peaks` stands for."""
    head, _, name = path.rpartition(".")
    return getattr(
        importlib.import_module(head.replace("dd", "deodar", 1) if head.split(".")[0] == "dd" else head), name
    )


def _described(obj: Any) -> dict[str, str]:
    read = docstring.parse(inspect.getdoc(obj) or "")
    return read.entries("Args") or read.entries("Attributes")


def opening(obj: Any) -> str:
    """The first paragraph of a docstring, in one line."""
    return docstring.parse(inspect.getdoc(obj) or "").summary


def section(obj: Any, title: str, constructed: bool = True) -> str:
    """One function or class: signature, docstring, public methods.

    Without the signature where scripts do not construct it.
    """
    read = docstring.parse(inspect.getdoc(obj) or "")
    out = [f"## {title}\n"]
    if (title.startswith("dd.") and constructed) or (
        not dataclasses.is_dataclass(obj) and not inspect.isclass(obj)
    ):
        out.append(f"```text\n{signature(obj, title)}\n```\n")
    out += [prose(read.opening) + "\n", attributes(read)]
    for name in ("Returns", "Raises", "Reference"):
        if name in read.sections:
            out.append(f"**{name}.** {read.line(name)}\n")
    if inspect.isclass(obj):
        rows = [
            (f"`{signature(f, name)}`" if callable(f) else f"`{name}`", opening(f))
            for name, f in members(obj)
        ]
        if rows:
            out.append(table(("method or property", "what it does"), rows))
    return "\n".join(part for part in out if part)


def attributes(read: docstring.Docstring) -> str:
    """The tables of arguments and attributes of a docstring."""
    heads = {
        "Args": "argument",
        "Attributes": "attribute",
        "Class attributes": "class attribute",
        "What the functions see": "argument",
    }
    tables = [
        table((head, "meaning"), [(f"`{k}`", v) for k, v in read.entries(name).items()])
        for name, head in heads.items()
        if name in read.sections
    ]
    return "\n".join(tables)


SAVED = "deodar.analysis.saved"
"""The module of the base class of results that have a file, whose methods are theirs."""


def members(cls: type) -> Iterator[tuple[str, Any]]:
    """Public methods and properties that the class itself declares and documents; also those of SAVED."""
    declared = dict(vars(cls))
    for base in cls.__mro__:
        if base.__module__ == SAVED:
            declared = {**declared, **{n: v for n, v in vars(base).items() if n not in declared}}
    for name, value in declared.items():
        if (
            not name.startswith("_")
            and (inspect.isfunction(value) or isinstance(value, property))
            and inspect.getdoc(value)
        ):
            yield name, value


def signature(obj: Any, title: str) -> str:
    """A call as one reads it: names and defaults, the types left to the text."""
    parts: list[str] = []
    starred = False
    for p in arguments(obj):
        if p.name == "self":
            continue
        if p.kind is p.KEYWORD_ONLY and not starred:
            parts.append("*")
            starred = True
        mark = {p.VAR_POSITIONAL: "*", p.VAR_KEYWORD: "**"}.get(p.kind, "")
        starred = starred or p.kind is p.VAR_POSITIONAL
        parts.append(f"{mark}{p.name}" + ("" if p.default is p.empty else f"={kinds.typed(p.default)}"))
    return f"{title}({', '.join(parts)})"


def arguments(obj: Any) -> list[inspect.Parameter]:
    """The arguments of a call; of a part, whose constructor checks them by its declaration, the declared
    ones.
    """
    found = _unpacked(obj, list(inspect.signature(obj).parameters.values()))
    if not dataclasses.is_dataclass(obj) or not any(p.kind is p.VAR_KEYWORD for p in found):
        return found
    out: list[inspect.Parameter] = []
    for f in sorted((f for f in dataclasses.fields(obj) if f.init), key=lambda f: f.kw_only):
        kind = inspect.Parameter.KEYWORD_ONLY if f.kw_only else inspect.Parameter.POSITIONAL_OR_KEYWORD
        given = f.default if f.default_factory is dataclasses.MISSING else f.default_factory()
        needed = given is dataclasses.MISSING or isinstance(given, Needed)
        out.append(inspect.Parameter(f.name, kind, default=inspect.Parameter.empty if needed else given))
    return out


def _unpacked(obj: Any, found: list[inspect.Parameter]) -> list[inspect.Parameter]:
    """The arguments with the keys of `**name: Unpack[...]` in place of `**name`; defaults are those of the
    function in the module of the keys that takes them all.
    """
    if not found or not str(found[-1].annotation).startswith("Unpack["):
        return found
    (keys,) = typing.get_args(typing.get_type_hints(obj)[found[-1].name])
    module = vars(importlib.import_module(keys.__module__)).values()
    functions = [(f, list(inspect.signature(f).parameters.values())) for f in module if inspect.isfunction(f)]
    taken = [{p.name: p for p in _unpacked(f, own)} for f, own in functions]
    takes = next(parameters for parameters in taken if keys.__annotations__.keys() <= parameters.keys())
    return [*found[:-1], *(takes[key] for key in keys.__annotations__)]


# ------------------------------------------------------------------------------------------- files of robots


def robots(text: str) -> str:
    """Return the page of robot files with new tables of keys."""
    file = importlib.import_module("deodar_robots.robot.robot_file")
    for declared in (file.RobotFile, file.RobotSensor, file.RobotMotor, file.RobotPlace):
        begin, end = f"<!-- keys of {declared.__name__} -->\n", f"<!-- end of {declared.__name__} -->\n"
        before, rest = text.split(begin, 1)
        text = before + begin + keys(declared) + end + rest.split(end, 1)[1]
    return text


def keys(declared: type[Any]) -> str:
    """The keys of an object in the file of a robot, with their defaults."""
    hints = typing.get_type_hints(declared, include_extras=True)
    rows: list[tuple[str, str, str]] = []
    for f in msgspec.structs.fields(declared):
        notes = [m.description for m in getattr(hints[f.name], "__metadata__", ()) if m.description]
        given = "required" if f.required else f.default if f.default is not msgspec.NODEFAULT else {}
        shown = given if given == "required" else "" if given in ("", None, {}) else f"`{given:g}`"
        rows.append((f"`{f.encode_name}`", " ".join(notes), shown))
    return f"\n{table(('key', 'meaning', 'default'), rows)}\n"


# ------------------------------------------------------------------------------------------- the command line


def fill(text: str) -> str:
    """Return the page of the command line with new tables of arguments; missing commands are added."""
    for name, module in cli.COMMANDS.first_party().items():
        begin, end = f"<!-- arguments of {name} -->\n", f"<!-- end of {name} -->\n"
        if begin not in text:
            text = text.rstrip("\n") + f"\n\n## deodar {name}\n\n{begin}{end}"
        before, rest = text.split(begin, 1)
        text = before + begin + command(name, module) + end + rest.split(end, 1)[1]
    return text


def command(name: str, module: Any) -> str:
    """What a command does, and its arguments."""
    parser = CommandParser(prog=f"deodar {name}", add_help=False)
    module.arguments(parser)
    rows: list[tuple[str, str]] = []
    for action in parser._actions:
        if action.help != argparse.SUPPRESS:
            rows.append((f"`{written(action)}`", action.help or ""))
    rows.append(("`--help`", "show this"))
    help_line = module.HELP[0].upper() + module.HELP[1:]
    return f"\n{help_line}.\n\n{table(('argument', 'meaning'), rows)}\n"


def written(action: argparse.Action) -> str:
    """An argument as one types it."""
    value = action.metavar or ("|".join(map(str, action.choices)) if action.choices else action.dest.upper())
    if isinstance(value, tuple):
        value = " ".join(value)
    many = {"*": f"[{value} ...]", "+": f"{value} [{value} ...]", "?": f"[{value}]"}.get(
        str(action.nargs), value
    )
    if not action.option_strings:
        return many
    return ", ".join(action.option_strings) + ("" if action.nargs == 0 else f" {many}")


if __name__ == "__main__":
    write()
