"""What hatchling calls before it makes a wheel, an sdist or an editable installation: the page of the studio
is built first.
"""

from __future__ import annotations

import importlib.util
import os
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface


def _page() -> ModuleType:
    """build.py beside this file. Not by its name: that belongs to a tool that may be running."""
    spec = importlib.util.spec_from_file_location("deodar_page", Path(__file__).with_name("build.py"))
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module  # where its dataclasses look
    spec.loader.exec_module(module)
    return module


class PageHook(BuildHookInterface[Any]):
    """Builds the page, unless it is there already or DEODAR_NO_PAGE is set."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Called before each build."""
        if os.environ.get("DEODAR_NO_PAGE"):
            self.app.display_warning("DEODAR_NO_PAGE is set: the page of the studio is left out.")
            return
        page = _page()
        try:
            page.build()
        except page.PageError as error:
            self.app.abort(f"The page of the studio could not be built. {error}")
