"""Events, actions and messages are declared in one place: the decorator of the class registers it, and no
second list names it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any

import msgspec
import pytest

from deodar.errors import ModelError
from deodar.experiments import actions, events
from deodar.experiments.design import KINDS, Design
from deodar.experiments.plain import from_data, to_data
from deodar.family import Family
from deodar.parameters import Recompile
from deodar_studio.messages import to_page, to_server
from deodar_studio.messages.message import Message, union
from deodar_studio.messages.protocol import schema
from deodar_studio.requests import dispatch, handlers


def _declared(module: Any, base: type[Any]) -> set[str]:
    """Return the classes that a module derives from a base, without the bases themselves."""
    own = [
        cls
        for cls in vars(module).values()
        if isinstance(cls, type) and issubclass(cls, base) and cls.__module__ == module.__name__
    ]
    bases = (base, to_server.Request, to_server.DocumentRequest, to_server.OpeningRequest)
    return {cls.__name__ for cls in own if cls not in bases}


@pytest.mark.parametrize(
    ("module", "base", "family"),
    [
        (events, events.Event, events.EVENTS),
        (actions, actions.Action, actions.ACTIONS),
        (to_server, Message, to_server.MESSAGES),
        (to_page, Message, to_page.MESSAGES),
    ],
    ids=["events", "actions", "to_server", "to_page"],
)
def test_every_declared_class_is_registered(module: Any, base: type[Any], family: Family[Any]) -> None:
    assert set(family) == _declared(module, base) and family


def test_a_new_event_is_read_written_and_in_the_schema(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(events.EVENTS, "_members", dict(events.EVENTS))

    @events.EVENTS.register
    @dataclass(frozen=True)
    class Rings(events.Event):
        name: Annotated[str, Recompile(meaning="name in the rows")]

    data = to_data(Rings("bell"))
    read = from_data(data, "conditions.bell", KINDS["conditions"], {"name": "bell"}, [])
    assert data == {"kind": "Rings"} and read == Rings("bell")
    kinds = Design.schema()["properties"]["conditions"]["additionalProperties"]["oneOf"]
    assert "Rings" in str(kinds)


def test_a_new_message_is_in_the_protocol(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(to_server.MESSAGES, "_members", dict(to_server.MESSAGES))

    @to_server.MESSAGES.register
    class Whistle(to_server.Request, frozen=True, kw_only=True, tag="whistle"):
        loud: bool

    assert "Whistle" in schema()["$defs"]
    read = msgspec.json.decode(b'{"type": "whistle", "loud": true}', type=union(to_server.MESSAGES))
    assert read == Whistle(loud=True)


def test_every_message_to_the_server_has_a_handler() -> None:
    """`Drawn` is not a request: the connection itself reads it."""
    assert set(dispatch.HANDLERS) == set(to_server.MESSAGES.values()) - {to_server.Drawn}


def test_a_second_handler_of_a_message_is_refused() -> None:
    with pytest.raises(ModelError, match="Undo has a handler already"):
        handlers.handles(to_server.Undo)(handlers.HANDLERS[to_server.Redo])


def test_a_name_is_registered_once_and_only_under_its_base() -> None:
    family = Family(events.Event)
    family.register(events.Crosses)
    with pytest.raises(ModelError, match="the Event 'Crosses' is registered twice"):
        family.register(events.Crosses)
    with pytest.raises(ModelError, match="Place is not a subclass of Event"):
        family.register(actions.Place)
    assert list(family) == ["Crosses"] and family["Crosses"] is events.Crosses
