"""Copies and pickles of the objects of scripts: axes, elements, documents, models and snapshots."""

from __future__ import annotations

import copy
import dataclasses
import pickle
import subprocess
import sys

import numpy as np
import pytest

import deodar as dd
from deodar.errors import AxesError, Untrusted
from deodar.parameters import FrozenArray
from tests.contracts.build import KINDS, PARTS, any_example, around, record, session
from tests.deodar.session.test_exchange import Tank, closed

COPIES = {
    "copy": copy.copy,
    "deepcopy": copy.deepcopy,
    **{
        f"pickle {n}": lambda value, n=n: pickle.loads(pickle.dumps(value, n))
        for n in (0, 2, pickle.HIGHEST_PROTOCOL)
    },
}


def test_public_values_cannot_be_changed_so_that_copies_may_share_them():
    public = {getattr(module, name) for module in (dd, dd.analysis) for name in module.__all__}
    kinds = {kind for kind in public if isinstance(kind, type) and dataclasses.is_dataclass(kind)}
    assert len(kinds) > 100
    assert {kind.__name__ for kind in kinds if not kind.__dataclass_params__.frozen} == set()


@pytest.fixture(params=COPIES)
def copied_by(request):
    """Return a function that copies or pickles an object."""
    return COPIES[request.param]


@pytest.mark.parametrize(
    "axis",
    [
        dd.Axis("x", 0, 100, samples=101),
        dd.Axis("hue", -180, 180, samples=36, periodic=True, unit="deg"),
        dd.Axis("lone", 0, 1, samples=1, periodic=True),
    ],
    ids=lambda a: a.name,
)
def test_an_axis_is_copied_and_pickled(axis, copied_by):
    other = copied_by(axis)
    assert other == axis and hash(other) == hash(axis) and str(other) == str(axis)
    assert np.array_equal(other.points, axis.points)


def test_a_pickled_axis_is_checked_when_it_is_read():
    axis = dd.Axis("x", 0, 100, samples=101)
    object.__setattr__(axis, "upper", -1.0)
    with pytest.raises(AxesError, match="not below"):
        pickle.loads(pickle.dumps(axis))


def test_a_copied_array_parameter_stays_read_only(copied_by):
    array = FrozenArray([[1.0, 2.0], [3.0, 4.0]])
    other = copied_by(array)
    assert other == array and hash(other) == hash(array) and np.array_equal(other.data, array.data)
    with pytest.raises(ValueError, match="read-only"):
        other.data[0, 0] = 5.0


@pytest.mark.parametrize("kind", [*KINDS, *PARTS])
def test_every_registered_kind_is_copied_and_pickled(kind):
    element = any_example(kind)
    for how, copied_by in COPIES.items():
        other = copied_by(element)
        assert (type(other), other, hash(other)) == (type(element), element, hash(element)), how


@pytest.mark.parametrize("kind", [*KINDS, *PARTS])
def test_documents_and_models_of_every_kind_are_copied_and_pickled(kind):
    model = around(any_example(kind))
    model.parameter("gain", 2.0)
    for copied_by in COPIES.values():
        other = copied_by(model)
        assert copied_by(model.document) == model.document == other.document
        assert copied_by(model.document).by_id().keys() == model.document.by_id().keys()


def test_the_copy_of_a_model_is_edited_alone(copied_by):
    model = around(any_example("Field"))
    model.set("example.tau", 30.0)
    other = copied_by(model)
    other.set("example.tau", 40.0)
    assert model.get("example.tau") == 30.0 and other.get("example.tau") == 40.0
    assert other.undo() and other.undo() and other.get("example.tau") == 20.0
    assert model.get("example.tau") == 30.0
    assert model.undo()


def test_a_handle_is_copied_with_its_model():
    model = around(any_example("Field"))
    for copied_by in (copy.deepcopy, COPIES["pickle 5"]):
        other, handle = copied_by((model, model["example"]))
        assert handle.model is other and handle.path == "example"


