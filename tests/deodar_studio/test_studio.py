"""The studio over a real socket: opening, running, tuning, watching, saving."""

from __future__ import annotations

import asyncio
import base64
import contextlib
import json
import shutil
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import websockets

import deodar as dd
from deodar.numerics.kernel_shape import kernel_shape
from deodar.numerics.sigmoids import Linear
from deodar_studio.files.state_store import StateStore
from deodar_studio.live import engine
from deodar_studio.pages import hub
from tests.deodar_studio.models import weighted
from tests.deodar_studio.page import Page, page, play, studio

AXES = [dd.Axis(name, 0, 10, samples=n) for name, n in (("x", 4), ("y", 5), ("z", 6))]


def test_a_page_watches_planes_and_rows_of_a_field_over_three_axes(root: Path) -> None:
    values = np.random.default_rng(0).normal(size=(4, 5, 6))
    model = dd.Model("three")
    model.add(dd.Pattern("s", AXES, values=values))
    dd.save(model, root / "three.json")
    whole = values.astype(np.float32)

    async def scene(p: Page) -> None:
        await p.open("open_file", path="three.json")
        port = {"element": p.element("s"), "port": "output"}
        await p.do("watch", stream=1, **port)
        await p.do("watch", stream=2, **port, drawn=["z", "x"], at={"y": 5.2})
        await p.do("watch", stream=3, **port, drawn=["y"], at={"x": 0, "z": 10})
        await p.do("rows", stream=4, **port, drawn="z", at={"x": 10})
        await p.do("step", n=2)
        await p.until(lambda: all(k in p.frames and p.frames[k][0] == 2 for k in (1, 2, 3)))
        assert np.array_equal(p.frames[1][1], whole.max(axis=2))
        assert np.array_equal(p.frames[2][1], whole[:, 2].T)
        assert np.array_equal(p.frames[3][1], whole[0, :, 5])
        said = [[a["name"] for a in p.forms[2][key]] for key in ("axes", "rest")]
        assert said == [["z", "x"], ["y"]] and p.forms[2]["folded"] == [] and p.forms[1]["folded"] == ["z"]
        await p.until(lambda: p.rows[4] is not None and p.rows[4][-1, 0] == 2)
        rows = p.rows[4]
        assert rows is not None and np.array_equal(rows[-1, 1:], whole[3].max(axis=0))
        assert p.forms[4]["folded"] == ["y"] and p.forms[4]["shape"] == [7]

    with studio(root) as address:
        play(address, scene)


def test_a_page_watches_the_kernel_of_a_field_as_its_parameters_are_now(root: Path) -> None:
    async def scene(p: Page) -> None:
        await p.open("open_file", path="selection.json")
        u, left = p.element("u"), p.element("left")
        shown = {e["path"]: e["kernel"] for e in p.document["elements"]}
        assert shown == {"u": True, "left": False, "right": False}
        await p.do("kernel", stream=1, element=u)
        await p.do("kernel", stream=2, element=left)
        await p.until(lambda: 1 in p.frames and 2 in p.lost)
        assert "no interaction kernel" in p.lost[2]["problem"]["what"]
        before, lags = p.frames[1][1], np.arange(-100, 101)
        u_kernel = dd.load(root / "selection.json").get("u.kernel")
        expected = kernel_shape(u_kernel, (dd.Axis("x", 0, 100, samples=101),))[1]
        np.testing.assert_allclose(before, expected, rtol=1e-5, atol=1e-6)
        assert p.forms[1]["axes"][0]["name"] == "lag in x" and lags[before.argmax()] == 0
        await p.do("set", element=u, parameter="kernel.0.amplitude", value=24.0)
        await p.until(lambda: np.allclose(p.frames[1][1], 2 * before, rtol=1e-5))
        count = len([m for m in p.all if m["type"] == "announced"])
        await p.do("step", n=5)
        await p.until(lambda: p.clock["tick"] == 5)
        assert len([m for m in p.all if m["type"] == "announced"]) == count

    with studio(root) as address:
        play(address, scene)


