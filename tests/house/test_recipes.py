"""The recipes in `deploy` follow the project: its version, its dependencies, its access control."""

from __future__ import annotations

import json
import re
import tomllib
import urllib.error
import urllib.request
from pathlib import Path
from types import SimpleNamespace
from typing import Any
from urllib.parse import urlsplit

import pytest
from packaging.requirements import Requirement

import deodar
from tests.deodar_studio.page import studio
from tests.house.source import ROOT

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
RECIPE = (ROOT / "deploy" / "conda" / "recipe.yaml").read_text(encoding="utf-8")
CONDA_NAMES = {"matplotlib": "matplotlib-base"}
"""Packages that have another name there."""


def _section(name: str) -> list[str]:
    [lines] = re.findall(rf"^  {name}:\n((?:    - .*\n)+)", RECIPE, re.MULTILINE)
    return [line.removeprefix("    - ") for line in lines.splitlines()]


def test_the_package_for_conda_has_the_version_and_the_dependencies_of_the_project() -> None:
    assert f'version: "{deodar.__version__}"' in RECIPE
    needed = [Requirement(text) for text in PROJECT["project"]["dependencies"]]
    python = f"python {PROJECT['project']['requires-python']}"
    assert _section("run") == [
        python,
        *(f"{CONDA_NAMES.get(need.name, need.name)} {need.specifier}" for need in needed),
    ]
    built = [Requirement(text) for text in PROJECT["build-system"]["requires"]]
    # the sdist has the built page
    tools = {f"{tool.name} {tool.specifier}" for tool in built if not tool.name.startswith("nodejs")}
    assert set(_section("host")) == {python, "pip", *tools}


def _servers() -> Any:
    """Return what the configuration of a Jupyter server adds."""
    config = SimpleNamespace(ServerProxy=SimpleNamespace())
    path = ROOT / "deploy" / "jupyterhub" / "jupyter_server_config.py"
    exec(path.read_text(encoding="utf-8"), {"get_config": lambda: config})
    return config.ServerProxy.servers["deodar"]


def test_a_studio_accepts_what_the_proxy_of_a_jupyter_server_sends(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    server = _servers()
    monkeypatch.setenv("DEODAR_STATE", str(tmp_path / "state"))
    monkeypatch.setenv("DEODAR_TOKEN", server["environment"]["DEODAR_TOKEN"])

    def status(address: str, headers: dict[str, str]) -> int:
        request = urllib.request.Request(f"{address}/examples/selection.png", headers=headers)
        try:
            with urllib.request.urlopen(request, timeout=60) as answer:
                return answer.status
        except urllib.error.HTTPError as error:
            return error.code

    with studio(tmp_path) as address:
        port = urlsplit(address).port
        sent = {k: v.format(port=port) for k, v in server["request_headers_override"].items()}
        base = f"http://127.0.0.1:{port}"
        assert status(base, sent) == 200
        assert status(base, sent | {"Cookie": ""}) == 401
        assert status(base, sent | {"Host": "hub.example"}) == 403
    assert server["command"] == ["deodar", "studio", "--no-browser", "--port", "{port}"]


def test_the_hub_leads_to_the_studio_and_its_servers_to_their_configuration() -> None:
    config = SimpleNamespace(Spawner=SimpleNamespace())
    path = ROOT / "deploy" / "jupyterhub" / "jupyterhub_config.py"
    exec(path.read_text(encoding="utf-8"), {"get_config": lambda: config, "__file__": str(path)})
    assert config.Spawner.default_url == "/deodar/"
    folder = Path(config.Spawner.environment["JUPYTER_CONFIG_PATH"])
    assert (folder / "jupyter_server_config.py").is_file()


def test_files_that_the_recipes_name_exist() -> None:
    post_build = (ROOT / ".binder" / "postBuild").read_text(encoding="utf-8")
    [copied] = re.findall(r"^cp (\S+) ", post_build, re.MULTILINE)
    assert (ROOT / copied).is_file()
    container = json.loads((ROOT / ".devcontainer" / "devcontainer.json").read_text(encoding="utf-8"))
    target = container["postCreateCommand"].removeprefix("make ")
    assert f"\n{target}: " in (ROOT / "Makefile").read_text(encoding="utf-8")
    image = (ROOT / "deploy" / "Dockerfile").read_text(encoding="utf-8")
    assert image.count("FROM ") == 2 and re.search(r"^USER [1-9]\d*$", image, re.MULTILINE)
