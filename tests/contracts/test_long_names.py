"""A name that is too long for the system names nothing, wherever a file is opened by its name."""

from __future__ import annotations

from collections.abc import Callable

import pytest

import deodar as dd
from deodar.errors import DeodarError

OPENERS: dict[str, Callable[[str], object]] = {
    "document": dd.load,
    "import": dd.read,
    "contents": dd.contents,
    "record": dd.load_record,
    "open record": dd.open_record,
    "results": dd.load_results,
    "snapshot": dd.load_snapshot,
    "experiment": dd.Experiment.load,
    "cedar": dd.load_cedar,
    "matlab": lambda name: dd.load_mat(name, "w"),
    "picture": dd.Picture,
    "video": dd.Video,
    "camera": lambda name: dd.Camera(name).sense("picture", dd.Camera.example_axes("picture"), 0.0),
    "arena": dd.Arena.open,
    "scene": dd.MuJoCo,
    "robot": dd.Robot,
    "bag": dd.ROSBag,
    "events": dd.EventFile,
    "packing": lambda name: dd.pack(f"{name}.json", "a.deodar"),
    "saving": lambda name: dd.save(dd.Model("a"), name),
}


@pytest.mark.parametrize("kind", OPENERS)
def test_a_name_that_is_too_long_is_refused(kind: str) -> None:
    with pytest.raises(DeodarError):
        OPENERS[kind](5000 * "x")
