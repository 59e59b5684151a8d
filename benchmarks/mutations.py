"""Files with errors in them, by the thousand: `python benchmarks/mutations.py [--count N] [--seed S] [--run
R]`, by default 2,000, 0 and 10.

Takes documents of deodar (`examples/`) and files of cedar, cosivina and dnf-composer (in the tests, and one
with every class of cosivina), changes their text or their content at random places, and opens them. Each must
give a model, or one error that lists problems. Any other exception, an error that says nothing, more than a
minute of CPU time, or a model that is empty although nothing says so, is printed with what makes it again
(`--only NAME:NUMBER`); then the status is 1.
"""

from __future__ import annotations

import argparse
import copy
import json
import random
import re
import signal
import string
import sys
import tempfile
import traceback
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import deodar as dd
from deodar.errors import DeodarError
from deodar.importers.opening import read, tool_of
from deodar.model import document_files
from deodar.model.document import Document
from deodar.model.model import Model
from deodar_interop.importers.cosivina.classes import CLASSES
from deodar_interop.importers.cosivina.translate import MISSING

ROOT = Path(__file__).parent.parent
SAMPLES = ROOT / "tests" / "deodar_interop" / "importers" / "cosivina"
ARCHITECTURES = ROOT / "tests" / "deodar_interop" / "importers" / "cedar" / "data"
SIMULATIONS = ROOT / "tests" / "deodar_interop" / "importers" / "dnf_composer"
EXAMPLES = ROOT / "examples"

SECONDS = 60.0
"""CPU time after which opening a file counts as a hang (a guess: the largest one takes about a second)."""

VALUES: list[Any] = [
    *(
        None,
        True,
        -1,
        0,
        3,
        0.5,
        -0.5,
        1e-300,
        1e308,
        10**250,
        "",
        "_NaN_",
        "_Inf_",
        "\ud800",
        "\0",
        "a" * 100_000,
        "." * 10_000,
        '"',
        "u",
        "output",
    ),
    *(
        [],
        {},
        [[]],
        [{}],
        [0.5],
        [3, 3],
        [1, [2]],
        [[1, 2], [3]],
        [10**9, 10**9],
        {"kind": "Field"},
        {"class": "NeuralField"},
        {"label": "u"},
    ),
    *("../../etc/passwd", "os:system", "__import__", ["x", "x"], {"array": "array"}, {"x": {}}),
    {"_ArrayType_": "double", "_ArraySize_": [0, 0], "_ArrayData_": None},
    {"_ArrayType_": "double", "_ArraySize_": [9], "_ArrayData_": [1]},
]


class Broken(Exception):
    """Raised where a file gives neither a model nor an error that lists problems."""


def every_class() -> str:
    """A file of cosivina that holds one element of each class, in two sizes, each reading a field."""
    field = {
        "label": "u",
        "class": "NeuralField",
        "param": {"size": [1, 5], "tau": 10, "h": -5, "beta": 4},
        "nInputs": 0,
        "input": None,
    }
    elements: list[dict[str, Any]] = [field]
    for kind in sorted({*CLASSES, *MISSING}):
        param = {
            "size": [1, 5],
            "inputSize": [1, 5],
            "outputSize": [1, 5],
            "pattern": [1, 2, 3, 4, 5],
            "weights": [[1] * 5] * 5,
        }
        param |= {
            "onTimes": [[1, 3]],
            "storingTimes": [1, 2],
            "stimulusPatterns": [[1, 2, 3, 4, 5]] * 2,
            "startTimes": [1, 4],
            "initialState": 1,
        }
        reads = [{"label": "u", "component": "output"}] * (2 if kind == "HebbianConnection" else 1)
        elements.append(
            {"label": f"a {kind}", "class": kind, "param": param, "nInputs": len(reads), "input": reads}
        )
    body = {
        "deltaT": 1,
        "tZero": 0,
        "nElements": len(elements),
        "elementLabels": [e["label"] for e in elements],
        "elements": elements,
    }
    return json.dumps({"simulator": body})


