"""The state of a run (one model or a batch of copies) as a file, from which another process continues."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from deodar.errors import NotFinite, RecordError
from deodar.recording import stored
from deodar.session.exchange import WorldState
from deodar.session.run import Run

KIND = "state of a run"


def save(run: Run, path: Path, about: Mapping[str, Any]) -> None:
    """Write the state of a run: elements, learned weights, clock, world, copies that diverged.

    The noise follows from seed and tick. `about` is what the reader needs besides.

    Raises:
        RecordError: the world keeps something that a file cannot hold.
        OutputError: the system refused.
    """
    own = stored.leaves(run.state, "the model")
    kept = run.exchange.keep()
    world: dict[str, Any] | None = None
    arrays = list(own)
    if kept is not None:
        theirs = stored.leaves(kept.world, f"the world {kept.kind.__name__}")
        commands = dict(kept.commands or {})
        world = {
            "kind": kept.kind.__name__,
            "leaves": len(theirs),
            "commands": None if kept.commands is None else list(commands),
        }
        world |= {"last": kept.last, "due": kept.due, "origin": kept.origin}
        arrays += [*theirs, *map(np.asarray, commands.values())]
    lost = [[list(copy), error.problems[0].what, error.step] for copy, error in run.lost.items()]
    text = {"clock": dc.asdict(run.clock), "leaves": len(own), "world": world, "lost": lost}
    stored.write(path, {**about, "run": text}, arrays, KIND)


def read(path: Path) -> tuple[dict[str, Any], list[np.ndarray]]:
    """Return what `save` wrote: its text and arrays, for `put`.

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
    world, here = text["world"], run.exchange.keep()
    if (world is None) != (here is None) or (here is not None and world["kind"] != here.kind.__name__):
        raise RecordError("the stored state is of a run in another world")
    if here is not None:
        theirs, commands = rest[: world["leaves"]], rest[world["leaves"] :]
        names = world["commands"]
        run.exchange.put(
            WorldState(
                here.kind,
                stored.filled(here.world, theirs, f"the world {world['kind']}"),
                world["last"],
                world["due"],
                world["origin"],
                None if names is None else dict(zip(names, commands, strict=True)),
            )
        )
