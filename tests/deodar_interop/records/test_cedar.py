"""Records that cedar wrote are read, and those that are written for it."""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd
from deodar.errors import RecordError
from deodar_interop.records import cedar


def test_a_folder_of_cedar_opens_with_times_in_ms_and_the_first_index_fastest(tmp_path):
    (tmp_path / "u_activation.csv").write_text("Mat,CV_32F,2,3\n0.02 s,1,2,3,4,5,6\n0.04 s,7,8,9,10,11,12\n")
    (tmp_path / "node_output.csv").write_text("Mat,CV_32F,1,1\n0.02 s,0.5\n0.04 s,0.25\n")
    (tmp_path / "Trial_1").mkdir()
    (tmp_path / "Trial_1" / "v.csv").write_text("Mat,CV_32F,3,1\n1e-1 s,1,2,3\n")
    record = dd.load_cedar(tmp_path)
    assert list(record.data_vars) == ["Trial_1/v", "node_output", "u_activation"]
    assert record["u_activation"].values[0].tolist() == [[1, 3, 5], [2, 4, 6]]
    assert record["u_activation"].sizes["x of u_activation"] == 2
    assert record["node_output"].dims == record["u_activation"].dims[:1]
    assert record["node_output"][record["node_output"].dims[0]].values.tolist() == [20, 40]
    assert record["Trial_1/v"][record["Trial_1/v"].dims[0]].values.tolist() == [100]


def test_what_deodar_writes_for_cedar_is_read_again(tmp_path):
    x, y = dd.Axis("x", 0, 4, 5), dd.Axis("y", 0, 2, 3)
    model = dd.Model("written")
    model.add(dd.GaussianStimulus("s", [x, y], center=[1, 2], sigma=1, amplitude=5)) >> model.add(
        dd.Field("u", [x, y], tau=50, noise=0.1)
    )
    recording = dd.simulate(model, 40, dt=10, record=["u.activation"], every=10, seed=3)
    cedar.save(recording, tmp_path / "out")
    record = dd.load_cedar(tmp_path / "out")
    np.testing.assert_array_equal(
        record["u.activation"].values.astype(np.float32), recording["u.activation"].values
    )
    np.testing.assert_allclose(record["time"].values, recording["time"].values)


def test_a_recording_that_was_cut_off_keeps_its_whole_lines(tmp_path):
    path = tmp_path / "u.csv"
    path.write_text("Mat,CV_32F,3,1\n0.02 s,1,2,3\n0.04 s,1,2")
    assert dd.load_cedar(path)["u"].values.tolist() == [[1, 2, 3]]


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("time,u\n0,1\n", "is not a file of cedar's recorder"),
        ("Mat,CV_32F,3,-1\n", "is not a file of cedar's recorder"),
        ("Mat,CV_32F,2,1\n0.02 s,1\n0.04 s,1,2\n", "line 2 is not a time in seconds and 2 numbers"),
        ("", "is not a file of cedar's recorder"),
    ],
)
def test_other_files_are_one_error(tmp_path, text, why):
    path = tmp_path / "u.csv"
    path.write_text(text)
    with pytest.raises(RecordError, match=why):
        dd.load_cedar(path)


def test_a_place_without_files_is_named(tmp_path):
    with pytest.raises(RecordError, match="neither a CSV file nor a folder with some"):
        dd.load_cedar(tmp_path / "none")
