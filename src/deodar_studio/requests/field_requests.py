"""Handlers of requests about one field: its regime and its tuning."""

from __future__ import annotations

from deodar_studio.messages import to_server
from deodar_studio.messages.to_page import Answer
from deodar_studio.pages.hub import Hub
from deodar_studio.pages.page import Page
from deodar_studio.requests.handlers import handles


@handles(to_server.MeasureRegime)
async def _measure_regime(hub: Hub, page: Page, m: to_server.MeasureRegime) -> None:
    hub.measure_regime(m.element)


@handles(to_server.StopRegime)
async def _stop_regime(hub: Hub, page: Page, m: to_server.StopRegime) -> None:
    hub.measurement.stop()


@handles(to_server.TuneField)
async def _tune_field(hub: Hub, page: Page, m: to_server.TuneField) -> None:
    hub.tune_field(m.element, m.parameters, m.requirements)


@handles(to_server.StopTuning)
async def _stop_tuning(hub: Hub, page: Page, m: to_server.StopTuning) -> None:
    hub.field_tuning.stop()


@handles(to_server.ApplyTuning)
async def _apply_tuning(hub: Hub, page: Page, m: to_server.ApplyTuning) -> Answer:
    return Answer(request=m.request, cost=await hub.project.history.change(hub.field_tuning.applied))
