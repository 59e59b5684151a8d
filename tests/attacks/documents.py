"""Mutated documents: each is read as a document, or refused with an error of deodar that states the reason.

Any other outcome is a failure.
"""

from __future__ import annotations

import copy
import dataclasses as dc
import json
import random
from pathlib import Path
from typing import Any

from deodar import codec
from deodar.errors import DeodarError
from deodar.model import document_files
from deodar.model.check import problems

EXAMPLES = Path(__file__).parents[2] / "examples"
STRANGE: tuple[Any, ...] = (
    None,
    True,
    False,
    0,
    -1,
    1,
    0.5,
    -0.0,
    1e308,
    -1e308,
    1e-308,
    2**31,
    2**63,
    10**200,
    "",
    "x",
    "u.output",
    "..",
    "\0",
    "é" * 300,
    "a" * 5000,
    [],
    {},
    [[]],
    [None],
    {"": None},
    {"kind": "Field"},
    {"kind": "Gaussian", "sigma": 0},
    [1, "2", None],
    {"array": "weights"},
    "nan",
    "__class__",
)
BROKEN = (
    "NaN",
    "Infinity",
    "-Infinity",
    "1e999",
    '"\\ud800"',
    "[" * 5000 + "]" * 5000,
    "{",
    "",
    "\0",
    '{"a":1,"a":2}',
)


@dc.dataclass
class Outcome:
    """Numbers of mutated documents by outcome."""

    read: int = 0
    refused: int = 0
    errors: list[str] = dc.field(default_factory=list[str])


def places(data: Any, at: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    """Return the path of every value inside nested data."""
    inside = data.items() if isinstance(data, dict) else enumerate(data) if isinstance(data, list) else ()
    return [at, *(place for key, value in inside for place in places(value, (*at, key)))]


def mutated(random: random.Random, data: Any) -> str:
    """Return a document with one to three mutations, as text."""
    data = copy.deepcopy(data)
    for _ in range(random.choice((1, 1, 2, 3))):
        *above, last = random.choice([p for p in places(data) if p])
        parent = data
        for key in above:
            parent = parent[key]
        match random.choice(("replace", "replace", "remove", "rename", "copy", "scale")):
            case "remove":
                del parent[last]
            case "rename" if isinstance(parent, dict):
                parent[random.choice((f"{last}x", str(last)[:-1], "", "kind", "a.b.c"))] = parent.pop(last)
            case "copy":
                copied = copy.deepcopy(data)
                for key in random.choice(places(data)):
                    copied = copied[key]
                parent[last] = copied
            case "scale" if isinstance(parent[last], (int, float)):
                parent[last] = parent[last] * random.choice((-1, 0, 1e6, 1e-6, 1e300))
            case _:
                parent[last] = copy.deepcopy(random.choice(STRANGE))
        if not [p for p in places(data) if p]:
            break
    text = json.dumps(data)
    if random.random() < 0.1:
        at = random.randrange(len(text))
        text = text[:at] + random.choice(BROKEN) + text[at + random.randrange(8) :]
    return text


def attack(count: int, seed: int) -> Outcome:
    """Read mutated documents made from the examples."""
    random_, outcome = random.Random(seed), Outcome()
    originals = [json.loads(path.read_text(encoding="utf-8")) for path in sorted(EXAMPLES.glob("*.json"))]
    small = [data for data in originals if "arrays" not in data and len(data["elements"]) < 20]
    for k in range(count):
        text = mutated(random_, random_.choice(small))
        try:
            document = document_files.from_data(codec.read(text), {})
            problems(document)
            restored = document_files.from_data(json.loads(document_files.dumps(document)[0]), {})
            if restored != document:
                outcome.errors.append(f"{k}: what is written differs from what was read: {text[:2000]}")
            outcome.read += 1
        except DeodarError:
            outcome.refused += 1
        except BaseException as error:
            outcome.errors.append(f"{k}: {type(error).__name__}: {error}: {text[:2000]}")
            if isinstance(error, KeyboardInterrupt):
                raise
    return outcome
