"""Requests about the open experiment."""

from __future__ import annotations

import functools
from typing import Annotated, Any

import msgspec

from deodar.cluster import Cluster
from deodar_studio.messages.to_page import Answer
from deodar_studio.pages.hub import Hub
from deodar_studio.pages.page import Page
from deodar_studio.requests.request import Count, Text, answer, asks, changes, opens, repeats


@changes()
async def new_experiment(hub: Hub, page: Page, *, discard_experiment: bool = False) -> None:
    """Open a new experiment whose model is the open document.

    `discard_experiment` allows unsaved edits of the open experiment to be lost.
    """
    await hub.experiment.new(discard_experiment)
    await hub.experiment.check()


@opens(tag="open_experiment")
async def open_experiment_file(
    hub: Hub, page: Page, *, path: Text, discard: bool = False, discard_experiment: bool = False
) -> None:
    """Open an experiment below the root, and its model.

    `discard` allows unsaved edits of the document to be lost, `discard_experiment` those of the experiment.
    """
    await hub.experiment.open(hub.workspace.inside(path), discard, discard_experiment)
    await hub.experiment.check()


@changes()
async def edit_experiment(hub: Hub, page: Page, *, data: dict[str, Any], version: Count) -> None:
    """Replace the plain data of the experiment of that version."""
    hub.experiment.edit(data, version)
    await hub.experiment.check()


@changes()
async def undo_experiment(hub: Hub, page: Page) -> None:
    """Undo the last edit of the experiment."""
    hub.experiment.undo()
    await hub.experiment.check()


@changes()
async def redo_experiment(hub: Hub, page: Page) -> None:
    """Redo the edit of the experiment that was undone last."""
    hub.experiment.redo()
    await hub.experiment.check()


@changes()
async def save_experiment(hub: Hub, page: Page, *, path: Text = "", replace: bool = False) -> Answer:
    """Write the experiment to `path`, or to its own file if `path` is empty.

    A model without a file is written beside it. `replace` allows another file to be overwritten.
    """
    return answer(file=hub.workspace.shown(await hub.experiment.save(path, replace)))


@changes()
async def close_experiment(hub: Hub, page: Page, *, discard_experiment: bool = False) -> None:
    """Close the experiment. `discard_experiment` allows its unsaved edits to be lost."""
    await hub.experiment.close(discard_experiment)


@changes()
async def run_experiment(
    hub: Hub,
    page: Page,
    *,
    workers: Count = 0,
    cluster: Text = "",
    patience: Annotated[float, msgspec.Meta(gt=0, le=1e7)] = 60.0,
    trust_network: bool = False,
    mixed: bool = False,
) -> None:
    """Run the experiment in worker processes, or on a cluster; a run that was stopped continues.

    `workers` is the number of processes on this machine; 0: the usual one. `cluster` is an address as on the
    command line, such as `local:4` or `tcp://HOST:8786`; empty: none. `patience` is the time in s without any
    worker after which the run ends, `trust_network` allows a scheduler beyond this machine without
    encryption, and `mixed` workers whose processors differ.
    """
    at = functools.partial(Cluster, trust_network=trust_network, mixed=mixed, patience=patience)
    await hub.experiment.start(workers, cluster.strip(), at)


@asks()
async def stop_experiment(hub: Hub, page: Page) -> None:
    """Stop the run of the experiment; its rows are kept."""
    hub.experiment.stop()


@repeats()
async def repeat_trial(hub: Hub, page: Page, *, trial: Count) -> None:
    """Run a trial of the experiment again, and open its record; the document with its edits is set aside."""
    await hub.experiment.repeat(trial)


@changes()
async def leave_trial(hub: Hub, page: Page) -> None:
    """Open the document that was set aside for the record of a trial, with its edits."""
    await hub.experiment.leave_trial()
