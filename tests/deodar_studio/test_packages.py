"""Packages in the studio: unpacked beside themselves, and opened as what they hold."""

from __future__ import annotations

from pathlib import Path

import pytest

import deodar as dd
from deodar.errors import DocumentError
from deodar_studio.files.unpacked import unpacked
from tests.deodar.packing.test_packing import folder as folder
from tests.deodar.packing.test_packing import packed_record, selection_plan
from tests.deodar_studio.page import Page, play, studio

__all__ = ["folder"]


def packed_results() -> Path:
    dd.save(dd.load("example:selection"), "model.json")
    selection_plan("choice").run("results")
    return dd.pack("results", "choice.deodar")


def test_a_packed_record_and_packed_results_open_from_the_page(folder: Path) -> None:
    packed_record()
    packed_results()

    async def scene(p: Page) -> None:
        answer = await p.do("open_file", path="node.deodar")
        assert answer["text"].startswith("node.deodar is unpacked in node: a record, made by deodar")
        await p.until(lambda: (p.document or {}).get("record"))
        assert p.document["record"]["path"] == "node/node.nc"
        await p.do("open_file", path="choice.deodar", discard=True)
        await p.until(lambda: p.document["title"] == "selection")
        assert (folder / "choice" / "results" / "trials.jsonl").is_file()

    with studio(folder) as address:
        play(address, scene)


def test_a_studio_that_is_started_with_results_shows_the_experiment(folder: Path) -> None:
    inner, _ = unpacked(packed_results(), False)
    assert inner == Path("choice/results/experiment.json")

    async def scene(p: Page) -> None:
        await p.until(lambda: p.said.get("experiment", {}).get("data"))
        assert p.said["experiment"]["data"]["trials"] == 2

    with studio(folder, folder / inner) as address:
        play(address, scene)


def test_a_package_is_unpacked_once_and_never_over_other_files(folder: Path) -> None:
    packed = packed_record()
    inner, sentence = unpacked(packed, False)
    assert (inner, sentence.partition(":")[0]) == (Path("node/node.nc"), "node.deodar is unpacked in node")
    assert unpacked(packed, False)[0] == inner
    inner.write_bytes(b"mine")
    assert unpacked(packed, False)[0] == Path("node-001/node.nc") and inner.read_bytes() == b"mine"


def test_a_model_alone_is_opened_as_it_is(folder: Path) -> None:
    assert unpacked(dd.pack("example:node"), False) == (Path("node.deodar"), "")


def test_a_packed_figure_is_refused_with_the_command_that_draws_it(folder: Path) -> None:
    dd.save_record(dd.simulate(dd.load("example:node"), 5, record="u.activation"), "node.nc")
    Path("f.toml").write_text('record = "node.nc"\n\n[[panel]]\nvariable = "u.activation"\n')
    with pytest.raises(DocumentError, match=r"Draw it: deodar plot f/f.toml"):
        unpacked(dd.pack("f.toml"), False)
