"""The command `deodar doctor`."""

from __future__ import annotations

import argparse
import dataclasses as dc
import importlib.metadata
import os
import platform
import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from deodar import __version__, codec, regular_file
from deodar.cli import _options
from deodar.cli._answer import CommandAnswer
from deodar.errors import DocumentError
from deodar.model import output, partial

if TYPE_CHECKING:
    from deodar.compiler.plans import Measured

HELP = "list installed packages, devices, the cache of compiled programs, and what is missing"

EXTRA = re.compile(r"""([\w.-]+).*extra == ["']([\w-]+)["']""")
"""A requirement of an extra in the metadata of deodar."""

GIB = 2**30


def arguments(parser: _options.CommandParser) -> None:
    """Add the arguments of the command."""
    parser.option("files", "FILE", "documents and experiments whose packages are looked for", nargs="*")
    _options.add_json(parser)
    parser.option(
        "--report",
        "REPORT",
        "one text for a fault report, with the last error, without paths of yours (default: print it)",
        nargs="?",
        const="",
    )
    _options.add_force(parser)
    parser.flag(
        "--plans",
        "measure every convolution strategy and compare it with its estimated cost (about a minute)",
    )
    parser.flag(
        "--sizes",
        "measure the size of each package that deodar needs, and the time of its import (half a minute)",
    )


def run(args: argparse.Namespace) -> CommandAnswer:
    """Examine the installation; status 1 if a requirement is missing."""
    if args.plans:
        return _plans()
    if args.sizes:
        return _measure_sizes()
    if args.report is not None:
        return _reported(args.report, args.force)
    state = examine() | ({"documents": [_needs(path) for path in args.files]} if args.files else {})
    state["left"] = [str(path) for path in _left_over({Path(), *(Path(file).parent for file in args.files)})]
    return CommandAnswer(state, [_page(state)], 1 if state["missing"] else 0)


def report() -> str:
    """Return one text for a fault report: versions, devices, caches and the last error of deodar itself.

    It has no path or name of a file of the user.
    """
    # start-up time
    from deodar import last_error

    state = examine()
    state["compiled_programs"]["folder"] = "their folder"
    variables = sorted(name for name in os.environ if name.startswith(("DEODAR_", "JAX_", "XLA_")))
    lines = [last_error.without_names(_page(state)), f"set        {', '.join(variables) or 'no variable'}"]
    return "\n".join([*lines, "", f"last error {last_error.stated() or 'none is kept'}"])


def _reported(path: str, force: bool) -> CommandAnswer:
    """Print the text for a fault report, or write it."""
    text = report()
    if not path:
        return CommandAnswer({"report": text}, [text])
    output.write(output.claim(path, force), f"{text}\n".encode())
    return CommandAnswer({"report": text, "out": path}, [f"Wrote {path}. Read it before you pass it on"])


def _left_over(folders: set[Path]) -> Iterator[Path]:
    """Yield what processes that were killed left in folders: the next save of the same files removes it."""
    # start-up time: this brings JAX
    from deodar.model import document_files

    for folder in sorted(folders):
        if folder.is_dir():
            yield from partial.abandoned(folder)
            yield from document_files.left_arrays(folder)


def _plans() -> CommandAnswer:
    """Compare the cost model of convolutions with this machine, on one core."""
    # start-up time: these bring JAX
    from rich.console import Console
    from rich.progress import track

    from deodar.cores import use_cores

    use_cores(1)
    # start-up time: these bring JAX
    from deodar.compiler.plans import CASES, measure

    console = Console(stderr=True)
    steps = [m for case in track(CASES, "measuring", console=console, transient=True) for m in measure(case)]
    return CommandAnswer([{**dc.asdict(m), "case": str(m.case)} for m in steps], _table(steps))


def _table(steps: Sequence[Measured]) -> Iterator[str]:
    """Print measured steps as a table, and yield how good the choice of strategies is."""
    # start-up time
    from rich.console import Console
    from rich.table import Table

    table = Table(
        "field and kernels",
        "method",
        "predicted us",
        "measured us",
        "",
        title="One step of the convolution; * marks the chosen strategy",
    )
    for m in steps:
        table.add_row(
            str(m.case),
            m.method,
            f"{m.predicted_us:.1f}",
            f"{m.measured_us:.1f}",
            "*" if m.chosen else "",
            end_section=m is steps[-1],
        )
    Console().print(table)
    lost = [m.measured_us / min(o.measured_us for o in steps if o.case == m.case) for m in steps if m.chosen]
    right = sum(ratio <= 1.25 for ratio in lost)
    yield (
        f"The chosen strategy is the fastest, or within 25 % of it, in {right} of {len(lost)} cases; at worst"
        f" it takes {max(lost):.2f} times as long"
    )


