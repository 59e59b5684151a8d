"""The dynamics of a document: how its programs are made, for one copy or for many."""

from __future__ import annotations

import dataclasses as dc

from deodar.compiler.body import Body
from deodar.compiler.copy_batch import Batch
from deodar.compiler.division import Distribution
from deodar.compiler.executable import Executable, executable
from deodar.model.document import Document
from deodar.model.model import Model

ONE = Batch()
"""One copy without an axis for copies."""


@dc.dataclass(frozen=True)
class Dynamics:
    """The dynamics of a document in a precision, on a device, with a world inside the step or without.

    All runs get their programs here: those of sessions, records, trials and environments.

    Attributes:
        model: the model that keeps the programs.
        doc: its document, or one made from it.
        precision: float32 or float64.
        accuracy: default, or exact: every kernel is applied as a matrix.
        device: the device, or the devices that divide the work; None: the CPU.
        body: the world that is computed inside the step; None: there is none, or it is on the host.
    """

    model: Model
    doc: Document
    precision: str = "float32"
    accuracy: str = "default"
    device: str | Distribution | None = None
    body: Body | None = None

    def compiled(self, copies: Batch = ONE) -> Executable:
        """Return the program of some copies; the model keeps it, so that it compiles once."""
        return executable(self.model, self.doc, self.precision, copies, self.device, self.accuracy, self.body)
