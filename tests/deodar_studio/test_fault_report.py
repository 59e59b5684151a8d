"""An error of deodar itself: the page gets the text for a fault report."""

from __future__ import annotations

from pathlib import Path

import pytest

from deodar_studio.files import workspace
from tests.deodar_studio.page import Page, play, studio


def test_the_page_gets_a_report_of_an_error_of_deodar_itself(
    root: Path, own_state: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def broken(self: object, path: str) -> None:
        raise KeyError(f"selection at {root}/{path}")

    monkeypatch.setattr(workspace.Workspace, "listed", broken)

    async def scene(p: Page) -> None:
        await p.open("open_file", path="selection.json")
        answer = await p.ask("list_folder", path="private")
        assert answer["fault"] and "error of deodar itself (KeyError" in answer["problems"][0]["what"]
        refused = await p.ask("return_to", name="never taken")
        assert refused["problems"] and not refused["fault"]
        text = (await p.do("fault_report"))["text"]
        assert text.startswith("deodar ") and "last error studio, deodar " in text
        assert "deodar_studio/requests/file_requests.py, line " in text and "KeyError: " in text
        assert str(root) not in text and "private" not in text and "selection" not in text

    with studio(root) as address:
        play(address, scene)
    assert (own_state / "last_error.json").stat().st_mode & 0o777 == 0o600
