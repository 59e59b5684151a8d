"""Events, actions and messages are declared in one place: the decorator of the class registers it, and no
second list names it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import msgspec
import pytest

from deodar.errors import ModelError
from deodar.experiments import actions, events
from deodar.experiments.design import KINDS, Design
from deodar.family import Family
from deodar.part_data import from_data, to_data
from deodar_studio.messages import to_page
from deodar_studio.messages.message import Message, union
from deodar_studio.pages.hub import Hub
from deodar_studio.pages.page import Page
from deodar_studio.requests.protocol import schema
from deodar_studio.requests.request import MESSAGES, Text, asks


def _declared(module: Any, base: type[Any]) -> set[str]:
    """Return the classes that a module derives from a base."""
    own = [
        cls
        for cls in vars(module).values()
        if isinstance(cls, type) and issubclass(cls, base) and cls.__module__ == module.__name__
    ]
    return {cls.__name__ for cls in own if cls is not base}


@pytest.mark.parametrize(
    ("module", "base", "family"),
    [
        (events, events.Event, events.EVENTS),
        (actions, actions.Action, actions.ACTIONS),
        (to_page, Message, to_page.MESSAGES),
    ],
    ids=["events", "actions", "to_page"],
)
def test_every_declared_class_is_registered(module: Any, base: type[Any], family: Family[Any]) -> None:
    assert set(family) == _declared(module, base) and family


def test_a_new_event_is_read_written_and_in_the_schema(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(events.EVENTS, "_members", dict(events.EVENTS))

    @events.EVENTS.register
    @dataclass(frozen=True)
    class Rings(events.Event):
        name: str

    data = to_data(Rings("bell"))
    read = from_data(data, "conditions.bell", KINDS["conditions"], {"name": "bell"}, [])
    assert data == {"kind": "Rings"} and read == Rings("bell")
    kinds = Design.schema()["properties"]["conditions"]["additionalProperties"]["oneOf"]
    assert "Rings" in str(kinds)


def test_a_new_message_is_in_the_protocol(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(MESSAGES, "_members", dict(MESSAGES))

    @asks(tag="blow")
    async def whistle_twice(hub: Hub, page: Page, *, loud: bool, tune: Text = "C") -> None:
        """Whistle."""

    form = schema()["$defs"]["WhistleTwice"]
    assert form["description"] == "Whistle." and set(form["required"]) == {"type", "loud"}
    read = msgspec.json.decode(b'{"type": "blow", "loud": true}', type=union(MESSAGES))
    assert read == MESSAGES["WhistleTwice"](loud=True, tune="C")
    with pytest.raises(msgspec.ValidationError, match="length <= 4096"):
        msgspec.convert({"type": "blow", "loud": True, "tune": "C" * 4097}, union(MESSAGES))
    with pytest.raises(msgspec.ValidationError, match="unknown field `pitch`"):
        msgspec.convert({"type": "blow", "loud": True, "pitch": 1}, union(MESSAGES))


def test_a_second_request_of_a_name_is_refused() -> None:
    async def undo(hub: Hub, page: Page) -> None:
        """Undo."""

    with pytest.raises(ModelError, match="the Request 'Undo' is registered twice"):
        asks()(undo)


def test_a_name_is_registered_once_and_only_under_its_base() -> None:
    family = Family(events.Event)
    family.register(events.Crosses)
    with pytest.raises(ModelError, match="the Event 'Crosses' is registered twice"):
        family.register(events.Crosses)
    with pytest.raises(ModelError, match="Place is not a subclass of Event"):
        family.register(actions.Place)
    assert list(family) == ["Crosses"] and family["Crosses"] is events.Crosses
