"""A simulation in progress: the translated file, and the session that runs it.

A session shows outputs of couplings for the present state. cosivina shows those that it computed in the last
step, from the states before or after that step; a second session, one step behind, gives them.
"""

from __future__ import annotations

import numpy as np

from deodar.errors import UnknownName, did_you_mean
from deodar.exporters.cosivina.layout import size
from deodar.importers.cosivina import file
from deodar.importers.cosivina.piece import Outlet
from deodar.importers.cosivina.translate import Translation, read
from deodar.importers.report import ImportReport
from deodar.model.model import Model
from deodar.model.paths import display
from deodar.session.session import Session
from deodar.session.snapshot import SessionSnapshot


class Running:
    """The session of a simulator, and where its components are.

    Args:
        content: the content of the simulator's file.
        seed: seed of the noise.
    """

    def __init__(self, content: bytes, seed: int) -> None:
        self._content = content
        done = read(content, "simulator.json")
        self.report: ImportReport = done.report
        self._model: Model = done.model
        self._outlets = _outlets(content)
        self._seed = seed
        self._session: Session | None = None
        self._behind: Session | None = None
        self._before: SessionSnapshot | None = None

    @property
    def session(self) -> Session:
        """The session; it is compiled when it is first used."""
        if self._session is None:
            self._session = Session(self._model, seed=self._seed, precision="float64")
        return self._session

    @property
    def time(self) -> float:
        """The present time."""
        return self.session.time

    def step(self, count: int) -> None:
        """Advance by a number of steps."""
        if count < 1:
            return
        self.session.step(count - 1)
        self._before = self.session.snapshot()
        self.session.step(1)

    def take(self, content: bytes) -> None:
        """Continue with other parameters; elements keep their states."""
        if content == self._content:
            return
        self._content = content
        done = read(content, "simulator.json")
        self.report, self._model = done.report, done.model
        self._outlets = _outlets(content)
        self.session.edit(self._model.document)

    def shown(self, label: str) -> list[str]:
        """Return the names of the components of an element."""
        return list(self._outlets[label])

    def component(self, label: str, name: str) -> np.ndarray:
        """Return the value of a component, with all dimensions that cosivina gives it."""
        outlets = self._outlets[label]
        if name not in outlets:
            raise UnknownName(f"{label!r} has no component {name!r}", fix=did_you_mean(name, list(outlets)))
        outlet = outlets[name]
        shape = size(outlet.dims)
        path = display((outlet.name, outlet.port))
        if outlet.state or outlet.still:
            return self.session.read(path).reshape(shape).copy()
        if self._before is None:
            return np.full(shape, outlet.initial)
        if self._behind is None:
            self._behind = Session(self._model, seed=self._seed, precision="float64")
        if self._behind.tick != self._before.clock.tick or self._behind.document is not self._before.document:
            self._behind.restore(self._before)
        return self._behind.read(path).reshape(shape).copy()


def _outlets(content: bytes) -> dict[str, dict[str, Outlet]]:
    """Return the components of each element that the translation shows."""
    pieces = Translation(file.parse(content), False).pieces
    return {label: dict(piece.outlets) for label, piece in pieces.items()}
