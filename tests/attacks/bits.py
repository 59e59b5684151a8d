"""Single bits of binary files that deodar wrote and reads back are flipped: every reader returns the values
that were written, or says that the file is damaged.

A process of its own reads, so that the end of Python and a reader that never returns are found, too. JSON
that people edit and files for other programs are left out.
"""

from __future__ import annotations

import contextlib
import dataclasses as dc
import functools
import itertools
import multiprocessing
import os
import random
import shutil
import tempfile
import unittest.mock
import warnings
from collections.abc import Callable, Generator, Mapping, Sequence
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

import numpy as np
import xarray

import deodar as dd
from deodar.errors import DeodarError
from deodar.recording.sound import DAMAGED
from deodar.session import checkpoint

LONGEST = 20.0
"""Seconds after which a reader counts as one that never returns (reading takes less than one)."""

Values = Mapping[str, Any]
"""What each reader returned, by its name."""


@dc.dataclass
class Outcome:
    """What became of the flipped bits."""

    refused: int = 0
    shortened: int = 0
    equal: int = 0
    by_kind: dict[str, int] = dc.field(default_factory=dict[str, int])
    errors: list[str] = dc.field(default_factory=list[str])

    def count(self, kind: str, answers: Sequence[tuple[str, str]], place: str) -> None:
        """Count what became of one attack on a file of a kind."""
        self.by_kind[kind] = self.by_kind.get(kind, 0) + 1
        for state, text in answers:
            match state:
                case "refused":
                    self.refused += 1
                case "shortened":
                    self.shortened += 1
                case "equal":
                    self.equal += 1
                case _:
                    self.errors.append(f"{kind}, {place}: {state}: {text[:300]}")


@dc.dataclass(frozen=True)
class Stored:
    """Files of one kind.

    Attributes:
        make: writes them into a folder.
        attacked: patterns of the files of which bits are flipped.
        readers: functions that read the folder, by their names.
    """

    make: Callable[[Path], None]
    attacked: tuple[str, ...]
    readers: Mapping[str, Callable[[Path], Any]]


def _model(name: str = "bits", weights: bool = False) -> dd.Model:
    model = dd.Model(name)
    x = dd.Axis("x", 0, 20, samples=21)
    field = model.add(dd.Field("u", [x], kernel=[dd.Gaussian(6, 2)], noise=0.5))
    model.add(dd.GaussianStimulus("s", [x], center=[10.0], sigma=2, amplitude=6)) >> field
    if weights:
        pattern = np.random.default_rng(1).normal(size=21)
        model.add(dd.Pattern("p", [x], values=pattern)) >> field
    return model


def _record(**settings: Any) -> xarray.Dataset:
    return dd.simulate(_model(), 40, record="u", seed=1, on=dd.Resources(progress=False), **settings)


def _experiment() -> dd.Experiment:
    field = [dd.Factor("input", [4.0, 8.0], "s.amplitude")]
    plan = dd.TrialPlan(
        30, measures=[dd.Measure("high", "u.output", "max")], watch=["u.activation"], every=10
    )
    return dd.Experiment("bits", _model(), plan, 2, factors=field)


def _save(suffix: str) -> Callable[[Path], None]:
    def make(folder: Path) -> None:
        dd.save_record(_record(trials=2), folder / f"record{suffix}")

    return make


def _load(name: str) -> Callable[[Path], Any]:
    return lambda folder: dd.load_record(folder / name)


def _opened(name: str) -> Callable[[Path], Any]:
    return lambda folder: dd.open_record(folder / name).load()


def _snapshot(folder: Path) -> None:
    session = dd.Session(_model())
    session.step(5)
    dd.save_snapshot(session.snapshot(), folder / "state.snapshot")


def _run(folder: Path) -> None:
    dd.simulate(_model(), 40, record="u", seed=1, out=folder / "run", on=dd.Resources(progress=False))


def _trials(folder: Path) -> None:
    _experiment().run(folder / "trials", on=dd.Resources(progress=False))
    _experiment().run(folder / "rows", records=folder / "store", on=dd.Resources(progress=False))


def _records_of_store(folder: Path) -> list[Any]:
    with dd.open_records(folder / "store") as records:
        return [records[trial] for trial in records]


def _programs(folder: Path) -> None:
    with _cache(folder):
        dd.Session(_model()).step(5)