def test_a_page_watches_fixed_weights_over_the_axes_of_target_and_source(root: Path) -> None:
    x, y = dd.Axis("x", 0, 10, samples=4), dd.Axis("y", 0, 10, samples=5)
    weights = np.random.default_rng(0).normal(size=(4, 5, 4))
    model = dd.Model("weights")
    source = model.add(dd.Field("source", [y, x]))
    source >> model.add(dd.Weights(weights, [x], name="map")) >> model.add(dd.Field("target", [x]))
    dd.save(model, root / "weights.json")
    whole = weights.astype(np.float32)

    async def scene(p: Page) -> None:
        await p.open("open_file", path="weights.json")
        ident = p.element("map")
        await p.do("weights", stream=1, element=ident, parameter="weights")
        await p.do("weights", stream=2, element=ident, parameter="weights", drawn=["y", "x"], at={"x 2": 10})
        await p.do("weights", stream=3, element=p.element("source"), parameter="weights")
        await p.until(lambda: {1, 2} <= p.frames.keys() and 3 in p.lost)
        assert np.array_equal(p.frames[1][1], whole.max(axis=2))
        assert np.array_equal(p.frames[2][1], whole[:, :, 3].T)
        said = [[a["name"] for a in p.forms[1][key]] for key in ("axes", "rest")]
        assert said == [["x", "y"], ["x 2"]] and p.forms[1]["folded"] == ["x 2"]
        assert "no weights 'weights'" in p.lost[3]["problem"]["what"]
        count = len([m for m in p.all if m["type"] == "announced"])
        await p.do("step", n=5)
        await p.until(lambda: p.clock["tick"] == 5)
        assert len([m for m in p.all if m["type"] == "announced"]) == count

    with studio(root) as address:
        play(address, scene)


def test_a_user_opens_a_file_creates_a_peak_removes_it_and_undoes_the_change(root: Path) -> None:
    """Open, run to a peak, lower the resting level until it decays, undo, save, and open the saved file."""

    async def scene(p: Page) -> None:
        await p.open("open_file", path="selection.json")
        u = p.element("u")
        await p.do("watch", stream=1, element=u, port="activation")
        await p.do("trace", stream=2, element=u, port="activation", reduce="max")
        await p.do("speed", factor=None)
        await p.do("step", n=500)
        await p.until(lambda: p.clock["tick"] == 500 and 1 in p.frames and p.frames[1][0] == 500)
        assert p.frames[1][1].shape == (101,) and p.frames[1][1].max() > 3, (
            "one of the two inputs has made a peak"
        )
        await p.until(lambda: p.samples.get(2) and p.samples[2][-1][0] == 500)
        assert p.samples[2][-1] == (500.0, pytest.approx(float(p.frames[1][1].max())))
        cost = await p.do("set", element=u, parameter="resting_level", value=-12, gesture=1)
        assert cost["cost"] == "live"
        await p.do("step", n=90)
        await p.until(lambda: p.clock["tick"] == 590 and p.frames[1][0] == 590)
        assert p.frames[1][1].max() < 0, "the peak has decayed while its input is still there"
        assert p.document["elements"][0]["values"]["resting_level"] == -12 and p.document["unsaved"]
        await p.do("undo")
        await p.until(
            lambda: p.document["elements"][0]["values"]["resting_level"] == -5 and not p.document["unsaved"]
        )
        await p.do("redo")
        done = await p.do("save", path="mine")
        assert done["file"] == "mine.json"

    with studio(root) as address:
        play(address, scene)
    assert dd.load(root / "mine.json").get("u.resting_level") == -12


def test_the_studio_gives_the_values_of_a_script(root: Path) -> None:
    """The same steps with the same seed give the same activation as a session of a script."""
    seen: list[np.ndarray] = []

    async def scene(p: Page) -> None:
        await p.runs()
        await p.do("watch", stream=1, element=p.element("u"), port="activation")
        await p.do("reset", seed=7)
        await p.do("step", n=400)
        await p.until(lambda: 1 in p.frames and p.frames[1][0] == 400)
        assert p.clock["seed"] == 7
        seen.append(p.frames[1][1])

    with studio(root, root / "selection.json") as address:
        play(address, scene)
    session = dd.Session(dd.load(root / "selection.json"), seed=7)
    session.step(400)
    np.testing.assert_allclose(seen[0], session.read("u.activation"), atol=1e-4)


