"""The reference reproduces what real cedar computed, with noise off and iterations of 10 ms."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from tests.deodar_interop.importers.cedar.models import (
    DROP,
    OUT,
    TYPES,
    Many,
    Model,
    border,
    box,
    every_type,
    gauss,
    random_models,
    sigmoid,
)
from tests.deodar_interop.importers.cedar.oracle import KINDS, Architecture, Clock, iterate, load, run

DATA = Path(__file__).parent / "data"
AT = (1, 2, 5, 20, 100)
KNOWN_BUG = "2to3 20 short.output"


def stored(name):
    """Return the values of real cedar by iteration and slot."""
    with np.load(DATA / f"{name}.npz") as z:
        return {(int(n), slot): z[key] for key in z for slot, n in [key.rsplit("|", 1)]}


@pytest.mark.parametrize("name", sorted(path.stem for path in DATA.glob("*.json")))
def test_the_traces_of_cedar_are_reproduced(name):
    done = run(DATA / f"{name}.json", AT[-1], 10, AT)
    reference = stored(name)
    assert len(reference) > 50
    for (n, slot), expected in reference.items():
        slot_values = done[slot][AT.index(n)]
        assert slot_values.shape == expected.shape, slot
        if slot != KNOWN_BUG:
            assert np.abs(slot_values - expected).max() < (1e-4 if n <= 5 else 1e-3), (slot, n)


def test_where_cedar_leaves_slices_empty_the_reference_fills_them():
    computed = run(DATA / "projection_steps.json", 1, 10)[KNOWN_BUG][1]
    expected = stored("projection_steps")[1, KNOWN_BUG]
    wrong = np.abs(computed - expected).max(axis=(0, 2)) > 1e-4
    assert wrong.tolist() == [False] * 10 + [True] * 2
    assert np.abs(computed[:, 10:] - computed[:, :1]).max() == 0


def test_the_listeners_of_a_group_are_its_looped_steps():
    order = Architecture(DATA / "elementaryBehavior.json").order
    names = ["CoS field", "CoS node", "intention field", "intention node"]
    assert order == [f"Elementary behavior.{name}" for name in names]


def invalid(text):
    """Return the names of the steps that never run, and the connections that are skipped."""
    a = Architecture(text)
    with np.errstate(all="ignore"):
        load(a, Clock(10.0))
        iterate(a, Clock(10.0, 10.0))
    return {s.name for s in a.steps.values() if not s.valid or "stopped" in s.state}, a.skipped


def test_there_is_a_model_for_every_type_and_all_of_it_runs():
    models = every_type()
    assert {name.split(",")[0] for name in models} == set(KINDS) == set(TYPES.values())
    for name, text in models.items():
        assert invalid(text) == (set(), []), name
        values = run(text, 8, 10)
        assert all(np.isfinite(v).all() for v in values.values()), name
        moved = values["target.activation" if "target.activation" in values else "field 1.activation"]
        assert np.abs(moved[8] - moved[0]).max() > 1e-4, name


@pytest.mark.parametrize("seed", range(20))
def test_random_models_run(seed):
    text = random_models(seed)
    assert text == random_models(seed)
    assert invalid(text) == (set(), [])
    values = run(text, 5, 10)
    assert 5 <= len({key.rsplit(".", 1)[0] for key in values}) <= 20
    assert all(np.isfinite(v).all() for v in values.values())


def three_fields(triggers):
    m = Model(triggers=triggers)
    for name in "ABC":
        m.field(name, (4,))
    return m


def test_listeners_follow_those_that_no_trigger_lists():
    assert Architecture(three_fields(None).text()).order == ["A", "B", "C"]
    assert Architecture(three_fields({"default thread": ["A"]}).text()).order == ["B", "C", "A"]
    two = {"other": ["C", "A"], "default thread": ["B"]}
    assert Architecture(three_fields(two).text()).order == ["C", "A", "B"]
    assert Architecture(three_fields({"other": ["B"]}).text()).order == ["A", "C", "B"]


def test_a_later_listener_reads_the_new_output_of_an_earlier_one():
    for names, lag in ((["A", "B", "C"], 0), (["C", "B", "A"], 1)):
        m = three_fields({"default thread": names})
        m.wire(f"A.{OUT}", "B.input")
        values = run(m.text(), 6, 10)
        output, given = values[f"A.{OUT}"], values["B.input sum"]
        assert np.array_equal(given[1:], output[1 - lag : 7 - lag])
        assert output[0].max() == 0 and values["A.activation"][0].max() == -1.5


def test_a_step_that_several_fields_feed_runs_after_the_first():
    m = three_fields({"default thread": ["A", "B", "C"]})
    m.add("Sum", "sum")
    for k, name in enumerate("ABC"):
        m.add("Boost", f"boost {k}", {"strength": 1 + k, "active": True})
        m.wire(f"boost {k}.boost", f"{name}.input")
        m.wire(f"{name}.{OUT}", "sum.terms")
    values = run(m.text(), 5, 10)
    a, b, c = (values[f"{name}.{OUT}"] for name in "ABC")
    assert np.allclose(values["sum.sum"][1:], a[1:] + b[:-1] + c[:-1])


def only_field(sizes, kernels, shape="Zero", engine="OpenCV", inputs=()):
    """Return the lateral interaction of a field after its second iteration."""
    m = Model()
    convolution = border(shape, engine)
    linear = sigmoid("LinearTransferFunction", factor=1, offset=0)
    settings = {"resting_level": 0, "time_scale": 10, "sigmoid": linear}
    m.field("f", sizes, lateral_kernels=Many(kernels), lateral_kernel_convolution=convolution, **settings)
    for k, center in enumerate(inputs):
        shape_of_input = {"dimensionality": len(sizes), "sizes": list(sizes), "amplitude": 1}
        m.add("BoxInput", f"i {k}", {**shape_of_input, "left bounds": center, "widths": [1] * len(sizes)})
        m.wire(f"i {k}.box input", "f.input")
    if not inputs:
        m.add("Boost", "boost", {"strength": 1, "active": True})
        m.wire("boost.boost", "f.input")
    return run(m.text(), 2, 10)["f.lateral interaction"][2]


def test_a_node_excites_itself_by_the_middle_of_its_kernel_or_by_all_of_it():
    assert only_field((), [gauss(1, [3])]) == pytest.approx(0.1346, abs=1e-4)
    assert only_field((), [gauss(1, [3])], "Cyclic") == pytest.approx(1)
    assert only_field((), [gauss(1, [3])], "Zero", "FFTW") == pytest.approx(1)
    assert only_field((), [box(1, [1])]) == pytest.approx(1)


def test_even_kernels_have_other_centres_in_other_engines():
    """A box of width 4 covers the cells i - 2 to i + 1, or i - 1 to i + 2 seen from the cell that is read."""
    one = [[5]]
    assert np.flatnonzero(only_field((12,), [box(1, [4])], inputs=one)).tolist() == [4, 5, 6, 7]
    assert np.flatnonzero(only_field((12,), [box(1, [4])], "Zero", "FFTW", one)).tolist() == [3, 4, 5, 6]
    assert np.argmax(only_field((12,), [gauss(1, [1], shifts=[2])], inputs=one)) == 7
    assert np.argmax(only_field((12,), [gauss(1, [1], anchor=[2])], inputs=one)) == 7


def test_borders_repeat_wrap_or_end():
    line = [box(1, [5])]
    assert only_field((6,), line, "Zero", inputs=[[0]]).ravel().tolist() == [1, 1, 1, 0, 0, 0]
    assert only_field((6,), line, "Cyclic", inputs=[[0]]).ravel().tolist() == [1, 1, 1, 0, 1, 1]
    assert only_field((6,), line, "Replicate", inputs=[[0]]).ravel().tolist() == [3, 2, 1, 0, 0, 0]
    assert only_field((6,), line, "Reflect", inputs=[[0]]).ravel().tolist() == [2, 2, 1, 0, 0, 0]
    assert only_field((6,), line, "Reflect", "FFTW", inputs=[[0]]).ravel().tolist() == [1, 1, 1, 0, 1, 1]


def test_a_kernel_larger_than_the_field_stops_it_with_fftw():
    m = Model()
    large = Many([gauss(1, [3])])
    m.field("f", (10,), lateral_kernels=large, lateral_kernel_convolution=border("Cyclic", "FFTW"))
    m.field("g", (10,), lateral_kernels=large, lateral_kernel_convolution=border("Cyclic"))
    values = run(m.text(), 3, 10)
    assert values["f.activation"].tolist() == np.full((4, 10, 1), -1.5).tolist()
    assert np.abs(values["g.activation"][3] + 1.5).max() > 1e-3


def test_one_input_that_does_not_fit_stops_a_field_and_its_readers():
    m = three_fields(None)
    m.add("ConstMatrix", "matrix", {"sizes": [5], "value": 1})
    m.add("Boost", "boost", {"strength": 1, "active": True})
    m.add("StaticGain", "gain")
    for wire in ("matrix.matrix -> A.input", "boost.boost -> A.input", "boost.boost -> B.input"):
        m.wires.append(wire)
    m.wire(f"A.{OUT}", "gain.input")
    m.wire("gain.output", "C.input")
    assert invalid(m.text()) == ({"A", "gain", "C"}, [])
    values = run(m.text(), 3, 10)
    assert values["A.activation"].tolist() == np.full((4, 4, 1), -1.5).tolist()
    assert np.abs(values["B.activation"][3] + 1.5).max() > 0.1


def test_a_number_cannot_be_subtracted_from_a_matrix():
    m = Model()
    m.add("ConstMatrix", "matrix", {"sizes": [5], "value": 1})
    m.add("Boost", "boost", {"strength": 3, "active": True})
    m.add("SubtractElementwise", "difference")
    m.wire("matrix.matrix", "difference.minuend")
    m.wire("boost.boost", "difference.subtrahend")
    assert invalid(m.text()) == ({"difference"}, [])


@pytest.mark.parametrize(
    ("source", "mapping", "target", "runs"),
    [
        ((10,), {0: DROP}, (), True),
        ((10,), {0: DROP}, (10,), False),
        ((10,), {0: 0}, (10, 10), True),
        ((10, 10), {0: 0, 1: DROP}, (10,), True),
        ((10, 10), {0: 0, 1: 0}, (10, 10), False),
        ((10, 10), {0: 1, 1: 0}, (10, 10), True),
        ((5, 5, 5), {0: DROP, 1: DROP, 2: DROP}, (), True),
        ((5, 5, 5), {0: DROP, 1: 0, 2: DROP}, (5,), True),
        ((5, 5), {}, (5,), False),
        ((5, 5), {0: 1, 1: DROP}, (5,), False),
    ],
)
def test_projections_run_if_their_mapping_is_possible(source, mapping, target, runs):
    m = Model()
    m.add("ConstMatrix", "matrix", {"sizes": list(source), "value": 1})
    settings = {"dimension mapping": mapping, "output dimensionality": len(target)}
    m.add("Projection", "projection", {**settings, "output dimension sizes": list(target)})
    m.wire("matrix.matrix", "projection.input")
    m.field("f", target)
    m.wire("projection.output", "f.input")
    assert invalid(m.text())[0] == (set() if runs else {"projection", "f"})


def test_a_short_reward_allows_learning_for_its_fixed_duration():
    learned = run(every_type()[f"{TYPES['HebbianConnection']}, reward duration"], 60, 10)["step.weights"]
    assert (np.abs(np.diff(learned, axis=0)).max(axis=(1, 2)) > 0).sum() == 4


def test_a_step_with_a_source_and_a_field_is_computed_before_the_first_iteration():
    m = three_fields(None)
    m.add("Boost", "boost", {"strength": 2, "active": True})
    m.add("Sum", "sum")
    m.add("StaticGain", "gain", {"gain factor": 3})
    m.add("AddConstant", "later", {"constant": 1})
    for wire in ("boost.boost -> sum.terms", f"A.{OUT} -> sum.terms", "sum.sum -> gain.input"):
        m.wires.append(wire)
    m.wire(f"A.{OUT}", "later.input")
    values = run(m.text(), 1, 10)
    assert values["gain.output"][0].tolist() == [[6]] * 4
    assert values["later.output"][0].tolist() == [[0]] * 4


def test_connectors_of_nested_groups_only_pass_values_on():
    results = []
    for outer, inner in (((), ()), (("g",), ("g", "h")), (("g",), ("k", "h")), (("g", "h"), ())):
        m = Model()
        m.add("Boost", "boost", {"strength": 2, "active": True}, ())
        m.add("StaticGain", "gain", {"gain factor": 0.7}, outer)
        m.field("f", (5,))
        m.place["f"] = inner
        m.add("Preshape", "memory", {"dimensionality": 1, "sizes": [5], "sigmoid": sigmoid(beta=2)}, outer)
        m.wires += ["boost.boost -> gain.input", "gain.output -> f.input", f"f.{OUT} -> memory.input"]
        assert invalid(m.text()) == (set(), [])
        values = run(m.text(), 9, 10)
        results.append({key.split(".")[-2]: v for key, v in values.items() if "activation" in key})
    assert all(np.array_equal(other["f"], results[0]["f"]) for other in results)
    assert all(other["memory"][9].min() > 0 for other in results)


def test_every_scalar_of_a_written_model_is_a_text():
    kinds = set()

    def note(node):
        kinds.add(type(node))
        for inner in node if isinstance(node, list | tuple) else ():
            note(inner)

    note(json.loads(random_models(3), object_pairs_hook=list))
    assert kinds <= {list, tuple, str}
