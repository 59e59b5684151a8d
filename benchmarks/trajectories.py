"""Store the trajectories of everything that the repository can run, and compare them with what the code
computes now.

    python benchmarks/trajectories.py compare               all models
    python benchmarks/trajectories.py compare contract      those whose name contains a text
    python benchmarks/trajectories.py store                 run everything, and write evidence/trajectories
    python benchmarks/trajectories.py store "contract Gain" run some models again; the others stay
    python benchmarks/trajectories.py list                  what is stored, and which versions computed it

Each model runs from the start of its document with seed 0, in double and in single precision
(`trajectory_models.py`). Stored are, for each readable port, the mean and the maximum every 10 steps, and up
to 64 evenly spaced cells every 50 steps (16 cells where a model has more than 300 ports). The intervals of a
run of n times 300 steps are n times as long. A difference is the largest absolute difference of a port,
divided by the largest absolute value of that port if this is above 1. `compare` prints one line for each
model and ends with status 1 if a difference exceeds its limit (1e-10 in double, 1e-4 in single precision), if
a document, an id, the bits of a noise or an event time changed, or if a model is missing.

The document of each model is stored too, as the version that computed the trajectory wrote it. `compare`
opens it, as a user opens a file of that version, and requires that it is the document of the present model.
The notes of a document are prose and may differ.
"""

from __future__ import annotations

import argparse
import base64
import dataclasses as dc
import datetime
import hashlib
import importlib.metadata
import json
import lzma
import os
import platform
import subprocess
import tempfile
import time
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

import deodar as dd
from deodar.model import find
from deodar.numerics.axes import shape
from deodar.numerics.noise import bits, element_keys
from deodar.recording.provenance import machine
from trajectory_models import ROOT, Scene, Table, scenes, tables

FOLDER = ROOT / "evidence" / "trajectories"
ABOUT, MODELS, VALUES = "about.json", "models.json.xz", "values.xz"
LIMITS = {"float64": 1e-10, "float32": 1e-4}
MEANS_EVERY, CELLS_EVERY = 10, 50
CELLS, FEW_CELLS, MANY_PORTS = 64, 16, 300
"""Stored cells of a port; fewer in a model with many ports."""

Values = Mapping[str, np.ndarray]
"""The rows `PORT mean`, `PORT maximum` and `PORT cells` of each port."""


# --------------------------------------------------------------------------------- the description of a model


def written(model: dd.Model) -> dict[str, str]:
    """Return the document of a model as text, and its arrays, as `dd.save` writes them."""
    with tempfile.TemporaryDirectory() as folder:
        dd.save(model, Path(folder) / "model.json")
        arrays = {
            p.name: base64.b64encode(p.read_bytes()).decode() for p in sorted(Path(folder).glob("*.npz"))
        }
        return {"document": (Path(folder) / "model.json").read_text(encoding="utf-8"), **arrays}


def opened(stored: Mapping[str, str]) -> dd.Model:
    """Open the model of a stored document."""
    with tempfile.TemporaryDirectory() as folder:
        for name, content in stored.items():
            if name != "document":
                (Path(folder) / name).write_bytes(base64.b64decode(content))
        (Path(folder) / "model.json").write_text(stored["document"], encoding="utf-8")
        return dd.load(Path(folder) / "model.json", trust=True)


def digest(*content: str | bytes) -> str:
    """Return the hash of a content."""
    found = hashlib.sha256()
    for part in content:
        found.update(part.encode() if isinstance(part, str) else part)
    return found.hexdigest()[:32]


def ids(model: dd.Model) -> dict[str, str]:
    """Return the id of every element."""
    return {e.path: e.id for e in model.document.entries}


def noises(model: dd.Model) -> dict[str, str]:
    """Return, for each element with noise, the digest of the integers from which the first four deviates of
    each cell are made.
    """
    out: dict[str, str] = {}
    for e in model.document.entries:
        axes = e.element.noise_axes()
        if axes is not None:
            (key,) = np.asarray(element_keys(0, 0, [int(e.id, 16)]))
            words = [
                np.asarray(w, "<u4") for block in (0, 1) for w in bits(int(np.prod(shape(axes))), key, block)
            ]
            out[e.path] = digest(*(w.tobytes() for w in words))[:12]
    return out