def test_a_dragged_slider_is_one_step_of_undo(root: Path) -> None:
    async def scene(p: Page) -> None:
        await p.runs()
        u = p.element("u")
        for gesture, values in ((1, (-4, -3, -2)), (2, (-1, 0))):
            for value in values:
                await p.do("set", element=u, parameter="resting_level", value=value, gesture=gesture)
        await p.until(
            lambda: p.document["elements"][0]["values"]["resting_level"] == 0 and p.document["undo"] == 2
        )
        await p.do("undo")
        await p.until(lambda: p.document["elements"][0]["values"]["resting_level"] == -2)
        await p.do("undo")
        await p.until(lambda: p.document["elements"][0]["values"]["resting_level"] == -5)

    with studio(root, root / "selection.json") as address:
        play(address, scene)


def test_a_warning_appears_and_disappears_while_a_slider_is_dragged(root: Path) -> None:
    """Single changes do not send the document again, and its warnings depend on the values."""

    async def scene(p: Page) -> None:
        await p.runs()
        before = p.document["problems"]
        level = p.document["elements"][0]["values"]["resting_level"]
        for value, warned in ((30, True), (level, False)):
            await p.do("set", element=p.element("u"), parameter="resting_level", value=value)
            await p.until(
                lambda warned=warned: (
                    "checked" in p.said and (p.said["checked"]["problems"] != before) == warned
                )
            )
            if warned:
                (problem,) = p.said["checked"]["problems"]
                assert (
                    problem["element"] == p.element("u")
                    and problem["severity"] == "warning"
                    and "always above" in problem["what"]
                )
        assert p.said["checked"]["version"] == p.said["edited"]["version"]

    with studio(root, root / "node.json") as address:
        play(address, scene)


def test_a_structural_change_compiles_beside_the_run_and_keeps_the_state(root: Path) -> None:
    async def scene(p: Page) -> None:
        await p.runs()
        u = p.element("u")
        await p.do("watch", stream=1, element=u, port="activation")
        await p.do("step", n=500)
        await p.until(lambda: 1 in p.frames and p.frames[1][0] == 500)
        before = p.frames[1][1]
        kernel = [
            {"kind": "Gaussian", "amplitude": 12, "sigma": 5, "normalized": True},
            {"kind": "Gaussian", "amplitude": -0.1, "sigma": 20},
        ]
        done = await p.do("set", element=u, parameter="kernel", value=kernel)
        assert done["cost"] == "recompile"
        await p.until(
            lambda: (
                len(p.document["elements"][0]["values"]["kernel"]) == 2
                and not p.clock["busy"]
                and 1 in p.frames
            )
        )
        np.testing.assert_array_equal(p.frames[1][1], before)
        assert p.clock["tick"] == 500
        done = await p.do("set", element=u, parameter="kernel.1.amplitude", value=-0.2)
        assert done["cost"] == "live", "the new program runs"

    with studio(root, root / "selection.json") as address:
        play(address, scene)


def test_a_refused_value_does_not_change_the_document_and_names_its_path(root: Path) -> None:
    async def scene(p: Page) -> None:
        await p.runs()
        u = p.element("u")
        refused = await p.ask("set", element=u, parameter="tau", value=-1)
        assert refused["problems"][0]["element"] == u and "below" in refused["problems"][0]["what"]
        refused = await p.ask("set", element=u, parameter="tau", value=0.5)
        assert "longer than the time constant" in refused["problems"][0]["what"]
        refused = await p.ask("describe", dt=50)
        assert "longer than the time constant" in refused["problems"][0]["what"]
        refused = await p.ask("set", element=u, parameter="kernel", value=[{"kind": "Gausian"}])
        assert "Gaussian" in refused["problems"][0]["fix"]
        refused = await p.ask("set", element=u, parameter="axes", value=["z"])
        assert "Axes of the document: x" in refused["problems"][0]["fix"]
        assert p.document["elements"][0]["values"]["tau"] == 20 and p.document["undo"] == 0

    with studio(root, root / "selection.json") as address:
        play(address, scene)


