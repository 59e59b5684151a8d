"""Handles: parameters are attributes, ports are items, and misspelt names are refused."""

from __future__ import annotations

import copy
import pickle
import re
from collections.abc import Callable

import numpy as np
import pytest

import deodar as dd
from deodar.couplings.weights import Weights
from deodar.element import Coupling, Element
from deodar.elements.changing_stimuli import Noise
from deodar.errors import DeodarError, ParameterError, UnknownName
from deodar.model.handle import Handle
from deodar.model.part_handle import PartHandle, PartsHandle
from deodar.parameters import parameters
from tests.contracts.build import KINDS, PARTS

X = dd.Axis("x", 0, 10, samples=11, unit="deg")


@pytest.fixture
def model() -> dd.Model:
    model = dd.Model("m")
    model.add(dd.Field("u", [X], kernel=[dd.Gaussian(amplitude=1.2, sigma=2)]), group="g")
    model.add(dd.Field("v", [X]))
    return model


@pytest.fixture
def u(model: dd.Model) -> Handle:
    return model["g.u"]


# ---------------------------------------------------------------------------------------------------- reading


def test_a_parameter_is_read_at_its_present_value(model: dd.Model, u: Handle) -> None:
    assert u.tau == 20.0 and u.axes == (X,) and u.name == "u"
    model.set("g.u.tau", 30)
    assert u.tau == 30.0
    model.undo()
    assert u.tau == 20.0
    model.rename(u, "w")
    assert u.tau == 20.0 and u.name == "w"


def test_a_linked_parameter_reads_as_the_value_of_the_document_parameter(model: dd.Model, u: Handle) -> None:
    model.parameter("slow", 80.0)
    model.link("g.u.tau", "slow")
    assert u.tau == 80.0
    model.set("slow", 90)
    assert u.tau == 90.0
    with pytest.raises(ParameterError, match="driven by the document parameter 'slow'"):
        u.tau = 5
    model.unlink("g.u.tau")
    assert u.tau == 90.0


def test_parts_are_read_inside_the_model(model: dd.Model, u: Handle) -> None:
    assert u.kernel[0].sigma == 2.0 and u.kernel[-1].sigma == 2.0 and len(u.kernel) == 1
    assert u.sigmoid.beta == 4.0 and u.sigmoid == dd.Logistic(beta=4) and u.kernel[0] == dd.Gaussian(1.2, 2)
    assert [k.amplitude for k in u.kernel] == [1.2] and u.kernel == (dd.Gaussian(1.2, 2),)
    assert u.sigmoid != dd.Logistic(beta=5) and u.kernel != ()
    kernel = u.kernel[0]
    model.set("g.u.kernel.0.sigma", 3)
    assert kernel.sigma == 3.0
    assert float(u.sigmoid(0.0)) == 0.5, "what a part can do, its handle can"


@pytest.mark.parametrize(
    "where",
    [lambda u: u.tua, lambda u: u.kernel[0].sigm, lambda u: u.sigmoid.bet, lambda u: u["activation"].tua],
)
def test_a_misspelt_parameter_is_refused_with_the_nearest_name(
    u: Handle, where: Callable[[Handle], object]
) -> None:
    with pytest.raises(UnknownName, match=r"Did you mean '(tau|sigma|beta)'"):
        where(u)
    with pytest.raises(AttributeError):
        where(u)


def test_a_port_used_as_an_attribute_states_how_to_write_it(u: Handle) -> None:
    with pytest.raises(
        UnknownName, match=re.escape('g.u.activation is a port, not a parameter. Write: u["activation"]')
    ):
        _ = u.activation
    with pytest.raises(UnknownName, match=re.escape('Write: u["activation"]')):
        u.activation = 3
    assert not hasattr(u, "activation") and hasattr(u, "tau")


def test_an_index_beyond_the_parts_is_an_index_error_that_states_their_number(u: Handle) -> None:
    with pytest.raises(IndexError, match=r"g\.u\.kernel has 1 part, counted from 0; there is no part 1"):
        u.kernel[1]
    with pytest.raises(ParameterError, match="the index of a part is a whole number, not 'a'"):
        u.kernel["a"]


def test_a_handle_of_a_removed_element_is_an_error(model: dd.Model, u: Handle) -> None:
    kernel = u.kernel[0]
    model.remove(u)
    for read in (lambda: u.tau, lambda: setattr(u, "tau", 3), lambda: kernel.sigma):
        with pytest.raises(UnknownName, match="was removed from the model"):
            read()
    assert "removed" in repr(u) and "removed" in repr(kernel)
    assert "tau" not in dir(u)


# -------------------------------------------------------------------------------------------------- assigning


def test_an_assignment_is_one_change_of_the_model(model: dd.Model, u: Handle) -> None:
    before = model.document
    u.tau = 30
    assert model.get("g.u.tau") == 30.0 and type(model.get("g.u.tau")) is float
    assert model.undo() and model.document is before


