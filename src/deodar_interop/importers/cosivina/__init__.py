"""cosivina, the MATLAB toolbox and its Python port: JSON files of simulators, parameters and presets, and
scripts that build a simulator and its window.
"""

from __future__ import annotations

import re

from deodar.importers._beside import Beside, nothing
from deodar.importers.imported import Imported
from deodar_interop.importers.cosivina import translate
from deodar_interop.importers.cosivina.launchers.launcher import is_launcher, read_launcher

NAME = "cosivina"
ENDINGS = (".m",)

KEYS = re.compile(rb'"(?:simulator|elementLabels)"\s*:')
"""Keys that no other tool writes; as a value, another tool may have the same words."""


def sniff(head: bytes) -> bool:
    """Return whether a file begins like one of cosivina: an object with a `simulator`, or with its lists, or
    a script that builds a simulator.
    """
    text = head.replace(b"\0", b"")  # two bytes a character
    return b'"deodar"' not in text[:1000] and (KEYS.search(text) is not None or is_launcher(text))


def read(content: bytes, name: str, bugs: bool = False, beside: Beside = nothing) -> Imported:
    """Return the model that the content of a file describes, and the report.

    Args:
        content: the content of a parameter file or of a launcher.
        name: name of the file, for the model's name and the report.
        bugs: whether to reproduce known errors of cosivina instead of correcting them.
        beside: reads parameter files and scripts that a launcher names.
    """
    if is_launcher(content):
        return read_launcher(content, name, bugs, beside)
    return translate.read(content, name, bugs)


__all__ = ["NAME", "read", "sniff"]