def test_the_repair_of_a_problem_is_one_edit_that_removes_it(root: Path) -> None:
    async def scene(p: Page) -> None:
        await p.runs()
        u = p.element("u")
        await p.do("set", element=u, parameter="resting_level", value=5)
        await p.until(lambda: "checked" in p.said and p.said["checked"]["problems"])
        (problem,) = p.said["checked"]["problems"]
        assert problem["repair"] == "Change the sign"
        named = {"where": problem["where"], "what": problem["what"]}
        await p.do("repair", **named)
        await p.until(lambda: not p.said["checked"]["problems"])
        assert p.document["elements"][0]["values"]["resting_level"] == -5 and p.document["undo"] == 2
        refused = await p.ask("repair", **named)
        (why,) = refused["problems"]
        assert "no repair any more" in why["what"] and (why["element"], why["repair"]) == (u, "")
        await p.do("undo")
        await p.until(lambda: p.document["elements"][0]["values"]["resting_level"] == 5)

    with studio(root, root / "selection.json") as address:
        play(address, scene)


def test_dt_is_stored_in_the_document(root: Path) -> None:
    async def scene(p: Page) -> None:
        await p.runs()
        await p.do("describe", dt=0.5)
        await p.until(lambda: p.clock["dt"] == 0.5 and p.document["dt"] == 0.5)
        await p.do("undo")
        await p.until(lambda: p.clock["dt"] == 1 and p.document["dt"] is None)

    with studio(root, root / "selection.json") as address:
        play(address, scene)


def test_one_document_parameter_drives_several(root: Path) -> None:
    async def scene(p: Page) -> None:
        await p.runs()
        left, right = p.element("left"), p.element("right")
        await p.do("add_document_parameter", name="input strength", element=left, parameter="amplitude")
        await p.do("link", name="input strength", element=right, parameter="amplitude")
        await p.do("set", element="", parameter="input strength", value=3, gesture=5)
        await p.until(lambda: [e["values"]["amplitude"] for e in p.document["elements"][1:]] == [3, 3])
        refused = await p.ask("set", element=left, parameter="amplitude", value=1)
        assert "driven by" in refused["problems"][0]["what"]
        await p.do("unlink", element=left, parameter="amplitude")
        await p.do("set", element=left, parameter="amplitude", value=1)
        await p.do("remove_document_parameter", name="input strength")
        await p.until(lambda: p.document["parameters"] == [])

    with studio(root, root / "selection.json") as address:
        play(address, scene)


def test_the_layout_is_stored_in_the_document(root: Path) -> None:
    async def scene(p: Page) -> None:
        await p.runs()
        await p.do("arrange", layout={"folded": ["g"]}, undoable=False)
        await p.until(lambda: p.document["layout"]["folded"] == ["g"])
        assert not p.document["unsaved"] and p.document["undo"] == 0, "which groups are folded is no edit"
        await p.do("arrange", layout={"pins": [{"element": "e", "parameter": "tau"}]})
        await p.until(lambda: p.document["unsaved"] and p.document["undo"] == 1)
        await p.do("save")

    with studio(root, root / "selection.json") as address:
        play(address, scene)
    layout = json.loads((root / "selection.json").read_text())["layout"]
    assert layout == {"folded": ["g"], "pins": [{"element": "e", "parameter": "tau"}]}


def test_views_and_folds_are_no_part_of_the_history(root: Path) -> None:
    async def scene(p: Page) -> None:
        await p.runs()
        u = p.element("u")

        async def arrange(**layout: Any) -> None:
            await p.do("arrange", layout=layout, undoable=False)

        def status() -> tuple[int, int, Any]:
            layout = p.document["layout"]
            return p.document["undo"], p.document["redo"], (layout["view"], layout["folded"])

        await p.do("set", element=u, parameter="tau", value=33.0)
        await p.do("undo")
        await arrange(view="run")
        assert status() == (0, 1, ("run", None)), "redo remains"
        await p.do("redo")
        await arrange(folded=["g"])
        await p.do("undo")
        assert status() == (0, 1, ("run", ["g"])), "the fold is not undone with tau"
        for view, value in (("build", 21.0), ("robot", 22.0)):  # the drag of a slider
            await p.do("set", element=u, parameter="tau", value=value, gesture=5)
            await arrange(view=view)
        assert status() == (1, 0, ("robot", ["g"])), "the drag is one step"
        await p.do("undo")
        assert p.document["layout"]["view"] == "robot"

    with studio(root, root / "selection.json") as address:
        play(address, scene)


