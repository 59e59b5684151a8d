"""What broken and hostile files may lead to: one clear error, or a model with a report."""

from __future__ import annotations

import json
import random
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import deodar as dd
from deodar.errors import DeodarError
from deodar.importers.opening import Imported
from deodar.importers.tools import IMPORTERS
from deodar.model.check import problems

sys.path.insert(0, str(Path(__file__).parents[3] / "benchmarks"))
import mutations


def tried(
    tool: str,
    content: bytes | str,
    bugs: bool = False,
    beside: Callable[[str], bytes | None] = lambda _: None,
) -> Imported | None:
    """Read a file; return None after its one error. Any other outcome fails the test.

    The model is checked, not compiled.
    """
    data = content.encode("utf-8", "surrogatepass") if isinstance(content, str) else content
    try:
        done = IMPORTERS[tool].read(data, "file.json", bugs, beside)
    except DeodarError as error:
        assert str(error) and "Traceback" not in str(error)
        return None
    assert done.report.text() and json.dumps(done.report.data())
    assert done.model.to_json()
    done.model.check()
    return done


def broken(source: str, rng: random.Random, count: int) -> Iterator[bytes | str]:
    """Yield files with errors: every fourth in its bytes, the others in their content."""
    document = json.loads(source)
    for k in range(count):
        if k % 4 == 0:
            yield mutations.scrambled(source.encode(), rng)
        else:
            yield json.dumps(mutations.mutated(document, rng, rng.randint(1, 12)))


def run_without_problems(read: Callable[[str], Imported | None], source: str, seed: int, count: int) -> int:
    """Return how many of some mutations of a file have no problems and run."""
    rng, document, ran = random.Random(seed), json.loads(source), 0
    for _ in range(count):
        done = read(json.dumps(mutations.mutated(document, rng, 4)))
        if done is not None and not problems(done.model.document):
            try:
                dd.simulate(done.model, done.model.document.step * 2, every=done.model.document.step * 2)
                ran += 1
            except DeodarError as error:
                assert str(error)
    return ran
