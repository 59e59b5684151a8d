"""The importers by name: the entry points `deodar.importers`."""

from __future__ import annotations

from types import ModuleType

from deodar.extensions import Extensions, requires

IMPORTERS: Extensions[ModuleType] = Extensions(
    "importers", "importer", dict, requires("NAME", "sniff", "read")
)
"""The importers by name.

Each has `NAME`, `sniff(head) -> bool` and `read(content, name, bugs, beside) -> Imported`; `beside` reads
other files of the same folder by their names. It may state `ENDINGS`, the endings of its files besides
`.json`.
"""
