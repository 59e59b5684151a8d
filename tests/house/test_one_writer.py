"""Files are written by `model/output.py`, which puts them on the disk before they get their names."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

from tests.house.source import MODULES, module, tree

OTHERS = {
    "model.partial": "the names beside the final ones, which `output` and `places` write",
    "guarded.child": "messages to its parent",
    "recording.places": "whole folders, each file of which `output` puts on the disk",
    "deodar_studio.files.open_folder": "the same steps in a folder that is held open, past links",
    "model.package": "writes into the temporary file that `output` gives it, and into folders of `places`",
    "recording.table": "writes into the temporary file that `output` gives it",
    "recording.netcdf": "the same",
    "deodar_interop.records.cedar": "files in the temporary folder that `places` gives it",
    "figures._encode": "writes into the temporary file that `output` gives it",
    "private_file": "a secret of mode 0600, which must not exist before",
    "deodar_studio.access.redirect_file": "a secret of mode 0600, in a temporary folder",
    "deodar_studio.files.saved_files": "moves whole files when their document gets a title",
    "deodar_studio.world.embodiment": "a file in a temporary folder",
    "deodar_spikes.norse": "the file for norse, in a temporary folder",
    "deodar_robots.event_file.event_file": "an example in a temporary folder",
    "deodar_robots.robot.schema": "the generated schema, in the package",
    "batch.workers": "the board that processes map, in a temporary folder",
}
"""Modules that write files themselves, with the reason."""

CALLS = {"fsync", "rename", "mkstemp", "NamedTemporaryFile", "write_text", "write_bytes"}


def _writes(path: Path) -> Iterator[tuple[int, str]]:
    """Yield the line and name of each call that writes, renames or waits for the disk."""
    for node in ast.walk(tree(path)):
        if not isinstance(node, ast.Call):
            continue
        function = node.func
        name = function.attr if isinstance(function, ast.Attribute) else getattr(function, "id", "")
        if name in CALLS:
            on = ast.unparse(function)
            if name != "rename" or on.startswith("os.") or _is_path(function):
                yield node.lineno, name
        elif name in ("open", "fdopen") and _mode(node)[:1] in ("w", "a", "x"):
            yield node.lineno, "open"
        elif name == "replace" and ast.unparse(function).startswith("os."):
            yield node.lineno, "replace"


def _is_path(function: ast.expr) -> bool:
    """Return whether a method is called on a name of a path."""
    value = function.value if isinstance(function, ast.Attribute) else None
    return isinstance(value, ast.Name) and value.id in ("path", "old", "inner", "beside")


def _mode(call: ast.Call) -> str:
    """Return the mode of a call of `open`, "" if it is missing or not a literal."""
    texts = [a.value for a in call.args if isinstance(a, ast.Constant) and isinstance(a.value, str)]
    texts += [
        k.value.value
        for k in call.keywords
        if k.arg == "mode" and isinstance(k.value, ast.Constant) and isinstance(k.value.value, str)
    ]
    return next((text for text in texts if set(text) <= set("rwaxbt+")), "")


def test_files_are_written_by_one_module() -> None:
    found = {module(path): list(_writes(path)) for path in MODULES}
    writers = {name for name, calls in found.items() if calls}
    assert writers - set(OTHERS) == {"model.output"}, {
        n: c for n, c in found.items() if c and n not in OTHERS
    }


def test_every_listed_writer_writes_files() -> None:
    writers = {module(path) for path in MODULES if list(_writes(path))}
    assert set(OTHERS) <= writers


def test_forbidden_writers_are_found(tmp_path: Path) -> None:
    bad = tmp_path / "bad.py"
    bad.write_text(
        "open('a.txt', 'w')\npath.open(mode='ab')\nos.fdopen(3, 'wb')\npath.write_text('')\nos.replace(a, b)"
        "\nos.fsync(3)\nold.rename(new)\nopen('a.txt')\nmodel.rename('a', 'b')\ndata.rename(x='y')\n"
    )
    assert [line for line, _ in _writes(bad)] == [1, 2, 3, 4, 5, 6, 7]
