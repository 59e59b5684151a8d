"""`deodar doctor`: its report states the present installation."""

from __future__ import annotations

import importlib.metadata
import json
from pathlib import Path

import psutil
import pytest

from deodar.cli import _sizes, main
from deodar.compiler import device


def test_doctor_prints_versions_device_and_cache_folder(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    (tmp_path / "kept").write_bytes(b"x" * 2**20)
    monkeypatch.setenv("DEODAR_CACHE", str(tmp_path))
    assert main(["doctor", "--json"]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert answer["packages"]["jax"] == importlib.metadata.version("jax") and answer["missing"] == []
    assert answer["device"].startswith("cpu") and answer["compiled_programs"] == {
        "folder": str(tmp_path),
        "count": 1,
        "mib": 1.0,
        "writable": True,
    }
    total = psutil.virtual_memory().total / 2**30
    assert 0 < answer["memory_gib"]["free"] <= answer["memory_gib"]["total"] == pytest.approx(total, abs=0.06)
    assert main(["doctor"]) == 0
    page = capsys.readouterr().out
    assert "1 compiled programs" in page and "extra      test: installed" in page


def test_a_missing_package_is_printed_with_the_line_to_type(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    version = importlib.metadata.version

    def without(name: str) -> str:
        if name in ("scipy", "zensical"):
            raise importlib.metadata.PackageNotFoundError(name)
        return version(name)

    monkeypatch.setattr(importlib.metadata, "version", without)
    monkeypatch.setenv("DEODAR_CACHE", "off")
    assert main(["doctor"]) == 1
    page = capsys.readouterr().out
    assert (
        "MISSING    scipy. Type: pip install" in page
        and "pip install 'deodar[docs]'" in page
        and "DEODAR_CACHE=off" in page
    )


@pytest.mark.parametrize(
    ("options", "advice"), [([], device.INSTALL), (["gpu:0"], "Choose one with --device")]
)
def test_the_line_of_devices_states_how_to_choose_or_install_one(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, options: list[str], advice: str
) -> None:
    names, cpu = ["cpu:0", *options], device.find()
    monkeypatch.setattr(device, "names", lambda: names)
    monkeypatch.setattr(device, "find", lambda name=None: cpu)
    main(["doctor"])
    (line,) = [x for x in capsys.readouterr().out.splitlines() if x.startswith("devices")]
    assert line.endswith(advice)


def test_sizes_are_those_of_the_packages_that_deodar_needs_without_an_extra(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    imported: list[str] = []
    monkeypatch.setattr(_sizes, "_import_seconds", lambda module: imported.append(module) or 0.25)
    assert main(["doctor", "--sizes", "--json"]) == 0
    costs = {cost["name"]: cost for cost in json.loads(capsys.readouterr().out)}
    assert costs["jax"]["needed_by"] == "deodar" and costs["jaxlib"]["needed_by"] == "jax"
    assert costs["jaxlib"]["mb"] > 50 > costs["packaging"]["mb"] > 0.1 and "pytest" not in costs
    assert {"PIL", "google_crc32c", "jax"} <= set(imported)
    assert main(["doctor", "--sizes"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[1].startswith("jaxlib ") and lines[1].endswith("0.25  jax") and "packages, " in lines[-2]


def test_the_time_of_an_import_is_measured_and_a_module_that_cannot_be_imported_has_none() -> None:
    assert 0 <= _sizes._import_seconds("json") < 5 and _sizes._import_seconds("no_such_module") is None
