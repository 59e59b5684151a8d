"""Writes the binary files of `tests/attacks/corpus`, by `python -m tests.attacks.corpus_maker`; its texts are
written by hand.

Some hold what must never run: it would leave a file called `executed`.
"""

from __future__ import annotations

import shutil
import sqlite3
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import xarray

import deodar as dd
from deodar import codec
from deodar.recording import netcdf, portable
from deodar_robots.ros_bag import bag_file
from tests.attacks.seeds import CORPUS, MARK
from tests.deodar_robots.ros2.fake import scan


class Payload:
    """An object whose pickle leaves the mark when it is read."""

    def __reduce__(self) -> tuple[Any, ...]:
        return eval, (f"__import__('pathlib').Path('{MARK}').touch()",)


def _model(weights: bool = False) -> dd.Model:
    model = dd.Model("small")
    x = dd.Axis("x", 0, 20, samples=21)
    field = model.add(dd.Field("u", [x], kernel=[dd.Gaussian(1.5, 2)], noise=0.5))
    model.add(dd.GaussianStimulus("s", [x], center=[10.0], sigma=2, amplitude=6)) >> field
    if weights:
        model.add(dd.Pattern("p", [x], values=np.linspace(0, 1, 21))) >> field
    return model


def _record() -> xarray.Dataset:
    return dd.simulate(_model(), 20, record="u", seed=1, on=dd.Resources(progress=False))


def _experiment() -> dd.Experiment:
    factors = [dd.Factor("input", [4.0, 8.0], "s.amplitude")]
    plan = dd.TrialPlan(30, measures=[dd.Measure("high", "u.output", "max")])
    return dd.Experiment("small", _model(), plan, 2, factors=factors)


def _arrays(folder: Path) -> None:
    dd.save(_model(weights=True), folder / "model.json")


def _pickled(folder: Path) -> None:
    """Write an array file of the model whose arrays are pickled objects."""
    array_file = next((CORPUS / "arrays").glob("*.npz"))
    with np.load(array_file) as sound:
        pickled: Any = dict.fromkeys(sound, np.array([Payload()], object))
    np.savez_compressed(folder / array_file.name, allow_pickle=True, **pickled)


def _packages(folder: Path) -> None:
    beside = folder.parent / "packed"
    beside.mkdir()
    dd.save(_model(weights=True), folder / "model.deodar")
    _experiment().save(beside / "experiment.json")
    dd.pack(beside / "experiment.json", folder / "experiment.deodar")
    shutil.rmtree(beside)


def _snapshot(folder: Path) -> None:
    session = dd.Session(_model())
    session.step(5)
    dd.save_snapshot(session.snapshot(), folder / "state.snapshot")


def _analyses(folder: Path) -> None:
    node = dd.Model("node")
    field = node.add(dd.Field("u", []))
    node.add(dd.Boost("s", [], 4)) >> field
    dd.continuation(node, "s.amplitude", (0, 8), finer=False).save(folder / "branch.nc")
    line = _model()
    axes: dict[str, Any] = {"u.kernel.0.amplitude": [2.0, 8.0], "u.resting_level": [-5.0, -2.0]}
    dd.regime_map(line, axes, refine=False).save(folder / "map.nc")
    for path in folder.glob("*.nc"):
        _without_proof(path)


def _without_proof(path: Path) -> None:
    """Write a file as earlier versions did, without hashes, so that no mutation is refused for them alone."""
    from scipy.io import netcdf_file

    with netcdf_file(path, mmap=False) as proven:
        attributes = {
            key: text.decode() for key, text in vars(proven)["_attributes"].items() if key != netcdf.PROOF
        }
        variables = {
            name: (variable.dimensions, variable[:].copy(), variable._attributes)
            for name, variable in proven.variables.items()
        }
    layout = codec.parse(attributes[portable.KEY]) | {"version": 1}
    for description in layout["variables"].values():
        description.pop("sha256", None)
    attributes[portable.KEY] = codec.line(layout, ascii=True)
    with netcdf_file(path, "w", version=2) as plain:
        for key, text in attributes.items():
            setattr(plain, key, text)
        for name, (dimensions, array, stated) in variables.items():
            for dimension, size in zip(dimensions, array.shape, strict=True):
                if dimension not in plain.dimensions:
                    plain.createDimension(dimension, size)
            new = plain.createVariable(name, array.dtype, dimensions)
            new[:] = array
            for key in stated.keys() - {netcdf.CHECKSUMS}:
                setattr(new, key, stated[key])