def _measure_sizes() -> CommandAnswer:
    """Measure the size and the time of an import of each package that deodar needs, the largest first."""
    # start-up time
    from rich.console import Console
    from rich.progress import track

    from deodar.cli import _sizes

    modules, needed = _sizes.modules_by_distribution(), _sizes.closure()
    bar = track(needed.items(), "measuring", console=Console(stderr=True), transient=True)
    costs = sorted((_sizes.measure(name, parent, modules) for name, parent in bar), key=lambda cost: -cost.mb)
    lines = [f"{'package':<24}{'version':<14}{'MB':>8}{'import, s':>11}  needed by"]
    for cost in costs:
        seconds = "-" if cost.seconds is None else f"{cost.seconds:.2f}"
        lines.append(f"{cost.name:<24}{cost.version:<14}{cost.mb:>8.1f}{seconds:>11}  {cost.needed_by}")
    total = sum(cost.mb for cost in costs)
    lines.append(f"{len(costs)} packages, {total:.0f} MB. The time of an import is CPU time,")
    return CommandAnswer(
        [dc.asdict(cost) for cost in costs], [*lines, "with all that the package itself imports."]
    )


def examine() -> dict[str, Any]:
    """Return the state of the installation as plain data."""
    # start-up time
    import psutil

    # start-up time: these bring JAX
    from deodar.compiler import cache, device
    from deodar.numerics import native

    def version(name: str) -> str | None:
        try:
            return importlib.metadata.version(name)
        except importlib.metadata.PackageNotFoundError:
            return None

    needed = [
        re.split(r"[^\w.-]", r)[0] for r in importlib.metadata.requires("deodar") or () if "extra ==" not in r
    ]
    packages = {name: version(name) for name in sorted(needed)}
    place = cache.folder()
    program_sizes = (
        [p.stat().st_size for p in place.iterdir() if p.is_file()]
        if place is not None and place.is_dir()
        else []
    )
    existing = next((p for p in (place, *place.parents) if p.exists()), None) if place is not None else None
    memory = psutil.virtual_memory()
    return {
        "deodar": __version__,
        "python": platform.python_version(),
        "system": platform.platform(),
        "packages": packages,
        "missing": [name for name, installed in packages.items() if installed is None],
        "plugins": _plugins(),
        "extras": {extra: None not in map(version, names) for extra, names in _extras().items()},
        "device": device.name(device.find()),
        "devices": {name: device.find(name).device_kind for name in device.names()},
        "cores": device.available(),
        "memory_gib": {"total": round(memory.total / GIB, 1), "free": round(memory.available / GIB, 1)},
        "native": {
            "kernels": native.version(native.kernels("cpu", "float32")),
            "problem": native.problem(),
            "off": native.switched_off(),
        },
        "compiled_programs": {
            "folder": str(place) if place is not None else None,
            "count": len(program_sizes),
            "mib": round(sum(program_sizes) / 2**20, 1),
            "writable": bool(existing is not None and os.access(existing, os.W_OK)),
        },
    }


def _extras() -> dict[str, list[str]]:
    """Return the packages that each extra of deodar brings."""
    packages: dict[str, list[str]] = {}
    for requirement in importlib.metadata.requires("deodar") or ():
        if extra := EXTRA.match(requirement):
            packages.setdefault(extra[2], []).append(extra[1])
    return packages


def _needs(path: str) -> dict[str, Any]:
    """Return the packages that a document needs, or an experiment and its model, and that are missing or have
    another version.
    """
    # start-up time: these bring JAX
    from deodar.experiments.design import Design
    from deodar.importers import opening
    from deodar.model import document_files

    check = f"deodar check {path}"
    try:
        place = opening.require(path)
        if _is_experiment(place):
            check = f"deodar experiment {path} --check"
            place = opening.require(str(Design.load(place).model))
        document_files.load(place)
    except DocumentError as error:
        problems = [
            f"{p.what}. {p.fix_at('shell')}".removesuffix(". ")
            for p in error.problems
            if ": packages." in p.where
        ]
        return {"file": path, "problems": problems, "opens": False, "check": check}
    return {"file": path, "problems": [], "opens": True, "check": check}


