"""Write the reference pages and the tables of the command line from the code.

    python docs/reference.py

One page for each room of the registry, one for what a script calls, one for measuring and drawing. Nothing here is written by hand
twice: equations (TeX), ports and sources are the docstrings', units, ranges and costs of change the declarations'.
"""

from __future__ import annotations

import argparse
import dataclasses
import inspect
import re
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from deodar import cli, errors, registry
from deodar.declarations import Needed
from deodar.numerics.axes import Axis
from deodar.parameters import Parameter, Part, parameters
from deodar.server.docstring import docstring

DOCS = Path(__file__).parent
MADE = "<!-- Made by docs/reference.py from the code: change the docstrings, not this page. -->\n"
HEAD = re.compile(r"^([A-Z][A-Za-z ]*):\s*$")

ROOMS = {
    "elements": ("Elements", "What stands in a model: fields and nodes, stimuli, sensors, motors, motor variables."),
    "couplings": ("Couplings", "Elements between elements. They are written `a >> Gain(2) >> b`, or added and connected by name."),
    "numerics.kernels": ("Interaction kernels", "What `kernel=[...]` of a field, or of `Convolve`, holds: any number of them, summed."),
    "numerics.sigmoids": ("Sigmoids", "Output functions g(u) of fields."),
    "worlds": ("Worlds", "What a model senses and moves. A model names sensors and motors; the world that has them is chosen when it is run."),
}

SCRIPT = ["Axis", "Model", "Session", "simulate", "Experiment", "save", "load", "draw", "quote", "use_cores"]
MEASURES = {
    "analysis.peaks": ["peaks", "Peaks", "Peak"],
    "analysis.regimes": ["regimes", "Regimes"],
    "analysis.thresholds": ["thresholds", "Thresholds", "Transition", "descend"],
    "analysis.memory": ["outlives", "Memory", "forgetting"],
    "analysis.selection": ["selects", "Selection"],
    "analysis.phase": ["phase", "Phase", "FixedPoint"],
    "analysis.ramp": ["ramp", "Ramp", "Branch"],
    "analysis.isolated": ["isolate", "Isolated"],
    "analysis.settle": ["settle", "Settled"],
    "analysis.figures": ["regimes_figure", "phase_figure"],
    "analysis.paths": ["length", "until", "divergence", "clearance"],
    "analysis.shortest": ["shortest", "grid", "Grid"],
    "analysis.statistics": ["wilson", "mean_interval", "median_interval", "anova"],
    "experiments.factor": ["Factor"],
    "experiments.measures": ["Measure"],
    "experiments.results": ["load"],
    "experiments.run": ["run"],
    "experiments.batch": ["run_batch"],
    "experiments.course": ["Course"],
    "experiments.events": ["Crosses", "Appears", "Vanishes", "Reached", "Within", "Leaves", "All", "AnyOf"],
    "experiments.actions": ["Set", "Ramp", "Push", "Place", "Move", "Remove", "Record", "Snapshot", "Reset", "End"],
    "experiments.jobs": ["carry_out", "Job"],
    "experiments.rows": ["Rows"],
    "runtime.live": ["run_live"],
    "runtime.meter": ["Meter"],
    "runtime.cost": ["Costs", "Cost"],
    "recording.files": ["save", "load"],
    "model.diagram": ["Diagram"],
    "importers.opening": ["read"],
    "importers.presets": ["apply"],
    "importers.report": ["Report", "Line"],
}
FIGURES = ["time_course", "space_time", "snapshot", "snapshots", "projection", "path"]


def pages() -> dict[Path, str]:
    """Every generated page and what it should hold."""
    folder = DOCS / "reference"
    out = {folder / f"{room.split('.')[-1]}.md": room_page(room) for room in registry.ROOMS}
    out[folder / "script.md"] = script_page()
    out[folder / "analysis.md"] = analysis_page()
    command_line = DOCS / "command-line.md"
    out[command_line] = fill(command_line.read_text(encoding="utf-8"))
    return out


def write() -> None:
    """Write what differs."""
    for path, text in pages().items():
        path.parent.mkdir(exist_ok=True)
        if not path.is_file() or path.read_text(encoding="utf-8") != text:
            path.write_text(text, encoding="utf-8", newline="\n")


# ------------------------------------------------------------------------------------------------ docstrings


def sections(text: str) -> tuple[str, dict[str, str]]:
    """A docstring's opening, and its sections by name."""
    opening: list[str] = []
    found: dict[str, list[str]] = {}
    into = opening
    for line in text.splitlines():
        head = HEAD.match(line)
        if head:
            into = found.setdefault(head[1], [])
        else:
            into.append(line)
    return "\n".join(opening).strip(), {name: inspect.cleandoc("\n".join(lines)) for name, lines in found.items()}


