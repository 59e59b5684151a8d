"""The state of a run (one model or a batch of copies) as a file, from which another process continues."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from deodar import codec, registry
from deodar.errors import NotFinite, RecordError
from deodar.recording import stored
from deodar.session.exchange import StoredLeaves, WorldState
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
    model_leaves = stored.leaves(run.state, "the model")
    world, world_leaves = world_to_file(run.exchange.keep())
    lost = [[list(copy), error.problems[0].what, error.step] for copy, error in run.lost.items()]
    text = {"clock": dc.asdict(run.clock), "leaves": len(model_leaves), "world": world, "lost": lost}
    return {**about, "run": text}, [*model_leaves, *world_leaves]


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
    model_leaves, world_leaves = arrays[: text["leaves"]], arrays[text["leaves"] :]
    run.state = stored.filled(run.state, model_leaves, "the model")
    run.clock = dc.replace(run.clock, **text["clock"])
    run.lost = {tuple(copy): NotFinite(problem, [], step=step) for copy, problem, step in text["lost"]}
    run.forget()
    world = run.exchange.world
    if (text["world"] is None) != (world is None):
        raise RecordError("the stored state is of a run in another world")
    world_state = world_from_file(text["world"], world_leaves)
    if world_state is not None and not isinstance(world, world_state.kind):
        raise RecordError(f"the stored state is of a run in the world {world_state.kind.__name__}")
    run.exchange.put(world_state)


def world_to_file(state: WorldState | None) -> tuple[dict[str, Any] | None, list[np.ndarray]]:
    """Return the state of a world as text and arrays.

    Raises:
        RecordError: the world keeps something that a file cannot hold.
    """
    if state is None:
        return None, []
    if isinstance(state.world, StoredLeaves):
        leaves = list(state.world.leaves)
    else:
        leaves = stored.leaves(state.world, f"the world {state.kind.__name__}")
    commands = dict(state.commands or {})
    text = {
        "kind": state.kind.__name__,
        "leaves": len(leaves),
        "commands": None if state.commands is None else list(commands),
        "last": state.last,
        "due": state.due,
        "origin": state.origin,
    }
    if state.objects is not None:
        try:
            text["objects"] = codec.parse(codec.line(state.objects))
        except (TypeError, ValueError):
            raise RecordError(
                f"the objects of the world {state.kind.__name__} are not plain data, which a file cannot"
                " hold",
                fix="Let its `arrangement` return numbers, text, lists and dictionaries",
            ) from None
    return text, [*leaves, *map(np.asarray, commands.values())]


def world_from_file(text: dict[str, Any] | None, arrays: list[np.ndarray]) -> WorldState | None:
    """Return the state of a world from what `world_to_file` returned.

    Raises:
        RecordError: a world of this kind is not known.
    """
    if text is None:
        return None
    kind = registry.kinds("worlds").get(text["kind"])
    if kind is None:
        raise RecordError(f"was taken in a world of the kind {text['kind']}, which is not known here")
    leaves, commands, names = arrays[: text["leaves"]], arrays[text["leaves"] :], text["commands"]
    command_of = None if names is None else dict(zip(names, commands, strict=True))
    times = text["last"], text["due"], text["origin"]
    return WorldState(kind, StoredLeaves(leaves), *times, command_of, text.get("objects"))