def test_an_injected_input_creates_a_peak_until_it_ends(root: Path) -> None:
    async def scene(p: Page) -> None:
        await p.runs()
        u = p.element("u")
        await p.do("watch", stream=1, element=u, port="activation")
        await p.do("push", element=u, amplitude=9, center=[50], sigma=[5])
        await p.until(lambda: p.clock["pushing"] == u)
        await p.do("step", n=80)
        await p.until(lambda: 1 in p.frames and p.frames[1][0] == 80)
        assert p.frames[1][1].argmax() == 50 and p.frames[1][1].max() > 3
        await p.do("release")
        await p.until(lambda: p.clock["pushing"] == "")
        refused = await p.ask("push", element=p.element("left"), amplitude=1)
        assert refused["problems"]

    with studio(root, root / "selection.json") as address:
        play(address, scene)


def test_two_pages_show_the_same_run_which_continues_after_both_are_closed(root: Path) -> None:
    async def main(address: str) -> None:
        async with page(address) as a, page(address) as b:
            await a.runs()
            await b.runs()
            await a.do("set", element=a.element("u"), parameter="tau", value=33)
            await b.until(lambda: b.document["elements"][0]["values"]["tau"] == 33)
            await b.do("play")
            await a.until(lambda: a.clock["running"] and a.clock["tick"] > 5)
        tick = a.clock["tick"]
        async with page(address) as c:
            await c.until(lambda: c.clock["tick"] > tick and c.clock["running"])
            assert c.document["elements"][0]["values"]["tau"] == 33 and c.document["unsaved"]

    with studio(root, root / "selection.json") as address:
        asyncio.run(main(address))


def test_a_stalled_page_gets_no_more_frames_and_delays_no_other_page(root: Path) -> None:
    async def main(address: str) -> None:
        async with page(address, draws=False) as stalled, page(address) as visitor:
            await visitor.runs()
            u = visitor.element("u")
            await visitor.do("watch", stream=1, element=u, port="activation")
            await stalled.send(type="watch", stream=1, element=u, port="activation")
            await visitor.do("play")
            for k in range(100):
                await visitor.do("set", element=u, parameter="tau", value=20 + k)
            await visitor.until(lambda: visitor.clocks > 60)
            assert stalled.clocks == 1, "it has not said that it took the first one in"
            await stalled.send(type="drawn", frame=stalled.clock["frame"])
            await stalled.until(lambda: stalled.clocks == 2)
            await stalled.until(lambda: stalled.document["elements"][0]["values"]["tau"] == 119)

    with studio(root, root / "selection.json") as address:
        asyncio.run(main(address))


def test_an_element_that_fails_is_named_and_the_document_is_kept(root: Path) -> None:
    model = dd.Model("runaway")
    model.add(dd.Field("u", [], tau=10, resting_level=0.5))
    grow = model.add(dd.Field("grow", [], tau=1, resting_level=1, sigmoid=Linear()))
    grow >> dd.Gain(1e6) >> grow
    dd.save(model, root / "runaway.json")

    async def scene(p: Page) -> None:
        await p.runs()
        await p.do("speed", factor=None)
        await p.do("play")
        await p.until(lambda: p.clock["failure"])
        failure = p.clock["failure"][0]
        assert (
            failure["element"] in (p.element("grow"), p.element("grow>Gain"))
            and "infinite" in failure["what"]
        )
        assert not p.clock["running"]
        await p.do("watch", stream=1, element=p.element("u"), port="activation")
        await p.until(lambda: 1 in p.frames)
        assert np.isfinite(p.frames[1][1])
        await p.do(
            "set",
            element=next(e["id"] for e in p.document["elements"] if e["kind"] == "Gain"),
            parameter="factor",
            value=0,
        )
        await p.do("reset")
        await p.do("step", n=50)
        await p.until(lambda: p.clock["tick"] == 50 and not p.clock["failure"])

    with studio(root, root / "runaway.json") as address:
        play(address, scene)


