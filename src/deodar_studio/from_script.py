"""The studio, opened by a script or a notebook on a model."""

from __future__ import annotations

import atexit
import contextlib
import html
import shutil
import subprocess
import sys
import tempfile
import threading
from pathlib import Path

from deodar import regular_file
from deodar.errors import OutputError, ParameterError, show
from deodar.importers.opening import load, require
from deodar.model.model import Model, save
from deodar.recording.places import free
from deodar.summary import Summarised, Summary

SAID = "deodar studio: http"
"""The begin of the line in which a studio prints its address."""

START = 120.0
"""Longest time in which a studio starts, in s (a guess: the first start compiles the sources)."""

END = 10.0
"""Time in which a studio ends, in s; then it is killed."""


class OpenedStudio(Summarised):
    """A studio in a process of its own, which `dd.studio` has started; it ends with this process.

    Attributes:
        path: the document that the studio has opened, and saves to.
    """

    def __init__(self, path: Path, command: list[str], folder: Path | None) -> None:
        self.path, self._folder = path, folder
        self._before = regular_file.read_bytes(path) if folder is not None else b""
        self._lines: list[str] = []
        self._ready = threading.Event()
        self._process = subprocess.Popen(
            command,
            cwd=path.parent,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
        )
        self._listener = threading.Thread(target=self._listen, daemon=True)
        self._listener.start()
        atexit.register(self.stop)

    @property
    def address(self) -> str:
        """The address of the studio, with its token; this waits until the studio has started.

        Raises:
            OutputError: the studio has ended.
        """
        self._ready.wait(START)
        address = next((line.split(": ", 1)[1] for line in self._lines if line.startswith(SAID)), "")
        if not address or not self.runs:
            why = f": {self._lines[-1]}" if self._lines else ""
            raise OutputError(f"the studio has ended{why}", fix="Open it again: dd.studio(model)")
        return address

    @property
    def runs(self) -> bool:
        """Whether the studio is running."""
        return self._process.poll() is None

    @property
    def model(self) -> Model:
        """The model as the studio has saved it last."""
        return load(self.path)

    def stop(self) -> None:
        """End the studio. A document that it has saved to is kept, at `path`."""
        if self.runs:
            self._process.terminate()
            try:
                self._process.wait(END)
            except subprocess.TimeoutExpired:
                self._process.kill()
                self._process.wait()
        self._listener.join()
        atexit.unregister(self.stop)
        with contextlib.suppress(OSError):
            if self._folder is not None and regular_file.read_bytes(self.path) == self._before:
                shutil.rmtree(self._folder)

    def wait(self) -> None:
        """Wait until the studio is ended, for example by Ctrl-C: a script ends, and its studio with it."""
        with contextlib.suppress(KeyboardInterrupt):
            self._process.wait()
        self.stop()

    def __enter__(self) -> OpenedStudio:
        return self

    def __exit__(self, *_: object) -> None:
        self.stop()

    def _listen(self) -> None:
        assert self._process.stdout is not None
        with self._process.stdout as lines:
            for line in lines:
                self._lines.append(line.rstrip())
                if line.startswith(SAID):
                    self._ready.set()
        self._ready.set()

    def _summary(self) -> Summary:
        if not self.runs:
            return Summary(f"Studio of {self.path.name}, ended", [(line,) for line in self._lines[:3]])
        return Summary(f"Studio of {self.path.name}", [("address", self.address)])

    def _repr_html_(self) -> str:
        if not self.runs:
            return self._summary().html()
        address = html.escape(self.address)
        link = f'<div><a href="{address}" target="_blank" rel="noopener">Open the studio</a></div>'
        return Summary(f"Studio of {self.path.name}").html(link)


def studio(model: Model | str | Path, browser: bool | None = None, port: int | None = None) -> OpenedStudio:
    """Open the studio on a model, in a process of its own, and return at once.

    A model is saved to a temporary folder, where the studio saves it again; `opened.model` is then the model
    with its changes. A document is opened and saved at its place. The studio listens on this machine only.

    Args:
        model: the model, or the path of a document or record.
        browser: whether a browser is opened; None: in a script, while a notebook shows a link.
        port: the port; None: the first free one from 8430 on.

    Returns:
        The opened studio: its `address`, `stop()`, and for scripts `wait()`.

    Raises:
        ParameterError: `model` is something else, or the port is none.
        DocumentError: there is no such file.
    """
    if port is not None and not (type(port) is int and 0 <= port <= 65535):
        raise ParameterError(f"port is {show(port)}; expected a number from 0 to 65535")
    folder: Path | None = None
    trusted = False
    if isinstance(model, Model):
        folder = Path(tempfile.mkdtemp(prefix="deodar-studio-"))
        path = free(folder, model.name, ".json")
        save(model, path)
        trusted = model.trusted
    elif isinstance(model, str | Path):
        path = require(model).resolve()
    else:
        raise ParameterError(f"expected a model or the path of a document, got {show(model)}")
    in_notebook = type(sys.stdout).__module__.startswith("ipykernel")
    opens = not in_notebook if browser is None else browser
    options = ["--trust"] * trusted + ["--no-browser"] * (not opens)
    options += [] if port is None else ["--port", str(port)]
    command = [sys.executable, "-m", "deodar", "studio", str(path), *options]
    return OpenedStudio(path, command, folder)
