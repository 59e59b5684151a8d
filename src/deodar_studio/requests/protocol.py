"""JSON Schema and TypeScript of the messages, generated from their declaration.

    python -m deodar_studio.requests.protocol

writes `protocol.schema.json` beside this file and, in a copy of the repository, `studio/src/protocol.ts`.
"""

from __future__ import annotations

import inspect
import textwrap
from pathlib import Path
from typing import Any

import msgspec

from deodar import codec
from deodar.model import output
from deodar_studio.messages import to_page
from deodar_studio.messages.message import union
from deodar_studio.requests.request import MESSAGES, DocumentRequest, OpeningRequest

SCHEMA = Path(__file__).with_name("protocol.schema.json")
TYPESCRIPT = Path(__file__).parents[3] / "studio" / "src" / "protocol.ts"
HEAD = (
    "// Generated from src/deodar_studio/requests and messages/to_page.py; change those, not this one:\n"
    "// python tools/generate.py\n"
)


def schema() -> dict[str, Any]:
    """Return the JSON Schema of both unions and all types in them."""
    unions = [union(MESSAGES), union(to_page.MESSAGES)]
    (server, page), defs = msgspec.json.schema_components(unions, ref_template="#/$defs/{name}")
    for form in defs.values():
        if "description" in form:  # with the indents of the source, or without: versions of msgspec differ
            form["description"] = inspect.cleandoc(form["description"])
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "deodar studio",
        "$defs": defs | {"ToServer": server, "ToPage": page},
    }


def schema_text() -> str:
    """Return the schema as the text of the generated file."""
    return codec.text(schema(), indent=1) + "\n"


def _comment(text: str) -> str:
    """Format a text as `//` comments of at most 110 columns, one for each paragraph."""
    paragraphs = [" ".join(part.split()) for part in text.split("\n\n") if part.strip()]
    return "//\n".join(
        "".join(f"// {line}\n" for line in textwrap.wrap(paragraph, 107, break_on_hyphens=False))
        for paragraph in paragraphs
    )


def typescript() -> str:
    """Return the schema as TypeScript types."""
    out = [HEAD]
    for name, form in sorted(schema()["$defs"].items()):
        description = form.get("description", "")
        out.append(_comment(description))
        if "properties" in form:
            out.append(f"export type {name} = {_record(form)};\n\n")
        else:
            lines = "".join(f"\n  | {_type(f)}" for f in form["anyOf"])
            out.append(f"export type {name} ={lines};\n\n")
    out.append("// Types of the requests that are meant for the document that the page shows.\n")
    listed = "".join(f"  {codec.line(tag)},\n" for tag in meant())
    out.append(f'export const MEANT: readonly ToServer["type"][] = [\n{listed}];\n')
    return "".join(out)


def meant() -> list[str]:
    """Return the types of the requests that are meant for the open document, and do not open another one."""
    return sorted(
        str(cls.__struct_config__.tag)
        for cls in MESSAGES.values()
        if issubclass(cls, DocumentRequest) and not issubclass(cls, OpeningRequest)
    )


def _record(form: dict[str, Any]) -> str:
    required = set(form.get("required", []))
    lines = [
        _folded(f"  {key}{'' if key in required else '?'}: {_type(inner)};")
        for key, inner in form["properties"].items()
    ]
    return "{\n" + "\n".join(lines) + "\n}"


def _folded(line: str) -> str:
    """Fold a member of a record; a union too wide for a line has one line for each alternative."""
    name, _, kinds = line.partition(": ")
    return line if len(line) <= 110 else f"{name}:\n    | " + kinds.replace(" | ", "\n    | ")


def _type(form: dict[str, Any]) -> str:
    if "$ref" in form:
        return form["$ref"].rsplit("/", 1)[1]
    if "enum" in form:
        return " | ".join(codec.line(v) for v in form["enum"])
    if "const" in form:
        return codec.line(form["const"])
    if "anyOf" in form:
        return " | ".join(dict.fromkeys(_type(f) for f in form["anyOf"]))
    match form.get("type"):
        case "array":
            inner = _type(form["items"]) if form.get("items") else "unknown"
            return f"({inner})[]" if " " in inner else f"{inner}[]"
        case "object":
            inner = form.get("additionalProperties")
            return f"Record<string, {_type(inner) if isinstance(inner, dict) else 'unknown'}>"
        case "integer" | "number":
            return "number"
        case "string":
            return "string"
        case "boolean":
            return "boolean"
        case "null":
            return "null"
        case _:
            return "unknown"


def write() -> None:
    """Write both files."""
    output.write(SCHEMA, schema_text().encode())
    if TYPESCRIPT.parent.is_dir():
        output.write(TYPESCRIPT, typescript().encode())


if __name__ == "__main__":
    write()
