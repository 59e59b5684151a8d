"""`deodar import FILE`."""

from __future__ import annotations

import json

import deodar as dd
from deodar.cli import main
from deodar.importers import stored_report
from tests.deodar_interop.importers.cosivina.files import SAMPLES, element, written
from tests.deodar_interop.importers.cosivina.scripts import launcher

SAMPLE = next(p for p in SAMPLES if "OneLayer" in p.stem)
FIELD = {"size": [1, 10], "tau": 10, "h": -5, "beta": 4}


def test_a_document_is_written_and_the_report_shown(tmp_path, capsys):
    out = tmp_path / "model.json"
    assert main(["import", str(SAMPLE), "-o", str(out)]) == 0
    printed = capsys.readouterr().out
    assert (
        "field u" in printed
        and "LateralInteractions1D" in printed
        and "0 dropped" in printed
        and "Written:" in printed
    )
    document, report = dd.load(out).document, dd.read(SAMPLE).report
    assert stored_report.without_report(document) == dd.load(SAMPLE).document
    kept = stored_report.report_of(document)
    assert kept is not None and kept.summary() == report.summary()
    assert main(["import", str(SAMPLE), "-o", str(out)]) == 1
    assert "exists already" in capsys.readouterr().err
    assert main(["import", str(SAMPLE), "-o", str(out), "--force"]) == 0


def test_import_without_out_writes_no_file(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert main(["import", str(SAMPLE)]) == 0
    assert "field u" in capsys.readouterr().out and not list(tmp_path.iterdir())


def test_json_contains_every_line_of_the_report(capsys):
    assert main(["import", str(SAMPLE), "--json"]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert answer["tool"] == "cosivina" and answer["counts"]["dropped"] == 0 and not answer["problems"]
    assert {"where", "part", "what", "verdict", "why"} == set(answer["lines"][0])
    assert sum(answer["counts"].values()) == len(answer["lines"])
    elements = {line["where"]: line["element"] for line in answer["lines"] if line["part"] == "element"}
    assert elements["field u"] == dd.load(SAMPLE)["field u"].id


def test_strict_fails_on_anything_that_is_not_carried(tmp_path, capsys):
    out = tmp_path / "model.json"
    lossy = written(
        tmp_path,
        [
            element("c", "CameraGrabber", {"deviceNumber": 1, "size": [3, 4]}),
            element("u", "NeuralField", FIELD),
        ],
    )
    assert main(["import", str(lossy), "-o", str(out), "--strict"]) == 1 and not out.exists()
    assert "reads a camera" in capsys.readouterr().out
    assert main(["import", str(lossy), "-o", str(out)]) == 0 and out.exists()
    assert main(["import", str(SAMPLE), "--strict"]) == 0
    capsys.readouterr()


def test_the_report_lists_each_loss_once_with_its_reason(tmp_path, capsys):
    lossy = written(
        tmp_path,
        [
            element("c", "CameraGrabber", {"deviceNumber": 1, "size": [3, 4]}),
            element("u", "NeuralField", {**FIELD, "depth": 3}),
        ],
    )
    assert main(["import", str(lossy)]) == 0
    rows = [line.split() for line in capsys.readouterr().out.splitlines()]
    camera = [row[1:3] for row in rows if row[:1] == ["c"]]
    assert camera == [["CameraGrabber", "Placeholder:"], ["parameter", "deviceNumber"], ["parameter", "size"]]
    (depth,) = (row for row in rows if "depth" in row)
    assert depth[:4] == ["u", "parameter", "depth", "dropped"] and "no such parameter" in " ".join(depth)


def test_known_errors_are_reproduced_with_bugs(tmp_path, capsys):
    param = {
        "size": [1, 9],
        "sigma": 1,
        "amplitude": 3,
        "position": 4,
        "circular": 1,
        "normalized": 1,
        "onTimes": [[0, 9]],
    }
    path = written(tmp_path, [element("s", "TimedGaussStimulus1D", param)])
    assert main(["import", str(path)]) == 0 and "corrected" in capsys.readouterr().out
    assert main(["import", str(path), "--bugs"]) == 0 and "reproduced" in capsys.readouterr().out
    assert dd.load(path).get("s.normalized") is True and dd.load(path, bugs=True).get("s.normalized") is False


def test_an_unreadable_file_is_an_error_of_one_line(tmp_path, capsys):
    (tmp_path / "x.json").write_text('{"simulator": {"elements"')
    assert main(["import", str(tmp_path / "x.json")]) == 1
    error = capsys.readouterr().err
    assert "is not JSON" in error and "Traceback" not in error and error.count("\n") == 1
    assert main(["import", str(tmp_path / "absent.json")]) == 1


def test_a_launcher_is_written_with_its_sliders_and_presets(tmp_path, capsys):
    script = tmp_path / "launcherPair.m"
    script.write_text(
        launcher(
            "ParameterSlider('h', 'line', 'h', [-10, 0])",
            "ParameterSwitchButton('go', 'cue left', 'amplitude', 0, 6)",
        )
    )
    out = tmp_path / "pair.json"
    assert main(["import", str(script), "-o", str(out), "--strict"]) == 0
    assert "8 elements" in capsys.readouterr().out
    layout = dd.load(out).document.layout
    assert len(layout["pins"]) == 2 and len(layout["presets"]) == 2
    assert main(["import", str(script), "--json"]) == 0
    lines = json.loads(capsys.readouterr().out)["lines"]
    assert [line["where"] for line in lines if line["part"] == "control"] == ["h", "go"]
    script.write_text("sim = Simulator();\nq = 3")
    assert main(["import", str(script)]) == 1
    assert "builds no simulator of cosivina" in capsys.readouterr().err
