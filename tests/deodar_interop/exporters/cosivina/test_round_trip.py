"""Import, export, import: the document is the same, bit by bit, for files of every class."""

from __future__ import annotations

import dataclasses as dc
import random
from typing import Any

import pytest

from deodar.model.document import Document
from deodar_interop.exporters.cosivina import write
from deodar_interop.importers.cosivina import read
from deodar_interop.importers.cosivina.classes import CLASSES
from tests.deodar_interop.exporters.cosivina.files import elements
from tests.deodar_interop.importers.cosivina import test_classes, test_random_models
from tests.deodar_interop.importers.cosivina.files import SAMPLES, element, text

ROW, PLANE, SOLID = [1, 9], [3, 4], [4, 5, 6]
FIELD = {"tau": 6, "h": -1, "beta": 2}
KERNEL = {"circular": 1, "normalized": 1, "cutoffFactor": 2}
ENDS = {"circularY": 1, "circularX": 0, "circularZ": 1, "normalized": 1, "cutoffFactor": 2}
WIDTHS = {
    f"sigma{part}{letter}": v
    for part, values in (("Exc", (1, 1.5, 0.8)), ("Inh", (2, 1, 1.2)))
    for letter, v in zip("YXZ", values, strict=True)
}
DIFFERENCE = {"size": SOLID, **WIDTHS, "amplitudeExc": 3, "amplitudeInh": 2, **ENDS}
INVERSE = {"size": ROW, "sigmaExc": 1, "sigmaInh": 2, "normalized": 1, "amplitudeGlobal": -0.1}
U, PL = ("u", "output"), ("pl", "output")

FURTHER = {
    "solid stimulus": (
        "GaussStimulus3D",
        {"size": SOLID, "amplitude": 2, "normalized": 0}
        | {"sigmaY": 1, "sigmaX": 1.5, "sigmaZ": 2, "positionY": 2, "positionX": 6, "positionZ": 1}
        | {"circularY": 1, "circularX": 1, "circularZ": 0},
        [],
    ),
    "solid kernel": (
        "GaussKernel3D",
        {"size": SOLID, "sigmaY": 1, "sigmaX": 1.5, "sigmaZ": 0.8, "amplitude": 3, **ENDS},
        [("solid stimulus", "output")],
    ),
    "solid hat": ("MexicanHatKernel3D", DIFFERENCE, [("solid stimulus", "output")]),
    "solid lateral": (
        "LateralInteractions3D",
        {**DIFFERENCE, "amplitudeGlobal": -0.25},
        [("solid stimulus", "output")],
    ),
    "shifted": (
        "LateralInteractionsShifted1D",
        {"size": ROW, "sigmaExc": 1, "amplitudeExc": 2, "sigmaInh": 1, "amplitudeInh": 0}
        | {"amplitudeGlobal": -0.1, "shift": 2, **KERNEL},
        [U],
    ),
    "discrete": (
        "LateralInteractionsDiscrete",
        {"size": ROW, "amplitudeExc": 2, "amplitudeGlobal": -0.1},
        [U],
    ),
    "transform": ("FastFourierTransform", {"size": ROW}, [U]),
    "inverse": (
        "KernelInverseFFT",
        {**INVERSE, "amplitudeExc": 1.5, "amplitudeInh": 0.3},
        [("transform", "output")],
    ),
    "constant": (
        "KernelInverseFFT",
        {**INVERSE, "amplitudeExc": 0, "amplitudeInh": 0},
        [("transform", "output")],
    ),
    "expansion": (
        "ExpandDimension",
        {"inputSize": PLANE, "outputSize": [4, 2, 3], "dimensionMapping": [3, 1]},
        [PL],
    ),
    "past": ("RunningHistory", {"size": ROW, "timeSlots": 4, "interval": 3}, [U]),
    "past that is read": ("RunningHistory", {"size": ROW, "timeSlots": 4, "interval": 3}, [U]),
    "its reader": ("NeuralField", {**FIELD, "size": [4, 9]}, [("past that is read", "output")]),
    "moments": ("History", {"size": ROW, "storingTimes": [0, 3, 3, 4.5, 8, 40]}, [U]),
    "moment of a plane": ("History", {"size": PLANE, "storingTimes": [2]}, [PL]),
    "moments of a plane": ("History", {"size": PLANE, "storingTimes": [2, 5]}, [PL]),
    "association": ("HebbianConnection", {"learningRate": 0.2}, [U, PL]),
    "rewarded": (
        "HebbianConnection",
        {"learningRate": 0.2, "instar": 1, "rewardDuration": [0, 7]},
        [U, ("n", "output"), ("r", "output")],
    ),
    "noise": ("NormalNoise", {"size": ROW, "amplitude": 0.3}, []),
    "noise kernel": (
        "GaussKernel1D",
        {"size": ROW, "sigma": 1, "amplitude": 1, **KERNEL},
        [("noise", "output")],
    ),
    "plane that is shifted": (
        "ShiftInput",
        {"size": PLANE, "shiftValue": [1, -1], "amplitude": 1, "circular": 0, "fillValue": 0.3},
        [PL],
    ),
    "solid pattern": (
        "CustomStimulus",
        {
            "size": [2, 2, 2],
            "pattern": {"_ArrayType_": "double", "_ArraySize_": [2, 2, 2], "_ArrayData_": list(range(8))},
        },
        [],
    ),
    "boosts that are never on": ("TimedBoost", {"amplitude": [[1], [2]], "onTimes": []}, []),
    "kernel of a column": (
        "GaussKernel2D",
        {"size": [5, 1], "sigmaX": 1, "sigmaY": 2, "amplitude": 1, "circularX": 1, "circularY": 0}
        | {"normalized": 1, "cutoffFactor": 3},
        [("column", "output")],
    ),
    "plane class of a row": (
        "LateralInteractions2D",
        {"size": ROW, **{k: v for k, v in WIDTHS.items() if "Z" not in k}, "amplitudeExc": 1}
        | {"amplitudeInh": 0.5, "amplitudeGlobal": -0.1, "circularX": 1, "circularY": 0}
        | {"normalized": 1, "cutoffFactor": 3},
        [U],
    ),
}
"""Cases of classes, and of sizes, that the tests of the importer take singly."""