def entries(text: str) -> dict[str, str]:
    """`name: what it is`, with the lines that go on below it."""
    out: dict[str, str] = {}
    name = ""
    for line in text.splitlines():
        found = re.match(r"^([\w.*]+(?:, [\w.*]+)*): (.*)$", line)
        if found:
            name = found[1]
            out[name] = found[2]
        elif name:
            out[name] += " " + line.strip()
    return out


def cell(text: Any) -> str:
    """Text that may stand in a table."""
    return str(text).replace("|", "\\|").replace("\n", " ").strip()


def table(head: tuple[str, ...], rows: list[tuple[Any, ...]]) -> str:
    """A table of Markdown."""
    lines = [f"| {' | '.join(head)} |", f"|{'---|' * len(head)}"]
    return "\n".join([*lines, *(f"| {' | '.join(cell(c) for c in row)} |" for row in rows)]) + "\n"


def prose(text: str) -> str:
    """Paragraphs as they are; a list that was indented in the docstring stays a list."""
    return re.sub(r"``([^`]+)``", r"`\1`", text)


# ------------------------------------------------------------------------------------------------ kinds


def room_page(room: str) -> str:
    """All kinds of one room."""
    title, about = ROOMS[room]
    kinds = list(registry.kinds(room).values())
    if room == "elements":
        kinds.append(registry.kind("Window"))
    parts = [MADE, f"# {title}\n", f"{about}\n"]
    return "\n".join([*parts, *(kind_section(cls) for cls in kinds)])


def kind_section(cls: type) -> str:
    """Heading, equation, parameters, ports, source."""
    opening, found = sections(inspect.getdoc(cls) or "")
    out = [f"## {cls.__name__}\n", f"`from {cls.__module__} import {cls.__name__}`\n", prose(opening) + "\n"]
    if "Equation" in found:
        out += [f"```math\n{line}\n```\n" for line in docstring(cls).equation]
    described = entries(found.get("Parameters", ""))
    if issubclass(cls, Part):
        rows = [(f"`{p.name}`", described.get(p.name, p.meaning), p.unit, default(p), limits(p), p.cost) for p in parameters(cls) if p.name != "name"]
        if rows:
            out.append(table(("parameter", "meaning", "unit", "default", "range", "a change costs"), rows))
    elif described:
        out.append(table(("argument", "meaning"), [(f"`{name}`", text) for name, text in described.items()]))
    if "Ports" in found:
        out.append(table(("port", "what it carries"), [(f"`{name}`", text) for name, text in entries(found["Ports"]).items()]))
    if "Shapes" in found:
        out.append(f"**Shapes.** {' '.join(found['Shapes'].split())}\n")
    out.append(f"**Reference.** {' '.join(found.get('Reference', 'no reference').split())}\n")
    return "\n".join(out)


def default(p: Parameter) -> str:
    """A default as one would type it."""
    value = p.default
    if isinstance(value, Needed) or value is dataclasses.MISSING or value is ... or value is inspect.Parameter.empty:
        return "required"
    if isinstance(value, float):
        return f"`{value:g}`" if abs(value) < 1e20 else "never"
    if value is None:
        return "none"
    if value in ((), ""):
        return "none" if value == () else "`''`"
    return f"`{short(value)}`"


def short(value: Any) -> str:
    """A part as the call that makes it."""
    if isinstance(value, Axis):
        return f"Axis({value.name!r}, {value.lower:g}, {value.upper:g}, {value.samples})"
    if isinstance(value, (tuple, list)):
        return "[" + ", ".join(short(v) for v in value) + "]"
    if isinstance(value, Part):
        shown = [f"{p.name}={short(getattr(value, p.name))}" for p in parameters(type(value)) if getattr(value, p.name) not in (None, "", ())]
        return f"{type(value).__name__}({', '.join(shown)})"
    if isinstance(value, float):
        return f"{value:g}"
    return repr(value)


def limits(p: Parameter) -> str:
    """The range of a parameter, in words."""
    if p.choices:
        return ", ".join(f"`{c}`" for c in p.choices)
    low = None if p.lower is None else f"{p.lower:g}"
    high = None if p.upper is None else f"{p.upper:g}"
    if low is not None and high is not None:
        return f"{low} to {high}"
    return f"at least {low}" if low is not None else f"at most {high}" if high is not None else ""


# ------------------------------------------------------------------------------------------------ functions and classes


def script_page() -> str:
    """What a script calls."""
    import deodar as dd

    parts = [
        MADE,
        "# In a script\n",
        "`import deodar as dd` gives these names, and the elements, couplings and kernels that nearly every script needs:"
        " `dd.Field`, `dd.GaussianStimulus`, `dd.Gain`, `dd.Project`, `dd.Gaussian`, `dd.Logistic`. Everything else comes from its module,"
        " which its entry in this reference names.\n",
    ]
    parts += [section(getattr(dd, name), f"dd.{name}") for name in SCRIPT]
    listed = [(f"`dd.errors.{n}`", opening(c)) for n, c in vars(errors).items() if isinstance(c, type) and issubclass(c, errors.DeodarError)]
    parts += ["## dd.errors\n", "Every error raised on purpose is one of these. The message says what is wrong, where, and what to type.\n"]
    parts.append(table(("error", "when"), listed))
    return "\n".join(parts)


