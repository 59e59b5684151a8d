"""Regimes of fields with known answers, and the command that prints them."""

from __future__ import annotations

import importlib
import itertools
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image
from scipy import optimize

import deodar as dd
from deodar.analysis.discretisation import discretisation, obstacle, refined
from deodar.analysis.isolated import isolate
from deodar.analysis.phase import COARSE, phase
from deodar.analysis.ramp import ramp
from deodar.analysis.regimes import regimes
from deodar.analysis.selection import selection
from deodar.analysis.settle import settle
from deodar.analysis.thresholds import thresholds
from deodar.analysis.working_memory import forgetting, suppression
from deodar.cli import main
from deodar.numerics.kernels.custom import Custom

x = dd.Axis("x", 0, 60, samples=61)


def lateral(excitation: float, inhibition: float, everywhere: float = 0.0, **options: object) -> dd.Field:
    kernel = [dd.Gaussian(excitation, 4, normalized=True), dd.Gaussian(-inhibition, 8, normalized=True)]
    return dd.Field("u", [x], **({"tau": 10, "kernel": kernel, "global_inhibition": everywhere} | options))  # type: ignore[arg-type]


def test_a_field_with_weak_excitation_is_input_driven_and_selective() -> None:
    measured = regimes(lateral(12, 0, 0.6))
    assert (
        not measured.self_sustained
        and measured.selection is not None
        and measured.selection.selects
        and measured.selection.right
    )
    assert (
        measured.detection is not None
        and measured.reverse is not None
        and 0 < measured.reverse < 0.97 * measured.detection
    )
    assert "selective" in " ".join(measured.words)


def test_local_interaction_keeps_two_peaks() -> None:
    measured = regimes(lateral(11, 6))
    assert (
        measured.selection is not None
        and not measured.selection.selects
        and len(measured.selection.equal) == 2
    )


def test_a_working_memory_is_erased_by_inhibition() -> None:
    measured = regimes(lateral(18, 6, 0.1))
    assert measured.self_sustained and measured.memory is not None and len(measured.memory.left) == 1
    assert measured.forgetting is not None and measured.forgetting < 0


def test_a_memory_is_also_erased_by_an_input_beside_its_position() -> None:
    measured, driven = regimes(lateral(18, 6, 0.1)), regimes(lateral(12, 0, 0.6))
    assert measured.suppression is not None and measured.suppression < 0 and driven.suppression is None
    isolated = isolate(lateral(18, 6, 0.1))
    (center,), (sigma,) = isolated.center, isolated.sigma
    for share, count in ((0.95, 1), (1.05, 0)):
        isolated.reset(input=1.2 * measured.detection)  # type: ignore[operator]
        isolated.settle()
        isolated.put(input=0.0)
        isolated.settle()
        isolated.session.set("input.center", center + 0.1 * sigma)
        isolated.put(input=share * measured.suppression)
        isolated.settle()
        assert len(isolated.peaks()) == count
        isolated.session.set("input.center", center)


def test_rounding_does_not_determine_the_input_that_erases_a_memory() -> None:
    """Exactly over the peak no side is preferred, and the value depended on precision and position."""
    field = lateral(18, 6, 0.1)
    home = regimes(field).suppression
    (center,) = isolate(field).center
    assert regimes(field, precision="float64").suppression == pytest.approx(home, abs=1e-5)
    assert regimes(field, center=[center - 3]).suppression == pytest.approx(home, abs=1e-5)


def test_an_input_weaker_than_the_one_that_erases_a_memory_moves_it_aside() -> None:
    isolated = isolate(lateral(18, 6, 0.1))
    strong = 1.2 * regimes(isolated.field).detection  # type: ignore[operator]
    erased = suppression(isolated, strong)
    assert erased is not None and isolated.session.get("input.center") == isolated.center
    isolated.restore(erased.state)
    assert not isolated.peaks()
    isolated.session.set("input.center", isolated.center)
    isolated.reset(input=strong)
    isolated.settle()
    isolated.put(input=0.0)
    isolated.settle()
    isolated.session.set("input.center", isolated.center[0] + 0.1 * isolated.sigma[0])
    isolated.put(input=erased.before)
    isolated.settle()
    (peak,) = isolated.peaks()
    assert peak.position[0] < isolated.center[0] - isolated.sigma[0]


