"""Borders of maps that are folds: computed lines against the labels of cells and closed forms."""

from __future__ import annotations

import json

import numpy as np
import pytest

import deodar as dd
from deodar.analysis.maps.borders import BORDERS, BorderField, cells_between, edges, stretches
from deodar.cli import main
from deodar.errors import AnalysisError, FigureError
from tests.deodar.analysis.continuation.models import node_folds
from tests.deodar.analysis.maps.test_regime_map import EXCITATION, INHIBITION, line, node

LEVEL = "u.resting_level"
EVEN = "detection", "forgetting", "detection without input"


def distances(regime_map: dd.analysis.RegimeMap, loci: list[dd.analysis.Locus]) -> dict[str, np.ndarray]:
    """Return the distance of each edge of each border to the nearest of its lines, in cells."""
    out: dict[str, np.ndarray] = {}
    for border in BORDERS:
        lines = [curve for curve in loci if curve.of == f"fold ({border.name})"]
        nearest = [
            min((cells_between(regime_map, e, curve) for curve in lines), default=np.inf)
            for e in edges(regime_map, border)
        ]
        out[border.name] = np.array(nearest)
    return out


def within(regime_map: dd.analysis.RegimeMap, point: np.ndarray, cells: int) -> set[str]:
    """Return the words of the cells around a point of the plane."""
    i, j = (int(np.abs(v - x).argmin()) for v, x in zip(regime_map.values, point, strict=True))
    around = regime_map.words[max(0, i - cells) : i + cells + 1, max(0, j - cells) : j + cells + 1]
    return set(around.ravel().tolist())


def inside(regime_map: dd.analysis.RegimeMap, curve: dd.analysis.Locus) -> np.ndarray:
    low, high = ([v[k] for v in regime_map.values] for k in (0, -1))
    return curve.values[((curve.values >= low) & (curve.values <= high)).all(axis=1)]


@pytest.fixture(scope="module")
def of_a_node():
    grid = {EXCITATION: (1.2, 12, 37), LEVEL: (-9.2, -1.2, 41)}
    regime_map = dd.regime_map(node(), grid, strength=6.0, precision="float64")
    return regime_map, dd.regime_loci(regime_map)


@pytest.fixture(scope="module")
def of_a_field():
    regime_map = dd.regime_map(line(61, 15, 0.6), {EXCITATION: (1, 30, 30), LEVEL: (-8, 1, 31)})
    return regime_map, dd.regime_loci(regime_map)


def test_all_borders_of_a_node_are_its_folds(of_a_node):
    regime_map, loci = of_a_node
    assert {curve.of for curve in loci} == {f"fold ({name})" for name in EVEN}
    for name, apart in distances(regime_map, loci).items():
        assert len(apart) >= 3 and apart.max() <= 0.75, name


def test_lines_of_a_node_are_the_closed_form(of_a_node):
    """A fold at the input s and the level h has s + h = u - w g(u), which `node_folds` has for h = -5."""
    _, loci = of_a_node
    for curve in loci:
        strength = 6.0 if curve.of == "fold (detection)" else 0.0
        for excitation, level in curve.values:
            levels = [s - 5 - strength for s in node_folds(excitation)]
            expected = min(levels) if curve.of == "fold (forgetting)" else max(levels)
            assert level == pytest.approx(expected, abs=1e-7)


def test_the_borders_of_a_field_lie_within_a_cell_of_a_computed_fold(of_a_field):
    regime_map, loci = of_a_field
    apart = distances(regime_map, loci)
    assert len(apart["detection without input"]) > 20 and apart["detection without input"].max() <= 1
    # with little excitation a peak grows steadily out of its input, and nothing vanishes
    for name, lowest in (("detection", 12.0), ("forgetting", 11.0)):
        border = next(b for b in BORDERS if b.name == name)
        pairs = zip(edges(regime_map, border), apart[name], strict=True)
        steep = [d for edge, d in pairs if regime_map.values[0][edge.cell[0]] > lowest]
        assert len(steep) > 15 and max(steep) <= 1


def test_the_labels_change_at_each_computed_fold_of_a_field(of_a_field):
    regime_map, loci = of_a_field
    by = {curve.of: inside(regime_map, curve) for curve in loci}
    for point in by["fold (detection)"]:
        words = within(regime_map, point, 1)
        assert "silent" in words and len(words) > 1
    for point in by["fold (detection without input)"]:
        words = within(regime_map, point, 1)
        assert "active at rest" in words and len(words) > 1
    reached = [within(regime_map, point, 1) for point in by["fold (forgetting)"]]
    # below the detection no input makes the peak that could remain
    tested = [words for words in reached if "silent" not in words]
    assert len(tested) > 10
    for words in tested:
        assert words & {"self-sustained", "self-sustained and selective"}
        assert words & {"input-driven", "selective"}


def test_a_border_that_is_no_fold_has_no_line():
    regime_map = dd.regime_map(line(51, 2.0, 0.8), {EXCITATION: (1, 3, 5), INHIBITION: (0.6, 1.0, 9)})
    detection = BORDERS[0]
    assert list(edges(regime_map, detection)), "silent and input-driven meet in this map"
    assert dd.regime_loci(regime_map) == []


