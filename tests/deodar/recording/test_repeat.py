"""A record is repeated from its provenance."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import deodar as dd
from deodar.architectures.saliency import saliency
from deodar.batch.simulate import simulate
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
    data = record(**settings)
    done = repeat(files.load_record(files.save_record(data, tmp_path / "record.zarr")), simulate)
    assert (
        done.same_bits
        and not done.differences
        and done.faithful
        and done.data.drop_attrs().identical(data.drop_attrs())
    )


@pytest.mark.parametrize(("version", "port"), [(2, "output"), (3, "activation")])
def test_the_path_of_a_field_has_the_meaning_of_the_version_of_the_record(version: int, port: str) -> None:
    data = dd.simulate(dd.Model(document=document(about(record()))), 5, record=f"u.{port}")
    made = about(data)
    made |= {"record": ["u"], "document": made["document"] | {"deodar": version}}
    assert repeat(data.assign_attrs({KEY: json.dumps(made)}), simulate).same_bits


def test_differences_of_versions_and_machine_are_listed() -> None:
    data = record()
    made = about(data)
    made["made_by"]["jaxlib"] = "0.0.1"
    made["made_by"]["machine"] = "another"
    changed = data.copy()
    changed["u.activation"] = data["u.activation"] + 0.25
    changed = changed.assign_attrs({KEY: json.dumps(made)})
    done = repeat(changed, simulate)
    assert not done.same_bits and done.faithful and done.largest["u.activation"] == pytest.approx(0.25)
    assert {d.what for d in done.differences} == {"jaxlib", "machine"} and "0.0.1 then" in str(done)


def test_a_difference_without_an_explanation_is_not_faithful() -> None:
    data = record()
    data["u.activation"] = data["u.activation"] + 1
    done = repeat(data, simulate)
    assert not done.faithful and "nothing explains it" in str(done)


def test_a_world_is_opened_again_and_must_be_the_same(tmp_path: Path) -> None:
    picture = np.zeros((8, 8, 3), np.uint8)
    picture[2:6, 2:6] = [255, 0, 0]
    Image.fromarray(picture).save(tmp_path / "p.png")
    data = dd.simulate(
        saliency(), 50, record=["colour.activation"], every=50, world=Picture(tmp_path / "p.png")
    )
    assert repeat(data, simulate).same_bits
    picture[0, 0] = 9
    Image.fromarray(picture).save(tmp_path / "p.png")
    with pytest.raises(dd.errors.WorldError, match="--world picture"):
        repeat(data, simulate)
    (tmp_path / "p.png").unlink()
    with pytest.raises(dd.errors.WorldError, match="--world picture"):
        repeat(data, simulate)


def test_repeating_a_record_with_functions_requires_trust() -> None:
    made = dd.Model("function")
    made.add(Function("f", [x]))
    data = dd.simulate(made, 3, record=["f.output"])
    with pytest.raises(dd.errors.Untrusted):
        repeat(data, simulate)
    assert repeat(data, simulate, trust=True).same_bits


def test_a_record_without_its_document_cannot_be_repeated() -> None:
    data = record().assign_attrs({KEY: "{}"})
    with pytest.raises(dd.errors.RecordError):
        repeat(data, simulate)


def test_nan_in_only_one_of_two_records_is_a_difference() -> None:
    data = record()
    diverged = data.copy(deep=True)
    diverged["u.activation"].values[-1, 0] = np.nan
    both = compare(diverged, diverged.copy(deep=True))
    assert both.same_bits and both.largest["u.activation"] == 0
    for old, new in ((data, diverged), (diverged, data)):
        done = compare(old, new)
        assert not done.same_bits and done.largest["u.activation"] == float("inf")


def test_different_bits_of_nan_are_not_a_difference_of_values() -> None:
    old, new = record(), record()
    old["u.activation"].values[-1, 0], new["u.activation"].values[-1, 0] = np.nan, -np.float32(np.nan)
    new["u.activation"].values[-1, 1] += 0.5
    assert compare(old, new).largest["u.activation"] == pytest.approx(0.5)


@pytest.mark.parametrize(
    ("described", "shown"),
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
    described: dict[str, str], shown: str
) -> None:
    says = f"the record was made with the world {shown}, which is not known here"
    with pytest.raises(dd.errors.WorldError, match=re.escape(says)) as caught:
        _world(described)
    assert caught.value.problems[0].fix == "Give it: --world nowhere:FILE"
