"""The report of an import or an export: a verdict for each element, parameter and connection."""

from __future__ import annotations

import dataclasses as dc
from collections import Counter
from collections.abc import Sequence
from typing import Literal

from deodar.codec import JsonObject
from deodar.summary import Summarised, Summary

Verdict = Literal["carried", "approximated", "dropped"]
VERDICTS: tuple[Verdict, ...] = ("carried", "approximated", "dropped")


@dc.dataclass(frozen=True)
class Line:
    """One item of the file and its verdict.

    Attributes:
        where: label of the element in the file; "" for the file itself.
        part: `element`, `parameter`, `connection`, `component` (of an element, if the model has it under
            another name), `key` (of a JSON object, if it occurs more than once), `group`, `file`, or of a
            script `control`, `preset`, `visualization` or `statement`.
        what: the class, the name of the parameter or component, the source, or the key.
        verdict: `carried` (the model does what the file states), `approximated`, or `dropped`.
        why: how it was approximated or why it was dropped; for a carried item, its counterpart.
        element: id of the element of the model that the item belongs to, for an item of a group that of the
            first element in it; empty if that is not known, or if there is none.
        group: names of the group of the model, from the outermost, if the item belongs to a group.
    """

    where: str
    part: str
    what: str
    verdict: Verdict
    why: str = ""
    element: str = ""
    group: tuple[str, ...] = ()

    def __str__(self) -> str:
        place = f"{self.where}: " if self.where else ""
        return f"{place}{self.part} {self.what}: {self.verdict}{f', {self.why}' if self.why else ''}"

    def data(self) -> JsonObject:
        """Return plain data, for JSON; without `element` and `group` if they are empty."""
        found = {**dc.asdict(self), "group": list(self.group)}
        return {key: value for key, value in found.items() if value or key not in ("element", "group")}


@dc.dataclass(frozen=True, repr=False)
class ImportReport(Summarised):
    """The lines of one file, and the known errors of the other tool that the file touches.

    Attributes:
        tool: name of the tool.
        file: name of the file, without its folder.
        lines: one line for each element, parameter and connection.
        bugs: known errors of the tool that this file touches, and whether they were corrected or reproduced.
    """

    tool: str
    file: str
    lines: Sequence[Line]
    bugs: Sequence[str] = ()

    def count(self, verdict: Verdict) -> int:
        """Return the number of lines with a verdict."""
        return sum(line.verdict == verdict for line in self.lines)

    @property
    def faithful(self) -> bool:
        """Whether every item was carried."""
        return self.count("carried") == len(self.lines)

    @property
    def losses(self) -> list[Line]:
        """The lines whose verdict is not `carried`."""
        return [line for line in self.lines if line.verdict != "carried"]

    def summary(self) -> str:
        """Return the report as one sentence."""
        parts = Counter(
            line.part for line in self.lines if line.part in ("element", "parameter", "connection", "control")
        )
        counted = ", ".join(f"{n} {part}{'s' if n != 1 else ''}" for part, n in parts.items()) or "nothing"
        return f"{counted}; " + ", ".join(f"{self.count(v)} {v}" for v in VERDICTS)

    def text(self) -> str:
        """Return the report for a document's notes: the losses, the counterpart of each element, and the
        ports of its components.
        """
        out = [f"Imported from {self.file} ({self.tool}): {self.summary()}."]
        if self.losses:
            out += ["", "Not carried exactly:", *(f"- {line}" for line in self.losses)]
        if self.bugs:
            out += ["", f"Known errors of {self.tool} met:", *(f"- {bug}" for bug in self.bugs)]
        elements = [line for line in self.lines if line.part == "element"]
        if elements:
            out += [
                "",
                "Elements:",
                *(
                    f"- {line.where}: {line.what}, {line.verdict}{f' ({line.why})' if line.why else ''}"
                    for line in elements
                ),
            ]
        components = [line for line in self.lines if line.part == "component" and line.verdict == "carried"]
        if components:
            out += ["", "Components:", *(f"- {line.where}: {line.what}: {line.why}" for line in components)]
        return "\n".join(out)

    def data(self) -> JsonObject:
        """Return plain data, for JSON."""
        counts = {v: self.count(v) for v in VERDICTS}
        return {
            "tool": self.tool,
            "file": self.file,
            "counts": counts,
            "bugs": list(self.bugs),
            "lines": [line.data() for line in self.lines],
        }

    def _summary(self) -> Summary:
        lost = [(line.verdict, line.where, line.what) for line in self.losses]
        return Summary(f"{self.file} ({self.tool}): {self.summary()}", lost)
