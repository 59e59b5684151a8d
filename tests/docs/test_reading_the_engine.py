"""The page on reading the engine names the modules that are there, and leaves out none of the way."""

from __future__ import annotations

import re

from tests.docs.source import DOCS, ROOT

ENGINE = ROOT / "src" / "deodar"
NAMED = set(re.findall(r"`([a-z_/]+\.py)`", (DOCS / "reading-the-engine.md").read_text(encoding="utf-8")))

WAY = (
    *("parameters", "leaves", "part_type", "codec", "registry", "element"),
    *(f"model/{name}" for name in ("document_files", "reader", "parts", "document", "edit", "resolve")),
    *(
        "model/order",
        "model/document_graph",
        "numerics/integrators",
        "numerics/interaction",
    ),
    *(f"session/{name}" for name in ("session", "adopt", "changes", "run")),
)
"""Modules that a number passes from its file to the step, or when it changes while a model runs."""


def test_every_module_that_it_names_exists() -> None:
    assert NAMED and not [name for name in NAMED if not (ENGINE / name).is_file()]


def test_it_names_every_module_of_the_compiler_and_of_the_two_ways() -> None:
    compiler = {f"compiler/{path.name}" for path in (ENGINE / "compiler").glob("[!_]*.py")}
    assert not (compiler | {f"{name}.py" for name in WAY}) - NAMED
