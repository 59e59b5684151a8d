"""The state of a run (one model or a batch of copies) as a file, from which another process continues."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from deodar.errors import NotFinite, RecordError
from deodar.recording import stored
from deodar.session import world_file
from deodar.session.run import Run

KIND = "state of a run"

StoredState = tuple[dict[str, Any], list[np.ndarray]]
"""A stored state: its text and its arrays."""


def taken(run: Run, about: Mapping[str, Any]) -> StoredState:
    """Return the state of a run: elements, learned weights, clock, world, copies that diverged.

    The noise follows from seed and tick. `about` is what the reader needs besides.

    Raises:
        RecordError: the world keeps something that a file cannot hold.
    """
    own = stored.leaves(run.state, "the model")
    world, theirs = world_file.to_file(run.exchange.keep())
    lost = [[list(copy), error.problems[0].what, error.step] for copy, error in run.lost.items()]
    text = {"clock": dc.asdict(run.clock), "leaves": len(own), "world": world, "lost": lost}
    return {**about, "run": text}, [*own, *theirs]


def write(state: StoredState, path: Path) -> None:
    """Write what `taken` returned.

    Raises:
        OutputError: the system refused.
    """
    stored.write(path, state[0], state[1], KIND)


def read(path: Path) -> StoredState:
    """Return what `write` wrote: its text and arrays, for `put`.

    Raises:
        RecordError: there is none, or it is damaged.
    """
    return stored.read(path, KIND)


def put(run: Run, about: Mapping[str, Any], arrays: list[np.ndarray]) -> None:
    """Set a run, just begun, to a state that `read` returned.

    Raises:
        RecordError: the state is of another model or world.
    """
    text = about["run"]
    own, rest = arrays[: text["leaves"]], arrays[text["leaves"] :]
    run.state = stored.filled(run.state, own, "the model")
    run.clock = dc.replace(run.clock, **text["clock"])
    run.lost = {tuple(copy): NotFinite(what, [], step=step) for copy, what, step in text["lost"]}
    run.forget()
    here = run.exchange.world
    if (text["world"] is None) != (here is None):
        raise RecordError("the stored state is of a run in another world")
    kept = world_file.from_file(text["world"], rest)
    if kept is not None and not isinstance(here, kept.kind):
        raise RecordError(f"the stored state is of a run in the world {kept.kind.__name__}")
    run.exchange.put(kept)
