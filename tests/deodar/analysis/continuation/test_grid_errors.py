"""Thresholds on a field's own grid against those of a finer one, in percent."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import deodar as dd
from deodar.analysis.continuation import grid_errors as module
from deodar.analysis.continuation.confirmation import Confirmation
from deodar.analysis.continuation.grid_errors import grid_errors
from deodar.analysis.isolated import Isolated
from deodar.analysis.regimes import Regimes
from deodar.cli import main
from deodar.errors import AnalysisError


def driven(quadrature: str) -> dd.Field:
    """A field whose peaks need their input, at 2.5 samples a kernel width."""
    x = dd.Axis("x", 0, 100, samples=50, periodic=True)
    kernel = [dd.Gaussian(12, 5, normalized=True)]
    return dd.Field("u", [x], kernel=kernel, global_inhibition=0.3, quadrature=quadrature)


def test_sums_over_points_depend_on_the_grid_where_means_over_cells_do_not() -> None:
    """Reverse detection, where the edges of the peak decide, for an input between two samples."""
    errors = {(e.quadrature, e.between): e.percent for e in grid_errors(dd.regimes(driven("point")))}
    assert set(errors) == {(q, b) for q in ("point", "cell") for b in (False, True)}
    for percent in errors.values():
        assert set(percent) >= {"detection", "reverse"}
    assert errors["point", True]["reverse"] == pytest.approx(-6.9, abs=0.3)
    for between in (False, True):
        for name in ("detection", "reverse"):
            assert errors["cell", between][name] == pytest.approx(0, abs=0.2)


@pytest.mark.parametrize("grids", [(), (25,), (49,), (25, 49)])
def test_a_fold_that_a_grid_lacks_is_not_found(
    grids: tuple[int, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Forgetting on some of both grids alone, and nowhere where the input is not in the middle."""
    x = dd.Axis("x", 0, 24, samples=25)
    kernel = [dd.Gaussian(18, 2, normalized=True)]
    measured = dd.regimes(dd.Field("u", [x], kernel=kernel, global_inhibition=0.8))

    def some(isolated: Isolated, _: Regimes) -> dict[str, Confirmation]:
        on_this_grid = isolated.axes[0].samples in grids
        forgetting = Confirmation(-2.0, True) if on_this_grid else Confirmation(None, False, "no such fold")
        return {"detection": Confirmation(4.0, True), "forgetting": forgetting}

    monkeypatch.setattr(module, "folds", some)
    forgetting = 0.0 if grids == (25, 49) else None
    for error in grid_errors(measured):
        assert error.percent == {"detection": 0.0} | ({} if error.between else {"forgetting": forgetting})


def test_a_field_that_has_no_finer_grid_is_refused() -> None:
    with pytest.raises(AnalysisError, match="a node has no grid"):
        grid_errors(dd.regimes(dd.Field("u", [], kernel=[dd.Gaussian(8)])))


def test_the_command_prints_percentages_and_has_them_as_data(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    model = dd.Model("m")
    model.add(driven("cell"))
    dd.save(model, tmp_path / "m.json")
    command = ["regimes", str(tmp_path / "m.json"), "u", "--resolution", "-o", str(tmp_path / "m.png")]
    assert main([*command, "--json"]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert [(e["quadrature"], e["between_samples"]) for e in answer["resolution"]] == [
        ("cell", False),
        ("cell", True),
    ]
    assert main([*command, "--force"]) == 0
    page = capsys.readouterr().out
    for place, error in zip(("on a sample", "between samples"), answer["resolution"], strict=True):
        (row,) = [text for text in page.splitlines() if f"cell, {place}" in text]
        assert f"reverse detection {error['percent']['reverse']:+.2f} %" in row


def of_a_node() -> dd.Field:
    return dd.Field("u", [], kernel=[dd.Gaussian(6.0)])


def of_a_custom_kernel() -> dd.Field:
    values = 0.5 * np.exp(-0.5 * (np.arange(-12, 13) / 2) ** 2)
    return dd.Field("u", [dd.Axis("x", 0, 24, samples=25)], kernel=[dd.Custom(values)])


@pytest.mark.parametrize(
    ("make", "options", "why"),
    [
        (of_a_node, [], "a node has no grid"),
        (of_a_custom_kernel, [], "a custom kernel is given on this grid alone"),
        (lambda: driven("point"), ["--input", "s"], "the inputs that are kept have the field's own grid"),
    ],
)
def test_the_command_states_why_a_grid_is_not_compared(
    make: Callable[[], dd.Field],
    options: list[str],
    why: str,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """The table and the figure, which took long, are there as without --resolution."""
    model = dd.Model("m")
    field = model.add(make())
    if options:
        model.add(dd.Boost("s", [], amplitude=0.5)) >> field
    dd.save(model, tmp_path / "m.json")
    figure = tmp_path / "m.png"
    command = ["regimes", str(tmp_path / "m.json"), "u", "--resolution", "-o", str(figure), *options]
    assert main(command) == 0 and figure.stat().st_size
    page = capsys.readouterr().out
    assert "detection threshold" in page and f"  {'the grid':26}not compared: {why}\n" in page
    assert main([*command, "--force", "--json"]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert answer["resolution"] is None and answer["discretisation_not_measured"] == why
