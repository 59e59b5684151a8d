"""The engine as it would be installed without the packages beside it."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

from tests.house.source import ROOT

sys.path.insert(0, str(ROOT / "tools"))
import engine_alone
import packages

CODE = """
import importlib.util, deodar as dd
from deodar import cli, registry
from deodar.exporters.tools import EXPORTERS
print(dd.__file__)
print([name for name in {beside} if importlib.util.find_spec(name)])
print(list(EXPORTERS), [name for name in dd.__all__ if not hasattr(dd, name)])
print("Field" in registry.kinds(), "MuJoCo" in registry.kinds(), "studio" in cli.COMMANDS)
"""


def test_packages_beside_the_engine_and_their_entry_points_are_hidden(tmp_path: Path) -> None:
    place = engine_alone.install(tmp_path / "engine")
    beside = [name for name in packages.packages() if name != "deodar"]
    code = CODE.replace("{beside}", repr(beside))
    done = subprocess.run(
        [sys.executable, "-c", code],
        env=engine_alone.environment(place),
        capture_output=True,
        text=True,
        check=True,
    )
    file, *rest = done.stdout.splitlines()
    assert Path(file).parent == place / "deodar"
    assert rest == ["[]", "[] []", "True False False"]
