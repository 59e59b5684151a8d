"""Requests about one field: its regime and its tuning."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from deodar.errors import DocumentError
from deodar.model.model import Model
from deodar_studio.messages.message import Id
from deodar_studio.messages.to_page import Answer
from deodar_studio.pages.hub import Hub
from deodar_studio.pages.page import Page
from deodar_studio.requests.request import Count, Text, answer, asks, changes


def _model(hub: Hub, element: str) -> Model:
    """Return the model of the open document, which has this element."""
    doc = hub.project.history.document()
    if element not in doc.by_id():
        raise DocumentError("the document has no such element", where=element)
    return Model(document=doc, trusted=hub.project.trust)


@asks()
async def measure_regime(hub: Hub, page: Page, *, element: Id) -> None:
    """Measure what a field or node does alone, without noise: the `regime` follows when it is found."""
    hub.measurement.start(hub.project.session, _model(hub, element), element)


@asks()
async def stop_regime(hub: Hub, page: Page) -> None:
    """End the measurement of a regime."""
    hub.measurement.stop()


@asks()
async def tune_field(
    hub: Hub,
    page: Page,
    *,
    element: Id,
    parameters: Sequence[Text],
    requirements: Sequence[Any],
    seed: Count = 0,
) -> None:
    """Find values of parameters at which a field meets requirements: `tuning` follows.

    `parameters` are names of parameters of the field, such as `kernel.0.sigma`. A requirement is a name, or
    an object such as `{"detects": {"at": 3, "within": 0.2}}`, as in the files of `deodar tune`. Another
    `seed` searches elsewhere.
    """
    model = _model(hub, element)
    wanted = {"requirements": list(requirements), "seed": seed}
    hub.field_tuning.start(hub.project.session, model, element, parameters, wanted)


@asks()
async def stop_tuning(hub: Hub, page: Page) -> None:
    """End the tuning of a field, and forget what was found."""
    hub.field_tuning.stop()


@changes()
async def apply_tuning(hub: Hub, page: Page) -> Answer:
    """Give the parameters of the field the values that were found, as one change."""
    return answer(cost=await hub.project.history.change(hub.field_tuning.applied))
