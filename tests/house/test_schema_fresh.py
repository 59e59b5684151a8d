"""The shipped JSON Schema agrees with the declarations, and committed and written documents are valid
under it.
"""

from __future__ import annotations

import json
import runpy
from pathlib import Path
from typing import Any

import jsonschema
import pytest

from deodar import registry
from deodar.element import Element
from deodar.errors import DeodarError
from deodar.model import document_files, output, schema
from deodar.model.document import VERSION
from deodar.model.model import Model
from tests.house.source import ROOT, texts

SHIPPED: dict[str, Any] = json.loads(schema.SHIPPED.read_text(encoding="utf-8"))
VALIDATOR = jsonschema.Draft202012Validator(SHIPPED)


def _documents() -> list[Path]:
    """Return every committed JSON file that is a deodar document, without the older versions in
    tests/old_files.
    """
    found = []
    for path in texts():
        if path.suffix == ".json" and path != schema.SHIPPED and "old_files" not in path.parts:
            document = json.loads(path.read_text(encoding="utf-8"))
            if isinstance(document, dict) and "deodar" in document and "elements" in document:
                found.append(path)
    return found


def test_the_shipped_schema_is_up_to_date() -> None:
    assert schema.SHIPPED.read_text(encoding="utf-8") == schema.text(), "type: python tools/generate.py"


def test_the_command_writes_the_schema(monkeypatch: pytest.MonkeyPatch) -> None:
    written: dict[Path, bytes] = {}
    monkeypatch.setattr(output, "write", written.__setitem__)
    runpy.run_path(schema.__file__, run_name="__main__")
    assert written == {schema.SHIPPED: schema.SHIPPED.read_bytes()}


def test_the_schema_is_a_valid_json_schema() -> None:
    jsonschema.Draft202012Validator.check_schema(SHIPPED)


def test_saved_documents_are_valid() -> None:
    elements = {n: cls for n, cls in registry.kinds().items() if issubclass(cls, Element)}
    wrong: list[str] = []
    for name, cls in elements.items():
        model = Model("one")
        model.add(cls.example())
        document = json.loads(model.to_json())
        wrong += [f"{name}: {error.message}" for error in VALIDATOR.iter_errors(document)]
    assert len(elements) > 50 and not wrong, wrong


def test_the_schema_refuses_what_load_refuses() -> None:
    model = Model("one")
    model.add(registry.kind("Field").example())
    for change in (
        lambda d: d.update(deodar=VERSION + 1),
        lambda d: d.update(elements=[]),
        lambda d: d.update(strange=1),
        lambda d: d["elements"]["example"].update(kind="Feild"),
        lambda d: d["elements"]["example"].update(tau="20"),
        lambda d: d["elements"]["example"].update(tua=20),
        lambda d: d["elements"]["example"].update(tau=0),
        lambda d: d["axes"]["x"].update(samples=2.5),
    ):
        document = json.loads(model.to_json())
        change(document)
        assert list(VALIDATOR.iter_errors(document))
        with pytest.raises(DeodarError):
            document_files.from_data(document, {})


def test_committed_documents_are_valid_and_have_no_problems() -> None:
    for path in _documents():
        VALIDATOR.validate(json.loads(path.read_text(encoding="utf-8")))
        model = Model(document=document_files.load(path), trusted=False)
        assert not model.check(), path.relative_to(ROOT)
