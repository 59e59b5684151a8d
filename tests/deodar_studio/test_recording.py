"""A page records the run, over a real socket."""

from __future__ import annotations

from pathlib import Path

import numpy as np

import deodar as dd
from deodar.figures import FigureFile
from deodar.recording.record import about
from tests.deodar_studio.page import Page, play, studio


def test_a_page_records_the_run_and_stops_it(root: Path) -> None:
    async def scene(p: Page) -> None:
        await p.open("open_file", path="selection.json")
        assert p.clock["recording"] is None
        await p.do("start_record", ports=[{"element": p.element("u"), "port": "output"}], every=2)
        await p.do("step", n=10)
        await p.until(lambda: p.clock["tick"] == 10)
        assert p.clock["recording"] == {"path": "selection-001", "ended": ""}
        answer = await p.ask("start_record")
        assert "recorded already" in answer["problems"][0]["what"]
        await p.do("stop_record")
        await p.until(lambda: p.clock["recording"]["ended"] == "closed")
        record = dd.open_record(root / "selection-001")
        assert list(record.data_vars) == ["u.output"] and record["time"].values.tolist() == [
            0,
            2,
            4,
            6,
            8,
            10,
        ]
        await p.do("start_record")
        await p.do("step", n=3)
        await p.until(lambda: p.clock["tick"] == 13)
        await p.do("reset")
        await p.until(lambda: "reset" in p.clock["recording"]["ended"])
        record = dd.open_record(root / "selection-002")
        assert list(record.data_vars) == ["u.activation"] and not about(record)["complete"]

    with studio(root) as address:
        play(address, scene)


def test_a_record_is_complete_when_the_document_is_closed(root: Path) -> None:
    async def scene(p: Page) -> None:
        await p.open("open_file", path="selection.json")
        await p.do("start_record", ports=[])
        await p.do("step", n=5)
        await p.until(lambda: p.clock["tick"] == 5)
        await p.do("close")
        await p.until(lambda: p.clock["recording"] is None)
        record = dd.open_record(root / "selection-001")
        assert record.sizes["time"] == 6 and about(record)["complete"]

    with studio(root) as address:
        play(address, scene)


def test_a_plot_is_saved_as_a_figure_file_that_is_drawn(root: Path) -> None:
    async def scene(p: Page) -> None:
        await p.open("open_file", path="selection.json")
        u = p.element("u")
        await p.do("start_record", ports=[{"element": u, "port": "activation"}])
        await p.do("step", n=300)
        await p.until(lambda: p.clock["tick"] == 300)
        await p.do("stop_record")
        plot = {"element": u, "port": "activation"}
        curve = await p.do("save_figure", **plot, kind="curve", range=[-12, 6])
        course = await p.do("save_figure", **plot, kind="course")
        assert (curve["file"], course["file"]) == ("selection-figure-001.toml", "selection-figure-002.toml")
        snapshot, over_time = (FigureFile.read(root / answer["file"]) for answer in (curve, course))
        assert snapshot.record == "selection-001" and snapshot.panels[0].at == (300,)
        assert snapshot.kinds() == ["snapshot"] and over_time.kinds() == ["time_course"]
        axes = snapshot.draw().axes[0]
        assert axes.get_ylim() == (-12, 6)
        expected = dd.open_record(root / "selection-001")["u.activation"].values[-1]
        assert np.allclose(axes.lines[0].get_ydata(), expected)
        refused = await p.ask("save_figure", element=u, port="nothing", kind="curve")
        assert "nothing" in refused["problems"][0]["what"]

    with studio(root) as address:
        play(address, scene)


def test_a_figure_file_without_a_record_is_drawn_from_any(root: Path) -> None:
    async def scene(p: Page) -> None:
        await p.open("open_file", path="selection.json")
        await p.do("save_figure", element=p.element("u"), port="output", kind="curve")
        figure = FigureFile.read(root / "selection-figure-001.toml")
        assert figure.record is None and figure.panels[0].variable == "u.output"

    with studio(root) as address:
        play(address, scene)
