"""What `deodar run` prints of a run that has ended, and its status."""

from __future__ import annotations

import argparse
import contextlib
import dataclasses as dc
import sys
import warnings
from collections.abc import Generator
from typing import TYPE_CHECKING

from deodar.cli import _options
from deodar.cli._answer import INTERRUPTED, CommandAnswer
from deodar.cli._run_output import GrownRecord, RunFolder, WrittenRun
from deodar.codec import Json
from deodar.errors import RunWarning
from deodar.recording import probe
from deodar.recording.files import SUFFIXES

if TYPE_CHECKING:
    import xarray

    from deodar.model.document import Document
    from deodar.recording.repeat import Repetition

NAMES = 4
"""Most variables that are named."""


@contextlib.contextmanager
def quiet() -> Generator[None]:
    """Suppress the warnings of a run, which its report prints."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RunWarning)
        yield


@dc.dataclass(frozen=True)
class EndedRun:
    """A run that has ended.

    Attributes:
        document: its document.
        data: its record; None if it was stopped before the first time.
        stopped: why it was stopped; "": it is complete.
        repetition: the comparison with the record that was run again.
        resumes: whether its record can be continued.
    """

    document: Document
    data: xarray.Dataset | None
    stopped: str = ""
    repetition: Repetition | None = None
    resumes: bool = False


def finish(args: argparse.Namespace, output: RunFolder | GrownRecord, run: EndedRun) -> CommandAnswer | int:
    """Write a run and return where; status 130 if it was stopped, 1 if it was written elsewhere, or
    differs without a reason.
    """
    values, stopped, repetition = run.data, run.stopped, run.repetition
    if stopped and (values is None or not _times(values)):
        _say(_options.paragraph([stopped, "Nothing had been recorded, so nothing was written"]))
        return INTERRUPTED
    assert values is not None
    written = output.write(values, run.document, not args.json)
    out, record, failure = written
    if "diverged" in values.attrs:
        _say(f"warning: {values.attrs['diverged']}")
    fields = _fields(written, values, run) | ({"instead_of": output.label} if failure else {})
    wrote = f"Wrote {_contents(values)} to {_options.shown(out)}"
    table = record.suffix == SUFFIXES["csv"]
    look = (
        f"The table is {_options.shown(record)}"
        if table
        else f"Look at it with: deodar plot {_options.shown(out)}"
    )
    if stopped:
        resume = [f"Continue it with: deodar run {_options.shown(out)} --resume"] if run.resumes else []
        _say(_options.paragraph([stopped, f"{wrote}, marked as incomplete", *resume, look]))
        return CommandAnswer(fields, status=INTERRUPTED)
    if failure:
        instead = (
            f"{wrote} as {record.name} instead" if isinstance(output, GrownRecord) else f"{wrote} instead"
        )
        _say(_options.paragraph([failure, instead, look]))
        return CommandAnswer(fields, status=1)
    text = _options.paragraph([wrote, look])
    lines = [text if table else text.rstrip(".")]  # a command to copy
    if repetition is not None and (repetition.differences or not repetition.same_bits):
        _say(_options.paragraph([("warning: " if repetition.faithful else "") + str(repetition)]))
    elif repetition is not None:
        lines = [_options.paragraph([str(repetition)]), *lines]
    return CommandAnswer(fields, lines, 0 if repetition is None or repetition.faithful else 1)


def _say(message: str) -> None:
    print(f"deodar run: {message}", file=sys.stderr)


def _times(record: xarray.Dataset) -> int:
    """Return the number of times of the variable with most of them."""
    return max((n for d, n in record.sizes.items() if probe.is_time(str(d))), default=0)


def _contents(record: xarray.Dataset) -> str:
    names = list(map(str, record.data_vars))
    listed = ", ".join(names[:NAMES]) + (f" and {len(names) - NAMES} more" if len(names) > NAMES else "")
    times = _times(record)
    trials = f"{record.sizes['trial']} trials, " if "trial" in record.sizes else ""
    return f"{listed} ({trials}{f'{times} times' if times != 1 else 'one time'})"


def _fields(written: WrittenRun, record: xarray.Dataset, run: EndedRun) -> dict[str, Json]:
    answer: dict[str, Json] = {
        "out": str(written.out),
        "record": str(written.record),
        "variables": {
            str(n): dict(zip(map(str, v.dims), v.shape, strict=True)) for n, v in record.data_vars.items()
        },
        "complete": not run.stopped,
    }
    if (written.out / "model.json").is_file():
        answer["model"] = str(written.out / "model.json")
    if (repetition := run.repetition) is not None:
        answer["repetition"] = {
            "same_bits": repetition.same_bits,
            **({"damage": repetition.damage} if repetition.damage else {}),
            "differences": [{"what": d.what, "then": d.then, "now": d.now} for d in repetition.differences],
            "largest": {k: v if v < float("inf") else None for k, v in repetition.largest.items()},
            "compared": repetition.compared,
        }
    return answer
