"""Files of other tools in the studio: opened as documents without a file, and applied as presets."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Any

from deodar.couplings.weights import Weights
from deodar.parameters import FrozenArray
from deodar_studio.files import content
from deodar_studio.files.workspace import Workspace
from tests.deodar_interop.importers.cosivina.files import element, text, written
from tests.deodar_interop.importers.cosivina.scripts import PAIR, built, launcher, parameters
from tests.deodar_interop.importers.dnf_composer.files import HERE as SIMULATIONS
from tests.deodar_studio.page import Page, play, studio

FIELD = {"size": [1, 10], "tau": 10, "h": -5, "beta": 4}
KERNEL = {"size": [1, 10], "sigma": 2, "amplitude": 1, "circular": 1, "normalized": 1, "cutoffFactor": 5}


def parts(**changes: Any) -> list[dict[str, Any]]:
    return [
        element("u", "NeuralField", FIELD | changes, [("k", "output")]),
        element("k", "GaussKernel1D", KERNEL, [("u", "output")]),
    ]


def test_a_file_of_another_tool_opens_runs_and_accepts_a_preset(tmp_path: Path) -> None:
    written(tmp_path, parts(), name="simulator.json")
    written(
        tmp_path, [*parts(h=-3)[:1], element("new", "BoostStimulus", {"amplitude": 1})], name="preset.json"
    )
    before = (tmp_path / "simulator.json").read_bytes()

    async def scene(p: Page) -> None:
        opened = await p.do("open_file", path="simulator.json")
        await p.runs()
        assert opened["imported"].startswith("Imported from simulator.json (cosivina): 2 elements")
        assert p.document["notes"].startswith(opened["imported"])
        assert {e["path"] for e in p.document["elements"]} == {"u", "k"} and "cosivina" in p.document["notes"]
        await p.do("step", n=5)
        await p.until(lambda: p.clock["tick"] == 5)
        assert (await p.ask("save"))["problems"]  # it has no file of its own yet
        answer = await p.do("apply_preset", path="preset.json")
        assert answer["carried"] == 1
        assert [line.split(":")[0] for line in answer["unmatched"]] == ["k", "new"]
        await p.do("watch", stream=1, element=p.element("u"), port="activation")
        await p.do("step", n=400)
        await p.until(lambda: 1 in p.frames and abs(p.frames[1][1] + 3).max() < 0.01)
        await p.do("undo")
        await p.do("step", n=400)
        await p.until(lambda: abs(p.frames[1][1] + 5).max() < 0.01)
        assert (await p.ask("apply_preset", path="absent.json"))["problems"]
        await p.do("save", path="own.json")

    with studio(tmp_path) as address:
        play(address, scene)
    assert (tmp_path / "simulator.json").read_bytes() == before
    assert '"deodar"' in (tmp_path / "own.json").read_text()


def test_the_report_of_an_import_is_a_message_and_is_saved_with_the_document(tmp_path: Path) -> None:
    written(tmp_path, parts(h="high", colour="red"), name="simulator.json")

    def losses(p: Page) -> list[tuple[str, str, str]]:
        lines = p.said["import_report"]["lines"]
        return [(x["element"], x["what"], x["verdict"]) for x in lines if x["verdict"] != "carried"]

    async def scene(p: Page) -> None:
        assert p.said["import_report"] == {
            "type": "import_report",
            "tool": "",
            "file": "",
            "lines": [],
            "bugs": [],
        }
        await p.open("open_file", path="simulator.json")
        found, u = p.said["import_report"], p.element("u")
        assert (found["tool"], found["file"]) == ("cosivina", "simulator.json")
        assert losses(p) == [(u, "h", "approximated"), (u, "colour", "dropped")]
        assert {x["element"] for x in found["lines"]} == {"", u, p.element("k")}
        assert "import_report" not in p.document["layout"]
        script = (await p.do("export_script"))["text"]
        assert "import_report" not in script and "Imported from" in script
        sent = [m["type"] for m in p.all].count("import_report")
        await p.do("rename", element=u, name="v")
        await p.do("arrange", layout={"pins": []}, undoable=True)
        assert [m["type"] for m in p.all].count("import_report") == sent, "it is sent once"
        await p.do("save", path="own.json")
        await p.do("close")
        assert p.said["import_report"]["tool"] == ""
        await p.open("open_file", path="own.json")
        assert losses(p) == [(p.element("v"), "h", "approximated"), (p.element("v"), "colour", "dropped")]
        assert p.said["import_report"] == found

    with studio(tmp_path) as address:
        play(address, scene)


def test_the_report_is_removed_from_the_document_as_one_step_of_undo(tmp_path: Path) -> None:
    async def scene(p: Page) -> None:
        await p.open("open_text", name="simulator.json", text=text(parts(colour="red")))
        before = p.said["import_report"]
        assert before["lines"]
        await p.do("arrange", layout={"import_report": None}, undoable=True)
        assert p.said["import_report"]["lines"] == [] and p.document["unsaved"]
        await p.do("undo")
        assert p.said["import_report"] == before and not p.document["unsaved"]

    with studio(tmp_path) as address:
        play(address, scene)


def test_a_file_of_another_tool_may_be_dropped(tmp_path: Path) -> None:
    async def scene(p: Page) -> None:
        opened = await p.do("open_text", name="simulator.json", text=text(parts()))
        await p.runs()
        assert "2 elements" in opened["imported"]
        assert {e["path"] for e in p.document["elements"]} == {"u", "k"}
        answer = await p.do("apply_preset_text", name="preset.json", text=text(parts(h=-3, beta=2)))
        assert (answer["carried"], answer["unmatched"]) == (2, [])
        await p.until(lambda: p.document["undo"] == 1)
        assert (await p.ask("apply_preset_text", name="preset.json", text="{"))["problems"]
        broken = await p.do("open_text", name="preset.json", text=text(parts())[:-1], discard=True)
        assert broken["imported"] == "" and p.said["file_problems"]["problems"]

    with studio(tmp_path) as address:
        play(address, scene)


def value(p: Page, path: str, name: str) -> Any:
    """Return the value of a parameter in the document of a page."""
    return next(e["values"][name] for e in p.document["elements"] if e["path"] == path)


def test_a_launcher_of_cosivina_opens_with_pins_and_presets(tmp_path: Path) -> None:
    sim, _ = built(PAIR)
    sim.elements["line"].values["h"] = -7
    (tmp_path / "calm.json").write_bytes(parameters(sim))
    (tmp_path / "launcherPair.m").write_text(
        launcher(
            "ParameterSlider('rest', {'cue left', 'cue right'}, {'amplitude', 'amplitude'}, [0, 9])",
            "ParameterSwitchButton('go', 'line', 'tau', 20, 40)",
            "PresetSelector('Select', gui, '', {'calm.json'}, {'calm'})",
        )
    )

    async def scene(p: Page) -> None:
        opened = await p.do("open_file", path="launcherPair.m")
        assert opened["imported"].startswith("Imported from launcherPair.m (cosivina): 8 elements")
        layout = p.document["layout"]
        assert [pin["parameter"] for pin in layout["pins"]] == ["rest", "tau"]
        assert [preset["name"] for preset in layout["presets"]] == ["go: off", "go: on", "calm"]
        answer = await p.do("apply_kept_preset", name="go: on")
        assert (answer["carried"], answer["unmatched"]) == (1, [])
        await p.until(lambda: value(p, "line", "tau") == 40)
        assert (await p.do("apply_kept_preset", name="calm"))["carried"] == 2  # tau and the resting level
        await p.until(lambda: value(p, "line", "resting_level") == -7 and value(p, "line", "tau") == 20)
        await p.do("undo")
        await p.until(lambda: value(p, "line", "tau") == 40)
        problems = (await p.ask("apply_kept_preset", name="calms"))["problems"]
        assert "no preset 'calms'" in problems[0]["what"]
        await p.do("save", path="own.json")

    with studio(tmp_path) as address:
        play(address, scene)
    listed = Workspace(tmp_path).listed("").files
    assert listed == ["calm.json", "launcherPair.m", "own.json"]
    assert '"go: on"' in (tmp_path / "own.json").read_text()


def test_a_dropped_launcher_reports_the_files_that_were_not_dropped_with_it(tmp_path: Path) -> None:
    async def scene(p: Page) -> None:
        text = launcher("PresetSelector('Select', gui, '', {'calm.json'}, {'calm'})")
        opened = await p.do("open_text", name="launcherPair.m", text=text)
        assert "8 elements" in opened["imported"] and p.document["layout"]["presets"] == []
        assert "preset calm: dropped" in p.document["notes"]

    with studio(tmp_path) as address:
        play(address, scene)


def test_a_folder_lists_files_of_dnf_composer_and_one_opens_with_its_weights(tmp_path: Path) -> None:
    shutil.copyfile(SIMULATIONS / "all-elements.dnf", tmp_path / "a.dnf")
    shutil.copyfile(SIMULATIONS / "field coupling_weights.txt", tmp_path / "field coupling_weights.txt")
    space = Workspace(tmp_path)
    assert space.listed("").files == ["a.dnf"]
    document = content.load(space, tmp_path / "a.dnf")
    coupling = next(e.element for e in document.entries if e.path == "field coupling")
    assert isinstance(coupling, Weights) and isinstance(coupling.weights, FrozenArray)
    assert coupling.weights.data.any()
