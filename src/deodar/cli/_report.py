"""The report of an import or an export, as tables."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from deodar.importers.report import ImportReport


def told(report: ImportReport, then: Iterable[str]) -> Iterator[str]:
    """Print the summary, the elements and their counterparts, and what was not carried; yield what is printed
    then.
    """
    # start-up time: only a terminal needs rich
    from rich import box
    from rich.console import Console
    from rich.markup import escape
    from rich.table import Table

    console = Console()
    if not console.is_terminal:  # a pipe has no width
        console = Console(width=160)
    console.print(f"{escape(report.file)} ({report.tool}): {report.summary()}.", highlight=False)
    elements = [line for line in report.lines if line.part == "element"]
    if elements:
        table = Table("element", "class", "became", "verdict", box=box.SIMPLE_HEAD)
        for line in elements:
            table.add_row(*(escape(text) for text in (line.where, line.what, line.why, line.verdict)))
        console.print(table)
    components = [line for line in report.lines if line.part == "component" and line.verdict == "carried"]
    if components:
        table = Table("element", "component", "here", box=box.SIMPLE_HEAD)
        for line in components:
            table.add_row(*(escape(text) for text in (line.where, line.what, line.why)))
        console.print(table)
    losses = [line for line in report.losses if line.part != "element"]
    if losses:
        table = Table("where", "what", "verdict", "why", box=box.SIMPLE_HEAD)
        for line in losses:
            table.add_row(
                *(escape(text) for text in (line.where, f"{line.part} {line.what}", line.verdict, line.why))
            )
        console.print(table)
    for bug in report.bugs:
        console.print(f"Known error of {report.tool}: {escape(bug)}.", highlight=False)
    yield from then
