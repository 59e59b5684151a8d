"""`deodar elements [KIND]`."""

from __future__ import annotations

import argparse
import json
from collections.abc import Iterator

from deodar.part_type import source_doc

HELP = (
    "list elements, couplings, kernels, sigmoids and worlds, or show one of them with its equation and"
    " parameters"
)


def arguments(parser: argparse.ArgumentParser) -> None:
    """Arguments of the command."""
    parser.add_argument("kind", nargs="?", metavar="KIND", help="show this one, for example Field")
    parser.add_argument("--json", action="store_true", help="print the answer as JSON")


def run(args: argparse.Namespace) -> int:
    """The list, or one page."""
    from deodar import registry
    from deodar.model.parts import schema
    from deodar.model.schema import reference
    from deodar.parameters import Part

    if args.kind:
        cls = registry.kind(args.kind)
        if args.json:
            found = (
                schema(cls, reference)
                if issubclass(cls, Part)
                else {"title": cls.__name__, "description": source_doc(cls)}
            )
            print(json.dumps(found, indent=2, ensure_ascii=False))
        else:
            where = f"dd.{cls.__name__}" if cls.__module__.startswith("deodar.") else cls.__module__
            print(f"{cls.__name__}  ({where})\n\n{source_doc(cls)}")
            values = list(_values(cls)) if issubclass(cls, Part) else []
            if values:
                print("\n".join(["", "Values:", *values]))
        return 0
    listed = {room: registry.kinds(room) for room in registry.ROOMS}
    known = {name for found in listed.values() for name in found}
    outside = {
        name: cls
        for name, cls in registry.kinds().items()
        if name not in known and not cls.__module__.startswith("deodar.")
    }
    listed |= {"own": outside} if outside else {}
    if args.json:
        print(
            json.dumps(
                {room: {name: _line(cls) for name, cls in found.items()} for room, found in listed.items()},
                indent=2,
            )
        )
        return 0
    width = max(len(name) for found in listed.values() for name in found)
    for room, found in listed.items():
        print(room.split(".")[-1])
        for name, cls in found.items():
            print(f"  {name:{width}}  {_line(cls)}")
    return 0


def _values(cls: type) -> Iterator[str]:
    """For each parameter its default, unit, range and what a change costs, from the declaration."""
    from deodar.parameters import parameters, show

    rows = [p for p in parameters(cls) if p.name != "name"]
    width = max((len(p.name) for p in rows), default=0)
    for p in rows:
        lower, upper = ("" if bound is None else f"{bound:g}" for bound in (p.lower, p.upper))
        bounds = (
            f"{lower} to {upper}".strip()
            if lower and upper
            else f"from {lower}"
            if lower
            else f"to {upper}"
            if upper
            else ""
        )
        about = [show(p.default), p.unit, bounds, " | ".join(p.choices), p.cost]
        yield f"    {p.name:{width}}  {'; '.join(a for a in about if a)}"


def _line(cls: type) -> str:
    return " ".join((source_doc(cls) or cls.__name__).partition("\n\n")[0].split())
