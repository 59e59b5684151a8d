"""The importers by name: the entry points `deodar.importers`."""

from __future__ import annotations

from types import ModuleType
from typing import Any

from deodar.extensions import Extensions
from deodar.plugins import Plugin


def _problem(plugin: Plugin, module: Any) -> str:
    missing = [name for name in ("NAME", "sniff", "read") if not hasattr(module, name)]
    return f"has no {', '.join(missing)}" if missing else ""


IMPORTERS: Extensions[ModuleType] = Extensions("importers", "importer", dict, _problem)
"""The importers by name.

Each has `NAME`, `sniff(head) -> bool` and `read(content, name, bugs, beside) -> Imported`; `beside` reads
other files of the same folder by their names. It may state `ENDINGS`, the endings of its files besides
`.json`.
"""
