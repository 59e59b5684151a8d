"""Write the list of public names, `src/deodar/__init__.pyi`.

    python tools/stub.py      also a step of tools/generate.py

The lines of kinds follow from the registry, and those of the packages beside the engine from the entry
points of deodar (`deodar.worlds`, `deodar.names`). All other lines of the engine stay as they are.
"""

from __future__ import annotations

import importlib.metadata
from collections.abc import Iterator
from pathlib import Path

from deodar import registry

STUB = Path(__file__).resolve().parents[1] / "src" / "deodar" / "__init__.pyi"
HEAD = """\
# Every public name, one line each. Editors and pyright read the names here, and so does `__init__.py`, which
# imports a name when it is first used. `python tools/generate.py` writes the lines of kinds and of the
# packages beside the engine; the others are written by hand.

"""
TAIL = "\n__version__: str\n"


def _kinds() -> Iterator[str]:
    """Yield the lines of the engine's kinds."""
    for name, cls in registry.kinds().items():
        if cls.__module__.startswith("deodar."):
            yield f"from {cls.__module__} import {name} as {name}"


def _packages() -> Iterator[str]:
    """Yield the lines of the packages beside the engine."""
    for entry in importlib.metadata.distribution("deodar").entry_points:
        if entry.group in ("deodar.worlds", "deodar.names"):
            home, attribute = (entry.module, entry.attr) if entry.attr else entry.module.rsplit(".", 1)
            yield f"from {home} import {attribute} as {entry.name}"


def _by_hand(text: str) -> Iterator[str]:
    """Yield the other lines of a stub: those of the engine that name no kind."""
    kinds = registry.kinds()
    for line in text.splitlines():
        words = line.split()
        if line.startswith(("from deodar ", "from deodar.")) and words[-1] not in kinds:
            yield line


def stub(text: str) -> str:
    """Return the whole stub, given its present text."""
    lines = {*_kinds(), *_packages(), *_by_hand(text)}
    ordered = sorted(lines, key=lambda line: (line.split()[1], line.split()[-1]))
    return HEAD + "\n".join(ordered) + "\n" + TAIL


if __name__ == "__main__":
    STUB.write_text(stub(STUB.read_text(encoding="utf-8")), encoding="utf-8")
