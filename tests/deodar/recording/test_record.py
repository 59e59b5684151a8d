"""The labels of a record."""

from __future__ import annotations

import json

import numpy as np
import pytest
import xarray

import deodar as dd
from deodar import file_version
from deodar.couplings.weights import Weights
from deodar.errors import DamagedFile
from deodar.recording import provenance
from deodar.recording.record import about
from tests.deodar.recording.models import model, record, x


def test_a_record_has_dimensions_coordinates_and_units() -> None:
    recorded = record(trials=[4, 2], sweep={"s.amplitude": [1, 2, 3]})
    u = recorded["u.activation"]
    assert u.dims == ("s.amplitude", "trial", "time", "x") and u.shape == (3, 2, 5, 11)
    assert recorded["trial"].values.tolist() == [4, 2] and recorded["time"].values.tolist() == [
        0,
        5,
        10,
        15,
        20,
    ]
    assert (
        recorded["time"].attrs["units"] == "ms"
        and recorded["x"].attrs["units"] == "deg"
        and recorded["y"].attrs["periodic"] == 1
    )
    assert np.allclose(recorded["x"].values, x.points) and recorded["n.activation"].dims == (
        "s.amplitude",
        "trial",
        "time",
    )
    assert (u.values[:, :, 0] == -5).all()


def test_trial_is_a_dimension_only_where_trials_are_given() -> None:
    assert "trial" not in record().dims and record(trials=1).sizes["trial"] == 1


def test_axes_of_equal_name_and_different_sampling_are_separate_dimensions() -> None:
    model = dd.Model("names")
    model.add(dd.Field("coarse", [dd.Axis("x", 0, 20, samples=6)]))
    model.add(dd.Field("fine", [x]))
    model.add(dd.Field("again", [x]))
    model.add(dd.Field("clock", [dd.Axis("time", 0, 1, samples=4)]))
    record = dd.simulate(model, 1)
    dims = {str(name): v.dims[1:] for name, v in record.data_vars.items()}
    assert dims == {
        "coarse.activation": ("x",),
        "fine.activation": ("fine.activation.x",),
        "again.activation": ("again.activation.x",),
        "clock.activation": ("clock.activation.time",),
    }
    assert len(record["fine.activation.x"]) == 11


def test_a_record_states_document_seed_and_versions() -> None:
    recorded = record(precision="float64", dt=0.5)
    provenance = about(recorded)
    assert (
        {**provenance["document"], "written_by": file_version.HERE} == json.loads(model().to_json())
        and provenance["seed"] == 3
        and provenance["dt"] == 0.5
    )
    assert (
        provenance["precision"] == "float64"
        and provenance["every"] == 5
        and provenance["complete"] is True
        and provenance["duration"] == 20
    )
    assert {"deodar", "jax", "jaxlib", "numpy", "python", "device", "machine"} <= set(provenance["made_by"])


def test_a_record_contains_the_arrays_of_its_document() -> None:
    from deodar.recording.provenance import document

    model = dd.Model("arrays")
    u = model.add(dd.Field("u", [x]))
    u >> model.add(Weights(np.arange(121.0).reshape(11, 11), [x], name="w")) >> u
    assert document(about(dd.simulate(model, 1))) == model.document


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("{", "not JSON"),
        ("[1]", "not an object"),
        ('{"document": 3}', "states 3 as its document"),
        ('{"world": "arena"}', "states 'arena' as its world"),
        ('{"made_by": []}', "states \\[\\] as its made_by"),
    ],
)
def test_a_provenance_of_another_form_is_damage(text: str, message: str) -> None:
    with pytest.raises(DamagedFile, match=message):
        about(xarray.Dataset(attrs={provenance.KEY: text}))


@pytest.mark.parametrize("origin", [{}, {"document": {"deodar": 3}, "arrays": "a"}])
def test_a_provenance_without_a_document_is_damage(origin: dict[str, object]) -> None:
    with pytest.raises(DamagedFile, match="is damaged: "):
        provenance.document(origin)
