"""A record is repeated from its provenance."""

from __future__ import annotations

import importlib
import json
import re
import sys
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import deodar as dd
from deodar.architectures.saliency import saliency
from deodar.batch.simulate import simulate
from deodar.cli import main
from deodar.elements.function import Function
from deodar.recording import files
from deodar.recording.provenance import KEY, document
from deodar.recording.record import about
from deodar.recording.repeat import _world, compare, repeat
from deodar.worlds.picture import Picture
from tests.deodar.recording.models import record, x


@pytest.mark.parametrize(
    "settings", [{}, {"trials": [2, 5], "sweep": {"u.tau": [8.0, 12.0]}, "precision": "float64"}]
)
def test_a_repetition_on_the_same_machine_has_the_same_bits(
    settings: dict[str, object], tmp_path: Path
) -> None:
    recorded = record(**settings)
    done = repeat(files.load_record(files.save_record(recorded, tmp_path / "record.zarr")), simulate)
    assert (
        done.same_bits
        and not done.differences
        and done.faithful
        and done.data.drop_attrs().identical(recorded.drop_attrs())
    )


@pytest.mark.parametrize(("version", "port"), [(2, "output"), (3, "activation")])
def test_the_path_of_a_field_has_the_meaning_of_the_version_of_the_record(version: int, port: str) -> None:
    recorded = dd.simulate(dd.Model(document=document(about(record()))), 5, record=f"u.{port}")
    provenance = about(recorded)
    provenance |= {"record": ["u"], "document": provenance["document"] | {"deodar": version}}
    assert repeat(recorded.assign_attrs({KEY: json.dumps(provenance)}), simulate).same_bits


def test_differences_of_versions_and_machine_are_listed() -> None:
    recorded = record()
    provenance = about(recorded)
    provenance["made_by"]["jaxlib"] = "0.0.1"
    provenance["made_by"]["machine"] = "another"
    changed = recorded.copy()
    changed["u.activation"] = recorded["u.activation"] + 0.25
    changed = changed.assign_attrs({KEY: json.dumps(provenance)})
    done = repeat(changed, simulate)
    assert not done.same_bits and done.faithful and done.largest["u.activation"] == pytest.approx(0.25)
    assert {d.what for d in done.differences} == {"jaxlib", "machine"} and "0.0.1 then" in str(done)


def test_a_difference_without_an_explanation_is_not_faithful() -> None:
    recorded = record()
    recorded["u.activation"] = recorded["u.activation"] + 1
    done = repeat(recorded, simulate)
    assert not done.faithful and "nothing explains it" in str(done)


def test_a_world_is_opened_again_and_must_be_the_same(tmp_path: Path) -> None:
    picture = np.zeros((8, 8, 3), np.uint8)
    picture[2:6, 2:6] = [255, 0, 0]
    Image.fromarray(picture).save(tmp_path / "p.png")
    record = dd.simulate(
        saliency(), 50, record=["colour.activation"], every=50, world=Picture(tmp_path / "p.png")
    )
    assert repeat(record, simulate).same_bits
    picture[0, 0] = 9
    Image.fromarray(picture).save(tmp_path / "p.png")
    with pytest.raises(dd.errors.WorldError, match=r"world=Picture\("):
        repeat(record, simulate)
    (tmp_path / "p.png").unlink()
    with pytest.raises(dd.errors.WorldError, match=r"world=Picture\("):
        repeat(record, simulate)


def test_repeating_a_record_with_functions_requires_trust() -> None:
    model = dd.Model("function")
    model.add(Function("f", [x]))
    record = dd.simulate(model, 3, record=["f.output"])
    with pytest.raises(dd.errors.Untrusted):
        repeat(record, simulate)
    assert repeat(record, simulate, trust=True).same_bits


def test_a_record_without_its_document_cannot_be_repeated() -> None:
    recorded = record().assign_attrs({KEY: "{}"})
    with pytest.raises(dd.errors.RecordError):
        repeat(recorded, simulate)


def test_nan_in_only_one_of_two_records_is_a_difference() -> None:
    recorded = record()
    diverged = recorded.copy(deep=True)
    diverged["u.activation"].values[-1, 0] = np.nan
    comparison = compare(diverged, diverged.copy(deep=True))
    assert comparison.same_bits and comparison.largest["u.activation"] == 0
    for old, new in ((recorded, diverged), (diverged, recorded)):
        done = compare(old, new)
        assert not done.same_bits and done.largest["u.activation"] == float("inf")


