"""What `deodar plot` draws of the file of a branch, a locus or a map."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from deodar.cli import _figure, _options

if TYPE_CHECKING:
    from matplotlib.figure import Figure


class AnalysisDrawing(NamedTuple):
    """The figure of files of analyses, and what each file holds."""

    figure: Figure
    files: list[tuple[Path, str]]


def drawn(args: argparse.Namespace) -> AnalysisDrawing | None:
    """Return the figure of files of analyses; None if the first file is another record.

    Further arguments are files, or the port that is drawn of branches.
    """
    if args.record.suffix.lower() == ".toml":
        return None
    # start-up time: these bring JAX
    from deodar.recording import files

    first = files.open_record(args.record)
    # start-up time: this brings matplotlib
    from deodar.figures.analysis_file import analysis_figure, kind_of

    kind = kind_of(first)
    if not kind:
        return None
    for word in _figure.WORDS:
        if getattr(args, word, None) is not None:
            args.wrong(f"{_options.flags(word)} is for records of runs; {args.record} holds a {kind}")
    other_files = [Path(name) for name in args.variables if Path(name).suffix.lower() in (".nc", ".zarr")]
    ports = [name for name in args.variables if Path(name) not in other_files]
    if len(ports) > 1:
        args.wrong(f"one port is drawn, not {len(ports)}: {', '.join(ports)}")
    kinds = [
        (args.record, kind),
        *((path, kind_of(files.open_record(path))) for path in other_files),
    ]
    return AnalysisDrawing(analysis_figure(kinds, *ports), kinds)
