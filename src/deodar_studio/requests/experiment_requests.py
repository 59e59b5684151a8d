"""Handlers of requests about the open experiment."""

from __future__ import annotations

from deodar_studio.messages import to_server
from deodar_studio.messages.to_page import Answer
from deodar_studio.pages.hub import Hub
from deodar_studio.pages.page import Page
from deodar_studio.requests.handlers import handles


@handles(to_server.NewExperiment)
async def _new(hub: Hub, page: Page, m: to_server.NewExperiment) -> None:
    await hub.experiment.new(m.discard_experiment)
    await hub.experiment.check()


@handles(to_server.OpenExperimentFile)
async def _open(hub: Hub, page: Page, m: to_server.OpenExperimentFile) -> None:
    await hub.experiment.open(hub.workspace.inside(m.path), m.discard, m.discard_experiment)
    await hub.experiment.check()


@handles(to_server.EditExperiment)
async def _edit(hub: Hub, page: Page, m: to_server.EditExperiment) -> None:
    hub.experiment.edit(m.data, m.version)
    await hub.experiment.check()


@handles(to_server.UndoExperiment)
async def _undo(hub: Hub, page: Page, m: to_server.UndoExperiment) -> None:
    hub.experiment.undo()
    await hub.experiment.check()


@handles(to_server.RedoExperiment)
async def _redo(hub: Hub, page: Page, m: to_server.RedoExperiment) -> None:
    hub.experiment.redo()
    await hub.experiment.check()


@handles(to_server.SaveExperiment)
async def _save(hub: Hub, page: Page, m: to_server.SaveExperiment) -> Answer:
    path = await hub.experiment.save(m.path, m.replace)
    return Answer(request=m.request, file=hub.workspace.shown(path))


@handles(to_server.CloseExperiment)
async def _close(hub: Hub, page: Page, m: to_server.CloseExperiment) -> None:
    await hub.experiment.close(m.discard_experiment)


@handles(to_server.RunExperiment)
async def _run(hub: Hub, page: Page, m: to_server.RunExperiment) -> None:
    await hub.experiment.start(m)


@handles(to_server.StopExperiment)
async def _stop(hub: Hub, page: Page, m: to_server.StopExperiment) -> None:
    hub.experiment.stop()


@handles(to_server.RepeatTrial)
async def _repeat(hub: Hub, page: Page, m: to_server.RepeatTrial) -> None:
    await hub.experiment.repeat(m.trial)


@handles(to_server.LeaveTrial)
async def _leave(hub: Hub, page: Page, m: to_server.LeaveTrial) -> None:
    await hub.experiment.leave_trial()