def test_parts_are_assigned(model: dd.Model, u: Handle) -> None:
    u.kernel[0].sigma = 3
    u.sigmoid.beta = 5
    assert model.get("g.u.kernel.0.sigma") == 3.0 and model.get("g.u.sigmoid.beta") == 5.0
    u.kernel[0] = dd.Gaussian(2, 1)
    assert model.get("g.u.kernel") == (dd.Gaussian(2, 1),)
    u.kernel = [*u.kernel, dd.Gaussian(-1, 4)]
    assert model.get("g.u.kernel") == (dd.Gaussian(2, 1), dd.Gaussian(-1, 4))
    u.kernel += [dd.Gaussian(3, 3)]
    assert len(u.kernel) == 3
    u.kernel = []
    assert model.get("g.u.kernel") == ()


def test_a_part_is_deleted(model: dd.Model, u: Handle) -> None:
    u.kernel = [dd.Gaussian(1, 3), dd.Gaussian(-1, 9)]
    del u.kernel[-1]
    assert u.kernel == [dd.Gaussian(1, 3)]
    assert model.undo() and len(u.kernel) == 2
    with pytest.raises(IndexError, match=r"u.kernel has 2 parts, counted from 0; there is no part 2"):
        del u.kernel[2]


def test_parts_of_one_element_are_assigned_to_another(model: dd.Model, u: Handle) -> None:
    model["v"].kernel = u.kernel
    model["v"].sigmoid = u.sigmoid
    w = model.add(dd.Field("w", u.axes, kernel=[u.kernel[0], dd.Gaussian(-1, 4)], sigmoid=u.sigmoid))
    for field in (model["v"].element, w.element):
        assert (
            isinstance(field, dd.Field)
            and type(field.sigmoid) is dd.Logistic
            and type(field.kernel[0]) is dd.Gaussian
        )
    u.kernel[0].sigma = 4
    assert model["v"].kernel[0].sigma == 2.0, "the values are given, not the handle"


@pytest.mark.parametrize(
    ("change", "error", "problem"),
    [
        (
            lambda u: setattr(u, "tua", 3),
            UnknownName,
            "g.u.tua: Field has no parameter 'tua'. Did you mean 'tau'?",
        ),
        (lambda u: setattr(u, "tau", -1), ParameterError, r"g.u.tau: is -1, below its lower bound"),
        (lambda u: setattr(u, "tau", "slow"), ParameterError, "needs a number, not 'slow'"),
        (lambda u: setattr(u, "name", "w"), ParameterError, "renaming the element"),
        (lambda u: setattr(u, "path", "w"), ParameterError, "belongs to the handle"),
        (lambda u: setattr(u, "_private", 1), UnknownName, "no parameter '_private'"),
        (
            lambda u: setattr(u.kernel[0], "sigm", 3),
            UnknownName,
            "g.u.kernel.0.sigm: Gaussian has no parameter 'sigm'. Did you mean 'sigma'?",
        ),
        (lambda u: setattr(u.kernel[0], "sigma", -3), ParameterError, "sigma.* below its lower bound"),
        (lambda u: u.kernel.append(dd.Gaussian()), UnknownName, r"Write: u.kernel = \[\*u.kernel, part\]"),
        (lambda u: setattr(u.kernel, "sigma", 3), UnknownName, r"Write: u.kernel\[0\].sigma"),
        (lambda u: u.kernel.sigma, UnknownName, r"Write: u.kernel\[0\].sigma"),
        (lambda u: delattr(u, "tau"), ParameterError, "cannot be deleted"),
        (lambda u: delattr(u.kernel[0], "sigma"), ParameterError, "cannot be deleted"),
    ],
)
def test_an_assignment_is_checked_like_any_change(
    model: dd.Model, u: Handle, change: Callable[[Handle], object], error: type[DeodarError], problem: str
) -> None:
    before = model.document
    with pytest.raises(error, match=problem):
        change(u)
    assert model.document is before


# ---------------------------------------------------------------------------------------------------- showing


def test_repr_shows_kind_path_axes_and_what_is_not_default(model: dd.Model, u: Handle) -> None:
    assert repr(u) == "<Field g.u [x 0..10 deg, 11 samples]: kernel=[Gaussian(amplitude=1.2, sigma=2.0)]>"
    u.tau = 30
    u.sigmoid.beta = 2
    assert (
        repr(u) == "<Field g.u [x 0..10 deg, 11 samples]: tau=30.0, sigmoid=Logistic(beta=2.0),"
        " kernel=[Gaussian(amplitude=1.2, sigma=2.0)]>"
    )
    model.parameter("slow", 80.0)
    model.link("g.u.tau", "slow")
    assert "tau=80.0 (slow)" in repr(u)
    assert repr(model["v"]) == "<Field v [x 0..10 deg, 11 samples]>"
    assert repr(model.add(dd.Field("n", []))) == "<Field n>"
    assert repr(u["activation"]) == "<Field g.u.activation>"
    ring = dd.Axis("angle", 0, 360, samples=72, periodic=True)
    assert (
        repr(model.add(Noise("z", [X, ring], amplitude=2)))
        == "<Noise z [x 0..10 deg, 11 samples; angle 0..360, 72 samples, periodic]: amplitude=2.0>"
    )
    assert repr(u.kernel[0]) == "<g.u.kernel.0: Gaussian(amplitude=1.2, sigma=2.0)>"
    assert repr(u.kernel) == "<g.u.kernel: [Gaussian(amplitude=1.2, sigma=2.0)]>"


