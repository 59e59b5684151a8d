"""The folders of the server import one way, in the order of the docstring of the package."""

from __future__ import annotations

import re
from collections import defaultdict

import deodar_studio
from tests.house.source import MODULES, imported, module

FOLDERS = re.findall(r"`(\w+)`", deodar_studio.__doc__ or "")


def test_the_docstring_names_every_folder() -> None:
    parts = [module(path).split(".") for path in MODULES]
    assert sorted(FOLDERS) == sorted({p[1] for p in parts if p[0] == "deodar_studio" and len(p) > 2})


def test_a_folder_imports_only_those_before_it() -> None:
    wrong: list[str] = []
    for path in MODULES:
        name = module(path)
        if not name.startswith("deodar_studio.") or name.count(".") < 2:
            continue
        own = FOLDERS.index(name.split(".")[1])
        for line, other in imported(path):
            room, _, rest = other.partition(".")
            if room == "deodar_studio" and (not rest or FOLDERS.index(rest.split(".")[0]) > own):
                wrong.append(f"{name}:{line} imports {other}")
    assert not wrong, wrong


def test_no_two_folders_have_a_module_of_one_name() -> None:
    places: defaultdict[str, list[str]] = defaultdict(list)
    for path in MODULES:
        if module(path).startswith("deodar_studio.") and path.name != "__init__.py":
            places[path.stem].append(module(path))
    assert [names for names in places.values() if len(names) > 1] == []