def test_a_boost_makes_a_peak_at_the_position_of_a_subthreshold_input() -> None:
    measured = regimes(lateral(12, 0, 0.6))
    needed = [b.boost for b in measured.boosts]
    assert all(b.localised for b in measured.boosts) and all(a > b > 0 for a, b in itertools.pairwise(needed))  # type: ignore[operator]
    assert all(b.preshape + b.boost == pytest.approx(measured.detection, rel=0.05) for b in measured.boosts)  # type: ignore[operator]


def test_separation_is_the_smallest_distance_at_which_two_peaks_coexist() -> None:
    local, selective = regimes(lateral(11, 6)), regimes(lateral(12, 0, 0.6))
    assert local.separation is not None and 0.1 < local.separation < 0.5 and selective.separation is None
    isolated = isolate(lateral(11, 6))
    for off, count in ((-0.04, 1), (0.02, 2)):
        two_inputs = selection(isolated, 1.2 * local.detection, 0.0, local.separation + off)  # type: ignore[operator]
        assert len(two_inputs.equal) == count


def test_without_interaction_there_is_no_instability() -> None:
    measured = regimes(dd.Field("u", [x], tau=10))
    assert [b.preshape + b.boost for b in measured.boosts] == pytest.approx([5.0] * 3, rel=0.01)  # type: ignore[operator]
    assert (
        measured.detection == pytest.approx(5.0, rel=0.01)
        and not measured.thresholds.detection.jump
        and measured.bistable is None
    )  # type: ignore[union-attr]


def test_more_excitation_lowers_detection_and_reverse_detection() -> None:
    measured = [regimes(lateral(strength, 0, 0.3)) for strength in (6, 9)]
    assert measured[1].detection < measured[0].detection and (measured[1].reverse or 0) < (
        measured[0].reverse or 9
    )  # type: ignore[operator]


def test_the_ramp_shows_the_hysteresis_between_the_thresholds() -> None:
    isolated = isolate(lateral(12, 0, 0.6))
    measured = regimes(lateral(12, 0, 0.6))
    low, high = measured.bistable  # type: ignore[misc]
    swept = ramp(isolated, np.linspace(0, high * 1.2, 25))
    inside = (swept.values > low * 1.02) & (swept.values < high * 0.98)
    outside = (swept.values < low * 0.98) | (swept.values > high * 1.02)
    assert inside.any() and (swept.down.count[inside] == 1).all() and (swept.up.count[inside] == 0).all()
    assert (swept.up.count[outside] == swept.down.count[outside]).all()


@pytest.mark.parametrize("dimensions", [2, 3])
def test_regimes_of_fields_over_several_axes_are_measured(dimensions: int) -> None:
    axes = [dd.Axis(name, 0, 20, samples=11) for name in "abc"[:dimensions]]
    kernel = [dd.Gaussian(16, 3, normalized=True)]
    measured = regimes(
        dd.Field("u", axes, tau=10, kernel=kernel, global_inhibition=0.02 if dimensions == 2 else 0.002)
    )
    assert measured.detection is not None and 2 < measured.detection < 5 and measured.peak is not None
    assert np.allclose(measured.peak.position, 10, atol=1)


def test_thresholds_of_a_node_agree_with_a_root_finder() -> None:
    node = dd.Field("n", [], tau=10, resting_level=-2, sigmoid=dd.Logistic(4), kernel=[dd.Gaussian(3.0)])

    def rate(u: float, s: float = 0.0) -> float:
        return -u - 2 + s + 3 / (1 + np.exp(-4 * u))

    portrait = phase(node)
    grid = np.linspace(-4, 4, 4001)
    roots = [optimize.brentq(rate, a, b) for a, b in itertools.pairwise(grid) if rate(a) * rate(b) < 0]
    assert np.allclose([p.u for p in portrait.fixed_points], roots, atol=1e-8) and [
        p.stable for p in portrait.fixed_points
    ] == [True, False, True]
    # at a fold the rate and its slope are zero together
    folds = []
    for guess in (-0.5, 0.5):
        u = optimize.brentq(
            lambda v: -1 + 12 * np.exp(-4 * v) / (1 + np.exp(-4 * v)) ** 2,
            min(0, 4 * guess),
            max(0, 4 * guess),
        )
        folds.append(-rate(u))
    measured = regimes(node)
    assert measured.detection == pytest.approx(max(folds), rel=0.01) and measured.reverse == pytest.approx(
        min(folds), rel=0.01
    )