def test_copies_contain_no_compiled_programs(copied_by):
    model = around(any_example("Field"))
    dd.simulate(model, 2, record=["example"])
    assert model.programs
    assert not copied_by(model).programs


def test_a_copied_model_gives_the_same_bits():
    model = around(any_example("Field"), noisy=True)
    first = record(model, 20, ["example"], seed=3)["example.activation"].values
    for name in ("deepcopy", "pickle 5"):
        assert np.array_equal(
            record(COPIES[name](model), 20, ["example"], seed=3)["example.activation"].values, first
        )


def test_a_session_continues_from_a_copied_snapshot_as_from_the_snapshot(copied_by):
    model = around(any_example("Field"), noisy=True)
    running = session(model, seed=5)
    running.step(7)
    snapshot = running.snapshot()
    running.step(5)
    expected = running.read("example.activation")
    other = session(model, seed=5)
    other.restore(copied_by(snapshot))
    other.step(5)
    assert np.array_equal(other.read("example.activation"), expected)


def test_a_pickled_snapshot_holds_the_state_of_its_world():
    """Two sessions of one model in a tank: the second one is restored from a pickle and continues as the
    first.
    """
    one, two = dd.Session(closed(True), world=Tank()), dd.Session(closed(True), world=Tank())
    one.step(9)
    copied = pickle.loads(pickle.dumps(one.snapshot()))
    one.step(6)
    two.restore(copied)
    two.step(6)
    assert one.read("level").any() and np.array_equal(one.read("level"), two.read("level"))


# ------------------------------------------------------------------------------------------------------ trust


def foreign(tmp_path, trust):
    """Return a document that names a function, read from a file."""
    dd.save(around(KINDS["Function"].example()), tmp_path / "foreign.json", force=True)
    return dd.load(tmp_path / "foreign.json", trust=trust)


@pytest.mark.parametrize("trust", [False, True])
def test_a_copy_in_the_same_process_has_the_trust_of_its_model(trust, tmp_path):
    model = foreign(tmp_path, trust)
    assert copy.copy(model).trusted is copy.deepcopy(model).trusted is trust


def test_a_pickle_contains_no_trust(tmp_path):
    copied = pickle.loads(pickle.dumps(foreign(tmp_path, trust=True)))
    with pytest.raises(Untrusted, match=r"dd\.Model\(document=model\.document, trusted=True\)"):
        dd.Session(copied)
    with pytest.raises(Untrusted):
        dd.Session(dd.Model(document=copied.document))
    dd.Session(dd.Model(document=copied.document, trusted=True)).step()


def test_undo_after_unpickling_does_not_restore_trust(tmp_path):
    model = foreign(tmp_path, trust=True)
    model.remove(model.document.entries[0].path)
    assert not any(e.element.external_code() for e in model.document.entries)
    copied = pickle.loads(pickle.dumps(model))
    copied.undo()
    with pytest.raises(Untrusted):
        dd.Session(copied)


def test_a_pickled_model_without_functions_accepts_functions_of_the_script():
    copied = pickle.loads(pickle.dumps(around(any_example("Field"))))
    copied.add(KINDS["Function"].example(), group="own")
    assert copied.trusted


def test_reading_a_pickled_model_runs_none_of_the_functions_it_names(tmp_path):
    """Another process reads the model, and does not import the module of its function before that is
    trusted.
    """
    (tmp_path / "strange_functions.py").write_text("print('imported')\ndef twice(u):\n    return 2 * u\n")
    model = dd.Model("foreign")
    model.add(dd.Field("u", [dd.Axis("x", 0, 10, 11)])) >> model.add(
        KINDS["Function"]("f", function="strange_functions:twice")
    )
    (tmp_path / "model.pickle").write_bytes(pickle.dumps(model))
    code = "import pickle; m = pickle.load(open('model.pickle', 'rb')); m.check(); print(m.trusted)"
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, check=True
    )
    assert done.stdout.split() == ["False"]
