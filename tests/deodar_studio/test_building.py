"""Building by mouse over a real socket: elements, connections, groups, the clipboard."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import deodar as dd
from tests.deodar_studio.page import Page, play, studio


def names(p: Page) -> set[str]:
    """Return the paths of all elements of the open document."""
    return {e["path"] for e in p.document["elements"]}


def wires(p: Page) -> set[tuple[str, str]]:
    """Return the paths of both elements of each connection."""
    path = {e["id"]: e["path"] for e in p.document["elements"]}
    return {(path[c["source"]], path[c["target"]]) for c in p.document["connections"]}


async def made(p: Page, type: str, **message: Any) -> list[str]:
    """Send a request that makes elements, and return their ids."""
    answer = await p.do(type, **message)
    return answer["made"]


def test_a_model_is_built_from_nothing_and_runs(root: Path) -> None:
    async def scene(p: Page) -> None:
        await p.open("new")
        assert p.document["elements"] == [] and p.document["file"] == ""
        (u,) = await made(p, "add_element", kind="Field", at=[10, 20])
        (s,) = await made(p, "add_element", kind="GaussianStimulus", target={"element": u}, at=[0, 0])
        assert names(p) == {"field", "gaussian_stimulus"} and wires(p) == {("gaussian_stimulus", "field")}
        assert p.document["layout"]["boxes"] == {u: {"x": 10, "y": 20}, s: {"x": 0, "y": 0}}
        assert p.document["undo"] == 2 and p.document["unsaved"] and p.document["problems"] == []
        await p.until(lambda: not p.clock["busy"])
        await p.do("watch", stream=1, element=u, port="activation")
        await p.do("speed", factor=None)
        await p.do("step", n=200)
        await p.until(lambda: 1 in p.frames and p.frames[1][0] == 200)
        assert p.frames[1][1].max() > 0 > p.frames[1][1].min(), "the field has a peak"
        await p.do("save", path="built")

    with studio(root) as address:
        play(address, scene)
    assert dd.load(root / "built.json").check() == []


def test_each_edit_is_one_step_of_undo(root: Path) -> None:
    async def scene(p: Page) -> None:
        await p.runs()
        u, left_id, right = p.element("u"), p.element("left"), p.element("right")
        before = p.document
        wire = {"source": left_id, "target": u}
        edits: list[tuple[str, dict[str, Any]]] = [
            ("add_element", {"kind": "Gain", "wire": wire, "at": [1, 2]}),
            ("disconnect", {"source": right, "target": u}),
            ("connect", {"source": u, "target": u, "source_port": "output", "target_port": "input"}),
            ("reconnect", {"old": {"source": u, "target": u}, "new": {"source": right, "target": u}}),
            ("rename", {"element": u, "name": "field"}),
            ("group", {"elements": [left_id, right], "name": "inputs", "at": [0, 0]}),
            ("rename", {"group": ["inputs"], "name": "stimuli"}),
            ("move_into", {"elements": [u], "group": ["stimuli"], "positions": {u: [5, 6]}}),
            ("ungroup", {"group": ["stimuli"]}),
            ("place", {"positions": {u: [3, 4]}}),
            ("remove", {"elements": [left_id], "connections": [{"source": right, "target": u}]}),
        ]
        for k, (type, message) in enumerate(edits):
            await p.do(type, **message)
            assert p.document["undo"] == k + 1, type
        assert names(p) == {"field", "right", "gain"} and wires(p) == {("gain", "field")}
        for _ in edits:
            await p.do("undo")
        assert {key: p.document[key] for key in before if key != "redo"} == {
            key: before[key] for key in before if key != "redo"
        }
        for _ in edits:
            await p.do("redo")
        assert names(p) == {"field", "right", "gain"} and p.document["redo"] == 0

    with studio(root, root / "selection.json") as address:
        play(address, scene)


def test_an_existing_element_and_a_moved_end_are_one_step_each(root: Path) -> None:
    async def scene(p: Page) -> None:
        await p.runs()
        u, left_id, right = p.element("u"), p.element("left"), p.element("right")
        wire = {"source": left_id, "target": u}
        (gain,) = await made(p, "add_element", kind="Gain", name="gain")
        await p.do("insert", element=gain, wire=wire, positions={gain: [5, 6]})
        assert wires(p) == {("left", "gain"), ("gain", "u"), ("right", "u")} and p.document["undo"] == 2
        assert p.document["layout"]["boxes"][gain] == {"x": 5, "y": 6}
        refused = await p.ask("insert", element=gain, wire={"source": gain, "target": u})
        assert "is an end of this connection" in refused["problems"][0]["what"]
        (v,) = await made(
            p,
            "add_element",
            kind="Field",
            name="v",
            source={"element": right},
            replaces={"source": right, "target": u},
        )
        assert wires(p) == {("left", "gain"), ("gain", "u"), ("right", "v")} and p.document["undo"] == 3
        assert next(e for e in p.document["elements"] if e["id"] == v)["name"] == "v"
        await p.do("undo")
        assert ("right", "u") in wires(p)

    with studio(root, root / "selection.json") as address:
        play(address, scene)


def test_what_makes_room_for_an_inserted_element_moves_in_the_same_step(root: Path) -> None:
    async def scene(p: Page) -> None:
        await p.runs()
        u, left_id = p.element("u"), p.element("left")
        await p.do("place", positions={u: [0, 0], left_id: [0, 200]})
        (note,) = await made(p, "comment", text="a note", at=[0, 100])
        before = p.document["layout"]
        (field,) = await made(
            p,
            "add_element",
            kind="Field",
            wire={"source": left_id, "target": u},
            at=[100, 200],
            positions={u: [112, 0], "gone": [1, 1]},
            comments={note: [112, 100], "gone": [1, 1]},
        )
        layout = p.document["layout"]
        assert layout["boxes"][u] == {"x": 112, "y": 0} and layout["boxes"][left_id] == {"x": 0, "y": 200}
        assert layout["boxes"][field] == {"x": 100, "y": 200} and "gone" not in layout["boxes"]
        assert layout["comments"] == {note: before["comments"][note] | {"x": 112}}
        await p.do("undo")
        assert p.document["layout"] == before and ("left", "u") in wires(p)
        await p.do("redo")
        assert p.document["layout"] == layout

    with studio(root, root / "selection.json") as address:
        play(address, scene)


def test_a_refused_edit_states_the_reason_and_changes_nothing(root: Path) -> None:
    async def scene(p: Page) -> None:
        await p.runs()
        u, left_id = p.element("u"), p.element("left")
        before = p.document
        refused: list[tuple[str, dict[str, Any], str]] = [
            ("connect", {"source": left_id, "target": u}, "already connected"),
            ("connect", {"source": u, "target": left_id}, "no input port"),
            ("connect", {"source": u, "source_port": "outptu", "target": u}, "does not exist"),
            ("disconnect", {"source": u, "target": u}, "not connected"),
            ("rename", {"element": u, "name": "left"}, "already an element"),
            ("rename", {"group": ["none"], "name": "x"}, "no group"),
            ("remove", {"elements": ["00000000"]}, "was removed"),
            ("add_element", {"kind": "Gaussian"}, "expected an element"),
            ("add_element", {"kind": "Field", "values": {"axes": 3}}, "not among the document's axes"),
            ("add_element", {"kind": "Gain", "wire": {"source": u, "target": u}}, "not connected"),
            ("group", {}, "nothing is selected"),
        ]
        for type, message, what in refused:
            answer = await p.ask(type, **message)
            assert what in answer["problems"][0]["what"], (type, answer)
            assert answer["made"] == [] and p.document["undo"] == 0
        assert p.document == before

    with studio(root, root / "selection.json") as address:
        play(address, scene)


def test_elements_are_copied_to_another_document(root: Path) -> None:
    async def scene(p: Page) -> None:
        await p.runs()
        answer = await p.do("copy", elements=[e["id"] for e in p.document["elements"]])
        document = json.loads(answer["text"])
        assert document["elements"].keys() == {"u", "left", "right"} and len(document["connections"]) == 2
        new = await made(p, "paste", text=answer["text"], at=[100, 100])
        assert names(p) == {"u", "left", "right", "u2", "left2", "right2"} and len(new) == 3
        assert len(p.document["connections"]) == 4
        await p.open("open_file", path="node.json", discard=True)
        before = names(p)
        await made(p, "paste", text=answer["text"], group=["other"])
        assert names(p) == before | {"other.u", "other.left", "other.right"}
        assert p.document["groups"] == [["other"]] and p.document["undo"] == 1
        for text in (
            "",
            "hello",
            '{"deodar": 3, "elements": {"u": {"kind": "Nothing"}}}',
            answer["text"][:99],
        ):
            refused = await p.ask("paste", text=text)
            assert "cannot be pasted" not in str(refused["problems"][0]["fix"])
            assert "can be pasted" in refused["problems"][0]["what"] and p.document["undo"] == 1

    with studio(root, root / "selection.json") as address:
        play(address, scene)


def test_a_pasted_function_runs_only_where_the_studio_was_started_with_trust(
    root: Path, tmp_path: Path, monkeypatch: Any
) -> None:
    (tmp_path / "pasted_module.py").write_text(
        "from pathlib import Path\nPath(__file__).with_name('ran').touch()\ndef f(u, i, t): return u\n"
    )
    monkeypatch.syspath_prepend(str(tmp_path))
    text = json.dumps({"deodar": 1, "elements": {"f": {"kind": "Function", "function": "pasted_module:f"}}})

    async def scene(p: Page) -> None:
        await p.runs()
        await made(p, "paste", text=text)
        await p.until(lambda: p.clock["failure"])
        (problem,) = p.clock["failure"]
        assert problem["trust"] and not problem["repair"] and "--" not in problem["what"] + problem["fix"]
        assert "pasted_module:f" in problem["what"]
        # a reader that is compiled for another port is no edit that can run
        await p.do("watch", stream=1, element=p.element("u"), port="output")
        await p.until(lambda: 1 in p.frames)
        assert p.clock["failure"]
        before = len(p.document["elements"])
        await p.do("open_without_functions")
        await p.until(lambda: len(p.document["elements"]) == before - 1)
        await p.until(lambda: not p.clock["failure"])
        await p.do("undo")
        await p.until(lambda: p.clock["failure"])
        await p.do("undo")
        await p.runs()
        await p.do("step", n=5)
        await p.until(lambda: p.clock["tick"] == 5)

    with studio(root, root / "selection.json") as address:
        play(address, scene)
    assert not (tmp_path / "ran").exists()

    async def trusted(p: Page) -> None:
        await p.runs()
        await made(p, "paste", text=text)
        await p.until(lambda: (tmp_path / "ran").exists())

    with studio(root, root / "selection.json", trust=True) as address:
        play(address, trusted)


def test_a_record_is_copied_from_and_not_built_on(root: Path) -> None:
    model = dd.load(root / "selection.json")
    dd.save_record(dd.simulate(model, 20, every=10), root / "record.zarr")

    async def scene(p: Page) -> None:
        await p.do("open_file", path="record.zarr")
        await p.until(lambda: p.document and p.document["record"])
        answer = await p.do("copy", elements=[p.element("u")])
        assert '"u"' in answer["text"]
        for type, message in (("add_element", {"kind": "Field"}), ("paste", {"text": answer["text"]})):
            refused = await p.ask(type, **message)
            assert "record" in refused["problems"][0]["what"]

    with studio(root) as address:
        play(address, scene)


def test_the_page_learns_what_a_port_can_be_connected_with(root: Path) -> None:
    async def scene(p: Page) -> None:
        await p.runs()
        u, left_id = p.element("u"), p.element("left")
        await p.do("fits", element=left_id)
        found = p.said["fitting"]
        assert found["element"] == left_id and [f["element"] for f in found["ports"]] == [u]
        assert found["ports"][0]["reason"] == "they are connected already"
        assert {"kind": "Field", "port": "input"} in found["kinds"]
        axis = {"name": "y", "lower": 0, "upper": 100, "samples": 51}
        (v,) = await made(p, "add_element", kind="Field", name="v", values={"axes": [axis]})
        await p.do("fits", element=u, port="output")
        port = next(f for f in p.said["fitting"]["ports"] if f["element"] == v)
        assert not port["fits"] and "axes are missing on both sides" in port["reason"]
        offer = port["offers"][0]
        assert offer == {"kind": "Project", "values": {"axes": ["y"], "rename": {"x": "y"}}, "note": ""}
        ends = {"source": {"element": u, "port": "output"}, "target": {"element": v}}
        await made(p, "add_element", kind=offer["kind"], values=offer["values"], **ends)
        assert not [q for q in p.document["problems"] if q["severity"] == "problem"]
        assert wires(p) >= {("u", "project"), ("project", "v")}
        assert "no port" in (await p.ask("fits", element=u, port="x"))["problems"][0]["what"]

    with studio(root, root / "selection.json") as address:
        play(address, scene)


def test_one_parameter_of_several_elements_is_set_in_one_step(root: Path) -> None:
    async def scene(p: Page) -> None:
        await p.runs()
        both = [p.element("left"), p.element("right")]
        for value in (3, 4, 5):
            done = await p.do("set_many", elements=both, parameter="amplitude", value=value, gesture=1)
            assert done["cost"] == "live"
        await p.until(lambda: [e["values"]["amplitude"] for e in p.document["elements"][1:]] == [5, 5])
        assert p.document["undo"] == 1
        refused = await p.ask("set_many", elements=[*both, p.element("u")], parameter="amplitude", value=9)
        assert "amplitude" in refused["problems"][0]["what"] and p.document["undo"] == 1
        assert [e["values"]["amplitude"] for e in p.document["elements"][1:]] == [5, 5]

    with studio(root, root / "selection.json") as address:
        play(address, scene)


def test_an_axis_changes_for_all_elements_that_have_it(root: Path) -> None:
    async def scene(p: Page) -> None:
        await p.runs()
        axis = {"name": "place", "lower": -50, "upper": 50, "samples": 201, "unit": "mm"}
        assert (await p.do("change_axis", key="x", axis=axis))["cost"] == "recompile"
        (only,) = p.document["axes"]
        assert (only["name"], only["samples"], only["unit"]) == ("place", 201, "mm")
        assert [e["values"]["axes"] for e in p.document["elements"]] == [["place"]] * 3
        assert p.document["problems"] == []
        await p.until(lambda: p.said.get("checked", {}).get("version") == p.said["opened"]["version"])
        (warning,) = p.said["checked"]["problems"]
        assert (warning["where"], warning["severity"]) == ("right", "warning")
        assert "its center 70 lies outside the axis 'place'" in warning["what"]
        for key, bad, what in (
            ("x", axis, "has no axis"),
            ("place", axis | {"samples": -1}, "samples"),
            ("place", {"name": "x"}, "needs lower"),
            ("place", axis | {"colour": 1}, "colour"),
        ):
            refused = await p.ask("change_axis", key=key, axis=bad)
            assert what in refused["problems"][0]["what"], refused
        await p.do("set", element=p.element("u"), parameter="axes", value=[axis | {"name": "other"}])
        assert [a["key"] for a in p.document["axes"]] == ["other", "place"]

    with studio(root, root / "selection.json") as address:
        play(address, scene)


def test_an_axis_is_added_used_and_removed_each_as_one_step_of_undo(root: Path) -> None:
    async def scene(p: Page) -> None:
        await p.open("new")
        steps = p.document["undo"]
        y = {"name": "y", "lower": 0, "upper": 10, "samples": 21, "unit": "mm"}
        await p.do("add_axis", axis=y)
        assert [a["key"] for a in p.document["axes"]] == ["y"] and p.document["undo"] == steps + 1
        assert "already has" in (await p.ask("add_axis", axis=y))["problems"][0]["what"]
        (u,) = await made(p, "add_element", kind="Field", name="u", values={"axes": ["y"]})
        z = {"name": "z", "lower": 0, "upper": 5, "samples": 11}
        await p.do("set", element=u, parameter="axes", value=["y", z])
        assert [a["key"] for a in p.document["axes"]] == ["y", "z"] and p.document["undo"] == steps + 3
        await p.do("remove_axis", key="y")
        assert p.document["elements"][0]["values"]["axes"] == ["z"]
        await p.do("undo")
        assert p.document["elements"][0]["values"]["axes"] == ["y", "z"]
        assert "no axis 'w'" in (await p.ask("remove_axis", key="w"))["problems"][0]["what"]
        await p.do("describe", time_unit="s")
        assert p.document["time_unit"] == "s"
        await p.do("undo")
        assert p.document["time_unit"] == "ms"
        assert "time_unit is" in (await p.ask("describe", time_unit="years"))["problems"][0]["what"]

    with studio(root, None) as address:
        play(address, scene)


def test_every_kind_of_the_palette_is_added_to_an_empty_document(root: Path) -> None:
    async def scene(p: Page) -> None:
        await p.open("new")
        kinds = [k["name"] for k in p.said["welcome"]["kinds"] if k["room"] in ("elements", "couplings")]
        assert {"Field", "Gain", "Sensor", "Motor"} <= set(kinds)
        for kind in kinds:
            await made(p, "add_element", kind=kind)
            assert [e["kind"] for e in p.document["elements"]] == [kind]
            await p.do("undo")

    with studio(root) as address:
        play(address, scene)


def test_a_sensor_without_a_world_is_unfinished_and_runs_when_a_world_is_chosen(root: Path) -> None:
    async def scene(p: Page) -> None:
        await p.open("new")
        await p.do("use_world", kind="Arena", path="blocks")
        (u,) = await made(p, "add_element", kind="Field")
        await p.do("speed", factor=None)
        await p.do("step", n=5)
        await p.until(lambda: p.clock["tick"] == 5 and not p.clock["busy"])

        # one that the chosen world does not have, and an example does
        (eye,) = await made(p, "add_element", kind="Sensor", name="eye", values={"sensor": "picture"})
        assert p.document["problems"] == [] and p.clock["senses"]
        await p.until(lambda: p.clock["world"] == "Picture: an example" and p.clock["tick"] == 5)
        await p.do("undo")

        # one that no world has
        (lost,) = await made(
            p, "add_element", kind="Sensor", name="lost", values={"sensor": "nothing", "axes": []}
        )
        (problem,) = p.document["problems"]
        assert problem["element"] == lost and "'nothing'" in problem["what"]
        assert problem["world"] and p.clock["senses"]
        await p.do("set", element=u, parameter="tau", value=33.0)
        await p.until(lambda: p.said.get("checked", {}).get("version") == p.said["opened"]["version"])
        assert p.said["checked"]["problems"] == [problem], "the check keeps the problem"
        await p.do("step", n=5)
        await p.until(lambda: p.clock["tick"] == 10)

        # another one: the present document can run in its world, so the run continues
        await p.do("set", element=lost, parameter="sensor", value="touching")
        assert p.document["problems"] == []
        await p.until(lambda: p.clock["world"] == "Arena: blocks" and p.clock["tick"] == 10)
        await p.do("remove", elements=[lost])

        # axes over which the example can be read are the default
        (eye,) = await made(p, "add_element", kind="Sensor", name="eye", values={"sensor": "picture"})
        await p.do("watch", stream=1, element=eye, port="output")
        await p.do("step", n=1)
        await p.until(lambda: 1 in p.frames and p.frames[1][1].max() > 0)
        assert p.clock["failure"] == [] and p.clock["world"] == "Picture: an example"

        # the present document cannot run in the world of the next one: the run starts again
        await p.do("set", element=eye, parameter="sensor", value="nothing")
        await p.do("set", element=eye, parameter="axes", value=[])
        await p.do("set", element=eye, parameter="sensor", value="touching")
        await p.until(lambda: p.clock["world"] == "Arena: blocks" and p.clock["tick"] == 0)
        await p.do("step", n=1)
        await p.until(lambda: p.clock["tick"] == 1 and p.clock["failure"] == [])

    with studio(root) as address:
        play(address, scene)


def test_sensors_and_motors_of_the_world_are_offered_and_are_never_a_problem(root: Path) -> None:
    def offered(p: Page) -> dict[str, list[str]]:
        worlds = p.said["offered_signals"]["worlds"]
        return {w["world"]: [f"{s['kind']} {s['title']}" for s in w["signals"]] for w in worlds}

    async def scene(p: Page) -> None:
        await p.open("new")
        await p.until(lambda: "offered_signals" in p.said)
        assert {"Arena", "Eye", "Picture"} <= offered(p).keys() and "Camera" not in offered(p)
        assert {"Sensor Infrared, 8 samples", "Sensor Touching", "Motor Left wheel"} <= set(
            offered(p)["Arena"]
        )
        assert offered(p)["Picture"] == ["Sensor Picture, 16 x 16 x 3 samples"]
        arena = next(w for w in p.said["offered_signals"]["worlds"] if w["world"] == "Arena")
        for signal in arena["signals"]:
            await made(p, "add_element", kind=signal["kind"], name=signal["name"], values=signal["values"])
        assert p.document["problems"] == []
        await p.until(lambda: list(offered(p)) == ["Arena: an example"])
        await p.runs()
        await p.do("step", n=2)
        await p.until(lambda: p.clock["tick"] == 2 and p.clock["failure"] == [])

        await p.open("new", discard=True)
        await p.do("use_world", kind="Arena", path="blocks")
        await p.until(lambda: list(offered(p)) == ["Arena: blocks"])
        for kind in ("Sensor", "Motor", "Sensor", "Motor"):  # whatever is there first
            await made(p, "add_element", kind=kind)
            assert p.document["problems"] == [], kind

    with studio(root) as address:
        play(address, scene)


def test_a_document_without_a_title_gets_the_name_of_its_file(root: Path) -> None:
    async def scene(p: Page) -> None:
        await p.open("new")
        assert p.document["title"] == "untitled"
        await p.do("save", path="maze")
        assert (p.document["title"], p.document["file"], p.document["unsaved"]) == (
            "maze",
            "maze.json",
            False,
        )
        assert dd.load(root / "maze.json").name == "maze"
        await p.do("list_folder")
        size, changed = p.said["folder"]["facts"]["maze.json"]
        stated = (root / "maze.json").stat()
        assert (size, changed) == (stated.st_size, stated.st_mtime)
        await p.do("describe", name="my model")
        await p.do("save", path="other")
        assert p.document["title"] == "my model"

    with studio(root) as address:
        play(address, scene)


def test_the_first_save_keeps_redo_and_the_snapshots_of_the_document(root: Path) -> None:
    async def scene(p: Page) -> None:
        await p.open("new")
        await p.do("add_element", kind="Field", name="u")
        await p.do("add_element", kind="Field", name="v")
        await p.do("undo")
        await p.runs()
        await p.do("step", n=2)
        await p.until(lambda: p.clock["tick"] == 2)
        await p.do("save_snapshot", name="first")
        await p.do("save_preset", name="values")
        before = p.document["undo"], p.document["redo"]
        assert before == (1, 1)
        await p.do("save", path="maze")
        assert (p.document["undo"], p.document["redo"]) == before
        await p.until(lambda: [s["name"] for s in p.said["saved_files"]["snapshots"]] == ["first"])
        assert [s["path"] for s in p.said["saved_files"]["presets"]] == ["presets/maze/values.json"]
        await p.do("return_to", name="first")
        await p.do("undo")
        assert p.document["title"] == "maze" and p.document["elements"] == []
        await p.do("redo")
        await p.do("redo")
        assert p.document["title"] == "maze" and [e["path"] for e in p.document["elements"]] == ["u", "v"]

    with studio(root) as address:
        play(address, scene)


def test_every_template_is_added_as_a_group(root: Path) -> None:
    async def scene(p: Page) -> None:
        await p.open("new")
        listed = p.said["welcome"]["templates"]
        rooms = {
            room: [t["name"] for t in listed if t["room"] == room] for room in ("architectures", "examples")
        }
        assert {"behaviour", "saliency", "serial_order"} <= set(rooms["architectures"])
        assert "selection" in rooms["examples"] and all(t["title"] and t["sentence"] for t in listed)
        pictures = {t["name"]: t["picture"] for t in listed}
        assert pictures["selection"] == "examples/selection.png" and pictures["feature_space"] == ""
        for template in (t["name"] for t in listed):
            answer = await p.do("add_template", name=template)
            assert answer["group"] == [template] and answer["made"]
            worldly = [q["what"] for q in p.document["problems"] if "world" in q["what"]]
            assert worldly == [], template
            await p.do("undo")
        for template in ("behaviour", "selection"):
            answer = await p.do("add_template", name=template, at=[100, 50])
            assert answer["group"] == [template] and answer["made"]
            boxes = [p.document["layout"]["boxes"][i] for i in answer["made"]]
            assert (min(b["x"] for b in boxes), min(b["y"] for b in boxes)) == (100, 50)
        again = await p.do("add_template", name="behaviour", group=["behaviour"])
        assert again["group"] == ["behaviour", "behaviour"] and p.document["undo"] == 3
        assert not [q for q in p.document["problems"] if q["severity"] == "problem"]
        refused = await p.ask("add_template", name="behavior")
        assert "behaviour" in refused["problems"][0]["fix"]

    with studio(root) as address:
        play(address, scene)


def test_comments_have_no_effect_on_the_model(root: Path) -> None:
    async def scene(p: Page) -> None:
        await p.runs()
        (one,) = await made(p, "comment", text="the winner", at=[1, 2])
        await p.do("comment", comment=one, size=[100, 50])
        (two,) = await made(p, "comment", text="another", at=[5, 5])
        assert p.document["layout"]["comments"][one] == {
            "text": "the winner",
            "x": 1,
            "y": 2,
            "width": 100,
            "height": 50,
        }
        assert not p.clock["busy"] and p.document["undo"] == 3 and p.document["unsaved"]
        await p.do("comment", comment=two, remove=True)
        await p.do("comment", comment=one, remove=True)
        assert p.document["layout"]["comments"] == {}
        assert "no comment" in (await p.ask("comment", comment=one, text="x"))["problems"][0]["what"]

    with studio(root, root / "selection.json") as address:
        play(address, scene)


def test_an_unfinished_document_is_saved_opened_again_and_completed(root: Path) -> None:
    async def first(p: Page) -> None:
        await p.open("new")
        await made(p, "add_element", kind="Gain")
        assert "nothing is connected" in p.document["problems"][0]["what"]
        await p.do("save", path="half")

    async def second(p: Page) -> None:
        await p.until(lambda: p.document)
        gain = p.element("gain")
        assert "nothing is connected" in p.document["problems"][0]["what"]
        assert p.said["file_problems"]["problems"] == [] and not p.clock["busy"]
        refused = await p.ask("play")
        assert "nothing is connected" in refused["problems"][0]["what"]
        await made(p, "add_element", kind="Field", target={"element": gain})
        await p.runs()
        await p.do("step", n=5)
        await p.until(lambda: p.clock["tick"] == 5 and not p.clock["failure"])

    with studio(root) as address:
        play(address, first)
    with studio(root, root / "half.json") as address:
        play(address, second)


def test_the_last_valid_document_keeps_running_while_others_have_problems(root: Path) -> None:
    async def scene(p: Page) -> None:
        await p.runs()
        u = p.element("u")
        await p.do("play")
        (g,) = await made(p, "add_element", kind="Gain")
        (s,) = await made(p, "add_element", kind="Sigmoid")
        assert any(q["severity"] == "problem" for q in p.document["problems"])
        before = p.clock["tick"]
        await p.until(lambda: p.clock["tick"] > before + 20 and p.clock["running"])
        await p.do("connect", source=u, target=g)
        await p.do("connect", source=g, target=s)
        await p.do("watch", stream=1, element=s, port="output")
        await p.until(lambda: 1 in p.frames and p.clock["running"])
        assert p.clock["failure"] == [] and p.clock["tick"] > before, "the states and the time have stayed"

    with studio(root, root / "selection.json") as address:
        play(address, scene)


def test_an_edit_that_cannot_be_compiled_leaves_the_run_and_its_failure_ends_with_the_next_one(
    root: Path,
) -> None:
    text = json.dumps({"deodar": 1, "elements": {"f": {"kind": "Function", "function": "no_such_module:f"}}})

    async def scene(p: Page) -> None:
        await p.runs()
        await p.do("play")
        (f,) = await made(p, "paste", text=text)
        await p.until(lambda: p.clock["failure"])
        before = p.clock["tick"]
        await p.until(lambda: p.clock["tick"] > before + 20 and p.clock["running"])
        await p.do("remove", elements=[f])
        await p.until(lambda: not p.clock["failure"] and p.clock["running"])

    with studio(root, root / "selection.json", trust=True) as address:
        play(address, scene)


def test_the_script_of_the_open_document_makes_the_same_document(root: Path) -> None:
    async def scene(p: Page) -> None:
        await p.runs()
        await p.do("rename", element=p.element("u"), name="renamed")
        script = (await p.do("export_script"))["text"]
        await p.do("save", path="again.json")
        space: dict[str, Any] = {"__name__": "script"}
        exec(script, space)
        assert space["make"]().to_json() == (root / "again.json").read_text(encoding="utf-8")
        assert script.endswith('dd.save(make(), "selection.json")\n'), "the name of the file that was open"

    with studio(root, root / "selection.json") as address:
        play(address, scene)


def test_a_drag_of_a_strength_is_one_step_of_undo_and_1_leaves_the_document_as_it_was(root: Path) -> None:
    async def scene(p: Page) -> None:
        await p.runs()
        u, left_id = p.element("u"), p.element("left")
        before = p.document["connections"]
        (gain,) = await made(
            p, "set_strength", wire={"source": left_id, "target": u}, value=1.5, gesture=7, dragging=True
        )
        wire = {"source": left_id, "target": gain}
        for factor, dragging in ((1.0, True), (-3.0, True), (3.0, False)):
            assert await made(p, "set_strength", wire=wire, value=factor, gesture=7, dragging=dragging) == [
                gain
            ]
        assert p.document["undo"] == 1 and names(p) == {"u", "left", "right", "left>Gain"}
        assert next(e for e in p.document["elements"] if e["id"] == gain)["strength"] == "factor"
        await p.do("undo")
        assert p.document["connections"] == before and not p.document["unsaved"]
        await p.do("redo")
        assert await made(p, "set_strength", wire=wire, value=1.0) == []
        assert p.document["connections"] == before and not p.document["unsaved"]

    with studio(root, root / "selection.json") as address:
        play(address, scene)


def test_a_slider_that_changes_the_sign_of_a_coupling_changes_what_the_page_draws(root: Path) -> None:
    async def scene(p: Page) -> None:
        await p.runs()
        wire = {"source": p.element("left"), "target": p.element("u")}
        (gain,) = await made(p, "set_strength", wire=wire, value=2.0)

        def effect() -> str:
            return next(e for e in p.document["elements"] if e["id"] == gain)["effect"]

        await p.do("set", element=gain, parameter="factor", value=-2.0, gesture=1)
        assert effect() == "-"
        await p.do("set", element=gain, parameter="factor", value=2.0, gesture=1)
        assert effect() == "+" and p.document["undo"] == 1, "a drag that ends where it began is no step"

    with studio(root, root / "selection.json") as address:
        play(address, scene)


def test_the_usual_parameters_are_pinned_as_one_step_of_undo(root: Path) -> None:
    async def scene(p: Page) -> None:
        await p.do("pin_usual")
        pins = p.document["layout"]["pins"]
        paths = {e["id"]: e["path"] for e in p.document["elements"]}
        assert [f"{paths[pin['element']]}.{pin['parameter']}" for pin in pins][:3] == [
            "u.resting_level",
            "u.kernel.0.amplitude",
            "left.amplitude",
        ]
        assert len(pins) == 5 and p.document["undo"] == 1
        await p.do("undo")
        assert p.document["layout"]["pins"] == [] and not p.document["unsaved"]

    with studio(root, root / "selection.json") as address:
        play(address, scene)