def _is_experiment(path: Path) -> bool:
    try:
        content = codec.read(regular_file.read_bytes(path))
    except (DocumentError, OSError):
        return False
    return isinstance(content, dict) and "experiment" in content


def _plugins() -> list[dict[str, str]]:
    """Return the extensions of installed packages, each with its problem; "" without a problem."""
    # start-up time: these bring JAX
    import deodar
    from deodar import cli, plugins, registry
    from deodar.experiments.measures import MEASURES
    from deodar.exporters.tools import EXPORTERS
    from deodar.figures import _panels
    from deodar.importers import examples
    from deodar.importers.tools import IMPORTERS

    registry.kinds()  # names in deodar
    names = plugins.found("names", vars(deodar)["__all__"])
    groups = plugins.found("groups", plugins.GROUPS)
    defined = [group.load()[0] for group in groups if not group.load()[1]]
    listed = [(p, registry.take(p)) for p in registry.packaged()]
    for group in (MEASURES, _panels.KINDS, *defined, IMPORTERS, EXPORTERS, cli.COMMANDS):
        listed += [(p, group.problem(p)) for p in group.packaged()]
    listed += [(p, p.load()[1]) for p in (*examples.packaged(), *names, *groups)]
    return [
        {"package": p.package, "version": p.version, "group": p.group, "name": p.name, "problem": problem}
        for p, problem in listed
        if problem or not p.first_party
    ]


def _kernels(kernels: str, problem: str, off: bool) -> str:
    if off:
        return "compiled kernels are not used (DEODAR_NATIVE=off)"
    if problem:
        return f"PROBLEM: deodar-native {problem}"
    return f"deodar-native {kernels}" if kernels else "deodar-native is not installed (docs/speed.md)"


def _page(state: dict[str, Any]) -> str:
    # start-up time: these bring JAX
    from deodar.compiler import device

    lines = [f"deodar {state['deodar']} on Python {state['python']}, {state['system']}"]
    lines.append(
        f"device     {state['device']}; {state['cores']} cores, {state['memory_gib']['free']} of"
        f" {state['memory_gib']['total']} GiB memory free"
    )
    devices = ", ".join(f"{name} ({kind})" for name, kind in state["devices"].items())
    lines.append(
        f"devices    {devices}. "
        + ("Choose one with --device" if len(state["devices"]) > 1 else device.INSTALL)
    )
    lines.append(
        "packages   "
        + ", ".join(f"{name} {version}" for name, version in state["packages"].items() if version)
    )
    if state["missing"]:
        lines.append(f"MISSING    {', '.join(state['missing'])}. Type: pip install --upgrade deodar")
    for p in state["plugins"]:
        lines.append(
            f"plug-in    {p['package']} {p['version']}: "
            + (f"PROBLEM: {p['name']} {p['problem']}" if p["problem"] else f"{p['group']} {p['name']}")
        )
    for document in state.get("documents", ()):
        verdict = (
            "opens"
            if document["opens"]
            else "no package is missing, but it does not open. Type: " + document["check"]
        )
        lines += [
            f"document   {document['file']}: {line}"
            for line in ["PROBLEM: " + p for p in document["problems"]] or [verdict]
        ]
    for path in state.get("left", ()):
        old = Path(path) / partial.OLD
        lines.append(
            f"left over  {path}, of a process that was killed. "
            + (f"It holds what was replaced: {old}" if old.exists() else "It may be removed")
        )
    for extra, installed in state["extras"].items():
        lines.append(
            f"extra      {extra}: "
            + ("installed" if installed else f"not installed. Type: pip install 'deodar[{extra}]'")
        )
    lines.append(f"kernels    {_kernels(**state['native'])}")
    programs = state["compiled_programs"]
    if programs["folder"] is None:
        lines.append("programs   compiled programs are not kept (DEODAR_CACHE=off)")
    else:
        note = "" if programs["writable"] else ", which cannot be written to: every start compiles again"
        lines.append(
            f"programs   {programs['count']} compiled programs, {programs['mib']} MiB, in"
            f" {programs['folder']}{note}"
        )
    return "\n".join(lines)
