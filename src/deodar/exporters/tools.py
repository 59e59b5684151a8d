"""The exporters by name: the entry points `deodar.exporters`.

An exporter is a module with `NAME`, `ENDING` (of the name of a file, "" for a folder), `HELP` (one line), and

* `write(model, name, **options) -> Exported`, which converts a model, or
* `save(data, path, force)`, which writes a record.

One with options on the command line also has `ABOUT` (the subject of its options), `arguments(parser)`, and
`options(args)`, which returns the options of `write`. `deodar --help` reads these modules, so they import
JAX, NumPy and xarray inside functions.
"""

from __future__ import annotations

from types import ModuleType
from typing import Any

from deodar.extensions import Extensions, requires
from deodar.plugins import Plugin


def _problem(plugin: Plugin, module: Any) -> str:
    missing = requires("NAME", "ENDING", "HELP")(plugin, module)
    return missing or ("" if hasattr(module, "write") or hasattr(module, "save") else "has no write or save")


EXPORTERS: Extensions[ModuleType] = Extensions("exporters", "exporter", dict, _problem)
"""The exporters of installed packages."""


def of_models() -> dict[str, ModuleType]:
    """Return the exporters that convert models."""
    return {name: module for name, module in EXPORTERS.items() if hasattr(module, "write")}


def of_records() -> dict[str, ModuleType]:
    """Return the exporters that write records."""
    return {name: module for name, module in EXPORTERS.items() if hasattr(module, "save")}
