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
    EXCITATION,
    HUES,
    INHIBITION,
    LARGE,
    PATCH,
    RESTING,
    RIDGE,
    SEEN,
    TAUGHT,
    WIDTH,
    column_axis,
)
from deodar.architectures.serial_order import EXCITATION as CHAIN_EXCITATION
from deodar.architectures.serial_order import INHIBITION as CHAIN_INHIBITION
from deodar.architectures.serial_order import OFF, PREDICT, STRENGTHS
from deodar.architectures.serial_order import RESTING as CHAIN_RESTING
from deodar.architectures.serial_order import WIDTH as CHAIN_WIDTH
from deodar.experiments.rows import Row
from deodar_papers.serial_order.parameters import TABLE

SOURCE = "Sandamirskaya & Schöner (2010)"

CASCADE = ("satisfaction on", "node off", "action off", "satisfaction off", "next node on", "next action on")

SentenceValue = float | list[float] | str | None


def claims(by_condition: Mapping[str, Sequence[Row]]) -> list[Claim]:
    """Return all claims: those from runs, then those from parameters, each by section."""
    return [*from_runs(by_condition), *from_parameters()]


def from_runs(by_condition: Mapping[str, Sequence[Row]]) -> list[Claim]:
    """Return the sentences whose numbers come from rows."""
    return [*_learned(by_condition), *_transitions(by_condition), *_searches(by_condition)]


def from_parameters() -> list[Claim]:
    """Return the sentences whose numbers follow from the parameters of the model, then table B.1."""
    return [*_nodes(), *_satisfaction(), *_colour_space(), *_table()]


def runs_table(by_condition: Mapping[str, Sequence[Row]]) -> str:
    """Return the sentences whose numbers come from rows, as Markdown."""
    lines = ["| section | sentence, and the paper's number | deodar | n |", "|---|---|---|---|"]
    return (
        "\n".join([*lines, *(f"| {' | '.join(_cells(c))} | {c.n or ''} |" for c in from_runs(by_condition))])
        + "\n"
    )


def parameters_table() -> str:
    """Return the sentences whose numbers follow from parameters, as Markdown; the values of table B.1 that
    differ have a table of their own.
    """
    lines = ["| section | sentence, and the paper's number | deodar |", "|---|---|---|"]
    listed = [c for c in from_parameters() if ", printed " not in c.name]
    return "\n".join([*lines, *(f"| {' | '.join(_cells(c))} |" for c in listed)]) + "\n"


def _cells(claim: Claim) -> tuple[str, str, str]:
    section, _, text = claim.name.partition(": ")
    parts = claim.value if isinstance(claim.value, list) else [claim.value]
    return section, text, ", ".join("open" if part is None else _shown(part) for part in parts)


def _shown(value: object) -> str:
    """Return a number with three digits: none of them is known more precisely."""
    if not isinstance(value, float):
        return str(value)
    return f"{float(f'{value:.3g}'):g}"


def _number(section: str, text: str, value: SentenceValue, n: int = 0) -> Claim:
    """Return a number without a target; n is 0 for a number of the model."""
    where = "table B.1" if section == "B" else f"section {section}"
    printed = round(value, 4) if isinstance(value, float) else value
    return Claim(
        f"{section}: {text}", printed, "none", None, "reported", f"{SOURCE}, {where}", n, origin="none"
    )


def _share(section: str, text: str, true: Sequence[bool]) -> Claim:
    """Return the share of cases in which a sentence is true."""
    hits, n = sum(true), len(true)
    share = round(hits / n, 4) if n else None
    interval = rounded(statistics.wilson(hits, n)) if n else None
    where = f"{SOURCE}, section {section}"
    return Claim(f"{section}: {text}", share, "none", None, "reported", where, n, interval, origin="none")


def _nodes() -> list[Claim]:
    s, node, memory = STRENGTHS, CHAIN_RESTING["node"], CHAIN_RESTING["memory"]
    on = node + s["c0 self-excitation"]
    memory_on = memory + s["c4 self-excitation of memory"]
    supported = on + s["c3 own memory"]
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
        _number("4.1", "its own memory alone does not switch a node off: its on state (above 0)", supported),
        _number(
            "4.1",
            "inhibition by the condition of satisfaction does: samples of its field that suffice",
            float(np.floor(supported / -OFF) + 1),
        ),
        _number("4.1", "a memory node stays on without its node: its on state (above 0)", memory_on),
        _number(
            "4.1",
            "and when the sequence has advanced: its on state when the next node is on (above 0; with the"
            " printed values below 0, too)",
            memory_on + s["c5 other nodes to memory"],
        ),
    ]


def _learned(by_condition: Mapping[str, Sequence[Row]]) -> list[Claim]:
    rows = by_condition["learning"]
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