def test_different_bits_of_nan_are_not_a_difference_of_values() -> None:
    old, new = record(), record()
    old["u.activation"].values[-1, 0], new["u.activation"].values[-1, 0] = np.nan, -np.float32(np.nan)
    new["u.activation"].values[-1, 1] += 0.5
    assert compare(old, new).largest["u.activation"] == pytest.approx(0.5)


@pytest.mark.parametrize(
    ("described", "expected"),
    [
        ({"world": "Nowhere"}, "Nowhere"),
        ({"world": "Nowhere", "file": "a/b.png"}, "Nowhere a/b.png"),
        (
            {"world": "Nowhere", "file": "b.png", "sha256": "0123456789abcdef"},
            "Nowhere b.png sha256 0123456789ab",
        ),
    ],
)
def test_a_world_of_an_unknown_kind_is_named_as_the_record_describes_it(
    described: dict[str, str], expected: str
) -> None:
    says = f"the record was made with the world {expected}, which is not known here"
    with pytest.raises(dd.errors.WorldError, match=re.escape(says)) as caught:
        _world(described)
    assert caught.value.problems[0].fix == "Give it: dd.repeat(record, world=Nowhere(...))"


LAMP = """
import deodar as dd, numpy as np
class Lamp(dd.World):
    sensors = {"light": dd.Signal("brightness", (), "lux")}
    period = 10.0
    def reset(self, seed, trials=(0,), precision="float32"):
        self.light = 1.0
    def sense(self, sensor, axes, time):
        self.light *= 1.5
        return np.asarray(self.light)
"""


def test_a_record_of_a_world_of_ones_own_repeats_when_its_module_is_imported(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(tmp_path)
    (tmp_path / "own_lamp.py").write_text(LAMP)
    model = dd.Model("eye")
    model.add(dd.Sensor("eye", sensor="light"))
    lamp = importlib.import_module("own_lamp")
    recorded = dd.simulate(model, 100, record="eye.output", every=10, world=lamp.Lamp())
    assert about(recorded)["world"] == {"world": "Lamp", "module": "own_lamp"}
    assert repeat(recorded, simulate).same_bits
    dd.save_record(recorded, "seen.nc")
    # another user, whose Python has not imported it
    monkeypatch.delitem(sys.modules, "own_lamp")
    with pytest.raises(dd.errors.WorldError) as caught:
        repeat(recorded, simulate)
    assert caught.value.at("shell").endswith(
        "Import its module own_lamp: deodar --import own_lamp run RECORD"
    )
    assert "--" not in str(caught.value) and "Import its module own_lamp." in str(caught.value)
    assert main(["run", "seen.nc", "-o", "again"]) == 1
    assert "deodar --import own_lamp run RECORD" in capsys.readouterr().err
    assert main(["--import", "own_lamp", "run", "seen.nc", "-o", "again"]) == 0
    assert "same bits" in capsys.readouterr().out
    monkeypatch.delitem(sys.modules, "own_lamp")


def test_a_world_that_takes_arguments_is_not_made_without_them(monkeypatch: pytest.MonkeyPatch) -> None:
    class Taking(dd.World):
        def __init__(self, light: float = 1.0) -> None:
            self.light = light

    monkeypatch.setattr(sys.modules[__name__], "Taking", Taking, raising=False)
    with pytest.raises(dd.errors.WorldError, match=r"not opened from a file. Give it: world=Taking\(...\)"):
        _world({"world": "Taking", "module": __name__})


@pytest.mark.filterwarnings("always:.*left out:deodar.errors.RunWarning")
@pytest.mark.parametrize("samples", [0, 4])
def test_the_repetition_of_a_damaged_record_names_the_damage(
    samples: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("deodar.recording.growing.LONGEST_CHUNK", 4)
    monkeypatch.chdir(tmp_path)
    record(out="run")
    chunk = tmp_path / "run" / "record.zarr" / "u.activation" / "c" / str(samples // 4) / "0"
    chunk.write_bytes(chunk.read_bytes()[:-1])
    status = main(["run", "run", "--out", "again"])
    printed = " ".join("".join(capsys.readouterr()).split())
    assert "samples of time are left out: a chunk of u.activation is damaged" in printed
    assert "nothing explains it" not in printed
    assert status == (0 if samples else 1)
    assert ("The repetition has the same bits as the rest" in printed) == bool(samples)
    assert dd.load_record(tmp_path / "again").sizes == record().sizes
