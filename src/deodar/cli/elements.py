"""The command `deodar elements [KIND]`."""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from deodar.cli import _options
from deodar.cli._answer import CommandAnswer
from deodar.declarations import range_text

if TYPE_CHECKING:  # this also imports NumPy
    from deodar.kinds.parameter import ParameterDescription

HELP = (
    "list elements, couplings, kernels, sigmoids and worlds, or show one of them with its equation and"
    " parameters"
)


def arguments(parser: _options.CommandParser) -> None:
    """Add the arguments of the command."""
    parser.option("kind", "KIND", "show this one, for example Field", nargs="?")
    _options.add_json(parser)


def run(args: argparse.Namespace) -> CommandAnswer:
    """Print the list of kinds, or the page of one kind."""
    # start-up time: these bring JAX
    from deodar import docstring, registry
    from deodar.kinds.description import describe
    from deodar.model.parts import schema
    from deodar.model.schema import reference
    from deodar.parameters import Part

    if args.kind:
        cls = registry.kind(args.kind)
        source = docstring.source(cls)
        fields = (
            schema(cls, reference)
            if issubclass(cls, Part)
            else {"title": cls.__name__, "description": source}
        )
        kind = describe(cls)
        values = ["", "Values:", *_values(kind.parameters)] if kind.parameters else []
        return CommandAnswer(fields, [f"{kind.name}  ({kind.public_name})\n\n{source}", *values])
    listed = {room: registry.kinds(room) for room in registry.ROOMS}
    names = {name for kinds in listed.values() for name in kinds}
    outside = {
        name: cls for name, cls in registry.kinds().items() if name not in names and not registry.own(cls)
    }
    listed |= {"own": outside} if outside else {}
    summaries = {
        room: {
            name: docstring.parse(docstring.source(cls)).summary or cls.__name__
            for name, cls in kinds.items()
        }
        for room, kinds in listed.items()
    }
    width = max(len(name) for kinds in summaries.values() for name in kinds)
    lines = [
        line
        for room, kinds in summaries.items()
        for line in (room.split(".")[-1], *(f"  {name:{width}}  {text}" for name, text in kinds.items()))
    ]
    return CommandAnswer(summaries, lines)


def _values(parameters: Sequence[ParameterDescription]) -> Iterator[str]:
    """Yield for each parameter its default, unit, range and the cost of a change."""
    width = max(len(p.name) for p in parameters)
    for p in parameters:
        columns = [p.typed, p.unit, range_text(p.lower, p.upper), " | ".join(p.choices), p.cost]
        yield f"    {p.name:{width}}  {'; '.join(a for a in columns if a)}"