def _transitions(by_condition: Mapping[str, Sequence[Row]]) -> list[Claim]:
    rows = [t for r in by_condition["arena"] for t in r["transitions"]]
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


def _satisfaction() -> list[Claim]:
    resting = CHAIN_RESTING["satisfaction"]
    values: list[tuple[str, str, float]] = [
        (
            "4.3",
            "the action field alone leaves the field of the condition of satisfaction below threshold:"
            " activation (below 0)",
            resting + PREDICT,
        ),
        ("4.3", "sensory input alone does, too: activation (below 0)", resting + LARGE),
        ("4.3", "both together lift it above threshold: activation (above 0)", resting + PREDICT + LARGE),
        (
            "4.3",
            "its peak is self-stabilized: activation at the edge of a peak with the action field alone"
            " (above 0)",
            resting + PREDICT + _hysteresis(),
        ),
        (
            "5.1",
            "a sufficiently large blob of the wanted hue satisfies: share of the central picture",
            -(resting + PREDICT) / LARGE,
        ),
        (
            "5.1",
            "a blob of another hue does not: activation with the whole centre in its hue (below 0)",
            resting + LARGE,
        ),
        ("5.1", "a central portion of the picture is input: share of its columns", PATCH),
    ]
    return [_number(*value) for value in values]


def _hysteresis() -> float:
    """Return what a peak of the field of the condition of satisfaction contributes at its edge: the most over
    all widths.
    """
    widths = np.arange(HUES // 2)
    kernel = CHAIN_EXCITATION * np.exp(-(widths**2) / (2 * CHAIN_WIDTH**2))
    return float((np.cumsum(kernel) - CHAIN_INHIBITION * (widths + 1)).max())


def _colour_space() -> list[Claim]:
    learning = RESTING + TAUGHT + SEEN
    within = EXCITATION * 2 * np.pi * WIDTH**2
    wide, narrow = (_attraction(width) for width in (24.0, 12.0))
    values: list[tuple[str, str, float | list[float]]] = [
        ("5.2", "production, ridge alone: activation of the colour-space field (below 0)", RESTING + RIDGE),
        ("5.2", "production, camera alone, a whole column in one hue: activation (below 0)", RESTING + SEEN),
        ("5.2", "production, both: activation (above 0)", RESTING + RIDGE + SEEN),
        (
            "5.2",
            "production: share of a column from which a block on the ridge makes a peak",
            -(RESTING + RIDGE) / SEEN,
        ),
        ("5.2", "learning, camera alone suffices: activation (above 0)", learning),
        (
            "5.2",
            "learning, one of several objects is selected: samples of a peak that keep a second object below"
            " threshold, and samples of the largest peak (more)",
            [round(learning / INHIBITION), round((learning + within) / INHIBITION)],
        ),
        (
            "5.2",
            "attraction scales with the size of the peak: that of a peak twice as wide at the same place,"
            " over that of the other (2)",
            wide / narrow,
        ),
        (
            "5.2",
            "the vehicle is slower near obstacles: speed near over speed elsewhere (0.5)",
            CAUTION / CRUISE,
        ),
        ("5.2", "infrared sensors (8 in appendix A, 6 in table B.1)", float(len(ANGLES))),
    ]
    return [_number(*value) for value in values]


def _attraction(width: float) -> float:
    """Return the force towards a peak over columns of a width around column 30: the sum of their offsets."""
    axis = column_axis()
    inside = np.abs(np.asarray(axis.points) - 30.0) < width / 2
    return float(np.asarray(axis.points)[inside].sum())


def _searches(by_condition: Mapping[str, Sequence[Row]]) -> list[Claim]:
    rows = by_condition["arena"]
    far = [d for r in rows for d in r["distances"] if np.isfinite(d)]
    durations = [d for r in rows for d in r["actions"]]
    ratio = max(durations) / min(durations) if durations else None
    right = [r["sequence"].startswith(r["produced"]) for r in rows]
    return [
        _share("5", "colours are searched in the shown order", right),
        _number("5", "a block is found when it looms large: median distance, mm", _median(far), len(far)),
        _number("5", "the time of a search varies: longest over shortest action", ratio, len(durations)),
    ]


def _table() -> list[Claim]:
    differ = [parameter for parameter in TABLE if not np.isclose(parameter.printed, parameter.ours)]
    same = float(len(TABLE) - len(differ))
    out = [_number("B", f"parameters with the printed value, of {len(TABLE)}", same)]
    return out + [_number("B", f"{p.label}, printed {p.printed:g}", float(p.ours)) for p in differ]


def _median(values: Sequence[float]) -> float | None:
    return float(np.median(values)) if values else None