@pytest.mark.parametrize("index", [1, 2, COARSE // 2, COARSE - 3, COARSE - 2])
@pytest.mark.parametrize("step", [2.0**-4, 2.0**-7])
def test_a_fixed_point_on_a_sample_of_the_span_is_found(index: int, step: float) -> None:
    """A node without interaction has one fixed point, h + s; the rate there is exactly zero."""
    span = -5 - index * step, -5 + (COARSE - 1 - index) * step
    (fixed_point,) = phase(dd.Field("n", [], resting_level=-8), 3.0, span).fixed_points
    assert fixed_point.u == -5 and fixed_point.stable


@pytest.mark.parametrize("amplitude", [0.02, 0.2, 2.0, 20.0])
def test_the_width_of_the_input_is_that_of_the_kernel_at_any_strength(amplitude: float) -> None:
    """A kernel without excitation, or none, gives a twentieth of the axis."""
    for kernel, width in (
        ([dd.Gaussian(amplitude, 4)], 4.0),
        ([dd.Gaussian(2 * amplitude, 4), dd.Gaussian(-amplitude, 4)], 4.0),
        ([dd.Gaussian(-amplitude, 4)], 3.0),
        ([], 3.0),
    ):
        assert isolate(dd.Field("u", [x], kernel=kernel)).sigma == pytest.approx((width,), rel=0.02)


@pytest.mark.parametrize("sigma", [0, -1.0, float("nan"), (2.0, 3.0), ()])
def test_an_input_without_a_width_for_each_axis_is_refused(sigma: object) -> None:
    with pytest.raises(dd.errors.ParameterError, match="expected a number above 0, or one for each"):
        isolate(lateral(12, 0, 0.6), sigma=sigma)  # type: ignore[arg-type]


def test_settle_returns_whether_the_field_has_settled() -> None:
    model = dd.Model("noisy")
    model.add(dd.Field("u", [x], noise=1.0))
    assert not settle(dd.Session(model), limit=5)
    still = dd.Model("still")
    still.add(dd.Field("u", [x]))
    assert settle(dd.Session(still), limit=5).time_constants <= 5


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    model = dd.Model("m")
    model.add(lateral(12, 0, 0.6))
    model.add(dd.Field("n", [], tau=10, resting_level=-2, kernel=[dd.Gaussian(3.0)]), group="g")
    model.add(dd.GaussianStimulus("s", [x])) >> model["u"]
    dd.save(model, "m.json")
    return tmp_path


def test_the_command_prints_and_draws(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["regimes", "m.json", "u"]) == 0
    page = capsys.readouterr().out
    assert "tau 10 ms, resting level -5\n" in page
    assert "detection threshold" in page and "selective" in page and "m-regimes-001.png" in page
    with Image.open(folder / "m-regimes-001.png") as picture:
        assert picture.size[0] > 800
    assert main(["regimes", "m.json", "g.n", "--json", "-o", "n.svg"]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert answer["self_sustained"] is True and "du/dt" in (folder / "n.svg").read_text()
    assert main(["regimes", "m.json", "u", "-o", "n.svg"]) == 1 and "--force" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("element", "says"), [("v", "Did you mean"), ("s", "is not a Field"), ("u.activation", "element")]
)
def test_an_element_that_cannot_be_measured_is_an_error_and_writes_nothing(
    folder: Path, element: str, says: str, capsys: pytest.CaptureFixture[str]
) -> None:
    before = sorted(folder.iterdir())
    assert main(["regimes", "m.json", element]) == 1
    error = capsys.readouterr().err
    assert (
        (says in error or "there is no element" in error)
        and "Traceback" not in error
        and sorted(folder.iterdir()) == before
    )


def test_the_interval_of_a_threshold_holds_the_instability_at_every_accuracy() -> None:
    def fold(low: float, high: float) -> float:
        """Input at which a node with self-excitation 3 and steepness 4 loses a stable state: u = -2 + 3 g(u)
        + s, 3 g'(u) = 1.
        """
        u = optimize.brentq(lambda u: 12 / (2 * np.cosh(2 * u)) ** 2 - 1, low, high)
        return u + 2 - 3 / (1 + np.exp(-4 * u))

    node = dd.Field("n", [], tau=10, resting_level=-2, sigmoid=dd.Logistic(4), kernel=[dd.Gaussian(3.0)])
    exact = {"detection": fold(-3.0, 0.0), "reverse": fold(0.0, 3.0)}
    for precision, accuracies in (("float64", (1e-2, 1e-3, 1e-4, 1e-5)), ("float32", (1e-2, 1e-4))):
        isolated = isolate(node, precision=precision)
        for accuracy in accuracies:
            measured = thresholds(isolated, accuracy=accuracy)
            for name, exactly in exact.items():
                low, high = getattr(measured, name).interval
                assert low <= exactly <= high, (
                    precision,
                    accuracy,
                    name,
                    low - exactly,
                    high - exactly,
                )
                assert high - low <= 1.5 * accuracy * max(abs(exactly), 0.01 * isolated.scale) + (
                    2e-3 if precision == "float32" else 1.1e-5
                )


def held(samples: int, quadrature: str) -> dd.Field:
    """A memory whose edges are narrower than a sample on the coarse grid."""
    kernel = [dd.Gaussian(18, 5, normalized=True)]
    return dd.Field(
        "u", [dd.Axis("x", 0, 60, samples)], kernel=kernel, global_inhibition=0.3, quadrature=quadrature
    )


def test_the_discretisation_error_is_the_change_on_a_grid_twice_as_fine_and_smaller_with_cells() -> None:
    moved = {}
    for quadrature in ("point", "cell"):
        isolated = isolate(held(25, quadrature), sigma=5.0)
        lost = forgetting(isolated, 6.0, accuracy=1e-3)
        moved[quadrature] = discretisation(isolated, {"forgetting": lost}, 1.2, accuracy=1e-3)["forgetting"]  # type: ignore[dict-item]
        fine = forgetting(isolate(held(49, quadrature), sigma=5.0), 6.0, accuracy=1e-3)
        assert moved[quadrature] == pytest.approx(fine.value - lost.value, abs=2e-3)  # type: ignore[union-attr]
    assert abs(moved["point"]) > 0.05 > 5 * abs(moved["cell"])


def test_the_finer_grid_keeps_every_sample() -> None:
    field = dd.Field(
        "u",
        [
            dd.Axis("x", 0, 10, 11),
            dd.Axis("phi", 0, 360, 12, periodic=True),
            dd.Axis("one", 0, 1, 1, periodic=True),
        ],
    )
    for old, new, samples in zip(field.axes, refined(field).axes, (21, 24, 1), strict=True):
        assert new.samples == samples and np.allclose(new.points[::2], old.points)


@pytest.mark.parametrize(
    ("field", "says"),
    [
        (dd.Field("n", [], kernel=[dd.Gaussian(3.0)]), "a node has no grid"),
        (dd.Field("u", [dd.Axis(name, 0, 9, 100) for name in "xy"]), "39601 samples, more than 20000"),
        (dd.Field("u", [x], kernel=[Custom(np.ones(3))]), "custom kernel"),
    ],
    ids=["node", "large", "custom"],
)
def test_where_no_finer_grid_is_measured_the_reason_is_given(field: dd.Field, says: str) -> None:
    assert says in obstacle(isolate(field))


def called_once(call: Callable[..., Any]) -> Callable[..., Any]:
    """Return a function whose first call is made, and which later returns the answer of that call."""
    answers: list[Any] = []

    def first(*args: Any, **options: Any) -> Any:
        if not answers:
            answers.append(call(*args, **options))
        return answers[0]

    return first


def test_the_command_prints_the_interval_and_discretisation_error_of_every_threshold(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """As a table, and as data of the same measurement."""
    for module, name in (("regimes", "regimes"), ("continuation.confirmation", "confirmed")):
        place = importlib.import_module(f"deodar.analysis.{module}")
        monkeypatch.setattr(place, name, called_once(getattr(place, name)))
    model = dd.Model("m")
    model.add(held(25, "cell"))
    dd.save(model, tmp_path / "m.json")
    command = ["regimes", str(tmp_path / "m.json"), "u", "-o", str(tmp_path / "m.png")]
    assert main(command) == 0
    page = capsys.readouterr().out
    for line in ("detection threshold", "erased by a homogeneous input below", "by a localised input below"):
        (row,) = [text for text in page.splitlines() if line in text]
        assert " ± " in row and "discretisation error " in row
    assert main([*command, "--json", "--force"]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert (
        answer["intervals"].keys()
        == answer["discretisation_error"].keys()
        >= {"detection", "forgetting", "suppression"}
    )
    low, high = answer["intervals"]["forgetting"]
    assert low < answer["forgetting_boost"] < high and answer["discretisation_not_measured"] is None


def test_an_isolated_field_has_the_step_of_the_argument() -> None:
    field = lateral(12, 0, 0.6)
    assert isolate(field, dt=0.25).session.dt == 0.25
    assert isolate(field).session.dt == pytest.approx(min(max(1.0, field.tau / 100), field.tau / 10))
