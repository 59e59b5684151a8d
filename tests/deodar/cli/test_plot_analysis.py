"""`deodar plot` of files of analyses: the figure of the object, from the file."""

from __future__ import annotations

import json

import pytest

import deodar as dd
from deodar.cli import main
from deodar.figures import _files
from tests.deodar.analysis.continuation.models import node, rivals

LEVEL, EXCITATION = "u.resting_level", "u.kernel.0.amplitude"


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    dd.save(node(), "node.json")
    return tmp_path


def same(figure, name: str) -> bool:
    """Return whether a file has the bytes of a figure."""
    _files.save_figure(figure, "expected.svg", force=True)
    with open("expected.svg", "rb") as expected, open(name, "rb") as drawn:
        return expected.read() == drawn.read()


def test_a_branch_of_the_command_is_drawn_again(folder, capsys):
    assert (
        main(["continuation", "node.json", "s.amplitude", "0", "8", "--one-grid", "--out", "branch.nc"]) == 0
    )
    printed = capsys.readouterr().out
    assert "Branch: branch.nc" in printed and "Figure" not in printed and not list(folder.glob("*.png"))
    assert main(["plot", "branch.nc", "-o", "branch.svg"]) == 0
    assert capsys.readouterr().out == "Drew the branch of branch.nc into branch.svg\n"
    branch = dd.continuation(node(), "s.amplitude", (0, 8), finer=False)
    assert same(dd.bifurcation_diagram(branch), "branch.svg")
    assert main(["plot", "branch.nc", "u.output", "-o", "output.svg", "--json"]) == 0
    assert json.loads(capsys.readouterr().out) == {"out": "output.svg", "kinds": {"branch.nc": "branch"}}
    assert same(dd.bifurcation_diagram(branch, shown="u.output"), "output.svg")
    assert main(["plot", "branch.nc"]) == 0
    assert (folder / "branch-plot-001.png").exists()


def test_the_command_writes_a_figure_and_every_branch_beside_it(folder, capsys):
    dd.save(rivals(101), "rivals.json")
    call = ["continuation", "rivals.json", "u.global_inhibition", "0.32", "0.45", "--one-grid", "--switch"]
    assert main([*call, "-o", "all.svg", "--save", "all.zarr", "--json"]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert answer["files"] == ["all.zarr", *(f"all-{k}.zarr" for k in range(2, len(answer["switched"]) + 2))]
    assert len(answer["switched"]) == 2 * len(answer["bifurcations"]) == 2
    assert main(["plot", *answer["files"], "-o", "again.svg"]) == 0
    assert (folder / "again.svg").read_bytes() == (folder / "all.svg").read_bytes()


def test_a_map_is_drawn_again_with_loci_on_it(folder, capsys):
    grid = ["1", "12", "9", LEVEL, "-9.2", "-1.2", "9", "--strength", "6"]
    assert main(["map", "node.json", EXCITATION, *grid, "--out", "map.zarr"]) == 0
    assert not list(folder.glob("*.png"))
    regime_map = dd.analysis.RegimeMap.load("map.zarr")
    assert main(["plot", "map.zarr", "-o", "map.svg"]) == 0
    assert same(dd.regime_map_figure(regime_map), "map.svg")
    loci = dd.regime_loci(regime_map)
    names = [str(curve.save(f"line-{k}.nc")) for k, curve in enumerate(loci)]
    capsys.readouterr()
    assert main(["plot", names[0], "map.zarr", *names[1:], "-o", "both.svg"]) == 0
    assert same(dd.regime_map_figure(regime_map, loci), "both.svg")
    assert main(["plot", *names, "-o", "loci.svg"]) == 0
    assert same(dd.locus_figure(*loci), "loci.svg")
    assert capsys.readouterr().out.splitlines()[-1].startswith("Drew the locus of line-0.nc and the locus of")


def test_mistakes_are_answered(folder, capsys):
    dd.continuation(node(), "s.amplitude", (0, 8), finer=False).save("branch.nc")
    dd.save_record(dd.simulate(node(), 10), "run.nc")
    for options, message in (
        (["--at", "5"], "--at is for records of runs; branch.nc holds a branch"),
        (["u.output", "u.activation"], "one port is drawn, not 2"),
    ):
        with pytest.raises(SystemExit, match="2"):
            main(["plot", "branch.nc", *options])
        assert message in capsys.readouterr().err
    assert main(["plot", "branch.nc", "run.nc"]) == 1
    assert "not drawn together: branch, a run" in capsys.readouterr().err
    assert main(["plot", "branch.nc", "u.outptu"]) == 1
    assert "Did you mean" in capsys.readouterr().err
    with pytest.raises(SystemExit, match="2"):
        main(["continuation", "node.json", "s.amplitude", "0", "8", "--out", "a.nc", "--save", "b.nc"])
    assert "leave out --save" in capsys.readouterr().err
    assert main(["continuation", "node.json", "s.amplitude", "0", "8", "--out", "branch.nc"]) == 1
    assert "exists" in capsys.readouterr().err