def sources() -> dict[str, str]:
    """Text of all files that are changed, by their names: those without arrays in a file beside them."""
    found = {path.stem: path.read_text(encoding="utf-8") for path in sorted(SAMPLES.glob("*.json"))} | {
        "every_class": every_class()
    }
    found |= {
        f"{path.stem}.dnf": path.read_text(encoding="utf-8") for path in sorted(SIMULATIONS.glob("*.dnf"))
    }
    found |= {
        f"{path.stem}.cedar": path.read_text(encoding="utf-8")
        for path in sorted(ARCHITECTURES.glob("*.json"))
    }
    whole = [
        path for path in sorted(EXAMPLES.glob("*.json")) if not list(EXAMPLES.glob(f"{path.stem}.*.npz"))
    ]
    return found | {path.stem: path.read_text(encoding="utf-8") for path in whole}


# ---------------------------------------------------------------------------------------------------- changes


def changed(text: str, rng: random.Random) -> bytes:
    """A file with errors in its text or in its content."""
    way = rng.random()
    if way < 0.15:
        return scrambled(text.encode(), rng)
    if way < 0.3:
        return _lines(text, rng).encode("utf-8", "surrogatepass")
    data = json.loads(text, object_pairs_hook=numbered)
    return written(mutated(data, rng, rng.choice((1, 1, 2, 3, 8)))).encode("utf-8", "surrogatepass")


