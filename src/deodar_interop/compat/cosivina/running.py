"""A simulation in progress: the translated file, and the session that runs it.

A session shows the outputs of couplings for the present state. cosivina shows what it computed in the last
step, where some elements read the state before the step and others the state after it. A second session
repeats the last step, with a register behind every such output.
"""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Mapping

import numpy as np

from deodar.couplings.delays import Delay
from deodar.errors import UnknownName, did_you_mean
from deodar.importers.report import ImportReport
from deodar.model import edit
from deodar.model.document import Document
from deodar.model.model import Model
from deodar.model.paths import display
from deodar.session.session import Session
from deodar.session.session_snapshot import SessionSnapshot
from deodar_interop.exporters.cosivina.layout import size
from deodar_interop.importers._foreign import FreeNames
from deodar_interop.importers._piece import Outlet, axes
from deodar_interop.importers.cosivina import file
from deodar_interop.importers.cosivina.translate import Translation


class Running:
    """The session of a simulator, and where its components are.

    Args:
        content: the content of the simulator's file.
        seed: seed of the noise.
    """

    def __init__(self, content: bytes, seed: int) -> None:
        self._translate(content)
        self._seed = seed
        self._session: Session | None = None
        self._before: SessionSnapshot | None = None
        self._last: Session | None = None
        self._repeated: SessionSnapshot | None = None
        self._registers: dict[tuple[str, str], str] = {}

    def _translate(self, content: bytes) -> None:
        """Take over the model of a file, and where the components of its elements are."""
        simulator = file.parse(content)
        translation = Translation(simulator, False)
        doc = translation.document("simulator")
        imported = translation.imported(doc, "simulator.json", simulator.step, simulator.start)
        self._content = content
        self.report: ImportReport = imported.report
        self._model: Model = imported.model
        self._outlets = {label: dict(piece.outlets) for label, piece in translation.pieces.items()}

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
        self._translate(content)
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
        if self._repeated is not self._before:
            self._repeat(self._before)
        assert self._last is not None
        return self._last.read(display((self._registers[outlet.name, outlet.port],))).reshape(shape).copy()

    def _repeat(self, before: SessionSnapshot) -> None:
        """Repeat the last step in a model with registers."""
        document, self._registers = _registered(before.document, self._outlets)
        if self._last is None:
            self._last = Session(Model(document=document), seed=self._seed, precision="float64")
        self._last.restore(dc.replace(before, document=document))
        self._last.step(1)
        self._repeated = before


def _registered(
    document: Document, outlets: Mapping[str, Mapping[str, Outlet]]
) -> tuple[Document, dict[tuple[str, str], str]]:
    """Return a document with a register behind every output of a coupling, and the names of the registers."""
    names = FreeNames(e.path for e in document.entries)
    wanted = {
        (o.name, o.port): o for found in outlets.values() for o in found.values() if not (o.state or o.still)
    }
    registers = {key: names.new(f"last {' '.join(key)}") for key in wanted}
    delays = [Delay(axes(o.dims), name=registers[key]) for key, o in wanted.items()]
    document, added = edit.add_all(document, [(delay, (), 1) for delay in delays])
    by = document.by_names()
    for (name, port), entry in zip(wanted, added, strict=True):
        document = edit.connect(document, by[name,], port, entry, "input", "")
    return document, registers
