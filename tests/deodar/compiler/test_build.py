"""The key of a build decides between a live change, one that rebuilds constants, and another program."""

from __future__ import annotations

import dataclasses as dc

import pytest

import deodar as dd
from deodar.compiler.build import Build
from deodar.errors import ParameterError
from deodar.model import edit

x = dd.Axis("x", 0, 30, samples=31)


def model() -> dd.Model:
    m = dd.Model("pair")
    u = m.add(dd.Field("u", [x], kernel=[dd.Gaussian(2.0, 3.0)], noise=0.1, noise_length=1.0))
    m.add(dd.GaussianStimulus("s", [x], center=15.0)) >> dd.Gain(2.0, name="g") >> u
    return m


CHANGES = {
    "u.tau": (30.0, True),
    "u.noise": (0.0, True),  # it stays in the program
    "u.noise_length": (0.0, False),  # which switches it off
    "u.kernel.0.sigma": (3.001, True),
    "u.kernel.0.boundary": ("periodic", False),
    "s.center": (5.0, True),
    "g.factor": (0.5, True),
}


@pytest.mark.parametrize("path", CHANGES)
def test_a_program_continues_with_what_has_its_key(path: str) -> None:
    build = Build(model().document)
    setting, continues = CHANGES[path]
    new = build.continued(edit.change(build.doc, path, setting))
    assert (new == build) is continues
    afresh = dc.replace(new)  # nothing is taken over
    assert afresh.key == new.key


def test_a_leaf_that_is_left_out_needs_another_program() -> None:
    m = model()
    m.set("u.noise", 0.0)
    build = Build(m.document)
    noisy = edit.change(build.doc, "u.noise", 0.2)
    assert build.continued(noisy) != build
    silent = Build(noisy).continued(m.document)
    assert silent == Build(noisy) and silent != build
    assert silent.continued(noisy) == silent


def test_the_order_of_elements_and_connections_is_no_part_of_a_program() -> None:
    doc = model().document
    turned = dc.replace(doc, entries=doc.entries[::-1], connections=doc.connections[::-1])
    assert Build(turned) == Build(doc) == Build(doc).continued(turned)


def test_unknown_precisions_and_accuracies_are_refused() -> None:
    with pytest.raises(ParameterError, match="expected float32 or float64"):
        Build(model().document, "float16")
    with pytest.raises(ParameterError, match="expected default or exact"):
        Build(model().document, accuracy="rough")
