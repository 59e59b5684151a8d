"""`deodar elements [KIND]`."""

from __future__ import annotations

import argparse
import inspect
import json

HELP = "list elements, couplings, kernels, sigmoids and worlds, or show one of them with its equation and parameters"


def arguments(parser: argparse.ArgumentParser) -> None:
    """Arguments of the command."""
    parser.add_argument("kind", nargs="?", metavar="KIND", help="show this one, for example Field")
    parser.add_argument("--json", action="store_true", help="print the answer as JSON")


def run(args: argparse.Namespace) -> int:
    """The list, or one page."""
    from deodar import registry
    from deodar.model.schema import reference
    from deodar.parameters import Part, schema

    if args.kind:
        cls = registry.kind(args.kind)
        if args.json and issubclass(cls, Part):
            print(json.dumps(schema(cls, reference), indent=2, ensure_ascii=False))
        else:
            print(f"{cls.__name__}  ({cls.__module__})\n\n{inspect.getdoc(cls)}")
        return 0
    listed = {room: registry.kinds(room) for room in registry.ROOMS}
    if args.json:
        print(json.dumps({room: {name: _line(cls) for name, cls in found.items()} for room, found in listed.items()}, indent=2))
        return 0
    for room, found in listed.items():
        print(room.split(".")[-1])
        for name, cls in found.items():
            print(f"  {name:18}{_line(cls)}")
    return 0


def _line(cls: type) -> str:
    return (inspect.getdoc(cls) or "").splitlines()[0]
