"""The description of a kind, made from its declarations and its docstring."""

from __future__ import annotations

import dataclasses as dc
import re
from collections.abc import Mapping
from typing import cast

from deodar import docstring, plugins, registry
from deodar.codec import Json
from deodar.docstring import Docstring
from deodar.element import Element
from deodar.kinds.parameter import ParameterDescription, describe_parameter, plain
from deodar.kinds.world_settings import WorldSetting, world_settings
from deodar.parameters import Parameter, Part, parameters, positional
from deodar.worlds._base import World


@dc.dataclass(frozen=True)
class Description:
    """What a kind is. Kinds of packages may leave anything empty.

    Attributes:
        name: name of the class.
        module: name of its module.
        room: elements, couplings, kernels, sigmoids, windows or worlds; own for other kinds of packages.
        title: its name in words.
        summary: the first paragraph of its docstring, in one line.
        text: the docstring before the first section: the summary and what follows it.
        equation: lines of TeX, each shown on a line of its own.
        parameters: the declared parameters without `name`: those by position, then those by name.
        arguments: what the constructor takes where the kind declares no parameters, as worlds.
        ports: what each port carries; of a world, its sensors and motors.
        shapes: shapes of arrays, in one line.
        levels: for a port, the parameters that are levels on its scale (threshold, resting level).
        maps: for an array parameter from a source to a target, the ports whose axes its dimensions have.
        reference: where the equation comes from; "" where the docstring says: no reference.
        example: a value to start from, where the kind stands inside an element; None otherwise.
        opens: endings of the files that a world opens.
        names: names that a world opens besides files.
        settings: arguments of a world that can be opened.
    """

    name: str
    module: str
    room: str
    title: str
    summary: str
    text: str
    equation: tuple[str, ...]
    parameters: tuple[ParameterDescription, ...]
    arguments: Mapping[str, str]
    ports: Mapping[str, str]
    shapes: str
    levels: Mapping[str, Mapping[str, str]]
    maps: Mapping[str, tuple[str, ...]]
    reference: str
    example: Json
    opens: tuple[str, ...] = ()
    names: tuple[str, ...] = ()
    settings: tuple[WorldSetting, ...] = ()

    @property
    def public_name(self) -> str:
        """How a script names it: `dd.Field`, or the module and the class of a kind of a package."""
        return f"dd.{self.name}" if plugins.is_own(self.module) else f"{self.module}.{self.name}"


def descriptions() -> list[Description]:
    """Describe every registered kind, those of imported packages included."""
    known = registry.kinds()
    return [describe(cls, known) for cls in known.values()]


def describe(cls: type, known: Mapping[str, type] | None = None) -> Description:
    """Describe one kind.

    Args:
        cls: its class.
        known: every registered kind by name, if the caller has them at hand.
    """
    known = registry.kinds() if known is None else known
    doc = docstring.parse(docstring.source(cls))
    example = _example(cls)
    described = docstring.descriptions(cls) if issubclass(cls, Part) else doc.entries("Parameters")
    reference = doc.line("Reference")
    equation = doc.lines("Equation")
    declared = _declared(cls) if issubclass(cls, Part) else []
    return Description(
        name=cls.__name__,
        module=cls.__module__,
        room=_room(cls),
        title=title(cls.__name__),
        summary=doc.summary,
        text=doc.opening,
        equation=equation,
        parameters=tuple(describe_parameter(p, described.get(p.name, ""), equation, known) for p in declared),
        arguments={} if issubclass(cls, Part) else described,
        ports=_ports(cls, doc, example),
        shapes=doc.line("Shapes"),
        levels=dict(cls.levels) if issubclass(cls, Element) else {},
        maps=dict(cls.maps) if issubclass(cls, Element) else {},
        reference="" if reference == "no reference" else reference,
        example=plain(example) if example is not None and not isinstance(example, Element) else None,
        opens=cls.opens if issubclass(cls, World) else (),
        names=tuple(cls.names()) if issubclass(cls, World) else (),
        settings=world_settings(cls, described),
    )


def title(name: str) -> str:
    """Return the name of a class in words: Gaussian stimulus. A name of syllables stays: MuJoCo."""
    words = re.sub(r"(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])|_+", " ", name).split()
    if len(words) > 1 and all(len(word) == 2 for word in words):
        return name
    lower = [w if w.isupper() and len(w) > 1 else w.lower() for w in words]
    return " ".join(w if i or w.isupper() else w.capitalize() for i, w in enumerate(lower))


def _declared(cls: type[Part]) -> list[Parameter]:
    first = positional(cls)
    return sorted((p for p in parameters(cls) if p.name != "name"), key=lambda p: p.name not in first)


def _room(cls: type) -> str:
    """The first folder of its module, below `numerics` the second; windows have a module instead."""
    package, *inner = cls.__module__.split(".")
    if package != "deodar":
        return "worlds" if issubclass(cls, World) else "own"
    return inner[1] if inner[0] == "numerics" else inner[0]


def _example(cls: type) -> Part | None:
    """An instance that works on its own; None where a kind of a package has none."""
    try:
        return cls.example() if issubclass(cls, Part) else None
    except Exception:  # a kind of a package may need values that it does not give
        return None


def _ports(cls: type, doc: Docstring, example: Part | None) -> dict[str, str]:
    """The ports of the docstring, then those that it leaves out, with an empty text."""
    if issubclass(cls, World):
        return {name: str(signal) for name, signal in {**cls.sensors, **cls.motors}.items()}
    if not issubclass(cls, Element):
        return {}
    texts = doc.entries("Ports")
    inputs, outputs = list(cls.inputs), cast("list[str]", [])
    if isinstance(example, Element):
        inputs = list(example.ports())
        try:
            outputs = list(example.outputs({port: example.input_axes(port, ()) or () for port in inputs}))
        except Exception:  # the same
            outputs = []
    return {**texts, **{port: texts.get(port, "") for port in [*inputs, *outputs]}}