SOURCES = [
    ("pl", "NeuralField", {**FIELD, "size": PLANE}, []),
    (
        "n",
        "NeuralField",
        {**FIELD, "size": [1, 1]},
        [("solid lateral", "fullSum"), ("boosts that are never on", "output")],
    ),
    ("r", "NeuralField", {**FIELD, "size": [1, 1]}, []),
    ("column", "NeuralField", {**FIELD, "size": [5, 1]}, [("kernel of a column", "output")]),
    (
        "u",
        "NeuralField",
        {**FIELD, "size": ROW},
        [
            (name, "output")
            for name in ("shifted", "discrete", "inverse", "constant", "noise", "noise kernel")
        ],
    ),
]


def plain(document: Document) -> Document:
    """Return a document without its name and notes, which name the file."""
    return dc.replace(document, name="", notes="")


def again(content: bytes) -> tuple[Document, Document, Any]:
    """Return the document of a file, that of its export, and the report of the export."""
    first = read(content, "file.json").model
    written = write(first, "file.json")
    return plain(first.document), plain(read(written.content, "file.json").model.document), written


def content(parts: list[Any], dt: float = 1, t0: float = 0) -> bytes:
    return text([element(a, k, p, i) for a, k, p, i in parts], dt, t0).encode()


@pytest.mark.parametrize("path", SAMPLES, ids=lambda p: p.stem)
def test_a_published_file_is_the_same_after_import_export_and_import(path):
    before, after, written = again(path.read_bytes())
    assert after == before and written.report.faithful


@pytest.mark.parametrize("path", SAMPLES, ids=lambda p: p.stem)
def test_the_order_classes_and_inputs_of_a_published_file_are_kept(path):
    first = read(path.read_bytes(), path.name)
    elements_again = elements(write(first.model, path.name).content)
    listed = [(line.where, line.what) for line in first.report.lines if line.part == "element"]
    assert [(label, kind) for label, kind, _, _ in elements_again] == listed


@pytest.mark.parametrize(
    ("seed", "dt", "t0"), [("", 1, 0), ("reversed", 1, 0), ("mixed", 0.5, 2), ("more", 0.1, 0.3)]
)
def test_every_class_is_the_same_in_any_order(seed, dt, t0):
    before, after, written = again(content(test_classes.everything(seed), dt, t0))
    assert after == before and written.report.faithful


@pytest.mark.parametrize(("seed", "dt", "t0"), [(0, 1, 0), (1, 1, 0), (2, 0.1, 0.3)])
def test_further_classes_are_the_same_in_any_order(seed, dt, t0):
    parts = [*SOURCES, *((name, *case) for name, case in FURTHER.items())]
    random.Random(seed).shuffle(parts)
    before, after, written = again(content(parts, dt, t0))
    assert after == before
    assert {line.where for line in written.report.losses} == {"past that is read", "association", "rewarded"}


def test_the_cases_cover_every_class_of_the_importer():
    kinds = {kind for kind, *_ in (*test_classes.CASES.values(), *FURTHER.values())}
    assert kinds == set(CLASSES)


@pytest.mark.parametrize("seed", range(1, 13))
def test_a_random_model_with_loops_is_the_same(seed):
    before, after, written = again(content(test_random_models.model(seed, 50)))
    assert after == before and written.report.faithful


def test_a_change_of_the_model_is_in_the_export():
    first = read(SAMPLES[0].read_bytes(), "file.json").model
    field = next(e for e in first.document.entries if type(e.element).__name__ == "Field")
    first[field.path].resting_level = -3.25
    second = read(write(first, "file.json").content, "file.json").model
    assert second[field.path].resting_level == -3.25
