"""`deodar map`: regimes in words, as JSON, as a figure and as a file."""

from __future__ import annotations

import json

import pytest
from PIL import Image

import deodar as dd
from deodar.cli import main
from tests.deodar.analysis.maps.test_regime_map import EXCITATION, INHIBITION, line

CALL = ["map", "line.json", EXCITATION, "1", "30", "9", INHIBITION, "0", "1.2", "9"]


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    dd.save(line(31), "line.json")
    return tmp_path


def test_it_prints_shares_and_the_regime_of_the_model_and_draws_them(folder, capsys):
    assert main(CALL) == 0
    printed = capsys.readouterr()
    lines = printed.out.splitlines()
    assert lines[0].startswith(f"u over {EXCITATION} and {INHIBITION}: 9 x 9 cells")
    assert lines[1] == "Measured alone, without noise, with inputs of 6."
    shares = [float(row.split("%")[0]) for row in lines if "%" in row]
    assert sum(shares) == pytest.approx(100, abs=0.5) and shares == sorted(shares, reverse=True)
    assert lines[-3].endswith(f"({EXCITATION} 8, {INHIBITION} 0.1): input-driven")
    assert lines[-1] == "Figure: line-map-001.png" and not printed.err
    with Image.open(folder / "line-map-001.png") as picture:
        assert picture.width > 500


def test_json_and_a_file_have_the_same_map(folder, capsys):
    options = [
        "--json",
        "--save",
        "map.nc",
        "-o",
        "map.svg",
        "--every-cell",
        "--strength",
        "5",
        "--sigma",
        "4",
    ]
    assert main([*CALL, *options, "--set", "u.resting_level=-4"]) == 0
    answer = json.loads(capsys.readouterr().out)
    saved = dd.analysis.RegimeMap.load("map.nc")
    assert answer["labels"] == saved.labels.tolist() and answer["computed"] == 81
    assert (answer["strength"], answer["sigma"], answer["figure"]) == (5.0, [4.0], "map.svg")
    assert [e.element.resting_level for e in saved.document.entries] == [-4.0]
    assert main([*CALL, "--save", "map.nc"]) == 1
    assert "exists" in capsys.readouterr().err


def test_mistakes_are_answered(capsys):
    assert main([*CALL[:2], "u.kernel.0.amplitud", *CALL[3:]]) == 1
    assert "Did you mean 'amplitude'" in capsys.readouterr().err
    assert main([*CALL[:5], "1", *CALL[6:]]) == 1
    assert "needs 2 or more values" in capsys.readouterr().err
    with pytest.raises(SystemExit, match="2"):
        main([*CALL[:6], *CALL[2:6]])
    assert "both parameters are" in capsys.readouterr().err