def test_a_change_that_recompiles_is_shown_when_it_is_compiled(
    root: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    made = engine.port_reader

    def slowly(*arguments: Any) -> Any:
        time.sleep(0.3)
        return made(*arguments)

    monkeypatch.setattr(engine, "port_reader", slowly)

    async def scene(p: Page) -> None:
        await p.runs()
        await p.do("watch", stream=1, element=p.element("u"), port="activation")
        await p.until(lambda: 1 in p.frames)

    with studio(root, root / "selection.json") as address:
        play(address, scene)


def test_malformed_messages_are_answered_and_too_many_end_the_connection(root: Path) -> None:
    async def main(address: str) -> None:
        async with page(address) as p:
            for text in (
                "",
                "{",
                "[]",
                '{"type": "nonsense", "request": 3}',
                '{"type": "set", "request": 4}',
                '{"type": "step", "n": -1, "request": 5}',
            ):
                await p.socket.send(text)
            await p.until(lambda: {3, 4, 5} <= set(p._answers))
            assert "not understood" in p._answers[5]["problems"][0]["what"]
            await p.do("open_file", path="selection.json")
            for _ in range(30):
                await p.socket.send(b"\x00\x01")
            await asyncio.wait_for(p.socket.wait_closed(), 600)
            assert p.socket.close_code == 1008
        async with page(address) as p:
            assert p.document["title"] == "selection"

    with studio(root) as address:
        asyncio.run(main(address))


def test_an_oversized_message_ends_only_that_connection(root: Path) -> None:
    async def main(address: str) -> None:
        async with page(address) as p:
            with contextlib.suppress(websockets.ConnectionClosed):
                await p.socket.send(
                    json.dumps({"type": "open_text", "name": "x", "text": "x" * (65 * 2**20)})
                )
            await asyncio.wait_for(p.socket.wait_closed(), 600)
        async with page(address) as p:
            assert p.document is None

    with studio(root) as address:
        asyncio.run(main(address))


def test_a_file_with_problems_lists_all_of_them_until_a_valid_file_is_opened(root: Path) -> None:
    document = json.loads((root / "selection.json").read_text())
    document["elements"]["u"]["tau"] = -1
    document["elements"]["left"]["kind"] = "GausianStimulus"
    (root / "bad.json").write_text(json.dumps(document))

    async def scene(p: Page) -> None:
        await p.until(lambda: "file_problems" in p.said and p.said["file_problems"]["problems"])
        problems = p.said["file_problems"]["problems"]
        assert (
            len(problems) == 2
            and any("u.tau" in q["where"] for q in problems)
            and any("GaussianStimulus" in q["fix"] for q in problems)
        )
        assert p.document is None
        await p.do("open_file", path="gone.json")
        await p.until(lambda: "no such file" in p.said["file_problems"]["problems"][0]["what"])
        await p.open("open_file", path="selection.json")
        assert p.said["file_problems"]["problems"] == []

    with studio(root, root / "bad.json") as address:
        play(address, scene)


def test_leaving_with_unsaved_edits_requires_confirmation(root: Path) -> None:
    async def scene(p: Page) -> None:
        await p.runs()
        await p.do("set", element=p.element("u"), parameter="tau", value=30)
        for request in (
            {"type": "open_file", "path": "node.json"},
            {"type": "close"},
            {"type": "open_example", "name": "detection"},
        ):
            assert (await p.ask(**request))["ask"] == "unsaved"
        await p.do("close", discard=True)
        await p.until(lambda: p.said["opened"]["document"] is None)

    with studio(root, root / "selection.json") as address:
        play(address, scene)


def test_saving_over_a_file_changed_on_disk_requires_confirmation(root: Path) -> None:
    async def scene(p: Page) -> None:
        await p.runs()
        await p.do("set", element=p.element("u"), parameter="tau", value=30)
        await p.do("save")
        shutil.copy(root / "node.json", root / "selection.json")
        await p.do("set", element=p.element("u"), parameter="tau", value=31)
        assert (await p.ask("save"))["ask"] == "replace"
        assert (await p.ask("save", path="working_memory.json"))["ask"] == "replace"
        await p.do("save", replace=True)
        (root / "selection.json").unlink()
        await p.do("save")

    with studio(root, root / "selection.json") as address:
        play(address, scene)
    assert dd.load(root / "selection.json").get("u.tau") == 31


def test_nothing_outside_the_root_is_read_or_written(
    root: Path, tmp_path_factory: pytest.TempPathFactory
) -> None:
    outside = tmp_path_factory.mktemp("outside")
    shutil.copy(root / "node.json", outside / "secret.json")
    (root / "link.json").symlink_to(outside / "secret.json")
    (root / "folder").symlink_to(outside)

    async def scene(p: Page) -> None:
        await p.runs()
        for path in (
            str(outside / "secret.json"),
            "../x.json",
            "link.json",
            "folder/secret.json",
            "/etc/passwd",
        ):
            refused = await p.ask("open_file", path=path)
            assert "outside the folder" in refused["problems"][0]["what"], path
            refused = await p.ask("save", path=path)
            assert refused["problems"], path
        refused = await p.ask("list_folder", path="..")
        assert "outside" in refused["problems"][0]["what"]
        await p.do("list_folder")
        assert "selection.json" in p.said["folder"]["files"] and "link.json" not in p.said["folder"]["files"]
        assert "folder" not in p.said["folder"]["folders"]
        refused = await p.ask("use_world", kind="Picture", path="../x.png")
        assert "outside" in refused["problems"][0]["what"]

    with studio(root, root / "selection.json") as address:
        play(address, scene)
    assert sorted(p.name for p in outside.iterdir()) == ["secret.json"]


def test_a_dropped_document_is_saved_only_under_a_new_name(root: Path) -> None:
    text = (root / "selection.json").read_text()

    async def scene(p: Page) -> None:
        await p.open("open_text", name="dropped.json", text=text)
        assert p.document["file"] == "" and p.document["title"] == "selection"
        refused = await p.ask("save")
        assert "no file yet" in refused["problems"][0]["what"]
        await p.do("save", path="kept")
        await p.do(
            "open_text", name="broken.json", text='{"deodar": 1, "elements": {"u": {"kind": "Nothing"}}}'
        )
        assert p.said["file_problems"]["file"] == "broken.json"

    with studio(root) as address:
        play(address, scene)
    assert (root / "kept.json").is_file() and not (root / "dropped.json").exists()


def test_a_package_that_is_dropped_is_opened_with_its_arrays(root: Path) -> None:
    dd.save(weighted(), root / "m.deodar")
    dropped = (root / "m.deodar").read_bytes()

    async def scene(p: Page) -> None:
        await p.open("open_package", name="m.deodar", content=base64.b64encode(dropped).decode())
        assert p.document["file"] == "" and p.document["title"] == "m"
        await p.do("save", path="mine.deodar")
        await p.do("open_package", name="cut.deodar", content=base64.b64encode(dropped[:300]).decode())
        await p.until(lambda: "file_problems" in p.said and p.said["file_problems"]["problems"])
        assert "damaged" in p.said["file_problems"]["problems"][0]["what"]

    with studio(root) as address:
        play(address, scene)
    assert dd.load(root / "mine.deodar").document == weighted().document


def test_a_document_with_a_function_is_shown_and_never_run_without_trust(
    root: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "strange_module.py").write_text(
        "from pathlib import Path\nPath(__file__).with_name('ran').touch()\ndef f(u, i, t): return u\n"
    )
    monkeypatch.syspath_prepend(str(tmp_path))
    document = {
        "deodar": 1,
        "name": "m",
        "elements": {"f": {"kind": "Function", "id": "00000001", "function": "strange_module:f"}},
    }
    (root / "stranger.json").write_text(json.dumps(document))

    async def scene(p: Page) -> None:
        await p.until(lambda: p.clock["failure"])
        (failure,) = p.clock["failure"]
        assert failure["trust"] and failure["fix"].startswith("Open it without them, or state your trust")
        assert (await p.ask("play"))["problems"][0]["trust"]
        assert not p.clock["running"]

    with studio(root, root / "stranger.json") as address:
        play(address, scene)
    assert not (tmp_path / "ran").exists()


def test_sensors_read_an_example_until_a_picture_is_dropped(root: Path) -> None:
    import base64
    import io

    from PIL import Image

    red = io.BytesIO()
    Image.new("RGB", (8, 6), (255, 0, 0)).save(red, "PNG")

    async def scene(p: Page) -> None:
        await p.runs()
        await p.until(lambda: p.clock["senses"])
        assert "example" in p.clock["world"]
        sensor = next(e for e in p.document["elements"] if e["kind"] == "Sensor")
        await p.do("watch", stream=1, element=sensor["id"], port="output", most=16)
        await p.do(
            "use_world_content",
            kind="Picture",
            name="red.png",
            content=base64.b64encode(red.getvalue()).decode(),
        )
        await p.until(lambda: "red.png" in p.clock["world"])
        await p.do("step")
        # a frame of the example may come before, and may be white there
        await p.until(lambda: 1 in p.frames and p.frames[1][1][8, 8].tolist() == [1, 0, 0])
        assert p.forms[1]["channels"] and p.frames[1][1].shape[-1] == 3 and p.frames[1][1][..., 1:].max() == 0
        refused = await p.ask("use_world_content", kind="Picture", name="no.png", content="%%")
        assert refused["problems"][0]["where"] == "no.png"

    with studio(root, root / "saliency.json") as address:
        play(address, scene)


def test_unsaved_edits_are_restored_after_a_crash(root: Path, own_state: Path) -> None:
    async def first(p: Page) -> None:
        await p.runs()
        await p.do("set", element=p.element("u"), parameter="tau", value=44)
        await asyncio.sleep(0)

    with studio(root, root / "selection.json") as address:
        play(address, first)
    note = next((own_state / "unsaved").glob("*.note"))
    # the process that stored them has ended
    note.write_text(json.dumps(json.loads(note.read_text()) | {"process": [0, 0]}))

    async def second(p: Page) -> None:
        kept = p.said["gallery"]["recoveries"]
        assert [k["title"] for k in kept] == ["selection"]
        await p.open("recover", name=kept[0]["name"])
        assert (
            p.document["elements"][0]["values"]["tau"] == 44
            and p.document["unsaved"]
            and p.document["file"] == "selection.json"
        )
        await p.do("save", replace=True)

    with studio(root) as address:
        play(address, second)
    assert dd.load(root / "selection.json").get("u.tau") == 44
    assert list((own_state / "unsaved").iterdir()) == []


def test_the_state_folder_is_accessed_outside_of_the_event_loop(
    root: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A network folder that does not respond must not block all pages."""
    used: set[str] = set()

    def beside(name: str, real: Any) -> Any:
        def call(*arguments: Any) -> Any:
            with pytest.raises(RuntimeError):
                asyncio.get_running_loop()
            used.add(name)
            return real(*arguments)

        return call

    names = ("store_edits", "forget", "stored_edits", "read", "opened", "recent")
    for name in names:
        monkeypatch.setattr(StateStore, name, beside(name, getattr(StateStore, name)))
    monkeypatch.setattr(hub, "STORE_SECONDS", 0.02)

    async def scene(p: Page) -> None:
        await p.runs()
        await p.do("set", element=p.element("u"), parameter="tau", value=33)
        await p.until(lambda: "store_edits" in used)
        await p.do("save")
        assert p.said["gallery"]["recent"] == ["node.json"]
        await p.do("close")
        assert (await p.ask("recover", name="0123456789abcdef"))["problems"]

    with studio(root, root / "node.json") as address:
        play(address, scene)
    assert used == set(names)


def test_a_stream_of_an_unknown_element_or_port_is_an_error(root: Path) -> None:
    async def scene(p: Page) -> None:
        await p.runs()
        await p.do("watch", stream=1, element="feedbeef", port="activation")
        await p.do("watch", stream=2, element=p.element("u"), port="nonsense")
        await p.until(lambda: {1, 2} <= set(p.lost))
        assert "no port" in p.lost[2]["problem"]["what"]
        await p.do("unwatch", stream=1)
        await p.do("unwatch", stream=1)

    with studio(root, root / "selection.json") as address:
        play(address, scene)
