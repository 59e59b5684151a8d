"""Reported claims: sentences with numbers of sections 4 and 5 and values of table B.1, each with deodar's.

Numbers of runs come from rows. Numbers of the model are computed from its parameters; they test nothing, so
they neither hold nor fail.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from deodar.analysis import statistics
from deodar.analysis.claims import Claim
from deodar.analysis.statistics import rounded
from deodar.architectures.color_search import (
    ANGLES,
    CAUTION,
    CRUISE,
    LARGE,
    PATCH,
    RESTING,
    RIDGE,
    SEEN,
    TAUGHT,
)
from deodar.architectures.serial_order import OFF, PREDICT, STRENGTHS
from deodar.architectures.serial_order import RESTING as CHAIN_RESTING
from deodar.experiments.rows import Row
from deodar.papers.serial_order.parameters import TABLE

SOURCE = "Sandamirskaya & Schöner (2010)"

CASCADE = ("satisfaction on", "node off", "action off", "satisfaction off", "next node on", "next action on")

SentenceValue = float | list[float] | str | None


def claims(found: Mapping[str, Sequence[Row]]) -> list[Claim]:
    """Return all claims, by section."""
    return [*_section_4_1(), *_section_4_2(found), *_section_4_4(found), *_section_5(found), *_table()]


def table(all_claims: Sequence[Claim]) -> str:
    """Return the claims on sections 4 and 5 and table B.1 among others as Markdown."""
    lines = ["| section | sentence, and the paper's number | deodar | n |", "|---|---|---|---|"]
    for c in all_claims:
        section, _, text = c.name.partition(": ")
        if section[:2] in ("4.", "5.") or section in ("5", "B"):
            parts = c.value if isinstance(c.value, list) else [c.value]
            value = ", ".join("open" if part is None else _shown(part) for part in parts)
            lines.append(f"| {section} | {text} | {value} | {c.n or ''} |")
    return "\n".join(lines) + "\n"


def _shown(value: object) -> str:
    return f"{value:g}" if isinstance(value, float) else str(value)


def _number(section: str, text: str, value: SentenceValue, n: int = 0) -> Claim:
    """Return a number without a target; n is 0 for a number of the model."""
    where = "table B.1" if section == "B" else f"section {section}"
    shown = round(value, 4) if isinstance(value, float) else value
    return Claim(
        f"{section}: {text}", shown, "none", None, "reported", f"{SOURCE}, {where}", n, origin="none"
    )


def _share(section: str, text: str, true: Sequence[bool]) -> Claim:
    """Return the share of cases in which a sentence is true."""
    hits, n = sum(true), len(true)
    value = round(hits / n, 4) if n else None
    interval = rounded(statistics.wilson(hits, n)) if n else None
    where = f"{SOURCE}, section {section}"
    return Claim(f"{section}: {text}", value, "none", None, "reported", where, n, interval, origin="none")


def _section_4_1() -> list[Claim]:
    s, node, memory = STRENGTHS, CHAIN_RESTING["node"], CHAIN_RESTING["memory"]
    on = node + s["c0 self-excitation"]
    kept = memory + s["c4 self-excitation of memory"]
    own = on + s["c3 own memory"]
    return [
        _number(
            "4.1",
            "a node has an off state below 0 and an on state above 0: both states",
            [node, round(on, 4)],
        ),
        _number(
            "4.1",
            "one node alone can be on: highest off state of another one meanwhile (below 0)",
            node + s["c1 other nodes"] + s["c2 next"],
        ),
        _number(
            "4.1",
            "the memory node gives the next node its advantage: its off state (none above 0)",
            node + s["c2 next"],
        ),
        _number("4.1", "its own memory alone does not switch a node off: its on state (above 0)", own),
        _number(
            "4.1",
            "inhibition by the condition of satisfaction does: samples of its field that suffice",
            float(np.floor(own / -OFF) + 1),
        ),
        _number("4.1", "a memory node stays on without its node: its on state (above 0)", kept),
        _number(
            "4.1",
            "and when the sequence has advanced: its on state when the next node is on (above 0; with the"
            " printed values below 0, too)",
            kept + s["c5 other nodes to memory"],
        ),
    ]


def _section_4_2(found: Mapping[str, Sequence[Row]]) -> list[Claim]:
    rows = found["learning"]
    shapes = np.asarray([shape for r in rows for shape in r["weights"]], float).reshape(-1, 3)

    def median(k: int) -> float | None:
        return float(np.median(shapes[:, k])) if len(shapes) else None

    text = "one action is associated with each node in one showing: lessons with the shown colours alone"
    return [
        _share("4.2", text, [bool(r["right"]) for r in rows]),
        _number(
            "4.2",
            "weights converge to the output of the action field: median maximum",
            median(0),
            len(shapes),
        ),
        _number(
            "4.2",
            "weights are localised: median number of hues (of 180) above half",
            median(1),
            len(shapes),
        ),
        _number(
            "4.2",
            "around the shown action: largest deviation, samples of hue",
            float(np.abs(shapes[:, 2]).max()) if len(shapes) else None,
            len(shapes),
        ),
    ]


def _section_4_4(found: Mapping[str, Sequence[Row]]) -> list[Claim]:
    rows = [t for r in found["arena"] for t in r["transitions"]]
    # from the node's off; the third entry is the colour-space field, which is not part of the cascade
    times = [[t[0], 0.0, t[1], t[3], t[4], t[5]] for t in rows]
    out: list[Claim] = []
    for k in range(len(CASCADE) - 1):
        pairs = [(t[k], t[k + 1]) for t in times if t[k] is not None and t[k + 1] is not None]
        text = f"{CASCADE[k]}, then {CASCADE[k + 1]}: share of transitions"
        out.append(_share("4.4", text, [a <= b for a, b in pairs]))
    lasts = [t[5] - t[0] for t in times if t[0] is not None and t[5] is not None]
    median = float(np.median(lasts)) if lasts else None
    out.append(_number("4.4", "the cascade is one transient: median duration, ms", median, len(lasts)))
    longest = float(max(lasts)) if lasts else None
    out.append(_number("4.4", "the longest of them, ms", longest, len(lasts)))
    return out


def _section_5(found: Mapping[str, Sequence[Row]]) -> list[Claim]:
    rows = found["arena"]
    far = [d for r in rows for d in r["distances"] if np.isfinite(d)]
    durations = [d for r in rows for d in r["actions"]]
    rest = CHAIN_RESTING["satisfaction"]
    values: list[tuple[str, str, float | None, int]] = [
        (
            "5",
            "a block is found when it looms large: median distance, mm",
            _median(far),
            len(far),
        ),
        (
            "5",
            "the time of a search varies: longest over shortest action",
            max(durations) / min(durations) if durations else None,
            len(durations),
        ),
    ]
    out = [
        _share(
            "5",
            "colours are searched in the shown order",
            [r["sequence"].startswith(r["produced"]) for r in rows],
        )
    ]
    out += [_number(*value) for value in values]
    model: list[tuple[str, str, float]] = [
        (
            "5.1",
            "a sufficiently large blob of the wanted hue satisfies: share of the central picture",
            -(rest + PREDICT) / LARGE,
        ),
        (
            "5.1",
            "a blob of another hue does not: activation with the whole centre in its hue (below 0)",
            rest + LARGE,
        ),
        ("5.1", "a central portion of the picture is input: share of its columns", PATCH),
        (
            "5.2",
            "production, ridge alone: activation of the colour-space field (below 0)",
            RESTING + RIDGE,
        ),
        (
            "5.2",
            "production, camera alone, a whole column in one hue: activation (below 0)",
            RESTING + SEEN,
        ),
        (
            "5.2",
            "production, both: activation (above 0)",
            RESTING + RIDGE + SEEN,
        ),
        (
            "5.2",
            "production: share of a column from which a block on the ridge makes a peak",
            -(RESTING + RIDGE) / SEEN,
        ),
        (
            "5.2",
            "learning, camera alone suffices: activation (above 0)",
            RESTING + TAUGHT + SEEN,
        ),
        (
            "5.2",
            "the vehicle is slower near obstacles: speed near over speed elsewhere (0.5)",
            CAUTION / CRUISE,
        ),
        (
            "5.2",
            "infrared sensors (8 in appendix A, 6 in table B.1)",
            float(len(ANGLES)),
        ),
    ]
    return [*out, *(_number(*value) for value in model)]


def _table() -> list[Claim]:
    differ = [parameter for parameter in TABLE if not np.isclose(parameter.printed, parameter.ours)]
    same = float(len(TABLE) - len(differ))
    out = [_number("B", f"parameters with the printed value, of {len(TABLE)}", same)]
    return out + [_number("B", f"{p.label}, printed {p.printed:g}", float(p.ours)) for p in differ]


def _median(values: Sequence[float]) -> float | None:
    return float(np.median(values)) if values else None
