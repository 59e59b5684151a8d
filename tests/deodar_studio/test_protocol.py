"""The messages: generated files are up to date, and arrays are unchanged after transport."""

from __future__ import annotations

import json
from pathlib import Path

import jsonschema
import numpy as np
import pytest

from deodar.model import output
from deodar_studio.messages import frames, to_page
from deodar_studio.requests import protocol, request
from tests.deodar_studio.page import unpacked

SAY = "type: python tools/generate.py"


def test_the_schema_is_up_to_date() -> None:
    assert protocol.SCHEMA.read_text(encoding="utf-8") == protocol.schema_text(), SAY


def test_the_typescript_is_up_to_date() -> None:
    assert protocol.TYPESCRIPT.read_text(encoding="utf-8") == protocol.typescript(), SAY


def test_the_page_knows_which_requests_are_meant_for_the_open_document() -> None:
    meant = protocol.meant()
    assert {"change_axis", "use_world", "use_world_content", "leave_trial", "set", "close"} <= set(meant)
    assert not {"open_file", "open_text", "recover", "new", "play", "watch"} & set(meant)
    assert all(f'  "{tag}",\n' in protocol.typescript().partition("MEANT")[2] for tag in meant)


def test_the_command_writes_the_schema_and_the_typescript(monkeypatch: pytest.MonkeyPatch) -> None:
    written: dict[Path, bytes] = {}
    monkeypatch.setattr(output, "write", written.__setitem__)
    protocol.write()
    assert written == {path: path.read_bytes() for path in (protocol.SCHEMA, protocol.TYPESCRIPT)}


def test_the_schema_is_valid_and_refuses_unknown_messages() -> None:
    schema = protocol.schema()
    jsonschema.Draft202012Validator.check_schema(schema)
    validator = jsonschema.Draft202012Validator(schema | {"$ref": "#/$defs/ToServer"})
    validator.validate({"type": "step", "n": 5})
    for bad in (
        {"type": "step", "n": 0},
        {"type": "stop"},
        {"type": "set", "element": "u", "parameter": "tau"},
    ):
        with pytest.raises(jsonschema.ValidationError):
            validator.validate(bad)


def test_tags_of_messages_are_unique_and_all_are_in_the_typescript() -> None:
    text = protocol.typescript()
    families = (request.MESSAGES, to_page.MESSAGES)
    tags = [cls.__struct_config__.tag for family in families for cls in family.values()]
    assert len(set(tags)) == len(tags)
    for tag in tags:
        assert f"  type: {json.dumps(tag)};" in text


def test_an_encoded_frame_is_decoded_unchanged() -> None:
    values = np.arange(12, dtype=np.float32).reshape(3, 4)
    data = frames.pack(7, 2**32 + 5, 123.5, values)
    stream, frame, time, back = unpacked(data)
    assert (stream, frame, time) == (7, 5, 123.5) and len(data) == 16 + 4 * 12
    np.testing.assert_array_equal(back, values.ravel())
    assert unpacked(frames.pack(0, 0, 0, np.asarray(2.5)))[3].tolist() == [2.5]
