"""Storage of unsaved edits and of recent files between runs of the studio, in the user's state folder."""

from __future__ import annotations

import contextlib
import dataclasses as dc
import datetime
import os
import re
import secrets
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, cast

import platformdirs
import psutil

from deodar import codec, file_version, regular_file
from deodar.codec import JsonObject
from deodar.errors import DeodarError, DocumentError, OutputError, UnknownName, reading
from deodar.experiments.experiment_migrations import VERSION, migrate
from deodar.model import document_files, output, partial
from deodar.model.document import Document
from deodar_studio.messages.to_page import Recovery

MOST_RECENT = 12
UNSTATED = 3
"""Version of stored experiments that state none."""

NAME = re.compile(r"^[0-9a-f]{16}$")


def state_folder() -> Path:
    """Return the state folder: DEODAR_STATE, else the folder of the system for state files."""
    given = os.environ.get("DEODAR_STATE")
    if given:
        return Path(given)

    return Path(platformdirs.user_state_dir("deodar")) / "studio"


@dataclass(frozen=True)
class StoredExperiment:
    """Unsaved edits of an experiment: its plain data without its model, and its file (empty: none)."""

    data: JsonObject
    file: str


class StateStore:
    """Stores unsaved edits and recent files. Errors of writing are ignored."""

    def __init__(self, folder: Path) -> None:
        self._unsaved = folder / "unsaved"
        self._recent = folder / "recent.json"
        self._times = folder / "compile_times.json"

    # ------------------------------------------------------------------------------------------ unsaved edits

    def new_name(self) -> str:
        """Return a new name for the edits of one document."""
        return secrets.token_hex(8)

    def store_edits(
        self, name: str, document: Document, file: str, experiment: StoredExperiment | None = None
    ) -> None:
        """Store the edited document of a file, or an edited experiment with its model."""
        with contextlib.suppress(OSError, DeodarError):
            self._unsaved.mkdir(parents=True, exist_ok=True)
            # each studio has new names, so that no later save takes these over
            for path in [*partial.abandoned(self._unsaved), *document_files.left_arrays(self._unsaved)]:
                path.unlink()
            document_files.save(document, self._document(name), force=True)
            now = datetime.datetime.now().astimezone().isoformat(timespec="seconds")
            note: dict[str, Any] = {
                "title": document.name,
                "file": file,
                "when": now,
                "process": [os.getpid(), psutil.Process().create_time()],
            }
            if experiment is not None:
                stated = {"version": VERSION, file_version.KEY: file_version.HERE}
                note["experiment"] = {**stated, "data": experiment.data, "file": experiment.file}
            output.write(self._note(name), codec.line(note, ascii=True).encode())

    def forget(self, name: str) -> None:
        """Delete stored edits."""
        self._require(name)
        with contextlib.suppress(OSError):
            for path in self._unsaved.glob(f"{name}.*"):
                path.unlink(missing_ok=True)

    def stored_edits(self) -> list[Recovery]:
        """Return stored edits that no running studio has open, newest first."""
        out: list[Recovery] = []
        for path in self._unsaved.glob("*.note"):
            note = _read(path)
            if NAME.match(path.stem) and isinstance(note, dict) and self._document(path.stem).is_file():
                data = cast("dict[str, Any]", note)
                if not _lives(data.get("process")):
                    text = {key: str(data.get(key, "")) for key in ("title", "file", "when")}
                    experiment = _experiment(note)
                    title = "" if experiment is None else str(experiment.data.get("name", ""))
                    out.append(Recovery(name=path.stem, **text, experiment=title))
        return sorted(out, key=lambda r: r.when, reverse=True)

    def read(self, name: str) -> tuple[Document, str]:
        """Return a stored document, and the file it belongs to."""
        self._require(name)
        note: Any = _read(self._note(name))
        return document_files.load(self._document(name)), str(note.get("file", "")) if isinstance(
            note, dict
        ) else ""

    def experiment(self, name: str) -> StoredExperiment | None:
        """Return the experiment that is stored under a name; None: it is a document.

        One of an older version is converted with the stored document of its model, which knows the kinds of
        the elements that paths name. If the document cannot be read, the names of parameters alone decide.

        Raises:
            DocumentError: it is of a later version.
        """
        self._require(name)
        note: Any = _read(self._note(name))
        experiment = _experiment(note)
        if experiment is None:
            return None
        stated = note["experiment"]
        version = stated.get("version", UNSTATED)
        with reading(name, DocumentError):
            file_version.require_readable("an experiment", version, VERSION, stated)
        doc = None
        if version != VERSION:
            with contextlib.suppress(DeodarError):
                doc = document_files.load(self._document(name))
        plain = migrate({**experiment.data, "experiment": version}, doc)
        del plain["experiment"]
        return dc.replace(experiment, data=plain)

    def _require(self, name: str) -> None:
        if not NAME.match(name):
            raise UnknownName(f"no unsaved edits are kept under the name {name!r}")

    def _document(self, name: str) -> Path:
        return self._unsaved / f"{name}.json"

    def _note(self, name: str) -> Path:
        return self._unsaved / f"{name}.note"

    # ------------------------------------------------------------------------------------------- recent files

    def opened(self, path: Path) -> None:
        """Add a file to the recent files."""
        names = [str(path), *(n for n in self._names() if n != str(path))][:MOST_RECENT]
        with contextlib.suppress(OSError, OutputError):
            self._recent.parent.mkdir(parents=True, exist_ok=True)
            output.write(self._recent, codec.line(names, ascii=True).encode())

    def recent(self) -> list[Path]:
        """Return the recent files that still exist, the last one first."""
        return [p for p in map(Path, self._names()) if p.exists()]

    def _names(self) -> list[str]:
        found: Any = _read(self._recent)
        return [n for n in cast("list[Any]", found) if isinstance(n, str)] if isinstance(found, list) else []

    # ------------------------------------------------------------------------------------------ compile times

    def compile_times(self) -> dict[int, float]:
        """Return the seconds that programs took to compile, by the size of their documents."""
        found: Any = _read(self._times)
        rows = cast("dict[Any, Any]", found) if isinstance(found, dict) else {}
        return {
            int(size): float(seconds)
            for size, seconds in rows.items()
            if str(size).isdecimal() and int(size) > 0 and isinstance(seconds, (int, float))
        }

    def store_compile_times(self, times: Mapping[int, float]) -> None:
        """Store what `compile_times` returns."""
        with contextlib.suppress(OSError, OutputError):
            self._times.parent.mkdir(parents=True, exist_ok=True)
            rows = {str(size): seconds for size, seconds in times.items()}
            output.write(self._times, codec.line(rows, ascii=True).encode())


def _read(path: Path) -> Any:
    try:
        return codec.parse(regular_file.read_text(path))
    except (OSError, ValueError):
        return None


def _experiment(note: Any) -> StoredExperiment | None:
    try:
        data, file = note["experiment"]["data"], note["experiment"]["file"]
    except (KeyError, TypeError):
        return None
    return StoredExperiment(data, str(file)) if isinstance(data, dict) else None


def _lives(process: Any) -> bool:
    """Return whether a process (number and time of its start) still runs, and so has the edits open."""
    try:
        number, started = process
        return psutil.Process(number).create_time() == started
    except (psutil.Error, TypeError, ValueError):
        return False
