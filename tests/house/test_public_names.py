"""What a script may lean on: the names of the root, frozen in a file, and what importing them costs."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

import deodar

SNAPSHOT = Path(__file__).with_name("public_names.txt")
HEAVY = ["jax", "jaxlib", "numpy", "scipy", "xarray", "zarr", "matplotlib", "PIL", "rich", "psutil"]


def _loaded(code: str) -> set[str]:
    """The heavy packages that a fresh process has imported after running `code`."""
    tail = f"\nimport sys, json; print('LOADED', json.dumps([m for m in {HEAVY!r} if m in sys.modules]))"
    done = subprocess.run([sys.executable, "-c", code + tail], capture_output=True, text=True, check=True)
    line = next(line for line in done.stdout.splitlines() if line.startswith("LOADED"))
    return set(json.loads(line.removeprefix("LOADED ")))


def test_the_root_has_exactly_the_names_of_the_snapshot() -> None:
    assert sorted(deodar.__all__) == SNAPSHOT.read_text().split()


@pytest.mark.parametrize("name", SNAPSHOT.read_text().split())
def test_every_name_resolves_and_says_what_it_is(name: str) -> None:
    found = getattr(deodar, name)
    assert found.__doc__
    assert name in dir(deodar)


def test_an_unknown_name_of_the_root_is_an_attribute_error() -> None:
    with pytest.raises(AttributeError, match="no attribute 'Feild'"):
        deodar.Feild  # noqa: B018


def test_importing_deodar_imports_nothing_heavy() -> None:
    assert _loaded("import deodar") == set()


def test_errors_and_the_command_line_import_nothing_heavy() -> None:
    assert _loaded("import deodar; deodar.errors.DeodarError") == set()
    assert _loaded("import deodar.cli; deodar.cli.parser().format_help()") == set()


def test_help_answers_without_jax_and_numpy() -> None:
    code = "import contextlib, deodar.cli\nwith contextlib.suppress(SystemExit):\n    deodar.cli.main(['--help'])\n"
    assert _loaded(code) == set()


def test_a_document_is_read_and_checked_without_plots_or_records() -> None:
    """Reading and checking is quick: xarray, Zarr and matplotlib wait until a record is made or drawn."""
    code = "import deodar as dd; m = dd.Model('m'); m.add(dd.Field('u', [dd.Axis('x', 0, 1, samples=3)])); assert not m.check()"
    assert not _loaded(code) & {"xarray", "zarr", "matplotlib", "PIL", "rich"}