def analysis_page() -> str:
    """Measuring, drawing, files."""
    from importlib import import_module

    parts = [MADE, "# Measuring, drawing, files\n", "Peaks, instabilities, figures of records, and records as files.\n"]
    for home, names in MEASURES.items():
        module = import_module(f"deodar.{home}")
        for name in names:
            title = f"{home.rpartition('.')[2]}.{name}" if home == "recording.files" else name
            parts.append(section(getattr(module, name), title, f"deodar.{home}"))
    parts.append("## Figures of records\n")
    parts.append("Each kind is a module with a function `draw(variable, **view)` that returns a matplotlib `Figure`.\n")
    rows = [(f"`deodar.figures.{n}`", opening(import_module(f"deodar.figures.{n}"))) for n in FIGURES]
    parts.append(table(("module", "what it draws"), rows))
    from deodar.figures._view import View

    parts.append("The words of `view`:\n")
    parts.append(table(("argument", "meaning"), [(f"`{k}`", v) for k, v in _described(View).items() if k != "variable"]))
    return "\n".join(parts)


def _described(obj: Any) -> dict[str, str]:
    found = sections(inspect.getdoc(obj) or "")[1]
    return entries(found.get("Args") or found.get("Attributes") or "")


def opening(obj: Any) -> str:
    """The first line of a docstring."""
    return (inspect.getdoc(obj) or "").split("\n\n")[0].replace("\n", " ")


def section(obj: Any, title: str, home: str = "") -> str:
    """One function or class: signature, docstring, public methods."""
    text, found = sections(inspect.getdoc(obj) or "")
    out = [f"## {title}\n"]
    if home:
        out.append(f"`from {home} import {obj.__name__}`\n")
    if not dataclasses.is_dataclass(obj) or title.startswith("dd."):
        out.append(f"```text\n{signature(obj, title)}\n```\n")
    out.append(prose(text) + "\n")
    for name, head in (("Args", "argument"), ("Attributes", "attribute")):
        if name in found:
            out.append(table((head, "meaning"), [(f"`{k}`", v) for k, v in entries(found[name]).items()]))
    for name in ("Returns", "Raises", "Reference"):
        if name in found:
            out.append(f"**{name}.** {' '.join(found[name].split())}\n")
    if inspect.isclass(obj):
        rows = [(f"`{signature(f, name)}`" if callable(f) else f"`{name}`", opening(f)) for name, f in members(obj)]
        if rows:
            out.append(table(("method or property", "what it does"), rows))
    return "\n".join(out)


def members(cls: type) -> Iterator[tuple[str, Any]]:
    """Public methods and properties that the class itself declares and documents."""
    for name, value in vars(cls).items():
        if not name.startswith("_") and (inspect.isfunction(value) or isinstance(value, property)) and inspect.getdoc(value):
            yield name, value


def signature(obj: Any, title: str) -> str:
    """A call as one reads it: names and defaults, the types left to the text."""
    parts: list[str] = []
    starred = False
    for p in inspect.signature(obj).parameters.values():
        if p.name == "self":
            continue
        if p.kind is p.KEYWORD_ONLY and not starred:
            parts.append("*")
            starred = True
        mark = {p.VAR_POSITIONAL: "*", p.VAR_KEYWORD: "**"}.get(p.kind, "")
        starred = starred or p.kind is p.VAR_POSITIONAL
        parts.append(f"{mark}{p.name}" + ("" if p.default is p.empty else f"={short(p.default)}"))
    return f"{title}({', '.join(parts)})"


# ------------------------------------------------------------------------------------------------ the command line


def fill(text: str) -> str:
    """The page of the command line with every table of arguments made anew; commands that are not there are added."""
    for name, module in cli.commands().items():
        begin, end = f"<!-- arguments of {name} -->\n", f"<!-- end of {name} -->\n"
        if begin not in text:
            text = text.rstrip("\n") + f"\n\n## deodar {name}\n\n{begin}{end}"
        before, rest = text.split(begin, 1)
        text = before + begin + command(name, module) + end + rest.split(end, 1)[1]
    return text


def command(name: str, module: Any) -> str:
    """What a command does, and its arguments."""
    parser = argparse.ArgumentParser(prog=f"deodar {name}", add_help=False)
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
    many = {"*": f"[{value} ...]", "+": f"{value} [{value} ...]", "?": f"[{value}]"}.get(str(action.nargs), value)
    if not action.option_strings:
        return many
    return ", ".join(action.option_strings) + ("" if action.nargs == 0 else f" {many}")


if __name__ == "__main__":
    write()
    sys.stderr.write("written\n")