@contextlib.contextmanager
def _cache(folder: Path) -> Generator[None]:
    shared = unittest.mock.patch("deodar.compiler.executable.SHARED_BYTES", -1)  # none of this process
    with unittest.mock.patch.dict(os.environ, {"DEODAR_CACHE": str(folder)}), shared:
        yield


def _with_program(folder: Path) -> np.ndarray:
    """Return activation that stored programs computed; none of the memory of this process is used."""
    with _cache(folder):
        session = dd.Session(_model())
        session.step(5)
        return session.read("u.activation")


def _packed(folder: Path) -> None:
    dd.save_record(_record(), folder / "record.nc")
    dd.pack(folder / "record.nc", folder / "record.deodar")
    dd.save(_model(weights=True), folder / "model.deodar")


def _unpacked(folder: Path) -> list[Any]:
    with tempfile.TemporaryDirectory() as place:
        return [dd.load_record(dd.unpack(folder / "record.deodar", Path(place) / "out"))]


KINDS: dict[str, Stored] = {
    "zarr": Stored(
        _save(".zarr"),
        ("record.zarr/**/*",),
        {"load_record": _load("record.zarr"), "open_record": _opened("record.zarr")},
    ),
    "netcdf": Stored(
        _save(".nc"), ("record.nc",), {"load_record": _load("record.nc"), "open_record": _opened("record.nc")}
    ),
    "run": Stored(_run, ("run/**/*",), {"load_record": _load("run"), "open_record": _opened("run")}),
    "state": Stored(
        _run,
        ("run/record.zarr/state.npz",),
        {"checkpoint": lambda folder: checkpoint.read(folder / "run" / "record.zarr" / "state.npz")},
    ),
    "rows": Stored(
        _trials,
        ("*/trials.jsonl", "trials/records/*"),
        {
            "load_results": lambda folder: dd.load_results(folder / "trials"),
            "load_record": lambda folder: [
                dd.load_record(p) for p in sorted(folder.glob("trials/records/*"))
            ],
            "rows": lambda folder: dd.load_results(folder / "rows"),
        },
    ),
    "store": Stored(_trials, ("store/**/*.zip",), {"open_records": _records_of_store}),
    "package": Stored(
        _packed,
        ("*.deodar",),
        {"unpack": _unpacked, "load": lambda folder: dd.load(folder / "model.deodar").document},
    ),
    "program": Stored(_programs, ("*",), {"Session": _with_program}),
    "snapshot": Stored(
        _snapshot,
        ("state.snapshot",),
        {"load_snapshot": lambda folder: _plain(dd.load_snapshot(folder / "state.snapshot"))},
    ),
    "arrays": Stored(
        lambda folder: dd.save(_model(weights=True), folder / "model.json"),
        ("*.npz",),
        {"load": lambda folder: dd.load(folder / "model.json").document},
    ),
}


def _plain(snapshot: Any) -> Any:
    return [getattr(snapshot, field.name) for field in dc.fields(snapshot)]


# ----------------------------------------------------------------------------------------- in the process


def _read(kind: str, folder: Path) -> dict[str, tuple[str, Any]]:
    """Return for each reader what it returned, or the class of its error."""
    answers: dict[str, tuple[str, Any]] = {}
    for name, reader in KINDS[kind].readers.items():
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            try:
                answers[name] = "values", reader(folder)
            except DeodarError as error:
                answers[name] = "refused", str(error)
            except Exception as error:
                answers[name] = "foreign", f"{type(error).__name__}: {str(error)[:200]}"
    return answers


def _same(first: Any, second: Any) -> bool:
    match first:
        case xarray.Dataset():
            return isinstance(second, xarray.Dataset) and first.identical(second)
        case np.ndarray():
            return (
                isinstance(second, np.ndarray)
                and first.dtype == second.dtype
                and first.tobytes() == second.tobytes()
            )
        case dict():
            return first.keys() == second.keys() and all(_same(first[k], second[k]) for k in first)
        case list() | tuple():
            return len(first) == len(second) and all(map(_same, first, second))
        case _:
            return bool(first == second)


def _shorter(whole: Any, part: Any) -> bool:
    """Return whether a record is the beginning of another one, and says that the rest is damaged."""
    if not isinstance(part, xarray.Dataset) or DAMAGED not in part.attrs:
        return False
    beginning = whole.isel({d: slice(n) for d, n in part.sizes.items()})
    attributes = {k: v for k, v in part.attrs.items() if k != DAMAGED}
    return beginning.identical(part.assign_attrs(attributes)) or all(
        beginning[name].variable.identical(part[name].variable) for name in whole.variables
    )