def _matlab(folder: Path) -> None:
    from scipy.io import savemat

    values: Mapping[str, Any] = {
        "weights": np.arange(12.0).reshape(3, 4),
        "results": {"name": "u", "sizes": np.array([1, 2, 3], np.uint8)},
        "cells": np.array(["a", "bcd", 7.0], object),
    }
    savemat(folder / "plain.mat", dict(values))
    savemat(folder / "compressed.mat", dict(values), do_compression=True)
    savemat(folder / "four.mat", {"weights": values["weights"]}, format="4")


def _pictures(folder: Path) -> None:
    from PIL import Image

    rows, columns = np.mgrid[:12, :16]
    pixels = np.stack([rows * 20, columns * 15, (rows + columns) * 8], -1).astype(np.uint8)
    picture = Image.fromarray(pixels)
    for ending in ("png", "jpg", "bmp", "webp", "tif"):
        picture.save(folder / f"picture.{ending}")
    picture.save(folder / "moving.gif", save_all=True, append_images=[picture.rotate(90)])


def _videos(folder: Path) -> None:
    import cv2

    for name, code in (("film.avi", "MJPG"), ("film.mp4", "mp4v")):
        writer = cv2.VideoWriter(str(folder / name), cv2.VideoWriter.fourcc(*code), 25, (32, 24))
        for k in range(8):
            frame = np.full((24, 32, 3), 80, np.uint8)
            frame[4:12, 2 * k : 2 * k + 8] = (0, 0, 255)
            writer.write(frame)
        writer.release()


def _events(folder: Path) -> None:
    words = [(y << 8 | x << 1 | x % 2, 1000 * x) for x, y in zip(range(60), range(60, 0, -1), strict=True)]
    head = b"#!AER-DAT2.0\r\n# This is a raw AE data file - do not edit\r\n"
    (folder / "small.aedat").write_bytes(head + np.array(words, ">u4").tobytes())


def _bags(folder: Path) -> None:
    from rosbags.rosbag2 import StoragePlugin, Writer
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores.ROS2_JAZZY)
    kind = "sensor_msgs/msg/LaserScan"
    for name, plugin in (("lab", StoragePlugin.SQLITE3), ("lab_mcap", StoragePlugin.MCAP)):
        with Writer(folder / name, version=8, storage_plugin=plugin) as writer:
            topic = writer.add_connection("/scan", kind, typestore=store)
            for k in range(10):
                writer.write(topic, 10**18 + k * 10**8, scan([1 + 0.1 * k, 2, 3, 4]))
    bag_file.save(_record(), folder / "record")
    (folder / "code").mkdir()
    call = f'!!python/object/apply:os.system ["touch {MARK}"]'
    sound = (folder / "lab" / "metadata.yaml").read_text()
    (folder / "code" / "metadata.yaml").write_text(sound.replace("custom_data: null", f"custom_data: {call}"))
    for file in folder.glob("*/*.db3"):
        with sqlite3.connect(file) as base:
            base.execute("PRAGMA page_size=512")
            base.execute("VACUUM")


MAKERS: Mapping[str, Callable[[Path], None]] = {
    "arrays": _arrays,
    "pickled": _pickled,
    "packages": _packages,
    "snapshots": _snapshot,
    "analyses": _analyses,
    "matlab": _matlab,
    "pictures": _pictures,
    "videos": _videos,
    "events": _events,
    "bags": _bags,
}


def main() -> None:
    """Write all files again."""
    for name, make in MAKERS.items():
        folder = CORPUS / name
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        make(folder)


if __name__ == "__main__":
    main()
