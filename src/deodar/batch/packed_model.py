"""A model and its world as plain data, for another process.

A worker imports only deodar, so classes that the calling script defines must be importable.
"""

from __future__ import annotations

import dataclasses as dc
import functools
import pickle
from collections.abc import Sequence
from typing import Any

from deodar import codec
from deodar.errors import WorkerError
from deodar.model import document_files
from deodar.model.model import Model
from deodar.model.parts import foreign_kinds
from deodar.worlds._base import World


@dc.dataclass(frozen=True)
class PackedModel:
    """A packed model and its world.

    Attributes:
        document: the model's document as JSON text; `arrays` is the content of its array file.
        trusted: whether functions that the document names may be run.
        kinds: the classes outside deodar that the document names, pickled: reading them imports and registers
            them.
        packed: the world, pickled.
    """

    document: str
    arrays: bytes
    trusted: bool
    kinds: bytes
    packed: bytes

    @classmethod
    def of(cls, model: Model, world: World | None) -> PackedModel:
        """Pack a model and its world.

        Raises:
            WorkerError: a part of them cannot be sent to another process.
        """
        plain, arrays = document_files.to_data(model.document)
        outside = foreign_kinds(plain)
        _require_module([*outside, *([type(world)] if world is not None else [])])
        packed_arrays = document_files.pack(arrays) if arrays else b""
        return cls(
            codec.line(plain),
            packed_arrays,
            model.trusted,
            _pickled(outside, "an element"),
            _pickled(world, f"the world {type(world).__name__}"),
        )

    @property
    def model(self) -> Model:
        """Return the model; later pieces of the same run use its compiled programs."""
        return _model(self.document, self.arrays, self.trusted, self.kinds)

    def world(self) -> World | None:
        """Return a new copy of the world at each call."""
        return pickle.loads(self.packed)


def require_portable(world: World | None) -> None:
    """Raise an error if a world cannot be computed on another machine.

    Raises:
        WorkerError: it follows the wall clock, such as a camera or a robot.
    """
    if world is not None and world.wall_clock:
        raise WorkerError(
            f"the world {type(world).__name__} is bound to this machine and its clock, so that no cluster can"
            " compute it",
            fix="Run without a cluster",
        )


@functools.lru_cache(maxsize=1)
def _model(document: str, arrays: bytes, trusted: bool, kinds: bytes) -> Model:
    pickle.loads(kinds)
    unpacked = document_files.unpack(arrays, "the document") if arrays else {}
    return Model(document=document_files.from_data(codec.parse(document), unpacked), trusted=trusted)


def _require_module(classes: Sequence[type]) -> None:
    of_script = [cls.__name__ for cls in classes if cls.__module__ == "__main__"]
    if of_script:
        raise WorkerError(
            f"{', '.join(of_script)} is written in the script itself, which worker processes do not run",
            fix="Put it into a module of its own and import it, or run without workers",
        )


def _pickled(part: Any, name: str) -> bytes:
    try:
        return pickle.dumps(part)
    except Exception as error:  # a class may raise any exception
        raise WorkerError(
            f"{name} cannot be sent to other processes ({type(error).__name__}: {error})",
            fix="Run without workers",
        ) from None
