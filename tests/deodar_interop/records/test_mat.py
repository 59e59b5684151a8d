"""Files of MATLAB: a record out, arrays in."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest
import scipy.io

import deodar as dd
from deodar.errors import OutputExists, RecordError, UnknownName
from deodar_interop.records import mat
from tests.deodar.recording.models import record

LONG = "a very long name " * 6


def test_a_record_is_written_with_its_coordinates_and_a_table_of_contents(tmp_path: Path) -> None:
    recording = record(trials=2)
    mat.save(recording, tmp_path / "a.mat")
    arrays = scipy.io.loadmat(tmp_path / "a.mat", simplify_cells=True)
    rows = {path: (name, list(np.atleast_1d(dims))) for name, path, dims, _ in arrays["contents"]}
    for path, variable in recording.variables.items():
        name, dims = rows[str(path)]
        assert dims == list(variable.dims)
        if variable.dtype.kind in "biuf":
            assert np.array_equal(np.squeeze(arrays[name]), np.squeeze(variable.values))
    units = {path: unit for _, path, _, unit in arrays["contents"]}
    assert units["time"] == recording["time"].attrs["units"]


def test_names_that_matlab_does_not_allow_are_replaced_and_stay_different(tmp_path: Path) -> None:
    first, second = (record()["u.activation"].rename(name) for name in (f"{LONG}1", f"{LONG}2"))
    data = first.to_dataset().merge(second.to_dataset()).rename({f"{LONG}1": "1 u -> u"})
    mat.save(data, tmp_path / "a.mat")
    arrays = scipy.io.loadmat(tmp_path / "a.mat")
    names = [str(row[0][0]) for row in arrays["contents"]]
    assert len(set(names)) == len(names) and all(name.isidentifier() and len(name) <= 63 for name in names)
    assert {"v_1_u____u"} <= set(names)


def test_a_file_is_not_replaced_without_force(tmp_path: Path) -> None:
    mat.save(record(), tmp_path / "a.mat")
    with pytest.raises(OutputExists):
        mat.save(record(), tmp_path / "a.mat")
    mat.save(record(), tmp_path / "a.mat", force=True)


def test_an_array_is_read_by_the_name_of_its_variable(tmp_path: Path) -> None:
    weights = np.arange(12.0).reshape(3, 4)
    inside = {"row": np.arange(3), "deeper": {"value": 2}}
    scipy.io.savemat(tmp_path / "a.mat", {"weights": weights, "results": inside, "text": "none"})
    assert np.array_equal(dd.load_mat(tmp_path / "a.mat", "weights"), weights)
    assert np.array_equal(dd.load_mat(tmp_path / "a.mat", "results.row"), [0, 1, 2])
    assert dd.load_mat(tmp_path / "a.mat", "results.deeper.value") == 2
    scipy.io.savemat(tmp_path / "b.mat", {"only": weights})
    assert np.array_equal(dd.load_mat(tmp_path / "b.mat"), weights)


def test_weights_of_a_file_are_those_of_the_model(tmp_path: Path) -> None:
    """`WeightMatrix` has sources as rows."""
    rng = np.random.default_rng(1)
    matrix, pattern = rng.normal(size=(5, 3)), rng.normal(size=5)
    scipy.io.savemat(tmp_path / "a.mat", {"weights": matrix, "pattern": pattern})
    x, y = dd.Axis("x", 1, 5, samples=5), dd.Axis("y", 1, 3, samples=3)
    m = dd.Model("m")
    p = m.add(dd.Pattern("p", [x], dd.load_mat(tmp_path / "a.mat", "pattern")))
    p >> m.add(dd.Weights(dd.load_mat(tmp_path / "a.mat", "weights").T, [y], name="w"))
    values = dd.simulate(m, 1, every=1, record=["w.output"], precision="float64")["w.output"].values[0]
    assert np.allclose(values, pattern @ matrix, rtol=0, atol=1e-12)


def test_an_array_that_is_not_there_is_an_error_with_the_names_that_are(tmp_path: Path) -> None:
    scipy.io.savemat(tmp_path / "a.mat", {"weights": np.eye(2), "other": {"inside": 1}, "text": "none"})
    with pytest.raises(RecordError, match="holds weights, other, text"):
        dd.load_mat(tmp_path / "a.mat")
    with pytest.raises(UnknownName, match="Did you mean 'weights'"):
        dd.load_mat(tmp_path / "a.mat", "weight")
    with pytest.raises(UnknownName, match=r"other\.inside"):
        dd.load_mat(tmp_path / "a.mat", "other.insid")
    for name in ("text", "other", "weights.further"):
        with pytest.raises((RecordError, UnknownName)):
            dd.load_mat(tmp_path / "a.mat", name)


@pytest.mark.parametrize("content", [b"", b"no file of MATLAB", b"MATLAB 5.0 MAT-file" + b"\1" * 400])
def test_a_file_that_is_no_file_of_matlab_is_an_error(content: bytes, tmp_path: Path) -> None:
    (tmp_path / "a.mat").write_bytes(content)
    with pytest.raises(RecordError, match="cannot be read"):
        dd.load_mat(tmp_path / "a.mat")
    with pytest.raises(RecordError, match="cannot be read"):
        dd.load_mat(tmp_path / "missing.mat")


def test_a_file_of_version_7_3_says_how_to_save_it_again(tmp_path: Path) -> None:
    head = b"MATLAB 7.3 MAT-file".ljust(124) + bytes([0, 2]) + b"IM"
    (tmp_path / "a.mat").write_bytes(head + bytes(400))
    with pytest.raises(RecordError, match="-v7"):
        dd.load_mat(tmp_path / "a.mat")


def test_complex_numbers_are_refused_and_real_ones_of_that_form_are_read(tmp_path):
    scipy.io.savemat(
        tmp_path / "c.mat", {"a": np.array([1 + 2j, 3]), "b": np.array([1 + 0j, 3]), "s": {"c": 2j}}
    )
    for name in ("a", "s.c"):
        with pytest.raises(RecordError, match=rf"c\.mat: .*{name}.* holds complex numbers.*real\(A\)"):
            dd.load_mat(tmp_path / "c.mat", name)
    assert dd.load_mat(tmp_path / "c.mat", "b").tolist() == [1, 3]


def test_a_pipe_is_refused_at_once(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(RecordError, match=r"pipe: is not a regular file\. Save its content in a file"):
        dd.load_mat(tmp_path / "pipe")
