"""Components that scripts and plots of cosivina name: each is readable, or the report states that it is
not.
"""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd
from deodar.elements.placeholder import Placeholder
from deodar.importers.opening import read
from deodar.model import find
from deodar_interop.importers.cosivina.constructors import COMPONENTS, components
from tests.deodar_interop.importers.cosivina.files import element, written
from tests.deodar_interop.importers.cosivina.oracle import Sim

ROWS, COLUMNS = 3, 5
PLANE = [ROWS, COLUMNS]
FIELD = {"size": PLANE, "tau": 5, "h": 0.5, "beta": 2}
BELL = {
    "size": PLANE,
    "sigmaX": 1,
    "sigmaY": 1,
    "amplitude": 2,
    "positionX": 2,
    "positionY": 1,
    "circularX": 0,
    "circularY": 0,
    "normalized": 0,
}
WIDTHS = {
    "sigmaExcX": 1,
    "sigmaExcY": 1,
    "sigmaInhX": 2,
    "sigmaInhY": 2,
    "circularX": 0,
    "circularY": 0,
    "normalized": 1,
    "cutoffFactor": 2,
}
LATERAL = {"size": PLANE, **WIDTHS, "amplitudeExc": 0.3, "amplitudeInh": 0.1, "amplitudeGlobal": -0.01}
SUMS = ("horizontalSum", "verticalSum", "fullSum")


def told(report, label):
    """Return the report's entries about the components of an element."""
    return {line.what: line.why for line in report.lines if line.where == label and line.part == "component"}


@pytest.mark.parametrize("kind", ["SumAllDimensions", "LateralInteractions2D"])
def test_sums_without_readers_are_read_at_the_path_in_the_report(kind, tmp_path):
    parts = [
        ("bell", "GaussStimulus2D", BELL, []),
        (
            "u",
            "NeuralField",
            FIELD,
            [("bell", "output"), ("it", "output")] if kind.startswith("Lat") else [("bell", "output")],
        ),
        ("it", kind, LATERAL if kind.startswith("Lat") else {"size": PLANE}, [("u", "output")]),
    ]
    done = read(written(tmp_path, [element(*part) for part in parts]))
    assert done.report.faithful
    paths = {component: told(done.report, "it")[component].removeprefix("read ") for component in SUMS}
    record = dd.simulate(done.model, 6, record=list(paths.values()), precision="float64")
    plain = Sim(parts)
    for step in range(1, 7):
        plain.step()
        for component, path in paths.items():
            expected = plain.out["it"][component]
            assert np.allclose(
                record[path].isel(time=step).values.reshape(expected.shape), expected, rtol=0, atol=1e-12
            ), (component, step)


def test_the_resting_level_is_named_as_a_parameter(tmp_path):
    done = read(written(tmp_path, [element("u.v", "NeuralField", FIELD)]))
    path = told(done.report, "u.v")["h"].removeprefix("the parameter ")
    assert done.model.get(path) == 0.5
    assert path in done.model.document.notes


@pytest.mark.parametrize("kind", sorted(COMPONENTS))
def test_each_component_is_a_port_or_named_in_the_report(kind, tmp_path):
    reads = [("u", "output")] * (0 if kind == "NeuralField" else 2 if kind == "HebbianConnection" else 1)
    done = read(
        written(
            tmp_path,
            [element("u", "NeuralField", {"size": [1, 1]}), element("it", kind, {"size": [1, 1]}, reads)],
        )
    )
    own = done.model["it"].element
    if isinstance(own, Placeholder):
        assert any(
            line.where == "it" and line.verdict == "dropped"
            for line in done.report.lines
            if line.part == "element"
        )
        return
    message = told(done.report, "it")
    for component in components(kind):
        if component not in message:
            assert component in own.outputs({port: () for port in own.ports()})
        elif message[component].startswith("read "):
            find.port(done.model.document, message[component].removeprefix("read "))
        else:
            assert len(message[component]) > 12
    for why in message.values():
        words = [word for word in why.replace(",", "").split() if word.startswith("it.")]
        assert all(
            done.model.get(word) is not None
            for word in words
            if "read" not in why and not word.endswith("start")
        )