def ports(model: dd.Model) -> list[str]:
    """Return the path of every readable port."""
    return [f"{e.path}.{port}" for e in model.document.entries for port in find.readable(e)]


# ---------------------------------------------------------------------------------------------------- running


def run(scene: Scene, model: dd.Model, precision: str) -> dict[str, np.ndarray]:
    """Run a model, and return the rows that are stored of each port."""
    dt = model.document.step if scene.dt is None else scene.dt
    means, cells = MEANS_EVERY * -(-scene.steps // 300), CELLS_EVERY * -(-scene.steps // 300)
    world = None if scene.world is None else scene.world()
    most = CELLS if len(ports(model)) <= MANY_PORTS else FEW_CELLS
    data = dd.simulate(
        model,
        scene.steps * dt,
        dt=dt,
        seed=0,
        record=ports(model),
        every=means * dt,
        precision=precision,
        world=world,
        on=dd.Resources(progress=False),
    )
    out: dict[str, np.ndarray] = {}
    for path, variable in data.data_vars.items():
        values = variable.values.reshape(variable.sizes["time"], -1)
        at = np.unique(np.linspace(0, values.shape[1] - 1, min(most, values.shape[1])).round().astype(int))
        if values.shape[1] > 1:
            out[f"{path} mean"] = values.astype(np.float64).mean(1).astype(values.dtype)
            out[f"{path} maximum"] = values.max(1)
            out[f"{path} cells"] = values[:: cells // means, at]
        else:
            out[f"{path} cells"] = values
    return out


def computed(name: str, scene: Scene | Table) -> tuple[dict[str, Any], dict[str, dict[str, np.ndarray]]]:
    """Run a model or a table, and return what is stored: its description, and the values of each
    precision.
    """
    if isinstance(scene, Table):
        return {
            "name": name,
            "numbers": {p: scene.numbers(p) for p in scene.precisions},
            "exact": list(scene.exact),
        }, {}
    model = scene.build()
    document = written(model)
    about = {
        "name": name,
        "steps": scene.steps,
        **({"why": scene.why} if scene.why else {}),
        "digest": digest(*document.values()),
        "ids": ids(model),
        "noise": noises(model),
        **document,
    }
    return about, {p: run(scene, model, p) for p in scene.precisions}


# ------------------------------------------------------------------------------------------------------ files


@dc.dataclass
class Stored:
    """The content of `evidence/trajectories`: the description of each model, and its values in each
    precision.
    """

    about: dict[str, Any]
    models: dict[str, dict[str, Any]]
    values: dict[str, dict[str, dict[str, np.ndarray]]]

    @classmethod
    def read(cls, folder: Path = FOLDER) -> Stored:
        """Read the folder; a missing folder is empty."""
        if not (folder / ABOUT).exists():
            return cls({}, {}, {})
        about = json.loads((folder / ABOUT).read_text(encoding="utf-8"))
        models = json.loads(lzma.decompress((folder / MODELS).read_bytes()))
        raw, at, values = (
            lzma.decompress((folder / VALUES).read_bytes()),
            0,
            dict[str, dict[str, dict[str, np.ndarray]]](),
        )
        for name, body in models.items():
            exact: dict[str, np.ndarray] = {}
            for precision, rows in body.pop("rows", {}).items():
                found = values.setdefault(name, dict[str, dict[str, np.ndarray]]())
                found[precision] = {}
                for row, form in rows.items():
                    size = int(np.prod(form)) * np.dtype(precision).itemsize
                    array = _unpacked(raw[at : at + size], precision, tuple(form), exact.get(row))
                    at += size
                    found[precision][row] = array
                exact = dict(found[precision]) if precision == "float64" else exact
        return cls(about, models, values)

    def write(self, folder: Path = FOLDER) -> None:
        """Write the folder."""
        folder.mkdir(parents=True, exist_ok=True)
        raw, models = bytearray(), dict[str, Any]()
        for name, body in sorted(self.models.items()):
            rows: dict[str, Any] = {}
            exact: Values = {}
            for precision in sorted(self.values.get(name, {}), reverse=True):
                found = self.values[name][precision]
                rows[precision] = {row: list(array.shape) for row, array in found.items()}
                for row, array in found.items():
                    raw += _packed(array, exact.get(row))
                exact = found if precision == "float64" else exact
            models[name] = body | ({"rows": rows} if rows else {})
        (folder / MODELS).write_bytes(_compressed(json.dumps(models).encode()))
        (folder / VALUES).write_bytes(_compressed(bytes(raw)))
        (folder / ABOUT).write_text(json.dumps(self.about, indent=2) + "\n", encoding="utf-8")


def _compressed(content: bytes) -> bytes:
    return lzma.compress(content, preset=9 | lzma.PRESET_EXTREME)


def _packed(array: np.ndarray, exact: np.ndarray | None) -> bytes:
    """Bytes of an array, those of equal weight side by side; single precision as the distance of its bits
    from the double precision's, rounded.
    """
    whole = np.ascontiguousarray(array, array.dtype.newbyteorder("<"))
    if whole.dtype.itemsize == 4 and exact is not None and exact.shape == array.shape:
        whole = whole.view("<u4") - exact.astype("<f4").view("<u4")
    return whole.reshape(-1, 1).view(np.uint8).T.tobytes()


def _unpacked(content: bytes, precision: str, form: tuple[int, ...], exact: np.ndarray | None) -> np.ndarray:
    size = np.dtype(precision).itemsize
    whole = (
        np.ascontiguousarray(np.frombuffer(content, np.uint8).reshape(size, -1).T)
        .view(f"<u{size}")
        .reshape(form)
    )
    if size == 4 and exact is not None and exact.shape == form:
        whole = whole + exact.astype("<f4").view("<u4")
    return whole.view(f"<f{size}")


def made_by() -> dict[str, str]:
    """Return versions, machine and commit."""

    def git(*words: str) -> str:
        return subprocess.run(
            ["git", *words], cwd=ROOT, capture_output=True, text=True, check=True
        ).stdout.strip()

    changed = (
        ""
        if not git("status", "--porcelain", "--", "src", "examples")
        else ", with changes in src or examples"
    )
    return {
        "date": datetime.datetime.now(datetime.UTC).date().isoformat(),
        "commit": git("log", "-1", "--format=%H") + changed,
        **{name: importlib.metadata.version(name) for name in ("deodar", "jax", "jaxlib", "numpy")},
        "python": platform.python_version(),
        "machine": machine(),
        "cores": str(os.cpu_count()),
    }


# -------------------------------------------------------------------------------------------------- comparing


@dc.dataclass(frozen=True)
class Comparison:
    """The result of comparing a model.

    Attributes:
        name: of the model.
        largest: the largest difference in each precision, and its row.
        problems: differences above a limit, and changes of documents, ids, noise and events.
    """

    name: str
    largest: Mapping[str, tuple[float, str]]
    problems: Sequence[str]

    def __str__(self) -> str:
        told = "  ".join(f"{p} {largest:8.2g}" for p, (largest, _) in self.largest.items())
        return "\n".join([f"{self.name:45} {told}", *(f"    {problem}" for problem in self.problems)])


def compare(
    name: str,
    scene: Scene | Table,
    before: Mapping[str, Any],
    values: Mapping[str, Values],
    only: Sequence[str] = (),
) -> Comparison:
    """Run a model again, and compare it with the stored run.

    Args:
        name: of the model.
        scene: the model as it is run now.
        before: its stored description.
        values: its stored rows, by precision.
        only: precisions; none: all that are stored.
    """
    if isinstance(scene, Table):
        return _compare_numbers(name, scene, before, only)
    model = scene.build()
    problems = [
        *_documents(model, before),
        *_changed("id", before["ids"], ids(model)),
        *_changed("noise", before["noise"], noises(model)),
    ]
    largest: dict[str, tuple[float, str]] = {}
    if scene.steps != before["steps"]:
        return Comparison(name, {}, [*problems, f"{before['steps']} steps are stored, {scene.steps} are run"])
    for precision in [p for p in values if not only or p in only]:
        now, then = run(scene, model, precision), values[precision]
        missing, largest[precision] = [row for row in then if row not in now], (0.0, "")
        problems += [f"{row} is missing" for row in missing]
        for row in [row for row in then if row in now]:
            found = difference(then[row], now[row])
            if found > largest[precision][0]:
                largest[precision] = (found, row)
        if largest[precision][0] > LIMITS[precision]:
            problems.append(
                f"{precision}: {largest[precision][1]} differs by {largest[precision][0]:.3g}, above"
                f" {LIMITS[precision]:g}"
            )
    return Comparison(name, largest, problems)


def difference(then: np.ndarray, now: np.ndarray) -> float:
    """The largest absolute difference, divided by the largest absolute value if this is above 1; infinite
    where only one of the two is NaN.
    """
    if then.shape != now.shape or not np.array_equal(np.isnan(then), np.isnan(now)):
        return float("inf")
    there = ~np.isnan(then)
    if not there.any():
        return 0.0
    a, b = then[there].astype(np.float64), now[there].astype(np.float64)
    return float(np.abs(a - b).max() / max(1.0, np.abs(a).max()))


def _documents(model: dd.Model, before: Mapping[str, Any]) -> Iterator[str]:
    """Yield what differs between the stored document, as it opens now, and that of the present model."""
    keys = [key for key in before if key == "document" or key.endswith(".npz")]
    try:
        then = _without_notes(written(opened({key: before[key] for key in keys})))
    except dd.errors.DeodarError as error:
        yield f"the stored document does not open: {error}"
        return
    now = _without_notes(written(model))
    if then != now:
        lines = list(zip(then["document"].split("\n"), now["document"].split("\n"), strict=False))
        first = next(
            (f"{a.strip()} was stored, {b.strip()} is the present one" for a, b in lines if a != b),
            "arrays or length differ",
        )
        yield f"another document: {first}"


def _without_notes(written: Mapping[str, str]) -> dict[str, str]:
    document = {key: value for key, value in json.loads(written["document"]).items() if key != "notes"}
    return {**written, "document": json.dumps(document, indent=1)}


def _changed(what: str, then: Mapping[str, str], now: Mapping[str, str]) -> list[str]:
    return [
        f"{what} of {path}: {then.get(path)} was stored, {now.get(path)} is the present one"
        for path in {**then, **now}
        if then.get(path) != now.get(path)
    ]


def _compare_numbers(name: str, table: Table, before: Mapping[str, Any], only: Sequence[str]) -> Comparison:
    problems: list[str] = []
    largest: dict[str, tuple[float, str]] = {}
    for precision, then in before["numbers"].items():
        if only and precision not in only:
            continue
        now = json.loads(json.dumps(table.numbers(precision)))
        largest[precision] = (0.0, "")
        for column, values in then.items():
            if column in before["exact"]:
                problems += (
                    []
                    if now.get(column) == values
                    else [f"{precision}: {column} was {values}, and is {now.get(column)}"]
                )
                continue
            found = difference(
                *(
                    np.asarray([np.nan if v is None else v for v in c], np.float64)
                    for c in (values, now.get(column, []))
                )
            )
            largest[precision] = max(largest[precision], (found, column))
            problems += (
                [f"{precision}: {column} differs by {found:.3g}, above {LIMITS[precision]:g}"]
                if found > LIMITS[precision]
                else []
            )
    return Comparison(name, largest, problems)


# ---------------------------------------------------------------------------------------------------- command


def chosen(texts: Sequence[str]) -> dict[str, Scene | Table]:
    """Return the models and tables whose name is one of the texts, or contains one that is not a name."""
    everything: dict[str, Scene | Table] = {**scenes(), **tables()}
    return {name: everything[name] for name in _matching(list(everything), texts)}


def stored_names(found: Stored, texts: Sequence[str]) -> list[str]:
    """Return the names of stored models that are one of the texts, or contain one that is not a name."""
    return _matching(list(found.models), texts)


def _matching(names: Sequence[str], texts: Sequence[str]) -> list[str]:
    return [
        name for name in names if not texts or any(t == name or (t not in names and t in name) for t in texts)
    ]


def store(texts: Sequence[str]) -> int:
    """Run models and store them; without texts all of them, and nothing else."""
    found = Stored.read() if texts else Stored({}, {}, {})
    maker = made_by()
    mark = maker["commit"][:12]
    try:
        for name, scene in chosen(texts).items():
            began = time.perf_counter()
            about, values = computed(name, scene)
            found.models[name] = about | {"made_by": mark}
            found.values.pop(name, None)
            found.values |= {name: values} if values else {}
            print(f"{name:45} {time.perf_counter() - began:6.1f} s", flush=True)
    finally:  # Ctrl-C stores the models that were run
        makers = {**found.about.get("made_by", {}), mark: maker}
        used = {body["made_by"] for body in found.models.values()}
        found.about = {
            "what": (
                "trajectories of every model of the repository; python benchmarks/trajectories.py compare"
            ),
            "limits": LIMITS,
            "models": len(found.models),
            "made_by": {m: makers[m] for m in sorted(used)},
        }
        found.write()
    size = sum(p.stat().st_size for p in FOLDER.iterdir())
    print(f"{len(found.models)} models, {size / 1e6:.2f} MB in {FOLDER.relative_to(ROOT)}")
    return 0


def compare_all(texts: Sequence[str]) -> int:
    """Compare models, and print a line for each; 1 if a limit is broken."""
    found, now = Stored.read(), chosen(texts)
    for mark, maker in found.about.get("made_by", {}).items():
        print(f"stored at {mark}: " + ", ".join(f"{k} {v}" for k, v in maker.items() if k != "commit"))
    done: list[Comparison] = []
    for name in stored_names(found, texts):
        if name in now:
            done.append(compare(name, now[name], found.models[name], found.values.get(name, {})))
        else:
            done.append(Comparison(name, {}, ["is stored, but no model has this name now"]))
        print(done[-1], flush=True)
    for precision, limit in LIMITS.items():
        largest = max(
            ((c.largest[precision][0], c.name) for c in done if precision in c.largest), default=(0.0, "-")
        )
        print(
            f"{precision}: largest difference {largest[0]:.3g}{f' ({largest[1]})' if largest[0] else ''},"
            f" limit {limit:g}"
        )
    new = [name for name in now if name not in found.models]
    print(f"not stored: {', '.join(new)}" if new else "every model is stored")
    bad = [c for c in done if c.problems]
    print(
        f"{len(done)} models compared, {len(bad)} differ"
        + (f": {', '.join(c.name for c in bad)}" if bad else "")
    )
    return 1 if bad or not done else 0


def listed() -> int:
    """Print what is stored, and the difference between single and double precision."""
    found = Stored.read()
    print(json.dumps(found.about, indent=2))
    for name, body in found.models.items():
        values = found.values.get(name, {})
        gap = (
            max((difference(v, values["float32"][row]) for row, v in values["float64"].items()), default=0.0)
            if len(values) == 2
            else None
        )
        print(
            f"{name:45} {body.get('steps', ''):>6} steps  "
            + (f"float32 from float64 {gap:8.2g}" if gap is not None else "")
        )
    return 0


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("what", choices=("store", "compare", "list"))
    parser.add_argument(
        "names", nargs="*", help="models whose name contains one of these texts (default: all)"
    )
    args = parser.parse_args(arguments)
    return listed() if args.what == "list" else (store if args.what == "store" else compare_all)(args.names)


if __name__ == "__main__":
    raise SystemExit(main())