def test_repr_of_large_parameters_is_one_short_line(model: dd.Model) -> None:
    weights = model.add(Weights(np.ones((11, 11)), [X], name="w"))
    assert repr(weights) == "<Weights w [x 0..10 deg, 11 samples]: weights=array[11, 11]>"


def test_completion_lists_parameters_and_ports(u: Handle) -> None:
    assert {"tau", "kernel", "sigmoid", "path", "element"} <= set(dir(u))
    assert dir(u.kernel[0]) == ["amplitude", "boundary", "normalized", "sigma"]
    assert u._ipython_key_completions_() == [
        "output",
        "activation",
        "interaction",
        "bounded",
        "input",
    ]  # pyright: ignore[reportPrivateUsage]


# ------------------------------------------------------------------------------------------------- as objects


def test_handles_are_equal_by_model_and_element(model: dd.Model, u: Handle) -> None:
    assert (
        u == model["g.u"]
        and hash(u) == hash(model["g.u"])
        and u != model["v"]
        and u != u["activation"]
        and u != "g.u"
    )
    assert copy.copy(u) == u and copy.copy(u).model is model
    copied = copy.deepcopy(u)
    assert copied != u and copied.tau == 20.0 and copied.model is not model
    assert pickle.loads(pickle.dumps(u)).tau == 20.0
    assert copy.copy(u.kernel[0]).sigma == 2.0 and pickle.loads(pickle.dumps(u.kernel))[0].sigma == 2.0


def test_no_parameter_has_the_name_of_an_attribute_of_handles_or_elements(model: dd.Model, u: Handle) -> None:
    def attributes(*of: object) -> set[str]:
        return {name for instance in of for name in vars(instance) if not name.startswith("__")} - {"name"}

    inside = attributes(PartHandle, PartsHandle, u.kernel, u.sigmoid)
    taken = {
        **dict.fromkeys(KINDS, attributes(Handle, model["v"], Element, Coupling)),
        **dict.fromkeys(PARTS, inside),
    }
    kinds = {**KINDS, **PARTS}
    assert not [f"{k}.{p.name}" for k, cls in kinds.items() for p in parameters(cls) if p.name in taken[k]]


# ------------------------------------------------------------------------------------------------ one or many


def test_set_accepts_one_or_several_values(model: dd.Model) -> None:
    before = model.document
    model.set({"g.u.tau": 30, "v.tau": 10, "g.u.kernel.0.sigma": 4})
    assert (model.get("g.u.tau"), model.get("v.tau"), model.get("g.u.kernel.0.sigma")) == (30.0, 10.0, 4.0)
    assert model.undo() and model.document is before
    model.set("v.tau", 12)
    assert model["v"].tau == 12.0


def test_several_values_are_set_together_or_not_at_all_with_all_problems(model: dd.Model) -> None:
    before = model.document
    with pytest.raises(ParameterError) as caught:
        model.set({"g.u.tau": 30, "v.tau": -1, "v.nosie": 1})
    assert [p.where for p in caught.value.problems] == ["v.tau", ""] and "Did you mean 'noise'" in str(
        caught.value
    )
    assert model.document is before


@pytest.mark.parametrize("holder", ["model", "session"])
def test_set_without_a_value_is_an_error_that_states_what_to_write(model: dd.Model, holder: str) -> None:
    target = model if holder == "model" else dd.Session(model)
    with pytest.raises(ParameterError, match=re.escape("""set("g.u.tau", value)""")):
        target.set("g.u.tau")  # type: ignore[attr-defined]
    with pytest.raises(ParameterError, match="set takes one value for several"):
        target.set({"g.u.tau": 30}, 5)  # type: ignore[attr-defined]


def test_a_session_sets_several_values_at_one_tick(model: dd.Model) -> None:
    session = dd.Session(model)
    session.step(3)
    assert session.set({"g.u.tau": 30, "v.tau": 10}) == "live"
    assert session.get("g.u.tau") == 30.0 and session.get("v.tau") == 10.0
    assert [(c.tick, *c.arguments) for c in session.journal] == [(3, "g.u.tau", 30), (3, "v.tau", 10)]
    with pytest.raises(ParameterError):
        session.set({"g.u.tau": 40, "v.tau": -1})
    assert session.get("g.u.tau") == 30.0 and len(session.journal) == 2
