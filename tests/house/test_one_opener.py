"""One module opens files for reading by their names."""

from __future__ import annotations

import re
from pathlib import Path

from deodar import regular_file

SRC = Path(regular_file.__file__).parents[1]

OPENS = re.compile(r"\.read_bytes\(\)|\.read_text\(|open\([^()]*\"rb\"|\.open\(\"rb\"\)")
"""Calls that open a file for reading."""

OWN = {
    "deodar/worlds/arena/arena_layout.py": "the layouts of deodar itself, resources of the package",
    "deodar_papers/saliency/scenes.py": "the same",
    "deodar_papers/spa/pairs.py": "the same",
    "deodar/private_file.py": "opened by its descriptor, with its owner",
    "deodar_studio/files/open_folder.py": "opened in its folder, by its descriptor",
}
"""Modules that open files for reading, and why they may."""


def test_no_module_opens_files_in_another_way() -> None:
    places = {
        path.relative_to(SRC).as_posix()
        for package in SRC.glob("deodar*")
        for path in package.rglob("*.py")
        if path.name != "regular_file.py"
        and OPENS.search(path.read_text(encoding="utf-8").replace("regular_file.read_text(", ""))
    }
    assert places == OWN.keys()