def test_a_kept_input_at_one_side_leaves_states_that_are_not_even():
    model = line(51, 22, 0.4)
    model.parameter("level", -5)
    model.link(LEVEL, "level")
    at = {"center": 20.0, "sigma": 5.0, "amplitude": 0.5}
    model.add(dd.GaussianStimulus("s", model["u"].axes, **at)) >> model["u"]
    regime_map = dd.regime_map(
        model, {"level": (-6, -5.2, 9), "s.amplitude": (0.1, 1.0, 4)}, strength=4.5, inputs=["s"]
    )
    assert BorderField(regime_map).right_hand_side.even == ()
    loci = dd.regime_loci(regime_map)
    assert {curve.parameters for curve in loci} == {("level", "s.amplitude")}
    apart = distances(regime_map, loci)["detection"]
    assert len(apart) and apart.max() <= 1


def test_a_field_may_have_the_name_of_the_measured_one():
    model = dd.Model("node")
    model.add(dd.Field("field", tau=20, resting_level=-5, kernel=[dd.Gaussian(6.0)]))
    grid = {"field.kernel.0.amplitude": (5, 8, 4), "field.resting_level": (-8, -5, 13)}
    regime_map = dd.regime_map(model, grid, strength=6.0)
    (curve, *_) = dd.regime_loci(regime_map)
    assert curve.parameters == regime_map.parameters
    assert distances(regime_map, [curve])["detection"].max() <= 0.75


def test_a_threshold_may_be_a_parameter_of_the_map():
    regime_map = dd.regime_map(
        node(), {EXCITATION: (5, 8, 4), "u.sigmoid.threshold": (-1, 2, 13)}, strength=6.0
    )
    apart = distances(regime_map, dd.regime_loci(regime_map))
    assert len(apart["detection"]) and apart["detection"].max() <= 0.75
    assert len(apart["forgetting"]) and apart["forgetting"].max() <= 0.75


def test_an_input_beside_the_middle_is_refused():
    regime_map = dd.regime_map(line(31), {EXCITATION: [8, 9], INHIBITION: [0.1, 0.2]}, center=[30])
    with pytest.raises(AnalysisError, match="the input of the map is at 30, and the middle of x is 50"):
        dd.regime_loci(regime_map)


def test_the_figure_has_a_line_for_each_bifurcation_and_the_distance_of_the_model(of_a_node):
    regime_map, loci = of_a_node
    turned = [curve.over(*reversed(regime_map.parameters)) for curve in loci]
    figure = dd.regime_map_figure(regime_map, loci=turned)
    axes = figure.axes[0]
    texts = [text.get_text() for text in figure.legends[0].get_texts()]
    least = min(loci, key=lambda curve: curve.distance(regime_map.at))
    assert texts[-4:] == [
        *dict.fromkeys(curve.of for curve in loci),
        f"the model, {least.distance(regime_map.at):.1%} from\n{least.of}",
    ]
    drawn = [line for line in axes.lines if line.get_marker() == "None"]
    for curve, shown in zip(loci, drawn, strict=True):
        assert (np.column_stack(shown.get_data()) == curve.values).all()
    assert len({line.get_linestyle() for line in drawn}) == 3
    cusps = [line for line in axes.lines if line.get_marker() == "^"]
    assert [line.get_xdata()[0] for line in cusps] == [p.values[0] for curve in loci for p in curve.points]
    fold = dd.continuation(node(), LEVEL, (-8, 2), finer=False).bifurcations[0]
    with pytest.raises(FigureError, match=r"over u\.resting_level and u\.sigmoid\.beta, the map over"):
        dd.regime_map_figure(regime_map, loci=[dd.locus(fold, "u.sigmoid.beta", (3, 5), (-9, 0))])


def test_the_command_prints_folds_and_distances(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    dd.save(node(), "node.json")
    call = ["map", "node.json", EXCITATION, "1", "12", "12", LEVEL, "-9.2", "-1.2", "17", "--strength", "6"]
    assert main([*call, "--loci"]) == 0
    printed = capsys.readouterr().out
    lines = printed[printed.index("Borders that are folds") :].splitlines()
    assert [row.split("  ")[-1] for row in lines if "%" in row] == [f"fold ({name})" for name in EVEN]
    assert main([*call, "--loci", "--json"]) == 0
    loci = json.loads(capsys.readouterr().out)["loci"]
    assert {curve["of"] for curve in loci} == {f"fold ({name})" for name in EVEN}
    assert main([*call, "--json"]) == 0
    assert "loci" not in json.loads(capsys.readouterr().out)


@pytest.mark.parametrize("periodic", [False, True])
def test_a_map_from_a_file_has_lines_though_no_sample_is_in_the_middle(tmp_path, periodic):
    model = line(40, 15, 0.6, periodic=periodic)
    regime_map = dd.regime_map(model, {EXCITATION: (14, 30, 9), LEVEL: (-8, -3, 15)}, sigma=5)
    loaded = dd.analysis.RegimeMap.load(regime_map.save(tmp_path / "map.nc"))
    loci = dd.regime_loci(loaded)
    assert BorderField(loaded).right_hand_side.even == ("x",)
    apart = distances(loaded, loci)
    for name in ("detection", "forgetting"):
        assert len(apart[name]) > 5 and apart[name].max() <= 1


@pytest.mark.parametrize(
    ("marks", "expected"),
    [
        ("", []),
        ("...", []),
        ("#", [(0, 0)]),
        ("###", [(0, 2)]),
        ("..##", [(2, 3)]),
        ("##..", [(0, 1)]),
        (".#.###.", [(1, 1), (3, 5)]),
        ("##.#.#", [(0, 1), (3, 3), (5, 5)]),
    ],
)
def test_a_line_is_a_border_in_each_stretch_of_its_points(marks, expected):
    assert stretches([mark == "#" for mark in marks]) == expected