def _child(folder: str, connection: Connection) -> None:
    """Read the files of each kind that the parent names, and answer what differs from what was written."""
    root = Path(folder)

    @functools.cache
    def written(kind: str) -> dict[str, tuple[str, Any]]:
        return _read(kind, root / kind / "sound")

    while kind := connection.recv():
        sound, damaged = written(kind), _read(kind, root / kind / "damaged")
        answers: list[tuple[str, str]] = []
        for name, (state, content) in damaged.items():
            if state == "values":
                whole = sound[name][1]
                state = (
                    "equal" if _same(whole, content) else "shortened" if _shorter(whole, content) else "wrong"
                )
            answers.append((state, f"{name}: {content}" if state in ("wrong", "foreign") else name))
        connection.send(answers)


class _Reader:
    """The process that reads; it is started again after it ended."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._begin()

    def _begin(self) -> None:
        context = multiprocessing.get_context("spawn")
        self._connection, far_end = context.Pipe()
        self._process = context.Process(target=_child, args=(str(self._folder), far_end), daemon=True)
        self._process.start()
        far_end.close()

    def read(self, kind: str) -> list[tuple[str, str]]:
        """Return what became of each reader of a kind."""
        self._connection.send(kind)
        try:
            if self._connection.poll(LONGEST + 60 * (self._process.pid is None)):
                return self._connection.recv()
            state = "hang"
        except (EOFError, ConnectionError):
            self._process.join()
            state = f"crash ({self._process.exitcode})"
        self.close()
        self._begin()
        return [(state, "")]

    def close(self) -> None:
        """End the process: by asking it, or if it does not answer."""
        with contextlib.suppress(OSError):
            self._connection.send("")
        self._process.join(5)
        self._process.kill()
        self._process.join()
        self._connection.close()


def _places(folder: Path, patterns: tuple[str, ...]) -> list[Path]:
    return sorted({p for pattern in patterns for p in folder.glob(pattern) if p.is_file()})


def _written(folder: Path, kinds: Sequence[str]) -> None:
    """Write the files of each kind twice: as they stay, and as they are attacked."""
    for kind in kinds:
        (folder / kind / "sound").mkdir(parents=True)
        KINDS[kind].make(folder / kind / "sound")
        shutil.copytree(folder / kind / "sound", folder / kind / "damaged")


def pipes(folder: Path, seed: int = 0) -> Outcome:
    """Put a named pipe in the place of one file of each kind after the other: no reader waits for it."""
    outcome = Outcome()
    _written(folder, [*KINDS])
    reader = _Reader(folder)
    try:
        for kind, stored in KINDS.items():
            damaged = folder / kind / "damaged"
            for path in _places(damaged, stored.attacked):
                content = path.read_bytes()
                path.unlink()
                os.mkfifo(path)
                answers = reader.read(kind)
                path.unlink(missing_ok=True)
                path.write_bytes(content)
                outcome.count(kind, answers, f"{path.relative_to(damaged)}, a pipe")
    finally:
        reader.close()
    return outcome


def attack(folder: Path, count: int, seed: int = 0, kinds: tuple[str, ...] = ()) -> Outcome:
    """Flip single bits of files of each kind in turn."""
    outcome = Outcome()
    chosen = list(kinds or KINDS)
    _written(folder, chosen)
    reader = _Reader(folder)
    try:
        for number, kind in enumerate(itertools.islice(itertools.cycle(chosen), count)):
            draw = random.Random(f"{seed}/{number}")
            damaged = folder / kind / "damaged"
            path = draw.choice(_places(damaged, KINDS[kind].attacked))
            content = path.read_bytes()
            bit = draw.randrange(8 * len(content)) if content else 0
            flipped = bytearray(content)
            if flipped:
                flipped[bit // 8] ^= 1 << (bit % 8)
            path.write_bytes(flipped)
            answers = reader.read(kind)
            if not path.exists() or path.read_bytes() != content:
                path.write_bytes(content)
            outcome.count(kind, answers, f"{path.relative_to(damaged)}, bit {bit}")
    finally:
        reader.close()
    return outcome