def numbered(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """An object in which a repeated key has a number, so that all of them can be changed."""
    found: dict[str, Any] = {}
    for key, value in pairs:
        name, n = key, 0
        while name in found:
            n += 1
            name = f"{key}\0{n}"
        found[name] = value
    return found


def written(data: Any) -> str:
    """The text of data, with repeated keys as they were."""
    return re.sub(r"\\u0000\d+", "", json.dumps(data))


def scrambled(content: bytes, rng: random.Random) -> bytes:
    out = bytearray(content)
    for _ in range(rng.randint(1, 8)):
        out[rng.randrange(len(out))] = rng.randrange(256)
    return bytes(out[: rng.randrange(len(out))] if rng.random() < 0.3 else out)


def _lines(text: str, rng: random.Random) -> str:
    """Members of objects written twice, taken away or exchanged, as an editor or a merge of versions leaves
    them.
    """
    parts = text.split(", ") if "\n" not in text else text.split("\n")
    for _ in range(rng.randint(1, 4)):
        at = rng.randrange(len(parts))
        match rng.randrange(3):
            case 0:
                parts.insert(at, parts[at])
            case 1:
                del parts[at]
            case _:
                other = rng.randrange(len(parts))
                parts[at], parts[other] = parts[other], parts[at]
        parts = parts or [""]
    return (", " if "\n" not in text else "\n").join(parts)


def mutated(data: Any, rng: random.Random, times: int) -> Any:
    """A copy with some of its values changed, taken away, moved, doubled or renamed."""
    data = copy.deepcopy(data)
    for _ in range(times):
        holder: Any = data
        for _ in range(rng.randint(1, 7)):
            inner = [
                v
                for v in (holder.values() if isinstance(holder, dict) else holder)
                if isinstance(v, (dict, list)) and v
            ]
            if not inner:
                break
            holder = rng.choice(inner)
        if isinstance(holder, dict) and holder:
            key, way = rng.choice(list(holder)), rng.randrange(5)
            if way == 0:
                del holder[key]
            elif way == 1:
                names = [
                    "label",
                    "class",
                    "size",
                    "input",
                    "kind",
                    "axes",
                    "id",
                    "uniqueName",
                    "inputs",
                    "".join(rng.choices(string.printable, k=5)),
                ]
                holder[rng.choice(names)] = holder.pop(key)
            elif way == 2:
                holder[key] = copy.deepcopy(holder[rng.choice(list(holder))])
            else:
                holder[key] = copy.deepcopy(rng.choice(VALUES))
        elif isinstance(holder, list) and holder:
            at, way = rng.randrange(len(holder)), rng.randrange(4)
            if way == 0:
                del holder[at]
            elif way == 1:
                holder.append(copy.deepcopy(holder[at]))
            elif way == 2:
                rng.shuffle(holder)
            else:
                holder[at] = copy.deepcopy(rng.choice(VALUES))
    return data


# --------------------------------------------------------------------------------------- what becomes of them


def opened(content: bytes, folder: Path) -> Model | None:
    """The model of a file, or None after an error that lists problems.

    Raises:
        Broken: where it is neither.
    """
    path = folder / "file.json"
    path.write_bytes(content)
    try:
        with limited():
            return _foreign(path) if tool_of(path) is not None else _own(path)
    except DeodarError as error:
        if not error.problems or any(not p.what.strip() for p in error.problems) or "Traceback" in str(error):
            raise Broken(f"an error that says nothing: {error!r}") from error
        return None
    except Broken:
        raise
    except Exception as error:
        raise Broken(f"{type(error).__name__}: {error}\n{traceback.format_exc(limit=-4)}") from error


def _foreign(path: Path) -> Model:
    done = read(path)
    json.dumps(done.report.data())
    done.report.text()
    doc = done.model.document
    if not doc.entries and done.report.faithful and not _states_none(path.read_bytes()):
        raise Broken("an empty model, and the report says that everything was carried")
    _checked(done.model)
    return done.model


def _states_none(content: bytes) -> bool:
    """Whether a file of another tool states that it has no elements."""
    data = json.loads(content)
    steps = data.get("steps", data.get("groups"))
    return data.get("simulator", {}).get("nElements") == 0 or data.get("elements") == [] or steps in ("", {})


def _own(path: Path) -> Model:
    model = dd.load(path)
    if not model.document.entries and "elements" not in json.loads(path.read_bytes()):
        raise Broken("an empty model from a document without elements")
    _checked(model)
    return model


def _checked(model: Model) -> None:
    """What is open can be checked, and written and read again."""
    model.check()
    data, arrays = document_files.to_data(model.document)
    again: Document = document_files.from_data(json.loads(json.dumps(data)), arrays)
    if again != model.document:
        raise Broken("written and read again it is another model")


@contextmanager
def limited(seconds: float = SECONDS) -> Iterator[None]:
    """End what takes too much CPU time, on systems that can tell."""

    def stop(*_: Any) -> None:
        raise Broken(f"no end after {seconds:g} s of CPU time")

    if not hasattr(signal, "SIGVTALRM"):
        yield
        return
    before = signal.signal(signal.SIGVTALRM, stop)
    signal.setitimer(signal.ITIMER_VIRTUAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_VIRTUAL, 0)
        signal.signal(signal.SIGVTALRM, before)


def case(name: str, seed: int, number: int, texts: dict[str, str]) -> bytes:
    """One file with errors, always the same for the same name, seed and number."""
    return changed(texts[name], random.Random(f"{name} {seed} {number}"))


def ran(model: Model) -> bool:
    """Whether a model that has no problems runs two steps, or says why it does not."""
    try:
        with limited():
            dd.simulate(model, 2 * model.document.step, every=2 * model.document.step)
        return True
    except DeodarError:
        return False


def main() -> int:
    """Change files and print what became of them."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=2000, help="files with errors, of all sources together")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument(
        "--run",
        type=int,
        default=10,
        help="how many of the models that open without problems are run as well",
    )
    parser.add_argument("--only", metavar="NAME:NUMBER", help="one of them, with its content")
    args = parser.parse_args()
    texts = sources()
    if args.only:
        name, _, number = args.only.rpartition(":")
        content = case(name, args.seed, int(number), texts)
        sys.stdout.write(content.decode("utf-8", "replace") + "\n")
        with tempfile.TemporaryDirectory() as folder:
            sys.stdout.write(f"{opened(content, Path(folder))}\n")
        return 0
    found: Counter[str] = Counter()
    broken = 0
    with tempfile.TemporaryDirectory() as folder:
        for k in range(args.count):
            name = list(texts)[k % len(texts)]
            try:
                model = opened(case(name, args.seed, k // len(texts), texts), Path(folder))
                found["refused" if model is None else "opened"] += 1
                if (
                    model is not None
                    and found["run"] < args.run
                    and len(model.document.entries) < 40
                    and not model.check()
                ):
                    found["run" if ran(model) else "not run"] += 1
            except Broken as error:
                broken += 1
                sys.stdout.write(f"--only {name}:{k // len(texts)} --seed {args.seed}: {error}\n")
    counts = f"{found['opened']} opened, {found['refused']} refused, {broken} broken; {found['run']} run"
    sys.stdout.write(f"{args.count} files of {len(texts)} sources: {counts}\n")
    return int(broken > 0)


if __name__ == "__main__":
    sys.exit(main())
