"""Number of cores: set before JAX starts, never by an import, and by the command line for itself."""

from __future__ import annotations

import json
import os
import subprocess
import sys

import pytest

import deodar as dd
from deodar import cores

MODEL = "m = dd.Model('m'); m.add(dd.Field('u', [dd.Axis('x', 0, 1, samples=11)])); "


def printed_by(code: str, nproc: str | None = None) -> dict[str, object]:
    """Return the JSON that a new process prints after `code`."""
    environment = {k: v for k, v in os.environ.items() if k != "NPROC"} | ({"NPROC": nproc} if nproc else {})
    code = "import json, os, sys, deodar as dd; from deodar.compiler.device import cores; found = {}\n" + code
    code += "\nprint('FOUND', json.dumps({'nproc': os.environ.get('NPROC'), 'cores': cores()} | found))"
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, env=environment, check=True
    )
    return json.loads(
        next(line for line in done.stdout.splitlines() if line.startswith("FOUND")).removeprefix("FOUND ")
    )


def test_use_cores_with_another_number_is_refused_after_the_first_run() -> None:
    code = f"""
dd.use_cores(1)
{MODEL}
dd.simulate(m, 5)
dd.use_cores(1)
try:
    dd.use_cores(3)
except dd.errors.CoresError as error:
    found['says'] = str(error)
"""
    seen = printed_by(code)
    assert seen["nproc"] == "1" and seen["cores"] == 1
    assert "already started with 1 cores" in str(seen["says"]) and "NPROC=3" in str(seen["says"])


def test_use_cores_sets_the_environment_until_jax_starts(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("NPROC", "1")
    monkeypatch.setattr(cores, "started", lambda: False)
    for n in (3, 2):
        cores.use_cores(n)
        assert os.environ["NPROC"] == str(n) and cores.cores() == n
    monkeypatch.setattr(cores, "started", lambda: True)
    cores.use_cores(2)
    with pytest.raises(dd.errors.CoresError, match="already started with 2 cores"):
        cores.use_cores(3)
    assert os.environ["NPROC"] == "2"


def test_the_number_of_cores_sets_the_number_of_threads() -> None:
    """XLA names its threads after their pool; with one core it has fewer of them."""
    if not os.path.isdir("/proc/self/task"):  # only Linux lists threads; elsewhere the number is checked
        assert printed_by("dd.use_cores(2)")["nproc"] == "2"
        return
    code = (
        "import jax; dd.use_cores({}); before = len(os.listdir('/proc/self/task')); jax.devices(); x ="
        " jax.numpy.ones(3) + 1\n"
    )
    code += "found['threads'] = len(os.listdir('/proc/self/task')) - before"
    few, many = (int(str(printed_by(code.format(n))["threads"])) for n in (1, 8))
    assert many - few >= 7


def test_importing_deodar_does_not_set_the_number_of_cores() -> None:
    assert printed_by("import deodar.batch.simulate, deodar.batch.workers")["nproc"] is None


def test_the_command_line_uses_one_core_by_default() -> None:
    run = (
        "from deodar.cli import main; main(['elements', '--json']); from deodar.cli import _options;"
        " _options.use_cores({})"
    )
    assert printed_by(run.format("None"))["nproc"] == "1"
    assert printed_by(run.format("None"), nproc="2")["nproc"] == "2"
    assert printed_by(run.format("3"))["cores"] == 3
    assert (
        printed_by("import jax; jax.devices(); from deodar.cli import _options; _options.use_cores(None)")[
            "nproc"
        ]
        is None
    )


@pytest.mark.parametrize("wrong", [0, -1, True, 1.5, "2", None])
def test_an_invalid_number_of_cores_is_refused(wrong: object) -> None:
    with pytest.raises(dd.errors.ParameterError, match="at least 1"):
        dd.use_cores(wrong)  # type: ignore[arg-type]


def test_a_record_states_the_number_of_cores(monkeypatch: pytest.MonkeyPatch) -> None:
    from deodar.recording.provenance import cores_of
    from deodar.recording.record import about

    model = dd.Model("m")
    model.add(dd.Field("u", []))
    provenance = about(dd.simulate(model, 5))
    assert provenance["made_by"]["cores"] == str(cores.cores()) and cores_of(provenance) == cores.cores()
    assert cores_of({}) == 1 and cores_of({"made_by": {"cores": "many"}}) == 1
