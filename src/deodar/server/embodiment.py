"""The world that the sensors of the open document read and its motors move."""

from __future__ import annotations

import base64
import binascii
import tempfile
from pathlib import Path

from deodar import registry
from deodar.elements.motor import Motor
from deodar.elements.sensor import Sensor
from deodar.errors import WorldError, did_you_mean
from deodar.model.document import Document
from deodar.recording.opened import opened
from deodar.recording.provenance import described
from deodar.worlds._base import World
from deodar.worlds._failure import errors_of

MOST_BYTES = 32 * 2**20


class Embodiment:
    """The world that the user chose, or an example.

    An example is used if no world was chosen, or the chosen one lacks a sensor or motor of the document; it
    is of a kind that has all of them.

    Attributes:
        label: a phrase for the world in use.
    """

    def __init__(self, chosen: World | None = None) -> None:
        self.chosen = chosen
        self.label = ""
        self._name = (
            ""
            if chosen is None
            else _named(type(chosen).__name__, str((described(chosen) or {}).get("file", "")))
        )

    def world(self, doc: Document) -> World | None:
        """Return the world for a document.

        Return None if the document has no sensors and motors, or if no world was chosen and no example fits;
        a run then raises the error.
        """
        wanted = signals(doc)
        self.label = ""
        if not wanted:
            return None
        if self.chosen is None or not wanted <= {*self.chosen.sensors, *self.chosen.motors}:
            fitting = [
                cls
                for cls in registry.kinds("worlds").values()
                if cls.stands_in and wanted <= {*cls.sensors, *cls.motors}
            ]
            if fitting:
                self.label = _named(fitting[0].__name__, "an example")
                with errors_of(fitting[0], "example"):
                    return fitting[0].example()
        self.label = self._name
        return self.chosen

    def open(self, kind: str, path: Path, name: str) -> World:
        """Choose a world of a kind, made from a file; `name` is the name that messages show."""
        kinds = registry.kinds("worlds")
        if kind not in kinds:
            raise WorldError(f"there is no world {kind!r}", fix=did_you_mean(kind, kinds))
        try:
            self.chosen = opened(kinds[kind], str(path))
        except WorldError as error:
            raise WorldError(
                error.problems[0].what, where=name, fix=error.problems[0].fix
            ) from error.__cause__
        self.label = self._name = _named(kind, name)
        return self.chosen

    def open_content(self, kind: str, name: str, content: str) -> World:
        """Choose a world of a kind, made from the content (base64) of the file `name`."""
        try:
            data = base64.b64decode(content, validate=True)
        except (binascii.Error, ValueError):
            raise WorldError("the content is not base64", where=name) from None
        if len(data) > MOST_BYTES:
            raise WorldError(f"is larger than {MOST_BYTES // 2**20} MiB", where=name)
        with tempfile.TemporaryDirectory(prefix="deodar-") as folder:
            path = Path(folder) / f"dropped{Path(name).suffix}"
            path.write_bytes(data)
            return self.open(kind, path, name)


def signals(doc: Document) -> set[str]:
    """Return the names of the sensors that a document reads and of the motors that it drives."""
    sensors = {e.element.sensor for e in doc.entries if isinstance(e.element, Sensor)}
    return sensors | {e.element.motor for e in doc.entries if isinstance(e.element, Motor)}


def _named(kind: str, name: str) -> str:
    return f"{kind}: {name}" if name else kind
