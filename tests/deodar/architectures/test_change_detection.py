"""Same or different: the contrast field is active only at features that the memory lacks."""

from __future__ import annotations

import numpy as np
import pytest
import xarray

import deodar as dd
from deodar.analysis.peaks import peaks
from deodar.architectures.change_detection import LENGTH, TEST, change_trial

SAMPLE = (40.0, 130.0, 250.0)
TRIALS = 20


def trial(sample: tuple[float, ...], **sweep: list[float]) -> xarray.Dataset:
    """Run trials, recorded every 10 ms; the third item of the test is swept."""
    record = [f"{name}.activation" for name in ("contrast", "memory", "same", "different")]
    values = {f"test {len(sample)}.center": sweep["last"]}
    return dd.simulate(
        change_trial(sample, sample), LENGTH, record=record, every=10, trials=TRIALS, sweep=values
    )


def answers(trials: xarray.Dataset) -> tuple[np.ndarray, np.ndarray]:
    """Return whether `same` and `different` are on when the test ends."""
    before = trials.sel(time=TEST[1] - 10)
    return before["same.activation"].values > 0, before["different.activation"].values > 0


@pytest.fixture(scope="module")
def three() -> xarray.Dataset:
    return trial(SAMPLE, last=[250.0, 265.0, 285.0, 320.0])


def test_an_unchanged_display_is_the_same_and_a_changed_one_different_in_every_trial(
    three: xarray.Dataset,
) -> None:
    same, different = answers(three)
    assert same[0].all() and not different[0].any()
    assert different[2:].all() and not same[2:].any()


def test_a_small_change_is_not_detected(three: xarray.Dataset) -> None:
    """The memory still inhibits fifteen degrees away."""
    same, different = answers(three)
    assert same[1].all() and not different[1].any()


def test_decision_nodes_are_inactive_before_and_after_the_test(three: xarray.Dataset) -> None:
    for name in ("same", "different"):
        u = three[f"{name}.activation"]
        assert float(u.sel(time=slice(0, TEST[0])).max()) < 0 and float(u.sel(time=LENGTH).max()) < 0


def test_items_move_from_the_contrast_field_to_the_memory_field(three: xarray.Dataset) -> None:
    for k in range(TRIALS):
        trial = three.isel({"test 3.center": 2, "trial": k})
        memories = sorted(p.position[0] for p in peaks(trial["memory.activation"].sel(time=TEST[0])))
        assert memories == pytest.approx(SAMPLE, abs=8)
        assert not peaks(trial["contrast.activation"].sel(time=TEST[0] - 100)), "what is held is no news"
        assert [
            p.position[0] for p in peaks(trial["contrast.activation"].sel(time=TEST[0] + 70))
        ] == pytest.approx([285], abs=4)


@pytest.mark.parametrize("count", [1, 2])
def test_changes_among_fewer_items_are_detected(count: int) -> None:
    sample = SAMPLE[:count]
    same, different = answers(trial(sample, last=[sample[-1], sample[-1] + 60]))
    assert same[0].all() and different[1].all() and not (same & different).any()
