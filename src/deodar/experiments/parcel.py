"""The parcel: an experiment as a worker process gets it, as plain data."""

from __future__ import annotations

import dataclasses as dc
import functools
import json
import pickle
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, cast

from deodar import registry
from deodar.errors import WorkerError
from deodar.experiments.bench import Bench
from deodar.experiments.experiment import Experiment
from deodar.experiments.rows import Row
from deodar.model import files
from deodar.model.model import Model
from deodar.worlds._base import World


@dc.dataclass(frozen=True)
class Parcel:
    """An experiment, its model and its world.

    Attributes:
        experiment: its plain data, as JSON text.
        document: the model's document as JSON text, and its `arrays` as the content of their file.
        trusted: whether functions that the document names may be run.
        kinds: the classes outside deodar that the document names, pickled: reading them imports their modules, which registers them.
        world: the world, pickled.
    """

    experiment: str
    document: str
    arrays: bytes
    trusted: bool
    kinds: bytes
    world: bytes

    @classmethod
    def of(cls, bench: Bench) -> Parcel:
        """A bench, packed.

        Raises:
            WorkerError: something of it cannot be handed to another process.
        """
        data, arrays = files.to_data(bench.model.document)
        own = [kind for kind in map(registry.kind, sorted(set(_kinds(data["elements"])))) if not kind.__module__.startswith("deodar.")]
        here = [kind.__name__ for kind in own if kind.__module__ == "__main__"]
        if here:
            raise WorkerError(f"{', '.join(here)} is written in the script itself, which worker processes do not run", fix="Run without workers")
        packed = files.pack(arrays) if arrays else b""
        world = _pickled(bench.world, f"the world {type(bench.world).__name__}")
        plain = bench.experiment.to_data() | {"model": "as handed over"}
        return cls(json.dumps(plain), json.dumps(data), packed, bench.model.trusted, _pickled(own, "an element"), world)

    def open(self) -> Bench:
        """The bench again."""
        pickle.loads(self.kinds)
        held = files.unpack(self.arrays, "the document") if self.arrays else {}
        model = Model(document=files.from_data(json.loads(self.document), held), trusted=self.trusted)
        found: World | None = pickle.loads(self.world)
        return Bench(Experiment.from_data(json.loads(self.experiment)), model, found)


def work(parcel: Parcel, trials: Sequence[int], records: Path | None) -> list[Row]:
    """The rows of some trials, in a worker."""
    return _opened(parcel).rows(trials, records)


@functools.lru_cache(maxsize=1)  # the next piece of the same experiment finds the compiled programs that a model keeps
def _opened(parcel: Parcel) -> Bench:
    return parcel.open()


def _kinds(data: Any) -> Iterator[str]:
    if isinstance(data, Mapping):
        found = cast("Mapping[str, Any]", data)
        if isinstance(found.get("kind"), str):
            yield found["kind"]
        for value in found.values():
            yield from _kinds(value)
    elif isinstance(data, list):
        for value in cast("list[Any]", data):
            yield from _kinds(value)


def _pickled(what: Any, name: str) -> bytes:
    try:
        return pickle.dumps(what)
    except Exception as error:  # a class may refuse in any way
        raise WorkerError(f"{name} cannot be handed to other processes ({type(error).__name__}: {error})", fix="Run without workers") from None
