"""`deodar import FILE`."""

from __future__ import annotations

import deodar as dd
from deodar.importers import stored_report
from tests.command_line import typed
from tests.deodar_interop.importers.cosivina.files import SAMPLES, element, written
from tests.deodar_interop.importers.cosivina.scripts import launcher

SAMPLE = next(p for p in SAMPLES if "OneLayer" in p.stem)
FIELD = {"size": [1, 10], "tau": 10, "h": -5, "beta": 4}


def test_a_document_is_written_and_the_report_shown(tmp_path):
    command = typed("import", SAMPLE, "-o", out := tmp_path / "model.json")
    assert command.status == 0
    assert all(w in command.out for w in ("field u", "LateralInteractions1D", "0 dropped", "Written:"))
    document, report = dd.load(out).document, dd.read(SAMPLE).report
    assert stored_report.without_report(document) == dd.load(SAMPLE).document
    kept = stored_report.report_of(document)
    assert kept is not None and kept.summary() == report.summary()
    again = typed("import", SAMPLE, "-o", out)
    assert again.status == 1 and "exists already" in again.err
    assert typed("import", SAMPLE, "--force -o", out).status == 0


def test_import_without_out_writes_no_file(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    command = typed("import", SAMPLE)
    assert command.status == 0 and "field u" in command.out and not list(tmp_path.iterdir())


def test_json_contains_every_line_of_the_report():
    command = typed("import", SAMPLE, "--json")
    assert command.status == 0
    answer = command.json
    assert answer["tool"] == "cosivina" and answer["counts"]["dropped"] == 0 and not answer["problems"]
    assert {"where", "part", "what", "verdict", "why"} == set(answer["lines"][0])
    assert sum(answer["counts"].values()) == len(answer["lines"])
    elements = {line["where"]: line["element"] for line in answer["lines"] if line["part"] == "element"}
    assert elements["field u"] == dd.load(SAMPLE)["field u"].id


CAMERA = element("c", "CameraGrabber", {"deviceNumber": 1, "size": [3, 4]})


def test_strict_fails_on_anything_that_is_not_carried(tmp_path):
    out = tmp_path / "model.json"
    lossy = written(tmp_path, [CAMERA, element("u", "NeuralField", FIELD)])
    strict = typed("import --strict", lossy, "-o", out)
    assert strict.status == 1 and "reads a camera" in strict.out and not out.exists()
    assert typed("import", lossy, "-o", out).status == 0 and out.exists()
    assert typed("import --strict", SAMPLE).status == 0


def test_the_report_lists_each_loss_once_with_its_reason(tmp_path):
    lossy = written(tmp_path, [CAMERA, element("u", "NeuralField", {**FIELD, "depth": 3})])
    command = typed("import", lossy)
    assert command.status == 0
    rows = [line.split() for line in command.out.splitlines()]
    camera = [row[1:3] for row in rows if row[:1] == ["c"]]
    assert camera == [["CameraGrabber", "Placeholder:"], ["parameter", "deviceNumber"], ["parameter", "size"]]
    (depth,) = (row for row in rows if "depth" in row)
    assert depth[:4] == ["u", "parameter", "depth", "dropped"] and "no such parameter" in " ".join(depth)


def test_known_errors_are_reproduced_with_bugs(tmp_path):
    shape = {"size": [1, 9], "sigma": 1, "amplitude": 3, "position": 4, "circular": 1, "normalized": 1}
    path = written(tmp_path, [element("s", "TimedGaussStimulus1D", {**shape, "onTimes": [[0, 9]]})])
    for option, verdict in (("", "corrected"), ("--bugs", "reproduced")):
        command = typed("import", path, option)
        assert command.status == 0 and verdict in command.out
    assert dd.load(path).get("s.normalized") is True and dd.load(path, bugs=True).get("s.normalized") is False


def test_an_unreadable_file_is_an_error_of_one_line(tmp_path):
    (tmp_path / "x.json").write_text('{"simulator": {"elements"')
    command = typed("import", tmp_path / "x.json")
    assert command.status == 1 and "is not JSON" in command.err
    assert "Traceback" not in command.err and command.err.count("\n") == 1
    assert typed("import", tmp_path / "absent.json").status == 1


def test_a_launcher_is_written_with_its_sliders_and_presets(tmp_path):
    script = tmp_path / "launcherPair.m"
    script.write_text(
        launcher(
            "ParameterSlider('h', 'line', 'h', [-10, 0])",
            "ParameterSwitchButton('go', 'cue left', 'amplitude', 0, 6)",
        )
    )
    command = typed("import --strict", script, "-o", out := tmp_path / "pair.json")
    assert command.status == 0 and "8 elements" in command.out
    layout = dd.load(out).document.layout
    assert len(layout["pins"]) == 2 and len(layout["presets"]) == 2
    listing = typed("import --json", script)
    assert listing.status == 0
    lines = listing.json["lines"]
    assert [line["where"] for line in lines if line["part"] == "control"] == ["h", "go"]
    script.write_text("sim = Simulator();\nq = 3")
    refused = typed("import", script)
    assert refused.status == 1 and "builds no simulator of cosivina" in refused.err
