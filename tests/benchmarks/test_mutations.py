"""Files with errors open, or are refused with problems; the long form is `python benchmarks/mutations.py`."""

from __future__ import annotations

import json
import signal
import sys
from pathlib import Path

import pytest

import deodar as dd

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
import mutations

TEXTS = {name: text for name, text in mutations.sources().items() if len(text) < 30_000}


def test_samples_contain_documents_and_files_of_cosivina() -> None:
    foreign = [name for name, text in TEXTS.items() if "simulator" in text[:100]]
    assert len(foreign) > 3 and len(TEXTS) - len(foreign) > 10


@pytest.mark.parametrize("name", TEXTS)
def test_files_with_errors_open_or_are_refused(name: str, tmp_path: Path) -> None:
    assert mutations.opened(TEXTS[name].encode(), tmp_path) is not None
    outcomes = [mutations.opened(mutations.case(name, 1, number, TEXTS), tmp_path) for number in range(12)]
    assert any(model is None for model in outcomes)


@pytest.mark.parametrize(
    "content",
    [{"simulator": {"nElements": 0, "elements": []}}, {"deodar": 1, "name": "empty", "elements": {}}],
)
def test_a_file_that_states_zero_elements_is_valid(content: dict[str, object], tmp_path: Path) -> None:
    model = mutations.opened(json.dumps(content).encode(), tmp_path)
    assert model is not None and not model.document.entries


def test_an_unexpected_outcome_is_reported(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The harness reports a wrong exception, an error without a message, and an empty model without a
    problem.
    """
    content = json.dumps({"deodar": 1, "name": "m", "elements": {}}).encode()

    def wrong(*_: object) -> dd.Model:
        raise KeyError("u")

    monkeypatch.setattr(mutations.dd, "load", wrong)
    with pytest.raises(mutations.Broken, match="KeyError"):
        mutations.opened(content, tmp_path)

    def silent(*_: object) -> dd.Model:
        raise dd.errors.DocumentError("")

    monkeypatch.setattr(mutations.dd, "load", silent)
    with pytest.raises(mutations.Broken, match="says nothing"):
        mutations.opened(content, tmp_path)
    monkeypatch.setattr(mutations.dd, "load", lambda *_: dd.Model("empty"))
    with pytest.raises(mutations.Broken, match="without elements"):
        mutations.opened(b'{"deodar": 1, "name": "m"}', tmp_path)


if hasattr(signal, "SIGVTALRM"):  # elsewhere the harness has no limit

    def test_a_call_that_does_not_return_is_reported() -> None:
        with pytest.raises(mutations.Broken, match=r"no end after 0\.05 s"), mutations.limited(0.05):
            while True:
                pass
