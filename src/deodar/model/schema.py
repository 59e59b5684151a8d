"""JSON Schema of a document, generated from the declarations of everything registered."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from deodar import codec, registry
from deodar.element import Element
from deodar.model import output
from deodar.model.document import READS, VERSION
from deodar.model.parts import form_schema, schema
from deodar.numerics.axes import Axis
from deodar.parameters import Part, parameters

SHIPPED = Path(__file__).with_name("document.schema.json")
"""The generated schema, part of the package; `python tools/generate.py` writes it."""


def reference(base: type[Any]) -> dict[str, Any]:
    """Return a reference to any part of deodar that is valid where `base` is declared."""
    return {
        "oneOf": [
            {"$ref": f"#/$defs/{name}"}
            for name, cls in registry.kinds().items()
            if issubclass(cls, base) and registry.own(cls)
        ]
    }


def document_schema() -> dict[str, Any]:
    """Return the schema of a whole document."""
    parts = {
        name: cls for name, cls in registry.kinds().items() if issubclass(cls, Part) and registry.own(cls)
    }
    defs: dict[str, Any] = {name: schema(cls, reference) for name, cls in parts.items()}
    for name, cls in parts.items():
        if issubclass(cls, Element):
            defs[name]["properties"] |= {
                "id": {"type": "string", "pattern": "^[0-9a-f]{8}$"},
                "every": {"type": "integer", "minimum": 1},
            }
        defs[name]["additionalProperties"] = False
    axis: dict[str, Any] = {
        "type": "object",
        "properties": {
            p.name: form_schema(p, reference) | ({} if p.lower is None else {"minimum": p.lower})
            for p in parameters(Axis)
        },
        "required": ["lower", "upper", "samples"],
        "additionalProperties": False,
    }
    connection: dict[str, Any] = {
        "type": "object",
        "properties": {
            "source": {"type": "string"},
            "target": {"type": "string"},
            "reads": {"enum": [r for r in READS if r]},
        },
        "required": ["source", "target"],
        "additionalProperties": False,
    }
    document_parameter: dict[str, Any] = {
        "type": "object",
        "properties": {"value": {"type": "number"}, "links": {"type": "array", "items": {"type": "string"}}},
        "required": ["value"],
    }
    use: dict[str, Any] = {
        "type": "object",
        "properties": {
            "template": {"type": "string"},
            "elements": {"type": "object", "additionalProperties": {"type": "string"}},
        },
        "required": ["template", "elements"],
        "additionalProperties": False,
    }
    elements = {
        "oneOf": [{"$ref": f"#/$defs/{name}"} for name, cls in parts.items() if issubclass(cls, Element)]
    }
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "deodar document",
        "type": "object",
        "properties": {
            "deodar": {"enum": list(range(1, VERSION + 1))},
            "written_by": {"type": "string"},
            "name": {"type": "string"},
            "time_unit": {"type": "string"},
            "dt": {"type": "number", "exclusiveMinimum": 0},
            "t0": {"type": "number"},
            "axes": {"type": "object", "additionalProperties": axis},
            "parameters": {"type": "object", "additionalProperties": document_parameter},
            "elements": {"type": "object", "additionalProperties": elements},
            "connections": {"type": "array", "items": connection},
            "groups": {"type": "array", "items": {"type": "string"}},
            "uses": {"type": "object", "additionalProperties": use},
            "packages": {"type": "object", "additionalProperties": {"type": "string"}},
            "arrays": {
                "type": "object",
                "properties": {"file": {"type": "string"}, "sha256": {"type": "string"}},
            },
            "notes": {"type": "string"},
            "layout": {"type": "object"},
        },
        "required": ["deodar", "elements"],
        "additionalProperties": False,
        "$defs": defs,
    }


def text() -> str:
    """Return the schema as the text of its file."""
    return codec.text(document_schema(), indent=1) + "\n"


if __name__ == "__main__":
    output.write(SHIPPED, text().encode())
