"""The steered shift and the diagonals of a field are the same transformation: as couplings exactly, as
fields to a fraction of a sample.
"""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd
from deodar.analysis.peaks import peaks
from deodar.architectures.reference_frame import BODY, GAZE, RETINA, reference_frame
from deodar.couplings.arithmetic import Product
from deodar.couplings.convolutions import SteeredShift
from deodar.couplings.projections import DiagonalSum, Project, Resample
from deodar.elements.stimuli import Boost, Pattern
from deodar.errors import ParameterError


def test_both_couplings_give_the_same_values() -> None:
    """For any pattern and any gaze on the grid, the product of both, summed along diagonals, is the
    pattern moved by the gaze.
    """
    rng = np.random.default_rng(0)
    wide = dd.Axis(RETINA.name, BODY.lower, BODY.upper, BODY.samples, unit=RETINA.unit)
    for gaze in (-30.0, -7.0, 0.0, 13.0, 30.0):
        model = dd.Model("both")
        pattern = model.add(Pattern("pattern", [RETINA], rng.normal(size=RETINA.samples)))
        place = model.add(Pattern("place", [GAZE], (GAZE.points == gaze) / GAZE.step))
        number = model.add(Boost("number", [], amplitude=gaze))
        expanded = pattern >> model.add(Project([RETINA, GAZE], name="expand"))
        product = model.add(Product(name="both"))
        expanded >> product
        model.connect(place >> model.add(Project([RETINA, GAZE], name="gaze expands")), "both.factor")
        product >> model.add(DiagonalSum([BODY], name="diagonal"))
        (
            pattern
            >> model.add(Resample([wide], name="wide"))
            >> model.add(SteeredShift([RETINA.name], name="steered"))
        )
        model.connect(number, "steered.by")
        record = dd.simulate(
            model, 0, record=["diagonal.output", "steered.output"], precision="float64"
        ).isel(time=0)
        assert np.abs(record["diagonal.output"].values).max() > 1
        assert record["diagonal.output"].values == pytest.approx(record["steered.output"].values, abs=1e-12)


@pytest.mark.parametrize("form", ["diagonal", "steered"])
def test_a_peak_is_at_the_sum_of_position_and_gaze(form: str) -> None:
    model = reference_frame(form, noise=0.0)
    gaze = model.add(Boost("at", [], amplitude=0.0))
    gaze >> model["gaze"]
    model.add(dd.GaussianStimulus("object", [RETINA], center=0.0, sigma=3, amplitude=6)) >> model["retina"]
    places, gazes = [-15.0, -3.5, 0.0, 8.0, 20.0], [-20.0, -6.25, 0.0, 11.0, 20.0]
    record = dd.simulate(
        model,
        400,
        record=["body.activation"],
        every=400,
        sweep={"object.center": places, "at.amplitude": gazes},
    )
    for x in places:
        for g in gazes:
            (peak,) = peaks(
                record["body.activation"].isel(time=-1).sel({"object.center": x, "at.amplitude": g})
            )
            assert peak.position[0] == pytest.approx(x + g, abs=0.5), (x, g)


@pytest.mark.parametrize("form", ["diagonal", "steered"])
def test_several_objects_are_transformed_together(form: str) -> None:
    model = reference_frame(form)
    model.add(Boost("at", [], amplitude=10.0)) >> model["gaze"]
    for place in (-20.0, 0.0, 20.0):
        (
            model.add(
                dd.GaussianStimulus(f"object at {place:g}", [RETINA], center=place, sigma=3, amplitude=6.5)
            )
            >> model["retina"]
        )
    record = dd.simulate(model, 500, record=["body.activation"], every=500, trials=5)["body.activation"].isel(
        time=-1
    )
    for trial in range(5):
        assert sorted(p.position[0] for p in peaks(record.isel(trial=trial))) == pytest.approx(
            [-10, 10, 30], abs=0.6
        )


@pytest.mark.parametrize("form", ["diagonal", "steered"])
def test_gaze_without_an_object_creates_no_peak(form: str) -> None:
    model = reference_frame(form)
    model.add(Boost("at", [], amplitude=10.0)) >> model["gaze"]
    assert float(dd.simulate(model, 500, record=["body.activation"], every=10)["body.activation"].max()) < 0


def test_an_unknown_form_is_refused() -> None:
    with pytest.raises(ParameterError, match=r"form is 'diagnal'.*Did you mean 'diagonal'"):
        reference_frame("diagnal")
